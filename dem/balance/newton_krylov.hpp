// Newton's method on the elastic energy, its steps by conjugate gradients on the contact network.
#pragma once

#include <cstdint>
#include <vector>

#include "grainlaw/dem/balance/block_jacobi.hpp"
#include "grainlaw/dem/balance/contact_hessian.hpp"
#include "grainlaw/dem/balance/static_packing.hpp"
#include "grainlaw/dem/numbers/field.hpp"

namespace grainlaw::dem {

/// The Hessian holds only while contacts stay what they are. So a step ends within a radius that no grain
/// leaves, which shrinks where the energy did not follow the Hessian; and it is cut short where the network
/// turns out unstable. A loose step is enough while contacts change: the linear residual of a step falls by
/// as much as the last step was linear, or to what is wanted in the end.
class NewtonKrylov {
 public:
  explicit NewtonKrylov(StaticPacking& packing);

  /// One step; needs the contacts before and finds those after it. The energy never rises by more than its
  /// rounding. `wanted` is what the net forces may fall to, over what they are.
  void step(double wanted);

  /// Whether the last step went as the Hessian said, to within its radius.
  bool smooth() const { return smooth_; }
  std::uint64_t products() const { return products_; }  ///< of the Hessian with a displacement

 private:
  void find_direction(double share);
  void go_to_edge(Field& x) const;
  void hold_rattlers();
  void go();
  double misjudged(double size);

  StaticPacking& packing_;
  double most_radius_, radius_;  ///< mm
  double share_;                 ///< by which the linear residual is to fall
  bool smooth_ = true, cut_ = false;
  std::uint64_t products_ = 0;
  ContactHessian hessian_;
  BlockJacobi preconditioner_;
  Field r_, z_, p_, hp_;
  std::vector<std::uint32_t> rattlers_;
};

}  // namespace grainlaw::dem
