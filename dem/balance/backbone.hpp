// The grains that bear load: what is left when those that cannot be in stable balance are taken out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "grainlaw/dem/balance/contact_network.hpp"

namespace grainlaw::dem {

/// A frictionless sphere rests stably on no fewer than four contacts. Grains with fewer are taken out, then
/// those that have fewer than four left, and so on: these are the rattlers, the rest is the backbone. It is
/// stricter than the count of C* (grains with four contacts, whoever holds them).
class Backbone {
 public:
  void find(const ContactNetwork& network, std::size_t grains);

  bool holds(std::size_t grain) const { return contacts_[grain] >= least_contacts; }
  /// Whether contact c joins two grains of the backbone.
  bool joins(const ContactNetwork& network, std::size_t c) const {
    return holds(network.pairs[c].i) && holds(network.pairs[c].j);
  }
  std::size_t grains() const { return grains_; }    ///< in it
  std::size_t contacts() const { return inside_; }  ///< between two of them
  /// The fewest contacts that hold a backbone under load in a box at rest: each of its 3 (grains - 1)
  /// displacements needs one, and forces in balance one more. Below, some displacements meet no stiffness;
  /// at or above there may still be some, see floppy_modes().
  std::size_t isostatic() const { return grains_ == 0 ? 0 : 3 * grains_ - 2; }
  double mean_force() const { return mean_force_; }  ///< of these contacts, ug mm/us^2; 0 without any

  static constexpr std::uint32_t least_contacts = 4;

 private:
  std::vector<std::uint32_t> contacts_;  ///< of each grain with grains of the backbone
  std::vector<std::uint32_t> open_;      ///< contacts between grains not yet taken out
  std::size_t grains_ = 0, inside_ = 0;
  double mean_force_ = 0;
};

/// The contacts between grains of the backbone; its energy is left 0.
ContactNetwork bearing(const ContactNetwork& all, const Backbone& backbone);

}  // namespace grainlaw::dem
