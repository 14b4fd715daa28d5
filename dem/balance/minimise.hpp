// Brings a packing in a box at rest into balance by minimising its elastic energy over the places of the
// grains.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "grainlaw/dem/balance/static_packing.hpp"

namespace grainlaw::dem {

enum class Minimiser {
  fire,          ///< damped dynamics of grains of equal mass, see Fire
  newton_krylov  ///< Newton steps by conjugate gradients, and FIRE while grains rearrange, see NewtonKrylov
};

struct MinimiseOptions {
  Minimiser method = Minimiser::fire;
  /// Ends when no grain, rattlers included, has a net force above this times the mean contact force of the
  /// backbone.
  double residual = 1e-8;
  /// Without a backbone: ends when no overlap exceeds this times the mean radius. The energy is then zero for
  /// all that can be measured, at most 1e-18 k r^2 per contact.
  double zero_overlap = 1e-9;
  /// Passes over the contacts (for forces, or for a product with the Hessian) after which to give up.
  std::uint64_t most_passes = 100'000;
  /// When it turns true, looked at after every hundred steps or so: leaves the grains where they are.
  const std::atomic<bool>* stop = nullptr;
};

enum class Outcome {
  balanced,  ///< the residual is reached
  unjammed,  ///< no backbone is left, and no overlap: energy zero
  rounding,  ///< the residual is below what rounding of the places leaves, and that is reached
  gave_up,   ///< most_passes came first
  stopped    ///< it was told to stop
};

struct MinimiseResult {
  Outcome outcome = Outcome::gave_up;
  Balance balance;                ///< of the places as they are left
  double energy = 0;              ///< ug mm^2/us^2
  std::uint64_t evaluations = 0;  ///< of forces
  std::uint64_t products = 0;     ///< of the Hessian with a displacement
  std::uint64_t iterations = 0;

  bool converged() const { return outcome == Outcome::balanced || outcome == Outcome::unjammed; }
  /// The outcome in words, with the residual reached.
  std::string text() const;
};

/// When a minimiser is done.
class Goal {
 public:
  Goal(const StaticPacking& packing, const MinimiseOptions& options);

  /// True where it is reached, out of reach, or given up, judged at the last find_contacts() of the packing.
  /// Fills all of the result but its products and iterations, of which it reads the products.
  bool ends(const StaticPacking& packing, MinimiseResult& result) const;
  double residual() const { return options_.residual; }

 private:
  double rounding_floor(const StaticPacking& packing, const Balance& balance) const;

  MinimiseOptions options_;
  std::uint64_t evaluations_before_;
};

/// Moves the grains. Contacts, forces and measurements of `packing` then belong to the places it leaves
/// behind.
MinimiseResult minimise(StaticPacking& packing, const MinimiseOptions& options = {});

}  // namespace grainlaw::dem
