#include "grainlaw/apps/bench_model_page.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "grainlaw/apps/bench_legend.hpp"
#include "grainlaw/apps/report/figure.hpp"
#include "grainlaw/apps/report/gnuplot.hpp"
#include "grainlaw/apps/report/symbols.hpp"

namespace grainlaw::apps {

namespace {

using namespace report;

const std::vector<std::string>& methods() {
  static const std::vector<std::string> names{"CVODE BDF",        "CVODE Adams",    "light",
                                              "Bogacki-Shampine", "Dormand-Prince", "RODAS"};
  return names;
}

/// A line with dots on it.
void add_curve(Panel& panel, const std::string& label, const std::string& colour,
               const std::vector<double>& x, const std::vector<double>& y) {
  if (x.empty()) return;
  Series dots{label, Draw::dots, colour, x, y}, line = dots;
  line.draw = Draw::line;
  line.in_legend = false;
  panel.series.push_back(line);
  panel.series.push_back(dots);
}

Panel panel_of(const std::vector<ModelTiming>& timings, const Area& area, const std::string& title,
               const std::string& kind, const std::string& path, double unit, const std::string& unit_label) {
  Panel panel{area, title, "largest relative error", unit_label, {}, {}, {}};
  panel.log_x = panel.log_y = true;
  for (std::size_t i = 0; i < methods().size(); ++i) {
    std::vector<double> x, y;
    for (const ModelTiming& t : timings)
      if (t.kind == kind && t.path == path && t.method == methods()[i]) {
        x.push_back(std::max(t.error, 1e-15));
        y.push_back(t.ns * unit);
      }
    add_curve(panel, methods()[i], nth_colour(i), x, y);
  }
  return panel;
}

Panel batch_panel(const std::vector<ModelTiming>& timings, const Area& area) {
  Panel panel{area, "Batches, rtol 1e-6", "points", "ns per increment and point", {}, {}, {}};
  panel.log_x = panel.log_y = true;
  int most = 1;
  for (const ModelTiming& t : timings) most = std::max(most, t.threads);
  const char* colours[] = {"#000000", "#888888", "#7a3b00", "#c8a060"};
  std::size_t colour = 0;
  for (const char* volume : {"at rest", "moving"})
    for (int threads = 1; threads <= most; threads = threads == most ? threads + 1 : most) {
      std::vector<double> x, y;
      for (const ModelTiming& t : timings)
        if (t.kind == "batch" && t.path == volume && t.threads == threads) {
          x.push_back(static_cast<double>(t.points));
          y.push_back(t.ns);
        }
      add_curve(panel, fmt::format("volume {}, {} thread{}", volume, threads, threads == 1 ? "" : "s"),
                colours[colour++ % 4], x, y);
    }
  return panel;
}

}  // namespace

std::string bench_model_picture(const std::vector<ModelTiming>& timings) {
  Figure figure;
  figure.name = "model-speed";
  figure.alt =
      "Cost of the law over the error of its integration, one curve per method, and cost of batches over "
      "their size";
  const auto areas = grid(figure, 6, 3, 210);
  figure.panels = {panel_of(timings, areas[0], "D2 to 0.4", "path", "monotonic", 1e-6, "ms per path"),
                   panel_of(timings, areas[1], "100 cycles of D2", "path", "cycles", 1e-6, ""),
                   panel_of(timings, areas[2], "UNI through jamming", "path", "jamming", 1e-6, ""),
                   panel_of(timings, areas[3], "D2 cycle in increments of 1e-4", "increment", "D2 cycle", 1,
                            "ns per increment"),
                   batch_panel(timings, areas[4])};
  return drawn_with_legend(std::move(figure), "");
}

}  // namespace grainlaw::apps
