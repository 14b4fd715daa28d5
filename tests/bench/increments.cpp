// grainlaw_bench_increments [N [SEEDS [STRAIN [NU...]]]] : quasi-static D2 by fixed increments, and by
// increments that stop at the first rearrangement. Cost and error of P and s_dev of each, against the finest
// fixed ones.
//
// An increment that adapts is taken where it dissipates nothing: the work of the box goes into elastic energy
// but for `lossless` of it, as between rearrangements. Else it is tried again with half the strain, from the
// balance before it. Where that has become `smallest`, a rearrangement is met, and this increment passes it.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <string>
#include <vector>

#include "grainlaw/dem/balance/minimise.hpp"
#include "random_packing.hpp"

namespace {

using namespace grainlaw;
using namespace grainlaw::dem;

constexpr int rows = 20;
constexpr double residual = 1e-8;
constexpr double lossless = 1e-6;  // of the elastic energy, in an increment

double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// A packing in a box that was sheared from `start`, at this logarithmic strain of x and -y.
struct Shear {
  StaticPacking packing;
  Mat3 start;
  double at = 0;
};

void strain_to(Shear& shear, double strain) {
  shear.packing.deform(Mat3::diagonal({std::exp(strain), std::exp(-strain), 1.0}) * shear.start);
  shear.at = strain;
}

struct Run {
  std::vector<double> P, s;
  double seconds = 0, passes = 0;
  int increments = 0, rearrangements = 0;
};

void add_row(const Shear& shear, Run& run) {
  const Sym6 q = shear.packing.measure().stress;
  const double P = (q[0] + q[1] + q[2]) / 3;
  run.P.push_back(P / Material{}.stress_unit());
  run.s.push_back(std::sqrt(3.0) / 2 * (q[1] - q[0]) / P);
}

double passes_of(const MinimiseResult& result) {
  return static_cast<double>(result.evaluations + result.products);
}

MinimiseResult balance(StaticPacking& packing, Minimiser method = Minimiser::fire) {
  MinimiseOptions options;
  options.method = method;
  options.residual = residual;
  options.most_passes = 1'000'000;
  return minimise(packing, options);
}

/// `go(shear, to, run)` takes the packing to each row's strain.
using Way = std::function<void(Shear&, double, Run&)>;

Run follow(Shear shear, double strain, const Way& go) {
  Run run;
  const double begin = processor_seconds();
  for (int row = 1; row <= rows; ++row) {
    go(shear, strain * row / rows, run);
    add_row(shear, run);
  }
  run.seconds = processor_seconds() - begin;
  return run;
}

Way fixed(double increment) {
  return [increment](Shear& shear, double to, Run& run) {
    const double from = shear.at;
    const int steps = std::max(1, static_cast<int>(std::ceil((to - from) / increment * (1 - 1e-12))));
    for (int n = 1; n <= steps; ++n) {
      strain_to(shear, n == steps ? to : from + (to - from) * n / steps);
      run.passes += passes_of(balance(shear.packing));
      ++run.increments;
    }
  };
}

/// Of a packing in balance.
struct Point {
  double energy, volume, across;  ///< across: sigma_yy - sigma_xx, what a strain of -x and y works against

