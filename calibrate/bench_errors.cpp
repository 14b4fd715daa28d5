#include "grainlaw/calibrate/bench_errors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "grainlaw/element/median.hpp"
#include "grainlaw/element/record.hpp"
#include "grainlaw/element/short_text.hpp"

namespace grainlaw::calibrate {

namespace {

constexpr double undefined = std::numeric_limits<double>::quiet_NaN();
constexpr double most_bands = 2;  // an error beyond so many bands is not chance

Series mean_of(const std::vector<Series>& runs) {
  Series mean(runs.front().size(), 0);
  for (const Series& run : runs)
    for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += run[i] / static_cast<double>(runs.size());
  return mean;
}

/// Over the rows where it is defined.
double root_mean_square(const Series& squares) {
  double sum = 0, rows = 0;
  for (const double x : squares)
    if (std::isfinite(x)) sum += x, ++rows;
  return rows > 0 ? std::sqrt(sum / rows) : undefined;
}

/// The mean over groups of 1/(runs of a group), over the number of groups: the variance of a mean of means
/// over that of a run.
double mean_share(const Groups& groups) {
  double share = 0;
  for (const auto& runs : groups) share += 1 / static_cast<double>(runs.size());
  return share / static_cast<double>(groups.size() * groups.size());
}

/// The quantities that a test is judged by.
const std::vector<std::string>& quantities_of(BenchTest test) {
  static const std::vector<std::string> isotropic{"P", "C_star"}, shear{"P", "C_star", "s_dev", "F_dev"};
  return test == BenchTest::d2 ? shear : isotropic;
}

/// The runs of a variant, without the row at the start, which is no result of the setting.
std::optional<std::vector<std::vector<Record>>> read_runs(const Variant& variant, const RunFolder& folder) {
  std::vector<std::vector<Record>> groups;
  for (const auto& names : variant.records) {
    groups.emplace_back();
    for (const std::string& name : names) {
      if (!folder.has_record(name)) return std::nullopt;
      groups.back().push_back(Record::read_csv(folder.record(name) / "record.csv"));
    }
  }
  return groups;
}

Groups column(const std::vector<std::vector<Record>>& groups, const std::string& name) {
  Groups columns;
  for (const auto& runs : groups) {
    columns.emplace_back();
    for (const Record& run : runs) columns.back().emplace_back(run[name].begin() + 1, run[name].end());
  }
  return columns;
}

struct Cost {
  double particle_steps = 0, core_s = 0;
  std::size_t runs = 0;
};

Cost cost_of(const Variant& variant, const RunFolder& folder) {
  Cost cost;
  std::vector<double> seconds;
  for (const auto& names : variant.records)
    for (const std::string& name : names) {
      const Json provenance = load_json(folder.record(name) / "provenance.json");
      cost.particle_steps += provenance.at("particle_steps").get<double>();
      const auto file = folder.record(name) / core_time_file;
      if (std::filesystem::exists(file)) seconds.push_back(load_json(file).at("core_s").get<double>());
      ++cost.runs;
    }
  cost.particle_steps /= static_cast<double>(cost.runs);
  cost.core_s = median(std::move(seconds));
  return cost;
}

/// The root mean square over the rows of what groups have in common.
double size_of(const Groups& groups) {
  std::vector<Series> means;
  for (const auto& runs : groups) means.push_back(mean_of(runs));
  Series squares = mean_of(means);
  for (double& x : squares) x *= x;
  return root_mean_square(squares);
}

/// Fewer grains scatter more, so runs of different numbers of grains are not pooled.
Series variance_of(Knob knob, const Groups& runs, const std::vector<const Groups*>& all) {
  return knob == Knob::count ? pooled_variance({&runs}) : pooled_variance(all);
}

void add_errors(const Sweep& sweep, const RunFolder& folder, std::vector<BenchError>& errors) {
  std::vector<const Variant*> variants;
  std::vector<std::vector<std::vector<Record>>> runs;
  for (const Variant& variant : sweep.variants)
    if (auto read = read_runs(variant, folder)) {
      variants.push_back(&variant);
      runs.push_back(std::move(*read));
    }
  if (variants.empty() || variants.back() != &sweep.variants.back()) return;
  for (const std::string& quantity : quantities_of(sweep.test)) {
    std::vector<Groups> columns;
    for (const auto& groups : runs) columns.push_back(column(groups, quantity));
    std::vector<const Groups*> all;
    for (const Groups& groups : columns) all.push_back(&groups);
    const Series of_reference = variance_of(sweep.knob, columns.back(), all);
    for (std::size_t i = 0; i < variants.size(); ++i) {
      const bool finest = i + 1 == variants.size();
      const Series variance = variance_of(sweep.knob, columns[i], all);
      const Cost cost = cost_of(*variants[i], folder);
      BenchError line{sweep.knob,  sweep.test, variants[i]->value,
                      quantity,    cost.runs,  cost.particle_steps,
                      cost.core_s, {},         0,
                      0,           finest};
      if (!finest) line.comparison = compare(columns[i], columns.back(), variance, of_reference);
      const double size = size_of(columns.back());
      line.scatter = root_mean_square(variance) / size;
      line.packings = compares_packings(sweep.knob)
                          ? line.scatter
                          : root_mean_square(variance_over_groups(columns[i])) / size;
      errors.push_back(line);
    }
  }
}

std::string number(double x) { return std::isfinite(x) ? short_text(x, 6) : std::string(); }

double measure_of(const BenchError& line, Judge judge) {
  return judge == Judge::chance ? line.comparison.band : line.packings;
}

/// Another method has a limit of its own, and fewer grains scatter more.
bool judged(Knob knob, Judge judge) {
  return knob != Knob::method && (knob != Knob::count || judge == Judge::chance);
}

bool good_enough(const BenchError& line, Judge judge, double wanted) {
  const double measure = measure_of(line, judge);
  if (std::isnan(measure)) return false;
  const double granted = (judge == Judge::chance ? most_bands : 1) * measure;
  return line.finest || line.comparison.error <= std::max(wanted, granted);
}

}  // namespace

Comparison compare(const Groups& runs, const Groups& reference, const Series& variance,
                   const Series& of_reference) {
  std::vector<Series> differences, means;
  for (std::size_t g = 0; g < reference.size(); ++g) {
    const Series mine = mean_of(runs.at(g));
    means.push_back(mean_of(reference[g]));
    differences.push_back(mine);
    for (std::size_t i = 0; i < mine.size(); ++i) differences.back()[i] -= means.back()[i];
  }
  const Series d = mean_of(differences), m = mean_of(means);
  const double share = mean_share(runs), reference_share = mean_share(reference);
  Series d2, m2, chance;
  double sum_d = 0, sum_m = 0;
  for (std::size_t i = 0; i < d.size(); ++i) {
    if (!std::isfinite(d[i])) continue;  // C_star where no grain bears load
    d2.push_back(d[i] * d[i]);
    m2.push_back(m[i] * m[i]);
    chance.push_back(share * variance.at(i) + reference_share * of_reference.at(i));
    sum_d += d[i];
    sum_m += m[i];
  }
  const double size = root_mean_square(m2);
  return {root_mean_square(d2) / size, root_mean_square(chance) / size, sum_d / sum_m};
}

Series pooled_variance(const std::vector<const Groups*>& sets) {
  Series sum;
  double freedom = 0;
  for (const Groups* groups : sets)
    for (const auto& runs : *groups) {
      const Series mean = mean_of(runs);
      sum.resize(mean.size(), 0);
      freedom += static_cast<double>(runs.size()) - 1;
      for (const Series& run : runs)
        for (std::size_t i = 0; i < mean.size(); ++i) sum[i] += (run[i] - mean[i]) * (run[i] - mean[i]);
    }
  for (double& x : sum) x = freedom > 0 ? x / freedom : undefined;
  return sum;
}

Series variance_over_groups(const Groups& groups) {
  std::vector<Series> means;
  for (const auto& runs : groups) means.push_back(mean_of(runs));
  const Groups one{means};
  const Series between = pooled_variance({&one}), within = pooled_variance({&groups});
  const double share = mean_share(groups) * static_cast<double>(groups.size());  // of `within`, in `between`
  Series sum(between.size());
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = between[i] + (1 - share) * within.at(i);
  return sum;
}

std::vector<BenchError> bench_errors(const Bench& bench, const RunFolder& folder) {
  std::vector<BenchError> errors;
  for (const Sweep& sweep : sweeps(bench)) add_errors(sweep, folder, errors);
  return errors;
}

std::vector<Recommendation> recommend(const std::vector<BenchError>& errors, Judge judge, double wanted) {
  struct Candidate {
    double particle_steps = 0;
    std::map<BenchTest, double> core_s;
    bool good = true;
    const BenchError* worst = nullptr;  // of errors above the wanted one
  };
  std::map<Knob, std::map<double, Candidate>> knobs;
  for (const BenchError& line : errors) {
    Candidate& candidate = knobs[line.knob][line.value];
    candidate.particle_steps += line.particle_steps;
    candidate.core_s[line.test] = line.core_s;
    candidate.good = candidate.good && good_enough(line, judge, wanted);
    const bool above = !line.finest && line.comparison.error > wanted;
    if (above && (candidate.worst == nullptr || line.comparison.error > candidate.worst->comparison.error))
      candidate.worst = &line;
  }
  std::vector<Recommendation> list;
  for (const auto& [knob, candidates] : knobs) {
    if (!judged(knob, judge)) continue;
    auto best = candidates.end();
    for (auto one = candidates.begin(); one != candidates.end(); ++one)
      if (one->second.good &&
          (best == candidates.end() || one->second.particle_steps < best->second.particle_steps))
        best = one;
    if (best == candidates.end()) continue;
    double core_s = 0;
    for (const auto& [test, seconds] : best->second.core_s) core_s += seconds;
    Recommendation found{};
    found.knob = knob;
    found.value = best->first;
    found.core_s = core_s;
    if (const BenchError* worst = best->second.worst) {
      found.excused = worst->comparison.error;
      found.test = worst->test;
      found.quantity = worst->quantity;
    }
    list.push_back(found);
  }
  return list;
}

std::string to_csv(const std::vector<BenchError>& errors) {
  std::string text =
      "knob,value,test,quantity,runs,particle_steps,core_s,error,band,offset,scatter,packings\n";
  for (const BenchError& line : errors) {
    text += name_of(line.knob) + "," + number(line.value) + "," + name_of(line.test) + "," + line.quantity +
            "," + std::to_string(line.runs);
    const Comparison& c = line.comparison;
    const double none = line.finest ? undefined : 1;  // the finest is not compared with itself
    for (const double x : {line.particle_steps, line.core_s, none * c.error, none * c.band, none * c.offset,
                           line.scatter, line.packings})
      text += "," + number(x);
    text += "\n";
  }
  return text;
}

Json to_json(const std::vector<BenchError>& errors) {
  const auto or_null = [](double x) { return std::isfinite(x) ? Json(x) : Json(); };
  Json list = Json::array();
  for (const BenchError& line : errors) {
    Json entry{
        {"knob", name_of(line.knob)},    {"value", line.value}, {"test", name_of(line.test)},
        {"quantity", line.quantity},     {"runs", line.runs},   {"particle_steps", line.particle_steps},
        {"core_s", or_null(line.core_s)}};
    if (!line.finest) {
      entry["error"] = or_null(line.comparison.error);
      entry["band"] = or_null(line.comparison.band);
      entry["offset"] = or_null(line.comparison.offset);
    }
    entry["scatter"] = or_null(line.scatter);
    entry["packings"] = or_null(line.packings);
    list.push_back(std::move(entry));
  }
  return list;
}

}  // namespace grainlaw::calibrate
