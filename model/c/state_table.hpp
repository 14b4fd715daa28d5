// The state of a point as a row of numbers with names, for hosts that keep it and for files. The row begins
// with the number of its layout, so that a row of zeros or of another layout is known for what it is.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

#include "grainlaw/model/c/coaxial.hpp"

namespace grainlaw::model {

/// Of the layout. Callers that ask for lengths and for places by name live through a change of it.
inline constexpr int state_version = 2;

inline constexpr std::array state_names{
    "version",
    "nu",            ///< volume fraction
    "P",             ///< over k*
    "sigma_dev",     ///< over k*, signed
    "F_dev",         ///< signed
    "phi_J",         ///< at and below it the point is unjammed; NaN where the start could not tell
    "jammed",        ///< 1 or 0
    "eps_vol",       ///< ln(nu/nu_start)
    "eps_dev",       ///< since the start
    "phi_J_laws",    ///< the jamming density at which the laws stand
    "direction",     ///< q of the present direction of shear: 1 or -1; 0: the next shear begins one
    "S_I",           ///< |1 - q s/s_max| where it began (Eq. 4.16)
    "S_F_I",         ///< |1 - q F_dev/F_max| there
    "s_dev_0",       ///< s_dev there (Eq. 2.17)
    "F_dev_0",       ///< F_dev there (Eq. 2.18)
    "eps_dev_0",     ///< eps_dev there
    "phi_H",         ///< form memory: phi_J of the isotropic packing; 0 in the others, as what follows
    "phi_max",       ///< largest volume fraction seen
    "phi_H_nu",      ///< volume fraction where this is so
    "memory_plus",   ///< u of shear with d eps_dev > 0, in [0, 1] (laws/shear_memory.hpp)
    "memory_minus",  ///< the same of the other direction
    "packed",        ///< part of the way to phi_pack, in [0, 1]
    "phi_t"};        ///< jamming density of the steady state that it was sheared towards; 0.5 in the others
inline constexpr std::size_t state_length = state_names.size();
using StateRow = std::span<const double, state_length>;

std::optional<std::size_t> state_index(std::string_view name);

std::array<double, state_length> row_of(const CoaxialState& state);
/// Throws Error that names the entry for another version, and for numbers that no state has.
CoaxialState state_of(StateRow row);

}  // namespace grainlaw::model
