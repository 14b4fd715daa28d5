#include "grainlaw/dem/balance/contact_hessian.hpp"

#include <algorithm>
#include <cmath>

#include "grainlaw/dem/numbers/simd_targets.hpp"
// Compiled once per instruction set; the best one that the machine has is taken at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "grainlaw/dem/balance/contact_hessian.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
#include "grainlaw/dem/numbers/four-inl.hpp"

namespace grainlaw::dem::HWY_NAMESPACE {

/// Adds the contacts' forces to `y`.
void add_products(const ContactNetwork::Pair* pairs, const Quad* spring, const double* prestress,
                  std::size_t count, const Quad* x, Quad* y) {
  for (std::size_t c = 0; c < count; ++c) {
    const auto [i, j] = pairs[c];
    const Four apart = load(x[i]) - load(x[j]), m = load(spring[c]);
    const Four f = mul_add(sum(m * apart), m, all(prestress[c]) * apart);
    store(load(y[i]) + f, y[i]);
    store(load(y[j]) - f, y[j]);
  }
}

}  // namespace grainlaw::dem::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace grainlaw::dem {

HWY_EXPORT(add_products);

void ContactHessian::build(const ContactNetwork& network, std::size_t grains, const Backbone* backbone) {
  pairs_.assign(network.pairs.begin(), network.pairs.begin() + static_cast<std::ptrdiff_t>(network.count));
  spring_.resize(network.count);
  prestress_.assign(network.count, 0);
  diagonal_.assign(grains, Sym6{});
  for (std::size_t c = 0; c < network.count; ++c) {
    const Quad& n = network.normal[c];
    if (backbone == nullptr || backbone->joins(network, c)) prestress_[c] = -network.force[c] / n.w;
    const double s = std::sqrt(network.stiffness[c] - prestress_[c]);
    const Quad m{s * n.x, s * n.y, s * n.z, 0};
    spring_[c] = m;
    for (const std::uint32_t g : {pairs_[c].i, pairs_[c].j}) {
      Sym6& block = diagonal_[g];
      block[0] += m.x * m.x;
      block[1] += m.y * m.y;
      block[2] += m.z * m.z;
      block[3] += m.y * m.z;
      block[4] += m.x * m.z;
      block[5] += m.x * m.y;
    }
  }
}

void ContactHessian::apply(const Field& displacement, Field& product) const {
  std::fill(product.begin(), product.end(), Quad{});
  HWY_DYNAMIC_DISPATCH(add_products)
  (pairs_.data(), spring_.data(), prestress_.data(), pairs_.size(), displacement.data(), product.data());
}

}  // namespace grainlaw::dem
#endif
