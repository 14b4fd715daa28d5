// Past the thesis: how the deviatoric fabric changes when only the volume does. Contacts that compression
// makes know nothing of the shear before and grains rearrange, so that anisotropy fades.
#pragma once

#include <cmath>

namespace grainlaw::model {

/// -d ln F_dev/d ln nu.
template <class P>
struct BasicVolumetric {
  P compression = 0;    ///< where nu rises
  P decompression = 0;  ///< where nu falls
};
using Volumetric = BasicVolumetric<double>;

/// dF_dev = -k F_dev d ln nu, over a volume strain `eps_vol` = d ln nu.
template <class P, class V, class F>
auto fabric_by_volume(const BasicVolumetric<P>& m, const V& eps_vol, const F& F_dev) {
  using std::abs;
  // k d ln nu without a branch, for lanes of points of which some compress and some do not
  const auto k_eps_vol = 0.5 * (m.compression + m.decompression) * eps_vol +
                         0.5 * (m.compression - m.decompression) * abs(eps_vol);
  return -k_eps_vol * F_dev;
}

}  // namespace grainlaw::model
