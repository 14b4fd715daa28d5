// Which rows of a table of moduli a fit reads: packings in a stable balance, measured without changing their
// contacts. What is left out is counted and named, never averaged in.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "grainlaw/calibrate/fit_moduli.hpp"
#include "grainlaw/element/record.hpp"

namespace grainlaw::calibrate {

/// What a table of moduli gave.
struct ModuliCount {
  std::size_t taken = 0;
  std::size_t refused = 0;   ///< packings without moduli: unjammed, below isostatic, not in balance (1e-5)
  std::size_t unstable = 0;  ///< of linear response, in a balance that is not stable
  /// Whose energy has no minimum over strains of the box (the 6x6 is not positive definite): about to
  /// rearrange, so that moduli are those of strains without a size.
  std::size_t soft = 0;
  std::size_t changed = 0;  ///< of strains that opened or closed contacts
  std::string reasons;      ///< why packings were refused, each with its strain

  std::size_t left_out() const { return refused + unstable + soft + changed; }
  /// "1 state in no stable balance; eps_dev = 0.1: unjammed: no grain bears load"; empty where nothing is
  /// left out.
  std::string text() const;
};

/// The states of `table` (read_moduli) on this segment (none: on all) with the
/// moduli of linear response; where it has none, of strains that changed no contact, row by row. Strains
/// beside a linear response say the same again and are not taken.
ModuliSeries moduli_states(const Record& table, const std::string& test, const std::string& group,
                           std::optional<std::size_t> segment, ModuliCount& count);
std::string moduli_rule();

}  // namespace grainlaw::calibrate
