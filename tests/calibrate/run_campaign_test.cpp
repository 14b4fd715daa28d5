// Running a campaign with tests that are made up: order, failures, interruption, resuming, full disks, and a
// folder that is another's.
#include "grainlaw/calibrate/run_campaign.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <functional>
#include <map>
#include <mutex>
#include <thread>

#include "campaign_examples.hpp"
#include "grainlaw/calibrate/kept_record.hpp"
#include "grainlaw/dem/files/snapshot.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/element/file.hpp"
#include "grainlaw/element/record.hpp"

namespace grainlaw::calibrate {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::UnorderedElementsAre;

class RunCampaign : public testing::Test {
 protected:
  void SetUp() override {
    dir = fs::temp_directory_path() / ("grainlaw-run-campaign-" + std::to_string(::getpid()));
    fs::remove_all(dir);
  }
  void TearDown() override { fs::remove_all(dir); }

  /// A test that writes a record at once, and notes that it ran.
  dem::RunSummary write_record(const dem::Scene& scene, const fs::path& part) {
    const std::lock_guard lock(mutex);
    ran.push_back(part.stem().string());
    write_file(part / "scene.json", scene.to_json(part).dump() + "\n");
    write_file(part / "provenance.json", "{}\n");
    Record record(record_columns());
    for (std::size_t i = 0; i < scene.record_rows(); ++i)
      record.append(std::vector<double>(record_columns().size(), 0.5));
    record.write_csv(part / "record.csv");
    if (!scene.measure.snapshots.empty()) {
      const dem::State one{.box = dem::Mat3::diagonal({9, 9, 9}),
                           .position = {{1, 1, 1}},
                           .velocity = {{0, 0, 0}},
                           .radius = {1}};
      dem::SnapshotWriter(part / "snapshots.h5", one.radius).append(one, {});
    }
    return {0.01, 1000, {}, false, {}};
  }

  CampaignFolder open(CampaignFolder::Use use = CampaignFolder::Use::fresh) { return {campaign, dir, use}; }

  RunOptions options() {
    RunOptions result;
    result.workers = 2;
    result.run_test = [this](const dem::Scene& scene, const fs::path& part, const dem::RunHooks&) {
      return write_record(scene, part);
    };
    return result;
  }

  fs::path dir;
  Campaign campaign = campaign_of(with_tests(iso + "," + d2(R"({"test": "iso", "nu": [0.7, 0.75]})")));
  std::mutex mutex;
  std::vector<std::string> ran;
};

TEST_F(RunCampaign, MakesEveryRecordAfterTheOneItStartsFrom) {
  const auto result = run_campaign(campaign, open(), options());
  EXPECT_EQ(result.finished, 6u);
  EXPECT_TRUE(result.failed.empty());
  ASSERT_EQ(ran.size(), 6u);
  const auto place = [&](const std::string& name) {
    return std::find(ran.begin(), ran.end(), name) - ran.begin();
  };
  for (const std::string seed : {"s1", "s2"})
    for (const std::string test : {"d2-0.7-", "d2-0.75-"})
      EXPECT_LT(place("iso-" + seed), place(test + seed));
  EXPECT_TRUE(fs::exists(dir / "records/d2-0.75-s2/record.csv"));
  EXPECT_FALSE(fs::exists(dir / "records/d2-0.75-s2.part"));
  EXPECT_FALSE(fs::exists(dir / "failures.json"));
}

TEST_F(RunCampaign, ARecordThatWasOnlyNotNamedIsKept) {
  run_campaign(campaign, open(), options());
  fs::rename(dir / "records/iso-s1", dir / "records/iso-s1.part");
  ran.clear();
  const auto again = run_campaign(campaign, open(CampaignFolder::Use::resume), options());
  EXPECT_EQ(again.reused, 6u);
  EXPECT_TRUE(ran.empty());
  EXPECT_TRUE(fs::exists(dir / "records/iso-s1/record.csv"));
}

TEST_F(RunCampaign, ARecordThatWasCutShortIsKept) {
  auto o = options();
  o.run_test = [&](const dem::Scene& scene, const fs::path& part, const dem::RunHooks&) {
    auto summary = write_record(scene, part);
    Record few(record_columns());
    few.append(std::vector<double>(record_columns().size(), 0.5));
    few.write_csv(part / "record.csv");
    write_file(part / "provenance.json", R"({"cut_short": "the target is out of reach"})");
    return summary;
  };
  run_campaign(campaign, open(), o);
  EXPECT_EQ(run_campaign(campaign, open(CampaignFolder::Use::resume), options()).reused, 6u);
}

TEST_F(RunCampaign, ARecordThatWasCutShortHasTheRowsItSays) {
  auto o = options();
  o.run_test = [&](const dem::Scene& scene, const fs::path& part, const dem::RunHooks&) {
    auto summary = write_record(scene, part);
    Record few(record_columns());
    few.append(std::vector<double>(record_columns().size(), 0.5));
    few.write_csv(part / "record.csv");
    write_file(part / "provenance.json", R"({"cut_short": "the target is out of reach", "rows": 2})");
    return summary;
  };
  run_campaign(campaign, open(), o);
  try {
    run_campaign(campaign, open(CampaignFolder::Use::resume), options());
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("must have 2 rows, got 1"));
    EXPECT_THAT(error.what(), testing::HasSubstr("to have it made again"));
  }
}

