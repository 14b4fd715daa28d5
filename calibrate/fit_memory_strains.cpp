#include "grainlaw/calibrate/fit_memory_strains.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "grainlaw/calibrate/fit_paths.hpp"
#include "grainlaw/element/error.hpp"

namespace grainlaw::calibrate {

namespace {

/// Of D2 cycles to 0.4 at nu = 0.685, 0.711 and 0.75 (docs/model.md, Memory).
constexpr double usual_eps_c = 0.076, usual_eps_r = 0.0123;

model::Parameter assumed(double value, const std::string& why) {
  model::Parameter parameter;
  parameter.value = value;
  parameter.source = "assumed";
  parameter.note = why + "; that of the D2 cycles of data/records/base, w = 3";
  return parameter;
}

bool reverses(const TestRecord& test) {
  const auto shears = [&](const Leg& leg, double sign) {
    return sign * (leg.eps_dev[1] - leg.eps_dev[0]) > 0;
  };
  return std::any_of(test.legs.begin(), test.legs.end(), [&](const Leg& leg) { return shears(leg, 1); }) &&
         std::any_of(test.legs.begin(), test.legs.end(), [&](const Leg& leg) { return shears(leg, -1); });
}

/// Whether the tests determine it: not where the fit failed, where it rests on a bound, or where its error is
/// as large as itself.
bool is_told(const model::Parameter& parameter) {
  return parameter.source == "fit" && parameter.stderr_ && *parameter.stderr_ < 0.5 * parameter.value &&
         parameter.note.find("bound") == std::string::npos;
}

}  // namespace

void add_memory_strains(const std::filesystem::path& dir, const RecordFolder& folder,
                        model::ParameterSet& parameters) {
  if (!parameters.memory || !parameters.moduli || !parameters.shear || !parameters.isotropic.contains("d2"))
    return;
  PolishOptions options;
  options.selection.modes = {"d2"};
  options.form.form = model::Form::memory;
  options.names = {"memory.eps_c"};
  options.trade_off = options.profiles = options.held_out = false;
  const bool any_reverses = std::any_of(folder.tests.begin(), folder.tests.end(), [](const TestRecord& test) {
    return test.role == Role::fit && test.mode == "d2" && reverses(test);
  });
  if (any_reverses) options.names.push_back("memory.eps_r");
  parameters.memory->eps_c = assumed(usual_eps_c, "no D2 test tells");
  parameters.memory->eps_r =
      assumed(usual_eps_r, any_reverses ? "the D2 tests do not tell" : "no D2 test is reversed");
  try {
    const PolishOutput fitted = polish(dir, parameters, options);
    const auto& told = *fitted.parameters.memory;
    if (is_told(*told.eps_c)) parameters.memory->eps_c = told.eps_c;
    if (is_told(*told.eps_r)) parameters.memory->eps_r = told.eps_r;
  } catch (const Error&) {
    // No D2 test, or none that the law can follow: what is assumed says so.
  }
}

}  // namespace grainlaw::calibrate
