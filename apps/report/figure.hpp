// A figure as data: panels with series. Drawn by gnuplot, placed in the page with its legend as text beside
// it.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "grainlaw/apps/report/html.hpp"

namespace grainlaw::report {

/// `shade`: from the values down to the lower edge of the panel.
enum class Draw { dots, line, dashes, dotted, bars, shade };

struct Series {
  std::string label;  ///< plain text for legend and tooltip; series of one label share an entry
  Draw draw = Draw::line;
  std::string colour;           ///< "#rrggbb", or "black" for the page's own
  std::vector<double> x, y;     ///< a NaN breaks a line
  std::vector<double> error{};  ///< only for bars
  bool sets_range = true;       ///< false: does not widen the axes
  bool in_legend = true;
};

/// Where the plotting area lies in the figure, in pixels from its left upper corner.
struct Area {
  double left, top, width, height;
};

struct Panel {
  Area area;
  std::string title;             ///< plain text
  std::string x_label, y_label;  ///< gnuplot enhanced text, see axis_label()
  std::vector<Series> series;
  std::optional<std::array<double, 2>> x_range, y_range;  ///< else from the data
  double right_unit = 0;  ///< not zero: a second scale on the right, y times this
  std::string right_label{};
  bool x_numbers = true;   ///< false: axis shared with the panel below
  bool zero_line = false;  ///< draws y = 0
  /// Logarithmic axes: values that have no logarithm are not drawn, ranges given are common logarithms.
  bool log_x = false, log_y = false;
};

struct Figure {
  std::string name;  ///< unique in the page
  std::string alt;   ///< one line for readers who cannot see it
  Markup caption;
  double width = 920, height = 320;
  std::vector<Panel> panels;
  std::vector<Series> key{};     ///< more entries of the legend, without data
  std::string smallest_width{};  ///< CSS length below which the figure scrolls, e.g. "560px"
};

/// Areas of a grid of equal panels, row by row, with room for titles and labels; sets the figure's height.
std::vector<Area> grid(Figure& figure, std::size_t count, std::size_t columns, double panel_height,
                       double right_margin = 16);

/// What a figure is drawn on: an SVG for a page or a file, or a PNG of twice as many pixels.
enum class Canvas { svg, png };

/// The gnuplot script of a figure.
std::string script(const Figure& figure, Canvas canvas = Canvas::svg);

/// <figure> with legend, drawing and caption. Throws Error if gnuplot is missing or refuses.
Markup draw(const Figure& figure);

/// Every n-th element, first and last kept, so that at most `most` remain (at least 2).
std::vector<double> thinned(const std::vector<double>& values, std::size_t most);

}  // namespace grainlaw::report
