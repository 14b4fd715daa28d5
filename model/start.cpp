#include "grainlaw/model/start.hpp"

#include <cmath>
#include <limits>

#include "grainlaw/element/error.hpp"
#include "grainlaw/model/status.hpp"

namespace grainlaw::model {

namespace {

/// Fills in one start after the other; what was given and what follows stand side by side in `echo`.
class Filling {
 public:
  Filling(const ParameterSet& parameters, const Path& path, const Choice& choice)
      : parameters_(parameters),
        path_(path),
        start_(path.start),
        result_{make_law(parameters, choice), {}, {}, {}} {}

  StartState run() {
    fill_nu();
    fill_phi_J();
    fill_P();
    fill_shear();
    settle();
    return result_;
  }

 private:
  bool coupled() const {
    const Form form = form_of(result_.law);
    return form == Form::coupled || form == Form::coupled_3_14;
  }
  Laws& laws() { return laws_of(result_.law); }
  std::string pressure_law() const {
    return "the pressure law isotropic." + parameters_.closure.P + " (Eq. 2.14)" +
           (parameters_.file.empty() ? "" : " of " + parameters_.file);
  }
  [[noreturn]] void fail(const std::string& key, const std::string& message) const {
    // Segments know where the path stands in its file.
    std::string prefix = path_.segments.empty() ? "" : path_.segments.front().key;
    prefix.resize(std::min(prefix.size(), prefix.find("segments")));
    throw Error(path_.file, prefix + "start." + key, message);
  }
  void echo(const char* key, double value, const std::string& from) {
    result_.echo[key] = {{"value", std::isfinite(value) ? Json(value) : Json(nullptr)}, {"from", from}};
  }

  void fill_nu() {
    if (!start_.nu) fail("nu", "is missing; the parameter set has no volume fraction to start from");
    result_.state.nu = *start_.nu;
    echo("nu", *start_.nu, "given");
  }

  void set_phi_J(double phi_J, const std::string& from) {
    result_.state.phi_J = phi_J;
    echo("phi_J", phi_J, from);
  }
  /// Another jamming density than that of the parameter set moves every law with it.
  void take_history(double phi_J, const std::string& from) {
    laws() = with_jamming_density(laws(), phi_J);
    set_phi_J(phi_J, from);
  }

  void fill_phi_J();
  void check_phi_max();
  /// The reduced forms get P by the law at that phi_J. The coupled form integrates from the given P: its laws
  /// are left as they are.
  void infer_phi_J(double P);
  std::string beyond_pressure_law(double P);
  void fill_P();
  void fill_shear();
  void settle();

  const ParameterSet& parameters_;
  const Path& path_;
  const Start& start_;
  StartState result_;
};

void Filling::fill_phi_J() {
  check_phi_max();
  if (start_.phi_J) {
    if (start_.P && !coupled())
      fail("phi_J", "redundant: with start.P given, the " + name_of(form_of(result_.law)) +
                        " form finds phi_J by the pressure law; give one");
    take_history(*start_.phi_J, "given");
  } else if (start_.P) {
    infer_phi_J(*start_.P);
  } else if (start_.phi_max) {
    const auto memory = parameters_.need_memory("start.phi_max").over_compression();
    take_history(jamming_density_after(memory, *start_.phi_max, 1),
                 "start.phi_max, by Eqs. 5.1 and 5.5 with M = 1");
  } else {
    set_phi_J(jamming_density(laws().pressure), "nu_c of " + pressure_law());
  }
}

void Filling::check_phi_max() {
  if (!start_.phi_max) return;
  if (*start_.phi_max < *start_.nu)
    fail("phi_max", "must be >= start.nu = " + to_text(*start_.nu) + ", got " + to_text(*start_.phi_max));
  const bool used = !start_.phi_J && !start_.P;
  echo("phi_max", *start_.phi_max, used ? "given" : "given; not used, P or phi_J says more");
}

void Filling::infer_phi_J(double P) {
  const auto phi_J = jamming_density_from_pressure(laws().pressure, *start_.nu, P);
  const std::string from = "start.P, by " + pressure_law();
  if (coupled())
    set_phi_J(phi_J.value_or(std::numeric_limits<double>::quiet_NaN()),
              phi_J ? from : "unknown: start.P is beyond " + pressure_law());
  else if (phi_J)
    take_history(*phi_J, from);
  else
    fail("P", beyond_pressure_law(P));
}

std::string Filling::beyond_pressure_law(double P) {
  const PressureCurve& law = laws().pressure;
  const double range = range_of_inversion(law), phi_J = *start_.nu * std::exp(-range);
  const std::string most = shown(pressure(law, law.nu_c * std::exp(range))),
                    at = " at nu = " + to_text(*start_.nu);
  if (range < 1)
    return to_text(P) + " is above the maximum of " + pressure_law() + at + ", " + most +
           " with phi_J = " + shown(phi_J);
  return to_text(P) + " is more than " + pressure_law() + " gives" + at + " with phi_J down to " +
         shown(phi_J) + ", at most " + most;
}

void Filling::fill_P() {
  State& state = result_.state;
  state.P = start_.P ? *start_.P : pressure(laws().pressure, state.nu);
  if (start_.P && *start_.P == 0 && start_.phi_J && *start_.phi_J < state.nu)
    fail("P", "must be > 0 where nu > phi_J, got 0");
  echo("P", state.P, start_.P ? "given" : pressure_law());
}

void Filling::fill_shear() {
  State& state = result_.state;
  state.sigma_dev = start_.sigma_dev.value_or(0);
  state.F_dev = start_.F_dev.value_or(0);
  if (start_.P && *start_.P == 0 && state.sigma_dev != 0)
    fail("sigma_dev", "must be 0 where P = 0, got " + to_text(state.sigma_dev));
  echo("sigma_dev", state.sigma_dev, start_.sigma_dev ? "given" : "an isotropic start");
  echo("F_dev", state.F_dev, start_.F_dev ? "given" : "an isotropic start");
}

/// Jammed or not; an unjammed point carries nothing.
void Filling::settle() {
  State& state = result_.state;
  const double begin = unjamming_density(result_.law);
  state.jammed = state.P > smallest_pressure && state.nu > begin;
  if (state.jammed) return;
  const std::string at = "start: unjammed at nu = " + shown(state.nu);
  if (state.P > smallest_pressure)
    result_.warnings.push_back(at + ", where the contact law has no contacts (it begins at nu = " +
                               shown(begin) + "); P = " + shown(state.P) + " is not used");
  else if (state.sigma_dev != 0 || state.F_dev != 0)
    result_.warnings.push_back(at + "; sigma_dev and F_dev are not used");
  const double phi_J = std::max(state.phi_J, state.nu);
  unjam(result_.law, state);
  state.phi_J = phi_J;
}

}  // namespace

StartState start_of(const ParameterSet& parameters, const Path& path, const Choice& choice) {
  return Filling(parameters, path, choice).run();
}

}  // namespace grainlaw::model
