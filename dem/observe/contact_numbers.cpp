#include "grainlaw/dem/observe/contact_numbers.hpp"

namespace grainlaw::dem::observe {

std::array<double, 3> ContactNumbers::values(const View& view) const {
  std::uint64_t bearing = 0, of_rattlers = 0;
  for (const std::uint32_t c : view.network.contacts_of)
    if (c >= bearing_contacts)
      ++bearing;
    else
      of_rattlers += c;
  const double all = 2 * static_cast<double>(view.network.contacts.size());
  const double held = all - 2 * static_cast<double>(of_rattlers);
  const double grains = static_cast<double>(view.network.contacts_of.size());
  return {all / grains, bearing > 0 ? held / static_cast<double>(bearing) : undefined,
          1 - static_cast<double>(bearing) / grains};
}

}  // namespace grainlaw::dem::observe
