// A packing brought into balance, and what a table of moduli says of it: state, moduli, elastic constants.
#pragma once

#include <string>
#include <vector>

#include "grainlaw/dem/balance/minimise.hpp"
#include "grainlaw/dem/balance/static_packing.hpp"
#include "grainlaw/dem/packing/state.hpp"
#include "grainlaw/dem/stiffness/linear_response.hpp"
#include "grainlaw/dem/stiffness/probe.hpp"
#include "grainlaw/element/material.hpp"
#include "grainlaw/element/path.hpp"

namespace grainlaw::dem {

/// Rows hold the columns of moduli_columns() from `nu` on. All over k*.
class ProbedPacking {
 public:
  /// Largest net force over the mean contact force, below which a packing is in balance: the stress errs by
  /// about that, times P.
  static constexpr double balance = 1e-10;

  /// Takes grains and box of `state` at rest and minimises their energy. `axis` is the deviator along which
  /// sigma_dev, F_dev and the moduli count.
  ProbedPacking(const Material& material, const State& state, const StrainTensor& axis,
                double residual = balance);

  /// Why it has no moduli: nothing bears load, too few contacts, not in balance. Empty where it has.
  std::string refusal() const;
  bool in_balance() const { return result_.outcome != Outcome::gave_up; }

  /// The row of its linear response; its moduli are empty where it is refused. Throws Error where the
  /// equations of the response cannot be solved.
  std::vector<double> row();
  std::vector<double> row_without_moduli() const;
  std::vector<double> row(const LinearResponse& response) const;
  /// The row of a strain that was applied.
  std::vector<double> row(const Probe& probe) const;

  LinearResponse response() { return linear_response(packing_); }
  /// Strains copies of it (see dem/stiffness/probe.hpp).
  Probe probe(double amplitude, bool undo) const;
  const StaticPacking& packing() const { return packing_; }

 private:
  std::vector<double> row_of(double residual, double amplitude, const Moduli& moduli, double changed,
                             double unstable, const Stiffness* energy) const;

  StrainTensor axis_;
  double residual_, k_star_;
  StaticPacking packing_;
  MinimiseResult result_;
  std::vector<double> state_;  ///< nu to contacts
};

}  // namespace grainlaw::dem
