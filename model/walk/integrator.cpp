#include "grainlaw/model/walk/integrator.hpp"

#include <cvodes/cvodes.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <string>
#include <sundials/sundials_context.hpp>
#include <type_traits>
#include <utility>

#include "grainlaw/element/error.hpp"

namespace grainlaw::model {

std::string name_of(Method method) { return method == Method::bdf ? "bdf" : "adams"; }

Method method_of(const std::string& name) {
  for (const Method method : {Method::bdf, Method::adams})
    if (name == name_of(method)) return method;
  throw Error("", "method", "must be one of bdf, adams, got \"" + name + "\"");
}

namespace {

/// CVODE bounds the error of each step, and errors add up along a path: it is asked for this part of the
/// tolerance.
constexpr double safety = 0.02;
constexpr long most_steps = 200'000;

struct FreeVector {
  void operator()(N_Vector v) const { N_VDestroy(v); }
};
struct FreeMatrix {
  void operator()(SUNMatrix m) const { SUNMatDestroy(m); }
};
struct FreeSolver {
  void operator()(SUNLinearSolver s) const { SUNLinSolFree(s); }
};
struct FreeMemory {
  void operator()(void* memory) const { CVodeFree(&memory); }
};
template <class Handle, class Free>
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Free>;

double* data(N_Vector v) { return N_VGetArrayPointer(v); }

bool all_finite(const double* x, int count) {
  return std::all_of(x, x + count, [](double v) { return std::isfinite(v); });
}

/// [i + size k] and CVODES's vector for each k.
void gather(const N_Vector* from, std::vector<double>& to, int size) {
  for (std::size_t k = 0; k * static_cast<std::size_t>(size) < to.size(); ++k)
    std::copy_n(data(from[k]), size, to.data() + k * static_cast<std::size_t>(size));
}
void scatter(const double* from, N_Vector* to, std::size_t count, int size) {
  for (std::size_t k = 0; k < count; ++k)
    std::copy_n(from + k * static_cast<std::size_t>(size), size, data(to[k]));
}

}  // namespace

struct Integrator::Handles {
  Handles(int size_, Tolerance tolerance, Method method, const std::vector<double>& scales);

  // What CVODE calls: 0 done, 1 try a smaller step, -1 the system threw.
  static int rate(realtype t, N_Vector y, N_Vector dydt, void* user);
  static int jacobian(realtype t, N_Vector y, N_Vector, SUNMatrix J, void* user, N_Vector, N_Vector,
                      N_Vector);
  static int event(realtype t, N_Vector y, realtype* g, void* user);
  static int sensitivity_rate(int count, realtype t, N_Vector y, N_Vector, N_Vector* s, N_Vector* dsdt,
                              void* user, N_Vector, N_Vector);
  static void complain(int, const char*, const char*, char* message, void* user);
  template <class Call>
  int guarded(Call call);
  int add_sensitivities(std::vector<double> scales);
  int restart_sensitivities(const double* values);
  int get_sensitivities(double* values);
  std::size_t which_event();

  int size;
  sundials::Context context;  // first in, last out: everything below belongs to it
  Owned<N_Vector, FreeVector> y;
  std::vector<Owned<N_Vector, FreeVector>> sensitivities;  // of y to each parameter
  std::vector<N_Vector> s;                                 // the same, as CVODES takes them
  std::vector<double> s_values, s_rates;                   // [i + size k]
  Owned<SUNMatrix, FreeMatrix> matrix;
  Owned<SUNLinearSolver, FreeSolver> solver;
  std::unique_ptr<void, FreeMemory> memory;

