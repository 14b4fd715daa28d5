#include "grainlaw/dem/probe.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "grainlaw/dem/minimise.hpp"
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

/// In the box strained by `strain` (logarithmic, compression positive, diagonal), back in balance.
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

}  // namespace

Probe probe(const StaticPacking& packing, const StrainTensor& axis, double amplitude, double residual) {
  const double size = deviator_magnitude(axis);
  StaticPacking before = packing;
  before.find_contacts();
  const Sym6 sigma = before.measure().stress;
  const Touching contacts = touching(before);
  Probe result;
  result.amplitude = amplitude;
  const auto change = [&](const StrainTensor& strain, double& of_pressure, double& of_deviator) {
    StaticPacking after = strained(before, strain, residual);
    Sym6 stress = after.measure().stress;
    for (std::size_t c = 0; c < 6; ++c) stress[c] -= sigma[c];
    of_pressure = trace(stress) / 3 / amplitude;
    of_deviator = deviator_along(stress, axis) / amplitude;
    result.contacts_changed += differences(contacts, touching(after));
    result.residual = std::max(result.residual, after.balance().residual);
  };
  change({amplitude / 3, amplitude / 3, amplitude / 3}, result.moduli.B, result.moduli.A2);
  StrainTensor deviatoric{};
  for (std::size_t c = 0; c < 3; ++c) deviatoric[c] = amplitude * (axis[c] - trace(axis) / 3) / size;
  change(deviatoric, result.moduli.A1, result.moduli.G_oct);
  return result;
}

}  // namespace grainlaw::dem
