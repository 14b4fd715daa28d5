// The C interface: every bad argument is answered and changes nothing; many points and threads agree with
// one; what failed is replayed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "checks.hpp"
#include "grainlaw.h"
#include "grainlaw/element/file.hpp"
#include "grainlaw/element/version.hpp"
#include "grainlaw/model/replay.hpp"

namespace grainlaw::model {
namespace {

using testing::HasSubstr;
using testing::StartsWith;
using Six = std::array<double, 6>;

constexpr Six d2_step{-1e-4, 1e-4, 0, 0, 0, 0};

/// A law, a context, and the state of a point at nu = 0.711.
class CInterface : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(grainlaw_axis("d2", settings.axis), GRAINLAW_OK);
    make(thesis().to_json().dump());
  }
  void TearDown() override { destroy(); }

  void destroy() {
    grainlaw_context_destroy(context);
    grainlaw_law_destroy(law);
  }
  void make(const std::string& text) {
    destroy();
    char message[256];
    ASSERT_EQ(grainlaw_law_from_text(text.c_str(), &settings, &law, message, sizeof message), GRAINLAW_OK)
        << message;
    ASSERT_EQ(grainlaw_context_create(law, &context), GRAINLAW_OK);
    state.assign(grainlaw_state_length(law), 0);
    ASSERT_EQ(begin({{"nu", 0.711}}), GRAINLAW_OK) << said();
  }
  /// A set whose s_max is negative at high densities.
  void make_failing() {
    ParameterSet set = thesis();
    set.shear->s_max->Q_max.value = -0.05;
    make(set.to_json().dump());
  }

  using Given = std::vector<std::pair<const char*, double>>;
  int begin(const Given& given) {
    std::vector<const char*> names;
    std::vector<double> values;
    for (const auto& [name, value] : given) {
      names.push_back(name);
      values.push_back(value);
    }
    return grainlaw_start(context, given.size(), names.data(), values.data(), state.data(), state.size());
  }
  int update(const Six& increment, double* matrix = nullptr) {
    return grainlaw_update(context, state.data(), state.size(), increment.data(), stress.data(), matrix);
  }
  double& entry(const char* name) {
    return state.at(static_cast<std::size_t>(grainlaw_state_index(law, name)));
  }
  std::string said() const { return grainlaw_message(context); }

  /// The status, and that neither state nor stress has changed.
  void expect_refused(int status, int expected, const std::string& why, const std::vector<double>& before) {
    EXPECT_EQ(status, expected) << said();
    EXPECT_THAT(said(), HasSubstr(why));
    EXPECT_TRUE(std::equal(state.begin(), state.end(), before.begin(),
                           [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }));
    EXPECT_EQ(stress, untouched);
  }

  static constexpr Six untouched{7, 7, 7, 7, 7, 7};
  grainlaw_settings settings = GRAINLAW_SETTINGS;
  grainlaw_law* law = nullptr;
  grainlaw_context* context = nullptr;
  std::vector<double> state;
  Six stress = untouched;
  std::array<double, 36> tangent{};
};

TEST_F(CInterface, TheStateByName) {
  EXPECT_EQ(grainlaw_state_version(), 1);
  EXPECT_EQ(grainlaw_state_length(law), 16U);
  for (std::size_t i = 0; i < state.size(); ++i)
    EXPECT_EQ(grainlaw_state_index(law, grainlaw_state_name(law, i)), static_cast<int>(i));
  EXPECT_EQ(grainlaw_state_index(law, "sigma"), -1);
  EXPECT_EQ(grainlaw_state_index(law, nullptr), -1);
  EXPECT_EQ(grainlaw_state_name(law, 16), nullptr);
  EXPECT_EQ(grainlaw_state_length(nullptr), 0U);
  EXPECT_EQ(entry("version"), 1);
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
  expect_refused(start(nullptr, &value, state.data(), 16), GRAINLAW_BAD_ARGUMENT, "names: must not be NULL",
                 before);
  expect_refused(start(&name, nullptr, state.data(), 16), GRAINLAW_BAD_ARGUMENT, "values: must not be NULL",
                 before);
  expect_refused(start(&name, &value, nullptr, 16), GRAINLAW_BAD_ARGUMENT, "state: must not be NULL", before);
  expect_refused(start(&name, &value, state.data(), 15), GRAINLAW_BAD_ARGUMENT,
                 "length: must be grainlaw_state_length() = 16, got 15", before);
  EXPECT_EQ(grainlaw_start(nullptr, 1, &name, &value, state.data(), 16), GRAINLAW_BAD_ARGUMENT);
}

