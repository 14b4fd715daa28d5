#include "grainlaw/model/c/state_table.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "grainlaw/element/error.hpp"

namespace grainlaw::model {

namespace {

/// Places of state_names that are asked for.
constexpr std::size_t phi_J = 5;

void must(bool holds, const StateRow& row, std::size_t i, const char* what) {
  if (!holds)
    throw Error("state", state_names[i], std::string("must be ") + what + ", got " + to_text(row[i]));
}

/// Read as a state.
CoaxialState unchecked(const StateRow& row) {
  return {{.nu = row[1],
           .eps_vol = row[7],
           .eps_dev = row[8],
           .P = row[2],
           .sigma_dev = row[3],
           .F_dev = row[4],
           .phi_J = row[phi_J],
           .jammed = row[6] != 0,
           .direction = {.q = row[10],
                         .S_I = row[11],
                         .S_F_I = row[12],
                         .s_0 = row[13],
                         .F_0 = row[14],
                         .eps_dev_0 = row[15]},
           .history = {row[16], row[17], row[18]},
           .shear = {row[19], row[20], row[21], row[22]}},
          row[9]};
}

}  // namespace

std::optional<std::size_t> state_index(std::string_view name) {
  const auto* const place = std::find(state_names.begin(), state_names.end(), name);
  if (place == state_names.end()) return std::nullopt;
  return static_cast<std::size_t>(place - state_names.begin());
}

std::array<double, state_length> row_of(const CoaxialState& state) {
  const State& s = state.point;
  const Direction& d = s.direction;
  return {state_version,
          s.nu,
          s.P,
          s.sigma_dev,
          s.F_dev,
          s.phi_J,
          s.jammed ? 1.0 : 0.0,
          s.eps_vol,
          s.eps_dev,
          state.phi_J_laws,
          d.q,
          d.S_I,
          d.S_F_I,
          d.s_0,
          d.F_0,
          d.eps_dev_0,
          s.history.phi_H,
          s.history.phi_max,
          s.history.nu,
          s.shear.plus,
          s.shear.minus,
          s.shear.packed,
          s.shear.steady};
}

CoaxialState state_of(StateRow row) {
  must(row[0] == state_version, row, 0, "2, the layout that this grainlaw writes");
  for (std::size_t i = 0; i < state_length; ++i) must(i == phi_J || std::isfinite(row[i]), row, i, "finite");
  must(row[1] > 0, row, 1, "> 0");
  must(row[6] == 0 || row[6] == 1, row, 6, "0 or 1");
  must(row[6] == 1 ? row[2] > 0 : row[2] == 0, row, 2, row[6] == 1 ? "> 0 where jammed" : "0 where unjammed");
  must(!std::isinf(row[phi_J]), row, phi_J, "a number, or nan where it is not known");
  must(row[9] > 0, row, 9, "> 0");
  must(row[10] == 0 || std::abs(row[10]) == 1, row, 10, "-1, 0 or 1");
  must(row[11] > 0, row, 11, "> 0");
  must(row[12] > 0, row, 12, "> 0");
  for (std::size_t i = 19; i < 22; ++i) must(row[i] >= 0 && row[i] <= 1, row, i, "in [0, 1]");
  return unchecked(row);
}

}  // namespace grainlaw::model
