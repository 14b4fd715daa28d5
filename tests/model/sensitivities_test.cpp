// Sensitivities against central differences of predictions: through reversals, loss of contact and back, and
// the vanishing of pressure; their error against the tolerance.
#include "grainlaw/model/walk/sensitivities.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <map>
#include <memory>

#include "walks.hpp"

namespace grainlaw::model {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr double exact_rtol = 1e-12, exact_atol = 1e-16;

struct Case {
  const char* name;
  const char* path;
  ParameterSet set = thesis();
};

/// Loses its pressure in shear: A1 S takes more than there is.
const char* vanishing = R"({"start": {"nu": 0.6582, "P": 1e-4, "sigma_dev": 2e-5, "F_dev": 0.15},
    "segments": [{"mode": "d2", "amount": -0.1}, {"mode": "iso", "amount": 0.05}]})";

const char* simple =
    R"({"start": {"nu": 0.69, "phi_max": 0.75, "F_dev": 0.02}, "segments": [{"mode": "d2", "amount": 0.05},
    {"mode": "iso", "amount": 0.02}, {"mode": "d2", "amount": -0.02}]})";

/// With numbers for the term past the thesis.
ParameterSet with_energy() {
  ParameterSet set = thesis();
  set.moduli->a_F = set.moduli->a_s = set.moduli->a_I;
  set.moduli->a_F->value = 3.59;
  set.moduli->a_s->value = 0.149;
  return set;
}

std::vector<Case> cases() {
  ParameterSet fresh = thesis();
  fresh.closure = {"iso", "d2", false};
  return {
      {"D2Cycle", R"({"start": {"nu": 0.711}, "segments": [{"mode": "d2", "controls": {"eps_dev": 0.1}},
          {"mode": "d2", "controls": {"eps_dev": -0.05}}, {"mode": "relax"}, {"mode": "d2", "controls": {"eps_dev": 0.1}}]})"},
      {"UniThroughUnjammingAndBack", R"({"start": {"nu": 0.7}, "segments": [{"mode": "uni", "amount": 0.03},
          {"mode": "uni", "amount": -0.1}, {"mode": "uni", "amount": 0.15}]})"},
      {"UniFromUnjammed", R"({"start": {"nu": 0.66}, "segments": [{"mode": "uni", "amount": 0.15}]})"},
      {"PressureVanishesInShear", vanishing},
      {"GivenHistory", simple, with_energy()},
      {"ContactsOfTheirOwn", R"({"start": {"nu": 0.69}, "segments": [{"mode": "uni", "amount": 0.03}]})",
       fresh},
  };
}

/// The path and set with one of their numbers moved.
struct Moved {
  ParameterSet set;
  Path path;
  double* number;
};
std::unique_ptr<Moved> moved(const Case& c, const std::string& name, double by) {
  auto m = std::make_unique<Moved>(Moved{c.set, path_of(c.path), nullptr});
  Start& start = m->path.start;
  const std::map<std::string, std::optional<double>*> starts{
      {"start.nu", &start.nu},       {"start.P", &start.P},         {"start.sigma_dev", &start.sigma_dev},
      {"start.F_dev", &start.F_dev}, {"start.phi_J", &start.phi_J}, {"start.phi_max", &start.phi_max}};
  const auto at = starts.find(name);
  m->number = at != starts.end() ? &at->second->value() : &m->set.parameter(name).value;
  *m->number += by;
  return m;
}
double size_of(const Case& c, const std::string& name) {
  const double number = *moved(c, name, 0)->number;
  return number != 0 ? std::abs(number) : 1;
}

Record record_of(const Moved& m, Form form, Terms terms) {
  const Prediction p = predict(m.set, m.path, {form, exact_rtol, exact_atol, 4, terms});
  EXPECT_FALSE(p.status.failed()) << p.status.message;
  return p.record;
}

double largest(const std::vector<double>& x) {
  double most = 0;
  for (const double value : x) most = std::max(most, std::abs(value));
  return most;
}

