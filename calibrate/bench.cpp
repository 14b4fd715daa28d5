#include "grainlaw/calibrate/bench.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "grainlaw/dem/drive/quasistatic.hpp"
#include "grainlaw/dem/drive/stage.hpp"
#include "grainlaw/dem/scene/scene.hpp"
#include "grainlaw/element/short_text.hpp"

namespace grainlaw::calibrate {

namespace {

constexpr double d2_rate = 2.839e-5, iso_rate = 5.0e-6;  // 1/us, the defaults of a path
constexpr double compression_rate = 5e-5;                // of the packing, from 0.64 to nu_start
constexpr std::int64_t fewest_packings = 3;              // where packings are compared
constexpr double slowest = 0.1;                          // rate over the default
constexpr double balance = 1e-9;                         // residual of the packing, so that it does not creep
constexpr int name_digits = 6;
constexpr double relaxation_share = 0.3;  // of its longest duration that a relaxation takes

std::string packing_name(const BenchSetting& setting, std::int64_t seed) {
  return "packing-n" + std::to_string(setting.count) + "-gas" + std::to_string(setting.gas_steps) + "-s" +
         std::to_string(seed);
}

std::string run_name(BenchTest test, const BenchSetting& setting, std::int64_t seed, std::int64_t twin) {
  if (test == BenchTest::preparation) return packing_name(setting, seed);
  const std::string how = setting.increment > 0 ? "-increment" + short_text(setting.increment, name_digits)
                                                : "-step" + std::to_string(setting.steps) + "-rate" +
                                                      short_text(setting.rate, name_digits);
  return name_of(test) + "-n" + std::to_string(setting.count) + how + "-s" + std::to_string(seed) + "-t" +
         std::to_string(twin);
}

/// The largest component of the strain between two rows of a test.
double strain_of_a_row(const Bench& bench, BenchTest test) {
  const double strain = test == BenchTest::d2 ? bench.eps_dev / std::numbers::sqrt3
                                              : std::log(Bench::nu_start / bench.nu_end) / 3;
  return strain / Bench::rows;
}

/// The strain of an increment where `many` of them make a row: three digits, the last one rounded up, so that
/// there are no more of them.
double increment_of(const Bench& bench, BenchTest test, int many) {
  const double strain = strain_of_a_row(bench, test) / many;
  const double digit = std::pow(10, std::floor(std::log10(strain)) - 2);
  return std::stod(short_text(std::ceil(strain / digit) * digit, name_digits));
}

/// The values of a knob, the finest last.
std::vector<double> values_of(Knob knob, BenchTest test, const Bench& bench) {
  const auto n = static_cast<double>(bench.count);
  switch (knob) {
    case Knob::time_step:
      return {5, 10, 20, 50, 200};
    case Knob::rate:
      return {30, 10, 3, 1, 0.3, slowest};
    case Knob::method:
      return {increment_of(bench, test, 1), increment_of(bench, test, 3), increment_of(bench, test, 10), 0};
    case Knob::gas_step:
      return {5, 10, 20, 50, 100};
    case Knob::count:
      return {std::floor(n / 4), std::floor(n / 2), n, 2 * n, 4 * n};
  }
  return {};
}

BenchSetting setting_of(Knob knob, double value, std::int64_t count) {
  BenchSetting setting;
  setting.count = count;
  switch (knob) {
    case Knob::time_step:
      setting.steps = static_cast<int>(value);
      break;
    case Knob::rate:
      setting.rate = value;
      break;
    case Knob::method:
      setting.increment = value;
      if (value == 0) setting.rate = slowest;
      break;
    case Knob::gas_step:
      setting.gas_steps = static_cast<int>(value);
      break;
    case Knob::count:
      setting.count = static_cast<std::int64_t>(value);
      break;
  }
  return setting;
}

std::vector<BenchTest> tests_of(Knob knob) {
  if (knob == Knob::gas_step) return {BenchTest::preparation};
  return {BenchTest::iso, BenchTest::d2};
}

std::vector<std::vector<std::string>> records_of(const Bench& bench, Knob knob, BenchTest test,
                                                 const BenchSetting& setting) {
  std::vector<std::vector<std::string>> groups;
  if (compares_packings(knob)) {
    groups.emplace_back();
    for (std::int64_t seed = 1; seed <= std::max(bench.seeds, fewest_packings); ++seed)
      groups.back().push_back(run_name(test, setting, seed, 0));
    return groups;
  }
  for (std::int64_t seed = 1; seed <= bench.seeds; ++seed) {
    groups.emplace_back();
    for (std::int64_t twin = 0; twin < bench.twins; ++twin)
      groups.back().push_back(run_name(test, setting, seed, twin));
  }
  return groups;
}

Json measure_json(const BenchSetting& setting, Json snapshots) {
  return {{"rows", Bench::rows},
          {"snapshots", std::move(snapshots)},
          {"time_step", 1.0 / setting.steps},
          {"time_step_gas", 1.0 / setting.gas_steps}};
}

/// The packing that tests start from: the same for all of them that have its number of grains and gas step.
Json packing_scene(const BenchSetting& test, std::int64_t seed) {
  BenchSetting setting;
  setting.count = test.count;
  setting.gas_steps = test.gas_steps;
  const Json path{{"segments",
                   {{{"mode", "iso"}, {"controls", {{"nu", Bench::nu_start}}}, {"rate", compression_rate}},
                    {{"mode", "relax"}, {"residual", balance}}}}};
  return {{"preparation", {{"count", setting.count}, {"seed", seed}}},
          {"path", path},
          {"measure", measure_json(setting, {{{"segment", 1}}})}};
}

Json test_scene(const Bench& bench, BenchTest test, const BenchSetting& setting, std::int64_t seed,
                std::int64_t twin) {
  const bool is_d2 = test == BenchTest::d2;
  Json segment{{"mode", is_d2 ? "d2" : "iso"}};
  segment["controls"] = is_d2 ? Json{{"eps_dev", bench.eps_dev}} : Json{{"nu", bench.nu_end}};
  if (setting.increment > 0) {
    segment["profile"] = "quasistatic";
    segment["increment"] = setting.increment;
  } else {
    segment["rate"] = setting.rate * (is_d2 ? d2_rate : iso_rate);
  }
  const std::string snapshot =
      "../" + packing_name(setting, seed) + "/" + (twin == 0 ? "snapshots.h5" : twin_file(twin));
  return {{"preparation", {{"snapshot", snapshot}}},
          {"path", {{"segments", Json::array({segment})}}},
          {"measure", measure_json(setting, Json::array())}};
}

/// Grains times steps, preparation included.
double estimate(const dem::Scene& scene, const BenchSetting& setting) {
  const double contact = scene.material.contact_duration(scene.material.r_min());
  const auto* packing = std::get_if<dem::NewPacking>(&scene.preparation);
  double steps = dem::expected_passes(scene.legs(packing != nullptr ? packing->nu : Bench::nu_start),
                                      scene.measure, contact);
  if (packing != nullptr)
    steps += (std::log(packing->nu / packing->nu_gas) / 3 / packing->rate +
              relaxation_share * packing->relax.duration) /
             (scene.measure.time_step_gas * contact);
  return steps * static_cast<double>(setting.count);
}

/// Adds runs, each once, after the packing they start from.
class JobList {
 public:
  explicit JobList(const Bench& bench) : bench_(bench) {}

