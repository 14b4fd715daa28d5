#include "grainlaw/apps/explain.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "grainlaw/apps/terminal.hpp"
#include "grainlaw/element/column_groups.hpp"

namespace grainlaw::apps {

namespace {

using dem::SceneCost;

/// "63 us", "4.2 ms", "1 min 20 s"
std::string short_time(double seconds) {
  if (seconds < 1e-3) return fmt::format("{:.3g} us", 1e6 * seconds);
  if (seconds < 1) return fmt::format("{:.3g} ms", 1e3 * seconds);
  return time_text(seconds);
}

std::string size_text(double bytes) {
  if (std::isnan(bytes)) return "unknown";
  if (bytes < 1e6) return fmt::format("{:.3g} kB", bytes / 1e3);
  if (bytes < 1e9) return fmt::format("{:.3g} MB", bytes / 1e6);
  return fmt::format("{:.3g} GB", bytes / 1e9);
}

std::string count_text(double bytes) {
  return std::isnan(bytes) ? std::string("unknown") : fmt::format("{:.0f}", bytes);
}

/// "about 12 s (8 s to 18 s)"; without a range where there is none.
std::string range_text(double seconds, double least, double most) {
  const std::string about = "about " + short_time(seconds);
  if (!(most > least)) return about;
  return about + " (" + short_time(least) + " to " + short_time(most) + ")";
}

std::string terms(const Material& material, const SceneCost& cost) {
  const auto line = [](const char* name, const std::string& what) {
    return fmt::format("  {:<36}{}\n", name, what);
  };
  const auto viscosity = [](double value, const std::string& takes) {
    return value > 0 ? fmt::format("on, {:.4g} ug/us; {}", value, takes)
                     : std::string("off: it is 0, and costs nothing");
  };
  const auto a_step = [](double seconds) { return short_time(seconds) + " of a step"; };
  return "terms of the motion (no friction, no rotation: grains carry neither)\n" +
         line("contact  k delta",
              fmt::format("on, k = {:.4g} ug/us^2; with the walk through the pairs {}", material.k,
                          a_step(cost.force_seconds - cost.damping_seconds))) +
         line("contact  gamma d(delta)/dt", viscosity(material.gamma, a_step(cost.damping_seconds))) +
         line("background  -gamma_b v",
              viscosity(material.gamma_b, "a factor of the motion, which takes as long without")) +
         line("motion and lists of pairs", a_step(cost.motion_seconds)) + "\n";
}

std::string fields(const SceneCost& cost) {
  std::string text = "fields                                     bytes per grain\n";
  double sum = 0;
  for (const auto& field : cost.fields) {
    text += fmt::format("  {:<44}{:>5}\n", field.name, count_text(field.bytes_per_grain));
    sum += field.bytes_per_grain;
  }
  return text + fmt::format("  {:<44}{:>5}, together {}\n\n", "all", count_text(sum),
                            size_text(sum * static_cast<double>(cost.grains)));
}

/// In brackets after a servo: as if it had strained nothing.
std::string nu_text(const dem::StageCost& cost, bool known) {
  const std::string nu = cost.stage.leg.control.by_stress() ? fmt::format("from {:.4g}", cost.nu[0])
                         : cost.nu[0] == cost.nu[1]         ? fmt::format("{:.4g}", cost.nu[0])
                                                    : fmt::format("{:.4g} to {:.4g}", cost.nu[0], cost.nu[1]);
  return known ? nu : "(" + nu + ")";
}

/// Whether nothing but a guess is known of how long it takes.
bool guessed(const dem::StageCost& cost) {
  return !cost.tried && (cost.stage.leg.minimises() || cost.stage.leg.control.by_stress());
}

/// Whether only a part was tried of what may wait for a stress as long as it has to.
bool may_wait(const dem::StageCost& cost) {
  return cost.tried && cost.stage.leg.control.by_stress() && cost.most > cost.least;
}

/// Whether it may end before the time said.
bool may_end_early(const dem::StageCost& cost) {
  return !cost.tried && !cost.stage.leg.drives() && cost.least == 0;
}

/// Whether it takes more, because grains still move that were at rest in the trial.
bool still_moves(const dem::StageCost& cost) { return cost.still_moves; }

std::string stage_time(const dem::StageCost& cost) {
  if (may_wait(cost))
    return range_text(cost.seconds, cost.least, cost.most) + ", several times that if its servo has to wait";
  const std::string time =
      cost.tried ? range_text(cost.seconds, cost.least, cost.most) : short_time(cost.seconds);
  if (still_moves(cost))
    return (may_end_early(cost) ? "perhaps " + time : time + " or more") + ", for its grains still move";
  if (cost.tried) return time;
  return (guessed(cost) ? "not tried, perhaps " : may_end_early(cost) ? "at most " : "") + time;
}

/// Of all stages, rows and files.
std::string whole_time(const SceneCost& cost) {
  const auto any = [&](bool (*is)(const dem::StageCost&)) {
    return std::any_of(cost.stages.begin(), cost.stages.end(), is);
  };
  const std::string guess = any(guessed) ? "perhaps " : "",
                    more = any(may_wait) || any(still_moves) ? " or more" : "";
  const std::string least = short_time(cost.least()), most = short_time(cost.most());
  if (least == most) return guess + most + more;
  if (cost.most() - cost.least() < 0.1 * cost.seconds())
    return guess + "about " + short_time(cost.seconds()) + more;
  if (any(may_end_early)) return guess + least + " to " + most + more;
  return guess + range_text(cost.seconds(), cost.least(), cost.most()) + more;
}

std::string stages(const SceneCost& cost) {
  std::string text = "stage                      nu                steps       dt (us)   time\n";
  bool known = true;
  for (const dem::StageCost& of : cost.stages) {
    const dem::Stage& stage = of.stage;
    text += fmt::format("  {:<24} {:<16} {:>9} {:>12.4g}   {}\n", stage.name, nu_text(of, known),
                        stage.stepping.steps, stage.leg.minimises() ? 0 : stage.stepping.dt, stage_time(of));
    known = known && !stage.leg.control.by_stress();
    if (of.bytes != 0) text += fmt::format("  {:<24} and {} of memory meanwhile\n", "", size_text(of.bytes));
  }
  return text + fmt::format("  a step on the path: {}, of it contact forces {}, motion and lists {}\n\n",
                            short_time(cost.force_seconds + cost.motion_seconds),
                            short_time(cost.force_seconds), short_time(cost.motion_seconds));
}

/// Which groups of standard columns a scene turns on, and which it leaves out.
std::string groups_text(const std::vector<std::string>& asked) {
  std::vector<std::string> left_out;
  for (const std::string& group : column_groups())
    if (std::find(asked.begin(), asked.end(), group) == asked.end()) left_out.push_back(group);
  const std::string on = asked.empty() ? "none but segment, strains, nu, phi_J and t"
                                       : fmt::format("{}", fmt::join(asked, ", "));
  if (left_out.empty()) return fmt::format("    {}\n", on);
  return fmt::format("    {}; measure.standard leaves out {}\n", on, fmt::join(left_out, ", "));
}

/// Whether a run can say that its grains were not at rest (see dem/record/row_writer.hpp).
bool watches_energies(const dem::Measure& measure) {
  const auto has = [](const std::vector<std::string>& list, const char* word) {
    return std::find(list.begin(), list.end(), word) != list.end();
  };
  return has(measure.standard, "stress") &&
         (has(measure.standard, "energy_ratio") || has(measure.observe, "energy"));
}

std::string rows(const dem::Measure& measure, const SceneCost& cost) {
  double steps = 0;
  for (const auto& stage : cost.stages)
    if (stage.stage.segment) steps += static_cast<double>(stage.stage.stepping.steps);
  const auto line = [&](const std::string& name, double seconds, double bytes) {
    return fmt::format("  {:<24} {:>10} {:>12}   {}\n", name, short_time(seconds),
                       short_time(seconds * static_cast<double>(cost.rows) / steps),
                       bytes > 0 ? size_text(bytes) : std::string("-"));
  };
  std::string text = fmt::format("measured in {} rows         per row     per step   memory\n", cost.rows);
  text += line("standard columns", cost.row_seconds, 0) + groups_text(measure.standard);
  if (!watches_energies(measure)) text += "    so E_k/E_p is not watched\n";
  for (const auto& observer : cost.observers)
    text += line(observer.name, observer.seconds_per_row, observer.bytes);
  if (cost.observers.empty()) text += "  nothing else: measure.observe is empty\n";
  text += cost.snapshots == 0
              ? std::string("snapshots: none\n")
              : fmt::format("snapshots: {}, each {} and {} on disk\n", cost.snapshots,
                            short_time(cost.snapshot_seconds), size_text(cost.snapshot_bytes));
  text += fmt::format("checkpoints: {:.0f}, each {} and {} on disk, where two are kept\n", cost.checkpoints(),
                      short_time(cost.checkpoint_seconds), size_text(cost.checkpoint_bytes));
  if (cost.moduli > 0)
    text += fmt::format("moduli: {} states, each about {} and {} of memory: balance and linear response\n",
                        cost.moduli, short_time(cost.moduli_seconds), size_text(cost.moduli_bytes));
  return text + "\n";
}

}  // namespace

std::string explanation(const dem::Scene& scene, const dem::SceneCost& cost) {
  std::string text = fmt::format("{}: {} grains, w = {:.3g}\n\n", scene.file, cost.grains, scene.material.w);
  text += terms(scene.material, cost) + fields(cost) + stages(cost) + rows(scene.measure, cost);
  return text + fmt::format("in all: {:.3g} particle-steps, {} of one core like this one now, {} of memory\n",
                            cost.particle_steps(), whole_time(cost), size_text(cost.bytes()));
}

}  // namespace grainlaw::apps
