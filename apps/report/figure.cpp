#include "grainlaw/apps/report/figure.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "grainlaw/apps/report/axis.hpp"
#include "grainlaw/apps/report/gnuplot.hpp"
#include "grainlaw/apps/report/svg.hpp"

namespace grainlaw::report {
namespace {

constexpr double left_margin = 72, title_height = 26, bottom_margin = 48;
constexpr double tic_character = 6.8;  // width of a digit of a tic label, pixels

std::string digits(double x) {
  char text[40];
  return {text, std::to_chars(text, text + sizeof text, x, std::chars_format::general, 7).ptr};
}

bool drawable(const Series& series, std::size_t i) {
  return std::isfinite(series.x[i]) && std::isfinite(series.y[i]) &&
         (series.draw != Draw::bars || std::isfinite(series.error[i]));
}

bool has_points(const Series& series) {
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    if (drawable(series, i)) return true;
  }
  return false;
}

void check(const Series& series) {
  const bool even = series.x.size() == series.y.size() &&
                    (series.draw != Draw::bars || series.error.size() == series.x.size());
  if (!even) throw std::logic_error("a series needs as many x as y");
}

/// $name << EOD … EOD; an undefined point leaves an empty line, which breaks a line and is no dot.
std::string data_block(const std::string& name, const Series& series) {
  std::string block = "$" + name + " << EOD\n";
  bool broken = true;
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    if (!drawable(series, i)) {
      if (!broken) block += "\n";
      broken = true;
      continue;
    }
    block += digits(series.x[i]) + " " + digits(series.y[i]);
    if (series.draw == Draw::bars) block += " " + digits(series.error[i]);
    block += "\n";
    broken = false;
  }
  return block + "EOD\n";
}

std::string plot_item(const std::string& name, const Series& series) {
  const std::string colour = " lc rgb " + gnuplot_quoted(series.colour);
  const std::string what = "$" + name + " using 1:2";
  switch (series.draw) {
    case Draw::dots:
      // Few points need not be small.
      return what + " with points pt 7 ps " + (series.x.size() <= 40 ? "0.45" : "0.32") + colour;
    case Draw::bars:
      return what + ":3 with yerrorbars pt 7 ps 0.45 lw 1.2" + colour;
    case Draw::line:
      return what + " with lines lw 2" + colour;
    case Draw::dashes:
      return what + " with lines lw 1.8 dt (7,4)" + colour;
    case Draw::dotted:
      return what + " with lines lw 2 dt (2,3)" + colour;
    case Draw::shade:
      return what + " with filledcurves x1 fs transparent solid 0.15 noborder" + colour;
  }
  return what;
}

std::array<double, 2> range_of(const Panel& panel, bool along_x) {
  const auto& given = along_x ? panel.x_range : panel.y_range;
  if (given) return *given;
  std::vector<double> values;
  const auto collect = [&](const Series& series) {
    const auto& data = along_x ? series.x : series.y;
    for (std::size_t i = 0; i < data.size(); ++i) {
      if (!drawable(series, i)) continue;
      const double reach = !along_x && series.draw == Draw::bars ? series.error[i] : 0;
      values.push_back(data[i] - reach);
      values.push_back(data[i] + reach);
    }
  };
  for (const Series& series : panel.series) {
    if (series.sets_range) collect(series);
  }
  if (values.empty()) {
    for (const Series& series : panel.series) collect(series);
  }
  if (panel.zero_line && !along_x) values.push_back(0);
  return padded_range(values);
}

std::string tics(const std::string& axis_name, const Axis& axis, bool labelled) {
  std::string line = "set " + axis_name + "tics (";
  for (std::size_t i = 0; i < axis.tics.size(); ++i) {
    if (i > 0) line += ", ";
    line += gnuplot_quoted(labelled ? axis.tics[i].label : "") + " " + digits(axis.tics[i].at);
  }
  return line + ")\n";
}

constexpr std::size_t least_tics = 3;  // of an upright axis

/// How many tic marks an upright axis of so many pixels has room for.
int tics_over(double height) { return std::max(4, static_cast<int>(height / 32)); }

/// Width of the longest tic label, pixels.
double label_width(const Axis& axis) {
  std::size_t longest = 0;
  for (const Tic& tic : axis.tics) {
    const auto characters = std::count_if(tic.label.begin(), tic.label.end(), [](char c) {
      return (static_cast<unsigned char>(c) & 0xc0) != 0x80;
    });
    longest = std::max(longest, static_cast<std::size_t>(characters));
  }
  return tic_character * static_cast<double>(longest);
}

/// What is drawn where an axis is logarithmic: the logarithms. There are no bars on such an axis.
Panel with_logarithms(Panel panel) {
  const auto take = [](std::vector<double>& values) {
    for (double& x : values) x = x > 0 ? std::log10(x) : std::nan("");
  };
  for (Series& series : panel.series) {
    if (panel.log_x) take(series.x);
    if (panel.log_y) take(series.y);
  }
  return panel;
}

