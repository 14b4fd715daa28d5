#include "grainlaw/model/predict.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "grainlaw/element/error.hpp"
#include "grainlaw/model/columns.hpp"
#include "grainlaw/model/jamming_events.hpp"
#include "grainlaw/model/pressure_drift.hpp"
#include "grainlaw/model/samples.hpp"
#include "grainlaw/model/start.hpp"
#include "grainlaw/model/walk/controlled_path.hpp"
#include "grainlaw/model/walk/point.hpp"
#include "grainlaw/model/walk/sensitivities.hpp"

namespace grainlaw::model {

namespace {

/// A row further off its leg than this part of it is not on the path (a DEM run may overshoot by a time
/// step).
constexpr double off_path = 0.01;

/// The slopes of sensitive_columns(), name by name.
template <class S>
void append_slopes(std::vector<double>& row, const BasicState<S>& state, std::size_t names) {
  const S none(0.0), &F_dev = state.jammed ? state.F_dev : none;  // as in the column itself
  for (std::size_t k = 0; k < names; ++k)
    for (const S* x : {&state.P, &state.sigma_dev, &F_dev, &state.phi_J}) row.push_back(x->slope[k]);
}

struct Walked {
  Status status;
  std::vector<double> P_at_ends;  // of the legs, up to a failure
  State end = {};
};

/// Walks the legs, with `visit(leg, state)` at every sample.
template <class Point, class Visit>
Walked walk_legs(Point& point, const Path& path, const std::vector<Leg>& legs,
                 const std::vector<Sample>& samples, Visit visit) {
  Walked walked;
  auto next = samples.begin();
  std::vector<double> fractions;
  for (std::size_t i = 0; i < legs.size(); ++i) {
    const Leg& leg = legs[i];
    fractions.clear();
    for (; next != samples.end() && next->leg == i; ++next) fractions.push_back(next->progress);
    if (leg.mode == Mode::relax) point.relax();
    walked.status = point.walk(leg.eps_vol[1] - leg.eps_vol[0], leg.eps_dev[1] - leg.eps_dev[0], fractions,
                               [&](std::size_t, const auto& state) { visit(i, state); });
    if (walked.status.failed()) {
      walked.status.message = path.segments[i].key + ": " + walked.status.message;
      return walked;
    }
    walked.P_at_ends.push_back(value(point.state().P));
  }
  walked.end = values_of(point.state());
  walked.status = end_status({}, walked.end);
  return walked;
}

/// Where a row lies furthest beyond a saturation value, if by more than a per cent. Nothing keeps s_dev and
/// F_dev within them where the volume changes.
void tell_beyond_saturation(const Record& record, const char* column, const char* limit,
                            const Saturation& law, std::vector<std::string>& warnings) {
  double most = 1.01;
  std::size_t row = record.rows();
  for (std::size_t i = 0; i < record.rows(); ++i) {
    const double times = std::abs(record[column][i]) / saturation(law, record["nu"][i]);
    if (!(times > most)) continue;  // nor where there is no stress, or no limit
    most = times;
    row = i;
  }
  if (row < record.rows())
    warnings.push_back(std::string(column) + " goes to " + shown(most) + " " + limit + " " +
                       where(record["nu"][row], record["eps_dev"][row]));
}

void conclude(Prediction& prediction, const Law& law, const std::vector<Leg>& legs, const Walked& walked,
              const std::vector<Event>& events) {
  const Laws& laws = laws_of(law);
  prediction.status = walked.status;
  prediction.end = walked.end;
  tell_events(events, prediction.warnings);
  tell_beyond_saturation(prediction.record, "s_dev", "s_max", laws.s_max, prediction.warnings);
  tell_beyond_saturation(prediction.record, "F_dev", "F_max", laws.F_max, prediction.warnings);
  if (std::holds_alternative<Memory>(law)) return;  // its P comes back to that of phi_J
  tell_drift(pressure_drift(legs, walked.P_at_ends), prediction.warnings);
}

void check_rows(const PredictOptions& options) {
  if (options.rows_per_leg < 1)
    throw Error("", "rows_per_leg", "must be >= 1, got " + std::to_string(options.rows_per_leg));
}

std::vector<Sample> even_samples_of(const ParameterSet& parameters, const Path& path,
                                    const PredictOptions& options) {
  check_rows(options);
  const StartState start = start_of(parameters, path, {options.form, options.terms});
  return even_samples(path.legs(start.state.nu), options.rows_per_leg);
}

std::vector<std::string> idle_names(const Record& record, const std::vector<std::string>& names) {
  const auto idle = [&](const std::string& name) {
    return std::all_of(sensitive_columns().begin(), sensitive_columns().end(), [&](const auto& column) {
      const auto& slopes = record[sensitivity_column(column, name)];
      return std::all_of(slopes.begin(), slopes.end(), [](double x) { return x == 0; });
    });
  };
  std::vector<std::string> result;
  std::copy_if(names.begin(), names.end(), std::back_inserter(result), idle);
  return result;
}

template <class S>
Slopes widened(const S& x) {
  Slopes wide(x.value);
  std::copy(x.slope.begin(), x.slope.end(), wide.slope.begin());
  return wide;
}

template <class S>
SensitivePrediction predict_with(const Seeds& seeds, const ParameterSet& parameters, const Path& path,
                                 const std::vector<Sample>& samples, const PredictOptions& options) {
  const Choice choice{options.form, options.terms};
  const StartState start = start_of(parameters, path, choice);
  const auto slopes = seeds.start<S>(parameters, path, choice);
  const std::vector<Leg> legs = legs_of(path, start.state.nu);
  check_samples(samples, legs.size());
  const std::vector<std::string>& names = seeds.names();
  std::vector<std::string> columns = prediction_columns();
  for (const std::string& name : names)
    for (const std::string& column : sensitive_columns()) columns.push_back(sensitivity_column(column, name));
  SensitivePrediction result{{Record(columns), start.echo, start.warnings, {}}, {}, {}};
  SensitivePoint<S> point(start.law, slopes.law, slopes.state, {options.rtol, options.atol}, seeds.scales(),
                          options.method);
  const auto append = [&](std::size_t leg, const BasicState<S>& state) {
    std::vector<double> row = row_of(point.law(), values_of(state), leg);
    append_slopes(row, state, names.size());
    result.prediction.record.append(row);
  };
  const Walked walked = walk_legs(point, path, legs, samples, append);
  std::vector<Event> events;
  for (const auto& e : point.events()) {
    events.push_back({e.jammed, e.nu.value, e.eps_vol.value, e.eps_dev.value});
    result.events.push_back({e.jammed, widened(e.nu), widened(e.eps_vol), widened(e.eps_dev)});
  }
  conclude(result.prediction, start.law, legs, walked, events);
  result.idle = idle_names(result.prediction.record, names);
  return result;
}

}  // namespace

Prediction predict(const ParameterSet& parameters, const Path& path, const std::vector<Sample>& samples,
                   const PredictOptions& options) {
  const StartState start = start_of(parameters, path, {options.form, options.terms});
  const std::vector<Leg> legs = legs_of(path, start.state.nu);
  check_samples(samples, legs.size());
  Prediction prediction{Record(prediction_columns()), start.echo, start.warnings, {}};
  MaterialPoint point(start.law, start.state, {options.rtol, options.atol}, options.method);
  const Walked walked = walk_legs(point, path, legs, samples, [&](std::size_t leg, const State& state) {
    prediction.record.append(row_of(point.law(), state, leg));
  });
  conclude(prediction, start.law, legs, walked, point.events());
  return prediction;
}

namespace {

/// Where the strain of some segment is found only by walking it.
Prediction predict_controlled(const ParameterSet& parameters, const Path& path,
                              const PredictOptions& options) {
  check_rows(options);
  const StartState start = start_of(parameters, path, {options.form, options.terms});
  Prediction prediction{Record(prediction_columns()), start.echo, start.warnings, {}};
  const Tolerance tolerance{options.rtol, options.atol};
  MaterialPoint point(start.law, start.state, tolerance, options.method);
  const auto visit = [&](std::size_t segment, const State& state) {
    prediction.record.append(row_of(point.law(), state, segment));
  };
  visit(0, point.state());
  const WalkedPath walked = walk_controlled(point, tolerance, path, options.rows_per_leg, visit);
  for (const auto& warning : walked.warnings) prediction.warnings.push_back(warning);
  conclude(prediction, start.law, walked.legs,
           {end_status(walked.status, point.state()), walked.P_at_ends, point.state()}, point.events());
  return prediction;
}

}  // namespace

Prediction predict(const ParameterSet& parameters, const Path& path, const PredictOptions& options) {
  path.need_law_can_follow();
  if (!path.strain_is_known()) return predict_controlled(parameters, path, options);
  return predict(parameters, path, even_samples_of(parameters, path, options), options);
}

SensitivePrediction predict_sensitivities(const ParameterSet& parameters, const Path& path,
                                          const std::vector<Sample>& samples,
                                          const std::vector<std::string>& names,
                                          const PredictOptions& options) {
  const Seeds seeds(parameters, path, names);
  return names.size() <= FewSlopes().slope.size()
             ? predict_with<FewSlopes>(seeds, parameters, path, samples, options)
             : predict_with<Slopes>(seeds, parameters, path, samples, options);
}

SensitivePrediction predict_sensitivities(const ParameterSet& parameters, const Path& path,
                                          const std::vector<std::string>& names,
                                          const PredictOptions& options) {
  return predict_sensitivities(parameters, path, even_samples_of(parameters, path, options), names, options);
}

std::vector<Sample> samples_of(const Record& record, const Path& path, double nu_start) {
  const std::vector<Leg> legs = path.legs(nu_start);
  const auto &segment = record["segment"], &eps_vol = record["eps_vol"], &eps_dev = record["eps_dev"];
  std::vector<Sample> samples;
  for (std::size_t row = 0; row < record.rows(); ++row) {
    const auto fail = [&](const std::string& what) {
      throw Error(path.file, "", "row " + std::to_string(row + 1) + " of the record " + what);
    };
    if (!(segment[row] >= 0 && segment[row] < static_cast<double>(legs.size())))
      fail("has segment " + to_text(segment[row]) + "; the path has " + std::to_string(legs.size()));
    const auto i = static_cast<std::size_t>(segment[row]);
    const Leg& leg = legs[i];
    const double volume = leg.eps_vol[1] - leg.eps_vol[0], shear = leg.eps_dev[1] - leg.eps_dev[0];
    double progress = 1;
    if (volume != 0 || shear != 0)
      progress = std::abs(volume) > std::abs(shear) ? (eps_vol[row] - leg.eps_vol[0]) / volume
                                                    : (eps_dev[row] - leg.eps_dev[0]) / shear;
    if (!(progress >= -off_path && progress <= 1 + off_path))
      fail("is not on segment " + std::to_string(i) + " of the path: eps_vol = " + to_text(eps_vol[row]) +
           ", eps_dev = " + to_text(eps_dev[row]));
    samples.push_back({i, std::clamp(progress, 0.0, 1.0)});
  }
  return samples;
}

MeasuredPath measured_path(const Record& record, const Path& path) {
  path.need_law_can_follow();
  const auto &segment = record["segment"], &eps_vol = record["eps_vol"], &eps_dev = record["eps_dev"];
  const double nu = record["nu"].front() * std::exp(-eps_vol.front());
  const std::vector<Leg> asked = path.nominal_legs(nu);
  const SignConvention sign(asked);
  MeasuredPath measured;
  measured.path.file = path.file;
  measured.path.start = path.start;
  measured.path.start.nu = nu;
  measured.segments = segment;
  measured.samples.push_back({0, 0});
  for (std::size_t row = 1; row < record.rows(); ++row) {
    if (!(segment[row] >= 0 && segment[row] < static_cast<double>(asked.size())))
      throw Error(path.file, "",
                  "row " + std::to_string(row + 1) + " of the record has segment " + to_text(segment[row]) +
                      "; the path has " + std::to_string(asked.size()));
    const auto i = static_cast<std::size_t>(segment[row]);
    const double volume = eps_vol[row] - eps_vol[row - 1], shear = eps_dev[row] - eps_dev[row - 1];
    Segment step;
    step.key = "row " + std::to_string(row + 1);
    step.mode = volume == 0 && shear == 0 ? Mode::relax : Mode::components;
    step.duration = 1;
    const StrainTensor& axis = sign.axis(i);
    const double size = signed_deviator(axis, axis);
    for (std::size_t c = 0; c < 6; ++c) step.strain[c] = (c < 3 ? volume / 3 : 0) + shear * axis[c] / size;
    measured.path.segments.push_back(step);
    measured.samples.push_back({row - 1, 1});
  }
  return measured;
}

}  // namespace grainlaw::model