TEST_F(RunCampaign, TestsThatStartWhereNobodyCameSayWhy) {
  auto o = options();
  o.run_test = [&](const dem::Scene& scene, const fs::path& part, const dem::RunHooks&) {
    auto summary = write_record(scene, part);
    if (part.stem() != "iso-s1") return summary;
    write_file(part / "provenance.json", R"({"cut_short": "the target is out of reach"})");
    fs::remove(part / "snapshots.h5");
    return summary;
  };
  // Again and again: what is whole is kept, and the rest is not in its way.
  for (const auto use : {CampaignFolder::Use::fresh, CampaignFolder::Use::resume}) {
    const auto result = run_campaign(campaign, open(use), o);
    ASSERT_EQ(result.failed.size(), 2u);
    for (const auto& failed : result.failed)
      EXPECT_EQ(failed.error, "starts from iso-s1, which did not get there: the target is out of reach");
    EXPECT_TRUE(fs::exists(dir / "records/d2-0.7-s2/record.csv"));
  }
}

TEST_F(RunCampaign, RunsAsManyAtATimeAsAsked) {
  auto o = options();
  std::atomic<int> now{0}, most{0};
  o.run_test = [&](const dem::Scene& scene, const fs::path& part, const dem::RunHooks&) {
    most = std::max(most.load(), ++now);
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    --now;
    return write_record(scene, part);
  };
  run_campaign(campaign, open(), o);
  EXPECT_EQ(most, 2);
}

TEST_F(RunCampaign, AFailureStopsOnlyThoseThatStartFromIt) {
  auto o = options();
  o.run_test = [&](const dem::Scene& scene, const fs::path& part, const dem::RunHooks&) {
    if (part.stem() == "iso-s1") throw Error("scene", "path", "the grains flew away");
    return write_record(scene, part);
  };
  std::vector<std::string> told;
  o.hooks.failed = [&](const FailedJob& job) { told.push_back(job.record); };
  const auto result = run_campaign(campaign, open(), o);
  EXPECT_THAT(told, ElementsAre("iso-s1"));
  ASSERT_EQ(result.failed.size(), 1u);
  EXPECT_THAT(result.failed[0].error, HasSubstr("the grains flew away"));
  EXPECT_THAT(result.failed[0].skipped, ElementsAre("d2-0.7-s1", "d2-0.75-s1"));
  EXPECT_THAT(ran, UnorderedElementsAre("iso-s2", "d2-0.7-s2", "d2-0.75-s2"));
  const Json failures = load_json(dir / "failures.json");
  EXPECT_EQ(failures.at("failures").at(0).at("record"), "iso-s1");
  // Tried again next time; then the list of failures goes.
  ran.clear();
  const auto again = run_campaign(campaign, open(CampaignFolder::Use::resume), options());
  EXPECT_EQ(again.reused, 3u);
  EXPECT_THAT(ran, UnorderedElementsAre("iso-s1", "d2-0.7-s1", "d2-0.75-s1"));
  EXPECT_FALSE(fs::exists(dir / "failures.json"));
}