/// Central differences over steps from 1e-3 of a number to 1e-10, against the slopes: the error of each is
/// below 1e-6 at its best (the differences themselves, at 1e-12, are no better than that), and falls and
/// rises again over the steps. Steps too small for anything but rounding and a size that nothing has are left
/// out.
void expect_derivatives(const Case& c, Form form, Terms terms = {}) {
  SCOPED_TRACE(std::string(c.name) + ", " + name_of(Choice{form, terms}));
  const auto names = names_of_sensitivities(c.set, path_of(c.path), {form, terms});
  const auto s =
      predict_sensitivities(c.set, path_of(c.path), names, {form, exact_rtol, exact_atol, 4, terms});
  ASSERT_FALSE(s.prediction.status.failed()) << s.prediction.status.message;
  constexpr std::array steps{1e-3, 1e-5, 1e-6, 1e-10};
  std::array<double, steps.size()> worst{};
  for (const std::string& name : names) {
    const double size = size_of(c, name);
    std::map<std::string, double> lowest;
    for (std::size_t k = 0; k < worst.size(); ++k) {
      const double h = steps[k] * size;
      const Record up = record_of(*moved(c, name, h), form, terms),
                   down = record_of(*moved(c, name, -h), form, terms);
      for (const std::string& column : sensitive_columns()) {
        const auto& slopes = s.prediction.record[sensitivity_column(column, name)];
        double error = 0;
        for (std::size_t i = 0; i < slopes.size(); ++i)
          error = std::max(error, std::abs((up[column][i] - down[column][i]) / (2 * h) - slopes[i]));
        if (!lowest.contains(column) || error < lowest[column]) lowest[column] = error;
        if (largest(slopes) > 0.01 * largest(up[column]) / size)
          worst[k] = std::max(worst[k], error / largest(slopes));
      }
    }
    for (const std::string& column : sensitive_columns())
      EXPECT_LT(lowest[column], 1e-6 * largest(s.prediction.record[sensitivity_column(column, name)]) +
                                    1e-7 * largest(s.prediction.record[column]) / size)
          << column << " by " << name;
  }
  const double least = std::min(worst[1], worst[2]);
  EXPECT_GT(worst[0], 10 * least) << "no truncation error";
  EXPECT_GT(worst[3], 10 * least) << "no rounding error: is this a difference at all?";
}

/// The form with memory, through over-compression and loss of contact, where the contacts of isotropic
/// packings and of steady shear end and begin with infinite slopes, and through shear jamming and back. Its
/// rates have kinks ((G/B)_ini is cut at F_v,min), which derivatives cannot pass at 1e-12.
TEST(Sensitivities, OfTheFormWithMemory) {
  const ParameterSet set = thesis_with_memory();
  // Steps of the differences: the longer, the less the scatter of predictions counts, but a kink the more.
  const std::pair<Case, double> paths[] = {
      {{"first compression", R"({"start": {"nu": 0.64}, "segments": [{"mode": "uni", "amount": 0.15},
          {"mode": "uni", "amount": -0.14}]})",
        set},
       3e-6},
      {{"over-compression", R"({"start": {"nu": 0.69}, "segments": [{"mode": "uni", "amount": 0.03},
          {"mode": "uni", "amount": -0.1}, {"mode": "uni", "amount": 0.15}]})",
        set},
       1e-6},
      {{"shear jamming", R"({"start": {"nu": 0.661}, "segments": [{"mode": "d2", "amount": 0.3},
          {"mode": "d2", "amount": -0.056}, {"mode": "d2", "amount": -0.3}]})",
        set},
       1e-6}};
  for (const auto& [c, step] : paths) {
    SCOPED_TRACE(c.name);
    const auto names = names_of_sensitivities(c.set, path_of(c.path), {Form::memory, {}});
    const auto s = predict_sensitivities(c.set, path_of(c.path), names, {Form::memory, 1e-8, 1e-12, 4});
    ASSERT_FALSE(s.prediction.status.failed()) << s.prediction.status.message;
    EXPECT_GE(s.events.size(), 2U);
    for (const std::string& name : names) {
      const double size = size_of(c, name), h = step * size;
      const Record up = record_of(*moved(c, name, h), Form::memory, {}),
                   down = record_of(*moved(c, name, -h), Form::memory, {});
      for (const std::string& column : sensitive_columns()) {
        const auto& slopes = s.prediction.record[sensitivity_column(column, name)];
        double error = 0;
        for (std::size_t i = 0; i < slopes.size(); ++i)
          error = std::max(error, std::abs((up[column][i] - down[column][i]) / (2 * h) - slopes[i]));
        EXPECT_LE(error, 1e-4 * largest(slopes) + 1e-6 * largest(up[column]) / size)
            << column << " by " << name << " " << largest(slopes);
      }
    }
  }
}

