// grainlaw calibrate from beginning to end on a tiny campaign: what it leaves on disk, interruption by SIGINT
// and SIGKILL, resuming, two at once, records that were spoilt, and that tests of role predict feed no
// parameter.
#include <gmock/gmock.h>
#include <signal.h>

#include <algorithm>
#include <set>
#include <string>

#include "grainlaw/dem/files/archive.hpp"
#include "grainlaw/dem/numbers/simd.hpp"
#include "grainlaw/element/file.hpp"
#include "grainlaw/element/json.hpp"
#include "program.hpp"

namespace grainlaw::apps {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// The tiny campaign with one seed: half the work.
std::string one_seed() {
  std::string text = tiny_campaign();
  return text.replace(text.find("[1, 2]"), 6, "[1]");
}

class Calibrate : public Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    write("c.json", one_seed());
  }

  bool has(const std::string& name) const { return fs::exists(folder / name); }
  /// The finished records below `dir`.
  std::vector<std::string> records(const std::string& dir) const {
    std::vector<std::string> names;
    if (!has(dir + "/records")) return names;
    for (const auto& entry : fs::directory_iterator(folder / dir / "records"))
      if (entry.path().extension() != ".part") names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
  }
  Json json(const std::string& name) const { return load_json(folder / name); }

  /// Starts the campaign into `dir` one test at a time and waits until the first record is there.
  std::unique_ptr<Running> start(const std::string& dir) {
    auto running =
        std::make_unique<Running>(folder, Arguments{"calibrate", "c.json", "-o", dir, "--jobs", "1"});
    EXPECT_TRUE(eventually([&] { return !records(dir).empty() || running->ended(); }));
    return running;
  }

  /// Goes on with an interrupted campaign and compares it with one that was left alone.
  void resume_and_compare(const std::string& dir) {
    const auto kept = records(dir);
    ASSERT_FALSE(kept.empty());
    std::vector<std::string> provenance;
    for (const auto& name : kept) provenance.push_back(read(dir + "/records/" + name + "/provenance.json"));
    const auto written = fs::last_write_time(folder / dir / "records" / kept.front() / "record.csv");
    const Outcome again = run({"calibrate", "c.json", "-o", dir, "--resume"});
    ASSERT_EQ(again.status, 0) << again.err;
    EXPECT_THAT(again.out, HasSubstr("kept " + std::to_string(kept.size()) + " from before"));
    for (std::size_t i = 0; i < kept.size(); ++i)
      EXPECT_EQ(read(dir + "/records/" + kept[i] + "/provenance.json"), provenance[i]);
    EXPECT_EQ(fs::last_write_time(folder / dir / "records" / kept.front() / "record.csv"), written);
    ASSERT_EQ(run({"calibrate", "c.json", "-o", "whole"}).status, 0);
    ASSERT_EQ(records(dir), records("whole"));
    for (const auto& name : records("whole"))
      EXPECT_EQ(read(dir + "/records/" + name + "/record.csv"), read("whole/records/" + name + "/record.csv"))
          << name;
    EXPECT_EQ(read(dir + "/records/d2-0.7-s1/moduli.csv"), read("whole/records/d2-0.7-s1/moduli.csv"));
    EXPECT_EQ(read(dir + "/parameters.json"), read("whole/parameters.json"));
    for (const auto& name : listing(dir)) EXPECT_EQ(name.find(".part"), std::string::npos) << name;
  }
};

