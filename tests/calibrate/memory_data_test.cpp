// The tables that stand in data/memory (docs/memory.md), fitted again.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "fit_fixture.hpp"
#include "grainlaw/calibrate/fit_memory.hpp"
#include "grainlaw/calibrate/memory_tables.hpp"
#include "grainlaw/model/parameters.hpp"

namespace grainlaw::calibrate {
namespace {

const std::filesystem::path folder = std::filesystem::path(GRAINLAW_DATA_DIR) / "memory";

KnownValues thesis() {
  const model::MemoryLaws m = *model::ParameterSet::load(thesis_file()).memory;
  const auto known = [](const model::Parameter& p) { return KnownValue(p.value, p.stderr_.value_or(0)); };
  return {{"phi_SJ", known(m.phi_SJ)},       {"mu", known(m.mu)},       {"beta", known(m.beta)},
          {"alpha_max", known(m.alpha_max)}, {"alpha", known(m.alpha)}, {"alpha_phi", known(m.alpha_phi)},
          {"eps0", known(m.eps0)},           {"eps0_R", known(m.eps0_R)}};
}

std::vector<CycleDensity> cycles() { return read_over_compression(folder / "over_compression.csv"); }
std::vector<ShearJamming> runs() { return read_shear_jamming(folder / "shear_jamming.csv"); }

/// Mean of phi_J after cycle M to phi_max over the packings.
double mean_density(const std::vector<CycleDensity>& all, double phi_max, double M) {
  double sum = 0, n = 0;
  for (const CycleDensity& c : all) {
    if (std::abs(c.phi_max - phi_max) > 1e-4 || c.M != M || !c.from_P.known()) continue;
    sum += c.from_P.value;
    n += 1;
  }
  return sum / n;
}

void print(const FitResult& fit) {
  std::printf("%s; %s; n %zu, n_eff %.1f, rms %.2g\n", fit.exit.c_str(), fit.stderr_from.c_str(), fit.n, fit.n_effective, fit.rms);
  for (const FitEstimate& e : fit.parameters)
    std::printf("  %s %.6g +- %.2g%s%s %s\n", e.name.c_str(), e.value, e.stderr_.value_or(NAN), e.held ? " held" : "",
                e.determined ? "" : " not determined", e.reason.c_str());
}

TEST(MemoryData, Print) {
  const MemoryFit fit = fit_memory(cycles(), runs(), thesis());
  std::printf("%g\n", mean_density(cycles(), 0.82, 1));
  print(fit.over_compression);
  print(fit.shear);
  print(fit.reversal);
  for (const auto& g : fit.growth)
    std::printf("%s mu %.3g beta %.3g rms %.3g dAIC %.2f\n", name_of(g.growth).c_str(), g.mu, g.beta, g.rms, g.delta_AIC);
  for (const auto& e : fit.entangled) std::printf("%s %s %.3f\n", e.first.c_str(), e.second.c_str(), e.correlation);
  std::printf("phi_SJ %.6f %.6f oc %.6f %.6f sh %.6f %.6f\n",fit.phi_SJ.value,fit.phi_SJ.error,fit.phi_SJ.by_over_compression.value,fit.phi_SJ.by_over_compression.error,fit.phi_SJ.by_shear.value,fit.phi_SJ.by_shear.error);
  print(calibrate::fit(over_compression_problem(cycles(), Growth::stretched, thesis())));
  print(calibrate::fit(shear_jamming_problem(runs(), {0.6567,0.0005}, thesis())));
}

}  // namespace
}  // namespace grainlaw::calibrate
