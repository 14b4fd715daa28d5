#include "grainlaw/calibrate/fit_memory_numbers.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "grainlaw/calibrate/fit_paths.hpp"
#include "grainlaw/element/error.hpp"

namespace grainlaw::calibrate {

namespace {

/// What tells a number: whole D2 tests; P of those that turn their shear round, or F_dev (sigma_dev there is
/// that of Eq. 4.16, which errs by far more than P, and would bend the numbers of P).
enum class ToldBy { loading, pressure, fabric, nothing };

/// What the form has besides Eqs. 5.1 and 5.5: a number, what it is where nothing tells (that of w = 3, N =
/// 9261: docs/model.md, Memory), and what tells it. phi_pack and pack_rate cannot be told apart.
struct Number {
  const char* name;
  std::optional<model::Parameter> model::MemoryLaws::*member;
  double usual;
  ToldBy told_by;
};
constexpr Number numbers[] = {{"memory.alpha_P", &model::MemoryLaws::alpha_P, 1.7, ToldBy::loading},
                              {"memory.eps0_P", &model::MemoryLaws::eps0_P, 0.070, ToldBy::loading},
                              {"memory.eps0_R_P", &model::MemoryLaws::eps0_R_P, 0.16, ToldBy::pressure},
                              {"memory.eps_r", &model::MemoryLaws::eps_r, 0.13, ToldBy::pressure},
                              {"memory.phi_pack", &model::MemoryLaws::phi_pack, 0.668, ToldBy::pressure},
                              {"memory.hold", &model::MemoryLaws::hold, 0.22, ToldBy::fabric},
                              {"memory.pack_rate", &model::MemoryLaws::pack_rate, 2, ToldBy::nothing}};

model::Parameter assumed(double value, const std::string& why) {
  model::Parameter parameter;
  parameter.value = value;
  parameter.source = "assumed";
  parameter.note = why + "; that of w = 3 (docs/model.md, Memory)";
  return parameter;
}

/// Whether the account of a fit says that the tests determine this number.
bool is_told(const Json& account, const std::string& name) {
  for (const Json& parameter : account.at("parameters"))
    if (parameter.at("name") == name) return parameter.at("determined").get<bool>();
  return false;
}

/// Whether the account of a fit says that the law follows the tests within their errors.
bool follows(const Json& account) {
  for (const Json& sentence : account.at("sentences"))
    if (sentence.get<std::string>().starts_with("the law does not follow")) return false;
  return true;
}

/// Fits the numbers that such tests tell to those of `folder`; what is not determined is assumed, and its
/// name returned.
std::vector<std::string> fit_numbers(const RecordFolder& folder, ToldBy told_by,
                                     model::ParameterSet& parameters) {
  PolishOptions options;
  options.selection.modes = {"d2"};
  options.selection.reversed_only = told_by != ToldBy::loading;
  if (told_by == ToldBy::pressure) options.compared = {true, false, false};
  if (told_by == ToldBy::fabric) options.compared = {false, false, true};
  options.form.form = model::Form::memory;
  options.trade_off = options.profiles = options.held_out = false;
  auto& memory = *parameters.memory;
  const auto for_each = [&](auto&& f) {
    for (const Number& number : numbers)
      if (number.told_by == told_by) f(number, memory.*number.member);
  };
  for_each([&](const Number& number, auto& parameter) {
    options.names.emplace_back(number.name);
    parameter = assumed(number.usual, "the D2 tests do not tell");
  });
  std::vector<std::string> in_vain;
  try {
    const PolishOutput fitted = polish(folder, parameters, options);
    const bool followed = follows(fitted.account);
    for_each([&](const Number& number, auto& parameter) {
      if (!is_told(fitted.account, number.name)) return in_vain.emplace_back(number.name), void();
      parameter = (*fitted.parameters.memory).*number.member;
      if (!followed) parameter->note += "; the law does not follow them within their errors";
    });
  } catch (const Error& error) {  // no D2 test that could be followed: the other fits stand
    for_each([&](const Number& number, auto& parameter) {
      parameter = assumed(number.usual, std::string("no D2 test tells (") + error.what() + ")");
      in_vain.emplace_back(number.name);
    });
  }
  return in_vain;
}

}  // namespace

bool tells_of_reversals(const TestRecord& test) {
  return test.role == Role::fit && test.mode == "d2" && reverses(test);
}

std::vector<std::string> add_memory_numbers(const RecordFolder& folder, const RecordFolder& reversals,
                                            model::ParameterSet& parameters) {
  if (!parameters.memory || !parameters.moduli || !parameters.shear || !parameters.isotropic.contains("d2"))
    return {};
  for (const Number& number : numbers)
    (*parameters.memory).*number.member =
        assumed(number.usual,
                number.told_by == ToldBy::nothing ? "no test is asked for it" : "no D2 test is reversed");
  std::vector<std::string> in_vain = fit_numbers(folder, ToldBy::loading, parameters);
  const RecordFolder& reversed = reversals.tests.empty() ? folder : reversals;
  if (std::none_of(reversed.tests.begin(), reversed.tests.end(), tells_of_reversals)) return in_vain;
  for (const ToldBy told_by : {ToldBy::fabric, ToldBy::pressure}) {  // F_dev says how far a shear is opposed
    const auto others = fit_numbers(reversed, told_by, parameters);
    in_vain.insert(in_vain.end(), others.begin(), others.end());
  }
  return in_vain;
}

}  // namespace grainlaw::calibrate