TEST_F(Calibrate, LeavesRecordsParametersPredictionsAndAReport) {
  write("c.json", tiny_campaign());
  const Outcome outcome = run({"calibrate", "c.json", "--jobs", "2"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(records("out/tiny").size(), 10u);
  for (const char* name :
       {"campaign.json", "parameters.json", "fits.json", "predictions.json", "timing.json", "report.html"})
    EXPECT_TRUE(has(std::string("out/tiny/") + name)) << name;
  EXPECT_FALSE(has("out/tiny/.lock"));
  // Only tests of role predict are predicted, in every form.
  const Json predictions = json("out/tiny/predictions.json").at("predictions");
  std::set<std::string> forms;
  for (const Json& one : predictions) forms.insert(one.at("form").get<std::string>());
  EXPECT_EQ(predictions.size(), 2 * forms.size());
  for (const char* form : {"reduced_closed", "reduced", "coupled", "memory+volumetric"})
    EXPECT_TRUE(forms.contains(form)) << form;
  // Whether the tiny campaign tells the numbers of `energy`, too, is a matter of chance.
  EXPECT_TRUE(forms.contains("coupled+volumetric") || forms.contains("coupled+energy+volumetric"));
  for (const Json& one : predictions)
    EXPECT_TRUE(one.at("test").get<std::string>().starts_with("uni-0.695-s")) << one;
  // Time of every stage and speed of every test.
  const Json timing = json("out/tiny/timing.json");
  std::vector<std::string> stages;
  for (const Json& stage : timing.at("stages")) {
    stages.push_back(stage.at("name"));
    EXPECT_GT(stage.at("wall_s").get<double>(), 0);
  }
  EXPECT_THAT(stages, testing::ElementsAre("simulate", "fit", "predict", "report"));
  EXPECT_EQ(timing.at("tests").size(), 10u);
  // The end of the output: parameters beside the thesis's, errors of predictions, where the report is.
  for (const char* part : {"prediction of", "uni-0.695        coupled", "report: out/tiny/report.html"})
    EXPECT_THAT(outcome.out, HasSubstr(part));
  // Which parameters so small a campaign determines is a matter of chance: it differs between instruction
  // sets.
  int fitted = 0;
  const Json laws = json("out/tiny/parameters.json").at("isotropic");
  for (const auto& [mode, law] : laws.items())
    for (const auto& [name, parameter] : law.items()) {
      if (parameter.at("source") != "fit") continue;
      ++fitted;
      const std::string number = " +[0-9.e-]+";
      EXPECT_THAT(outcome.out, testing::ContainsRegex("\nisotropic\\." + mode + "\\." + name + number +
                                                      number + number + "\n"));
    }
  EXPECT_GT(fitted, 0);
  // Moduli are measured: what so few states do not determine is assumed, and said so.
  EXPECT_TRUE(has("out/tiny/records/d2-0.74-s1/moduli.csv"));
  const Json moduli = json("out/tiny/parameters.json").at("moduli");
  for (const auto& [name, parameter] : moduli.items()) {
    EXPECT_NE(parameter.at("source"), "thesis") << name;
    if (parameter.at("source") == "assumed") {
      EXPECT_NE(parameter.at("note"), "") << name;
    }
  }
}

TEST_F(Calibrate, SIGINTKeepsWhatIsFinishedAndSaysHowToGoOn) {
  const auto running = start("out/a");
  running->send(SIGINT);
  const Outcome outcome = running->wait();
  EXPECT_EQ(outcome.status, 130);
  EXPECT_THAT(outcome.err, HasSubstr("grainlaw calibrate c.json -o out/a --jobs 1 --resume"));
  EXPECT_LT(records("out/a").size(), 5u);
  // The test that was under way goes on from a checkpoint.
  for (const auto& entry : fs::directory_iterator(folder / "out/a/records"))
    EXPECT_TRUE(entry.path().extension() != ".part" || fs::exists(entry.path() / "checkpoint.bin")) << entry;
  resume_and_compare("out/a");
}

TEST_F(Calibrate, SIGKILLLosesNothingThatIsFinished) {
  const auto running = start("out/a");
  running->send(SIGKILL);
  EXPECT_EQ(running->wait().status, 128 + SIGKILL);
  EXPECT_LT(records("out/a").size(), 5u);
  resume_and_compare("out/a");
}

TEST_F(Calibrate, AnInterruptedTestGoesOnOnItsInstructionSetOnly) {
  const auto running = start("out/a");
  running->send(SIGINT);
  running->wait();
  const auto part = [&] {
    for (const auto& name : listing("out/a/records"))
      if (name.ends_with(".part/checkpoint.bin")) return name;
    return std::string();
  }();
  ASSERT_FALSE(part.empty());
  // What a machine with other instructions would have left, so that one with a single set can test it.
  const fs::path file = folder / "out/a/records" / part;
  const std::string ours = read_file(file);
  Json elsewhere = parse_json(dem::ArchiveReader(file).line(), "");
  elsewhere.at("simd") = "neon";
  {
    dem::ArchiveWriter archive(file);
    archive.line(elsewhere.dump());
    archive.finish();
  }
  const Outcome other = run({"calibrate", "c.json", "-o", "out/a", "--resume"});
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(other.err, HasSubstr("out/a/records/" + part + ": simd: the test ran on neon, this run is on " +
                                   dem::simd_target()));
  write_file(file, ours);
  resume_and_compare((folder / "out/a").string());  // the same folder by another name
}

TEST_F(Calibrate, TwoInOneFolderAreRefused) {
  const auto running = start("out/a");
  EXPECT_TRUE(refuses(run({"calibrate", "c.json", "-o", "out/a", "--resume"}),
                      {"out/a: is in use by another grainlaw (process "}));
  running->send(SIGTERM);
  EXPECT_EQ(running->wait().status, 130);
}

TEST_F(Calibrate, AnotherCampaignIsRefusedAndLeftAsItIs) {
  const auto running = start("out/a");
  running->send(SIGINT);
  running->wait();
  const auto before = listing("out/a");
  const std::string campaign = read("out/a/campaign.json");
  EXPECT_TRUE(refuses(run({"calibrate", "c.json", "-o", "out/a"}),
                      {"out/a: holds this campaign already; go on with --resume"}));
  std::string other = one_seed();
  write("d.json", other.replace(other.find("64"), 2, "65"));
  for (const bool resume : {false, true}) {
    Arguments arguments{"calibrate", "d.json", "-o", "out/a"};
    if (resume) arguments.push_back("--resume");
    EXPECT_TRUE(
        refuses(run(arguments),
                {"out/a: holds another campaign than d.json (preparation.count: 64 there, 65 here)"}));
  }
  EXPECT_EQ(listing("out/a"), before);
  EXPECT_EQ(read("out/a/campaign.json"), campaign);
  // Without a campaign, --resume goes on with the one in the folder.
  EXPECT_EQ(run({"calibrate", "-o", "out/a", "--resume"}).status, 0);
}

TEST_F(Calibrate, AFailedTestSkipsItsDependentsAndTheRestGoesOn) {
  // Grains that cross the box in every step: sooner or later two meet at one point.
  std::string text = one_seed();
  const std::string impossible =
      R"({"name": "torn", "role": "predict", "measure": {"rows": 1}, "path": {"segments": [
      {"repeat": 1000, "segments": [{"mode": "simple_shear", "amount": 100, "rate": 50}]}]}},
      {"name": "after", "role": "fit", "from": {"test": "torn"}, "path": {"segments": [{"mode": "iso", "amount": 0.01}]}},)";
  text.insert(text.find('[', text.find("\"tests\"")) + 1, impossible);
  write("c.json", text);
  const Outcome outcome = run({"calibrate", "c.json", "-o", "out/a"});
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("failed: torn-s1: "));
  EXPECT_THAT(outcome.err, HasSubstr("skipped, because they start from torn-s1: after-s1"));
  EXPECT_EQ(records("out/a").size(), 5u);
  EXPECT_TRUE(has("out/a/report.html"));
  const Json failure = json("out/a/failures.json").at("failures").at(0);
  EXPECT_EQ(failure.at("record"), "torn-s1");
  EXPECT_EQ(failure.at("skipped"), Json::array({"after-s1"}));
}

