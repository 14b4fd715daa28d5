#include "grainlaw/model/walk/sensitivities.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "grainlaw/element/error.hpp"

namespace grainlaw::model {

namespace {

constexpr std::pair<const char*, std::optional<double> Start::*> start_values[] = {
    {"nu", &Start::nu},       {"P", &Start::P},         {"sigma_dev", &Start::sigma_dev},
    {"F_dev", &Start::F_dev}, {"phi_J", &Start::phi_J}, {"phi_max", &Start::phi_max}};

double scale_of(double value) { return value != 0 ? std::abs(value) : 1; }

}  // namespace

Seeds::Seeds(const ParameterSet& parameters, const Path& path, const std::vector<std::string>& names)
    : names_(names) {
  if (names.size() > most_slopes)
    throw Error("", "sensitivities",
                "at most " + std::to_string(most_slopes) + " at a time, got " + std::to_string(names.size()));
  std::map<std::string, const Parameter*> known;
  for (const NamedParameter& entry : parameters.named()) known[entry.name] = entry.parameter;
  std::map<std::string, double> given;
  for (const auto& [key, member] : start_values)
    if (path.start.*member) given[key] = *(path.start.*member);
  std::set<std::string> seen;
  for (std::size_t k = 0; k < names.size(); ++k) {
    const std::string& name = names[k];
    if (!seen.insert(name).second) throw Error("", "sensitivities", name + " is listed twice");
    const bool is_start = name.starts_with("start.");
    if (is_start && given.contains(name.substr(6))) {
      by_start_[name.substr(6)] = k;
      scales_.push_back(scale_of(given[name.substr(6)]));
    } else if (known.contains(name)) {
      by_parameter_[known[name]] = k;
      scales_.push_back(scale_of(known[name]->value));
    } else {
      throw Error(is_start ? path.file : parameters.file, name,
                  is_start ? "is not given by the path; there is nothing to differentiate by"
                           : "no such parameter in the set; there is nothing to differentiate by");
    }
  }
}

template <class S>
BasicStartState<S> Seeds::start(const ParameterSet& parameters, const Path& path,
                                const Choice& choice) const {
  const auto seeded = [](const auto& slots, const auto& key, double value) {
    const auto slot = slots.find(key);
    return slot == slots.end() ? S(value) : S(value, slot->second);
  };
  return start_of<S>(
      parameters, path, choice,
      [&](const Parameter& parameter) { return seeded(by_parameter_, &parameter, parameter.value); },
      [&](const char* key, double value) { return seeded(by_start_, std::string(key), value); });
}

template BasicStartState<Slopes> Seeds::start(const ParameterSet&, const Path&, const Choice&) const;
template BasicStartState<FewSlopes> Seeds::start(const ParameterSet&, const Path&, const Choice&) const;

std::vector<std::string> names_of_sensitivities(const ParameterSet& parameters, const Path& path,
                                                const Choice& choice) {
  std::set<const Parameter*> used;
  start_of<double>(
      parameters, path, choice,
      [&](const Parameter& parameter) {
        used.insert(&parameter);
        return parameter.value;
      },
      [](const char*, double value) { return value; });
  std::vector<std::string> names;
  for (const NamedParameter& entry : parameters.named())
    if (used.contains(entry.parameter)) names.push_back(entry.name);
  for (const auto& [key, member] : start_values)
    if (path.start.*member) names.push_back(std::string("start.") + key);
  return names;
}

const std::vector<std::string>& sensitive_columns() {
  static const std::vector<std::string> columns{"P", "sigma_dev", "F_dev", "phi_J"};
  return columns;
}

std::string sensitivity_column(const std::string& column, const std::string& name) {
  return "d" + column + "/d(" + name + ")";
}

}  // namespace grainlaw::model
