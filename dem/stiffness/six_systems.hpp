// Six systems H x = b with the stiffness of one contact network, solved together.
#pragma once

#include <array>
#include <cstdint>

#include "grainlaw/dem/balance/block_jacobi.hpp"
#include "grainlaw/dem/balance/contact_hessian.hpp"
#include "grainlaw/dem/balance/contact_network.hpp"
#include "grainlaw/dem/stiffness/six_fields.hpp"

namespace grainlaw::dem {

/// Conjugate gradients on six right-hand sides in step, each with its own coefficients, preconditioned by the
/// inverse of each grain's own block: one iteration walks once through the contacts, for all six. The result
/// is that of six solves one after the other, to rounding.
class SixSystems {
 public:
  /// `floor`: what the blocks of the preconditioner gain on their diagonal, ug/us^2.
  SixSystems(const ContactNetwork& network, std::size_t grains, double floor);

  struct Options {
    double residual = 1e-6;  ///< what is left of b, over b, in the norm of the preconditioner
    SixNumbers enough{};     ///< b . x below which a system is solved, whatever the residual
    std::uint64_t most_iterations = 30'000;
  };
  struct Result {
    std::uint64_t iterations = 0;  ///< of the system that took the most
    std::uint64_t products = 0;    ///< of the Hessian with one field, over all six
    /// Systems in which a displacement without stiffness, or with a negative one, was met; x is what it was
    /// then.
    std::array<bool, 6> unstable{};
    bool gave_up = false;  ///< most_iterations came first
  };

  /// H x
  SixFields product(const SixFields& x) const;

  /// From x = 0. `b` is overwritten by what is left of it.
  Result solve(SixFields& b, SixFields& x, const Options& options);

 private:
  ContactHessian hessian_;
  BlockJacobi preconditioner_;
  SixFields p_, hp_;
};

}  // namespace grainlaw::dem
