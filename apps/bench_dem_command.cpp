// grainlaw bench dem: what a wanted error costs. Runs the same tests over time steps, rates and numbers of
// grains, and holds what each costs against its error relative to the finest.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "grainlaw/apps/arguments.hpp"
#include "grainlaw/apps/bench_commands.hpp"
#include "grainlaw/apps/bench_dem_page.hpp"
#include "grainlaw/apps/campaign_talk.hpp"
#include "grainlaw/apps/interrupt.hpp"
#include "grainlaw/apps/locations.hpp"
#include "grainlaw/apps/report/gnuplot.hpp"
#include "grainlaw/apps/terminal.hpp"
#include "grainlaw/calibrate/bench_advice.hpp"
#include "grainlaw/calibrate/bench_errors.hpp"
#include "grainlaw/calibrate/lock_file.hpp"
#include "grainlaw/calibrate/run_campaign.hpp"
#include "grainlaw/dem/files/snapshot.hpp"
#include "grainlaw/dem/numbers/simd.hpp"
#include "grainlaw/dem/record/checkpoint.hpp"
#include "grainlaw/dem/run/measured_cost.hpp"
#include "grainlaw/dem/scene/provenance.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/element/file.hpp"
#include "grainlaw/element/json_difference.hpp"
#include "grainlaw/element/version.hpp"

