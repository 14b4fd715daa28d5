#include "grainlaw/dem/balance/backbone.hpp"

#include <algorithm>
#include <numeric>

namespace grainlaw::dem {

void Backbone::find(const ContactNetwork& network, std::size_t grains) {
  contacts_.assign(grains, 0);
  open_.resize(std::max(open_.size(), network.count));
  std::iota(open_.begin(), open_.begin() + static_cast<std::ptrdiff_t>(network.count), 0u);
  for (std::size_t c = 0; c < network.count; ++c) {
    ++contacts_[network.pairs[c].i];
    ++contacts_[network.pairs[c].j];
  }
  // A pass takes the contacts of grains that are out from those that still hold; a grain is out for good,
  // because its count only falls.
  inside_ = network.count;
  for (bool fell = true; fell;) {
    std::size_t kept = 0;
    fell = false;
    for (std::size_t n = 0; n < inside_; ++n) {
      const auto [i, j] = network.pairs[open_[n]];
      const bool both = holds(i) && holds(j);
      open_[kept] = open_[n];
      kept += both ? 1u : 0u;
      if (both) continue;
      for (const std::uint32_t g : {i, j})
        if (contacts_[g]-- == least_contacts) fell = true;
    }
    inside_ = kept;
  }
  grains_ = 0;
  for (std::size_t g = 0; g < grains; ++g) grains_ += holds(g) ? 1u : 0u;
  mean_force_ = 0;
  for (std::size_t n = 0; n < inside_; ++n) mean_force_ += network.force[open_[n]];
  if (inside_ > 0) mean_force_ /= static_cast<double>(inside_);
}

ContactNetwork bearing(const ContactNetwork& all, const Backbone& backbone) {
  ContactNetwork some;
  for (std::size_t c = 0; c < all.count; ++c) {
    if (!backbone.joins(all, c)) continue;
    some.pairs.push_back(all.pairs[c]);
    some.normal.push_back(all.normal[c]);
    some.force.push_back(all.force[c]);
    some.stiffness.push_back(all.stiffness[c]);
  }
  some.count = some.pairs.size();
  return some;
}

}  // namespace grainlaw::dem