  explicit Point(const StaticPacking& packing)
      : energy(packing.network().energy), volume(packing.cell().volume()) {
    const Sym6 q = packing.measure().stress;
    across = q[1] - q[0];
  }
};

/// What of the work between two balances is not in the elastic energy, over that energy. The trapezoid errs
/// by the third power of the increment.
double dissipated(const Point& before, const Point& after, double strain) {
  const double work = before.volume * strain * (before.across + after.across) / 2;
  return (work - (after.energy - before.energy)) / after.energy;
}

Way adaptive(Minimiser method, double smallest, double largest) {
  return [method, smallest, largest, increment = largest](Shear& shear, double to, Run& run) mutable {
    while (shear.at < to) {
      const double left = to - shear.at, step = std::min(increment, left);
      Shear trial = shear;
      strain_to(trial, step < left ? shear.at + step : to);
      run.passes += passes_of(balance(trial.packing, method));
      const bool smooth = std::abs(dissipated(Point(shear.packing), Point(trial.packing), step)) <= lossless;
      if (smooth || step <= smallest) {
        run.rearrangements += smooth ? 0 : 1;
        shear = std::move(trial);
        ++run.increments;
        increment = smooth ? std::min(2 * std::max(increment, step), largest) : increment;
      } else {
        increment = std::max(step / 2, smallest);
      }
    }
  };
}

double distance(const std::vector<double>& a, const std::vector<double>& b) {
  double d = 0, size = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    d += (a[i] - b[i]) * (a[i] - b[i]);
    size += b[i] * b[i];
  }
  return std::sqrt(d / size);
}

/// A packing that was squeezed to 0.84 and let out to nu.
Shear unloaded(std::int64_t count, std::uint64_t seed, double nu) {
  Shear shear{random_packing(Material{}, count, seed, 0.84, residual), {}};
  const Mat3 dense = shear.packing.cell().edges();
  constexpr int steps = 100;
  for (int n = 1; n <= steps; ++n) {
    shear.packing.deform(std::cbrt(std::pow(0.84 / nu, static_cast<double>(n) / steps)) * dense);
    balance(shear.packing);
  }
  shear.start = shear.packing.cell().edges();
  return shear;
}

/// As it is, but for shifts of 1e-7 mm: what chance alone makes.
Shear shaken(const Shear& shear) {
  State state = shear.packing.state();
  for (std::size_t i = 0; i < state.count(); ++i) state.position[i][i % 3] += i % 2 == 0 ? 1e-7 : -1e-7;
  Shear other{StaticPacking(Material{}, state), shear.start};
  balance(other.packing);
  return other;
}

void print(const std::string& name, const Run& run, const Run& finest) {
  std::printf("  %-32s %8.2f s %9.0f passes %6d increments %4d rearrangements  error P %.1e s_dev %.1e\n",
              name.c_str(), run.seconds, run.passes, run.increments, run.rearrangements,
              distance(run.P, finest.P), distance(run.s, finest.s));
  std::fflush(stdout);
}

void compare(const Shear& shear, double strain) {
  const Run finest = follow(shear, strain, fixed(strain / 2000));
  print("fixed, strain/2000", finest, finest);
  print("  shaken by 1e-7 mm", follow(shaken(shear), strain, fixed(strain / 2000)), finest);
  for (const int parts : {400, 100, 20})
    print("fixed, strain/" + std::to_string(parts), follow(shear, strain, fixed(strain / parts)), finest);
  const auto adapt = [&](const char* name, Minimiser method, double parts) {
    print("adapting to strain/" + std::to_string(static_cast<int>(parts)) + name,
          follow(shear, strain, adaptive(method, strain / parts, strain / rows)), finest);
  };
  adapt("", Minimiser::fire, 2000);
  adapt(", Newton", Minimiser::newton_krylov, 2000);
  adapt("", Minimiser::fire, 20000);
}

}  // namespace

int main(int argc, char** argv) try {
  const std::int64_t count = argc > 1 ? std::atoll(argv[1]) : 1000;
  const std::uint64_t seeds = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 2;
  const double longest = argc > 3 ? std::atof(argv[3]) : 1e-2;
  std::vector<double> densities;
  for (int a = 4; a < argc; ++a) densities.push_back(std::atof(argv[a]));
  if (densities.empty()) densities = {0.67, 0.70, 0.75, 0.82};
  for (const double nu : densities)
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
      const Shear shear = unloaded(count, seed, nu);
      for (const double strain : {1e-5, longest}) {
        std::printf("N %ld, seed %lu, nu %.2f, D2 to a strain of %.0e\n", static_cast<long>(count),
                    static_cast<unsigned long>(seed), nu, strain);
        compare(shear, strain);
      }
    }
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
