// Preconditioner of the contact network: the inverse of each grain's own stiffness.
#pragma once

#include <vector>

#include "grainlaw/dem/balance/contact_hessian.hpp"

namespace grainlaw::dem {

class BlockJacobi {
 public:
  /// Every block gains `floor` (ug/us^2) on its diagonal: grains with fewer than three contacts have no
  /// stiffness of their own in some directions.
  void build(const ContactHessian& hessian, double floor);
  /// z = M^-1 r
  void apply(const Field& r, Field& z) const;

  struct Block {
    Quad on, off;  ///< xx, yy, zz | yz, xz, xy, of the inverse
  };
  const std::vector<Block>& blocks() const { return inverse_; }

 private:
  std::vector<Block> inverse_;
};

}  // namespace grainlaw::dem