TEST_F(CInterface, BadUpdates) {
  const std::vector<double> before = state;
  const auto call = [&](double* s, std::size_t length, const double* e, double* to) {
    return grainlaw_update(context, s, length, e, to, nullptr);
  };
  const auto refused = [&](int status, const char* why) {
    expect_refused(status, GRAINLAW_BAD_ARGUMENT, why, before);
  };
  refused(call(nullptr, 16, d2_step.data(), stress.data()), "state: must not be NULL");
  refused(call(state.data(), 16, nullptr, stress.data()), "strain_increment: must not be NULL");
  refused(call(state.data(), 16, d2_step.data(), nullptr), "stress: must not be NULL");
  refused(call(state.data(), 17, d2_step.data(), stress.data()), "length: must be");
  refused(update({0, 0, 0, 0, 0, NAN}), "strain_increment[5]: must be finite, got nan");
  refused(update({INFINITY, 0, 0, 0, 0, 0}), "strain_increment[0]: must be finite, got inf");
  EXPECT_EQ(grainlaw_update(nullptr, state.data(), 16, d2_step.data(), stress.data(), nullptr),
            GRAINLAW_BAD_ARGUMENT);
  EXPECT_STREQ(grainlaw_message(nullptr), "the context is NULL");
  EXPECT_EQ(grainlaw_stress(context, state.data(), 3, stress.data()), GRAINLAW_BAD_ARGUMENT);
  EXPECT_EQ(grainlaw_stress(context, state.data(), 16, nullptr), GRAINLAW_BAD_ARGUMENT);
  EXPECT_EQ(grainlaw_context_replay_file(nullptr, "x"), GRAINLAW_BAD_ARGUMENT);
}

