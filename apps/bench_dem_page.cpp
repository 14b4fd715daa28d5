#include "grainlaw/apps/bench_dem_page.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "grainlaw/apps/bench_legend.hpp"
#include "grainlaw/apps/report/figure.hpp"
#include "grainlaw/apps/report/numbers.hpp"
#include "grainlaw/apps/report/sections.hpp"
#include "grainlaw/apps/report/style.hpp"
#include "grainlaw/apps/report/symbols.hpp"
#include "grainlaw/element/version.hpp"

namespace grainlaw::apps {

namespace {

using namespace report;
using calibrate::BenchError;
using calibrate::BenchTest;
using calibrate::Knob;

std::string label_of(Knob knob) {
  switch (knob) {
    case Knob::time_step:
      return "time step";
    case Knob::rate:
      return "rate";
    case Knob::method:
      return "method";
    case Knob::gas_step:
      return "time step of the gas";
    case Knob::count:
      return "number of grains";
  }
  return "";
}

/// "t_c/10", "× 0.3", "increments of 0.0001", "1000"
std::string value_of(const BenchError& line) {
  switch (line.knob) {
    case Knob::time_step:
    case Knob::gas_step:
      return "t_c/" + number(line.value, 4);
    case Knob::rate:
      return "× " + number(line.value, 4);
    case Knob::method:
      return line.value > 0 ? "increments of " + number(line.value, 4) : "a tenth of the rate";
    case Knob::count:
      return number(line.value, 7);
  }
  return "";
}

std::string test_name(BenchTest test) {
  return test == BenchTest::preparation ? "preparation" : mode_name(name_of(test));
}

double cost_of(const BenchError& line, BenchCost cost) {
  return cost == BenchCost::core_seconds ? line.core_s : line.particle_steps;
}

/// Error over cost of one knob, and behind it, shaded, what chance alone would make.
void add_curves(Panel& panel, const std::vector<BenchError>& errors, BenchTest test,
                const std::string& quantity, Knob knob, BenchCost cost) {
  const std::string colour = nth_colour(static_cast<std::size_t>(knob));
  Series dots{label_of(knob), Draw::dots, colour, {}, {}}, line = dots, edge = dots;
  Series band{label_of(knob) + ", chance alone", Draw::shade, colour, {}, {}};
  line.draw = Draw::line;
  edge.draw = Draw::dashes;
  line.in_legend = edge.in_legend = false;
  for (const BenchError& e : errors) {
    if (e.finest || e.test != test || e.quantity != quantity || e.knob != knob) continue;
    for (Series* series : {&dots, &line, &band, &edge}) series->x.push_back(cost_of(e, cost));
    for (Series* series : {&dots, &line}) series->y.push_back(e.comparison.error);
    for (Series* series : {&band, &edge}) series->y.push_back(e.comparison.band);
  }
  for (Series* series : {&band, &edge, &line, &dots}) panel.series.push_back(*series);
}

/// Across the panel, dashed: how far one packing is off the mean of packings, which no setting improves.
void add_packings(Panel& panel, const std::vector<BenchError>& errors, BenchTest test,
                  const std::string& quantity, BenchCost cost) {
  Series line{"one packing among others", Draw::dashes, "#777777", {}, {}};
  line.in_legend = false;
  double scatter = std::numeric_limits<double>::quiet_NaN();
  for (const BenchError& e : errors) {
    if (e.test != test || e.quantity != quantity || calibrate::compares_packings(e.knob)) continue;
    if (e.finest && !std::isfinite(scatter)) scatter = e.packings;
    if (!e.finest) line.x.push_back(cost_of(e, cost));
  }
  if (line.x.empty() || !std::isfinite(scatter)) return;
  const auto [low, high] = std::minmax_element(line.x.begin(), line.x.end());
  line.x = {*low, *high};
  line.y = {scatter, scatter};
  panel.series.push_back(std::move(line));
}

Markup caption_of(const calibrate::Bench& bench, BenchCost cost) {
  if (cost == BenchCost::particle_steps)
    return "<b>The same over grains times steps</b>"_html +
           text(
               ", which no machine changes. A step of a flow and a pass of a minimiser do not cost the "
               "same.");
  return "<b>Speed against error</b>: "_html +
         text("N = " + std::to_string(bench.count) +
              ", median seconds of a core. Dots: deviation of the mean over runs from that of the finest "
              "setting of the knob, root mean square along the path over that of the quantity. Shaded: what "
              "it would be if chance (the chaos of the flow, or of the packings where these differ) were the "
              "only difference. Dashed, grey: how far one packing is off the mean of packings.");
}

Figure figure_of(const calibrate::Bench& bench, const std::vector<BenchError>& errors, BenchCost cost) {
  const bool seconds = cost == BenchCost::core_seconds;
  std::vector<std::pair<BenchTest, std::string>> panels;
  for (const BenchError& e : errors)
    if (const std::pair key{e.test, e.quantity}; std::find(panels.begin(), panels.end(), key) == panels.end())
      panels.push_back(key);
  Figure figure;
  figure.name = seconds ? "speed-against-error" : "steps-against-error";
  figure.alt = std::string("Error relative to the finest setting over ") +
               (seconds ? "seconds of a core" : "particle-steps") + ", one curve per knob";
  figure.smallest_width = "640px";
  const auto areas = grid(figure, panels.size(), 3, 190);
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const auto& [test, quantity] = panels[i];
    const Symbol* symbol = find_symbol(quantity);
    Panel panel{areas[i],
                enhanced(test_name(test)) + ": " + (symbol ? std::string(symbol->plot) : quantity),
                seconds ? "seconds of a core" : "particle-steps of a run",
                i % 3 == 0 ? "relative error" : "",
                {},
                {},
                {}};
    panel.log_x = panel.log_y = true;
    add_packings(panel, errors, test, quantity, cost);
    for (const Knob knob : calibrate::all_knobs()) add_curves(panel, errors, test, quantity, knob, cost);
    figure.panels.push_back(std::move(panel));
  }
  figure.caption = caption_of(bench, cost);
  return figure;
}

Markup table_of(const std::vector<BenchError>& errors) {
  Table table;
  table.column("Test"_html).column("Quantity"_html).column("Setting"_html, Table::Kind::figures);
  table.column("Particle-steps"_html, Table::Kind::figures).column("Core time"_html, Table::Kind::figures);
  table.column("Error"_html, Table::Kind::figures).column("Chance alone"_html, Table::Kind::figures);
  table.column("Offset"_html, Table::Kind::figures).column("Scatter of a run"_html, Table::Kind::figures);
  table.column("Scatter of packings"_html, Table::Kind::figures);
  std::optional<Knob> group;
  for (const BenchError& e : errors) {
    if (group != e.knob) table.group(text(label_of(e.knob)));
    group = e.knob;
    const auto known = [](double x) { return text(std::isfinite(x) ? percent(x) : nothing); };
    const auto share = [&](double x) { return e.finest ? text(nothing) : known(x); };
    table.row({text(test_name(e.test)), symbol(e.quantity), text(value_of(e)),
               text(number(e.particle_steps, 3)), text(std::isfinite(e.core_s) ? seconds(e.core_s) : nothing),
               e.finest ? "finest"_html : share(e.comparison.error), share(e.comparison.band),
               share(e.comparison.offset), known(e.scatter), known(e.packings)});
  }
  return table.html();
}

}  // namespace

std::string bench_page(const calibrate::Bench& bench, const std::vector<BenchError>& errors,
                       const std::string& advice) {
  const std::string title = "Speed against error of the DEM, N = " + std::to_string(bench.count);
  Markup body = element("h1", text(title)) + "\n"_html +
                element("p", text("grainlaw " + build_name(version(), commit())), {{"class", "lead"}});
  body += element("pre", text(advice)) + "\n"_html;
  if (!errors.empty()) {
    for (const BenchCost cost : {BenchCost::core_seconds, BenchCost::particle_steps})
      body += draw(figure_of(bench, errors, cost));
    body += table_of(errors);
  }
  const Markup head = "<meta charset=\"utf-8\"/>\n"_html + element("title", text(title)) +
                      element("style", Markup::trusted(style_sheet));
  return "<!DOCTYPE html>\n" +
         element("html", element("head", head) + element("body", body), {{"lang", "en"}}).str() + "\n";
}

std::string bench_picture(const calibrate::Bench& bench, const std::vector<BenchError>& errors,
                          BenchCost cost) {
  return drawn_with_legend(figure_of(bench, errors, cost),
                           "shaded: chance alone; dashed, grey: one packing among others");
}

}  // namespace grainlaw::apps
