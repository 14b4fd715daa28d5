// The parts of time_to_result that need the engine: a packing as LAMMPS data, and what LAMMPS's dumps of it
// hold, measured as we measure our own. Usage:
//
//   grainlaw_bench_time_to_result data SNAPSHOTS.h5 NU FILE
//     writes FILE, prints steps, dt and the frame's segment
//   grainlaw_bench_time_to_result rows SNAPSHOTS.h5 NU DUMP
//     prints the rows of record.csv for that dump
//
// The flow is D2 at the thesis's rate to eps_dev = 0.4 in 200 rows, with a step of t_c/50.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <fstream>
#include <sstream>
#include <string>

#include "grainlaw/dem/drive/drive.hpp"
#include "grainlaw/dem/files/lammps_data.hpp"
#include "grainlaw/dem/files/snapshot.hpp"
#include "grainlaw/dem/record/row_writer.hpp"
#include "grainlaw/dem/step/dynamics.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/element/file.hpp"

namespace {

using namespace grainlaw;

constexpr double rate = 2.839e-5, eps_dev = 0.4, fraction = 0.02;
constexpr std::uint64_t rows = 200;

Leg flow() {
  Leg d2{};
  d2.mode = Mode::d2;
  d2.eps_dev[1] = eps_dev;
  d2.duration = eps_dev / std::sqrt(3.0) / rate;
  d2.strain = {-rate * d2.duration, rate * d2.duration, 0};
  d2.profile = Profile::constant;
  return d2;
}

/// At t_c/50, and as many steps between any two rows.
dem::StepPlan steps_of(const dem::State& state, const Material& material) {
  const double smallest = *std::min_element(state.radius.begin(), state.radius.end());
  dem::StepPlan plan = dem::plan_steps(flow(), dem::time_step(material, smallest, fraction), 1);
  plan.steps = (plan.steps + rows - 1) / rows * rows;
  plan.dt = flow().duration / static_cast<double>(plan.steps);
  return plan;
}

/// The frame at `nu`, on the last segment that the file has: the unloading branch of a cycle.
dem::Frame packing(const char* file, const char* nu) {
  dem::FrameChoice choice;
  choice.nu = std::atof(nu);
  choice.segment = dem::list_frames(file).back().segment;
  return dem::read_whole_frame(file, choice);
}

void write_data(const dem::Frame& frame, const Material& material, const char* file) {
  write_file(file, dem::lammps_data(frame.state, material));
  const dem::StepPlan plan = steps_of(frame.state, material);
  std::printf("%llu %.17g %llu\n", static_cast<unsigned long long>(plan.steps), plan.dt,
              static_cast<unsigned long long>(frame.observables.segment));
}

/// Reads the next frame of a dump of id, place and velocity; the velocity becomes that beyond the flow.
bool read_dump(std::istream& in, dem::State& state) {
  std::string line;
  if (!std::getline(in, line)) return false;
  std::getline(in, line);
  state.step = std::strtoull(line.c_str(), nullptr, 10);
  for (int skip = 0; skip < 3; ++skip) std::getline(in, line);
  std::array<double, 3> low{};
  for (std::size_t c = 0; c < 3; ++c) {
    std::getline(in, line);
    std::istringstream ends(line);
    double high = 0;
    ends >> low[c] >> high;
    state.box(c, c) = high - low[c];
  }
  std::getline(in, line);
  const dem::Vec3 growth{rate, -rate, 0};
  for (std::size_t n = 0; n < state.count() && std::getline(in, line); ++n) {
    char* at = line.data();
    const std::size_t i = std::strtoull(at, &at, 10) - 1;
    for (double& x : state.position.at(i)) x = std::strtod(at, &at);
    for (double& v : state.velocity.at(i)) v = std::strtod(at, &at);
    for (std::size_t c = 0; c < 3; ++c) {
      state.position[i][c] -= low[c];
      state.velocity[i][c] -= growth[c] * (state.position[i][c] - state.box(c, c) / 2);
    }
  }
  return static_cast<bool>(in);
}

void print_rows(dem::State state, const Material& material, const char* file) {
  std::ifstream dump(file);
  if (!dump) throw Error(file, "", "cannot be read");
  const dem::StepPlan plan = steps_of(state, material);
  dem::RowWriter writer(material, {flow()}, state.volume_fraction());
  std::uint64_t next = 0;  // a run that was gone on with may have written a frame twice
  while (read_dump(dump, state)) {
    if (state.step != next) continue;
    next += plan.steps / rows;
    dem::Dynamics dynamics(material, state);
    dynamics.start(plan.dt, {rate, -rate, 0});
    const double progress = static_cast<double>(state.step) / static_cast<double>(plan.steps);
    writer.append(dynamics, 0, progress * eps_dev, static_cast<double>(state.step) * plan.dt);
  }
  std::fputs(writer.record().to_csv().c_str(), stdout);
}

}  // namespace

int main(int count, char** arguments) try {
  if (count != 5) return std::fprintf(stderr, "usage: see the head of time_to_result.cpp\n"), 2;
  const Material material;
  const dem::Frame frame = packing(arguments[2], arguments[3]);
  if (std::strcmp(arguments[1], "data") == 0)
    write_data(frame, material, arguments[4]);
  else
    print_rows(frame.state, material, arguments[4]);
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