TEST_F(RunCampaign, GoesOnInsideAnInterruptedTest) {
  campaign = campaign_of(R"({"name": "c", "seeds": [1],
    "preparation": {"count": 64, "rate": 1e-3, "relax": {"tolerance": 1e-3, "duration": 20}},
    "measure": {"rows": 10, "time_step": 0.2, "time_step_gas": 0.1},
    "tests": [{"name": "iso", "role": "fit", "path": {"segments": [
      {"mode": "iso", "controls": {"nu": 0.7}, "duration": 2000}]}}]})");
  std::atomic<bool> stop{false};
  std::vector<double> shares;
  auto o = options();
  o.workers = 1;
  o.hooks.stop = &stop;
  o.run_test = [&](const dem::Scene& scene, const fs::path& part, const dem::RunHooks& hooks) {
    dem::RunHooks own = hooks;
    own.progress = [&](double share, const std::string&) {
      shares.push_back(share);
      if (share < 0.5 || stop) return;
      stop = true;
      while (!hooks.stop->load()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    };
    return dem::run_element_test(scene, part, own);
  };
  EXPECT_TRUE(run_campaign(campaign, open(), o).stopped);
  EXPECT_TRUE(fs::exists(dir / "records/iso-s1.part/checkpoint.bin"));
  EXPECT_LT(shares.front(), 0.1);
  shares.clear();
  o.hooks.stop = nullptr;
  EXPECT_EQ(run_campaign(campaign, open(CampaignFolder::Use::resume), o).finished, 1u);
  ASSERT_FALSE(shares.empty());
  EXPECT_GE(shares.front(), 0.5);
  EXPECT_FALSE(fs::exists(dir / "records/iso-s1.part"));
  dem::run_element_test(dem::Scene::load(dir / "records/iso-s1/scene.json"), dir / "whole");
  EXPECT_EQ(read_file(dir / "records/iso-s1/record.csv"), read_file(dir / "whole/record.csv"));
}

TEST_F(RunCampaign, ACheckpointThatIsSpoiltIsNamedBeforeAnythingRuns) {
  open();
  fs::create_directories(dir / "records/d2-0.7-s1.part");
  write_file(dir / "records/d2-0.7-s1.part/checkpoint.bin", "rubble, but enough of it");
  try {
    run_campaign(campaign, open(CampaignFolder::Use::resume), options());
    FAIL() << "not refused";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("d2-0.7-s1.part/checkpoint.bin: is cut short or damaged"));
    EXPECT_THAT(error.what(), HasSubstr("remove " + (dir / "records/d2-0.7-s1.part").string()));
  }
  EXPECT_TRUE(ran.empty());
}

