#include "grainlaw/model/predict.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "grainlaw/element/error.hpp"
#include "grainlaw/model/point.hpp"
#include "grainlaw/model/start.hpp"

namespace grainlaw::model {

namespace {

/// A row further off its leg than this part of it is not on the path (a DEM run may overshoot by a time
/// step).
constexpr double off_path = 0.01;
/// Warnings about lost and found contacts are listed up to this many.
constexpr std::size_t most_events = 10;

bool is_shear(const Leg& leg) { return leg.eps_dev[0] != leg.eps_dev[1]; }

/// The law carries one direction of shear: every leg must keep the axes of the first that shears.
void check_axes(const Path& path, const std::vector<Leg>& legs) {
  const auto first = std::find_if(legs.begin(), legs.end(), is_shear);
  for (auto leg = first; leg != legs.end(); ++leg)
    if (is_shear(*leg) && !coaxial(leg->strain, first->strain))
      throw Error(path.file, path.segments[static_cast<std::size_t>(leg - legs.begin())].key,
                  "mode " + name_of(leg->mode) + " is not coaxial with " + name_of(first->mode) +
                      " before it: the law carries stress and fabric along one direction of shear only");
}

std::vector<Sample> even_samples(const std::vector<Leg>& legs, int rows_per_leg) {
  std::vector<Sample> samples{{0, 0}};
  for (std::size_t i = 0; i < legs.size(); ++i) {
    const int rows = legs[i].mode == Mode::relax ? 1 : rows_per_leg;
    for (int row = 1; row <= rows; ++row) samples.push_back({i, static_cast<double>(row) / rows});
  }
  return samples;
}

void check_samples(const std::vector<Sample>& samples, std::size_t legs) {
  Sample last;
  for (const Sample& sample : samples) {
    const bool ordered =
        sample.leg > last.leg || (sample.leg == last.leg && sample.progress >= last.progress);
    if (sample.leg >= legs || !(sample.progress >= 0 && sample.progress <= 1) || !ordered)
      throw Error("", "samples",
                  "must be points of the path in order, got leg " + std::to_string(sample.leg) +
                      ", progress " + to_text(sample.progress));
    last = sample;
  }
}

/// A row of prediction_columns().
void append_row(Record& record, const Law& law, const State& state, std::size_t leg) {
  const Contacts contacts = contacts_of(law, state);
  const auto value = [&](std::string_view column) {
    if (column == "segment") return static_cast<double>(leg);
    if (column == "eps_vol") return state.eps_vol;
    if (column == "eps_dev") return state.eps_dev;
    if (column == "nu") return state.nu;
    if (column == "P") return state.P;
    if (column == "sigma_dev") return state.sigma_dev;
    if (column == "s_dev") return state.s_dev();
    if (column == "F_v") return contacts.F_v;
    if (column == "F_dev") return state.F_dev;
    if (column == "C") return contacts.C;
    if (column == "C_star") return contacts.C_star;
    if (column == "f_NR") return contacts.f_NR;
    if (column == "phi_J") return state.phi_J;
    throw Error("the law has no column " + std::string(column));
  };
  std::vector<double> row;
  for (const auto& column : record.columns()) row.push_back(value(column));
  record.append(row);
}

std::string where(double nu, double eps_dev) {
  return "at nu = " + shown(nu) + ", eps_dev = " + shown(eps_dev);
}

void tell_events(const std::vector<Event>& events, std::vector<std::string>& warnings) {
  for (std::size_t i = 0; i < std::min(events.size(), most_events); ++i)
    warnings.push_back((events[i].jammed ? "jams " : "unjams: loses its pressure ") +
                       where(events[i].nu, events[i].eps_dev));
  if (events.size() > most_events)
    warnings.push_back("unjams and jams " + std::to_string(events.size() - most_events) + " times more");
}

/// Where a direction of shear ended.
struct Turn {
  double q, eps_dev, P;
};

/// Change of P per half cycle between two ends of the same direction one cycle apart, as a part of P; 0 where
/// the cycle is not closed, or no pressure was left. A cycle is compared and not its halves, because within
/// one P also dips after a reversal and recovers.
double drift_over_cycle(const Turn& before, const Turn& reversal, const Turn& after) {
  constexpr double closed = 0.01;  // of the strain of a half cycle
  const bool returns =
      std::abs(after.eps_dev - before.eps_dev) <= closed * std::abs(after.eps_dev - reversal.eps_dev);
  return returns && before.P > 0 && after.P > 0 ? std::sqrt(after.P / before.P) - 1 : 0;
}

/// The largest drift_over_cycle() in shear at constant volume; `P_at_ends` of the legs that were walked.
double pressure_drift(const std::vector<Leg>& legs, const std::vector<double>& P_at_ends) {
  constexpr double constant_volume = 1e-9;  // of the shear strain
  double largest = 0;
  std::vector<Turn> turns;  // since the volume last changed
  for (std::size_t i = 0; i < P_at_ends.size(); ++i) {
    const double volume = legs[i].eps_vol[1] - legs[i].eps_vol[0],
                 shear = legs[i].eps_dev[1] - legs[i].eps_dev[0], q = shear > 0 ? 1 : -1;
    if (std::abs(volume) > constant_volume * std::abs(shear)) {
      turns.clear();
    } else if (shear != 0) {
      if (!turns.empty() && turns.back().q == q) turns.pop_back();
      turns.push_back({q, legs[i].eps_dev[1], P_at_ends[i]});
    }
    if (turns.size() < 3) continue;
    const double drift = drift_over_cycle(turns.end()[-3], turns.end()[-2], turns.back());
    if (std::abs(drift) > std::abs(largest)) largest = drift;
  }
  return largest;
}

/// Eq. 4.16 has no restoring term in dP*: cycles of shear pump pressure.
void tell_drift(double drift, std::vector<std::string>& warnings) {
  constexpr double tolerated = 0.01;
  if (std::abs(drift) <= tolerated) return;
  char percent[32];
  std::snprintf(percent, sizeof percent, "%.1f", 100 * std::abs(drift));
  warnings.push_back(std::string(drift > 0 ? "gains" : "loses") + " up to " + percent +
                     " % of P per half cycle of shear at constant volume, without a bound: Eq. 4.16 has no "
                     "restoring term in dP");
}

struct Walked {
  Status status;
  std::vector<double> P_at_ends;  // of the legs, up to a failure
};

/// Walks the legs and appends a row per sample.
Walked walk_legs(MaterialPoint& point, const Path& path, const std::vector<Leg>& legs,
                 const std::vector<Sample>& samples, Record& record) {
  Walked walked;
  auto next = samples.begin();
  std::vector<double> fractions;
  for (std::size_t i = 0; i < legs.size(); ++i) {
    const Leg& leg = legs[i];
    fractions.clear();
    for (; next != samples.end() && next->leg == i; ++next) fractions.push_back(next->progress);
    if (leg.mode == Mode::relax) point.relax();
    walked.status =
        point.walk(leg.eps_vol[1] - leg.eps_vol[0], leg.eps_dev[1] - leg.eps_dev[0], fractions,
                   [&](std::size_t, const State& state) { append_row(record, point.law(), state, i); });
    if (walked.status.failed()) {
      walked.status.message = path.segments[i].key + ": " + walked.status.message;
      return walked;
    }
    walked.P_at_ends.push_back(point.state().P);
  }
  const State& end = point.state();
  if (!end.jammed)
    walked.status = {Status::Code::unjammed,
                     "carries no stress at the end: unjammed " + where(end.nu, end.eps_dev)};
  return walked;
}

}  // namespace

Prediction predict(const ParameterSet& parameters, const Path& path, const std::vector<Sample>& samples,
                   const PredictOptions& options) {
  const StartState start = start_of(parameters, path, {options.form, options.terms});
  const std::vector<Leg> legs = path.legs(start.state.nu);
  check_axes(path, legs);
  check_samples(samples, legs.size());
  Prediction prediction{Record(prediction_columns()), start.echo, start.warnings, {}};
  MaterialPoint point(start.law, start.state, {options.rtol, options.atol});
  const Walked walked = walk_legs(point, path, legs, samples, prediction.record);
  prediction.status = walked.status;
  tell_events(point.events(), prediction.warnings);
  tell_drift(pressure_drift(legs, walked.P_at_ends), prediction.warnings);
  return prediction;
}

Prediction predict(const ParameterSet& parameters, const Path& path, const PredictOptions& options) {
  if (options.rows_per_leg < 1)
    throw Error("", "rows_per_leg", "must be >= 1, got " + std::to_string(options.rows_per_leg));
  const StartState start = start_of(parameters, path, {options.form, options.terms});
  return predict(parameters, path, even_samples(path.legs(start.state.nu), options.rows_per_leg), options);
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
    for (std::size_t c = 0; c < 3; ++c) step.strain[c] = volume / 3 + shear * axis[c] / size;
    measured.path.segments.push_back(step);
    measured.samples.push_back({row - 1, 1});
  }
  return measured;
}

}  // namespace grainlaw::model