/// Writes the script of one panel; text sits at positions of its own, so that gnuplot's guess of text widths
/// cannot clip it.
class PanelScript {
 public:
  PanelScript(const Figure& figure, const Panel& panel)
      : figure_(figure),
        panel_(panel),
        x_(axis_of(range_of(panel, true), panel.log_x, std::max(3, static_cast<int>(panel.area.width / 52)),
                   2)),
        y_(axis_of(range_of(panel, false), panel.log_y, tics_over(panel.area.height), least_tics)) {}

  std::string text(const std::string& first_block) const {
    return margins() + axes() + labels() + plot(first_block);
  }

 private:
  static Axis axis_of(std::array<double, 2> range, bool logarithmic, int most, std::size_t least) {
    return logarithmic ? make_log_axis(range, most) : make_axis(range, most, 1, least);
  }
  double screen_x(double px) const { return px / figure_.width; }
  double screen_y(double px) const { return 1 - px / figure_.height; }

  std::string margins() const {
    const Area& a = panel_.area;
    return "set lmargin at screen " + digits(screen_x(a.left)) + "\nset rmargin at screen " +
           digits(screen_x(a.left + a.width)) + "\nset tmargin at screen " + digits(screen_y(a.top)) +
           "\nset bmargin at screen " + digits(screen_y(a.top + a.height)) + "\n";
  }

  std::string axes() const {
    std::string text = "set xrange [" + digits(x_.low) + ":" + digits(x_.high) + "]\nset yrange [" +
                       digits(y_.low) + ":" + digits(y_.high) + "]\n" + tics("x", x_, panel_.x_numbers) +
                       tics("y", y_, true) + (panel_.zero_line ? "set" : "unset") +
                       " xzeroaxis\nunset y2tics\nset border 3\n";
    if (panel_.right_unit != 0) {
      text += "set border 11\nset y2range [" + digits(y_.low) + ":" + digits(y_.high) + "]\n" +
              tics("y2", right_axis(), true) + "set y2tics out nomirror scale 0.5 font ',11'\n";
    }
    return text;
  }

  Axis right_axis() const {
    return make_axis({y_.low, y_.high}, tics_over(panel_.area.height), panel_.right_unit, least_tics);
  }

  std::string label(int tag, const std::string& enhanced_text, double x_px, double y_px,
                    const std::string& how) const {
    if (enhanced_text.empty()) return "";
    return "set label " + std::to_string(tag) + " " + gnuplot_quoted(enhanced_text) + " at screen " +
           digits(screen_x(x_px)) + "," + digits(screen_y(y_px)) + " " + how + "\n";
  }

  std::string labels() const {
    const Area& a = panel_.area;
    const double middle = a.top + a.height / 2;
    std::string text = "unset label\n";
    // An axis without a name says its power of ten in the title.
    const bool nameless = panel_.y_label.empty() && y_.power != 0;
    const std::string title = nameless ? with_power(panel_.title, y_.power) : panel_.title;
    text += label(1, title, a.left, a.top - 12, "left font ',13'");
    if (panel_.x_numbers) {
      text += label(2, with_power(panel_.x_label, x_.power), a.left + a.width / 2, a.top + a.height + 36,
                    "center");
    }
    const double left = std::max(12.0, a.left - 22 - label_width(y_));
    if (!nameless) {
      text += label(3, with_power(panel_.y_label, y_.power), left, middle, "center rotate by 90");
    }
    if (panel_.right_unit != 0) {
      const Axis right = right_axis();
      const double at = std::min(figure_.width - 10, a.left + a.width + 27 + label_width(right));
      text += label(4, with_power(panel_.right_label, right.power), at, middle, "center rotate by 90");
    }
    return text;
  }

  std::string plot(const std::string& first_block) const {
    std::string items;
    for (std::size_t i = 0; i < panel_.series.size(); ++i) {
      if (!has_points(panel_.series[i])) continue;
      items += (items.empty() ? "" : ", ") + plot_item(first_block + std::to_string(i), panel_.series[i]);
    }
    if (!items.empty()) return "plot " + items + "\n";
    const Area& a = panel_.area;
    return label(9, "nothing to draw", a.left + a.width / 2, a.top + a.height / 2, "center") + "plot NaN\n";
  }

  const Figure& figure_;
  const Panel& panel_;
  Axis x_, y_;
};

