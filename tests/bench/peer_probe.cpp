// Our side of peer_probe: the four moduli of a packing by linear response, and by probe tests with the
// engine: strain applied slowly, then rest, until the stress stands still. Usage:
//
//   grainlaw_bench_peer_probe SNAPSHOTS.h5 NU AMPLITUDE FOLDER
//
// takes the last frame at NU, brings it into balance and writes FOLDER/packing.data for LAMMPS. Prints what
// it took (processor seconds; us of simulated time) and what came out, one name and number a line, moduli
// over k*.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <string>

#include "grainlaw/dem/balance/minimise.hpp"
#include "grainlaw/dem/drive/drive.hpp"
#include "grainlaw/dem/files/lammps_data.hpp"
#include "grainlaw/dem/files/snapshot.hpp"
#include "grainlaw/dem/step/dynamics.hpp"
#include "grainlaw/dem/stiffness/linear_response.hpp"
#include "grainlaw/dem/stiffness/probe.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/element/file.hpp"
#include "stress_differences.hpp"

namespace {

using namespace grainlaw;
using namespace grainlaw::dem;

constexpr StrainTensor d2{-1, 1, 0};
constexpr double straining = 100, window = 50, longest = 5000;  // us
constexpr double still = 1e-3;    // change of stress in a window over amplitude and k*, twice in a row
constexpr double fraction = 0.2;  // of t_c: the default step
constexpr int turns = 5;          // of linear response

double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

StaticPacking balanced(const std::string& file, double nu, const Material& material) {
  FrameChoice choice;
  const std::vector<Observables> frames = list_frames(file);
  for (std::size_t f = 0; f < frames.size(); ++f)
    if (std::abs(frames[f].nu - nu) < 1e-3) choice.frame = f;
  if (!choice.frame) throw Error(file, "", "has no frame at this nu");
  StaticPacking packing(material, read_frame(file, choice));
  MinimiseOptions options;
  options.residual = 1e-11;
  const MinimiseResult result = minimise(packing, options);
  if (result.outcome == Outcome::gave_up || !result.balance.jammed)
    throw Error(file, "", "its packing is " + result.text());
  return packing;
}

/// Seconds of the turn in the middle.
double time_linear_response(StaticPacking& packing, LinearResponse& response) {
  std::array<double, turns> seconds{};
  for (double& s : seconds) {
    const double begin = processor_seconds();
    response = linear_response(packing);
    s = processor_seconds() - begin;
  }
  std::sort(seconds.begin(), seconds.end());
  return seconds[turns / 2];
}

double largest_change(const Sym6& a, const Sym6& b) {
  double largest = 0;
  for (std::size_t c = 0; c < 6; ++c) largest = std::max(largest, std::abs(a[c] - b[c]));
  return largest;
}

/// Stress after the strain, and the us of rest that it took.
Sym6 probed(const State& state, const Material& material, const StrainTensor& strain, double amplitude,
            double& resting) {
  Dynamics dynamics(material, state);
  Leg leg{};
  leg.mode = Mode::components;
  leg.strain = strain;
  leg.duration = straining;
  leg.profile = Profile::cosine;
  const double dt = time_step(material, dynamics.grains().smallest_radius(), fraction);
  drive(dynamics, leg, plan_steps(leg, dt, 1));
  Sym6 last = dynamics.measure().stress;
  const auto steps = static_cast<int>(window / dynamics.dt());
  int quiet = 0;
  for (resting = 0; quiet < 2 && resting < longest; resting += window) {
    for (int n = 0; n < steps; ++n) dynamics.step();
    const Sym6 stress = dynamics.measure().stress;
    quiet = largest_change(stress, last) < still * amplitude * material.stress_unit() ? quiet + 1 : 0;
    last = stress;
  }
  return last;
}

StrainTensor scaled(double factor, StrainTensor strain) {
  for (double& component : strain) component *= factor;
  return strain;
}

struct Slopes {
  double of_pressure, of_deviator;
};

/// By central difference over both signs; adds to the simulated time.
Slopes slopes(const State& state, const Material& material, const StrainTensor& strain, double amplitude,
              double& resting) {
  double forth = 0, back = 0;
  Sym6 change = probed(state, material, scaled(amplitude, strain), amplitude, forth);
  const Sym6 other = probed(state, material, scaled(-amplitude, strain), amplitude, back);
  for (std::size_t c = 0; c < 6; ++c) change[c] -= other[c];
  resting += forth + back;
  const double unit = 2 * amplitude * material.stress_unit();
  return {trace(change) / 3 / unit, deviator_along(change, d2) / unit};
}

void print(const char* which, const Moduli& m, double unit) {
  std::printf("%s_B %.6f\n%s_A1 %.6f\n%s_A2 %.6f\n%s_G_oct %.6f\n", which, m.B / unit, which, m.A1 / unit,
              which, m.A2 / unit, which, m.G_oct / unit);
}

}  // namespace

int main(int count, char** arguments) try {
  if (count != 5) return std::fprintf(stderr, "usage: see the head of peer_probe.cpp\n"), 2;
  const Material material;
  const double nu = std::atof(arguments[2]), amplitude = std::atof(arguments[3]);
  StaticPacking packing = balanced(arguments[1], nu, material);
  const State state = packing.state();
  write_file(std::string(arguments[4]) + "/packing.data", lammps_data(state, material));
  LinearResponse response;
  std::printf("grains %zu\nlinear_seconds %.4f\n", packing.count(), time_linear_response(packing, response));
  std::printf("iterations %llu\n", static_cast<unsigned long long>(response.iterations));
  double resting = 0;
  const double begin = processor_seconds();
  const Slopes volume = slopes(state, material, {1.0 / 3, 1.0 / 3, 1.0 / 3}, amplitude, resting);
  const double half = 1 / std::sqrt(3.0);
  const Slopes shear = slopes(state, material, {-half, half, 0}, amplitude, resting);
  std::printf("dynamic_seconds %.3f\nstraining_us %g\nresting_us %g\n", processor_seconds() - begin,
              straining, resting);
  std::printf(
      "contact_duration_us %.17g\n",
      time_step(material, *std::min_element(state.radius.begin(), state.radius.end()), fraction) / fraction);
  print("linear", moduli_of(response.stress, d2), material.stress_unit());
  print("dynamic", {volume.of_pressure, shear.of_pressure, volume.of_deviator, shear.of_deviator}, 1);
  const double then = processor_seconds();
  const Stiffness differences = differences_at(packing, 1e-7);
  const Distance all = distance(differences, response.stress);
  Stiffness bare = differences;  // less what the prestress makes of it: the 21 constants, each twice
  for (std::size_t a = 0; a < 6; ++a)
    for (std::size_t b = 0; b < 6; ++b) bare[a][b] += response.energy[a][b] - response.stress[a][b];
  const Distance each = distance(bare, response.energy);
  std::printf("difference %.2e\ndifference_of_each %.2e\nsize_there %.2e\n", all.of_largest, each.of_each,
              each.there);
  std::printf("difference_seconds %.2f\n", processor_seconds() - then);
  for (const double sign : {1.0, -1.0}) {
    const Probe probe = dem::probe(packing, d2, sign * amplitude);
    std::printf("contacts_changed %llu\n", static_cast<unsigned long long>(probe.changed.both()));
  }
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