TEST_F(Calibrate, WhereEveryTestFailsThereIsNothingToFit) {
  write(
      "c.json",
      R"({"name": "c", "preparation": {"count": 64, "nu": 0.7, "rate": 2e-3}, "measure": {"rows": 1}, "seeds": [1], "tests": [{"name": "torn", "role": "predict",
      "path": {"segments": [{"repeat": 1000, "segments": [{"mode": "simple_shear", "amount": 100, "rate": 50}]}]}}]})");
  const Outcome outcome = run({"calibrate", "c.json", "-o", "out/a"});
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("1 of the tests failed, see out/a/failures.json"));
  EXPECT_FALSE(has("out/a/parameters.json"));
}

TEST_F(Calibrate, ABoxTooNarrowIsRefusedBeforeAnyWork) {
  std::string text = one_seed();
  text.insert(text.find('[', text.find("\"tests\"")) + 1,
              R"({"name": "flat", "role": "fit", "path": {"segments": [
      {"mode": "components", "strain": [1.4, -1.4, 0]}]}},)");
  write("c.json", text);
  EXPECT_TRUE(
      refuses(run({"calibrate", "c.json", "-o", "out/a"}),
              {"c.json: tests[0].path.segments[0]: makes the box", "take more grains or less strain"}));
  EXPECT_FALSE(has("out/a"));
}