  const System* system = nullptr;
  double t = 0;               // where y belongs
  std::string complaint;      // what CVODE said last
  std::exception_ptr thrown;  // by a function of the system
};

template <class Call>
int Integrator::Handles::guarded(Call call) {
  try {
    return call() ? 0 : 1;
  } catch (...) {  // must not cross C; rethrown by advance()
    thrown = std::current_exception();
    return -1;
  }
}

int Integrator::Handles::rate(realtype t, N_Vector y, N_Vector dydt, void* user) {
  auto& h = *static_cast<Handles*>(user);
  return h.guarded([&] { return h.system->rate(t, data(y), data(dydt)) && all_finite(data(dydt), h.size); });
}

int Integrator::Handles::jacobian(realtype t, N_Vector y, N_Vector, SUNMatrix J, void* user, N_Vector,
                                  N_Vector, N_Vector) {
  auto& h = *static_cast<Handles*>(user);
  double* entries = SUNDenseMatrix_Data(J);
  return h.guarded(
      [&] { return h.system->jacobian(t, data(y), entries) && all_finite(entries, h.size * h.size); });
}

int Integrator::Handles::event(realtype t, N_Vector y, realtype* g, void* user) {
  auto& h = *static_cast<Handles*>(user);
  return h.guarded([&] {
    const auto& others = h.system->others;
    for (std::size_t i = 0; i < others.size(); ++i) g[i] = others[i](t, data(y));
    if (h.system->event) g[others.size()] = h.system->event(t, data(y));
    return true;
  });
}

int Integrator::Handles::sensitivity_rate(int, realtype t, N_Vector y, N_Vector, N_Vector* s, N_Vector* dsdt,
                                          void* user, N_Vector, N_Vector) {
  auto& h = *static_cast<Handles*>(user);
  return h.guarded([&] {
    gather(s, h.s_values, h.size);
    if (!h.system->sensitivity_rate(t, data(y), h.s_values.data(), h.s_rates.data())) return false;
    scatter(h.s_rates.data(), dsdt, h.s.size(), h.size);
    return all_finite(h.s_rates.data(), static_cast<int>(h.s_rates.size()));
  });
}

int Integrator::Handles::add_sensitivities(std::vector<double> scales) {
  for (std::size_t k = 0; k < scales.size(); ++k) {
    sensitivities.emplace_back(N_VNew_Serial(size, context));
    if (!sensitivities.back()) throw Error("the integrator got no memory");
    s.push_back(sensitivities.back().get());
    N_VConst(0.0, s.back());
  }
  s_values.resize(scales.size() * static_cast<std::size_t>(size));
  s_rates.resize(s_values.size());
  void* m = memory.get();
  int failed = CVodeSensInit(m, static_cast<int>(s.size()), CV_STAGGERED, sensitivity_rate, s.data());
  if (failed == 0) failed = CVodeSetSensParams(m, nullptr, scales.data(), nullptr);
  if (failed == 0) failed = CVodeSensEEtolerances(m);
  if (failed == 0) failed = CVodeSetSensErrCon(m, SUNTRUE);
  return failed;
}

int Integrator::Handles::restart_sensitivities(const double* values) {
  if (s.empty()) return 0;
  scatter(values, s.data(), s.size(), size);
  return CVodeSensReInit(memory.get(), CV_STAGGERED, s.data());
}

/// Where CVode() last returned.
int Integrator::Handles::get_sensitivities(double* values) {
  if (s.empty()) return 0;
  double at = 0;
  const int failed = CVodeGetSens(memory.get(), &at, s.data());
  if (failed != 0) return failed;
  gather(s.data(), s_values, size);
  std::copy(s_values.begin(), s_values.end(), values);
  return 0;
}

/// Of several at the same place, the first.
std::size_t Integrator::Handles::which_event() {
  std::vector<int> found(system->others.size() + (system->event ? 1 : 0));
  if (CVodeGetRootInfo(memory.get(), found.data()) != 0) return 0;
  const auto first = std::find_if(found.begin(), found.end(), [](int crossed) { return crossed != 0; });
  return static_cast<std::size_t>(first - found.begin());
}

void Integrator::Handles::complain(int, const char*, const char*, char* message, void* user) {
  static_cast<Handles*>(user)->complaint = message;
}

Integrator::Handles::Handles(int size_, Tolerance tolerance, Method method, const std::vector<double>& scales)
    : size(size_),
      y(N_VNew_Serial(size_, context)),
      matrix(SUNDenseMatrix(size_, size_, context)),
      solver(y && matrix ? SUNLinSol_Dense(y.get(), matrix.get(), context) : nullptr),
      memory(CVodeCreate(method == Method::bdf ? CV_BDF : CV_ADAMS, context)) {
  if (!y || !matrix || !solver || !memory) throw Error("the integrator got no memory");
  N_VConst(0.0, y.get());
  void* m = memory.get();
  int failed = CVodeSetErrHandlerFn(m, complain, this);
  if (failed == 0) failed = CVodeInit(m, rate, 0.0, y.get());
  if (failed == 0) failed = CVodeSStolerances(m, safety * tolerance.rtol, safety * tolerance.atol);
  if (failed == 0) failed = CVodeSetUserData(m, this);
  if (failed == 0) failed = CVodeSetLinearSolver(m, solver.get(), matrix.get());
  if (failed == 0) failed = CVodeSetJacFn(m, jacobian);
  // A Jacobian from where the law was stiffer (P* small) makes Newton's corrections small and looks like
  // convergence: take it anew in every step; it costs little.
  if (failed == 0) failed = CVodeSetJacEvalFrequency(m, 1);
  if (failed == 0) failed = CVodeSetLSetupFrequency(m, 1);
  if (failed == 0) failed = CVodeSetMaxNumSteps(m, most_steps);
  if (failed == 0) failed = CVodeSetNoInactiveRootWarn(m);
  if (failed == 0 && !scales.empty()) failed = add_sensitivities(scales);
  if (failed != 0) throw Error("the integrator cannot be set up: " + complaint);
}

void check(Tolerance tolerance) {
  if (!(tolerance.rtol > 0 && std::isfinite(tolerance.rtol)))
    throw Error("", "rtol", "must be > 0, got " + to_text(tolerance.rtol));
  if (!(tolerance.atol > 0 && std::isfinite(tolerance.atol)))  // a variable may be 0
    throw Error("", "atol", "must be > 0, got " + to_text(tolerance.atol));
}

Integrator::Integrator(int size, Tolerance tolerance, Method method, const std::vector<double>& scales) {
  check(tolerance);
  for (const double scale : scales)
    if (!(scale > 0 && std::isfinite(scale))) throw Error("", "scales", "must be > 0, got " + to_text(scale));
  handles_ = std::make_unique<Handles>(size, tolerance, method, scales);
}

Integrator::~Integrator() = default;
Integrator::Integrator(Integrator&&) noexcept = default;
Integrator& Integrator::operator=(Integrator&&) noexcept = default;

Status Integrator::start(const System& system, double t, double end, const double* y, const double* s) {
  Handles& h = *handles_;
  h.system = &system;
  h.t = t;
  h.complaint.clear();
  std::copy(y, y + h.size, data(h.y.get()));
  void* m = h.memory.get();
  int failed = CVodeReInit(m, t, h.y.get());
  if (failed == 0) failed = h.restart_sensitivities(s);
  const int events = static_cast<int>(system.others.size()) + (system.event ? 1 : 0);
  if (failed == 0) failed = CVodeRootInit(m, events, events > 0 ? Handles::event : nullptr);
  if (failed == 0) failed = CVodeSetStopTime(m, end);
  if (failed != 0) return {Status::Code::failed, "the integrator cannot start: " + h.complaint};
  return {};
}

Integrator::Arrival Integrator::advance(double to, double* y, double* s) {
  Handles& h = *handles_;
  // CVODE refuses a first step below the rounding of t; nothing moves over so short a way.
  constexpr double too_close = 1e-13;
  int code = CV_SUCCESS;
  bool moved = false;
  if (to > h.t + too_close * std::max(1.0, std::abs(to))) {
    code = CVode(h.memory.get(), to, h.y.get(), &h.t, CV_NORMAL);
    moved = true;
  }
  if (h.thrown) std::rethrow_exception(std::exchange(h.thrown, nullptr));
  if (code >= 0 && moved) {
    if (const int failed = h.get_sensitivities(s); failed != 0) code = failed;
  }
  if (code < 0) return {{Status::Code::failed, "CVODE: " + h.complaint}, h.t, false};
  std::copy_n(data(h.y.get()), h.size, y);
  return {{}, h.t, code == CV_ROOT_RETURN, code == CV_ROOT_RETURN ? h.which_event() : 0};
}

long Integrator::steps() const {
  long count = 0;
  CVodeGetNumSteps(handles_->memory.get(), &count);
  return count;
}

}  // namespace grainlaw::model
