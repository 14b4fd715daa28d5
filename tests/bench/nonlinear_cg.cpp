#include "nonlinear_cg.hpp"

#include <algorithm>
#include <cmath>

#include "grainlaw/dem/balance/block_jacobi.hpp"
#include "grainlaw/dem/balance/contact_hessian.hpp"
#include "grainlaw/dem/numbers/field.hpp"

namespace grainlaw::dem {

namespace {

constexpr double floor_share = 0.1;    // of the contact stiffness, in the preconditioner
constexpr double flat_enough = 0.3;    // slope along a line, over that at its beginning, to stop there
constexpr double longest_move = 0.05;  // of any grain along one line, in mean radii
constexpr int most_tries = 6;          // places along a line
constexpr int between_looks = 20;      // lines between two looks at the network

}  // namespace

MinimiseResult minimise_by_conjugate_gradients(StaticPacking& packing, const MinimiseOptions& options) {
  MinimiseResult result;
  const Goal goal(packing, options);
  Grains& grains = packing.grains();
  ContactHessian hessian;
  BlockJacobi preconditioner;
  Field z(packing.count());
  double last_step = 1;
  packing.find_contacts();
  while (!goal.ends(packing, result)) {
    hessian.build(packing.network(), packing.count());
    preconditioner.build(hessian, floor_share * packing.law().stiffness(0));
    double norm = 0;  // F.z of the line before; 0: begin anew
    std::uint64_t sorts = packing.sorts();
    for (int n = 0; n < between_looks && sorts == packing.sorts(); ++n) {
      preconditioner.apply(grains.force, z);
      const double now = dot(grains.force, z);
      const double beta = norm > 0 ? std::max(0.0, (now - dot(grains.half, z)) / norm) : 0;
      add_to_scaled(z, beta, grains.motion);
      double slope = dot(grains.force, grains.motion);
      if (!(slope > 0)) {
        grains.motion = z;
        slope = now;
      }
      norm = now;
      grains.half = grains.force;
      const double farthest =
          longest_move * packing.unit_of_length() / std::sqrt(largest_square(grains.motion));
      double at = 0, low = 0, low_slope = slope, step = std::min(last_step, farthest);
      for (int tries = 0; tries < most_tries; ++tries) {
        packing.move(step - at);
        at = step;
        packing.forces();
        const double here = dot(grains.force, grains.motion);
        if (std::abs(here) <= flat_enough * slope || (here > 0 && at >= farthest)) break;
        // The zero of the slope by the secant through the last place downhill and this one.
        step = here < 0 || here < low_slope ? low + (at - low) * low_slope / (low_slope - here) : 4 * at;
        if (here > 0) {
          low = at;
          low_slope = here;
        }
        step = std::min({step, 4 * at, farthest});
      }
      last_step = at;
      ++result.iterations;
    }
    packing.find_contacts();
  }
  return result;
}

}  // namespace grainlaw::dem
