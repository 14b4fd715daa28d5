#include "grainlaw/apps/explain.hpp"

#include <fmt/format.h>

#include <cmath>

#include "grainlaw/apps/terminal.hpp"

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
  if (bytes < 1e6) return fmt::format("{:.3g} kB", bytes / 1e3);
  if (bytes < 1e9) return fmt::format("{:.3g} MB", bytes / 1e6);
  return fmt::format("{:.3g} GB", bytes / 1e9);
}

std::string terms(const Material& material) {
  const auto viscosity = [](double value) {
    return value > 0 ? fmt::format("on, {:.4g} ug/us", value) : std::string("off: it is 0");
  };
  return fmt::format(
      "terms of the motion (no friction, no rotation: grains carry neither)\n"
      "  contact  k delta               on, k = {:.4g} ug/us^2\n"
      "  contact  gamma d(delta)/dt     {}\n"
      "  background  -gamma_b v         {}\n\n",
      material.k, viscosity(material.gamma), viscosity(material.gamma_b));
}

std::string fields(const SceneCost& cost) {
  std::string text = "fields                                     bytes per grain\n";
  double sum = 0;
  for (const auto& field : cost.fields) {
    text += fmt::format("  {:<44}{:>5.0f}\n", field.name, field.bytes_per_grain);
    sum += field.bytes_per_grain;
  }
  return text + fmt::format("  {:<44}{:>5.0f}, together {}\n\n", "all", sum,
                            size_text(sum * static_cast<double>(cost.grains)));
}

std::string stages(const SceneCost& cost) {
  std::string text = "stage                      nu                steps       dt (us)   time\n";
  for (const auto& [stage, range, seconds] : cost.stages) {
    const std::string nu = range[0] == range[1] ? fmt::format("{:.4g}", range[0])
                                                : fmt::format("{:.4g} to {:.4g}", range[0], range[1]);
    text += fmt::format("  {:<24} {:<16} {:>9} {:>12.4g}   {}{}\n", stage.name, nu, stage.stepping.steps,
                        stage.leg.minimises() ? 0 : stage.stepping.dt,
                        stage.leg.minimises()           ? "about "
                        : stage.leg.mode == Mode::relax ? "at most "
                                                        : "",
                        short_time(seconds));
  }
  return text + fmt::format("  a step on the path: {}, of it contact forces {}, motion and lists {}\n\n",
                            short_time(cost.force_seconds + cost.motion_seconds),
                            short_time(cost.force_seconds), short_time(cost.motion_seconds));
}

std::string rows(const SceneCost& cost) {
  double steps = 0;
  for (const auto& stage : cost.stages)
    if (stage.stage.segment) steps += static_cast<double>(stage.stage.stepping.steps);
  const auto line = [&](const std::string& name, double seconds, double bytes) {
    return fmt::format("  {:<24} {:>10} {:>12}   {}\n", name, short_time(seconds),
                       short_time(seconds * static_cast<double>(cost.rows) / steps),
                       bytes > 0 ? size_text(bytes) : std::string("-"));
  };
  std::string text = fmt::format("measured in {} rows         per row     per step   memory\n", cost.rows);
  text += line("standard columns", cost.row_seconds, 0);
  for (const auto& observer : cost.observers)
    text += line(observer.name, observer.seconds_per_row, observer.bytes);
  if (cost.observers.empty()) text += "  nothing else: measure.observe is empty\n";
  text += fmt::format("snapshots: {} of {}\n", cost.snapshots, size_text(cost.snapshot_bytes));
  if (cost.moduli > 0)
    text += fmt::format("moduli: {} states, each about {}: balance and linear response\n", cost.moduli,
                        short_time(cost.moduli_seconds));
  return text + "\n";
}

}  // namespace

std::string explanation(const dem::Scene& scene, const dem::SceneCost& cost) {
  std::string text = fmt::format("{}: {} grains, w = {:.3g}\n\n", scene.file, cost.grains, scene.material.w);
  text += terms(scene.material) + fields(cost) + stages(cost) + rows(cost);
  return text + fmt::format("in all: {:.3g} particle-steps, {} of one core like this one now, {} of memory\n",
                            cost.particle_steps(), short_time(cost.seconds()), size_text(cost.bytes()));
}

}  // namespace grainlaw::apps
