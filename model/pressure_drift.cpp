#include "grainlaw/model/pressure_drift.hpp"

#include <cmath>
#include <cstddef>
#include <cstdio>

namespace grainlaw::model {

namespace {

/// Where a direction of shear ended.
struct Turn {
  double q, eps_dev, P;
};

/// Change of P per half cycle between two ends of the same direction one cycle apart, as a part of P; 0 where
/// the cycle is not closed, or no pressure was left. A cycle is compared and not its halves, because within
/// one P also dips after a reversal and recovers.
double drift_over_cycle(const Turn& before, const Turn& reversal, const Turn& after) {
  constexpr double closed = 0.01;  // of the strain of a half cycle
  const bool returns =
      std::abs(after.eps_dev - before.eps_dev) <= closed * std::abs(after.eps_dev - reversal.eps_dev);
  return returns && before.P > 0 && after.P > 0 ? std::sqrt(after.P / before.P) - 1 : 0;
}

}  // namespace

double pressure_drift(const std::vector<Leg>& legs, const std::vector<double>& P_at_ends) {
  constexpr double constant_volume = 1e-9;  // of the shear strain
  double largest = 0;
  std::vector<Turn> turns;  // since the volume last changed
  for (std::size_t i = 0; i < P_at_ends.size(); ++i) {
    const double volume = legs[i].eps_vol[1] - legs[i].eps_vol[0],
                 shear = legs[i].eps_dev[1] - legs[i].eps_dev[0], q = shear > 0 ? 1 : -1;
    if (std::abs(volume) > constant_volume * std::abs(shear)) {
      turns.clear();
    } else if (shear != 0) {
      if (!turns.empty() && turns.back().q == q) turns.pop_back();
      turns.push_back({q, legs[i].eps_dev[1], P_at_ends[i]});
    }
    if (turns.size() < 3) continue;
    const double drift = drift_over_cycle(turns.end()[-3], turns.end()[-2], turns.back());
    if (std::abs(drift) > std::abs(largest)) largest = drift;
  }
  return largest;
}

void tell_drift(double drift, std::vector<std::string>& warnings) {
  constexpr double tolerated = 0.005;
  if (std::abs(drift) <= tolerated) return;
  char percent[32];
  std::snprintf(percent, sizeof percent, "%.1f", 100 * std::abs(drift));
  warnings.push_back(std::string(drift > 0 ? "gains" : "loses") + " up to " + percent +
                     " % of P per half cycle of shear at constant volume, without a bound: Eq. 4.16 has no "
                     "restoring term in dP");
}

}  // namespace grainlaw::model