TEST_F(RunCampaign, StopsWhenToldAndGoesOnLater) {
  std::atomic<bool> stop{false};
  auto o = options();
  o.hooks.stop = &stop;
  o.run_test = [&](const dem::Scene& scene, const fs::path& part, const dem::RunHooks& hooks) {
    if (!part.stem().string().starts_with("iso")) {
      stop = true;
      while (!hooks.stop->load()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      return dem::RunSummary{0, 0, {}, true, {}};
    }
    return write_record(scene, part);
  };
  const auto result = run_campaign(campaign, open(), o);
  EXPECT_TRUE(result.stopped);
  EXPECT_LE(result.finished, 2u);
  for (const auto& entry : fs::directory_iterator(dir / "records"))
    EXPECT_NE(entry.path().extension(), ".part");
  const std::size_t kept = result.finished;
  ran.clear();
  fs::create_directories(dir / "records/d2-0.7-s1.part/rubble");  // as a killed run leaves it
  const auto again = run_campaign(campaign, open(CampaignFolder::Use::resume), options());
  EXPECT_EQ(again.reused, kept);
  EXPECT_EQ(again.finished, 6 - kept);
  EXPECT_FALSE(fs::exists(dir / "records/d2-0.7-s1/rubble"));
}

TEST_F(RunCampaign, AFullDiskEndsTheCampaign) {
  auto o = options();
  o.run_test = [&](const dem::Scene& scene, const fs::path& part, const dem::RunHooks&) -> dem::RunSummary {
    if (part.stem() == "iso-s1")
      throw Error::cannot_write((part / "record.csv").string(), "No space left on device");
    return write_record(scene, part);
  };
  try {
    run_campaign(campaign, open(), o);
    FAIL() << "a full disk went unseen";
  } catch (const Error& error) {
    EXPECT_TRUE(error.unwritable());
    EXPECT_THAT(error.what(), HasSubstr("No space left"));
  }
  EXPECT_FALSE(fs::exists(dir / "records/iso-s1.part"));
}

TEST_F(RunCampaign, TellsHowFarItIs) {
  auto o = options();
  o.workers = 1;
  double fraction = 0;
  std::size_t finished = 0;
  o.hooks.finished = [&](const FinishedJob& job, const CampaignProgress& now) {
    EXPECT_GT(now.fraction, fraction);
    fraction = now.fraction;
    EXPECT_EQ(now.finished, ++finished);
    EXPECT_EQ(now.jobs, 6u);
    EXPECT_EQ(job.summary.particle_steps, 1000u);
  };
  run_campaign(campaign, open(), o);
  EXPECT_DOUBLE_EQ(fraction, 1);
}

TEST_F(RunCampaign, AFolderIsTakenOnlyOnce) {
  const auto first = open();
  try {
    open(CampaignFolder::Use::resume);
    FAIL() << "two in one folder";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(),
                HasSubstr("is in use by another grainlaw (process " + std::to_string(::getpid()) + ")"));
  }
}

TEST_F(RunCampaign, ALockLeftBehindLocksNothing) {
  { const auto first = open(); }
  EXPECT_FALSE(fs::exists(dir / ".lock"));
  write_file(dir / ".lock", "1");
  EXPECT_NO_THROW(open(CampaignFolder::Use::resume));
}