namespace grainlaw::apps {

namespace {

namespace fs = std::filesystem;

constexpr long most_workers = 1024;
constexpr auto plan_name = "bench.json";

struct Arguments {
  std::string output, jobs, count, seeds, twins, eps_dev, nu_end;
  std::vector<std::string> knobs;
  bool resume = false;
};

std::vector<calibrate::Knob> knobs_of(const Arguments& arguments) {
  if (arguments.knobs.empty()) return calibrate::all_knobs();
  std::vector<calibrate::Knob> chosen;
  std::string known;
  for (const calibrate::Knob knob : calibrate::all_knobs()) {
    known += (known.empty() ? "" : ", ") + name_of(knob);
    if (std::count(arguments.knobs.begin(), arguments.knobs.end(), name_of(knob)) > 0) chosen.push_back(knob);
  }
  for (const std::string& name : arguments.knobs)
    if (std::none_of(chosen.begin(), chosen.end(), [&](auto knob) { return name_of(knob) == name; }))
      throw Error("--knob: must be one of " + known + ", got \"" + name + "\"");
  return chosen;
}

calibrate::Bench bench_of(const Arguments& arguments) {
  calibrate::Bench bench;
  const auto whole = [](const char* option, const std::string& text, std::int64_t& value, long low,
                        long high) {
    if (!text.empty()) value = read_whole_number(option, text, low, high);
  };
  whole("--count", arguments.count, bench.count, 32, 1'000'000);
  whole("--seeds", arguments.seeds, bench.seeds, 1, 1000);
  whole("--twins", arguments.twins, bench.twins, 2, 1000);
  if (!arguments.eps_dev.empty())
    bench.eps_dev = read_number("--eps-dev", arguments.eps_dev, above_up_to(0, 2));
  if (!arguments.nu_end.empty())
    bench.nu_end = read_number("--nu", arguments.nu_end, inside(0.5, calibrate::Bench::nu_start));
  bench.knobs = knobs_of(arguments);
  return bench;
}

std::size_t worker_count(const Arguments& arguments) {
  if (!arguments.jobs.empty())
    return static_cast<std::size_t>(read_whole_number("--jobs", arguments.jobs, 1, most_workers));
  return std::clamp<std::size_t>(std::thread::hardware_concurrency(), 1, most_workers);
}

/// Refuses a directory that holds anything but this very bench.
void check_directory(const fs::path& dir, const calibrate::Bench& bench, bool resume) {
  const fs::path written = dir / plan_name;
  if (fs::exists(dir) && !fs::is_directory(dir))
    throw Error(dir.string(), "", "is a file, must be a directory");
  if (!fs::exists(written)) {
    if (resume)
      throw Error(dir.string(), "", "holds no bench to go on with; leave --resume out to start one there");
    for (const auto& entry : fs::exists(dir) ? fs::directory_iterator(dir) : fs::directory_iterator())
      if (entry.path().filename() != ".lock")
        throw Error(dir.string(), "", "is not empty and holds no bench; give another directory with -o");
    return;
  }
  if (const auto differs = first_difference(load_json(written), bench.to_json()); !differs.empty())
    throw Error(dir.string(), "", "holds another bench (" + differs + "); give another directory with -o");
  if (!resume)
    throw Error(dir.string(), "",
                "holds this bench already; go on with --resume, or give another directory with -o");
}

/// The twins of a packing: one grain of each moved, a different one each time.
void write_twins(const fs::path& dir, std::int64_t twins) {
  const dem::Frame frame = dem::read_whole_frame(dir / "snapshots.h5", {});
  for (std::int64_t twin = 1; twin < twins; ++twin) {
    dem::State state = frame.state;
    state.position[static_cast<std::size_t>(twin) % state.count()][0] += calibrate::Bench::nudge;
    fs::remove(dir / calibrate::twin_file(twin));
    dem::SnapshotWriter(dir / calibrate::twin_file(twin), state.radius).append(state, frame.observables);
  }
}

/// What a test has taken of a core so far: nothing where it is new, unknown where it was killed.
std::optional<double> seconds_before(const fs::path& dir) {
  const fs::path file = dir / calibrate::core_time_file;
  if (!dem::has_checkpoint(dir)) return 0;
  if (!fs::exists(file)) return std::nullopt;
  const double seconds = load_json(file).at("core_s").get<double>();
  fs::remove(file);
  return seconds;
}

/// Runs a test, notes what it took of a core, and makes the twins of a packing.
calibrate::RunTest timed_test(const calibrate::Bench& bench) {
  return [twins = bench.twins](const dem::Scene& scene, const fs::path& dir, const dem::RunHooks& hooks) {
    const auto before = seconds_before(dir);
    const double begin = dem::thread_seconds();
    const dem::RunSummary summary = dem::run_element_test(scene, dir, hooks);
    const double core_s = dem::thread_seconds() - begin;
    if (before && (!summary.stopped || dem::has_checkpoint(dir)))
      write_file(dir / calibrate::core_time_file, Json{{"core_s", *before + core_s}}.dump(2) + "\n");
    if (!summary.stopped && std::holds_alternative<dem::NewPacking>(scene.preparation))
      write_twins(dir, twins);
    return summary;
  };
}

/// The numbers and pictures of what is on disk.
std::vector<calibrate::BenchError> write_result(const calibrate::Bench& bench, const fs::path& dir) {
  const auto errors = calibrate::bench_errors(bench, calibrate::RunFolder{dir});
  Json result{{"bench", bench.to_json()},         {"version", version()},       {"commit", commit()},
              {"compiler", dem::compiler_name()}, {"simd", dem::simd_target()}, {"written", dem::utc_now()},
              {"errors", to_json(errors)}};
  write_file(dir / "speed-against-error.json", result.dump(1) + "\n");
  write_file(dir / "speed-against-error.csv", to_csv(errors));
  write_file(dir / "speed-against-error.svg", bench_picture(bench, errors, BenchCost::core_seconds));
  write_file(dir / "steps-against-error.svg", bench_picture(bench, errors, BenchCost::particle_steps));
  write_file(dir / "report.html", bench_page(bench, errors, calibrate::bench_advice(errors)));
  return errors;
}

int run(const Arguments& arguments) {
  const calibrate::Bench bench = bench_of(arguments);
  const std::size_t workers = worker_count(arguments);
  report::run_gnuplot("");
  const fs::path dir = arguments.output.empty() ? fs::path("out/bench-dem") : fs::path(arguments.output);
  check_directory(dir, bench, arguments.resume);
  fs::create_directories(dir / "records");
  const calibrate::LockFile lock(dir / ".lock", dir);
  write_file(dir / plan_name, bench.to_json().dump(2) + "\n");
  Terminal terminal;
  CampaignTalk talk(terminal, dir);
  Interrupt interrupt;
  const auto jobs = plan(bench);
  talk.say(fmt::format("bench of {} runs, N = {}, in {}", jobs.size(), bench.count, dir.string()));
  calibrate::RunOptions options;
  options.workers = workers;
  options.hooks = talk.hooks(interrupt.stop());
  options.run_test = timed_test(bench);
  const auto result = calibrate::run_jobs(jobs, {dir}, options);
  const auto errors = write_result(bench, dir);
  if (result.stopped) {
    talk.complain(fmt::format("stopped; {} finished runs are kept; go on with --resume",
                              result.reused + result.finished));
    return interrupted;
  }
  talk.say(calibrate::bench_advice(errors));
  talk.say("report: " + (dir / "report.html").string());
  return result.failed.empty() ? all_well : failed;
}

}  // namespace

Action add_bench_dem(CLI::App& bench) {
  CLI::App* command = bench.add_subcommand("dem",
                                           "What a wanted error costs: the DEM over time steps, rate, method "
                                           "and number of grains, against the finest");
  const auto arguments = std::make_shared<Arguments>();
  const auto option = [&](const char* name, std::string& value, const char* what, const char* type) {
    command->add_option(name, value, what)->type_name(type);
  };
  option("--count", arguments->count, "number of grains (default: 1000)", "N");
  option("--seeds", arguments->seeds, "packings (default: 2)", "N");
  option("--twins", arguments->twins, "runs per packing, told apart by 1e-7 mm (default: 2)", "N");
  option("--eps-dev", arguments->eps_dev, "to which D2 goes (default: 0.05)", "X");
  option("--nu", arguments->nu_end, "to which the isotropic unloading goes (default: 0.74)", "X");
  command
      ->add_option("--knob", arguments->knobs,
                   "only this knob: time_step, rate, method, gas_step, count; may be repeated")
      ->type_name("KNOB");
  option("-o,--output", arguments->output, "output directory (default: out/bench-dem)", "DIR");
  option("--jobs", arguments->jobs, "runs at the same time (default: one per core)", "N");
  command->add_flag("--resume", arguments->resume, "go on where an interrupted bench stopped");
  command->footer(
      "Examples:\n"
      "  grainlaw bench dem\n"
      "  grainlaw bench dem --count 9261 --knob time_step --knob rate -o out/bench-9261");
  return [arguments] { return run(*arguments); };
}

}  // namespace grainlaw::apps
