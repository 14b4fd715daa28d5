#include "grainlaw/apps/prediction_picture.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "grainlaw/apps/report/figure.hpp"
#include "grainlaw/apps/report/gnuplot.hpp"
#include "grainlaw/apps/report/symbols.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/element/file.hpp"

namespace grainlaw::apps {

namespace {

using namespace report;

constexpr std::size_t most_points = 4000;  // of a curve

/// The column as the table names it: in kPa with --si.
std::string column_of(const Record& table, const std::string& name) {
  return table.has(name + "_kPa") ? name + "_kPa" : name;
}

/// A stress in kPa has no star, which says that one is over k*.
std::string in_kPa(const std::string& name) {
  return std::string(name == "P" ? "{/:Italic P}" : "{/:Italic σ}_{dev}") + " (kPa)";
}

std::string label_of(const std::string& column, const std::string& name) {
  return column == name ? axis_label(name, name) : in_kPa(name);
}

double range_of(const std::vector<double>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return *high - *low;
}

Panel panel_of(Area area, const Record& table, const std::string& x, const std::string& y) {
  const std::string x_column = column_of(table, x), y_column = column_of(table, y);
  Panel panel{area, "", label_of(x_column, x), label_of(y_column, y), {}, {}, {}};
  const auto &xs = table[x_column], &ys = table[y_column];
  panel.series.push_back({"", Draw::line, nth_colour(0), thinned(xs, most_points), thinned(ys, most_points)});
  Series ends{"", Draw::dots, ink, {}, {}};
  const auto& segment = table["segment"];
  for (std::size_t i = 0; i < table.rows(); ++i)
    if (i == 0 || i + 1 == table.rows() || segment[i + 1] != segment[i]) {
      ends.x.push_back(xs[i]);
      ends.y.push_back(ys[i]);
    }
  panel.series.push_back(std::move(ends));
  panel.zero_line = y == "sigma_dev" || y == "s_dev" || y == "F_dev";
  return panel;
}

void write(const std::filesystem::path& file, const Figure& figure) {
  const Canvas canvas = file.extension() == ".png" ? Canvas::png : Canvas::svg;
  write_file(file, run_gnuplot(script(figure, canvas)));
}

}  // namespace

void check_picture(const std::filesystem::path& file) {
  if (file.extension() != ".svg" && file.extension() != ".png")
    throw Error("", "--plot", "must end in .svg or .png, got " + file.string());
}

void write_picture(const std::filesystem::path& file, const Record& prediction) {
  const std::string x =
      range_of(prediction["eps_vol"]) > (1 + 1e-9) * range_of(prediction["eps_dev"]) ? "eps_vol" : "eps_dev";
  const std::vector<std::pair<std::string, std::string>> panels{
      {x, "P"}, {x, "sigma_dev"}, {x, "s_dev"}, {x, "F_dev"}, {x, "nu"}, {"P", "sigma_dev"}};
  Figure figure;
  figure.width = 1040;
  const auto areas = grid(figure, panels.size(), 3, 210);
  for (std::size_t i = 0; i < panels.size(); ++i)
    figure.panels.push_back(panel_of(areas[i], prediction, panels[i].first, panels[i].second));
  write(file, figure);
}

void write_envelope_picture(const std::filesystem::path& file, const Record& responses) {
  Figure figure;
  figure.width = 820;
  const auto areas = grid(figure, 2, 2, 320);
  const auto add = [&](Area area, const std::string& title, const std::string& x, const std::string& y,
                       const std::string& x_label, const std::string& y_label) {
    Panel panel{area, title, x_label, y_label, {}, {}, {}};
    Series line{"", Draw::line, nth_colour(0), responses[x], responses[y]};
    line.x.push_back(line.x.front());  // the curve is closed
    line.y.push_back(line.y.front());
    Series dots = line;
    dots.draw = Draw::dots;
    Series begin{"", Draw::dots, ink, {0}, {0}};
    for (Series* series : {&line, &dots, &begin}) panel.series.push_back(*series);
    panel.zero_line = true;
    figure.panels.push_back(std::move(panel));
  };
  const bool si = responses.has("dP_kPa");
  const auto response = [&](const std::string& name) {
    return "{/Symbol D}" + (si ? in_kPa(name) : std::string(find_symbol(name)->plot));
  };
  const std::string tail = si ? "_kPa" : "";
  add(areas[0], "strain increments", "eps_vol", "eps_dev", axis_label("eps_vol", "eps_vol"),
      axis_label("eps_dev", "eps_dev"));
  add(areas[1], "responses", "dP" + tail, "dsigma_dev" + tail, response("P"), response("sigma_dev"));
  write(file, figure);
}

}  // namespace grainlaw::apps
