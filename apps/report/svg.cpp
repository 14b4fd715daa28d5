#include "grainlaw/apps/report/svg.hpp"

#include <charconv>
#include <string_view>

#include "grainlaw/apps/report/numbers.hpp"
#include "grainlaw/element/error.hpp"

namespace grainlaw::report {
namespace {

[[noreturn]] void unexpected(const std::string& what) {
  throw Error("gnuplot wrote an SVG that the report does not understand: " + what);
}

/// The text between two marks, searched from `from`; `from` moves behind the second mark.
std::string_view between(std::string_view all, std::string_view first, std::string_view second,
                         std::size_t& from) {
  const auto start = all.find(first, from);
  if (start == std::string_view::npos) unexpected("no " + std::string(first));
  const auto begin = start + first.size();
  const auto end = all.find(second, begin);
  if (end == std::string_view::npos) unexpected("no " + std::string(second));
  from = end + second.size();
  return all.substr(begin, end - begin);
}

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
}

std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const auto end = text.find('\n');
    lines.push_back(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return lines;
}

bool is_dot(std::string_view line) { return line.find("<use ") != std::string_view::npos; }

double parse(std::string_view digits) {
  double value = 0;
  const auto [end, code] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (code != std::errc() || end != digits.data() + digits.size()) unexpected(std::string(digits));
  return value;
}

/// One dot of gnuplot's: a marker of radius 1, moved, scaled and coloured.
struct Dot {
  std::string_view position, scale, colour;
};

Dot read_dot(std::string_view line) {
  std::size_t at = 0;
  Dot dot;
  dot.position = between(line, "translate(", ")", at);
  dot.scale = between(line, "scale(", ")", at);
  dot.colour = between(line, "color='", "'", at);
  return dot;
}

/// A run of dots of one size and colour as one path of zero-length strokes with round ends.
std::string dots_path(const std::vector<Dot>& dots) {
  const double width = 2 * parse(dots.front().scale);
  std::string path = "<path class=\"dots\" stroke-linecap=\"round\" fill=\"none\" stroke=\"" +
                     std::string(dots.front().colour) + "\" stroke-width=\"" + number(width, 3) + "\" d=\"";
  for (const Dot& dot : dots) path += "M" + std::string(dot.position) + "h0";
  return path + "\"/>\n";
}

/// gnuplot opens and closes many groups with nothing inside; those go, and runs of dots become paths.
std::string tidy_lines(std::string_view body) {
  const auto lines = lines_of(body);
  std::string tidy;
  std::vector<Dot> dots;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (is_dot(lines[i])) {
      dots.push_back(read_dot(lines[i]));
      const bool run_goes_on = i + 1 < lines.size() && is_dot(lines[i + 1]) &&
                               read_dot(lines[i + 1]).colour == dots.front().colour &&
                               read_dot(lines[i + 1]).scale == dots.front().scale;
      if (!run_goes_on) {
        tidy += dots_path(dots);
        dots.clear();
      }
      continue;
    }
    const bool opens = lines[i].starts_with("<g ") && lines[i].ends_with(">");
    if (opens && i + 1 < lines.size() && lines[i + 1] == "</g>") {
      ++i;
      continue;
    }
    if (lines[i].find_first_not_of("\t ") == std::string_view::npos) continue;
    tidy += std::string(lines[i]) + "\n";
  }
  return tidy;
}

/// Replaces the ids of plots (<g id="NAME_plot_1a" ><title>…</title>) by tooltips.
std::string name_plots(std::string body, const std::vector<std::string>& labels) {
  const std::string opening = "<g id=\"", closing = "</title>";
  std::size_t plot = 0;
  for (auto at = body.find(opening); at != std::string::npos; at = body.find(opening, at + 1)) {
    const auto end = body.find(closing, at);
    if (end == std::string::npos) unexpected("a plot without a title");
    const std::string label = plot < labels.size() ? labels[plot] : "";
    const Markup title = label.empty() ? Markup() : element("title", text(label));
    body.replace(at, end + closing.size() - at, "<g>" + title.str());
    ++plot;
  }
  return body;
}

}  // namespace

Markup inline_svg(const std::string& file, const std::vector<std::string>& labels,
                  const std::string& description) {
  std::size_t at = 0;
  const std::string view_box(between(file, "viewBox=\"", "\"", at));
  between(file, "<defs>", "</defs>", at);
  const auto end = file.rfind("</g>\n</svg>");
  if (end == std::string::npos || end < at) unexpected("no </svg>");
  std::string body = tidy_lines(std::string_view(file).substr(at, end - at));
  body = name_plots(std::move(body), labels);
  for (const auto& [from, to] : {std::pair{" stroke-linecap=\"butt\" stroke-linejoin=\"miter\"", ""},
                                 {" stroke-width=\"1.00\"", ""},
                                 {" color=\"black\"", ""},
                                 {" color=\"white\"", ""},
                                 {" color=\"gray\"", ""},
                                 {" font-family=\"sans\"", ""},
                                 {"<tspan >", "<tspan>"},
                                 {"'black'", "'currentColor'"},
                                 {"\"black\"", "\"currentColor\""}}) {
    replace_all(body, from, to);
  }
  return Markup::trusted("<svg class=\"plot\" viewBox=\"" + text(view_box).str() +
                         "\" role=\"img\" aria-label=\"" + text(description).str() + "\">\n" + body +
                         "</svg>\n");
}

}  // namespace grainlaw::report