TEST_F(CInterface, StatesThatAreNone) {
  for (const auto& [name, value, why] : std::vector<std::tuple<const char*, double, const char*>>{
           {"version", 2, "state: version: must be 1"},
           {"version", 0, "state: version: must be 1"},
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
           {"S_F_I", -1, "state: S_F_I: must be > 0"}}) {
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
  bad([](auto& s) { s.form = "coupled+magic"; }, "coupled takes the terms energy");
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
  EXPECT_EQ(grainlaw_context_create(nullptr, &context), GRAINLAW_BAD_ARGUMENT);
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

TEST_F(CInterface, AZeroIncrementLeavesThePointAndHasATangent) {
  ASSERT_EQ(update(d2_step), GRAINLAW_OK);
  const std::vector<double> before = state;
  const Six stress_before = stress;
  ASSERT_EQ(update({}), GRAINLAW_OK);
  ASSERT_EQ(update({}, tangent.data()), GRAINLAW_OK);
  EXPECT_EQ(state, before);
  EXPECT_EQ(stress, stress_before);
  const double B = (tangent[0] + tangent[1] + tangent[2] + tangent[6] + tangent[7] + tangent[8] +
                    tangent[12] + tangent[13] + tangent[14]) /
                   9;
  EXPECT_NEAR(B, 0.4279, 1e-4);  // Eq. 4.11
}

TEST_F(CInterface, Unjammed) {
  EXPECT_EQ(update({-0.1, -0.1, -0.1, 0, 0, 0}, tangent.data()), GRAINLAW_UNJAMMED);
  EXPECT_EQ(stress, Six{});
  EXPECT_EQ(entry("P"), 0);
  EXPECT_EQ(entry("jammed"), 0);
  EXPECT_EQ(tangent, (std::array<double, 36>{}));
  EXPECT_EQ(update({}), GRAINLAW_UNJAMMED);
  EXPECT_EQ(grainlaw_stress(context, state.data(), state.size(), stress.data()), GRAINLAW_UNJAMMED);
  EXPECT_EQ(update({0.1, 0.1, 0.1, 0, 0, 0}), GRAINLAW_OK);
  EXPECT_GT(stress[0], 0.01);
}

TEST_F(CInterface, TensionPositiveHosts) {
  settings.tension_positive = 1;
  settings.engineering_shear = 1;
  settings.axis[5] = 0.5;
  make(thesis().to_json().dump());
  ASSERT_EQ(update({1e-3, -1e-3, 0, 0, 0, -1e-3}, tangent.data()), GRAINLAW_OK) << said();
  EXPECT_GT(entry("eps_dev"), 0);
  EXPECT_GT(entry("sigma_dev"), 0);
  EXPECT_LT(stress[0] + stress[1] + stress[2], 0);
  EXPECT_LT(stress[1], stress[0]);  // y is compressed
  EXPECT_LT(stress[5], 0);
  EXPECT_GT(tangent[0], 0.3);
}

/// Points at several densities, with states further apart than they are long.
struct Field {
  static constexpr std::size_t count = 101, stride = 20;
  std::vector<double> states = std::vector<double>(count * stride, 13.0), strains, stresses, tangents;
  std::vector<int> statuses = std::vector<int>(count, 99);
  grainlaw_outcome outcome{99, 99, 99};

  explicit Field(grainlaw_context* context) : stresses(6 * count, 7.0), tangents(36 * count) {
    const std::array names{"nu", "phi_J"};
    for (std::size_t i = 0; i < count; ++i) {
      const std::array values{0.66 + 0.001 * static_cast<double>(i), i % 3 == 0 ? 0.66 : 0.665};
      EXPECT_GE(grainlaw_start(context, 2, names.data(), values.data(), &states[i * stride], 16), 0);
      const double e = 1e-4 * (1 + static_cast<double>(i % 7));
      strains.insert(strains.end(), {1e-5 - e, 1e-5 + e, 1e-5, 0, 0, 0});
    }
  }
  int update(grainlaw_context* context, int threads, bool slopes = true) {
    return grainlaw_update_many(context, count, states.data(), stride, strains.data(), stresses.data(),
                                slopes ? tangents.data() : nullptr, threads, statuses.data(), &outcome);
  }
};

TEST_F(CInterface, ManyPointsAsOneByOne) {
  for (const int threads : {1, 3, 200})
    for (const bool slopes : {false, true}) {
      Field field(context), alone(context);
      EXPECT_EQ(field.update(context, threads, slopes), GRAINLAW_UNJAMMED);  // the loosest points
      EXPECT_EQ(field.outcome.failed, 0U);
      std::size_t unjammed = 0;
      for (std::size_t i = 0; i < Field::count; ++i) {
        const int status =
            grainlaw_update(context, &alone.states[i * Field::stride], 16, &alone.strains[6 * i],
                            &alone.stresses[6 * i], slopes ? &alone.tangents[36 * i] : nullptr);
        EXPECT_EQ(field.statuses[i], status);
        if (status == GRAINLAW_UNJAMMED) ++unjammed;
      }
      EXPECT_EQ(field.outcome.unjammed, unjammed);
      EXPECT_GT(unjammed, 0U);
      EXPECT_EQ(field.states, alone.states);
      EXPECT_EQ(field.stresses, alone.stresses);
      EXPECT_EQ(field.tangents, alone.tangents);
    }
}

TEST_F(CInterface, ManyPointsNameTheFirstThatFails) {
  for (const int threads : {1, 4}) {
    Field field(context);
    field.strains[6 * 80 + 3] = 1;
    field.strains[6 * 42 + 5] = 1e-4;
    field.strains[6 * 90] = NAN;
    const Field before = field;
    EXPECT_EQ(field.update(context, threads), GRAINLAW_NOT_COAXIAL);
    EXPECT_EQ(field.outcome.failed, 3U);
    EXPECT_EQ(field.outcome.first, 42U);
    EXPECT_THAT(said(), StartsWith("point 42: the strain increment is not coaxial"));
    EXPECT_EQ(field.statuses[42], GRAINLAW_NOT_COAXIAL);
    EXPECT_EQ(field.statuses[90], GRAINLAW_BAD_ARGUMENT);
    for (const std::size_t i : {42, 80, 90}) {
      EXPECT_TRUE(std::equal(&field.states[i * Field::stride], &field.states[i * Field::stride] + 16,
                             &before.states[i * Field::stride]));
      EXPECT_EQ(field.stresses[6 * i], 7);
    }
    EXPECT_NE(field.states[43 * Field::stride + 8], before.states[43 * Field::stride + 8]);
  }
}

TEST_F(CInterface, ManyPointsBadArguments) {
  Field field(context);
  const auto call = [&](double* s, std::size_t stride, const double* e, double* to, int threads) {
    return grainlaw_update_many(context, Field::count, s, stride, e, to, nullptr, threads,
                                field.statuses.data(), &field.outcome);
  };
  double *s = field.states.data(), *e = field.strains.data(), *to = field.stresses.data();
  const auto refused = [&](int status, const char* why) {
    EXPECT_EQ(status, GRAINLAW_BAD_ARGUMENT);
    EXPECT_THAT(said(), HasSubstr(why));
    EXPECT_EQ(field.statuses[0], 99);
    EXPECT_EQ(field.outcome.failed, 99U);
    EXPECT_EQ(field.stresses[0], 7);
  };
  refused(call(nullptr, 20, e, to, 1), "states: must not be NULL");
  refused(call(s, 20, nullptr, to, 1), "strain_increments: must not be NULL");
  refused(call(s, 20, e, nullptr, 1), "stresses: must not be NULL");
  refused(call(s, 15, e, to, 1), "stride: must be >= grainlaw_state_length() = 16, got 15");
  refused(call(s, 20, e, to, 0), "threads: must be >= 1, got 0");
  EXPECT_EQ(grainlaw_update_many(context, 0, s, 20, e, to, nullptr, 2, nullptr, nullptr), GRAINLAW_OK);
}

TEST_F(CInterface, AContextPerThreadAndOneLaw) {
  const auto walk = [this](grainlaw_context* own, double sign) {
    std::vector<double> point(16);
    Six there{};
    std::array<double, 36> slopes{};
    const char* name = "nu";
    const double nu = 0.7 + 0.01 * sign;
    EXPECT_EQ(grainlaw_start(own, 1, &name, &nu, point.data(), 16), GRAINLAW_OK);
    for (int i = 0; i < 3000; ++i) {
      const double e = (i % 300 < 200 ? sign : -sign) * 1e-4;
      const Six along{-e, e, 0, 0, 0, 0}, off{0, 0, 0, 0, 0, e};
      EXPECT_EQ(grainlaw_update(own, point.data(), 16, off.data(), there.data(), nullptr),
                GRAINLAW_NOT_COAXIAL);
      EXPECT_EQ(
          grainlaw_update(own, point.data(), 16, along.data(), there.data(), i % 2 ? slopes.data() : nullptr),
          GRAINLAW_OK);
    }
    point.insert(point.end(), there.begin(), there.end());
    return point;
  };
  const std::vector<double> plus = walk(context, 1), minus = walk(context, -1);
  std::array<grainlaw_context*, 4> contexts{};
  for (auto& one : contexts) ASSERT_EQ(grainlaw_context_create(law, &one), GRAINLAW_OK);
  grainlaw_law_destroy(law);  // contexts keep what they need
  law = nullptr;
  std::array<std::vector<double>, 4> ends;
  {
    std::vector<std::jthread> threads;
    for (std::size_t i = 0; i < 4; ++i)
      threads.emplace_back([&, i] { ends[i] = walk(contexts[i], i % 2 == 0 ? 1 : -1); });
  }
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(ends[i], i % 2 == 0 ? plus : minus);
  for (auto* one : contexts) grainlaw_context_destroy(one);
}

TEST_F(CInterface, AFailedIncrementIsReplayed) {
  make_failing();
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "grainlaw-replay-test.json";
  std::filesystem::remove(file);
  ASSERT_EQ(grainlaw_context_replay_file(context, file.c_str()), GRAINLAW_OK);
  ASSERT_EQ(update(d2_step), GRAINLAW_OK);
  EXPECT_FALSE(std::filesystem::exists(file));
  stress = untouched;
  const std::vector<double> before = state;
  expect_refused(update({-0.1, 0.2, 0.05, 0, 0, 0}, tangent.data()), GRAINLAW_FAILED, "s_max is -0.0",
                 before);
  const std::string why = said();
  const Replay kept = Replay::load(file);
  EXPECT_EQ(kept.message, why);
  EXPECT_EQ(kept.status, "failed");
  EXPECT_EQ(kept.version, version());
  EXPECT_TRUE(kept.tangent);
  EXPECT_EQ(kept.state.point.P, entry("P"));
  EXPECT_EQ(kept.state.point.direction.S_I, entry("S_I"));
  EXPECT_EQ(kept.to_json(), Replay::read(Reader(kept.to_json(), "again")).to_json());
  const Replayed now = replay(kept);
  EXPECT_EQ(now.status.code, Status::Code::failed);
  EXPECT_EQ(now.status.message, why);
  EXPECT_EQ(now.state.point.P, entry("P"));

  EXPECT_EQ(update({0, 0, 0, 1e-3, 0, 0}), GRAINLAW_NOT_COAXIAL);  // takes its place
  EXPECT_EQ(replay(Replay::load(file)).status.code, Status::Code::not_coaxial);
  ASSERT_EQ(grainlaw_context_replay_file(context, nullptr), GRAINLAW_OK);
  std::filesystem::remove(file);
  EXPECT_EQ(update({0, 0, 0, 1e-3, 0, 0}), GRAINLAW_NOT_COAXIAL);
  EXPECT_FALSE(std::filesystem::exists(file));
  ASSERT_EQ(grainlaw_context_replay_file(context, "/no/such/folder/replay.json"), GRAINLAW_OK);
  EXPECT_EQ(update({0, 0, 0, 1e-3, 0, 0}), GRAINLAW_NOT_COAXIAL);
  EXPECT_THAT(said(), HasSubstr("; /no/such/folder/replay.json: cannot be written"));
}

}  // namespace
}  // namespace grainlaw::model