TEST_F(Calibrate, AFullDiskEndsItAndResumeGoesOn) {
  const Outcome outcome = run({"calibrate", "c.json", "-o", "out/a", "--jobs", "1"}, {"", 40'000});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, testing::EndsWith("cannot be written: File too large\n"));
  EXPECT_THAT(outcome.err, HasSubstr("out/a/records/iso-s1.part/"));
  EXPECT_THAT(records("out/a"), testing::IsEmpty());
  EXPECT_EQ(run({"calibrate", "c.json", "-o", "out/a", "--resume"}).status, 0);
}

TEST_F(Calibrate, SpoiltRecordsAreNamed) {
  ASSERT_EQ(run({"calibrate", "c.json", "-o", "out/a"}).status, 0);
  const std::string record = "out/a/records/d2-0.7-s1/record.csv", good = read(record);
  const auto spoil = [&](std::size_t from, std::size_t length, const std::string& by) {
    write(record, std::string(good).replace(from, length, by));
  };
  const std::size_t second_line = good.find('\n') + 1;
  const std::size_t second_comma = good.find(',', good.find(',', second_line) + 1);  // behind eps_vol
  const std::string parameters = read("out/a/parameters.json");
  for (const char* value : {"nan", "inf", "-inf", "abc", "1e999"}) {
    spoil(second_comma + 1, 0, value);
    EXPECT_TRUE(refuses(run({"fit", "out/a"}),
                        {record + ": eps_dev: line 2: must be a finite number or empty, got \"" + value}))
        << value;
  }
  spoil(good.find(",s_dev,"), 7, ",s,");
  EXPECT_TRUE(refuses(run({"fit", "out/a"}), {record + ": s_dev: column is missing"}));
  for (const std::size_t cut : {1, 5, 20, 1000}) {
    spoil(good.size() - cut, cut, "");
    EXPECT_TRUE(refuses(run({"fit", "out/a"}), {record + ": is cut short"})) << cut;
  }
  write(record, "");
  EXPECT_TRUE(refuses(run({"fit", "out/a"}), {record + ": is empty"}));
  EXPECT_EQ(read("out/a/parameters.json"), parameters);  // not touched by a fit that failed
}

TEST_F(Calibrate, RecordsOfRolePredictChangeNoDigit) {
  ASSERT_EQ(run({"calibrate", "c.json", "-o", "out/a"}).status, 0);
  ASSERT_EQ(run({"fit", "out/a", "-o", "with.json"}).status, 0);
  const auto predict = [&](const std::string& parameters) {
    const Outcome outcome = run({"predict", parameters, "data/paths/uni.json", "--form", "reduced"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.out;
  };
  const std::string with = predict("with.json");
  EXPECT_EQ(read("with.json"), read("out/a/parameters.json"));
  ASSERT_GT(fs::remove_all(folder / "out/a/records/uni-0.695-s1"), 0u);
  ASSERT_EQ(run({"fit", "out/a", "-o", "without.json"}).status, 0);
  EXPECT_EQ(read("without.json"), read("with.json"));
  EXPECT_EQ(predict("without.json"), with);
  // The proof of the proof: a record of role fit does change them.
  ASSERT_GT(fs::remove_all(folder / "out/a/records/d2-0.7-s1"), 0u);
  ASSERT_EQ(run({"fit", "out/a", "-o", "less.json"}).status, 0);
  EXPECT_NE(read("less.json"), read("with.json"));
}

}  // namespace
}  // namespace grainlaw::apps
