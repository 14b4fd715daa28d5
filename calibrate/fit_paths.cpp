#include "grainlaw/calibrate/fit_paths.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "grainlaw/calibrate/path_account.hpp"
#include "grainlaw/calibrate/path_errors.hpp"
#include "grainlaw/calibrate/path_problem.hpp"
#include "grainlaw/element/error.hpp"

namespace grainlaw::calibrate {
namespace {

constexpr ColumnWeights alike{1, 1, 1};

/// Parts of the cost that fabric has in the trade-off.
constexpr std::array parts_of_fabric{0.01, 0.1, 0.3, 0.5, 0.7, 0.9, 0.99};

ColumnWeights weights_for(double part_of_fabric) {
  const double stress = std::sqrt(2 * (1 - part_of_fabric));
  ColumnWeights weights{stress, stress, stress};
  weights[fabric_column] = std::sqrt(2 * part_of_fabric);
  return weights;
}

std::vector<TradeOff> sweep(const PathProblem& problem, const PathMinimum& best,
                            const std::set<std::size_t>& fixed) {
  std::vector<TradeOff> points;
  for (const double part : parts_of_fabric) {
    const PathMinimum at = problem.minimise(best.values, weights_for(part), fixed);
    points.push_back({part, at, misfits_of(problem, at.values)});
  }
  return points;
}

/// The set with what was found: values, errors, source "fit", and from which records.
model::ParameterSet polished(const PathProblem& problem, const PathFit& fit, const std::string& records) {
  model::ParameterSet set = problem.with(fit.best.values);
  for (std::size_t k = 0; k < problem.names().size(); ++k) {
    model::Parameter& p = set.parameter(problem.names()[k]);
    if (fit.blind.numbers.contains(k)) continue;  // as it was
    p.stderr_.reset();
    if (std::isfinite(fit.errors.errors[k])) p.stderr_ = fit.errors.errors[k];
    p.source = "fit";
    p.note = "whole paths of " + records + ", from " + to_text(problem.start()[k]);
    if (problem.at_bound(k, fit.best.values[k])) p.note += "; rests on the bound of the law";
  }
  return set;
}

}  // namespace

std::vector<std::string> polished_by_default(const model::ParameterSet& set, const model::Choice& form) {
  std::vector<std::string> wanted{"shear.s_max.Q_max", "shear.s_max.Q_v",  "shear.F_max.Q_v",
                                  "shear.F_max.alpha", "shear.beta_F.Q_v", "shear.beta_F.alpha",
                                  "moduli.g_I",        "moduli.GB_max"};
  const bool coupled = form.form == model::Form::coupled || form.form == model::Form::coupled_3_14;
  if (form.terms.energy)
    wanted.insert(wanted.end(), {"moduli.a_F", "moduli.a_s"});
  else if (coupled)
    wanted.push_back("moduli.a_I");
  else
    wanted.insert(wanted.end(), {"shear.beta_s.Q_max", "shear.beta_s.Q_v"});
  std::vector<std::string> names;
  for (const model::NamedParameter& entry : set.named()) {
    if (!coupled && entry.name.starts_with("moduli.")) continue;
    if (std::find(wanted.begin(), wanted.end(), entry.name) != wanted.end()) names.push_back(entry.name);
  }
  return names;
}

PolishOutput polish(const std::filesystem::path& dir, const model::ParameterSet& start,
                    const PolishOptions& options) {
  return polish(read_records(dir), start, options);
}

PolishOutput polish(const RecordFolder& folder, const model::ParameterSet& start,
                    const PolishOptions& options) {
  std::vector<LeftOut> left_out;
  std::vector<PathSeries> series = path_series(folder, options.selection, left_out);
  if (series.empty()) throw Error(folder.name, "", "no record of a mode and role that a polish reads");
  model::PredictOptions predict;
  predict.form = options.form.form;
  predict.terms = options.form.terms;
  predict.rtol = options.rtol;
  predict.atol = 1e-4 * options.rtol;
  predict.method = model::Method::adams;  // with sensitivities the faster of the two on these paths
  const auto names = options.names.empty() ? polished_by_default(start, options.form) : options.names;
  if (names.empty()) throw Error(start.file, "", "has none of the parameters that a polish fits by default");
  const PathProblem problem(start, names, std::move(series), predict, options.compared);

  PathFit fit;
  fit.blind.reasons.resize(names.size());
  fit.best.values = problem.start();
  std::string why;
  const auto before = problem.evaluate(problem.start(), alike, true, &why);
  PolishOutput out{start, Json::object()};
  if (!before) {
    fit.best.exit = "failed: the law does not come along the paths from the start: " + why;
  } else {
    fit.blind = blind_parameters(problem, before->jacobian);
    fit.best = problem.minimise(problem.start(), alike, fit.blind.numbers);
    if (const auto after = problem.evaluate(fit.best.values, alike, true, &why)) {
      fit.errors = path_errors(problem, *after, fit.blind.numbers);
      out.parameters = polished(problem, fit, folder.name);
      if (options.trade_off && options.compared == all_columns)
        fit.trade_off = sweep(problem, fit.best, fit.blind.numbers);
      for (std::size_t k = 0; options.profiles && k < names.size(); ++k)
        fit.profiles.push_back(fit.blind.numbers.contains(k)
                                   ? Profile{}
                                   : profile_of(problem, fit.best, fit.errors, alike, fit.blind.numbers, k));
    }
  }
  out.account = account_of(problem, fit, left_out);
  if (options.held_out) out.account["held_out"] = held_out(folder, start, out.parameters, options.form);
  return out;
}

}  // namespace grainlaw::calibrate
