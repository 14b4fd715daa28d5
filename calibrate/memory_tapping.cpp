#include "grainlaw/calibrate/memory_tapping.hpp"

#include <algorithm>
#include <cmath>

namespace grainlaw::calibrate {

std::vector<TappedDensity> tapped_density(const TestRecord& test, const TestRecord& sheared,
                                          const KnownValues& laws, const Selection& selection) {
  const auto cycles = cycle_densities(test, laws, selection);
  if (cycles.empty() || !test.from) return {};
  TappedDensity out;
  out.density = cycles.front();
  double low = 0, high = 0;
  for (std::size_t leg = 0; leg <= std::min(test.from->leg, sheared.legs.size() - 1); ++leg) {
    const auto& eps_dev = sheared.legs[leg].eps_dev;
    low = std::min({low, eps_dev[0], eps_dev[1]});
    high = std::max({high, eps_dev[0], eps_dev[1]});
    out.strain += std::abs(eps_dev[1] - eps_dev[0]);
  }
  out.amplitude = 0.5 * (high - low);
  return {out};
}

double largest_nu(const TestRecord& test, std::size_t leg) {
  double largest = test.nu_start;
  for (std::size_t i = 0; i <= leg && i < test.legs.size(); ++i)
    for (const double eps_vol : {test.legs[i].eps_vol[0], test.legs[i].eps_vol[1]})
      largest = std::max(largest, test.nu_start * std::exp(eps_vol));
  return largest;
}

}  // namespace grainlaw::calibrate
