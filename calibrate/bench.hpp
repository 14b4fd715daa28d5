// A bench of the DEM: which settings of the engine are varied, one at a time, and the runs that show what
// each costs and how far it leads away from the finest.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "grainlaw/calibrate/campaign_plan.hpp"
#include "grainlaw/element/json.hpp"

namespace grainlaw::calibrate {

/// What is varied. The method: increments of minimised energy, one, three and ten to a row, against a flow at
/// the slowest rate; where nothing rearranges, the flow is the one that lags. The step of the gas is that of
/// preparation; it is judged by the packing that comes out.
enum class Knob { time_step, rate, method, gas_step, count };
std::string name_of(Knob knob);  ///< "time_step", …
const std::vector<Knob>& all_knobs();
/// Whether a knob changes the packing, so that runs cannot start from the same one.
bool compares_packings(Knob knob);

/// The tests: D2 and an isotropic unloading from one relaxed packing at nu_start; for the step of the gas,
/// the way to that packing.
enum class BenchTest { iso, d2, preparation };
std::string name_of(BenchTest test);

struct Bench {
  std::int64_t count = 1000;
  std::int64_t seeds = 2;  ///< packings; at least three where packings are compared (gas_step, count)
  std::int64_t twins = 2;  ///< runs per packing, that one grain moved by 1e-7 mm tells apart
  double eps_dev = 0.05;   ///< to which D2 goes
  double nu_end = 0.74;    ///< to which the isotropic unloading goes
  std::vector<Knob> knobs = all_knobs();

  static constexpr double nu_start = 0.75;
  static constexpr double nudge = 1e-7;  ///< mm
  static constexpr std::int64_t rows = 50;

  Json to_json() const;
};

/// The engine's settings of one run. Defaults are those of a scene.
struct BenchSetting {
  int steps = 5;         ///< per smallest contact duration, on the path
  int gas_steps = 20;    ///< the same, during preparation
  double rate = 1;       ///< over the default rate of the mode
  double increment = 0;  ///< of a quasistatic path, which has no rate; 0: dynamics
  std::int64_t count = 0;

  bool operator==(const BenchSetting&) const = default;
};

/// One value of a knob in one test. Runs of one group differ by chance alone; groups (packings) may differ.
struct Variant {
  Knob knob;
  BenchTest test;
  double value;  ///< steps per contact duration, rate over the default, increment (0: flow), grains
  BenchSetting setting;
  std::vector<std::vector<std::string>> records;  ///< names, by group
};

/// All values of a knob in a test; the finest, which the others are compared with, comes last.
struct Sweep {
  Knob knob;
  BenchTest test;
  std::vector<Variant> variants;
};

std::vector<Sweep> sweeps(const Bench& bench);

/// The runs of all sweeps, each once; those of a packing wait for its preparation.
std::vector<Job> plan(const Bench& bench);

/// The name of a twin's snapshot beside its packing's snapshots.h5; the first twin is the packing itself.
std::string twin_file(std::int64_t twin);

}  // namespace grainlaw::calibrate
