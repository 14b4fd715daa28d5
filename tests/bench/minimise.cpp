// grainlaw_bench_minimise NU... SNAPSHOTS.h5... : what each minimiser costs, in processor time and in passes
// over the contacts, to bring packings back into balance after an affine increment of D2. From each file it
// takes the last frame of about that volume fraction. Prints medians over the files.
#include "grainlaw/dem/balance/minimise.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <exception>
#include <string>
#include <vector>

#include "grainlaw/dem/files/snapshot.hpp"
#include "nonlinear_cg.hpp"

namespace {

using namespace grainlaw;
using namespace grainlaw::dem;

constexpr std::array<double, 3> strains{1e-5, 1e-4, 1e-3}, residuals{1e-4, 1e-8, 1e-12};
constexpr std::array<const char*, 3> methods{"fire", "newton_krylov", "nonlinear_cg"};

double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Balanced to 1e-11.
State rest(const std::string& file, double nu) {
  FrameChoice choice;
  choice.nu = nu;
  const std::vector<Observables> frames = list_frames(file);
  for (std::size_t f = 0; f < frames.size(); ++f)
    if (std::abs(frames[f].nu - nu) < 1e-3) {
      choice.frame = f;
      choice.nu.reset();
    }
  StaticPacking packing(Material{}, read_frame(file, choice));
  MinimiseOptions options;
  options.residual = 1e-11;
  const MinimiseResult result = minimise(packing, options);
  if (result.outcome == Outcome::gave_up) std::printf("# %s: %s\n", file.c_str(), result.text().c_str());
  return packing.state();
}

struct Cost {
  double seconds, passes;
  bool reached;
};

Cost measure(const State& state, double strain, double residual, std::size_t method) {
  StaticPacking packing(Material{}, state);
  const Vec3 before = packing.cell().length();
  packing.deform(Mat3::diagonal({before[0] * std::exp(strain), before[1] * std::exp(-strain), before[2]}));
  MinimiseOptions options;
  options.residual = residual;
  options.method = method == 1 ? Minimiser::newton_krylov : Minimiser::fire;
  options.most_passes = 30'000;
  const double begin = processor_seconds();
  const MinimiseResult r =
      method == 2 ? minimise_by_conjugate_gradients(packing, options) : minimise(packing, options);
  return {processor_seconds() - begin, static_cast<double>(r.evaluations + r.products),
          r.outcome != Outcome::gave_up};
}

void print_medians(std::vector<Cost> costs, const char* method) {
  const std::size_t middle = costs.size() / 2;
  const auto reached = std::count_if(costs.begin(), costs.end(), [](const Cost& c) { return c.reached; });
  std::sort(costs.begin(), costs.end(), [](const Cost& a, const Cost& b) { return a.passes < b.passes; });
  const double passes = costs[middle].passes;
  std::sort(costs.begin(), costs.end(), [](const Cost& a, const Cost& b) { return a.seconds < b.seconds; });
  std::printf(" %-13s %9.4f s %6.0f passes %td of %zu\n", method, costs[middle].seconds, passes, reached,
              costs.size());
}

}  // namespace

int main(int argc, char** argv) try {
  std::vector<double> densities;
  std::vector<std::string> files;
  for (int a = 1; a < argc; ++a)
    if (files.empty() && std::strtod(argv[a], nullptr) > 0)
      densities.push_back(std::strtod(argv[a], nullptr));
    else
      files.push_back(argv[a]);
  if (densities.empty() || files.empty()) {
    std::fprintf(stderr, "usage: %s NU... SNAPSHOTS.h5...\n", argv[0]);
    return 2;
  }
  for (const double nu : densities) {
    std::vector<State> states;
    for (const std::string& file : files) states.push_back(rest(file, nu));
    for (const double strain : strains)
      for (const double residual : residuals) {
        std::printf("N %zu nu %.3f strain %.0e residual %.0e\n", states[0].count(), nu, strain, residual);
        for (std::size_t method = 0; method < methods.size(); ++method) {
          std::vector<Cost> costs;
          for (const State& state : states) costs.push_back(measure(state, strain, residual, method));
          print_medians(std::move(costs), methods[method]);
        }
        std::fflush(stdout);
      }
  }
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
