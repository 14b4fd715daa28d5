// Random parameters, states and paths, the same in every run: numbers stay numbers, pressure is never
// negative, saturation bounds hold at constant volume, and all integrators agree, or say that they failed.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "grainlaw/model/light/light_law.hpp"
#include "grainlaw/model/start.hpp"
#include "grainlaw/model/walk/point.hpp"
#include "walks.hpp"

namespace grainlaw::model {
namespace {

constexpr Form forms[] = {Form::reduced_closed, Form::reduced, Form::coupled, Form::coupled_3_14};

class Chance {
 public:
  explicit Chance(std::uint64_t seed) : generator_(seed) {}
  /// Uniform in [low, high); the same everywhere, unlike the standard's distributions.
  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(generator_() >> 11) * 0x1p-53;
  }
  bool one_in(int n) { return between(0, n) < 1; }

 private:
  std::mt19937_64 generator_;
};

/// A set with every number within a factor of two, densities within one per cent.
ParameterSet random_set(Chance& chance, ParameterSet set) {
  for (const NamedParameter& entry : set.named()) {
    Parameter& p = set.parameter(entry.name);
    const bool density = entry.name.find("nu_c") != std::string::npos || entry.name.ends_with("phi_SJ");
    const double factor = density ? chance.between(0.99, 1.01) : std::exp(chance.between(-0.7, 0.7));
    if (entry.range.contains(p.value * factor)) p.value *= factor;
  }
  if (chance.one_in(4)) set.moduli->gamma_p.value *= -1;
  return set;
}

struct Leg {
  double eps_vol, eps_dev;
};

std::vector<Leg> random_legs(Chance& chance) {
  std::vector<Leg> legs;
  for (int i = 0; i < 6; ++i) {
    const double size = std::exp(chance.between(std::log(1e-6), std::log(0.2)));
    const double volume = chance.one_in(2) ? 0 : chance.between(-1, 1) * size;
    legs.push_back({volume, chance.one_in(5) ? 0 : chance.between(-1, 1) * size});
  }
  return legs;
}

/// Jammed within the bounds of saturation, or unjammed.
State random_state(Chance& chance, const ParameterSet& set, const Law& law) {
  const Laws& laws = laws_of(law);
  State state;
  state.nu = chance.between(0.64, 0.85);
  if (form_of(law) == Form::memory) {  // of a history
    Path path;
    path.start.nu = state.nu;
    state = start_of(set, path, {Form::memory, {}}).state;
    if (chance.one_in(2)) {
      const Memory& memory = std::get<Memory>(law);
      const double most = std::max(state.history.phi_H, memory.laws.shear_pressure.nu_c);
      state.shear = {chance.between(0, 1), chance.between(0, 1), chance.between(0, 1),
                     chance.between(memory.laws.shear_pressure.nu_c, most)};
    }
    state.phi_J = std::get<Memory>(law).jamming_density_of(state);
    state.P = std::get<Memory>(law).pressure_of(state.nu, state.phi_J);
    state.jammed = state.P > smallest_pressure;
    if (!state.jammed) state.P = 0;
    state.sigma_dev = chance.between(-1, 1) * saturation(laws.s_max, state.nu) * state.P;
    state.F_dev = chance.between(-1, 1) * saturation(laws.F_max, state.nu);
    return state;
  }
  state.phi_J = jamming_density(laws.pressure);
  state.jammed = state.nu > std::max(unjamming_density(law), 1.001 * state.phi_J);
  if (!state.jammed) {
    state.phi_J = std::max(state.phi_J, state.nu);
    return state;
  }
  state.P = pressure(laws.pressure, state.nu);
  state.sigma_dev = chance.between(-1, 1) * saturation(laws.s_max, state.nu) * state.P;
  state.F_dev = chance.between(-1, 1) * saturation(laws.F_max, state.nu);
  return state;
}

/// s and F_dev in units of their saturation values, signed.
struct Fullness {
  double s, F;
};
Fullness fullness(const Law& law, const State& state) {
  if (!state.jammed) return {0, 0};
  return {state.s_dev() / saturation(laws_of(law).s_max, state.nu),
          state.F_dev / saturation(laws_of(law).F_max, state.nu)};
}

/// Whether shear changes pressure faster than stress: in the form with memory by what is remembered, else
/// where G < A1 s. Then ds/d eps_dev = S (G - A1 s)/P has the
/// other sign: sheared against its own direction, s grows without a bound (S vanishes only at q s_max), and
/// from beyond s_max it does not come back.
bool pressure_may_give_way(const Law& law, const State& state) {
  const auto* form = std::get_if<Coupled>(&law);
  if (!form) return form_of(law) == Form::coupled_3_14 || form_of(law) == Form::memory;
  const auto c = form->coefficients(state.nu);
  const Moduli& m = form->laws.moduli;
  return shear_modulus(m, c.B, c.ratio_ini, state.sigma_dev, state.F_dev) <
         std::abs(anisotropy_modulus_1(m, c.B, state.F_dev) * state.s_dev());
}

void expect_same(const State& a, const State& b) {
  EXPECT_EQ(a.nu, b.nu);
  EXPECT_EQ(a.P, b.P);
  EXPECT_EQ(a.sigma_dev, b.sigma_dev);
  EXPECT_EQ(a.F_dev, b.F_dev);
  EXPECT_EQ(a.jammed, b.jammed);
}

struct Tally {
  int legs = 0, failed = 0, disagreed_to_fail = 0, unjammed = 0, beyond = 0, gave_way = 0;
  double most_s = 0, most_ahead = 0;
};

/// One leg; what must hold before and after. False where it failed.
template <class Walk>
bool expect_sound_leg(const Law& law, State& state, const Leg& leg, Walk walk, Tally& tally) {
  const State before = state;
  const Fullness full_before = fullness(law, before);
  const Status status = walk(state, leg);
  ++tally.legs;
  if (status.failed()) {
    ++tally.failed;
    EXPECT_FALSE(status.message.empty());
    expect_same(state, before);
    return false;
  }
  EXPECT_TRUE(is_finite(state));
  EXPECT_TRUE(std::isfinite(state.phi_J));
  EXPECT_GE(state.P, 0);
  EXPECT_EQ(state.jammed, state.P > 0);
  tally.unjammed += !state.jammed;
  const Fullness full = fullness(law, state);
  // Volume changes leave the bounds (Eq. 4.16 has A2 < s B): by how much is counted, not cut.
  constexpr double rounding = 1e-6;
  if (leg.eps_vol == 0 && leg.eps_dev != 0) {
    const double q = sign(leg.eps_dev);
    const bool gives_way = pressure_may_give_way(law, before) || pressure_may_give_way(law, state);
    if (form_of(law) == Form::memory) {  // P falls by what is remembered, not by the stress
      if (full_before.s * q <= 1) tally.most_ahead = std::max(tally.most_ahead, q * full.s);
    } else if (q * full_before.s <= 1 || !gives_way) {
      EXPECT_LE(q * full.s, std::max(1.0, q * full_before.s) + rounding);
    }
    EXPECT_LE(std::abs(full.F), std::max(1.0, std::abs(full_before.F)) + rounding);
    if (-q * full.s > std::max(1.0, -q * full_before.s) + rounding) {
      ++tally.gave_way;
      EXPECT_TRUE(gives_way);
    }
  }
  tally.beyond += std::abs(full.s) > 1 + rounding;
  tally.most_s = std::max(tally.most_s, std::abs(full.s));
  return true;
}

/// Of P*, sigma*_dev over P*, and F_dev over 1.
double distance(const State& a, const State& b) {
  if (a.jammed != b.jammed) return INFINITY;
  const double size = b.P + 1e-6;
  return std::max(
      {std::abs(a.P - b.P) / size, std::abs(a.sigma_dev - b.sigma_dev) / size, std::abs(a.F_dev - b.F_dev)});
}

TEST(RandomPaths, EveryIntegratorIsSoundAndAllAgree) {
  std::map<Form, Tally> tallies;
  int compared = 0;
  for (std::uint64_t seed = 1; seed <= 500; ++seed) {
    Chance chance(seed);
    const Form form = seed <= 400 ? forms[seed % 4] : Form::memory;
    const ParameterSet set = random_set(chance, form == Form::memory ? thesis_with_memory() : thesis());
    SCOPED_TRACE(name_of(form) + ", seed " + std::to_string(seed));
    const Law law = make_law(set, form);
    const Tolerance tolerance{1e-8, 1e-12};
    const State start = random_state(chance, set, law);
    MaterialPoint bdf(law, start, tolerance), adams(law, start, tolerance, Method::adams);
    const LightLaw light(law, tolerance);
    State by_light = start;
    bool wild = false;
    const auto by_point = [](MaterialPoint& point) {
      return [&point](State& state, const Leg& l) {
        const Status status = point.walk(l.eps_vol, l.eps_dev);
        state = point.state();
        return status;
      };
    };
    const auto by_light_path = [&](State& state, const Leg& l) {
      return light.update(state, l.eps_vol, l.eps_dev);
    };
    for (const Leg& leg : random_legs(chance)) {
      State one = bdf.state(), two = adams.state();
      Tally& tally = tallies[form];
      const bool all[] = {expect_sound_leg(law, one, leg, by_point(bdf), tally),
                          expect_sound_leg(law, two, leg, by_point(adams), tally),
                          expect_sound_leg(law, by_light, leg, by_light_path, tally)};
      tally.disagreed_to_fail += all[0] != all[1] || all[0] != all[2];
      if (!all[0] || !all[1] || !all[2]) break;
      // Far beyond saturation, with hardly any pressure left, the law is as sensitive to its state.
      wild = wild || std::abs(fullness(law, one).s) > 1.5;
      EXPECT_LT(distance(two, one), wild ? 1e-3 : 1e-5);
      EXPECT_LT(distance(by_light, one), wild ? 1e-3 : 1e-5);
      compared += !wild;
    }
  }
  EXPECT_GT(compared, 2000);
  int disagreed_to_fail = 0;
  for (const auto& [form, tally] : tallies) {
    disagreed_to_fail += tally.disagreed_to_fail;
    EXPECT_GT(tally.legs, 1500) << name_of(form);
    EXPECT_LT(tally.failed, 10) << name_of(form);
    EXPECT_GT(tally.unjammed, 50) << name_of(form);
  }
  // Of the coupled form, where contact is lost and found again without end.
  EXPECT_LE(disagreed_to_fail, 4);
  EXPECT_EQ(tallies[Form::memory].disagreed_to_fail, 0);
  EXPECT_EQ(tallies[Form::memory].failed, 0);
  // The thesis's own form leaves |s| <= s_max, the reduced closed one never.
  EXPECT_EQ(tallies[Form::reduced_closed].beyond, 0);
  EXPECT_GT(tallies[Form::coupled].beyond, 0);
  EXPECT_GT(tallies[Form::coupled].gave_way, 0);
  EXPECT_LT(tallies[Form::memory].most_ahead, 1.1);
}

}  // namespace
}  // namespace grainlaw::model
