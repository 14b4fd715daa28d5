// Grains at rest in a box at rest: elastic energy and forces as a function of where they are. What minimisers
// move.
#pragma once

#include <cstdint>

#include "grainlaw/dem/balance/backbone.hpp"
#include "grainlaw/dem/balance/contact_network.hpp"
#include "grainlaw/dem/packing/cell.hpp"
#include "grainlaw/dem/packing/grains.hpp"
#include "grainlaw/dem/packing/state.hpp"
#include "grainlaw/dem/step/contact_law.hpp"
#include "grainlaw/dem/step/measure.hpp"
#include "grainlaw/dem/step/neighbours.hpp"
#include "grainlaw/element/material.hpp"

namespace grainlaw::dem {

/// How far a packing is from balance.
struct Balance {
  double largest_net_force = 0;  ///< of any grain, rattlers included, ug mm/us^2
  double mean_force = 0;         ///< of the contacts of the backbone, ug mm/us^2; 0 where there is none
  /// largest_net_force/mean_force; without a backbone the largest force of a contact over the stiffness times
  /// the mean radius
  double residual = 0;
  bool jammed = false;  ///< there is a backbone
};

/// Places change by move() and deform() alone, which keep the list right. grains() is where a minimiser keeps
/// what it must not lose when the grains are sorted: `motion` is its direction and `half` a field of its own.
/// Forces are elastic: the box is at rest, nothing is damped.
class StaticPacking {
 public:
  /// Takes places and radii of `state`; its velocities are forgotten.
  StaticPacking(const Material& material, const State& state);

  std::size_t count() const { return grains_.count(); }
  Grains& grains() { return grains_; }
  const Grains& grains() const { return grains_; }
  const Cell& cell() const { return cell_; }
  const ContactLaw& law() const { return law_; }
  const ContactNetwork& network() const { return network_; }
  const Backbone& backbone() const { return backbone_; }
  double unit_of_length() const { return unit_; }  ///< the mean radius, mm

  /// To a box of these edges (mm); the grains go along affinely.
  void deform(const Mat3& edges);
  /// Every grain goes `step` times its grains().motion.
  void move(double step);
  /// Fills grains().force, by the vector kernel.
  void forces();
  /// Fills grains().force, the network and its backbone.
  void find_contacts();
  /// Of the places at the last find_contacts().
  Balance balance() const;

  std::uint64_t evaluations() const { return evaluations_; }  ///< of the forces of all contacts
  std::uint64_t sorts() const { return neighbours_.sorts(); }

  Measurement measure() const;
  /// In the order of the State it began with, at rest; `time_us` and `step` are those of the state it began
  /// with.
  State state() const;

 private:
  Material material_;
  ContactLaw law_;  ///< without viscosity
  Cell cell_;
  Grains grains_;
  Neighbours neighbours_;
  ContactNetwork network_;
  Backbone backbone_;
  double unit_;
  double time_;
  std::uint64_t step_, evaluations_ = 0;
};

}  // namespace grainlaw::dem
