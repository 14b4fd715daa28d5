#include "grainlaw/calibrate/fit_memory_numbers.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "grainlaw/calibrate/fit_paths.hpp"
#include "grainlaw/element/error.hpp"

namespace grainlaw::calibrate {

namespace {

/// Of first loadings at nu = 0.67 to 0.81, and of D2 cycles to 0.4 at 0.685 to 0.75 (docs/model.md, Memory).
constexpr double usual_eps_c = 0.042, usual_hold = 0.4;

model::Parameter assumed(double value, const std::string& why) {
  model::Parameter parameter;
  parameter.value = value;
  parameter.source = "assumed";
  parameter.note = why + "; that of data/records/base, w = 3";
  return parameter;
}

bool reverses(const TestRecord& test) {
  const auto shears = [&](const Leg& leg, double sign) {
    return sign * (leg.eps_dev[1] - leg.eps_dev[0]) > 0;
  };
  return std::any_of(test.legs.begin(), test.legs.end(), [&](const Leg& leg) { return shears(leg, 1); }) &&
         std::any_of(test.legs.begin(), test.legs.end(), [&](const Leg& leg) { return shears(leg, -1); });
}

/// Whether the account of a fit says that the tests determine this number.
bool is_told(const Json& account, const std::string& name) {
  for (const Json& parameter : account.at("parameters"))
    if (parameter.at("name") == name) return parameter.at("determined").get<bool>();
  return false;
}

}  // namespace

void add_memory_numbers(const std::filesystem::path& dir, const RecordFolder& folder,
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
  if (any_reverses) options.names.push_back("memory.hold");
  auto& memory = *parameters.memory;
  memory.eps_c = assumed(usual_eps_c, "no D2 test tells");
  memory.hold = assumed(usual_hold, any_reverses ? "the D2 tests do not tell" : "no D2 test is reversed");
  try {
    const PolishOutput fitted = polish(dir, parameters, options);
    const auto& told = *fitted.parameters.memory;
    if (is_told(fitted.account, "memory.eps_c")) memory.eps_c = told.eps_c;
    if (is_told(fitted.account, "memory.hold")) memory.hold = told.hold;
  } catch (const Error& error) {  // no D2 test that could be followed: the other fits stand
    memory.eps_c = assumed(usual_eps_c, std::string("no D2 test tells (") + error.what() + ")");
  }
}

}  // namespace grainlaw::calibrate
