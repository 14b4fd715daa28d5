// grainlaw calibrate: from a campaign to a report. Simulates its tests, fits the law, predicts what was not
// fitted, reports.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>

#include "grainlaw/apps/arguments.hpp"
#include "grainlaw/apps/campaign_talk.hpp"
#include "grainlaw/apps/commands.hpp"
#include "grainlaw/apps/interrupt.hpp"
#include "grainlaw/apps/locations.hpp"
#include "grainlaw/apps/report/gnuplot.hpp"
#include "grainlaw/apps/report/report.hpp"
#include "grainlaw/apps/stage_times.hpp"
#include "grainlaw/apps/summary.hpp"
#include "grainlaw/apps/terminal.hpp"
#include "grainlaw/calibrate/campaign.hpp"
#include "grainlaw/calibrate/campaign_boxes.hpp"
#include "grainlaw/calibrate/campaign_folder.hpp"
#include "grainlaw/calibrate/fit_records.hpp"
#include "grainlaw/calibrate/predict_records.hpp"
#include "grainlaw/calibrate/run_campaign.hpp"
#include "grainlaw/element/file.hpp"

namespace grainlaw::apps {

namespace {

namespace fs = std::filesystem;

constexpr long most_workers = 1024;

struct Arguments {
  std::string campaign, output, jobs;
  RunArguments run;
};

/// The campaign to run: as given, that of the folder to go on with, or the quick one.
fs::path campaign_file(const Arguments& arguments) {
  if (!arguments.campaign.empty()) return arguments.campaign;
  const fs::path written = fs::path(arguments.output) / "campaign.json";
  if (arguments.run.resume && !arguments.output.empty() && fs::exists(written)) return written;
  return find_data("campaigns/quick.json");
}

std::size_t worker_count(const Arguments& arguments) {
  if (!arguments.jobs.empty())
    return static_cast<std::size_t>(read_whole_number("--jobs", arguments.jobs, 1, most_workers));
  return std::clamp<std::size_t>(std::thread::hardware_concurrency(), 1, most_workers);
}

/// The command that goes on where this one stopped.
std::string resume_command(const Arguments& arguments, const fs::path& dir) {
  std::string command = quoted(program_name()) + " calibrate";
  if (!arguments.campaign.empty()) command += " " + quoted(arguments.campaign);
  command += " -o " + quoted(dir.string());
  if (!arguments.jobs.empty()) command += " --jobs " + arguments.jobs;
  return command + arguments.run.words() + " --resume";
}

class Calibration {
 public:
  Calibration(const Arguments& arguments, const calibrate::Campaign& campaign, const fs::path& dir)
      : arguments_(arguments),
        campaign_(campaign),
        folder_(campaign, dir,
                arguments.run.resume ? calibrate::CampaignFolder::Use::resume
                                     : calibrate::CampaignFolder::Use::fresh),
        talk_(terminal_, dir),
        times_(dir, arguments.run.resume) {}

  int run() {
    const calibrate::CampaignResult simulated = simulate();
    if (simulated.stopped || interrupt_.stop()) {
      talk_.complain(fmt::format(
          "stopped; {} finished tests are kept, and a checkpoint of each under way; go on with: {}",
          simulated.reused + simulated.finished, resume_command(arguments_, folder_.dir())));
      return interrupted;
    }
    if (simulated.reused + simulated.finished == 0) return say_failures(simulated);  // nothing to fit
    interrupt_.end_at_once("stopped; all finished tests are kept; go on with: " +
                           resume_command(arguments_, folder_.dir()));
    fit_and_predict();
    terminal_.draw("writing the report");
    times_.measure("report", [&] { report::write_report(folder_.dir()); });
    talk_.say(fmt::format("report: {} ({} in all)", (folder_.dir() / "report.html").string(),
                          time_text(times_.total_s())));
    return simulated.failed.empty() ? all_well : say_failures(simulated);
  }

 private:
  calibrate::CampaignResult simulate() {
    const std::size_t workers = worker_count(arguments_);
    talk_.say(fmt::format("campaign {} in {}, {} at a time", campaign_.name, folder_.dir().string(),
                          workers == 1 ? "one test" : fmt::format("{} tests", workers)));
    calibrate::CampaignResult result;
    times_.measure("simulate", [&] {
      result = calibrate::run_campaign(
          campaign_, folder_, {workers, talk_.hooks(interrupt_.stop()), arguments_.run.checkpoint_every()});
    });
    talk_.say(fmt::format("simulated {} tests in {}{}", result.finished, time_text(result.wall_s),
                          result.reused > 0 ? fmt::format(", kept {} from before", result.reused) : ""));
    return result;
  }

  int say_failures(const calibrate::CampaignResult& simulated) {
    talk_.complain(fmt::format("{} of the tests failed, see {}; try them again with: {}",
                               simulated.failed.size(), (folder_.dir() / "failures.json").string(),
                               resume_command(arguments_, folder_.dir())));
    return failed;
  }

  void fit_and_predict() {
    calibrate::FitOutput fitted;
    terminal_.draw("fitting");
    times_.measure("fit", [&] {
      fitted = calibrate::fit_records(folder_.dir(), find_thesis(campaign_.material.w), {}, memory_sources());
      write_file(folder_.dir() / "parameters.json", fitted.parameters.to_json().dump(2) + "\n");
      fitted.write_account(folder_.dir());
    });
    Json predictions;
    terminal_.draw("predicting");
    times_.measure("predict",
                   [&] { predictions = calibrate::predict_records(folder_.dir(), fitted.parameters); });
    talk_.say("\n" + parameter_table(fitted.parameters) + "\n" + fit_remarks(fitted.fits) + "\n" +
              prediction_table(predictions));
  }

  const Arguments& arguments_;
  const calibrate::Campaign& campaign_;
  Interrupt interrupt_;
  calibrate::CampaignFolder folder_;
  Terminal terminal_;
  CampaignTalk talk_;
  StageTimes times_;
};

int run(const Arguments& arguments) {
  arguments.run.force_simd();
  arguments.run.checkpoint_every();
  worker_count(arguments);  // what would end the run is said before it begins, not after the simulation
  const auto campaign = calibrate::Campaign::load(campaign_file(arguments));
  find_thesis(campaign.material.w);
  report::run_gnuplot("");
  const fs::path dir =
      arguments.output.empty() ? fs::path("out") / campaign.name : fs::path(arguments.output);
  if (!fs::exists(dir)) check_boxes(campaign);  // what was begun goes on, but for that test
  return Calibration(arguments, campaign, dir).run();
}

}  // namespace

Action add_calibrate(CLI::App& program) {
  CLI::App* command = program.add_subcommand(
      "calibrate",
      "The main job: simulates a campaign, fits the law, predicts what was not fitted, writes a report");
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("CAMPAIGN.json", arguments->campaign, "campaign (default: data/campaigns/quick.json)");
  command
      ->add_option("-o,--output", arguments->output,
                   "output directory (default: out/NAME, the campaign's name)")
      ->type_name("DIR");
  command->add_option("--jobs", arguments->jobs, "tests to run at the same time (default: one per core)")
      ->type_name("N");
  arguments->run.add_to(*command, "go on where an interrupted run stopped; finished tests are kept");
  command->footer(
      "Examples:\n"
      "  grainlaw calibrate\n"
      "  grainlaw calibrate data/campaigns/quick.json -o out/mine --jobs 2\n"
      "  grainlaw calibrate -o out/mine --resume");
  return [arguments] { return run(*arguments); };
}

}  // namespace grainlaw::apps