TEST_F(RunCampaign, AnotherCampaignIsNeverOverwritten) {
  { const auto first = open(); }
  const std::string written = read_file(dir / "campaign.json");
  const auto refusal = [&](CampaignFolder::Use use) {
    try {
      open(use);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_THAT(refusal(CampaignFolder::Use::fresh),
              HasSubstr("holds this campaign already; go on with --resume"));
  campaign.preparation.count = 200;
  for (const auto use : {CampaignFolder::Use::fresh, CampaignFolder::Use::resume})
    EXPECT_THAT(refusal(use),
                HasSubstr("holds another campaign than c.json (preparation.count: 100 there, 200 here)"));
  EXPECT_EQ(read_file(dir / "campaign.json"), written);
}

TEST_F(RunCampaign, AForeignFolderIsLeftAlone) {
  fs::create_directories(dir);
  write_file(dir / "thesis.tex", "precious");
  EXPECT_THROW(open(CampaignFolder::Use::resume), Error);
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(dir)) names.push_back(entry.path().filename().string());
  EXPECT_THAT(names, ElementsAre("thesis.tex"));
}

TEST_F(RunCampaign, FilesThatAKilledRunWasWritingAreCleared) {
  { const auto first = open(); }
  for (const char* name :
       {"fits.json.part123", "predictions/a.csv.part7", "records/mine.part1", "my.partition", "fits.json"})
    fs::create_directories((dir / name).parent_path()), write_file(dir / name, "half");
  { const auto again = open(CampaignFolder::Use::resume); }
  EXPECT_FALSE(fs::exists(dir / "fits.json.part123"));
  EXPECT_FALSE(fs::exists(dir / "predictions/a.csv.part7"));
  for (const char* name : {"records/mine.part1", "my.partition", "fits.json"})
    EXPECT_TRUE(fs::exists(dir / name)) << name;
}

TEST_F(RunCampaign, AKeptRecordMustBeWholeAndOfItsScene) {
  run_campaign(campaign, open(), options());
  ran.clear();
  const fs::path records = dir / "records", kept = dir / "kept";
  const auto refusal = [&](const std::function<void()>& spoil) {
    fs::copy(records, kept, fs::copy_options::recursive);
    spoil();
    std::string said = "accepted";
    try {
      run_campaign(campaign, open(CampaignFolder::Use::resume), options());
    } catch (const Error& error) {
      said = error.what();
    }
    fs::remove_all(records);
    fs::rename(kept, records);
    return said;
  };
  const auto cut = [&](const char* file, std::size_t least) {
    const std::string text = read_file(records / file);
    write_file(records / file, text.substr(0, text.find('\n', least) + 1));
  };
  EXPECT_EQ(refusal([] {}), "accepted");
  EXPECT_THAT(refusal([&] { fs::remove(records / "iso-s2/record.csv"); }),
              AllOf(HasSubstr("iso-s2/record.csv: no such file"),
                    HasSubstr("; remove " + (records / "iso-s2").string())));
  EXPECT_THAT(refusal([&] { cut("d2-0.7-s1/record.csv", 2000); }),
              AllOf(HasSubstr("d2-0.7-s1/record.csv: must have 101 rows as its scene says, got"),
                    HasSubstr("; remove ")));
  EXPECT_THAT(refusal([&] { write_file(records / "d2-0.7-s1/record.csv", "nu,P\n0.5,nan\n"); }),
              HasSubstr("d2-0.7-s1/record.csv"));
  EXPECT_THAT(refusal([&] {
                fs::copy_file(records / "d2-0.75-s1/scene.json", records / "d2-0.7-s1/scene.json",
                              fs::copy_options::overwrite_existing);
              }),
              AllOf(HasSubstr("d2-0.7-s1/scene.json: is another scene than is wanted (preparation.nu: "
                              "0.75 there, 0.7 here)")));
  EXPECT_THAT(refusal([&] { write_file(records / "iso-s1/provenance.json", "{"); }), HasSubstr("; remove "));
  // A record of an earlier version, which knew no observers, is as good.
  EXPECT_EQ(refusal([&] {
              Json scene = load_json(records / "iso-s1/scene.json");
              scene["measure"].erase("observe");
              write_file(records / "iso-s1/scene.json", scene.dump());
            }),
            "accepted");
  EXPECT_THAT(refusal([&] {
                Json scene = load_json(records / "iso-s1/scene.json");
                scene["measure"]["observe"] = {"contacts"};
                write_file(records / "iso-s1/scene.json", scene.dump());
              }),
              HasSubstr("is another scene than is wanted (measure.observe"));
  // Snapshots count only where a test has yet to start from them.
  EXPECT_EQ(refusal([&] { fs::remove(records / "iso-s1/snapshots.h5"); }), "accepted");
  EXPECT_TRUE(ran.empty());
  EXPECT_THAT(
      refusal([&] {
        fs::remove_all(records / "d2-0.7-s1");
        fs::resize_file(records / "iso-s1/snapshots.h5", 1000);
      }),
      AllOf(HasSubstr("iso-s1/snapshots.h5"), HasSubstr("; remove " + (records / "iso-s1").string())));
  EXPECT_TRUE(ran.empty());
}

// Whether the strong forces percolate along an axis, these records do not tell: it came later.
TEST(KeptRecord, OfAnEarlierVersionLacksTheColumnsThatCameSince) {
  const fs::path dir = GRAINLAW_DATA_DIR "/records/near-jamming/sj-0.73-0.6585-s4";
  const Json scene = load_json(dir / "scene.json");
  ASSERT_FALSE(Record::read_csv(dir / "record.csv", {"xi_x", "percolating"}).has("percolates_x"));
  EXPECT_NO_THROW(check_kept_record(dir, scene));
}

}  // namespace
}  // namespace grainlaw::calibrate
