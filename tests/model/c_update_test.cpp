// The C interface walks: one point and many, on threads with a context each, and what failed is replayed.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <thread>
#include <vector>

#include "c_interface_fixture.hpp"
#include "grainlaw/element/version.hpp"
#include "grainlaw/model/c/replay.hpp"

namespace grainlaw::model {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class CUpdate : public CInterface {};

TEST_F(CUpdate, AZeroIncrementLeavesThePointAndHasATangent) {
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

TEST_F(CUpdate, Unjammed) {
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

TEST_F(CUpdate, TensionPositiveHosts) {
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
  static constexpr std::size_t count = 101, stride = 23;
  std::vector<double> states = std::vector<double>(count * stride, 13.0), strains, stresses, tangents;
  std::vector<int> statuses = std::vector<int>(count, 99);
  grainlaw_outcome outcome{99, 99, 99};

  explicit Field(grainlaw_context* context) : stresses(6 * count, 7.0), tangents(36 * count) {
    const std::array names{"nu", "phi_J"};
    for (std::size_t i = 0; i < count; ++i) {
      const std::array values{0.66 + 0.001 * static_cast<double>(i), i % 3 == 0 ? 0.66 : 0.665};
      EXPECT_GE(grainlaw_start(context, 2, names.data(), values.data(), &states[i * stride], 23), 0);
      const double e = 1e-4 * (1 + static_cast<double>(i % 7));
      strains.insert(strains.end(), {1e-5 - e, 1e-5 + e, 1e-5, 0, 0, 0});
    }
  }
  int update(grainlaw_context* context, int threads, bool slopes = true) {
    return grainlaw_update_many(context, count, states.data(), stride, strains.data(), stresses.data(),
                                slopes ? tangents.data() : nullptr, threads, statuses.data(), &outcome);
  }
};

TEST_F(CUpdate, ManyPointsAsOneByOne) {
  for (const int threads : {1, 3, 200})
    for (const bool slopes : {false, true}) {
      Field field(context), alone(context);
      EXPECT_EQ(field.update(context, threads, slopes), GRAINLAW_UNJAMMED);  // the loosest points
      EXPECT_EQ(field.outcome.failed, 0U);
      std::size_t unjammed = 0;
      for (std::size_t i = 0; i < Field::count; ++i) {
        const int status =
            grainlaw_update(context, &alone.states[i * Field::stride], 23, &alone.strains[6 * i],
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

/// Of one history they go through lanes, where the tolerance lets increments of this size be one step: within
/// the tolerance of one by one, and the same to the last bit on any number of threads.
TEST_F(CUpdate, ManyPointsOfOneHistory) {
  settings.rtol = 1e-6;
  settings.atol = 1e-9;
  make(thesis().to_json().dump());
  constexpr std::size_t count = 1000, stride = 25;
  std::vector<double> begin(count * stride, 13.0), strains;
  for (std::size_t i = 0; i < count; ++i) {
    const char* name = "nu";
    const double nu = 0.66 + 0.0001 * static_cast<double>(i), e = 1e-4 * (1 + static_cast<double>(i % 7));
    ASSERT_GE(grainlaw_start(context, 1, &name, &nu, &begin[i * stride], 23), 0);
    strains.insert(strains.end(), {1e-5 - e, 1e-5 + e, 1e-5, 0, 0, 0});
  }
  const auto walked = [&](int threads) {
    std::vector<double> states = begin, stresses(6 * count);
    std::vector<int> statuses(count);
    grainlaw_outcome outcome{};
    for (int step = 0; step < 10; ++step) {
      if (step == 7)
        for (double& e : strains) e = -e;  // a reversal
      EXPECT_EQ(grainlaw_update_many(context, count, states.data(), stride, strains.data(), stresses.data(),
                                     nullptr, threads, statuses.data(), &outcome),
                GRAINLAW_UNJAMMED);
      EXPECT_EQ(outcome.failed, 0U);
      EXPECT_EQ(outcome.unjammed,
                static_cast<std::size_t>(std::count(statuses.begin(), statuses.end(), GRAINLAW_UNJAMMED)));
    }
    for (double& e : strains) e = -e;
    states.insert(states.end(), stresses.begin(), stresses.end());
    return states;
  };
  const std::vector<double> one = walked(1), several = walked(3);
  EXPECT_EQ(one, several);
  std::vector<double> alone = begin;
  Six there{};
  std::size_t differ = 0;  // in rounding or in method: to the last bit, nothing has gone through lanes
  for (std::size_t i = 0; i < count; ++i) {
    for (int step = 0; step < 10; ++step) {
      Six e;
      for (std::size_t k = 0; k < 6; ++k) e[k] = (step < 7 ? 1 : -1) * strains[6 * i + k];
      EXPECT_GE(grainlaw_update(context, &alone[i * stride], 23, e.data(), there.data(), nullptr), 0);
    }
    for (std::size_t k = 0; k < 23; ++k)
      EXPECT_NEAR(one[i * stride + k], alone[i * stride + k], k == 5 ? INFINITY : 1e-7)
          << i << " entry " << k;
    differ += one[i * stride + 3] != alone[i * stride + 3] ? 1 : 0;
    EXPECT_EQ(one[i * stride + 23], 13) << "what lies between states is the caller's";
    EXPECT_NEAR(one[count * stride + 6 * i], there[0], 1e-7);
  }
  EXPECT_GT(differ, 0U);
}

TEST_F(CUpdate, ManyPointsNameTheFirstThatFails) {
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
      EXPECT_TRUE(std::equal(&field.states[i * Field::stride], &field.states[i * Field::stride] + 23,
                             &before.states[i * Field::stride]));
      EXPECT_EQ(field.stresses[6 * i], 7);
    }
    EXPECT_NE(field.states[43 * Field::stride + 8], before.states[43 * Field::stride + 8]);
  }
}

TEST_F(CUpdate, ManyPointsBadArguments) {
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
  refused(call(nullptr, 23, e, to, 1), "states: must not be NULL");
  refused(call(s, 23, nullptr, to, 1), "strain_increments: must not be NULL");
  refused(call(s, 23, e, nullptr, 1), "stresses: must not be NULL");
  refused(call(s, 22, e, to, 1), "stride: must be >= grainlaw_state_length() = 23, got 22");
  refused(call(s, 23, e, to, 0), "threads: must be >= 1, got 0");
  EXPECT_EQ(grainlaw_update_many(context, 0, s, 23, e, to, nullptr, 2, nullptr, nullptr), GRAINLAW_OK);
}

TEST_F(CUpdate, AContextPerThreadAndOneLaw) {
  const auto walk = [this](grainlaw_context* own, double sign) {
    std::vector<double> point(23);
    Six there{};
    std::array<double, 36> slopes{};
    const char* name = "nu";
    const double nu = 0.7 + 0.01 * sign;
    EXPECT_EQ(grainlaw_start(own, 1, &name, &nu, point.data(), 23), GRAINLAW_OK);
    for (int i = 0; i < 3000; ++i) {
      const double e = (i % 300 < 200 ? sign : -sign) * 1e-4;
      const Six along{-e, e, 0, 0, 0, 0}, off{0, 0, 0, 0, 0, e};
      EXPECT_EQ(grainlaw_update(own, point.data(), 23, off.data(), there.data(), nullptr),
                GRAINLAW_NOT_COAXIAL);
      EXPECT_EQ(
          grainlaw_update(own, point.data(), 23, along.data(), there.data(), i % 2 ? slopes.data() : nullptr),
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

TEST_F(CUpdate, AFailedIncrementIsReplayed) {
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
