#include "grainlaw/calibrate/bench_advice.hpp"

#include <cmath>
#include <map>

#include "grainlaw/element/short_text.hpp"

namespace grainlaw::calibrate {

namespace {

std::string padded(const std::string& text, std::size_t width) {
  return text + std::string(text.size() < width ? width - text.size() : 0, ' ');
}

std::string percent(double share) { return short_text(100 * share, 2) + " %"; }

std::string value_text(const Recommendation& best) {
  const std::string value = short_text(best.value, 6);
  if (best.knob == Knob::time_step || best.knob == Knob::gas_step) return "t_c/" + value;
  return best.knob == Knob::count ? value : "x " + value;
}

std::string line_of(double wanted, const Recommendation& best, const std::string& excuse) {
  std::string text = "\n  " + padded(name_of(best.knob), 10) + padded(percent(wanted), 8) + value_text(best);
  if (std::isfinite(best.core_s)) text += ", " + short_text(best.core_s, 2) + " s";
  if (best.quantity.empty()) return text;
  return text + "; " + best.quantity + " of " + name_of(best.test) + " by " + percent(best.excused) + ", " +
         excuse;
}

std::string cheapest(const std::vector<BenchError>& errors, Judge judge, const std::string& excuse) {
  std::map<Knob, std::string> lines;
  for (const double wanted : wanted_errors)
    for (const Recommendation& best : recommend(errors, judge, wanted))
      lines[best.knob] += line_of(wanted, best, excuse);
  std::string text;
  for (const auto& [knob, of_knob] : lines) text += of_knob;
  return text;
}

}  // namespace

std::string bench_advice(const std::vector<BenchError>& errors) {
  const std::string one = cheapest(errors, Judge::one_packing, "within what packings differ"),
                    many = cheapest(errors, Judge::chance, "within what chance makes");
  const std::string begin = "cheapest setting for a wanted error ";
  return (one.empty() ? "" : begin + "of one test, and what it takes of a core:" + one + "\n") + begin +
         "of means over many tests, and what it takes of a core:" + many;
}

}  // namespace grainlaw::calibrate
