#include <algorithm>
#include <map>

#include "grainlaw/apps/report/numbers.hpp"
#include "grainlaw/apps/report/sections.hpp"
#include "grainlaw/apps/report/symbols.hpp"

namespace grainlaw::report {
namespace {

struct Spent {
  std::string name;
  double wall = 0, core = 0;
  bool has_core = false;
};

std::string share(double part, double whole) { return percent(whole > 0 ? part / whole : 0); }

/// A bar whose length is the share of the longest.
Markup bar(double part, double longest, const std::string& colour) {
  const std::string width = longest > 0 ? std::to_string(static_cast<int>(100 * part / longest + 0.5)) : "0";
  return element("div", element("div", Markup(), {{"style", "width:" + width + "%;background:" + colour}}),
                 {{"class", "bar"}});
}

Markup stage_table(const std::vector<Spent>& stages) {
  double total = 0, longest = 0;
  for (const Spent& stage : stages) {
    total += stage.wall;
    longest = std::max(longest, stage.wall);
  }
  Table table;
  table.column("Stage"_html)
      .column("Wall time"_html, Table::Kind::figures)
      .column("Share"_html, Table::Kind::figures);
  table.column("Core time"_html, Table::Kind::figures).column(Markup());
  for (const Spent& stage : stages) {
    table.row({text(stage.name), text(seconds(stage.wall)), text(share(stage.wall, total)),
               text(stage.has_core ? seconds(stage.core) : nothing), bar(stage.wall, longest, "#0072b2")});
  }
  table.row({element("b", "all"_html), text(seconds(total)), text("100 %"), Markup(), Markup()});
  return table.html();
}

std::vector<Spent> stages_of(const Json& timing) {
  std::vector<Spent> stages;
  const Json& list = value_in(timing, "stages");
  if (!list.is_array()) return stages;
  for (const Json& entry : list) {
    const auto wall = number_in(entry, "wall_s"), core = number_in(entry, "core_s");
    if (wall && *wall >= 0)
      stages.push_back({text_in(entry, "name"), *wall, core.value_or(0), core.has_value()});
  }
  return stages;
}

/// Wall time of the runs, summed over seeds, by test.
Markup test_table(const Inputs& inputs) {
  std::vector<Spent> tests;
  std::map<std::string, std::string> modes;
  double longest = 0;
  for (const Run& run : inputs.runs) {
    const auto wall = number_in(run.provenance, "wall_time_s");
    if (!wall || *wall < 0) continue;
    auto found = std::find_if(tests.begin(), tests.end(), [&](const Spent& s) { return s.name == run.test; });
    if (found == tests.end()) found = tests.insert(tests.end(), Spent{run.test});
    found->wall += *wall;
    modes[run.test] = run.mode;
    longest = std::max(longest, found->wall);
  }
  if (tests.empty()) return {};
  Table table;
  table.column("Test, all seeds"_html).column("Simulation"_html, Table::Kind::figures).column(Markup());
  for (const Spent& test : tests) {
    table.row(
        {text(test.name), text(seconds(test.wall)), bar(test.wall, longest, mode_colour(modes[test.name]))});
  }
  return "<h3>Simulation by test</h3>\n"_html + table.html();
}

}  // namespace

Markup time_section(const Inputs& inputs) {
  const auto stages = stages_of(inputs.timing);
  const Markup by_stage = stages.empty()
                              ? absent("No times by stage: timing.json is not there, or holds none.")
                              : "<h3>By stage</h3>\n"_html + stage_table(stages);
  return by_stage + test_table(inputs);
}

}  // namespace grainlaw::report
