#include "grainlaw/dem/balance/fire.hpp"

#include <algorithm>
#include <cmath>

#include "grainlaw/dem/numbers/field.hpp"

namespace grainlaw::dem {

namespace {

constexpr double first_step = 0.45, longest_step = 0.45;  // over sqrt(m/k)
constexpr double shorter = 0.5, longer = 1.1;             // factors of the step
constexpr double first_mixing = 0.1, less_mixing = 0.99;
constexpr int patience = 5;  // steps downhill before the step grows

}  // namespace

// Grains of mass 1: the velocity, in `motion`, is a displacement per unit of pseudo time.
Fire::Fire(StaticPacking& packing)
    : packing_(packing), unit_(std::sqrt(1 / packing.law().typical_stiffness())) {}

void Fire::start() {
  Field& v = packing_.grains().motion;
  std::fill(v.begin(), v.end(), Quad{});
  dt_ = first_step * unit_;
  mixing_ = first_mixing;
  downhill_ = 0;
}

void Fire::run(int steps) {
  Field &v = packing_.grains().motion, &f = packing_.grains().force;
  for (int n = 0; n < steps; ++n) {
    const double force = std::sqrt(dot(f, f));
    if (force == 0) return;  // no contact left, or balance to the last bit
    const double power = dot(f, v);
    if (power > 0) {
      if (++downhill_ > patience) {
        dt_ = std::min(dt_ * longer, longest_step * unit_);
        mixing_ *= less_mixing;
      }
    } else {
      packing_.move(-0.5 * dt_);
      std::fill(v.begin(), v.end(), Quad{});
      if (power < 0) dt_ *= shorter;  // not at rest
      mixing_ = first_mixing;
      downhill_ = 0;
    }
    add(dt_, f, v);
    scale_and_add(1 - mixing_, v, mixing_ * std::sqrt(dot(v, v)) / force, f);
    packing_.move(dt_);
    packing_.forces();
  }
}

}  // namespace grainlaw::dem
