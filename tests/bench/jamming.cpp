// grainlaw_bench_jamming COUNT [SEED [NU]] : linear response as a packing comes apart. A random packing is
// brought into balance at NU (0.67) and unloaded in steps, each brought into balance, that bring P* down by
// 0.7 at most; at every half decade and at P* = 1e-5 it prints a row: contacts over those of an isostatic
// backbone, floppy modes, iterations and processor seconds of linear response, and how far the 36 derivatives
// of stress are from central differences of the re-balanced packing (the best of six strains), over the
// largest.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <string>

#include "grainlaw/dem/stiffness/floppy_modes.hpp"
#include "grainlaw/dem/stiffness/linear_response.hpp"
#include "random_packing.hpp"
#include "stress_differences.hpp"

namespace {

using namespace grainlaw;
using namespace grainlaw::dem;

constexpr double last = 1e-5, half_decade = 3.1622776601683795;
/// Strains of the differences, over P*: rounding spoils small ones, changes of contacts large ones.
constexpr std::array<double, 6> strains_over_pressure{1e-5, 3e-5, 1e-4, 3e-4, 1e-3, 3e-3};

double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double least_error(const StaticPacking& packing, const Stiffness& stress, double pressure) {
  double least = 1;
  for (const double share : strains_over_pressure)
    least = std::min(least, distance(differences_at(packing, share * pressure), stress).of_largest);
  return least;
}

/// What a residual of 1e-10 would change in the constants, over the largest.
double error_of_solver(StaticPacking& packing, const Stiffness& energy) {
  LinearResponseOptions options;
  options.residual = 1e-10;
  const Stiffness exact = linear_response(packing, options).energy;
  double error = 0, largest = 0;
  for (std::size_t a = 0; a < 6; ++a)
    for (std::size_t b = 0; b < 6; ++b) {
      error = std::max(error, std::abs(energy[a][b] - exact[a][b]));
      largest = std::max(largest, std::abs(exact[a][b]));
    }
  return error / largest;
}

double pressure(const StaticPacking& packing, const Material& material) {
  return trace(packing.measure().stress) / 3 / material.stress_unit();
}

/// A row; the bulk modulus.
double report(StaticPacking& packing, const Material& material, bool print) {
  double begin = processor_seconds();
  const LinearResponse response = linear_response(packing);
  const double seconds = processor_seconds() - begin;
  const Moduli moduli = moduli_of(response.stress, {-1, 1, 0});
  if (!print) return moduli.B / material.stress_unit();
  const double p = pressure(packing, material);
  begin = processor_seconds();
  const FloppyModes floppy = floppy_modes(packing);
  const double counting = processor_seconds() - begin;
  const double isostatic = static_cast<double>(packing.backbone().isostatic());
  std::printf("| %.2e | %.5f | %.3f | %.1f | %.4f | %.4f | %zu | %d | %llu | %.3f | %.2f | %.0e | %.0e |\n",
              p, packing.measure().nu,
              static_cast<double>(response.backbone) / static_cast<double>(packing.count()),
              100 * (static_cast<double>(response.contacts) / isostatic - 1),
              moduli.B / material.stress_unit(), moduli.G_oct / material.stress_unit(), floppy.count,
              response.unstable, static_cast<unsigned long long>(response.iterations), seconds, counting,
              error_of_solver(packing, response.energy), least_error(packing, response.stress, p));
  std::fflush(stdout);
  return moduli.B / material.stress_unit();
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 2 || std::atol(argv[1]) < 8) {
    std::fprintf(stderr, "usage: %s COUNT [SEED [NU]]\n", argv[0]);
    return 2;
  }
  const Material material;
  StaticPacking packing =
      random_packing(material, std::atol(argv[1]), argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1,
                     argc > 3 ? std::strtod(argv[3], nullptr) : 0.67, 1e-12);
  std::puts(
      "| P* | nu | grains that bear load | contacts over isostatic, % | B/k* | G_oct/k* | floppy | unstable "
      "| iterations | s | s for floppy | error of the solver | difference |");
  std::puts("|---|---|---|---|---|---|---|---|---|---|---|---|---|");
  double next = 1;  // P* at which to print
  while (next > pressure(packing, material)) next /= half_decade;
  for (bool done = false; !done;) {
    const double p = pressure(packing, material);
    done = p <= 1.001 * last;
    const bool print = done || p <= 1.001 * next;
    while (next >= p / 1.001) next /= half_decade;
    const double bulk = report(packing, material, print), to = std::max({0.7 * p, next, last});
    const double strain = (p - to) / bulk / 3;  // of each axis, less where the packing gets softer
    packing.deform(std::exp(strain) * packing.cell().edges());
    balance_fully(packing);
  }
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
