// Calls the program gnuplot: a script in, an SVG out.
#pragma once

#include <string>

namespace grainlaw::report {

/// Runs `program` with default settings, feeds it `script` and returns what it printed. No shell takes part.
/// Throws Error naming the package if the program is not installed, or with gnuplot's own message if it
/// refuses.
std::string run_gnuplot(const std::string& script, const std::string& program = "gnuplot");

/// A text as a gnuplot string in single quotes, in which gnuplot neither runs backquotes nor expands macros;
/// an apostrophe becomes ’.
std::string gnuplot_quoted(const std::string& text);

}  // namespace grainlaw::report
