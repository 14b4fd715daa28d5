// Packings at rest along shear, and unloaded after it.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "grainlaw/apps/report/figure.hpp"
#include "grainlaw/apps/report/numbers.hpp"
#include "grainlaw/apps/report/sections.hpp"
#include "grainlaw/apps/report/symbols.hpp"

namespace grainlaw::report {
namespace {

constexpr double pushes = 2e-4;  ///< P* of a packing that counts as jammed, as the fits have it
constexpr double steady = 0.18;  ///< strain from which a state counts as steady, likewise
constexpr std::size_t line_points = 80;

struct Rests {
  std::vector<double> phi_J0, nu, eps_dev, P_flow, P, s_dev, C;
  std::size_t size() const { return nu.size(); }
};

Rests rests_of(const Json& relaxed) {
  Rests r{numbers_in(relaxed, "phi_J0"), numbers_in(relaxed, "nu"), numbers_in(relaxed, "eps_dev"),
          numbers_in(relaxed, "P_flow"), numbers_in(relaxed, "P"),  numbers_in(relaxed, "s_dev"),
          numbers_in(relaxed, "C")};
  const std::size_t n = std::min({r.phi_J0.size(), r.nu.size(), r.eps_dev.size(), r.P_flow.size(), r.P.size(),
                                  r.s_dev.size(), r.C.size()});
  for (auto* column : {&r.phi_J0, &r.nu, &r.eps_dev, &r.P_flow, &r.P, &r.s_dev, &r.C}) column->resize(n);
  return r;
}

/// Eq. 5.2 between phi_SJ and phi_J0.
Series jamming_line(const std::string& label, Draw draw, double phi_SJ, double phi_J0, double alpha,
                    double eps0) {
  Series line{label, draw, draw == Draw::dashes ? ink : mode_colour("d2"), {}, {}};
  for (std::size_t i = 1; i < line_points; ++i) {
    const double scaled = static_cast<double>(i) / line_points;
    line.x.push_back(phi_SJ + scaled * (phi_J0 - phi_SJ));
    line.y.push_back(eps0 * std::pow(-std::log(scaled), 1 / alpha));
  }
  line.sets_range = false;
  return line;
}

/// Eq. 5.2 as fitted, or the thesis's; none where a number is missing.
void add_line(Panel& panel, const std::vector<FitView>& fits, double phi_J0, const std::string& label,
              Draw draw, std::optional<double> FitParameter::*which) {
  std::map<std::string, double> value;
  for (const FitView& fit : fits) {
    if (fit.group != "memory" || fit.family != "eps_SJ") continue;
    for (const FitParameter& p : fit.parameters)
      if (p.*which) value[p.name] = *(p.*which);
  }
  for (const char* name : {"phi_SJ_sheared", "alpha", "eps0"})
    if (!value.contains(name)) return;
  panel.series.push_back(
      jamming_line(label, draw, value["phi_SJ_sheared"], phi_J0, value["alpha"], value["eps0"]));
}

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

/// Fig. 5.2a.
Panel phases_panel(const Rests& rests, const std::vector<FitView>& fits, Area area) {
  Panel panel{area, "", axis_label("nu", ""), axis_label("eps_dev", ""), {}, {}, {}};
  Series unjammed{"pushes neither in flow nor at rest", Draw::dots, nth_colour(0), {}, {}},
      fragile{"in flow only (fragile)", Draw::dots, nth_colour(1), {}, {}},
      jammed{"at rest (jammed)", Draw::dots, ink, {}, {}};
  for (std::size_t i = 0; i < rests.size(); ++i) {
    Series& series = rests.P[i] >= pushes ? jammed : rests.P_flow[i] >= pushes ? fragile : unjammed;
    series.x.push_back(rests.nu[i]);
    series.y.push_back(std::abs(rests.eps_dev[i]));
  }
  panel.series = {unjammed, fragile, jammed};
  const double phi_J0 = mean(rests.phi_J0);
  add_line(panel, fits, phi_J0, "Eq. 5.2, fit", Draw::line, &FitParameter::value);
  add_line(panel, fits, phi_J0, "Eq. 5.2, thesis", Draw::dashes, &FitParameter::thesis);
  return panel;
}

/// Figs. 5.12a and c, over the contacts.
Panel rest_panel(const Rests& rests, Area area) {
  Panel panel{area, "", axis_label("nu", ""), "steady stress at rest over {/:Italic νC} (–)", {}, {}, {}};
  Series pressure{"P/(νC)", Draw::dots, nth_colour(0), {}, {}},
      shear{"|σ_dev|/(νC)", Draw::dots, nth_colour(1), {}, {}};
  for (std::size_t i = 0; i < rests.size(); ++i) {
    if (std::abs(rests.eps_dev[i]) < steady || rests.P[i] < pushes || !(rests.C[i] > 0)) continue;
    const double contacts = rests.nu[i] * rests.C[i];
    pressure.x.push_back(rests.nu[i]);
    pressure.y.push_back(rests.P[i] / contacts);
    shear.x.push_back(rests.nu[i]);
    shear.y.push_back(std::abs(rests.s_dev[i]) * rests.P[i] / contacts);
  }
  panel.series = {pressure, shear};
  return panel;
}

Panel tapping_panel(const Json& tapped, Area area) {
  Panel panel{area, "", "amplitude of shear (–)", "jamming density {/:Italic φ}_J (–)", {}, {}, {}};
  const auto phi_max = numbers_in(tapped, "phi_max"), amplitude = numbers_in(tapped, "amplitude"),
             phi_J = numbers_in(tapped, "phi_J");
  std::map<double, Series> series;
  for (std::size_t i = 0; i < std::min({phi_max.size(), amplitude.size(), phi_J.size()}); ++i) {
    Series& one = series[std::round(phi_max[i] * 1e4) / 1e4];
    one.x.push_back(amplitude[i]);
    one.y.push_back(phi_J[i]);
  }
  std::size_t i = 0;
  for (auto& [largest, one] : series) {
    one.label = "φ_max = " + number(largest, 3) + " before";
    one.draw = Draw::dots;
    one.colour = nth_colour(i++);
    panel.series.push_back(one);
  }
  return panel;
}

}  // namespace

Markup memory_states_figure(const Inputs& inputs, const std::vector<FitView>& fits) {
  const Json& memory = value_in(inputs.fits, "memory");
  const Rests rests = rests_of(value_in(memory, "relaxed"));
  const Json& tapped = value_in(memory, "tapped");
  const bool taps = !numbers_in(tapped, "phi_J").empty();
  const std::size_t panels = (rests.size() > 0 ? 2 : 0) + (taps ? 1 : 0);
  if (panels == 0) return {};
  Figure figure;
  figure.name = "memory-states";
  figure.alt = "States of packings at rest along shear, their stresses, and jamming densities after shear";
  figure.smallest_width = "560px";
  const auto areas = grid(figure, panels, 2, 240);
  if (rests.size() > 0) figure.panels = {phases_panel(rests, fits, areas[0]), rest_panel(rests, areas[1])};
  if (taps) figure.panels.push_back(tapping_panel(tapped, areas.back()));
  figure.caption =
      "<b>Packings at rest along shear</b> (Figs. 5.2a and 5.12 of the thesis), <b>and unloaded after "
      "it</b>. "
      "A packing pushes where P ≥ 2·10⁻⁴; the line is Eq. 5.2 at the mean jamming density before the shear."_html;
  return draw(figure);
}

}  // namespace grainlaw::report
