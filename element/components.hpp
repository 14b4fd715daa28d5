// Names of the six components of a symmetric tensor, in the order of Sym6.
#pragma once

#include <array>

namespace grainlaw {

using ComponentNames = std::array<const char*, 6>;

/// The two axes of each component.
inline constexpr ComponentNames tensor_components{"xx", "yy", "zz", "yz", "xz", "xy"};
/// Keys of mode `control`: an axis by its one letter.
inline constexpr ComponentNames control_keys{"x", "y", "z", "yz", "xz", "xy"};
/// Columns of a record: static stress over k*, compression positive.
inline constexpr ComponentNames stress_columns{"sxx", "syy", "szz", "syz", "sxz", "sxy"};
/// Columns of a record: fabric.
inline constexpr ComponentNames fabric_columns{"Fxx", "Fyy", "Fzz", "Fyz", "Fxz", "Fxy"};

}  // namespace grainlaw
