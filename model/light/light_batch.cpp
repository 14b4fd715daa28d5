#include "grainlaw/model/light/light_batch.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <string>

#include "grainlaw/element/error.hpp"
#include "grainlaw/model/light/lanes.hpp"

namespace grainlaw::model {

/// What a block of lanes needs, and the step over it.
struct LightBatch::Kernel {
  const Coupled& form;
  Tolerance tolerance;
  double unjamming;
  double* values;
  std::size_t stride;
  using Coefficients = Coupled::Coefficients<Lanes>;
  using Mask = decltype(Lanes{}.v > 0);

  Lanes load(Column which, std::size_t i) const { return Lanes::load(values + which * stride + i); }
  void store(Column which, std::size_t i, const Mask& where, const Lanes& value) const {
    double* place = values + which * stride + i;
    Lanes(where ? value.v : Lanes::load(place).v).store(place);
  }

  bool is_known(std::size_t i, const Lanes& nu) const { return nu == load(known_density, i); }
  Coefficients known(std::size_t i, const Lanes& nu) const {
    if (is_known(i, nu))
      return {load(known_B, i),     load(known_F_v, i),   load(known_ratio, i),
              load(known_s_max, i), load(known_F_max, i), load(known_beta_F, i)};
    return form.coefficients(nu);
  }
  void remember(std::size_t i, const Mask& where, const Lanes& nu, const Coefficients& c) const {
    store(known_density, i, where, nu);
    store(known_B, i, where, c.B);
    store(known_F_v, i, where, c.F_v);
    store(known_ratio, i, where, c.ratio_ini);
    store(known_s_max, i, where, c.s_max);
    store(known_F_max, i, where, c.F_max);
    store(known_beta_F, i, where, c.beta_F);
  }

  /// One step of the third-order pair for the points i to i + 7; bit k of the result: point i + k has taken
  /// it. Which points may, and the error they may make, is as in LightRun.
  unsigned step(std::size_t i, const Lanes& v, const Lanes& e) const {
    const BasicStretch<Lanes> stretch{load(density, i), v, e};
    const bool rests = vanishes(v);
    const Lanes q = stretch.q(), nu_end = rests ? stretch.nu_0 : stretch.nu_0 * exp(v);
    const BasicDirection<Lanes> shear{.q = load(direction, i), .S_I = load(S_I, i), .S_F_I = load(S_F_I, i)};
    Mask may = (load(jammed, i).v > 0) & (q.v == shear.q.v) & (e.v != 0) & (nu_end.v > unjamming) &
               (stretch.nu_0.v > unjamming);
    const std::array<Lanes, 3> y{load(pressure, i), load(stress, i), load(fabric, i)};
    const Coefficients start = known(i, stretch.nu_0);
    Coefficients now = start;
    std::array<std::array<Lanes, 3>, BogackiShampine::stages> k;
    Trial<Lanes, 3> trial;
    const auto rate = [&](double c, const Lanes* x, Lanes* dx) {
      if (!rests) now = form.coefficients(c == 1 ? nu_end : stretch.nu_0 * exp(c * v));
      return form.rate(now, stretch, shear, x, dx);
    };
    if (!form.rate(start, stretch, shear, y.data(), k[0].data())) return 0;
    if (!trial_step<BogackiShampine>(rate, y, 1, k, trial)) return 0;
    may &= accepted(start, y, trial);
    store(pressure, i, may, trial.y[0]);
    store(stress, i, may, trial.y[1]);
    store(fabric, i, may, trial.y[2]);
    store(shear_strain, i, may, load(shear_strain, i) + e);
    if (!rests) {
      store(density, i, may, nu_end);
      store(volume_strain, i, may, load(volume_strain, i) + v);
    }
    if (!rests || !is_known(i, nu_end)) remember(i, may, nu_end, now);
    unsigned taken = 0;
    for (std::size_t lane = 0; lane < Lanes::count; ++lane) taken |= (may[lane] != 0 ? 1U : 0U) << lane;
    return taken;
  }