TEST(Sensitivities, OfFabricUnderVolumeChange) {
  ParameterSet set = thesis();
  set.volumetric.emplace();
  set.volumetric->compression.value = 1.5;
  set.volumetric->decompression.value = 0.7;
  for (const Form form : {Form::coupled, Form::reduced})
    expect_derivatives({"fabric", simple, set}, form, {.volumetric = true});
}

TEST(Sensitivities, OfTheTermsOfModuli) {
  ParameterSet set = thesis();
  set.moduli->F_v.emplace().value = 6.2;
  const std::vector<double> nu{0.68, 0.7, 0.72, 0.76};
  set.moduli_table.emplace().table = ModuliTable(nu, {{{0.33, 0.4, 0.46, 0.56},
                                                       {0.8, 0.76, 0.7, 0.61},
                                                       {1.2, 1.2, 1.1, 1},
                                                       {0.25, 0.37, 0.42, 0.46},
                                                       {13, 120, 142, 100}}});
  for (const Terms terms : {Terms{.constant_F_v = true}, Terms{.moduli_table = true}})
    expect_derivatives({"moduli", simple, set}, Form::coupled, terms);
}

class SensitivitiesOf : public testing::TestWithParam<Case> {};

TEST_P(SensitivitiesOf, AreTheDerivativesOfPredictions) {
  expect_derivatives(GetParam(), Form::coupled);
  if (GetParam().path == vanishing) return;
  if (GetParam().path == simple) {
    expect_derivatives(GetParam(), Form::coupled, {.energy = true});
    expect_derivatives(GetParam(), Form::coupled_3_14);
  }
  expect_derivatives(GetParam(), Form::reduced);
  expect_derivatives(GetParam(), Form::reduced_closed);
}

INSTANTIATE_TEST_SUITE_P(Paths, SensitivitiesOf, testing::ValuesIn(cases()),
                         [](const auto& c) { return c.param.name; });

Record sensitivities_at(const Case& c, Form form, double rtol, double atol) {
  const auto names = names_of_sensitivities(c.set, path_of(c.path), {form, {}});
  return predict_sensitivities(c.set, path_of(c.path), names, {form, rtol, atol, 50}).prediction.record;
}

/// Largest error, relative L2 over the rows, of scale dx/dp and of x, in units of rtol.
double error_over_tolerance(const Case& c, Form form, double rtol, const Record& reference) {
  const auto names = names_of_sensitivities(c.set, path_of(c.path), {form, {}});
  const Record coarse = sensitivities_at(c, form, rtol, 1e-3 * rtol);
  double worst = 0;
  for (const std::string column : {"P", "sigma_dev", "F_dev"})
    for (const std::string& name : names) {
      // A sensitivity far below the quantity itself is held to the quantity's tolerance.
      const auto &exact = reference[sensitivity_column(column, name)],
                 &found = coarse[sensitivity_column(column, name)], &quantity = reference[column];
      double error = 0, square = 0, own = 0;
      for (std::size_t i = 0; i < exact.size(); ++i) {
        error += std::pow(found[i] - exact[i], 2);
        square += std::pow(exact[i], 2);
        own += std::pow(quantity[i] / size_of(c, name), 2);
      }
      if (error > 0) worst = std::max(worst, std::sqrt(error / std::max(square, own)) / rtol);
    }
  return worst;
}

TEST(Sensitivities, AchieveTheirErrorButWherePressureVanishes) {
  // Where shear takes the pressure away, P* ~ (t* - t)^(1/2) and dP*/dp ~ (t* - t)^(-1/2): steps without end,
  // each with its error. What follows inherits it.
  for (const Case& c : cases()) {
    if (c.path == vanishing) continue;
    const double allowed = c.name == std::string("UniThroughUnjammingAndBack") ? 200 : 10;
    const Record reference = sensitivities_at(c, Form::coupled, 1e-12, 1e-16);
    double loosest = 0;
    for (const double rtol : {1e-4, 1e-6, 1e-8}) {
      const double ratio = error_over_tolerance(c, Form::coupled, rtol, reference);
      EXPECT_LT(ratio, allowed) << c.name << " at " << rtol;
      loosest = std::max(loosest, ratio);
    }
    EXPECT_GT(loosest, 1e-3) << c.name << ": the tolerance does nothing";
  }
}

