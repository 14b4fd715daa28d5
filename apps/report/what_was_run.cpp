#include <algorithm>
#include <cmath>
#include <set>

#include "grainlaw/apps/report/numbers.hpp"
#include "grainlaw/apps/report/sections.hpp"
#include "grainlaw/apps/report/symbols.hpp"

namespace grainlaw::report {
namespace {

/// "0.64 → 0.82 → 0.64": the turning points of a column, to so many decimals.
Markup turning_points(const std::vector<double>& column, int decimals) {
  const double unit = std::pow(10.0, decimals);
  std::vector<double> turns;
  for (const double raw : column) {
    if (!std::isfinite(raw)) continue;
    const double value = std::round(raw * unit) / unit;
    if (!turns.empty() && value == turns.back()) continue;
    const std::size_t n = turns.size();
    const bool goes_on = n >= 2 && (turns[n - 1] - turns[n - 2]) * (value - turns[n - 1]) > 0;
    if (goes_on) turns.pop_back();
    turns.push_back(value);
  }
  if (turns.empty()) return text(nothing);
  const bool many = turns.size() > 6;
  const double low = *std::min_element(turns.begin(), turns.end());
  const double high = *std::max_element(turns.begin(), turns.end());
  if (many) return text(number(low, 3) + " … " + number(high, 3));
  std::vector<Markup> pieces;
  for (const double turn : turns) pieces.push_back(text(number(turn, 3)));
  const Markup line = join(pieces, " → "_html);
  return turns.size() > 3 ? line : element("span", line, {{"class", "whole"}});
}

std::optional<double> largest_pressure(const Run& run) {
  if (!run.record || !run.record->has("P")) return std::nullopt;
  std::optional<double> largest;
  for (const double P : (*run.record)["P"]) {
    if (std::isfinite(P) && P > largest.value_or(-1)) largest = P;
  }
  return largest;
}

std::optional<double> total(const Inputs& inputs, const std::string& key) {
  std::optional<double> sum;
  for (const Run& run : inputs.runs) {
    if (const auto value = number_in(run.provenance, key)) sum = sum.value_or(0) + *value;
  }
  return sum;
}

Markup material_sentence(const Inputs& inputs) {
  const Json& given = value_in(inputs.campaign, "material");
  const auto w = number_in(given, "w"), k = number_in(given, "k");
  if (!w || !k) return {};
  Markup sentence = "Radii are uniform with r<sub>max</sub>/r<sub>min</sub> = "_html + text(number(*w)) +
                    " about a mean of "_html + text(number(number_in(given, "r_mean"))) +
                    " mm; contacts have stiffness "_html + text(number(*k * 1e3)) +
                    " kg/s² and no friction. "_html;
  if (const auto unit = inputs.stress_unit_kPa()) {
    sentence +=
        "Stresses with a star are in units of <var>k</var>* = <var>k</var>/(2⟨<var>r</var>⟩) = "_html +
        text(number(*unit)) + " kPa. "_html;
  }
  return sentence;
}

Markup counts_sentence(const Inputs& inputs) {
  std::size_t done = 0, to_fit = 0, to_predict = 0, of_memory = 0;
  std::set<std::string> tests;
  for (const Run& run : inputs.runs) {
    if (!run.unfinished) ++done;
    if (!tests.insert(run.test).second) continue;
    if (run.role == "fit") ++to_fit;
    if (run.role == "predict") ++to_predict;
    if (run.role == "memory") ++of_memory;
  }
  Markup sentence = text(std::to_string(done)) + text(done == 1 ? " run of " : " runs of ") +
                    text(std::to_string(tests.size())) + " element tests"_html;
  if (to_fit + to_predict > 0) {
    sentence += ": the law is fitted to "_html + text(std::to_string(to_fit)) + ", and "_html +
                text(std::to_string(to_predict)) + " are kept back for it to predict"_html;
  }
  if (of_memory > 0)
    sentence += "; "_html + text(std::to_string(of_memory)) +
                " tell how the jamming density depends on what a packing has been through"_html;
  sentence += ". "_html;
  const auto steps = total(inputs, "particle_steps"), wall = total(inputs, "wall_time_s");
  if (steps && wall && *wall > 0) {
    sentence += "Together they took "_html + text(number(*steps, 3)) + " particle-steps and "_html +
                text(seconds(wall)) + " of wall time, summed over the runs: "_html +
                text(number(*steps / *wall, 3)) + " particle-steps per second. "_html;
  }
  return sentence;
}

Markup campaign_paragraph(const Inputs& inputs) {
  Markup paragraph;
  if (inputs.campaign.is_object()) {
    const Json& preparation = value_in(inputs.campaign, "preparation");
    const auto grains = number_in(preparation, "count");
    const std::size_t seeds = numbers_in(inputs.campaign, "seeds").size();
    paragraph = "Campaign <b>"_html + text(text_in(inputs.campaign, "name")) + "</b>: "_html;
    if (grains) {
      paragraph += "periodic boxes of "_html + text(number(*grains, 7)) +
                   " grains, prepared as a random gas, compressed to <var>ν</var> = "_html +
                   text(number(number_in(preparation, "nu"))) + " and relaxed, "_html +
                   text(std::to_string(seeds)) +
                   text(seeds == 1 ? " packing. " : " different packings (seeds). ");
    }
    paragraph += material_sentence(inputs);
  }
  return element("p", paragraph + counts_sentence(inputs));
}

Markup warnings_cell(const Run& run) {
  if (run.unfinished) return element("span", "not finished"_html, {{"class", "bad"}});
  const Json& warnings = value_in(run.provenance, "warnings");
  if (!warnings.is_array() || warnings.empty()) return text(run.provenance.is_null() ? nothing : "none");
  return element("a", text(std::to_string(warnings.size())), {{"href", "#warnings"}});
}

Table run_table() {
  using Kind = Table::Kind;
  Table table;
  table.column("Run"_html).column("Mode"_html).column("Role"_html);
  table.column("<var>ν</var>"_html).column("<var>ε</var><sub>dev</sub>"_html);
  table.column("Largest <var>P</var> (kPa)"_html, Kind::figures);
  table.column("Seed"_html, Kind::figures).column("Rows"_html, Kind::figures);
  table.column("Particle-steps"_html, Kind::figures).column("Wall time"_html, Kind::figures);
  table.column("Particle-steps/s"_html, Kind::figures).column("Warnings"_html, Kind::figures);
  return table;
}

std::vector<Markup> run_row(const Inputs& inputs, const Run& run) {
  const auto column = [&](const char* name, int decimals) {
    return run.record && run.record->has(name) ? turning_points((*run.record)[name], decimals)
                                               : text(nothing);
  };
  const auto P = largest_pressure(run);
  const auto unit = inputs.stress_unit_kPa();
  return {text(run.name),
          run.mode.empty() ? text(nothing) : text(mode_name(run.mode)),
          run.role.empty() ? text(nothing) : text(run.role),
          column("nu", 3),
          column("eps_dev", 2),
          text(P && unit ? number(*P * *unit, 3) : nothing),
          text(run.seed ? std::to_string(*run.seed) : nothing),
          text(run.record ? count(run.record->rows()) : nothing),
          text(number(number_in(run.provenance, "particle_steps"), 3)),
          text(seconds(number_in(run.provenance, "wall_time_s"))),
          text(number(number_in(run.provenance, "particle_steps_per_s"), 3)),
          warnings_cell(run)};
}

}  // namespace

Markup absent(const std::string& what) { return element("p", text(what), {{"class", "absent"}}); }

Markup what_was_run(const Inputs& inputs) {
  if (inputs.runs.empty())
    return campaign_paragraph(inputs) + absent("No records on disk, so no table of tests.");
  Table table = run_table();
  for (const Run& run : inputs.runs) table.row(run_row(inputs, run));
  return campaign_paragraph(inputs) + table.html("small") +
         element(
             "p",
             "Modes: ISO compresses alike in all directions, UNI along one, D2 compresses one direction "
             "and extends "
             "another at constant volume, D3 compresses one and extends two. A test of role “predict” is "
             "never read "
             "by a fit that a prediction uses, one of role “memory” only by that of the jamming density."_html,
             {{"class", "note"}});
}

}  // namespace grainlaw::report
