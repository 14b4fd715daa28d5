#include "grainlaw/dem/stiffness/six_systems.hpp"

#include <algorithm>
#include <cmath>

#include "grainlaw/dem/numbers/simd_targets.hpp"
// Compiled once per instruction set; the best one that the machine has is taken at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "grainlaw/dem/stiffness/six_systems.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
#include "grainlaw/dem/numbers/four-inl.hpp"

namespace grainlaw::dem::HWY_NAMESPACE {

/// One vector of three components for as many systems as fit in a register.
struct Three {
  Wide x, y, z;
};
HWY_INLINE Three at(const SixVectors& v, std::size_t k) {
  return {load_wide(&v.q[0][k]), load_wide(&v.q[1][k]), load_wide(&v.q[2][k])};
}
HWY_INLINE void keep(const Three& a, SixVectors& v, std::size_t k) {
  store(a.x, &v.q[0][k]);
  store(a.y, &v.q[1][k]);
  store(a.z, &v.q[2][k]);
}
HWY_INLINE Three operator+(const Three& a, const Three& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
HWY_INLINE Three operator-(const Three& a, const Three& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
HWY_INLINE Wide product(const Three& a, const Three& b) {
  return mul_add(a.z, b.z, mul_add(a.y, b.y, a.x * b.x));
}
/// s a + b
HWY_INLINE Three mul_add(Wide s, const Three& a, const Three& b) {
  return {mul_add(s, a.x, b.x), mul_add(s, a.y, b.y), mul_add(s, a.z, b.z)};
}
HWY_INLINE Three times(const BlockJacobi::Block& m, const Three& r) {
  const Wide xx = wide(m.on.x), yy = wide(m.on.y), zz = wide(m.on.z), yz = wide(m.off.x), xz = wide(m.off.y),
             xy = wide(m.off.z);
  return {product({xx, xy, xz}, r), product({xy, yy, yz}, r), product({xz, yz, zz}, r)};
}

/// hp += H p; returns p . H p of each system.
SixNumbers add_products(const ContactHessian& hessian, const SixFields& p, SixFields& hp) {
  SixNumbers sums{};
  for (std::size_t k = 0; k < 8; k += lanes) {
    Wide sum = wide(0);
    for (std::size_t c = 0; c < hessian.pairs().size(); ++c) {
      const auto [i, j] = hessian.pairs()[c];
      const Quad& spring = hessian.springs()[c];
      const Three m{wide(spring.x), wide(spring.y), wide(spring.z)}, apart = at(p[i], k) - at(p[j], k);
      const Wide t = wide(hessian.prestress()[c]), s = product(m, apart);
      const Three f = mul_add(s, m, {t * apart.x, t * apart.y, t * apart.z});
      sum = sum + product(f, apart);
      keep(at(hp[i], k) + f, hp[i], k);
      keep(at(hp[j], k) - f, hp[j], k);
    }
    store(sum, &sums[k]);
  }
  return sums;
}

/// x += alpha p, r -= alpha hp; returns r . z with z = M^-1 r.
SixNumbers advance(const SixNumbers& alpha, const BlockJacobi& preconditioner, const SixFields& p,
                   const SixFields& hp, SixFields& x, SixFields& r) {
  SixNumbers sums{};
  for (std::size_t k = 0; k < 8; k += lanes) {
    const Wide forth = load_wide(&alpha[k]), back = wide(0) - forth;
    Wide sum = wide(0);
    for (std::size_t g = 0; g < x.size(); ++g) {
      keep(mul_add(forth, at(p[g], k), at(x[g], k)), x[g], k);
      const Three left = mul_add(back, at(hp[g], k), at(r[g], k));
      keep(left, r[g], k);
      sum = sum + product(left, times(preconditioner.blocks()[g], left));
    }
    store(sum, &sums[k]);
  }
  return sums;
}

/// p = M^-1 r + beta p, and hp = 0.
void turn(const SixNumbers& beta, const BlockJacobi& preconditioner, const SixFields& r, SixFields& p,
          SixFields& hp) {
  const Three none{wide(0), wide(0), wide(0)};
  for (std::size_t k = 0; k < 8; k += lanes) {
    const Wide share = load_wide(&beta[k]);
    for (std::size_t g = 0; g < p.size(); ++g) {
      keep(mul_add(share, at(p[g], k), times(preconditioner.blocks()[g], at(r[g], k))), p[g], k);
      keep(none, hp[g], k);
    }
  }
}

}  // namespace grainlaw::dem::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace grainlaw::dem {

HWY_EXPORT(add_products);
HWY_EXPORT(advance);
HWY_EXPORT(turn);

SixSystems::SixSystems(const ContactNetwork& network, std::size_t grains, double floor)
    : p_(grains), hp_(grains) {
  hessian_.build(network, grains);
  preconditioner_.build(hessian_, floor);
}

SixFields SixSystems::product(const SixFields& x) const {
  SixFields hx(x.size());
  HWY_DYNAMIC_DISPATCH(add_products)(hessian_, x, hx);
  return hx;
}

SixSystems::Result SixSystems::solve(SixFields& b, SixFields& x, const Options& options) {
  Result result;
  SixFields& r = b;
  SixNumbers alpha{}, beta{};
  std::fill(x.begin(), x.end(), SixVectors{});
  std::fill(p_.begin(), p_.end(), SixVectors{});
  HWY_DYNAMIC_DISPATCH(turn)(beta, preconditioner_, r, p_, hp_);
  SixNumbers rz = HWY_DYNAMIC_DISPATCH(advance)(alpha, preconditioner_, p_, hp_, x, r), enough{};
  std::array<bool, 6> open{};
  for (std::size_t a = 0; a < 6; ++a) {
    enough[a] = std::max(options.residual * options.residual * rz[a], options.enough[a]);
    open[a] = rz[a] > enough[a];
  }
  while (std::count(open.begin(), open.end(), true) > 0) {
    if (result.iterations == options.most_iterations) {
      result.gave_up = true;
      break;
    }
    ++result.iterations;
    const SixNumbers curvature = HWY_DYNAMIC_DISPATCH(add_products)(hessian_, p_, hp_);
    for (std::size_t a = 0; a < 6; ++a) {
      if (open[a]) ++result.products;
      if (open[a] && !(curvature[a] > 0)) {
        result.unstable[a] = true;
        open[a] = false;
      }
      alpha[a] = open[a] ? rz[a] / curvature[a] : 0;
    }
    const SixNumbers next = HWY_DYNAMIC_DISPATCH(advance)(alpha, preconditioner_, p_, hp_, x, r);
    for (std::size_t a = 0; a < 6; ++a) {
      beta[a] = open[a] ? next[a] / rz[a] : 0;
      rz[a] = next[a];
      open[a] = open[a] && rz[a] > enough[a];
    }
    HWY_DYNAMIC_DISPATCH(turn)(beta, preconditioner_, r, p_, hp_);
  }
  return result;
}

}  // namespace grainlaw::dem
#endif
