// grainlaw replay: what a file that a host left says, and that it says the same again.
#include <gmock/gmock.h>

#include "grainlaw/element/json.hpp"
#include "grainlaw/model/c/replay.hpp"
#include "program.hpp"

namespace grainlaw::apps {
namespace {

using testing::HasSubstr;

class Replay : public Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    const auto parameters = model::ParameterSet::load(folder / "data/thesis/parameters.json");
    kept.parameters = parameters;
    kept.settings.axis = {-1, 1, 0, 0, 0, 0};
    kept.state = model::CoaxialLaw(parameters, kept.settings).start(Start{0.711, {}, {}, {}, {}, {}}).state;
    kept.increment = {0, 0, 1e-3, 0, 0, 0};
    kept.status = "not_coaxial";
    kept.message = "the strain increment is not coaxial";
    kept.version = "0.0.7";
    kept.commit = "abc";
  }
  Outcome replayed() {
    write("failed.json", kept.to_json().dump());
    return run({"replay", "failed.json"});
  }
  model::Replay kept;
};

TEST_F(Replay, SaysWhatHappenedThenAndNow) {
  const Outcome outcome = replayed();
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.out, HasSubstr("written by grainlaw 0.0.7 (abc)"));
  EXPECT_THAT(outcome.out, HasSubstr("then  not_coaxial: the strain increment is not coaxial\n"));
  EXPECT_THAT(outcome.out, HasSubstr("now   not_coaxial: the strain increment is not coaxial with the axis"));
  EXPECT_THAT(outcome.out, HasSubstr("nu           0.711                    0.711\n"));
}

TEST_F(Replay, AnIncrementThatIsWellNow) {
  kept.increment = {-1e-3, 1e-3, 0, 0, 0, 0};
  const Outcome outcome = replayed();
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out, HasSubstr("now   ok\n"));
  EXPECT_THAT(outcome.out, testing::ContainsRegex("eps_dev      0 +0.0017320508"));
  EXPECT_THAT(outcome.out, HasSubstr("stress yy 0.02"));
}

TEST_F(Replay, BadInput) {
  EXPECT_TRUE(refuses(run({"replay", "no.json"}), {"no.json: no such file"}));
  const auto refused = [&](const char* pointer, const Json& value, const std::vector<std::string>& parts) {
    Json json = kept.to_json();
    json[Json::json_pointer(pointer)] = value;
    write("failed.json", json.dump());
    return refuses(run({"replay", "failed.json"}), parts);
  };
  EXPECT_TRUE(
      refused("/format", "grainlaw-replay-2", {"failed.json: format: must be one of grainlaw-replay-1"}));
  EXPECT_TRUE(refused("/form", "couple", {"failed.json: form: must be one of"}));
  EXPECT_TRUE(refused("/form", "coupled+energy", {"moduli", "a_F"}));
  EXPECT_TRUE(refused("/axis", Json{1, 1, 1, 0, 0, 0}, {"axis: must have a deviator"}));
  EXPECT_TRUE(refused("/axis", Json{1, 0, 0}, {"failed.json: axis"}));
  EXPECT_TRUE(refused("/rtol", 0, {"failed.json: rtol: must be > 0"}));
  EXPECT_TRUE(refused("/state/P", -1, {"failed.json: state.P: must be > 0 where jammed, got -1"}));
  EXPECT_TRUE(refused("/state/p", 1, {"failed.json: state.p: unknown key"}));
  EXPECT_TRUE(refused("/state/nu", nullptr, {"failed.json: state.nu"}));
  EXPECT_TRUE(refused("/strain_increment/0", nullptr, {"failed.json: strain_increment"}));
  EXPECT_TRUE(refused("/steps", 1, {"failed.json: steps: unknown key"}));
  EXPECT_TRUE(refused("/parameters/name", 3, {"failed.json: parameters.name"}));
}

}  // namespace
}  // namespace grainlaw::apps
