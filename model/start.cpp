#include "grainlaw/model/start.hpp"

#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "grainlaw/element/error.hpp"
#include "grainlaw/model/status.hpp"

namespace grainlaw::model {

namespace {

/// Fills in one start after the other; what was given and what follows stand side by side in `echo`.
template <class T>
class Filling {
 public:
  Filling(const ParameterSet& parameters, const Path& path, const Choice& choice, const Reading<T>& read,
          const StartReading<T>& given)
      : parameters_(parameters),
        path_(path),
        start_(path.start),
        read_(read),
        given_(given),
        result_{make_law<T>(parameters, choice, read), {}, {}, {}} {}

  BasicStartState<T> run() {
    check_given();
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
  bool remembers() const { return form_of(result_.law) == Form::memory; }
  BasicLaws<T>& laws() { return laws_of(result_.law); }
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
  void echo(const char* key, const T& number, const std::string& from) {
    const double x = value(number);
    result_.echo[key] = {{"value", std::isfinite(x) ? Json(x) : Json(nullptr)}, {"from", from}};
  }

  void check_given() const {
    for (const auto& [key, number] : {std::pair{"nu", start_.nu},
                                      {"P", start_.P},
                                      {"sigma_dev", start_.sigma_dev},
                                      {"F_dev", start_.F_dev},
                                      {"phi_J", start_.phi_J},
                                      {"phi_max", start_.phi_max}})
      if (number && !std::isfinite(*number)) fail(key, "must be a finite number, got " + to_text(*number));
  }
  void fill_nu() {
    if (!start_.nu) fail("nu", "is missing; the parameter set has no volume fraction to start from");
    result_.state.nu = given_("nu", *start_.nu);
    echo("nu", result_.state.nu, "given");
  }

  void set_phi_J(const T& phi_J, const std::string& from) {
    result_.state.phi_J = phi_J;
    echo("phi_J", phi_J, from);
  }
  /// Another jamming density than that of the parameter set moves every law with it.
  void take_history(const T& phi_J, const std::string& from) {
    if (!remembers()) laws() = with_jamming_density(laws(), phi_J);
    set_phi_J(phi_J, from);
  }

  /// The pressure law at the start's phi_J: the form with memory leaves its laws as they are.
  BasicPressureCurve<T> law_of_history() {
    return remembers() ? with_jamming_density(laws().pressure, result_.state.phi_J) : laws().pressure;
  }
  void fill_history();
  void fill_phi_J();
  void check_phi_max();
  /// The reduced forms get P by the law at that phi_J. The coupled form integrates from the given P: its laws
  /// are left as they are.
  void infer_phi_J(const T& P);
  std::string beyond_pressure_law(const T& P);
  void fill_P();
  void fill_shear();
  void settle();

  const ParameterSet& parameters_;
  const Path& path_;
  const Start& start_;
  const Reading<T>& read_;
  const StartReading<T>& given_;
  BasicStartState<T> result_;
};

template <class T>
void Filling<T>::fill_phi_J() {
  check_phi_max();
  if (start_.phi_J) {
    if (start_.P && !coupled())
      fail("phi_J", "redundant: with start.P given, the " + name_of(form_of(result_.law)) +
                        " form finds phi_J by the pressure law; give one");
    take_history(given_("phi_J", *start_.phi_J), "given");
  } else if (start_.P) {
    infer_phi_J(given_("P", *start_.P));
  } else if (start_.phi_max) {
    const auto memory =
        over_compression_of<T>(parameters_.need_memory("start.phi_max"), [&](const Parameter& p) {
          check_finite(parameters_, p);
          return read_(p);
        });
    take_history(jamming_density_after(memory, given_("phi_max", *start_.phi_max), 1.0),
                 "start.phi_max, by Eqs. 5.1 and 5.5 with M = 1");
  } else if (remembers() && !(result_.state.nu > laws().memory.over.phi_SJ)) {
    set_phi_J(laws().memory.over.phi_SJ,
              "memory.phi_SJ: nu is not above it, and nothing says that it ever was");
  } else {
    set_phi_J(jamming_density(laws().pressure), "nu_c of " + pressure_law());
  }
}

template <class T>
void Filling<T>::check_phi_max() {
  if (!start_.phi_max) return;
  if (*start_.phi_max < *start_.nu)
    fail("phi_max", "must be >= start.nu = " + to_text(*start_.nu) + ", got " + to_text(*start_.phi_max));
  const bool used = !start_.phi_J && !start_.P;
  echo("phi_max", given_("phi_max", *start_.phi_max),
       used ? "given" : "given; not used, P or phi_J says more");
}

template <class T>
void Filling<T>::infer_phi_J(const T& P) {
  const auto phi_J = jamming_density_from_pressure(laws().pressure, result_.state.nu, P);
  const std::string from = "start.P, by " + pressure_law();
  if (coupled())
    set_phi_J(phi_J.value_or(T(std::numeric_limits<double>::quiet_NaN())),
              phi_J ? from : "unknown: start.P is beyond " + pressure_law());
  else if (phi_J)
    take_history(*phi_J, from);
  else
    fail("P", beyond_pressure_law(P));
}

template <class T>
std::string Filling<T>::beyond_pressure_law(const T& P) {
  const BasicPressureCurve<T>& law = laws().pressure;
  const double range = range_of_inversion(law), phi_J = *start_.nu * std::exp(-range);
  const std::string most = shown(value(pressure(law, T(law.nu_c * std::exp(range))))),
                    at = " at nu = " + to_text(*start_.nu);
  if (range < 1)
    return to_text(value(P)) + " is above the maximum of " + pressure_law() + at + ", " + most +
           " with phi_J = " + shown(phi_J);
  return to_text(value(P)) + " is more than " + pressure_law() + " gives" + at + " with phi_J down to " +
         shown(phi_J) + ", at most " + most;
}

template <class T>
void Filling<T>::fill_P() {
  BasicState<T>& state = result_.state;
  state.P = start_.P ? given_("P", *start_.P) : pressure(law_of_history(), state.nu);
  if (start_.P && *start_.P == 0 && start_.phi_J && *start_.phi_J < state.nu)
    fail("P", "must be > 0 where nu > phi_J, got 0");
  echo("P", state.P, start_.P ? "given" : pressure_law());
}

template <class T>
void Filling<T>::fill_shear() {
  BasicState<T>& state = result_.state;
  if (start_.sigma_dev) state.sigma_dev = given_("sigma_dev", *start_.sigma_dev);
  if (start_.F_dev) state.F_dev = given_("F_dev", *start_.F_dev);
  if (start_.P && *start_.P == 0 && state.sigma_dev != 0)
    fail("sigma_dev", "must be 0 where P = 0, got " + to_text(value(state.sigma_dev)));
  echo("sigma_dev", state.sigma_dev, start_.sigma_dev ? "given" : "an isotropic start");
  echo("F_dev", state.F_dev, start_.F_dev ? "given" : "an isotropic start");
}

/// Of the form with memory: phi_J at the start is that of an isotropic packing, and the largest volume
/// fraction it has seen, if not given, the one whose first compression leaves it.
template <class T>
void Filling<T>::fill_history() {
  BasicState<T>& state = result_.state;
  const auto& over = laws().memory.over;
  T phi_max = state.nu;
  if (start_.phi_max) {
    phi_max = given_("phi_max", *start_.phi_max);
  } else {
    const double most = 0.99;
    const auto too_low = [&](double phi) {
      return value(jamming_density_after(over, T(phi), 1.0)) < value(state.phi_J);
    };
    if (too_low(value(state.nu))) {
      // A Newton step after the bisection gives it its slopes.
      const double phi = turning_point(value(state.nu), most, too_low);
      const auto there = jamming_density_after(over, Dual<1, T>(T(phi), 0), 1.0);
      phi_max = phi;
      if (value(there.slope[0]) > 0) phi_max = phi - (there.value - state.phi_J) / value(there.slope[0]);
    }
    echo("phi_max", phi_max,
         "the compression that leaves phi_J, by Eqs. 5.1 and 5.5 with M = 1, at least nu");
  }
  state.history = {state.phi_J, phi_max, state.nu};
  state.shear.steady = std::get<BasicMemory<T>>(result_.law).steady_density(state.nu);
}

/// Jammed or not; an unjammed point carries nothing.
template <class T>
void Filling<T>::settle() {
  BasicState<T>& state = result_.state;
  if (remembers()) {
    fill_history();
    state.jammed = state.P > smallest_pressure;
    if (!state.jammed) unjam(result_.law, state);
    return;
  }
  const T begin = unjamming_density(result_.law);
  state.jammed = state.P > smallest_pressure && state.nu > begin;
  if (state.jammed) return;
  const std::string at = "start: unjammed at nu = " + shown(value(state.nu));
  if (state.P > smallest_pressure)
    result_.warnings.push_back(at + ", where the contact law has no contacts (it begins at nu = " +
                               shown(value(begin)) + "); P = " + shown(value(state.P)) + " is not used");
  else if (state.sigma_dev != 0 || state.F_dev != 0)
    result_.warnings.push_back(at + "; sigma_dev and F_dev are not used");
  const T phi_J = std::max(state.phi_J, state.nu);
  unjam(result_.law, state);
  state.phi_J = phi_J;
}

}  // namespace

template <class T>
BasicStartState<T> start_of(const ParameterSet& parameters, const Path& path, const Choice& choice,
                            const Reading<T>& read, const StartReading<T>& given) {
  return Filling<T>(parameters, path, choice, read, given).run();
}

template BasicStartState<double> start_of(const ParameterSet&, const Path&, const Choice&,
                                          const Reading<double>&, const StartReading<double>&);
template BasicStartState<Slopes> start_of(const ParameterSet&, const Path&, const Choice&,
                                          const Reading<Slopes>&, const StartReading<Slopes>&);
template BasicStartState<FewSlopes> start_of(const ParameterSet&, const Path&, const Choice&,
                                             const Reading<FewSlopes>&, const StartReading<FewSlopes>&);

StartState start_of(const ParameterSet& parameters, const Path& path, const Choice& choice) {
  return start_of<double>(
      parameters, path, choice, [](const Parameter& parameter) { return parameter.value; },
      [](const char*, double number) { return number; });
}

}  // namespace grainlaw::model
