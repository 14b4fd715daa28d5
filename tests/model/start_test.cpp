// What a path starts from, and where each value is from.
#include "grainlaw/model/start.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "checks.hpp"

namespace grainlaw::model {
namespace {

using testing::HasSubstr;

Path start(const std::string& values) {
  return path_of(R"({"start": {)" + values + R"(}, "segments": [{"mode": "d2", "amount": 0.1}]})");
}

StartState started(const std::string& values, Form form = Form::coupled) {
  return start_of(thesis(), start(values), form);
}

/// From 0.7 under a pressure that a file may not ask for.
StartState pressed(const ParameterSet& set, double P, Form form = Form::coupled) {
  Path path = start(R"("nu": 0.7)");
  path.start.P = P;
  return start_of(set, path, form);
}

std::string from(const StartState& state, const char* key) {
  return state.echo[key]["from"].get<std::string>();
}

std::string refused(const std::string& values, Form form) {
  return refusal([&] { started(values, form); });
}

TEST(Start, FillsFromTheParameterSet) {
  const StartState s = started(R"("nu": 0.711)");
  EXPECT_TRUE(s.state.jammed);
  EXPECT_NEAR(s.state.P, 0.0222, 5e-5);
  EXPECT_EQ(s.state.phi_J, 0.6649);
  EXPECT_EQ(s.state.sigma_dev, 0);
  EXPECT_EQ(s.echo["P"]["value"], s.state.P);
  EXPECT_THAT(from(s, "P"), HasSubstr("isotropic.iso"));
  EXPECT_THAT(from(s, "P"), HasSubstr("parameters.json"));
  EXPECT_THAT(from(s, "phi_J"), HasSubstr("nu_c"));
  EXPECT_EQ(from(s, "nu"), "given");
  EXPECT_EQ(from(s, "sigma_dev"), "an isotropic start");
}

TEST(Start, TakesWhatIsGiven) {
  const StartState s =
      started(R"("nu": 0.711, "P": 0.03, "sigma_dev": -0.002, "F_dev": 0.05, "phi_J": 0.66)");
  EXPECT_EQ(s.state.P, 0.03);
  EXPECT_EQ(s.state.sigma_dev, -0.002);
  EXPECT_EQ(s.state.F_dev, 0.05);
  EXPECT_EQ(s.state.phi_J, 0.66);
  for (const char* key : {"nu", "P", "sigma_dev", "F_dev", "phi_J"}) EXPECT_EQ(from(s, key), "given") << key;
}

TEST(Start, JammingDensityReplacesTheOneOfThePressureLaw) {
  for (const Form form : {Form::reduced, Form::coupled}) {
    const StartState s = started(R"("nu": 0.68, "phi_J": 0.67)", form);
    const PressureCurve law = with_jamming_density(thesis().isotropic.at("iso").pressure(), 0.67);
    EXPECT_EQ(s.state.P, pressure(law, 0.68));
    EXPECT_LT(s.state.P, started(R"("nu": 0.68)", form).state.P);
  }
  EXPECT_FALSE(started(R"("nu": 0.669, "phi_J": 0.67)").state.jammed);
}

TEST(Start, JammingDensityMovesTheContactLawsToo) {
  // 0.652 is jammed with phi_J = 0.65, where the set has contacts from 0.658 on.
  for (const Form form : {Form::reduced_closed, Form::reduced, Form::coupled}) {
    SCOPED_TRACE(name_of(form));
    const StartState s = started(R"("nu": 0.652, "phi_J": 0.65)", form);
    EXPECT_TRUE(s.state.jammed);
    EXPECT_TRUE(s.warnings.empty());
    const double factor = 0.65 / 0.6649;
    EXPECT_DOUBLE_EQ(laws_of(s.law).contacts.nu_c, 0.658 * factor);
    const Contacts contacts = contacts_of(s.law, s.state);
    ContactCurve d2 = laws_of(thesis(), form).contacts;
    EXPECT_NEAR(contacts.C_star, corrected_coordination(d2, 0.652 / factor), 1e-12);
    EXPECT_NEAR(contacts.f_NR, 1 - rattlers(d2, 0.652 / factor), 1e-13);
  }
  EXPECT_DOUBLE_EQ(laws_of(started(R"("nu": 0.7, "phi_max": 0.82)").law).contacts.nu_c,
                   0.658 * started(R"("nu": 0.7, "phi_max": 0.82)").state.phi_J / 0.6649);
}

TEST(Start, ThePressureOfASetLeavesTheReducedLawsAsTheyAre) {
  const StartState filled = started(R"("nu": 0.711)", Form::reduced);
  const StartState given = started(R"("nu": 0.711, "P": )" + to_text(filled.state.P), Form::reduced);
  EXPECT_NEAR(given.state.phi_J, 0.6649, 1e-12);
  EXPECT_NEAR(laws_of(given.law).contacts.nu_c, 0.658, 1e-12);
}

TEST(Start, PressureLeavesTheCoupledLawsAsTheyAre) {
  const StartState s = started(R"("nu": 0.711, "P": 0.0264)");
  EXPECT_NEAR(s.state.phi_J, 0.6583, 5e-5);  // of a reduced form
  EXPECT_EQ(laws_of(s.law).contacts.nu_c, 0.658);
}

TEST(Start, LargestVolumeFractionSeenGivesTheJammingDensity) {
  const StartState s = started(R"("nu": 0.7, "phi_max": 0.82)");
  EXPECT_NEAR(s.state.phi_J, 0.66503, 5e-6);  // Eqs. 5.1, 5.5 with M = 1
  EXPECT_THAT(from(s, "phi_J"), HasSubstr("5.1"));
  EXPECT_THAT(refused(R"("nu": 0.7, "phi_max": 0.69)", Form::coupled),
              HasSubstr("p.json: start.phi_max: must be >= "));
  ParameterSet set = thesis();
  set.memory.reset();
  EXPECT_THAT(refusal([&] { start_of(set, start(R"("nu": 0.7, "phi_max": 0.82)"), Form::reduced); }),
              HasSubstr("memory: is missing; start.phi_max needs it"));
}

TEST(Start, ReducedFormsFindTheJammingDensityFromPressure) {
  const StartState s = started(R"("nu": 0.711, "P": 0.025)", Form::reduced);
  EXPECT_LT(s.state.phi_J, 0.6649);
  EXPECT_NEAR(pressure(laws_of(s.law).pressure, 0.711), 0.025, 1e-14);
  EXPECT_THAT(from(s, "phi_J"), HasSubstr("start.P"));
  EXPECT_THAT(refused(R"("nu": 0.711, "P": 0.025, "phi_J": 0.66)", Form::reduced),
              HasSubstr("start.phi_J: redundant"));
  const std::string too_much = refusal([] { pressed(thesis(), 3, Form::reduced); });
  EXPECT_THAT(too_much, HasSubstr("start.P: 3 is more than"));
  EXPECT_THAT(too_much, HasSubstr("with phi_J down to 0.257516, at most "));
  // The coupled form only starts there.
  const StartState beyond = pressed(thesis(), 3);
  EXPECT_EQ(beyond.state.P, 3);
  EXPECT_TRUE(beyond.echo["phi_J"]["value"].is_null());
}

TEST(Start, PressureMayBeUpToTheMaximumOfItsLaw) {
  ParameterSet set = thesis();
  set.isotropic.at("iso").gamma_p.value = 1;
  EXPECT_GT(pressure(laws_of(set, Form::reduced).pressure, 0.6649 * std::exp(0.6)), 0.2);
  EXPECT_NEAR(pressed(set, 0.2, Form::reduced).state.P, 0.2, 1e-12);
  EXPECT_THAT(refusal([&] { pressed(set, 3, Form::reduced); }),
              HasSubstr("start.P: 3 is above the maximum of the pressure law"));
}

TEST(Start, Unjammed) {
  for (const Form form : {Form::reduced_closed, Form::reduced, Form::coupled}) {
    const StartState s = started(R"("nu": 0.64)", form);
    EXPECT_FALSE(s.state.jammed);
    EXPECT_EQ(s.state.P, 0);
    EXPECT_TRUE(std::isnan(s.state.s_dev()));
    EXPECT_TRUE(s.warnings.empty());
    const StartState given = started(R"("nu": 0.64, "F_dev": 0.01)", form);
    EXPECT_EQ(given.state.F_dev, 0);
    ASSERT_EQ(given.warnings.size(), 1U);
    EXPECT_THAT(given.warnings[0], HasSubstr("not used"));
  }
}

TEST(Start, PressureWithoutContactsIsNotUsed) {
  const StartState s = started(R"("nu": 0.655, "P": 1e-5)");  // contacts begin at 0.658
  EXPECT_FALSE(s.state.jammed);
  ASSERT_EQ(s.warnings.size(), 1U);
  EXPECT_THAT(s.warnings[0], HasSubstr("0.658"));
}

TEST(Start, Contradictions) {
  EXPECT_THAT(refused(R"("P": 0.01)", Form::coupled), HasSubstr("p.json: start.nu: is missing"));
  EXPECT_THAT(refused(R"("nu": 0.7, "P": 0, "sigma_dev": 0.1)", Form::coupled),
              HasSubstr("start.sigma_dev: must be 0"));
  EXPECT_THAT(refused(R"("nu": 0.7, "P": 0, "phi_J": 0.66)", Form::coupled),
              HasSubstr("start.P: must be > 0"));
  // The path of a scene stands deeper in its file.
  const Json scene =
      parse_json(R"({"start": {}, "segments": [{"mode": "d2", "amount": 0.1}]})", "scene.json");
  const Path path = Path::read(Reader(scene, "scene.json", "path"));
  EXPECT_THAT(refusal([&] { start_of(thesis(), path, Form::coupled); }),
              HasSubstr("scene.json: path.start.nu"));
}

}  // namespace
}  // namespace grainlaw::model
