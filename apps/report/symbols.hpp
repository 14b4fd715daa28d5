// The one list of symbols: how each is written in a page and in a figure, its unit and what it means in one
// line.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "grainlaw/apps/report/html.hpp"

namespace grainlaw::report {

struct Symbol {
  std::string_view key;      ///< the name in files; "group.name" where two groups use one name
  std::string_view html;     ///< in a page
  std::string_view plot;     ///< in a figure: gnuplot's enhanced text
  std::string_view unit;     ///< "–" for a pure number
  std::string_view meaning;  ///< one line, for a reader who has not read the thesis
};

/// A part of the glossary.
struct SymbolGroup {
  std::string_view title;
  std::vector<Symbol> symbols;
};

const std::vector<SymbolGroup>& symbol_groups();

/// The symbol of a name; `group` (isotropic, shear, moduli, memory) decides between meanings. Null if
/// unknown.
const Symbol* find_symbol(std::string_view name, std::string_view group = "");

/// The symbol in a page; an unknown name as it stands.
Markup symbol(std::string_view name, std::string_view group = "");

/// "volume fraction ν (–)" for an axis, in gnuplot's enhanced text; an unknown name or a fallback label is
/// escaped.
std::string axis_label(const std::string& name, const std::string& fallback);

/// Plain text as gnuplot enhanced text that prints just that.
std::string enhanced(std::string_view plain);

/// "ISO", "UNI", "D2", "D3"; other names unchanged.
std::string mode_name(const std::string& mode);
/// "closed form", "rate form", "coupled"; other names unchanged.
std::string form_name(const std::string& form);

/// Colours that differ for colour-blind readers too and stand out on white and on black (after Okabe and
/// Ito).
std::string mode_colour(const std::string& mode);
std::string form_colour(const std::string& form);
/// Colour of the n-th of several runs.
std::string nth_colour(std::size_t n);
/// Shade of grey for the DEM's points of the n-th seed; after three they begin again.
std::string seed_grey(std::size_t n);
/// From dark to bright as `share` goes from 0 to 1: loose to dense.
std::string ramp(double share);
inline constexpr const char* measured_colour = "#808080";
inline constexpr const char* ink = "black";  ///< drawn in the page's own text colour

}  // namespace grainlaw::report
