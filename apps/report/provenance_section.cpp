#include <algorithm>
#include <set>

#include "grainlaw/apps/report/numbers.hpp"
#include "grainlaw/apps/report/prose.hpp"
#include "grainlaw/apps/report/sections.hpp"

namespace grainlaw::report {
namespace {

/// All different values of a key over the runs, in order of appearance.
std::vector<std::string> different(const Inputs& inputs, const std::string& key) {
  std::vector<std::string> values;
  for (const Run& run : inputs.runs) {
    const Json& value = value_in(run.provenance, key);
    const std::string shown = value.is_string()   ? value.get<std::string>()
                              : value.is_number() ? number(value.get<double>(), 5)
                                                  : "";
    if (!shown.empty() && std::find(values.begin(), values.end(), shown) == values.end())
      values.push_back(shown);
  }
  return values;
}

Markup cell(const std::vector<std::string>& values) {
  if (values.empty()) return text(nothing);
  std::vector<Markup> pieces;
  for (const std::string& value : values) pieces.push_back(text(value));
  return join(pieces, "<br/>"_html);
}

Markup first_and_last(std::vector<std::string> values) {
  if (values.empty()) return text(nothing);
  std::sort(values.begin(), values.end());
  if (values.size() == 1) return text(values.front());
  return text("first run " + values.front() + ", last run " + values.back());
}

Markup warnings(const Inputs& inputs) {
  Markup items;
  for (const Run& run : inputs.runs) {
    const Json& list = value_in(run.provenance, "warnings");
    if (!list.is_array()) continue;
    for (const Json& warning : list) {
      const std::string words = warning.is_string() ? warning.get<std::string>() : "";
      if (!words.empty())
        items += element("li", element("b", text(run.name)) + ": "_html + prose(words)) + "\n"_html;
    }
  }
  const Markup list =
      items.empty() ? "<p>None of the runs warned of anything.</p>\n"_html : element("ul", items);
  return "<h3 id=\"warnings\">Warnings</h3>\n"_html + list;
}

}  // namespace

Markup provenance_section(const Inputs& inputs) {
  const bool any = std::any_of(inputs.runs.begin(), inputs.runs.end(),
                               [](const Run& r) { return r.provenance.is_object(); });
  if (!any) return absent("No provenance: no record on disk has a provenance.json.");
  Table table;
  table.column("What"_html).column("Value"_html);
  table.row({"grainlaw version"_html, cell(different(inputs, "version"))});
  table.row({"Commit"_html, cell(different(inputs, "commit"))});
  table.row({"Compiler"_html, cell(different(inputs, "compiler"))});
  table.row({"Instruction set"_html, cell(different(inputs, "simd"))});
  table.row({"Started (UTC)"_html, first_and_last(different(inputs, "started"))});
  table.row({"Stress unit <var>k</var>*, kPa"_html, cell(different(inputs, "k_star_kPa"))});
  table.row({"Time step, μs"_html, cell(different(inputs, "time_step"))});
  return table.html() + warnings(inputs);
}

}  // namespace grainlaw::report
