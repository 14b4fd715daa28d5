#include "grainlaw/calibrate/fit_memory_strain.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "grainlaw/calibrate/fit_paths.hpp"
#include "grainlaw/element/error.hpp"

namespace grainlaw::calibrate {

namespace {

/// Of first loadings at nu = 0.67 to 0.81 (docs/model.md, Memory).
constexpr double usual_eps_c = 0.042;

model::Parameter assumed(double value, const std::string& why) {
  model::Parameter parameter;
  parameter.value = value;
  parameter.source = "assumed";
  parameter.note = why + "; that of data/records/base, w = 3";
  return parameter;
}

/// Whether the account of a fit says that the tests determine this number.
bool is_told(const Json& account, const std::string& name) {
  for (const Json& parameter : account.at("parameters"))
    if (parameter.at("name") == name) return parameter.at("determined").get<bool>();
  return false;
}

}  // namespace

void add_memory_strain(const std::filesystem::path& dir, model::ParameterSet& parameters) {
  if (!parameters.memory || !parameters.moduli || !parameters.shear || !parameters.isotropic.contains("d2"))
    return;
  PolishOptions options;
  options.selection.modes = {"d2"};
  options.form.form = model::Form::memory;
  options.names = {"memory.eps_c"};
  options.trade_off = options.profiles = options.held_out = false;
  auto& memory = *parameters.memory;
  memory.eps_c = assumed(usual_eps_c, "no D2 test tells");
  try {
    const PolishOutput fitted = polish(dir, parameters, options);
    const auto& told = *fitted.parameters.memory;
    if (is_told(fitted.account, "memory.eps_c")) memory.eps_c = told.eps_c;
  } catch (const Error& error) {  // no D2 test that could be followed: the other fits stand
    memory.eps_c = assumed(usual_eps_c, std::string("no D2 test tells (") + error.what() + ")");
  }
}

}  // namespace grainlaw::calibrate