  void add(BenchTest test, const BenchSetting& setting, std::int64_t seed, std::int64_t twin) {
    if (test == BenchTest::preparation) {
      add(packing_name(setting, seed), packing_scene(setting, seed), setting, seed, std::nullopt);
      return;
    }
    const std::size_t packing =
        add(packing_name(setting, seed), packing_scene(setting, seed), setting, seed, std::nullopt);
    add(run_name(test, setting, seed, twin), test_scene(bench_, test, setting, seed, twin), setting, seed,
        packing);
  }
  std::vector<Job> take() { return std::move(jobs_); }

 private:
  std::size_t add(const std::string& name, const Json& json, const BenchSetting& setting, std::int64_t seed,
                  std::optional<std::size_t> needs) {
    const auto [known, is_new] = index_.try_emplace(name, jobs_.size());
    if (!is_new) return known->second;
    const dem::Scene scene = dem::Scene::read(Reader(json, name), "");
    jobs_.push_back({name, 0, seed, needs, scene.to_json(), estimate(scene, setting)});
    return known->second;
  }

  const Bench& bench_;
  std::vector<Job> jobs_;
  std::map<std::string, std::size_t> index_;
};

}  // namespace

std::string name_of(Knob knob) {
  switch (knob) {
    case Knob::time_step:
      return "time_step";
    case Knob::rate:
      return "rate";
    case Knob::method:
      return "method";
    case Knob::gas_step:
      return "gas_step";
    case Knob::count:
      return "count";
  }
  return "";
}

const std::vector<Knob>& all_knobs() {
  static const std::vector<Knob> list{Knob::time_step, Knob::rate, Knob::method, Knob::gas_step, Knob::count};
  return list;
}

bool compares_packings(Knob knob) { return knob == Knob::gas_step || knob == Knob::count; }

std::string name_of(BenchTest test) {
  switch (test) {
    case BenchTest::iso:
      return "iso";
    case BenchTest::d2:
      return "d2";
    case BenchTest::preparation:
      return "preparation";
  }
  return "";
}

std::string twin_file(std::int64_t twin) { return "twin-" + std::to_string(twin) + ".h5"; }

Json Bench::to_json() const {
  Json names = Json::array();
  for (const Knob knob : knobs) names.push_back(name_of(knob));
  return {{"count", count},     {"seeds", seeds},   {"twins", twins},
          {"eps_dev", eps_dev}, {"nu_end", nu_end}, {"knobs", names}};
}

std::vector<Sweep> sweeps(const Bench& bench) {
  std::vector<Sweep> list;
  for (const Knob knob : bench.knobs) {
    const std::vector<BenchTest> tests = tests_of(knob);
    for (const BenchTest test : tests) {
      Sweep sweep{knob, test, {}};
      for (const double value : values_of(knob, test, bench)) {
        const BenchSetting setting = setting_of(knob, value, bench.count);
        sweep.variants.push_back({knob, test, value, setting, records_of(bench, knob, test, setting)});
      }
      list.push_back(std::move(sweep));
    }
  }
  return list;
}

std::vector<Job> plan(const Bench& bench) {
  JobList jobs(bench);
  for (const Sweep& sweep : sweeps(bench))
    for (const Variant& variant : sweep.variants) {
      const bool packings = compares_packings(sweep.knob);
      const std::int64_t seeds = packings ? std::max(bench.seeds, fewest_packings) : bench.seeds;
      for (std::int64_t seed = 1; seed <= seeds; ++seed)
        for (std::int64_t twin = 0; twin < (packings ? 1 : bench.twins); ++twin)
          jobs.add(sweep.test, variant.setting, seed, twin);
    }
  return jobs.take();
}

}  // namespace grainlaw::calibrate
