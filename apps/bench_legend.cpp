#include "grainlaw/apps/bench_legend.hpp"

#include <algorithm>
#include <vector>

#include "grainlaw/apps/report/gnuplot.hpp"
#include "grainlaw/apps/report/html.hpp"
#include "grainlaw/apps/report/numbers.hpp"

namespace grainlaw::apps {

namespace {

using namespace report;

constexpr double line_height = 22;

/// Entries of the legend, from left to right, in as many lines as they need.
struct Legend {
  std::string svg;
  double height = line_height;
};

Legend legend_of(const Figure& figure, const std::string& note) {
  Legend legend;
  std::vector<std::string> seen;
  double left = 72, top = 14;
  const auto room_for = [&](const std::string& label) {
    const double width = 30 + 7.5 * static_cast<double>(label.size());
    if (left + width > figure.width && left > 72) {
      left = 72;
      top += line_height;
      legend.height += line_height;
    }
    return width;
  };
  const auto write = [&](const std::string& label, double at, const char* colour) {
    legend.svg += "<text x=\"" + number(at, 6) + "\" y=\"" + number(top + 4, 6) +
                  "\" font-family=\"sans-serif\" font-size=\"13\"" + colour + ">" + text(label).str() +
                  "</text>\n";
  };
  for (const Panel& panel : figure.panels)
    for (const Series& series : panel.series) {
      if (series.draw != Draw::dots || series.x.empty()) continue;
      if (std::find(seen.begin(), seen.end(), series.label) != seen.end()) continue;
      seen.push_back(series.label);
      const double width = room_for(series.label);
      legend.svg += "<circle cx=\"" + number(left, 6) + "\" cy=\"" + number(top, 6) + "\" r=\"4\" fill=\"" +
                    series.colour + "\"/>";
      write(series.label, left + 10, "");
      left += width;
    }
  if (!note.empty()) {
    room_for(note);
    write(note, left, " fill=\"#555\"");
  }
  return legend;
}

}  // namespace

std::string drawn_with_legend(Figure figure, const std::string& note) {
  const Legend legend = legend_of(figure, note);
  const double room = legend.height + 6;
  figure.height += room;
  for (Panel& panel : figure.panels) panel.area.top += room;
  std::string svg = run_gnuplot(script(figure));
  const auto end = svg.rfind("</svg>");
  return end == std::string::npos ? svg : svg.insert(end, legend.svg);
}

}  // namespace grainlaw::apps
