// The runs of a bench: one knob at a time, each run once, each packing before those that start from it.
#include "grainlaw/calibrate/bench.hpp"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "grainlaw/calibrate/campaign.hpp"
#include "grainlaw/dem/drive/quasistatic.hpp"
#include "grainlaw/dem/scene/scene.hpp"

namespace grainlaw::calibrate {
namespace {

std::map<std::string, Json> scenes_of(const std::vector<Job>& jobs) {
  std::map<std::string, Json> scenes;
  for (const Job& job : jobs) scenes[job.record] = job.scene;
  return scenes;
}

TEST(Bench, RunsEachTestOnceAfterItsPacking) {
  const std::vector<Job> jobs = plan(Bench{});
  std::set<std::string> names;
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    EXPECT_TRUE(names.insert(jobs[i].record).second) << jobs[i].record;
    EXPECT_GT(jobs[i].particle_steps, 0);
    const bool from_snapshot = jobs[i].scene.at("preparation").contains("snapshot");
    ASSERT_EQ(jobs[i].needs.has_value(), from_snapshot) << jobs[i].record;
    if (!from_snapshot) continue;
    ASSERT_LT(*jobs[i].needs, i);
    const auto snapshot = jobs[i].scene.at("preparation").at("snapshot").get<std::string>();
    EXPECT_TRUE(snapshot.starts_with("../" + jobs[*jobs[i].needs].record + "/")) << snapshot;
  }
}

TEST(Bench, HasARunForEveryRecordThatASweepNames) {
  const Bench bench;
  const auto scenes = scenes_of(plan(bench));
  std::set<std::string> named;
  for (const Sweep& sweep : sweeps(bench))
    for (const Variant& variant : sweep.variants)
      for (const auto& group : variant.records) {
        EXPECT_GE(group.size(), 2u);  // or chance could not be told
        for (const std::string& name : group) {
          EXPECT_EQ(scenes.count(name), 1u) << name;
          named.insert(name);
        }
      }
  for (const auto& [name, scene] : scenes)  // what is run and not read is a packing
    EXPECT_TRUE(named.count(name) == 1 || !scene.at("preparation").contains("snapshot")) << name;
}

/// The keys in which two scenes differ.
std::set<std::string> differences(const Json& a, const Json& b, const std::string& at = "") {
  if (a == b) return {};
  if (a.type() != b.type() || !(a.is_object() || a.is_array()) || a.size() != b.size()) return {at};
  std::set<std::string> all;
  for (const auto& [key, value] : a.items()) {
    const Json& other = a.is_array() ? b.at(std::stoul(key)) : b.at(key);
    all.merge(differences(value, other, at.empty() ? key : at + "." + key));
  }
  return all;
}

TEST(Bench, VariesOneThingAtATime) {
  const Bench bench;
  const auto scenes = scenes_of(plan(bench));
  const std::map<Knob, std::set<std::string>> varied{{Knob::time_step, {"measure.time_step"}},
                                                     {Knob::rate, {"path.segments.0.rate"}},
                                                     {Knob::method, {"path.segments.0.increment"}},
                                                     {Knob::gas_step, {"measure.time_step_gas"}},
                                                     {Knob::count, {"preparation.snapshot"}}};
  for (const Sweep& sweep : sweeps(bench))
    for (std::size_t i = 1; i < sweep.variants.size(); ++i) {
      // What quasistatic segments are held against has other keys altogether.
      const std::set<std::string> segment{"path.segments.0"};
      const bool other_method = sweep.knob == Knob::method && sweep.variants[i].setting.increment == 0;
      EXPECT_EQ(
          differences(scenes.at(sweep.variants[i].records[0][0]), scenes.at(sweep.variants[0].records[0][0])),
          other_method ? segment : varied.at(sweep.knob))
          << name_of(sweep.knob);
    }
}

TEST(Bench, IncrementsAreOneThreeAndTenToARowOfEitherTest) {
  for (const auto& [eps_dev, nu_end] : {std::pair{0.05, 0.74}, {0.02, 0.748}, {0.1, 0.6}, {0.001, 0.7499}}) {
    Bench bench;
    bench.knobs = {Knob::method};
    bench.eps_dev = eps_dev;
    bench.nu_end = nu_end;
    const auto scenes = scenes_of(plan(bench));
    const std::vector<Sweep> both = sweeps(bench);
    ASSERT_EQ(both.size(), 2u);
    for (const Sweep& sweep : both) {
      std::vector<std::uint64_t> to_a_row;
      for (const Variant& variant : sweep.variants) {
        if (variant.value == 0) continue;
        const Json& json = scenes.at(variant.records[0][0]);
        const Leg leg = dem::Scene::read(Reader(json, ""), "").legs(Bench::nu_start).at(0);
        to_a_row.push_back(dem::plan_increments(leg, Bench::rows).steps / Bench::rows);
      }
      EXPECT_EQ(to_a_row, (std::vector<std::uint64_t>{1, 3, 10})) << name_of(sweep.test) << " " << nu_end;
    }
  }
}

TEST(Bench, MethodsAndRatesAreHeldAgainstTheSameFlow) {
  std::map<BenchTest, std::set<std::string>> finest;
  for (const Sweep& sweep : sweeps(Bench{}))
    if (sweep.knob == Knob::method || sweep.knob == Knob::rate)
      finest[sweep.test].insert(sweep.variants.back().records[0][0]);
  ASSERT_EQ(finest.size(), 2u);
  for (const auto& [test, names] : finest) EXPECT_EQ(names.size(), 1u) << name_of(test);
}

TEST(Bench, TheFinestValueComesLastAndCostsMost) {
  const Bench bench;
  std::map<std::string, double> work;
  for (const Job& job : plan(bench)) work[job.record] = job.particle_steps;
  for (const Sweep& sweep : sweeps(bench))
    for (std::size_t i = 1; i < sweep.variants.size(); ++i) {
      if (sweep.knob == Knob::method && i + 1 == sweep.variants.size()) continue;  // the flow may cost less
      EXPECT_GT(work.at(sweep.variants[i].records[0][0]), work.at(sweep.variants[i - 1].records[0][0]))
          << name_of(sweep.knob) << " " << i;
    }
}

TEST(Bench, OneOfTheValuesIsTheDefault) {
  const Bench bench;
  BenchSetting recommended;
  recommended.count = bench.count;
  for (const Sweep& sweep : sweeps(bench)) {
    if (sweep.knob == Knob::method) continue;  // held against a slower flow
    std::size_t found = 0;
    for (const Variant& variant : sweep.variants)
      if (variant.setting == recommended) ++found;
    EXPECT_EQ(found, 1u) << name_of(sweep.knob);
  }
  const dem::Measure measure;
  EXPECT_EQ(measure.time_step, 1.0 / recommended.steps);
  EXPECT_EQ(measure.time_step_gas, 1.0 / recommended.gas_steps);
}

TEST(Bench, TwinsStartFromSnapshotsOfTheirOwn) {
  Bench bench;
  bench.twins = 3;
  std::set<std::string> starts;
  const auto scenes = scenes_of(plan(bench));
  const std::vector<Sweep> all = sweeps(bench);
  for (const std::string& name : all.front().variants.front().records.front())
    starts.insert(scenes.at(name).at("preparation").at("snapshot").get<std::string>());
  EXPECT_EQ(starts.size(), 3u);
}

}  // namespace
}  // namespace grainlaw::calibrate
