// Conjugate gradients on one right-hand side: what SixSystems does for six in step, to hold it against.
#pragma once

#include <cstdint>

#include "grainlaw/dem/balance/block_jacobi.hpp"
#include "grainlaw/dem/balance/contact_hessian.hpp"
#include "grainlaw/dem/numbers/field.hpp"

namespace grainlaw::dem {

class OneSystem {
 public:
  OneSystem(const ContactNetwork& network, std::size_t grains, double floor)
      : r_(grains), z_(grains), p_(grains), hp_(grains) {
    hessian_.build(network, grains);
    preconditioner_.build(hessian_, floor);
  }

  /// x with H x = b, from 0, to `residual` in the norm of the preconditioner; returns the products.
  std::uint64_t solve(const Field& b, double residual, Field& x) {
    std::uint64_t products = 0;
    x.assign(b.size(), Quad{});
    r_ = b;
    preconditioner_.apply(r_, z_);
    p_ = z_;
    double rz = dot(r_, z_);
    const double enough = residual * residual * rz;
    while (rz > enough) {
      hessian_.apply(p_, hp_);
      ++products;
      const double alpha = rz / dot(p_, hp_);
      add(alpha, p_, x);
      add(-alpha, hp_, r_);
      preconditioner_.apply(r_, z_);
      const double next = dot(r_, z_);
      add_to_scaled(z_, next / rz, p_);
      rz = next;
    }
    return products;
  }

 private:
  ContactHessian hessian_;
  BlockJacobi preconditioner_;
  Field r_, z_, p_, hp_;
};

}  // namespace grainlaw::dem
