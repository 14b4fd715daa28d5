#include "grainlaw/calibrate/path_account.hpp"

#include <cmath>
#include <limits>

#include "grainlaw/calibrate/predict_records.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/model/predict.hpp"
#include "grainlaw/model/status.hpp"

namespace grainlaw::calibrate {
namespace {

using model::shown;

constexpr double entangled = 0.95;
/// Root mean square of residuals, in errors, up to which a law can be said to follow the data.
constexpr double follows = 1.5;

Json number(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }
Json number(const std::optional<double>& x) { return x ? Json(*x) : Json(nullptr); }
Json numbers(const std::vector<double>& x) {
  Json list = Json::array();
  for (const double value : x) list.push_back(number(value));
  return list;
}

struct Pair {
  std::string a, b;
  double correlation;
};

std::vector<Pair> entangled_pairs(const PathProblem& problem, const PathFit& fit) {
  std::vector<Pair> pairs;
  const auto& correlations = fit.errors.correlations;
  for (Eigen::Index i = 0; i < correlations.rows(); ++i)
    for (Eigen::Index j = 0; j < i; ++j)
      if (std::abs(correlations(i, j)) > entangled)
        pairs.push_back({problem.names()[static_cast<std::size_t>(j)],
                         problem.names()[static_cast<std::size_t>(i)], correlations(i, j)});
  return pairs;
}

/// Why the paths do not determine parameter k, or nothing.
std::string undetermined(const PathProblem& problem, const PathFit& fit, std::size_t k) {
  if (fit.errors.errors.empty()) return "nothing could be fitted";
  if (!fit.blind.reasons[k].empty()) return fit.blind.reasons[k];
  if (problem.at_bound(k, fit.best.values[k])) return "it rests on the bound of the law";
  if (!std::isfinite(fit.errors.errors[k])) return "where the fit ends its standard error cannot be told";
  if (fit.errors.errors[k] > std::abs(fit.best.values[k])) return "its standard error exceeds its value";
  if (fit.profiles.empty()) return "";
  const Profile& profile = fit.profiles[k];
  if (!profile.low || !profile.high)
    return std::string("its profile is open ") + (profile.low    ? "upwards"
                                                  : profile.high ? "downwards"
                                                                 : "on both sides");
  return "";
}

std::string found(const PathProblem& problem, const PathFit& fit, std::size_t k) {
  std::string text = problem.names()[k] + " = " + shown(fit.best.values[k]) + " +- " +
                     shown(fit.errors.errors[k]) + " (from " + shown(problem.start()[k]) + ")";
  if (!fit.profiles.empty() && fit.profiles[k].low && fit.profiles[k].high)
    text += ", profile " + shown(*fit.profiles[k].low) + " to " + shown(*fit.profiles[k].high);
  return text;
}

Json sentences(const PathProblem& problem, const PathFit& fit) {
  Json list = Json::array();
  for (std::size_t k = 0; k < problem.names().size(); ++k) {
    const std::string reason = undetermined(problem, fit, k);
    list.push_back(reason.empty() ? "determined: " + found(problem, fit, k)
                                  : "not determined: " + problem.names()[k] + ": " + reason);
  }
  const Misfits left = misfits_of(problem, fit.best.values);
  if (left.stress > follows || left.fabric > follows) {
    std::string residuals;
    if (std::isfinite(left.stress)) residuals = shown(left.stress) + " errors in stress";
    if (std::isfinite(left.fabric))
      residuals += (residuals.empty() ? "" : ", ") + shown(left.fabric) + " errors in fabric";
    list.push_back("the law does not follow the paths within their errors (residuals of " + residuals +
                   "): values make up for what its form lacks, and standard errors leave that out");
  }
  for (const Pair& pair : entangled_pairs(problem, fit))
    list.push_back("entangled: " + pair.a + " and " + pair.b + " (correlation " + shown(pair.correlation) +
                   ")");
  return list;
}

Json parameters(const PathProblem& problem, const PathFit& fit) {
  Json list = Json::array();
  for (std::size_t k = 0; k < problem.names().size(); ++k) {
    const bool known = !fit.errors.errors.empty() && !fit.blind.numbers.contains(k);
    const std::string reason = undetermined(problem, fit, k);
    Json entry{
        {"name", problem.names()[k]},   {"start", problem.start()[k]},
        {"value", fit.best.values[k]},  {"stderr", known ? number(fit.errors.errors[k]) : Json(nullptr)},
        {"determined", reason.empty()}, {"reason", reason}};
    if (known && !fit.profiles.empty()) {
      const Profile& p = fit.profiles[k];
      entry["profile"] = {{"values", numbers(p.values)},
                          {"rises", numbers(p.rises)},
                          {"interval95", {number(p.low), number(p.high)}}};
    }
    list.push_back(entry);
  }
  return list;
}

Json data(const PathProblem& problem, const PathFit& fit) {
  Json list = Json::array();
  const std::vector<double>* both[] = {&problem.start(), &fit.best.values};
  for (const PathSeries& series : problem.series()) {
    Json entry{{"test", series.test}, {"seeds", series.seeds}, {"rows", series.samples.size()}};
    for (const std::size_t q : problem.columns())
      entry["columns"][path_columns[q]] = {{"error", series.error[q]},
                                           {"error_from", series.from_scatter[q] ? "scatter" : "assumed"}};
    for (int i = 0; i < 2; ++i) {
      std::vector<double> residuals(problem.columns().size() * series.samples.size());
      const bool walked =
          problem.evaluate_series(series, *both[i], {1, 1, 1}, residuals.data(), nullptr, nullptr);
      std::size_t row = 0;
      for (const std::size_t q : problem.columns()) {
        std::vector<double> predicted;
        for (const double measured : series.measured[q])
          predicted.push_back(measured + series.error[q] * residuals[row++]);
        entry["columns"][path_columns[q]][i == 0 ? "distance_before" : "distance_after"] =
            walked ? number(relative_distance(predicted, series.measured[q])) : Json(nullptr);
      }
    }
    list.push_back(entry);
  }
  return list;
}

Json misfits_json(const Misfits& misfits) {
  return {{"stress", number(misfits.stress)}, {"fabric", number(misfits.fabric)}};
}

}  // namespace

Misfits misfits_of(const PathProblem& problem, const std::vector<double>& values) {
  const auto residuals = problem.evaluate(values, {1, 1, 1}, false);
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  if (!residuals) return {nothing, nothing};
  struct {
    double squares = 0, rows = 0;
  } stress, fabric;
  Eigen::Index row = 0;
  for (const PathSeries& series : problem.series())
    for (const std::size_t q : problem.columns()) {
      const auto n = static_cast<Eigen::Index>(series.samples.size());
      auto& sum = q == fabric_column ? fabric : stress;
      sum.squares += residuals->values.segment(row, n).squaredNorm();
      sum.rows += static_cast<double>(n);
      row += n;
    }
  return {std::sqrt(stress.squares / stress.rows), std::sqrt(fabric.squares / fabric.rows)};
}

Json account_of(const PathProblem& problem, const PathFit& fit, const std::vector<LeftOut>& left_out) {
  Json account{{"exit", fit.best.exit},
               {"parameters", parameters(problem, fit)},
               {"sentences", sentences(problem, fit)},
               {"data", data(problem, fit)},
               {"misfit_before", misfits_json(misfits_of(problem, problem.start()))},
               {"misfit_after", misfits_json(misfits_of(problem, fit.best.values))},
               {"n_effective", number(fit.errors.n_effective)}};
  account["correlations"] = Json::array();
  for (Eigen::Index i = 0; i < fit.errors.correlations.rows(); ++i) {
    Json row = Json::array();
    for (Eigen::Index j = 0; j < fit.errors.correlations.cols(); ++j)
      row.push_back(number(fit.errors.correlations(i, j)));
    account["correlations"].push_back(row);
  }
  account["entangled"] = Json::array();
  for (const Pair& pair : entangled_pairs(problem, fit))
    account["entangled"].push_back({{"a", pair.a}, {"b", pair.b}, {"correlation", pair.correlation}});
  account["trade_off"] = Json::array();
  for (const TradeOff& point : fit.trade_off) {
    Json entry = misfits_json(point.misfits);
    entry["part_of_fabric"] = point.part_of_fabric;
    entry["values"] = numbers(point.at.values);
    entry["exit"] = point.at.exit;
    account["trade_off"].push_back(entry);
  }
  account["left_out"] = Json::array();
  for (const LeftOut& out : left_out)
    account["left_out"].push_back({{"test", out.name}, {"reason", out.reason}});
  return account;
}

Json held_out(const RecordFolder& folder, const model::ParameterSet& before, const model::ParameterSet& after,
              const model::Choice& form) {
  Json list = Json::array();
  for (const TestRecord& test : folder.tests) {
    if (test.role != Role::predict) continue;
    Json entry{{"test", test.test}, {"seed", test.seed}, {"status", Json::object()}};
    const std::pair<const char*, const model::ParameterSet*> sets[] = {{"before", &before},
                                                                       {"after", &after}};
    for (const auto& [which, set] : sets) {
      Path path = test.path;
      path.start = Start{};
      path.start.nu = test.nu_start;
      model::PredictOptions options;
      options.form = form.form;
      options.terms = form.terms;
      try {
        const auto p = model::predict(*set, path, model::samples_of(test.rows, path, test.nu_start), options);
        entry["status"][which] = model::name_of(p.status.code);
        for (const char* column : {"P", "sigma_dev", "s_dev", "F_dev"})
          entry["errors"][column][which] = number(relative_distance(p.record[column], test.rows[column]));
      } catch (const Error& error) {
        entry["status"][which] = std::string("refused: ") + error.what();
      }
    }
    list.push_back(entry);
  }
  return list;
}

}  // namespace grainlaw::calibrate
