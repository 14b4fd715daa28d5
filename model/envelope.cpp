#include "grainlaw/model/envelope.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "grainlaw/model/walk/point.hpp"

namespace grainlaw::model {

namespace {

/// cos and sin, exact where an axis is met: isotropic strain shears nothing, and shear keeps the volume.
std::array<double, 2> direction_of(int i, int count) {
  if (4 * i % count == 0) {
    constexpr std::array<std::array<double, 2>, 4> axes{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
    return axes[static_cast<std::size_t>(4 * i / count)];
  }
  const double angle = 2 * std::numbers::pi * i / count;
  return {std::cos(angle), std::sin(angle)};
}

}  // namespace

const std::vector<std::string>& envelope_columns() {
  static const std::vector<std::string> names{"direction", "eps_vol", "eps_dev",   "dP",   "dsigma_dev",
                                              "dF_dev",    "P",       "sigma_dev", "F_dev"};
  return names;
}

Envelope envelope(const Law& law, const State& from, Tolerance tolerance, double size, int directions) {
  Envelope result{Record(envelope_columns()), {}};
  MaterialPoint point(law, from, tolerance);
  for (int i = 0; i < directions; ++i) {
    const auto [volume, shear] = direction_of(i, directions);
    point.set_state(from);
    const Status status = point.walk(size * volume, size * shear);
    const double degrees = 360.0 * i / directions;
    if (status.failed()) {
      if (!result.status.failed())
        result.status = {status.code, "direction " + shown(degrees) + ": " + status.message};
      continue;
    }
    const State& to = point.state();
    result.responses.append({degrees, size * volume, size * shear, to.P - from.P,
                             to.sigma_dev - from.sigma_dev, to.F_dev - from.F_dev, to.P, to.sigma_dev,
                             to.F_dev});
  }
  return result;
}

}  // namespace grainlaw::model
