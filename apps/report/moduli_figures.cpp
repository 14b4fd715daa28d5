#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "grainlaw/apps/report/figure.hpp"
#include "grainlaw/apps/report/numbers.hpp"
#include "grainlaw/apps/report/prose.hpp"
#include "grainlaw/apps/report/sections.hpp"
#include "grainlaw/apps/report/symbols.hpp"

namespace grainlaw::report {
namespace {

constexpr std::size_t dots_per_test = 60;

/// Axes of a panel, by the name of the fit.
struct Axes {
  const char *name, *x, *y;
};
constexpr std::array<Axes, 6> all_axes{{
    {"moduli.B", "fabric trace {/:Italic F}_v (–)", "bulk modulus {/:Italic B} (–)"},
    {"moduli.A1", "contact anisotropy {/:Italic F}_{dev} (–)", "{/:Italic A}_1/{/:Italic B} (–)"},
    {"moduli.A2", "contact anisotropy {/:Italic F}_{dev} (–)", "{/:Italic A}_2/{/:Italic B} (–)"},
    {"moduli.A", "{/:Italic F}_{dev}/{/:Italic F}_v (–)", "{/:Italic A}/{/:Italic B}_0 (–)"},
    {"moduli.GB_ini", "fabric trace {/:Italic F}_v (–)", "({/:Italic G}/{/:Italic B})_{ini} (–)"},
    {"moduli.G", "{/:Italic σ}*_{dev} {/:Italic F}_{dev} (–)",
     "{/:Italic G}/{/:Italic B} − ({/:Italic G}/{/:Italic B})_{ini} (–)"},
}};

/// Volume fraction by test, from the records; tests without one are left out.
std::map<std::string, double> densities(const Inputs& inputs, const std::vector<const FitView*>& fits) {
  std::map<std::string, double> list;
  for (const FitView* fit : fits)
    for (const FitPoints& data : fit->data)
      if (const Run* run = inputs.run(data.test); run && run->record)
        list.emplace(split_seed(data.test).first, (*run->record)["nu"].front());
  return list;
}

/// Label and colour of a test by its volume fraction.
class Legend {
 public:
  explicit Legend(const std::map<std::string, double>& densities) : densities_(densities) {
    for (const auto& [test, nu] : densities) nus_.push_back(nu);
    std::sort(nus_.begin(), nus_.end());
  }
  Series dots(const FitPoints& data) const {
    const auto found = densities_.find(split_seed(data.test).first);
    const bool known = found != densities_.end();
    Series series{known ? "ν = " + number(found->second, 3) : data.test, Draw::dots,
                  known ? colour(found->second) : measured_colour, thinned(data.x, dots_per_test),
                  thinned(data.y, dots_per_test)};
    return series;
  }

 private:
  std::string colour(double nu) const {
    const double low = nus_.front(), high = nus_.back();
    return ramp(high > low ? (nu - low) / (high - low) : 0);
  }
  const std::map<std::string, double>& densities_;
  std::vector<double> nus_;
};

/// Loose tests first, so that the legend runs from loose to dense.
std::vector<const FitPoints*> by_density(const FitView& fit, const std::map<std::string, double>& densities) {
  std::vector<const FitPoints*> list;
  for (const FitPoints& data : fit.data) list.push_back(&data);
  const auto nu = [&](const FitPoints* data) {
    const auto found = densities.find(split_seed(data->test).first);
    return found == densities.end() ? 2.0 : found->second;
  };
  std::stable_sort(list.begin(), list.end(), [&](const auto* a, const auto* b) { return nu(a) < nu(b); });
  return list;
}

Panel panel_of(const FitView& fit, const std::map<std::string, double>& densities, Area area) {
  const auto axes =
      std::find_if(all_axes.begin(), all_axes.end(), [&](const Axes& a) { return fit.name == a.name; });
  Panel panel{area, "", axes->x, axes->y, {}, {}, {}};
  const Legend legend(densities);
  for (const FitPoints* data : by_density(fit, densities)) panel.series.push_back(legend.dots(*data));
  panel.series.push_back({"fit", Draw::line, mode_colour("d2"), fit.curve.x, fit.curve.y});
  panel.series.push_back({"thesis, Table 4.1", Draw::dashes, ink, fit.thesis_curve.x, fit.thesis_curve.y});
  panel.series.back().sets_range = false;
  return panel;
}

Markup caption(const std::vector<const FitView*>& fits) {
  Markup text_of =
      "<b>Small-strain moduli along D2</b>, of packings brought into balance, by the linear response of "
      "their "
      "contacts (Figs. 4.10 – 4.13 of the thesis), over k*. One dot is one state; one dot is one test for (G/B)<sub>ini</sub>. "_html;
  for (const FitView* fit : fits) text_of += prose(fit->law, fit->group) + ". "_html;
  return text_of;
}

}  // namespace

Markup moduli_figures(const Inputs& inputs, const std::vector<FitView>& fits) {
  std::vector<const FitView*> laws;
  for (const Axes& axes : all_axes)
    for (const FitView& fit : fits)
      if (fit.name == axes.name && !fit.data.empty()) laws.push_back(&fit);
  if (laws.empty()) return {};
  const auto nu = densities(inputs, laws);
  Figure figure;
  figure.name = "moduli";
  figure.alt = "Bulk modulus, anisotropy moduli and shear modulus of sheared packings over fabric and stress";
  figure.smallest_width = "560px";
  const auto areas = grid(figure, laws.size(), 2, 230);
  for (std::size_t i = 0; i < laws.size(); ++i) figure.panels.push_back(panel_of(*laws[i], nu, areas[i]));
  figure.caption = caption(laws);
  return "<h3>Small-strain moduli</h3>\n"_html + draw(figure);
}

}  // namespace grainlaw::report
