#include "grainlaw/model/predict_minimal.hpp"

#include <cmath>
#include <limits>
#include <string>

#include "grainlaw/element/error.hpp"
#include "grainlaw/model/columns.hpp"
#include "grainlaw/model/jamming_events.hpp"
#include "grainlaw/model/laws/jamming_density.hpp"
#include "grainlaw/model/samples.hpp"

namespace grainlaw::model {

namespace {

/// Tables 5.1 and 5.2 in place of the laws of the whole range.
void take_near_jamming(const ParameterSet& parameters, MinimalLaws& laws) {
  for (const NamedParameter& entry : parameters.named())
    if (entry.name.starts_with("near_jamming.")) check_finite(parameters, *entry.parameter);
  const NearJammingLaws& near = *parameters.near_jamming;
  laws.isotropic = near.iso.pressure();
  laws.sheared = near.d2.pressure();
  laws.s_max = near.s_max.values();
  laws.beta_s = near.beta_s.values();
  laws.F_max = near.F_max.values();
  laws.beta_F = near.beta_F.values();
}

}  // namespace

MinimalLaws minimal_laws(const ParameterSet& parameters) {
  const std::string who = std::string("the ") + minimal_name + " form";
  const Laws laws = laws_of(parameters, Form::reduced_closed);
  const MemoryLaws& memory = parameters.need_memory(who);
  for (const Parameter* p : {&memory.phi_SJ, &memory.mu, &memory.beta, &memory.alpha_max, &memory.alpha_phi,
                             &memory.alpha, &memory.eps0, &memory.eps0_R})
    check_finite(parameters, *p);
  MinimalLaws result;
  result.isotropic = laws.pressure;
  result.sheared = parameters.packing(parameters.closure.contacts, who).pressure();
  result.g3 = laws.g3;
  result.s_max = laws.s_max;
  result.beta_s = laws.beta_s;
  result.F_max = laws.F_max;
  result.beta_F = laws.beta_F;
  if (parameters.near_jamming) take_near_jamming(parameters, result);
  result.over = memory.over_compression();
  result.first = {memory.phi_SJ.value, memory.alpha.value, memory.eps0.value};
  result.again = {memory.phi_SJ.value, memory.alpha.value, memory.eps0_R.value};
  if (memory.phi_cr) {
    check_finite(parameters, *memory.phi_cr);
    result.phi_cr = memory.phi_cr->value;
  }
  return result;
}

namespace {

/// The point that a path starts from, and where its numbers come from.
class MinimalStart {
 public:
  MinimalStart(const Path& path, const Minimal& law) : path_(path), law_(law) {}

  MinimalState state() {
    const Start& start = path_.start;
    if (!start.nu)
      throw Error(path_.file, "start.nu",
                  "is missing; the parameter set has no volume fraction to start from");
    if (start.sigma_dev.value_or(0) != 0 || start.F_dev.value_or(0) != 0)
      throw Error(path_.file, start.F_dev.value_or(0) != 0 ? "start.F_dev" : "start.sigma_dev",
                  "must be left out or 0: the minimal form starts from an isotropic packing");
    for (const auto& [key, number] :
         {std::pair{"nu", start.nu}, {"phi_J", start.phi_J}, {"P", start.P}, {"phi_max", start.phi_max}})
      if (number && !std::isfinite(*number))
        throw Error(path_.file, std::string("start.") + key,
                    "must be a finite number, got " + to_text(*number));
    if (start.phi_max && *start.phi_max < *start.nu)
      throw Error(path_.file, "start.phi_max",
                  "must be >= start.nu = " + to_text(*start.nu) + ", got " + to_text(*start.phi_max));
    MinimalState state;
    state.point.nu = *start.nu;
    state.point.history = {jamming_density(), start.phi_max.value_or(*start.nu), *start.nu};
    law_.settle(state);
    echo("nu", *start.nu, "given");
    echo("P", state.point.P, start.P ? "given" : "Eq. 5.9 at phi_J");
    return state;
  }
  Json& told() { return told_; }

