// grainlaw_bench_response_size SNAPSHOTS.h5... : what linear response costs over the size of the packing, of
// the last frame of each file, smallest first. Prints processor seconds of the balance (to 1e-10), of the 21
// constants, and of counting floppy modes, and the most memory that the process has had so far.
#include <sys/resource.h>

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>

#include "grainlaw/dem/stiffness/floppy_modes.hpp"
#include "grainlaw/dem/stiffness/linear_response.hpp"
#include "random_packing.hpp"

namespace {

using namespace grainlaw;
using namespace grainlaw::dem;

double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double most_memory_MiB() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

void report(double nu, std::int64_t count) {
  const Material material;
  const double begin = processor_seconds();
  StaticPacking packing = random_packing(material, count, 1, nu, 1e-9);
  const double balanced = processor_seconds();
  const LinearResponse response = linear_response(packing);
  const double solved = processor_seconds();
  const double memory = most_memory_MiB();
  const FloppyModes floppy = floppy_modes(packing);
  const double counted = processor_seconds();
  const Moduli moduli = moduli_of(response.stress, {-1, 1, 0});
  std::printf("| %zu | %.1f | %llu | %.3f | %.2f | %zu in %.2f s | %.0f | %.5f | %.5f |\n", packing.count(),
              balanced - begin, static_cast<unsigned long long>(response.iterations), solved - balanced,
              1e9 * (solved - balanced) / static_cast<double>(packing.count()) /
                  static_cast<double>(response.iterations),
              floppy.count, counted - solved, memory, moduli.B / material.stress_unit(),
              moduli.G_oct / material.stress_unit());
  std::fflush(stdout);
}

}  // namespace

int main(int count, char** arguments) try {
  if (count < 3) return std::fprintf(stderr, "usage: %s NU COUNT...\n", arguments[0]), 2;
  std::puts(
      "| N | balance, s | iterations | s | ns per grain and iteration | floppy modes | MiB | B/k* | G_oct/k* "
      "|");
  std::puts("|---|---|---|---|---|---|---|---|---|");
  for (int a = 2; a < count; ++a) report(std::atof(arguments[1]), std::atoll(arguments[a]));
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