TEST(Sensitivities, SayHowAnEventMoves) {
  const Case c{"vanishing", vanishing};
  const auto at = [&](double by) {
    const auto m = moved(c, "moduli.a_I", by);
    return predict_sensitivities(m->set, m->path, {"moduli.a_I"}, {Form::coupled, exact_rtol, exact_atol, 1})
        .events;
  };
  const auto events = at(0), up = at(1e-4), down = at(-1e-4);
  ASSERT_EQ(events.size(), 2U);
  EXPECT_FALSE(events[0].jammed);
  EXPECT_NE(events[0].eps_dev.slope[0], 0);  // lost in shear at constant volume
  EXPECT_EQ(events[0].nu.slope[0], 0);
  EXPECT_NEAR((up[0].eps_dev.value - down[0].eps_dev.value) / 2e-4, events[0].eps_dev.slope[0],
              1e-6 * std::abs(events[0].eps_dev.slope[0]));
}

TEST(Sensitivities, ValuesAreThoseOfThePredictionAndIdleNamesAreTold) {
  const Path path = path_of(R"({"start": {"nu": 0.711}, "segments": [{"mode": "d2", "amount": 0.1}]})");
  const auto s = predict_sensitivities(thesis(), path, {"moduli.a_I", "memory.mu", "isotropic.d3.C1"});
  const Prediction p = predict(thesis(), path);
  for (const std::string& column : prediction_columns())
    for (std::size_t i = 0; i < p.record.rows(); ++i)
      EXPECT_NEAR(s.prediction.record[column][i], p.record[column][i], 1e-8 * std::abs(p.record[column][i]))
          << column;
  EXPECT_THAT(s.idle, ElementsAre("memory.mu", "isotropic.d3.C1"));
  EXPECT_NE(s.prediction.record["dP/d(moduli.a_I)"].back(), 0);
  EXPECT_EQ(s.prediction.start, p.start);
}

TEST(Sensitivities, RefuseWhatIsNotThere) {
  const Path path = path_of(R"({"start": {"nu": 0.711}, "segments": [{"mode": "d2", "amount": 0.1}]})");
  const auto refused = [&](const std::vector<std::string>& names) {
    return refusal([&] { predict_sensitivities(thesis(), path, names); });
  };
  EXPECT_THAT(refused({"moduli.a_III"}), HasSubstr("moduli.a_III: no such parameter"));
  EXPECT_THAT(refused({"start.P"}), HasSubstr("start.P: is not given by the path"));
  EXPECT_THAT(refused({"moduli.a_I", "moduli.a_I"}), HasSubstr("moduli.a_I is listed twice"));
  std::vector<std::string> many;
  const ParameterSet set = thesis();
  for (const auto& entry : set.named()) many.push_back(entry.name);
  EXPECT_THAT(refused(many), HasSubstr("at most 64"));
}

TEST(Sensitivities, AFailureIsAStatus) {
  ParameterSet set = thesis();
  set.shear->beta_F->Q_max.value = 1e308;
  const auto s = predict_sensitivities(
      set, path_of(R"({"start": {"nu": 0.66}, "segments": [{"mode": "uni", "amount": 0.1}]})"),
      {"moduli.a_I"});
  EXPECT_TRUE(s.prediction.status.failed());
}

TEST(Sensitivities, SwitchedOffCostNothing) {
  // A state without them is the numbers of its own alone, and the plain walk knows of none.
  static_assert(sizeof(State) ==
                7 * sizeof(double) + 8 + sizeof(Direction) + sizeof(History) + sizeof(ShearHistory));
  static_assert(sizeof(ShearHistory) == 4 * sizeof(double));
  static_assert(sizeof(Direction) == 6 * sizeof(double) + 8 + sizeof(History));
  const Path path = path_of(R"({"start": {"nu": 0.711}, "segments": [{"mode": "d2", "amount": 0.1}]})");
  EXPECT_EQ(predict(thesis(), path).record.columns(), prediction_columns());
}

}  // namespace
}  // namespace grainlaw::model
