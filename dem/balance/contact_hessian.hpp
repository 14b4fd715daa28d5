// The second derivative of the elastic energy with respect to the places of the grains, as an operator on
// displacements.
#pragma once

#include <cstddef>
#include <vector>

#include "grainlaw/dem/balance/backbone.hpp"
#include "grainlaw/dem/balance/contact_network.hpp"
#include "grainlaw/dem/numbers/field.hpp"
#include "grainlaw/element/tensor.hpp"

namespace grainlaw::dem {

/// Per contact with normal n, force f, stiffness k and distance d, the block
///
///   K = k n (x) n - (f/d) (I - n (x) n)
///
/// acts on u_i - u_j; the second term is that of the prestress, which makes networks softer than their
/// springs and may make them unstable. Stored as K = m (x) m + t I, m = sqrt(k + f/d) n, t = -f/d.
class ContactHessian {
 public:
  /// The second derivative itself. With `backbone`: without the prestress of contacts outside it, which is
  /// what makes rattlers unstable while a minimiser pushes them out of the way.
  void build(const ContactNetwork& network, std::size_t grains, const Backbone* backbone = nullptr);

  /// product = H displacement.
  void apply(const Field& displacement, Field& product) const;

  /// Symmetric blocks of the diagonal without what softens it (so never negative): xx, yy,
  /// zz, yz, xz, xy for each grain.
  const std::vector<Sym6>& diagonal() const { return diagonal_; }

  const std::vector<ContactNetwork::Pair>& pairs() const { return pairs_; }
  const Quads& springs() const { return spring_; }                     ///< m | 0
  const std::vector<double>& prestress() const { return prestress_; }  ///< t

 private:
  std::vector<ContactNetwork::Pair> pairs_;
  Quads spring_;                   ///< m | 0
  std::vector<double> prestress_;  ///< t
  std::vector<Sym6> diagonal_;
};

}  // namespace grainlaw::dem
