#include "grainlaw/calibrate/fit_memory_numbers.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "grainlaw/calibrate/fit_paths.hpp"
#include "grainlaw/element/error.hpp"

namespace grainlaw::calibrate {

namespace {

/// What the form has besides Eqs. 5.1 and 5.5: a number, what it is where nothing tells (that of w = 3, N =
/// 9261: docs/model.md, Memory), and what tells it.
struct Number {
  const char* name;
  std::optional<model::Parameter> model::MemoryLaws::*member;
  double usual;
  enum { loading, reversal, nothing } told_by;
};
constexpr Number numbers[] = {{"memory.alpha_P", &model::MemoryLaws::alpha_P, 1.7, Number::loading},
                              {"memory.eps0_P", &model::MemoryLaws::eps0_P, 0.070, Number::loading},
                              {"memory.eps0_R_P", &model::MemoryLaws::eps0_R_P, 0.16, Number::reversal},
                              {"memory.eps_r", &model::MemoryLaws::eps_r, 0.145, Number::reversal},
                              {"memory.hold", &model::MemoryLaws::hold, 0.3, Number::reversal},
                              {"memory.pack_rate", &model::MemoryLaws::pack_rate, 2, Number::nothing},
                              {"memory.phi_pack", &model::MemoryLaws::phi_pack, 0.668, Number::nothing}};

model::Parameter assumed(double value, const std::string& why) {
  model::Parameter parameter;
  parameter.value = value;
  parameter.source = "assumed";
  parameter.note = why + "; that of w = 3 (docs/model.md, Memory)";
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
  options.trade_off = options.profiles = options.held_out = false;
  const bool any_reverses = std::any_of(folder.tests.begin(), folder.tests.end(), [](const TestRecord& test) {
    return test.role == Role::fit && test.mode == "d2" && reverses(test);
  });
  auto& memory = *parameters.memory;
  for (const Number& number : numbers) {
    const bool asked =
        number.told_by == Number::loading || (number.told_by == Number::reversal && any_reverses);
    if (asked) options.names.emplace_back(number.name);
    memory.*number.member =
        assumed(number.usual, asked                                ? "the D2 tests do not tell"
                              : number.told_by == Number::reversal ? "no D2 test is reversed"
                                                                   : "no test is asked for it");
  }
  try {
    const PolishOutput fitted = polish(dir, parameters, options);
    for (const Number& number : numbers)
      if (is_told(fitted.account, number.name))
        memory.*number.member = (*fitted.parameters.memory).*number.member;
  } catch (const Error& error) {  // no D2 test that could be followed: the other fits stand
    for (const Number& number : numbers)
      if (number.told_by == Number::loading || (number.told_by == Number::reversal && any_reverses))
        memory.*number.member = assumed(number.usual, std::string("no D2 test tells (") + error.what() + ")");
  }
}

}  // namespace grainlaw::calibrate
