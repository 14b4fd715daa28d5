// Our side of the comparison with another DEM code (see peer_lammps): writes a packing of ours in LAMMPS's
// data format, or lets it flow in D2 and says how fast that was (in processor time) and what came out. Usage:
//   grainlaw_bench_peer_dem data SNAPSHOTS.h5 FILE
//   grainlaw_bench_peer_dem run SNAPSHOTS.h5 STEPS TIME_STEP (over t_c) RATE (1/us)
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <exception>
#include <string>

#include "grainlaw/dem/drive/drive.hpp"
#include "grainlaw/dem/files/lammps_data.hpp"
#include "grainlaw/dem/files/snapshot.hpp"
#include "grainlaw/dem/step/dynamics.hpp"
#include "grainlaw/element/file.hpp"

namespace {

using namespace grainlaw;

void print(const char* when, const dem::Measurement& m) {
  std::printf("%s stress %.15g %.15g %.15g contacts %.0f\n", when, m.stress[0], m.stress[1], m.stress[2],
              m.contacts);
}

void flow(const dem::State& state, const Material& material, std::uint64_t steps, double fraction,
          double rate) {
  dem::Dynamics dynamics(material, state);
  Leg d2{};
  d2.mode = Mode::d2;
  d2.duration =
      static_cast<double>(steps) * dem::time_step(material, dynamics.grains().smallest_radius(), fraction);
  d2.strain = {-rate * d2.duration, rate * d2.duration, 0};
  d2.profile = Profile::constant;
  dem::StepPlan plan = dem::plan_steps(d2, d2.duration, steps);
  std::printf("dt %.17g\n", plan.dt);
  print("before", dynamics.measure());
  const std::clock_t begin = std::clock();
  dem::drive(dynamics, d2, plan);
  const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  print("after", dynamics.measure());
  std::printf("speed %.6g\n", static_cast<double>(steps * state.count()) / seconds / 1e6);
}

}  // namespace

int main(int count, char** arguments) try {
  if (count < 4) return std::fprintf(stderr, "usage: see the head of peer_dem.cpp\n"), 2;
  const Material material;
  const dem::State state = dem::read_frame(arguments[2], {});
  if (std::strcmp(arguments[1], "data") == 0)
    write_file(arguments[3], dem::lammps_data(state, material));
  else if (count == 6)
    flow(state, material, std::strtoull(arguments[3], nullptr, 10), std::atof(arguments[4]),
         std::atof(arguments[5]));
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
