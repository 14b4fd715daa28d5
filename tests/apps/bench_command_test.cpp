// grainlaw bench dem from beginning to end with few grains: what it leaves on disk, going on, and bad input.
#include <gmock/gmock.h>

#include "grainlaw/element/json.hpp"
#include "program.hpp"

namespace grainlaw::apps {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

class BenchCommand : public Program {
 protected:
  const Arguments tiny{"bench", "dem",       "--count", "32",   "--knob", "time_step", "--seeds",
                       "1",     "--eps-dev", "0.001",   "--nu", "0.7499", "-o",        "b"};
};

TEST_F(BenchCommand, WritesTablePictureAndPageAndGoesOn) {
  const Outcome first = run(tiny);
  ASSERT_EQ(first.status, 0) << first.err;
  EXPECT_THAT(first.out, HasSubstr("cheapest setting for a wanted error of means over many tests"));
  EXPECT_THAT(first.out, Not(HasSubstr("of one test")));  // there is one
  const Json result = load_json(folder / "b/speed-against-error.json");
  EXPECT_EQ(result.at("errors").size(), 5u * (2 + 4));  // values times quantities of ISO and of D2
  for (const Json& entry : result.at("errors")) {
    EXPECT_GT(entry.at("particle_steps").get<double>(), 0);
    EXPECT_GT(entry.at("core_s").get<double>(), 0);
    if (entry.at("quantity") == "P") {
      EXPECT_GT(entry.at("scatter").get<double>(), 0);  // twins grow apart
    }
    EXPECT_LT(entry.at("scatter").get<double>(), 0.5);
  }
  EXPECT_THAT(read("b/speed-against-error.csv"), HasSubstr("time_step,200,d2,F_dev,2,"));
  EXPECT_THAT(read("b/speed-against-error.svg"), HasSubstr("seconds of a core"));
  EXPECT_THAT(read("b/steps-against-error.svg"), HasSubstr("particle-steps of a run"));
  EXPECT_THAT(read("b/report.html"), HasSubstr("</html>"));
  const std::string csv = read("b/speed-against-error.csv");
  fs::remove_all(folder / "b/records/d2-n32-step5-rate1-s1-t1");
  Arguments again = tiny;
  again.push_back("--resume");
  const Outcome second = run(again);
  ASSERT_EQ(second.status, 0) << second.err;
  // The same but for the time that the one run took.
  const auto errors = load_json(folder / "b/speed-against-error.json").at("errors");
  for (std::size_t i = 0; i < errors.size(); ++i)
    EXPECT_EQ(errors[i].value("error", 0.0), result.at("errors")[i].value("error", 0.0));
  EXPECT_TRUE(refuses(run(tiny), {"holds this bench already", "--resume"}));
  again[3] = "33";
  EXPECT_TRUE(refuses(run(again), {"another bench", "count"}));
}

TEST_F(BenchCommand, SeveralPackingsTellWhatOneTestIsWorth) {
  Arguments two = tiny;
  two[7] = "2";
  const Outcome outcome = run(two);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("cheapest setting for a wanted error of one test"));
  EXPECT_THAT(outcome.out, HasSubstr("of means over many tests"));
  const Json result = load_json(folder / "b/speed-against-error.json");
  for (const Json& entry : result.at("errors"))
    EXPECT_GT(entry.at("packings").get<double>(), entry.at("scatter").get<double>());
  EXPECT_THAT(read("b/speed-against-error.svg"), HasSubstr("rgb(119, 119, 119)"));
}

TEST_F(BenchCommand, ModelWritesItsTableAndPicture) {
  const Outcome outcome =
      run({"bench", "model", "--seconds", "1e-9", "--points", "64", "--threads", "2", "-o", "m"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("bytes"));
  const std::string csv = read("m/model-speed.csv");
  for (const char* part :
       {"path,\"monotonic\",CVODE BDF,1e-06", "path,\"cycles\",light,", "path,\"jamming\",RODAS,",
        "increment,\"D2 cycle\",CVODE Adams,", "batch,\"at rest\",light,1e-06,64,2,",
        "term,\"coupled, tangent, volume at rest\",", "term,\"memory, volume moving\",",
        "term,\"coupled+constant_F_v, volume moving\",", "sensitivities",
        "host,\"grainlaw_update_many\",light,1e-06,512,2,"})
    EXPECT_THAT(csv, HasSubstr(part));
  EXPECT_THAT(read("m/model-speed.svg"), HasSubstr("</svg>"));
  EXPECT_GE(load_json(folder / "m/model-speed.json").at("state_bytes").get<int>(), 14 * 8 - 7);
}

TEST_F(BenchCommand, SaysWhatIsWrong) {
  EXPECT_TRUE(refuses(run({"bench", "model", "--threads", "0"}), {"--threads", "0"}));
  EXPECT_TRUE(refuses(run({"bench", "model", "nowhere.json"}), {"nowhere.json"}));
  EXPECT_TRUE(refuses(run({"bench", "dem", "--knob", "speed"}), {"--knob", "time_step", "speed"}));
  EXPECT_TRUE(refuses(run({"bench", "dem", "--count", "7"}), {"--count", "7"}));
  EXPECT_TRUE(refuses(run({"bench", "dem", "--nu", "0.8"}), {"--nu", "0.8"}));
  EXPECT_TRUE(refuses(run({"bench"}), {"bench"}));
  fs::create_directory(folder / "full");
  write("full/other", "x");
  EXPECT_TRUE(refuses(run({"bench", "dem", "-o", "full"}), {"full", "not empty"}));
}

}  // namespace
}  // namespace grainlaw::apps