  /// Where the estimate of the error keeps the tolerance, and the pressure is far from its end.
  Mask accepted(const Coefficients& c, const std::array<Lanes, 3>& y, const Trial<Lanes, 3>& trial) const {
    const auto part = [&](std::size_t j, const Lanes& scale) {
      return abs(trial.error[j]) / (tolerance.rtol * larger(scale, abs(y[j])) + tolerance.atol);
    };
    const Lanes error = larger(part(0, y[0]), larger(part(1, c.s_max * y[0]), part(2, c.F_max)));
    return (error.v <= light_safety_third) & (trial.y[0].v > 0.5 * y[0].v);
  }

  /// Steps over whole blocks from `first` to `last`; calls `left(i)` for each point that has not taken its
  /// own.
  template <class Left>
  void run(std::size_t first, std::size_t last, const double* eps_vol, const double* eps_dev,
           Left left) const {
    for (std::size_t i = first; i + Lanes::count <= last; i += Lanes::count) {
      const unsigned taken = step(i, Lanes::load(eps_vol + i), Lanes::load(eps_dev + i));
      for (std::size_t lane = 0; taken != 0xff && lane < Lanes::count; ++lane)
        if (!(taken >> lane & 1U)) left(i + lane);
    }
  }
};

namespace {

/// A call without its type, so that the kernels of all instruction sets are plain functions.
struct Left {
  void* who;
  void (*call)(void*, std::size_t);
  void operator()(std::size_t i) const { call(who, i); }
};

// Without optimisation nothing is inlined, and functions that pass wide vectors would disagree on how; under
// sanitizers they take a minute to compile.
#if defined(__x86_64__) && defined(__OPTIMIZE__) && !defined(__SANITIZE_ADDRESS__)
#define GRAINLAW_KERNELS 1
#else
#define GRAINLAW_KERNELS 0
#endif

// Everything below is inlined into each of these, and so compiled for its instruction set.
#define GRAINLAW_KERNEL(name, ...)                                                                          \
  template <class Kernel>                                                                                   \
  __attribute__((flatten __VA_ARGS__)) void name(const Kernel& kernel, std::size_t first, std::size_t last, \
                                                 const double* eps_vol, const double* eps_dev, Left left) { \
    kernel.run(first, last, eps_vol, eps_dev, left);                                                        \
  }
GRAINLAW_KERNEL(run_baseline)
#if GRAINLAW_KERNELS
GRAINLAW_KERNEL(run_avx2, , target("avx2,fma"))
GRAINLAW_KERNEL(run_avx512, , target("avx512f,avx512dq,avx512vl,avx2,fma,prefer-vector-width=512"))
#endif
#undef GRAINLAW_KERNEL

enum class Vectors { baseline, avx2, avx512 };

Vectors best_vectors() {
#if GRAINLAW_KERNELS
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl"))
    return Vectors::avx512;
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return Vectors::avx2;
#endif
  return Vectors::baseline;
}

template <class Kernel>
auto best_kernel() {
  switch (best_vectors()) {
#if GRAINLAW_KERNELS
    case Vectors::avx512:
      return run_avx512<Kernel>;
    case Vectors::avx2:
      return run_avx2<Kernel>;
#endif
    default:
      return run_baseline<Kernel>;
  }
}

}  // namespace

std::string LightBatch::vectors() {
  switch (best_vectors()) {
    case Vectors::avx512:
      return "avx512";
    case Vectors::avx2:
      return "avx2";
    default:
      return "baseline";
  }
}

LightBatch::LightBatch(const LightLaw& law, std::size_t count, const State& start)
    : law_(law),
      count_(count),
      stride_((count + Lanes::count - 1) / Lanes::count * Lanes::count),
      values_(columns * stride_) {
  std::fill_n(column(known_density), stride_, std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < count_; ++i) set_state(i, start);
}

State LightBatch::state(std::size_t i) const {
  const auto at = [&](Column which) { return column(which)[i]; };
  return {at(density),
          at(volume_strain),
          at(shear_strain),
          at(pressure),
          at(stress),
          at(fabric),
          at(jamming_density_),
          at(jammed) > 0,
          {at(direction), at(S_I), at(S_F_I), at(s_0), at(F_0), at(shear_strain_0)},
          {at(isotropic_jamming), at(largest_density), at(history_density)},
          {at(memory_plus), at(memory_minus), at(memory_packed), at(memory_steady)}};
}

void LightBatch::set_state(std::size_t i, const State& s) {
  const Direction& d = s.direction;
  const std::array<double, known_density> values{
      s.nu,          s.eps_vol,    s.eps_dev,       s.P,
      s.sigma_dev,   s.F_dev,      s.phi_J,         s.jammed ? 1.0 : 0.0,
      d.q,           d.S_I,        d.S_F_I,         d.s_0,
      d.F_0,         d.eps_dev_0,  s.history.phi_H, s.history.phi_max,
      s.history.nu,  s.shear.plus, s.shear.minus,   s.shear.packed,
      s.shear.steady};
  for (std::size_t which = 0; which < values.size(); ++which) values_[which * stride_ + i] = values[which];
}

LightBatch::Outcome LightBatch::update_range(std::size_t first, std::size_t last, const double* eps_vol,
                                             const double* eps_dev) {
  Outcome outcome;
  auto one_by_one = [&](std::size_t i) {
    State moved = state(i);
    Status status = law_.update(moved, eps_vol[i], eps_dev[i]);
    if (!status.failed()) {
      set_state(i, moved);
      return;
    }
    if (outcome.failed++ > 0) return;
    outcome.first = i;
    outcome.status = std::move(status);
  };
  std::size_t next = first;
  if (const auto* form = std::get_if<Coupled>(&law_.law())) {
    const Kernel kernel{*form, law_.tolerance(), form->unjamming_density(), values_.data(), stride_};
    const Left left{&one_by_one,
                    [](void* who, std::size_t i) { (*static_cast<decltype(one_by_one)*>(who))(i); }};
    best_kernel<Kernel>()(kernel, first, last, eps_vol, eps_dev, left);
    next += (last - first) / Lanes::count * Lanes::count;
  }
  for (; next < last; ++next) one_by_one(next);
  return outcome;
}

LightBatch::Outcome LightBatch::update(std::span<const double> eps_vol, std::span<const double> eps_dev,
                                       int threads) {
  for (const auto& [name, span] : {std::pair{"eps_vol", eps_vol}, std::pair{"eps_dev", eps_dev}})
    if (span.size() != count_)
      throw Error("", name,
                  "must have one number for each of the " + std::to_string(count_) + " points, got " +
                      std::to_string(span.size()));
  if (threads < 1) throw Error("", "threads", "must be >= 1, got " + std::to_string(threads));
  // Fewer points than these are done before another thread has woken up.
  constexpr std::size_t smallest_share = 2048 / Lanes::count;
  const std::size_t blocks = stride_ / Lanes::count;
  if (blocks < 2 * smallest_share || threads == 1)
    return update_range(0, count_, eps_vol.data(), eps_dev.data());
  if (!team_ || team_->threads() != threads) team_ = std::make_unique<ThreadPool>(threads);
  const auto shares = static_cast<std::size_t>(threads);
  std::vector<Outcome> outcomes(shares);
  team_->run([&](int thread) {
    const auto share = static_cast<std::size_t>(thread);
    const auto edge = [&](std::size_t s) { return std::min(count_, blocks * s / shares * Lanes::count); };
    outcomes[share] = update_range(edge(share), edge(share + 1), eps_vol.data(), eps_dev.data());
  });
  Outcome all;
  for (Outcome& outcome : outcomes) {
    if (all.failed == 0 && outcome.failed > 0) {
      all.first = outcome.first;
      all.status = std::move(outcome.status);
    }
    all.failed += outcome.failed;
  }
  return all;
}

}  // namespace grainlaw::model
