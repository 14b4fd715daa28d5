// The C interface: states by name, and every bad argument answered with nothing changed.
#include <cmath>
#include <functional>
#include <tuple>

#include "c_interface_fixture.hpp"
#include "grainlaw.h"
#include "grainlaw/element/version.hpp"

namespace grainlaw::model {
namespace {

using testing::HasSubstr;

TEST_F(CInterface, TheStateByName) {
  EXPECT_EQ(grainlaw_state_version(), 2);
  EXPECT_EQ(grainlaw_state_length(law), 23U);
  for (std::size_t i = 0; i < state.size(); ++i)
    EXPECT_EQ(grainlaw_state_index(law, grainlaw_state_name(law, i)), static_cast<int>(i));
  EXPECT_EQ(grainlaw_state_index(law, "sigma"), -1);
  EXPECT_EQ(grainlaw_state_index(law, nullptr), -1);
  EXPECT_EQ(grainlaw_state_name(law, 23), nullptr);
  EXPECT_EQ(grainlaw_state_length(nullptr), 0U);
  EXPECT_EQ(entry("version"), 2);
  EXPECT_EQ(entry("nu"), 0.711);
  EXPECT_EQ(entry("jammed"), 1);
  EXPECT_NEAR(entry("P"), 0.02218, 1e-5);
  EXPECT_NEAR(grainlaw_stress_unit(law), 5e7, 1e-6);  // k/(2<r>) = 5e4 MPa
  EXPECT_TRUE(std::isnan(grainlaw_stress_unit(nullptr)));
}

TEST_F(CInterface, AStartAsThatOfAPath) {
  ASSERT_EQ(begin({{"nu", 0.7}, {"P", 0.03}, {"sigma_dev", -0.002}, {"F_dev", -0.05}}), GRAINLAW_OK);
  EXPECT_EQ(entry("P"), 0.03);
  EXPECT_EQ(entry("sigma_dev"), -0.002);
  EXPECT_EQ(entry("F_dev"), -0.05);
  ASSERT_EQ(grainlaw_stress(context, state.data(), state.size(), stress.data()), GRAINLAW_OK);
  EXPECT_NEAR(stress[0], 0.03 + 0.002 / std::sqrt(3), 1e-16);
  EXPECT_NEAR(stress[1], 0.03 - 0.002 / std::sqrt(3), 1e-16);
  EXPECT_EQ(stress[2], 0.03);
  ASSERT_EQ(begin({{"nu", 0.7}, {"phi_J", 0.65}}), GRAINLAW_OK);
  EXPECT_EQ(entry("phi_J"), 0.65);
  EXPECT_EQ(entry("phi_J_laws"), 0.65);
  ASSERT_EQ(begin({{"nu", 0.7}, {"phi_max", 0.82}}), GRAINLAW_OK);
  EXPECT_NEAR(entry("phi_J"), 0.66503, 1e-5);
  ASSERT_EQ(begin({{"nu", 0.6}, {"F_dev", 0.1}}), GRAINLAW_UNJAMMED);
  EXPECT_EQ(entry("F_dev"), 0);
  EXPECT_THAT(said(), HasSubstr("sigma_dev and F_dev are not used"));
}

TEST_F(CInterface, BadStarts) {
  const std::vector<double> before = state;
  const auto refused = [&](const Given& given, const char* why) {
    expect_refused(begin(given), GRAINLAW_BAD_ARGUMENT, why, before);
  };
  refused({}, "must not be NULL");
  refused({{"P", 0.1}}, "nu: is missing");
  refused({{"nu", 1.5}}, "start: nu: must be > 0 and < 1, got 1.5");
  refused({{"nu", NAN}}, "start: nu: must be finite");
  refused({{"nu", 0.7}, {"nu", 0.7}}, "start: nu: is given twice");
  refused({{"nu", 0.7}, {"sigma", 0.1}}, "start: sigma: unknown key");
  refused({{"nu", 0.7}, {nullptr, 0.1}}, "names[1]: must not be NULL");
  const char* name = "nu";
  const double value = 0.7;
  const auto start = [&](const char* const* names, const double* values, double* to, std::size_t length) {
    return grainlaw_start(context, 1, names, values, to, length);
  };
  expect_refused(start(nullptr, &value, state.data(), 23), GRAINLAW_BAD_ARGUMENT, "names: must not be NULL",
                 before);
  expect_refused(start(&name, nullptr, state.data(), 23), GRAINLAW_BAD_ARGUMENT, "values: must not be NULL",
                 before);
  expect_refused(start(&name, &value, nullptr, 23), GRAINLAW_BAD_ARGUMENT, "state: must not be NULL", before);
  expect_refused(start(&name, &value, state.data(), 22), GRAINLAW_BAD_ARGUMENT,
                 "length: must be grainlaw_state_length() = 23, got 22", before);
  EXPECT_EQ(grainlaw_start(nullptr, 1, &name, &value, state.data(), 23), GRAINLAW_BAD_ARGUMENT);
}

TEST_F(CInterface, BadUpdates) {
  const std::vector<double> before = state;
  const auto call = [&](double* s, std::size_t length, const double* e, double* to) {
    return grainlaw_update(context, s, length, e, to, nullptr);
  };
  const auto refused = [&](int status, const char* why) {
    expect_refused(status, GRAINLAW_BAD_ARGUMENT, why, before);
  };
  refused(call(nullptr, 23, d2_step.data(), stress.data()), "state: must not be NULL");
  refused(call(state.data(), 23, nullptr, stress.data()), "strain_increment: must not be NULL");
  refused(call(state.data(), 23, d2_step.data(), nullptr), "stress: must not be NULL");
  refused(call(state.data(), 17, d2_step.data(), stress.data()), "length: must be");
  refused(update({0, 0, 0, 0, 0, NAN}), "strain_increment[5]: must be finite, got nan");
  refused(update({INFINITY, 0, 0, 0, 0, 0}), "strain_increment[0]: must be finite, got inf");
  EXPECT_EQ(grainlaw_update(nullptr, state.data(), 23, d2_step.data(), stress.data(), nullptr),
            GRAINLAW_BAD_ARGUMENT);
  EXPECT_STREQ(grainlaw_message(nullptr), "the context is NULL");
  EXPECT_EQ(grainlaw_stress(context, state.data(), 3, stress.data()), GRAINLAW_BAD_ARGUMENT);
  EXPECT_EQ(grainlaw_stress(context, state.data(), 23, nullptr), GRAINLAW_BAD_ARGUMENT);
  EXPECT_EQ(grainlaw_context_replay_file(nullptr, "x"), GRAINLAW_BAD_ARGUMENT);
}

TEST_F(CInterface, StatesThatAreNone) {
  for (const auto& [name, value, why] : std::vector<std::tuple<const char*, double, const char*>>{
           {"version", 1, "state: version: must be 2"},
           {"version", 0, "state: version: must be 2"},
           {"nu", 0, "state: nu: must be > 0"},
           {"nu", NAN, "state: nu: must be finite"},
           {"P", -1, "state: P: must be > 0 where jammed, got -1"},
           {"sigma_dev", INFINITY, "state: sigma_dev: must be finite"},
           {"phi_J", INFINITY, "state: phi_J: must be a number"},
           {"jammed", 0.5, "state: jammed: must be 0 or 1"},
           {"jammed", 0, "state: P: must be 0 where unjammed"},
           {"phi_J_laws", 0, "state: phi_J_laws: must be > 0"},
           {"direction", 2, "state: direction: must be -1, 0 or 1"},
           {"S_I", 0, "state: S_I: must be > 0"},
           {"S_F_I", -1, "state: S_F_I: must be > 0"},
           {"memory_plus", -1e-9, "state: memory_plus: must be in [0, 1]"},
           {"memory_minus", 1.5, "state: memory_minus: must be in [0, 1]"},
           {"packed", 2, "state: packed: must be in [0, 1]"},
           {"phi_t", NAN, "state: phi_t: must be finite"}}) {
    const std::vector<double> good = state;
    entry(name) = value;
    const std::vector<double> before = state;
    expect_refused(update(d2_step), GRAINLAW_BAD_ARGUMENT, why, before);
    state = good;
  }
  EXPECT_EQ(update(d2_step), GRAINLAW_OK);
  EXPECT_EQ(said(), "");
}

TEST_F(CInterface, BadLaws) {
  const auto refused = [&](const char* text, const grainlaw_settings* how, int status, const char* why) {
    grainlaw_law* none = law;
    char message[256] = "untouched";
    EXPECT_EQ(grainlaw_law_from_text(text, how, &none, message, sizeof message), status);
    EXPECT_THAT(message, HasSubstr(why));
    EXPECT_EQ(none, nullptr);
    EXPECT_EQ(grainlaw_law_from_text(text, how, &none, nullptr, 0), status);
  };
  const std::string good = thesis().to_json().dump();
  refused(nullptr, &settings, GRAINLAW_BAD_INPUT, "text: must not be NULL");
  refused("{", &settings, GRAINLAW_BAD_INPUT, "parameters: line 1 is not valid JSON");
  refused("{}", &settings, GRAINLAW_BAD_INPUT, "parameters: format: is missing");
  refused(good.c_str(), nullptr, GRAINLAW_BAD_ARGUMENT, "settings: must not be NULL");
  const auto with = [&](const std::function<void(grainlaw_settings&)>& change) {
    grainlaw_settings changed = settings;
    change(changed);
    return changed;
  };
  const auto bad = [&](const std::function<void(grainlaw_settings&)>& change, const char* why) {
    const grainlaw_settings changed = with(change);
    refused(good.c_str(), &changed, GRAINLAW_BAD_ARGUMENT, why);
  };
  bad([](auto& s) { s.size = 8; }, "settings.size: must be");
  bad([](auto& s) { s.form = "coupling"; }, "form: must be one of");
  bad([](auto& s) { s.form = "coupled+magic"; }, "coupled takes the terms axial, energy, volumetric");
  bad([](auto& s) { s.form = nullptr; }, "settings.form: must not be NULL");
  bad([](auto& s) { s.rtol = 0; }, "rtol: must be > 0");
  bad([](auto& s) { s.atol = NAN; }, "atol: must be > 0");
  bad([](auto& s) { s.coaxial_tolerance = 2; }, "coaxial_tolerance: must be");
  bad([](auto& s) { std::fill_n(s.axis, 6, 0.0); }, "axis: must have a deviator");
  const grainlaw_settings energy = with([](auto& s) { s.form = "coupled+energy"; });
  refused(good.c_str(), &energy, GRAINLAW_BAD_INPUT, "a_F");  // the thesis has no such number
  EXPECT_EQ(grainlaw_law_from_text(good.c_str(), &settings, nullptr, nullptr, 0), GRAINLAW_BAD_ARGUMENT);

  grainlaw_law* none = nullptr;
  char message[256];
  EXPECT_EQ(grainlaw_law_from_file("no.json", &settings, &none, message, sizeof message), GRAINLAW_BAD_INPUT);
  EXPECT_THAT(message, HasSubstr("no.json: no such file"));
  EXPECT_EQ(grainlaw_law_from_file(nullptr, &settings, &none, message, 8), GRAINLAW_BAD_INPUT);
  EXPECT_STREQ(message, "file: m");  // a short buffer cuts
  grainlaw_context* nobody = context;
  EXPECT_EQ(grainlaw_context_create(nullptr, &nobody), GRAINLAW_BAD_ARGUMENT);
  EXPECT_EQ(nobody, nullptr);
  EXPECT_EQ(grainlaw_context_create(law, nullptr), GRAINLAW_BAD_ARGUMENT);
  double axis[6];
  EXPECT_EQ(grainlaw_axis("d4", axis), GRAINLAW_BAD_ARGUMENT);
  EXPECT_EQ(grainlaw_axis(nullptr, axis), GRAINLAW_BAD_ARGUMENT);
  EXPECT_EQ(grainlaw_axis("d2", nullptr), GRAINLAW_BAD_ARGUMENT);
  grainlaw_law_destroy(nullptr);
  grainlaw_context_destroy(nullptr);
}

TEST_F(CInterface, TextsOfStatuses) {
  for (const int status : {GRAINLAW_OK, GRAINLAW_UNJAMMED, GRAINLAW_FAILED, GRAINLAW_NOT_COAXIAL,
                           GRAINLAW_BAD_ARGUMENT, GRAINLAW_BAD_INPUT})
    EXPECT_STRNE(grainlaw_status_text(status), "unknown status");
  EXPECT_STREQ(grainlaw_status_text(42), "unknown status");
  EXPECT_EQ(grainlaw_version(), version());
}

}  // namespace
}  // namespace grainlaw::model
