#include "grainlaw/dem/observe/contact_fabric.hpp"

namespace grainlaw::dem::observe {

std::array<double, 7> ContactFabric::values(const View& view) const {
  std::array<double, 7> result;
  result.fill(undefined);
  if (view.network.contacts.empty()) return result;
  Sym6 sum{};
  for (const Touch& c : view.network.contacts) add_dyad(sum, 1 / (c.distance * c.distance), c.branch);
  const Sym6 fabric = times(1 / static_cast<double>(view.network.contacts.size()), sum);
  result[0] = view.sign.signed_deviator(fabric, view.segment);
  for (std::size_t c = 0; c < 6; ++c) result[c + 1] = fabric[c];
  return result;
}

}  // namespace grainlaw::dem::observe
