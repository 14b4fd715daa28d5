#include <algorithm>
#include <set>

#include "grainlaw/apps/report/numbers.hpp"
#include "grainlaw/apps/report/prose.hpp"
#include "grainlaw/apps/report/sections.hpp"
#include "grainlaw/element/version.hpp"

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

/// How many runs have each value of something, in order of appearance; runs without a value do not count.
using Tally = std::vector<std::pair<std::string, std::size_t>>;

template <class Value>
Tally tally(const Inputs& inputs, const Value& value_of) {
  Tally tally;
  for (const Run& run : inputs.runs) {
    const std::string value = value_of(run.provenance);
    if (value.empty()) continue;
    auto entry = std::find_if(tally.begin(), tally.end(), [&](const auto& t) { return t.first == value; });
    if (entry == tally.end()) entry = tally.insert(tally.end(), {value, 0});
    ++entry->second;
  }
  return tally;
}

Markup list(const Tally& tally) {
  std::vector<Markup> pieces;
  for (const auto& [value, runs] : tally)
    pieces.push_back(text(value + " (" + std::to_string(runs) + (runs == 1 ? " run)" : " runs)")));
  return join(pieces, ", "_html);
}

}  // namespace

std::string build_name(const std::string& version, const std::string& commit) {
  return commit.empty() ? version : version + ", commit " + commit;
}

Markup other_builds(const Inputs& inputs) {
  Tally builds = tally(inputs, [](const Json& provenance) {
    return build_name(text_in(provenance, "version"), text_in(provenance, "commit"));
  });
  std::erase_if(builds, [](const auto& b) { return b.first == build_name(version(), commit()); });
  const Tally sets = tally(inputs, [](const Json& provenance) { return text_in(provenance, "simd"); });
  std::vector<Markup> pieces;
  if (!builds.empty()) pieces.push_back("by another grainlaw than this report: "_html + list(builds));
  if (sets.size() > 1) pieces.push_back("with different instruction sets: "_html + list(sets));
  if (pieces.empty()) return {};
  return element("p", "<b>Warning</b>: records were made "_html + join(pieces, "; "_html) + "."_html,
                 {{"class", "gaps"}}) +
         "\n"_html;
}

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