 private:
  void echo(const char* key, double number, const std::string& from) {
    told_[key] = {{"value", number}, {"from", from}};
  }
  double from(double phi_J, const std::string& how) {
    echo("phi_J", phi_J, how);
    return phi_J;
  }
  double jamming_density() {
    const Start& start = path_.start;
    const MinimalLaws& laws = law_.laws;
    if (start.phi_J) return from(*start.phi_J, "given");
    if (start.P) {
      const auto phi_J = jamming_density_from_pressure(laws.isotropic, *start.nu, *start.P);
      if (!phi_J) throw Error(path_.file, "start.P", "is more than Eq. 5.9 gives at this nu with any phi_J");
      return from(*phi_J, "start.P, by Eq. 5.9");
    }
    if (start.phi_max)
      return from(jamming_density_after(laws.over, *start.phi_max, 1.0),
                  "start.phi_max, by Eqs. 5.1 and 5.5 with M = 1");
    if (*start.nu <= laws.over.phi_SJ)
      return from(laws.over.phi_SJ, "memory.phi_SJ: nu is not above it, and nothing says that it ever was");
    return from(laws.isotropic.nu_c, "nu_c of the isotropic row");
  }

  const Path& path_;
  const Minimal& law_;
  Json told_;
};

Contacts contacts_of(const Minimal& law, const MinimalState& state) {
  if (!state.point.jammed) return {0, 0, std::numeric_limits<double>::quiet_NaN(), 0};
  const ContactCurve contacts = law.curve(state).contacts;
  const double nu = at_least_isostatic(contacts, state.point.nu), C = coordination(contacts, nu);
  return {law.laws.g3 * state.point.nu * C, C, corrected_coordination(contacts, nu),
          1 - rattlers(contacts, nu)};
}

/// Where a straight stretch passes phi_J, which moves as well: it may jam, unjam and jam again. Looked for
/// between so many points of it, so that no event hangs on the rows that are asked for.
constexpr int looks = 64;

void find_events(const Minimal& law, const MinimalState& from, double v, double e,
                 std::vector<Event>& events) {
  const auto at = [&](double t) { return law.after(from, v * t, e * t); };
  bool jammed = from.point.jammed;
  const auto note = [&](const State& point) {
    jammed = !jammed;
    events.push_back({jammed, point.nu, point.eps_vol, point.eps_dev});
  };
  if (law.turned(from, e).point.jammed != jammed) note(from.point);  // a reversal moves phi_J at once
  for (int k = 1; k <= looks; ++k) {
    const double to = static_cast<double>(k) / looks;
    if (at(to).point.jammed == jammed) continue;
    note(at(turning_point(to - 1.0 / looks, to, [&](double t) {
           return at(t).point.jammed == jammed;
         })).point);
  }
}

}  // namespace

Prediction predict_minimal(const ParameterSet& parameters, const Path& path,
                           const std::vector<Sample>& samples) {
  const Minimal law{minimal_laws(parameters)};
  MinimalStart start(path, law);
  MinimalState state = start.state();
  const auto legs = legs_of(path, state.point.nu);
  check_samples(samples, legs.size());
  Prediction prediction{Record(prediction_columns()), start.told(), {}, {}};
  const bool has_phi_cr = parameters.need_memory("minimal").phi_cr.has_value();
  bool reverses = false;
  std::vector<Event> events;
  auto next = samples.begin();
  for (std::size_t i = 0; i < legs.size(); ++i) {
    const double v = legs[i].eps_vol[1] - legs[i].eps_vol[0], e = legs[i].eps_dev[1] - legs[i].eps_dev[0];
    for (; next != samples.end() && next->leg == i; ++next) {
      const MinimalState there = next->progress > 0 ? law.after(state, v * next->progress, e * next->progress)
                                                    : state;  // where a reversal is still to come
      prediction.record.append(row_of(contacts_of(law, there), there.point, i));
    }
    if (v != 0 || e != 0) {
      find_events(law, state, v, e, events);
      state = law.after(state, v, e);
    }
    reverses = reverses || state.reversed;
  }
  tell_events(events, prediction.warnings);
  if (!has_phi_cr && reverses)
    prediction.warnings.push_back(
        "memory.phi_cr is missing: a reversal of shear, at any nu, takes phi_J back to what over-compression "
        "has left");
  prediction.end = state.point;
  prediction.status = end_status({}, prediction.end);
  return prediction;
}

Prediction predict_minimal(const ParameterSet& parameters, const Path& path, int rows_per_leg) {
  if (!path.strain_is_known())
    throw Error(path.file, "segments", "must prescribe strains: the minimal form follows no stress");
  if (!path.start.nu)
    throw Error(path.file, "start.nu", "is missing; the parameter set has no volume fraction to start from");
  return predict_minimal(parameters, path, even_samples(legs_of(path, *path.start.nu), rows_per_leg));
}

}  // namespace grainlaw::model