Markup swatch(const Series& series) {
  const std::string stroke = series.colour == "black" ? "currentColor" : series.colour;
  std::string shape = "<path d=\"M1,6H27\" stroke=\"" + stroke + "\" stroke-width=\"2\"";
  if (series.draw == Draw::dashes) shape += " stroke-dasharray=\"7,4\"";
  if (series.draw == Draw::dotted) shape += " stroke-dasharray=\"2,3\"";
  shape += "/>";
  if (series.draw == Draw::shade)
    shape = "<path d=\"M1,1H27V11H1Z\" fill=\"" + stroke + "\" fill-opacity=\"0.15\"/>";
  if (series.draw == Draw::dots) shape = "<circle cx=\"14\" cy=\"6\" r=\"3\" fill=\"" + stroke + "\"/>";
  if (series.draw == Draw::bars) {
    shape = "<path d=\"M14,0V12\" stroke=\"" + stroke + "\"/><circle cx=\"14\" cy=\"6\" r=\"3\" fill=\"" +
            stroke + "\"/>";
  }
  return Markup::trusted("<svg class=\"swatch\" viewBox=\"0 0 28 12\" aria-hidden=\"true\">" + shape +
                         "</svg>");
}

/// The legend stands above the drawing, as text of the page: it cannot cover data or be cut off.
Markup legend(const Figure& figure) {
  std::vector<std::string> seen;
  Markup entries;
  const auto enter = [&](const Series& series) {
    if (series.label.empty() || std::find(seen.begin(), seen.end(), series.label) != seen.end()) return;
    seen.push_back(series.label);
    entries += element("span", swatch(series) + text(series.label));
  };
  for (const Panel& panel : figure.panels) {
    for (const Series& series : panel.series) {
      if (series.in_legend && has_points(series)) enter(series);
    }
  }
  for (const Series& entry : figure.key) enter(entry);
  return entries.empty() ? entries : element("div", entries, {{"class", "legend"}}) + "\n"_html;
}

/// The name as an id of the page: letters, digits and hyphens.
std::string identifier(std::string name) {
  for (char& c : name) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
    if (!plain) c = '-';
  }
  return name;
}

}  // namespace

std::vector<Area> grid(Figure& figure, std::size_t count, std::size_t columns, double panel_height,
                       double right_margin) {
  const double cell = figure.width / static_cast<double>(columns);
  const double row = title_height + panel_height + bottom_margin;
  std::vector<Area> areas;
  for (std::size_t i = 0; i < count; ++i) {
    const auto column = static_cast<double>(i % columns), line = static_cast<double>(i / columns);
    areas.push_back({column * cell + left_margin, line * row + title_height,
                     cell - left_margin - right_margin, panel_height});
  }
  figure.height = row * std::ceil(static_cast<double>(count) / static_cast<double>(columns));
  return areas;
}

namespace {

std::string terminal(const Figure& figure, Canvas canvas) {
  if (canvas == Canvas::png)
    return "set terminal pngcairo size " + digits(2 * figure.width) + "," + digits(2 * figure.height) +
           " enhanced font 'sans,12' fontscale 1.5 linewidth 2 pointscale 2";
  return "set terminal svg size " + digits(figure.width) + "," + digits(figure.height) +
         " dynamic enhanced font 'sans,12' name 'figure'";
}

}  // namespace

std::string script(const Figure& figure, Canvas canvas) {
  std::string text = "set encoding utf8\n" + terminal(figure, canvas) +
                     "\nunset key\nset tics out nomirror scale 0.5 font ',11'\nset xtics offset 0,0.4\n"
                     "set grid\nset xzeroaxis lt 1 lw 1 lc rgb 'black'\n";
  std::string panels;
  for (std::size_t p = 0; p < figure.panels.size(); ++p) {
    const std::string block = "d" + std::to_string(p) + "_";
    const Panel panel = with_logarithms(figure.panels[p]);
    for (std::size_t i = 0; i < panel.series.size(); ++i) {
      check(panel.series[i]);
      text += data_block(block + std::to_string(i), panel.series[i]);
    }
    panels += PanelScript(figure, panel).text(block);
  }
  return text + "set multiplot\n" + panels + "unset multiplot\n";
}

Markup draw(const Figure& figure) {
  std::vector<std::string> labels;
  for (const Panel& panel : figure.panels) {
    for (const Series& series : with_logarithms(panel).series) {
      if (has_points(series)) labels.push_back(series.label);
    }
  }
  Markup drawing = inline_svg(run_gnuplot(script(figure)), labels, figure.alt);
  if (!figure.smallest_width.empty()) {
    drawing = element("div", element("div", drawing, {{"style", "min-width:" + figure.smallest_width}}),
                      {{"class", "scroll"}});
  }
  return element("figure", legend(figure) + drawing + element("figcaption", figure.caption),
                 {{"id", "figure-" + identifier(figure.name)}}) +
         "\n"_html;
}

std::vector<double> thinned(const std::vector<double>& values, std::size_t most) {
  most = std::max<std::size_t>(most, 2);
  if (values.size() <= most) return values;
  std::vector<double> few;
  for (std::size_t i = 0; i < most; ++i) few.push_back(values[i * (values.size() - 1) / (most - 1)]);
  return few;
}

}  // namespace grainlaw::report
