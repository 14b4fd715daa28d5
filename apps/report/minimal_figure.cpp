// Fig. 5.4 of the thesis: cycles of compression and of shear, by grains and by the minimal form.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "grainlaw/apps/report/figure.hpp"
#include "grainlaw/apps/report/numbers.hpp"
#include "grainlaw/apps/report/sections.hpp"
#include "grainlaw/apps/report/symbols.hpp"

namespace grainlaw::report {
namespace {

constexpr double loosest_shown = 0.65;  ///< nu: below it nothing carries a load

/// A test of grains and what the form says of it.
struct Pair {
  const PredictedRun* law = nullptr;
  const Run* grains = nullptr;
  explicit operator bool() const { return law != nullptr; }
};

/// Columns that the figure draws.
bool complete(const Record& record) {
  for (const char* column : {"segment", "C_star", "f_NR"})
    if (!record.has(column)) return false;
  return record.rows() > 0;
}

double last_segment(const Record& record) { return record["segment"].back(); }

/// Of the tests in this mode that have both, the one of the most segments; of equals, the middle one.
Pair longest(const Inputs& inputs, const std::string& mode) {
  std::vector<Pair> pairs;
  for (const PredictedRun& run : inputs.predicted_memory) {
    const Run* grains = inputs.run(text_in(run.entry, "test"));
    if (text_in(run.entry, "mode") != mode || grains == nullptr || !grains->record || !run.record) continue;
    if (!complete(*grains->record) || !complete(*run.record) || !run.record->has("phi_J")) continue;
    if (!pairs.empty() && last_segment(*run.record) > last_segment(*pairs.front().law->record)) pairs.clear();
    if (pairs.empty() || last_segment(*run.record) == last_segment(*pairs.front().law->record))
      pairs.push_back({&run, grains});
  }
  return pairs.empty() ? Pair{} : pairs[pairs.size() / 2];
}

constexpr double loads = 1e-4;  ///< P* from which C* and s_dev of grains are more than noise

double shown(const Record& record, const std::string& column, std::size_t row) {
  const bool needs_contacts = column == "s_dev" || column == "C_star";
  return needs_contacts && !(record["P"][row] >= loads) ? NAN : record[column][row];
}

/// Rows of two segments over nu.
Series over_density(const Record& record, const std::string& column, double first, Series style) {
  for (std::size_t i = 0; i < record.rows(); ++i) {
    const double segment = record["segment"][i];
    if (segment != first && segment != first + 1) continue;
    style.x.push_back(record["nu"][i]);
    style.y.push_back(shown(record, column, i));
  }
  return style;
}

/// All rows over the length of the way in eps_dev.
Series over_way(const Record& record, const std::string& column, Series style) {
  double way = 0;
  for (std::size_t i = 0; i < record.rows(); ++i) {
    if (i > 0) way += std::abs(record["eps_dev"][i] - record["eps_dev"][i - 1]);
    style.x.push_back(way);
    style.y.push_back(shown(record, column, i));
  }
  return style;
}

Panel cycles_panel(const Pair& pair, const std::string& column, Area area) {
  Panel panel{area, "", axis_label("nu", ""), axis_label(column, ""), {}, {}, {}};
  const double last = std::max(0.0, last_segment(*pair.law->record) - 1);
  std::size_t colour = 0;
  for (const double first : {0.0, last}) {
    const std::string cycle = "cycle " + number(first / 2 + 1, 3);
    const std::string shade = nth_colour(colour++);
    panel.series.push_back(
        over_density(*pair.grains->record, column, first, {cycle + ", DEM", Draw::dots, shade, {}, {}}));
    panel.series.push_back(
        over_density(*pair.law->record, column, first, {cycle + ", minimal", Draw::line, shade, {}, {}}));
    if (first == last) break;
  }
  const auto& nu = (*pair.law->record)["nu"];
  panel.x_range = {{loosest_shown, *std::max_element(nu.begin(), nu.end())}};
  return panel;
}

Panel shear_panel(const Pair& pair, const std::string& column, Area area) {
  Panel panel{area, "", "length of the way in {/:Italic ε}_{dev} (–)", axis_label(column, ""), {}, {}, {}};
  const Record &grains = *pair.grains->record, &law = *pair.law->record;
  if (column != "phi_J")
    panel.series.push_back(over_way(grains, column, {"DEM", Draw::dots, measured_colour, {}, {}}));
  panel.series.push_back(over_way(law, column, {"minimal", Draw::line, form_colour("minimal"), {}, {}}));
  if (column == "phi_J") {
    const double end = panel.series.back().x.back(), nu = law["nu"].front();
    panel.series.push_back({"ν", Draw::dashes, ink, {0, end}, {nu, nu}});
  }
  return panel;
}

}  // namespace

Markup minimal_figure(const Inputs& inputs) {
  const Pair cycles = longest(inputs, "iso"), shear = longest(inputs, "d2");
  if (!cycles && !shear) return {};
  std::vector<std::pair<const Pair*, std::string>> panels;
  if (cycles)
    for (const char* column : {"P", "C_star"}) panels.emplace_back(&cycles, column);
  if (shear)
    for (const char* column : {"s_dev", "F_dev", "f_NR", "C_star", "P", "phi_J"})
      panels.emplace_back(&shear, column);
  Figure figure;
  figure.name = "minimal";
  figure.alt = "Cycles of compression and of shear by the minimal form beside grains";
  figure.smallest_width = "560px";
  const auto areas = grid(figure, panels.size(), 2, 200);
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const auto& [pair, column] = panels[i];
    figure.panels.push_back(pair == &cycles ? cycles_panel(*pair, column, areas[i])
                                            : shear_panel(*pair, column, areas[i]));
  }
  figure.caption =
      "<b>The minimal form</b> (Fig. 5.4 of the thesis, its section 5.H) with the numbers near jamming, from "
      "what "
      "the campaign did to the packing before. "_html;
  if (cycles)
    figure.caption +=
        "First and last cycle of "_html + element("code", text(cycles.grains->name)) + ". "_html;
  if (shear)
    figure.caption += "Shear at constant volume: "_html + element("code", text(shear.grains->name)) +
                      ". The fits have read these tests; the form follows none of them by itself."_html;
  return draw(figure);
}

}  // namespace grainlaw::report
