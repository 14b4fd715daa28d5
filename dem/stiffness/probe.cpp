#include "grainlaw/dem/stiffness/probe.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "grainlaw/dem/balance/minimise.hpp"
#include "grainlaw/element/error.hpp"

namespace grainlaw::dem {

namespace {

using Touching = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

/// Contacts between grains that bear load, by the numbers of the grains.
Touching touching(const StaticPacking& packing) {
  Touching list;
  const ContactNetwork& network = packing.network();
  const auto& id = packing.grains().id;
  for (std::size_t c = 0; c < network.count; ++c)
    if (packing.backbone().joins(network, c))
      list.push_back(std::minmax(id[network.pairs[c].i], id[network.pairs[c].j]));
  std::sort(list.begin(), list.end());
  return list;
}

std::uint64_t differences(const Touching& a, const Touching& b) {
  Touching both;
  std::set_symmetric_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
  return both.size();
}

/// `from` in the box strained by `strain` (logarithmic, compression positive, diagonal), back in balance.
StaticPacking strained(const StaticPacking& from, const StrainTensor& strain, double residual) {
  StaticPacking packing = from;
  packing.deform(Mat3::diagonal({std::exp(-strain[0]), std::exp(-strain[1]), std::exp(-strain[2])}) *
                 packing.cell().edges());
  MinimiseOptions options;
  options.residual = residual;
  const MinimiseResult result = minimise(packing, options);
  if (result.outcome == Outcome::gave_up) throw Error("a probed packing is " + result.text());
  return packing;
}

/// Change of stress, over the amplitude: of the pressure, and of sigma_dev along the axis.
struct Slopes {
  double of_pressure = 0, of_deviator = 0;
};

/// A packing before it is strained, and what becomes of it.
class Strained {
 public:
  Strained(const StaticPacking& packing, const StrainTensor& axis, double amplitude,
           const ProbeOptions& options)
      : before_(packing), axis_(axis), amplitude_(amplitude), options_(options) {
    before_.find_contacts();
    stress_ = before_.measure().stress;
    contacts_ = touching(before_);
  }

  /// Applies `strain`, and takes it back where the options ask for it.
  void apply(const StrainTensor& strain) {
    const StaticPacking there = strained(before_, strain, options_.residual);
    slopes = slopes_of(there);
    changed = differences(contacts_, touching(there));
    residual = there.balance().residual;
    if (!options_.undo) return;
    StrainTensor back = strain;
    for (double& component : back) component = -component;
    const StaticPacking home = strained(there, back, options_.residual);
    slopes_left = slopes_of(home);
    changes_left = differences(contacts_, touching(home));
    residual = std::max(residual, home.balance().residual);
  }
  Slopes slopes, slopes_left;
  std::uint64_t changed = 0, changes_left = 0;
  double residual = 0;

 private:
  Slopes slopes_of(const StaticPacking& packing) const {
    Sym6 stress = packing.measure().stress;
    for (std::size_t c = 0; c < 6; ++c) stress[c] -= stress_[c];
    return {trace(stress) / 3 / amplitude_, deviator_along(stress, axis_) / amplitude_};
  }

  StaticPacking before_;
  StrainTensor axis_;
  double amplitude_;
  ProbeOptions options_;
  Sym6 stress_;
  Touching contacts_;
};

/// B and A2 by the isotropic strain, A1 and G_oct by the other, which holds `share` of it.
Moduli moduli_from(const Slopes& volume, const Slopes& shear, double share) {
  return {volume.of_pressure, shear.of_pressure - share * volume.of_pressure, volume.of_deviator,
          shear.of_deviator - share * volume.of_deviator};
}

}  // namespace

Probe probe(const StaticPacking& packing, const StrainTensor& axis, double amplitude,
            const ProbeOptions& options) {
  const double size = deviator_magnitude(axis);
  StrainTensor along{};
  for (std::size_t c = 0; c < 3; ++c) along[c] = amplitude * axis[c] / size;
  Strained volume(packing, axis, amplitude, options), shear = volume;
  volume.apply({amplitude / 3, amplitude / 3, amplitude / 3});
  shear.apply(along);
  Probe result;
  result.amplitude = amplitude;
  result.residual = std::max(volume.residual, shear.residual);
  const double share = trace(axis) / size;
  result.moduli = moduli_from(volume.slopes, shear.slopes, share);
  result.left = moduli_from(volume.slopes_left, shear.slopes_left, share);
  result.changed = {volume.changed, shear.changed};
  result.contacts_left = {volume.changes_left, shear.changes_left};
  return result;
}

}  // namespace grainlaw::dem
