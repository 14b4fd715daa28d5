#include "grainlaw/apps/report/report.hpp"

#include "grainlaw/apps/report/numbers.hpp"
#include "grainlaw/apps/report/sections.hpp"
#include "grainlaw/apps/report/style.hpp"
#include "grainlaw/element/file.hpp"
#include "grainlaw/element/version.hpp"

namespace grainlaw::report {
namespace {

struct Section {
  const char* id;
  const char* title;
  Markup body;
};

Markup gaps(const Inputs& inputs) {
  if (inputs.gaps.empty()) return {};
  constexpr std::size_t most = 30;
  Markup items;
  for (std::size_t i = 0; i < inputs.gaps.size() && i < most; ++i) {
    items +=
        element("li", element("code", text(inputs.gaps[i].file)) + " "_html + text(inputs.gaps[i].reason)) +
        "\n"_html;
  }
  if (inputs.gaps.size() > most) {
    items += element("li", text("and " + std::to_string(inputs.gaps.size() - most) + " more"));
  }
  return element(
             "div",
             "<p><b>This report is incomplete.</b> It shows what is on disk; the following is missing or cannot be read:</p>\n"_html +
                 element("ul", items),
             {{"class", "gaps"}}) +
         "\n"_html;
}

Markup header(const Inputs& inputs, const std::string& title) {
  const Markup lead = text("grainlaw " + build_name(version(), commit()) +
                           ": constitutive laws for granular matter, calibrated from the grains up");
  return element("h1", text(title)) + "\n"_html + element("p", lead, {{"class", "lead"}}) + "\n"_html +
         other_builds(inputs);
}

Markup contents(const std::vector<Section>& sections) {
  Markup links;
  for (const Section& section : sections) {
    links += element("a", text(section.title), {{"href", std::string("#") + section.id}}) + "\n"_html;
  }
  return element("nav", links) + "\n"_html;
}

std::string page_of(const Inputs& inputs) {
  const std::vector<FitView> fits = fit_views(inputs);
  const std::vector<Section> sections{
      {"run", "What was run", what_was_run(inputs)},
      {"headline", "What came out", headline(inputs, fits)},
      {"fits", "The fits", fits_section(inputs, fits)},
      {"predictions", "Predictions against DEM", predictions_section(inputs)},
      {"time", "Where the time went", time_section(inputs)},
      {"provenance", "Provenance", provenance_section(inputs)},
      {"glossary", "Glossary", glossary_section()},
  };
  const std::string name = text_in(inputs.campaign, "name");
  const std::string title = name.empty() ? "From grains to a law" : "From grains to a law: campaign " + name;
  Markup body = header(inputs, title) + contents(sections) + gaps(inputs);
  for (const Section& section : sections) {
    body += element("section", element("h2", text(section.title)) + "\n"_html + section.body,
                    {{"id", section.id}}) +
            "\n"_html;
  }
  const Markup head =
      "<meta charset=\"utf-8\"/>\n<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n"_html +
      element("title", text(title)) + "\n"_html + element("style", Markup::trusted(style_sheet)) + "\n"_html;
  const Markup page = element("head", head) + "\n"_html + element("body", body) + "\n"_html;
  return "<!DOCTYPE html>\n" + element("html", page, {{"lang", "en"}}).str() + "\n";
}

}  // namespace

std::string report_html(const std::filesystem::path& dir) { return page_of(read_inputs(dir)); }

std::vector<Gap> write_report(const std::filesystem::path& dir) {
  const Inputs inputs = read_inputs(dir);
  write_file(dir / "report.html", page_of(inputs));
  return inputs.gaps;
}

}  // namespace grainlaw::report
