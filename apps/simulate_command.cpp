// grainlaw simulate: one element test by DEM.
#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "grainlaw/apps/arguments.hpp"
#include "grainlaw/apps/commands.hpp"
#include "grainlaw/apps/explain.hpp"
#include "grainlaw/apps/interrupt.hpp"
#include "grainlaw/apps/locations.hpp"
#include "grainlaw/apps/terminal.hpp"
#include "grainlaw/calibrate/kept_record.hpp"
#include "grainlaw/calibrate/lock_file.hpp"
#include "grainlaw/dem/observe/names.hpp"
#include "grainlaw/dem/record/checkpoint.hpp"
#include "grainlaw/dem/run/element_test.hpp"
#include "grainlaw/element/error.hpp"

namespace grainlaw::apps {

namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::string scene, output, threads, explain_seconds;
  RunArguments run;
  bool explain = false;
};

constexpr int most_threads = 1024;

int threads_of(const Arguments& arguments) {
  if (arguments.threads.empty()) return 1;
  return static_cast<int>(read_whole_number("--threads", arguments.threads, 1, most_threads));
}

std::optional<double> trial_seconds_of(const Arguments& arguments) {
  if (arguments.explain_seconds.empty()) return std::nullopt;
  if (!arguments.explain)
    throw Error("", "--explain-seconds", "is for --explain alone; leave it out to run the test");
  return read_number("--explain-seconds", arguments.explain_seconds, between(0.01, 1e9));
}

/// The folder as an absolute path without "." and "/" at its end, so that names can be put after it.
fs::path folder_of(const std::string& argument) {
  const fs::path folder = fs::absolute(argument).lexically_normal();
  return folder.has_filename() ? folder : folder.parent_path();
}

void check_free(const fs::path& folder, const std::string& shown) {
  if (fs::is_symlink(folder))
    throw Error(shown, "",
                "is a link; give the directory itself: it is made by renaming, which would replace the link");
  if (!fs::exists(folder)) return;
  if (!fs::is_directory(folder)) throw Error(shown, "", "is a file, must be a directory");
  if (!fs::is_empty(folder))
    throw Error(shown, "", "is not empty, and nothing in it is overwritten; give another directory with -o");
}

/// Removes the folder of a run that ended before its first checkpoint; refuses one that holds anything else.
void remove_leftover(const fs::path& part) {
  if (!fs::exists(part)) return;
  for (const auto& entry : fs::directory_iterator(part)) {
    const std::string name = entry.path().filename().string();
    bool ours = false;
    for (const std::string_view file : {"scene.json", "snapshots.h5", "moduli.csv", "provenance.json",
                                        "record.csv", "rows.csv", "checkpoint."})
      ours = ours || name.starts_with(file);
    for (const std::string& table : dem::observe::tables(dem::observe::names()))
      ours = ours || name.starts_with(table);
    if (!ours)
      throw Error(part.string(), "",
                  "is in the way: it holds \"" + name + "\", which is no part of a record");
  }
  fs::remove_all(part);
}

/// The test writes into `part`, and begins by emptying it.
void check_apart(const fs::path& part, const fs::path& input) {
  std::error_code code;
  const std::string way =
      fs::weakly_canonical(input, code).lexically_relative(fs::weakly_canonical(part, code));
  if (!way.empty() && !way.starts_with(".."))
    throw Error(input.string(), "",
                "lies in " + part.string() +
                    ", which this test would replace; move it, or give another directory with -o");
}

/// Makes the folder ready for the test: empty, or with the checkpoint that it is to go on from, or with the
/// whole record of a run that was killed before it could give it its name.
void make_ready(const fs::path& part, const dem::Scene& scene, const Arguments& arguments) {
  const bool whole = dem::has_whole_record(part);
  if (!dem::has_checkpoint(part) && !whole) {
    if (arguments.run.resume && !fs::exists(part))
      throw Error(arguments.output, "",
                  "holds no interrupted test to go on with (no " + part.filename().string() +
                      " beside it); leave --resume out to start one");
    check_apart(part, arguments.scene);
    if (const auto* begin = std::get_if<dem::FromSnapshot>(&scene.preparation))
      check_apart(part, begin->file);
    return remove_leftover(part);
  }
  if (!arguments.run.resume)
    throw Error(
        arguments.output, "",
        "holds an interrupted test; go on with --resume, or remove " + part.string() + " to start anew");
  if (whole)
    calibrate::check_kept_record(part, scene.to_json(part));
  else
    dem::check_checkpoint(part, scene);
}

std::string resume_command(const Arguments& arguments) {
  return quoted(program_name()) + " simulate " + quoted(arguments.scene) + " -o " + quoted(arguments.output) +
         (arguments.threads.empty() ? "" : " --threads " + quoted(arguments.threads)) +
         arguments.run.words() + " --resume";
}

/// A live line on a terminal.
dem::RunHooks hooks(Terminal& terminal, const Interrupt& interrupt, const Arguments& arguments) {
  dem::RunHooks hooks;
  hooks.checkpoint_every = arguments.run.checkpoint_every();
  hooks.threads = threads_of(arguments);
  hooks.stop = &interrupt.stop();
  if (terminal.live())
    hooks.progress = [&terminal](double fraction, const std::string& stage) {
      terminal.draw(fmt::format("{} {:3.0f} %  {}", bar_text(fraction, 20), 100 * fraction, stage));
    };
  return hooks;
}

int run(const Arguments& arguments) {
  arguments.run.force_simd();
  arguments.run.checkpoint_every();  // bad input is refused before anything is made
  threads_of(arguments);
  trial_seconds_of(arguments);
  if (arguments.output.empty() && !arguments.explain)
    throw Error("simulate: -o DIR is missing, the directory to make; or --explain, to make none");
  const dem::Scene scene = dem::Scene::load(arguments.scene);
  if (arguments.explain) {
    const dem::CostOptions options{threads_of(arguments), arguments.run.checkpoint_every(),
                                   trial_seconds_of(arguments)};
    write_stdout(explanation(scene, dem::cost_of(scene, options)));
    return all_well;
  }
  const fs::path folder = folder_of(arguments.output), part = folder.string() + ".part";
  check_free(folder, arguments.output);
  fs::create_directories(folder.parent_path());
  const calibrate::LockFile lock(part.string() + ".lock", arguments.output);
  check_free(folder, arguments.output);
  make_ready(part, scene, arguments);
  Interrupt interrupt;
  Terminal terminal;
  if (dem::has_whole_record(part)) {
    fs::rename(part, folder);
    terminal.say("the test had come to its end; " + arguments.output + " now holds its record");
    return all_well;
  }
  dem::RunSummary summary;
  try {
    summary = dem::run_element_test(scene, part, hooks(terminal, interrupt, arguments));
  } catch (...) {
    std::error_code ignored;
    if (!dem::has_checkpoint(part) && !fs::exists(part / "rows.csv", ignored)) fs::remove_all(part, ignored);
    throw;
  }
  if (summary.stopped) {
    terminal.warn("stopped; go on with: " + resume_command(arguments));
    return interrupted;
  }
  fs::rename(part, folder);
  for (const auto& warning : summary.warnings) terminal.warn("warning: " + warning);
  terminal.say(fmt::format(
      "wrote {} in {}, {}", (fs::path(arguments.output) / "record.csv").lexically_normal().string(),
      time_text(summary.wall_s), speed_text(static_cast<double>(summary.particle_steps) / summary.wall_s)));
  return summary.cut_short.empty() ? all_well : failed;
}

}  // namespace

Action add_simulate(CLI::App& program) {
  CLI::App* command =
      program.add_subcommand("simulate", "One element test by DEM: a record in a new directory");
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("SCENE.json", arguments->scene, "material, preparation, path and measure of the test")
      ->required();
  command->add_option("-o,--output", arguments->output, "directory to make; must not exist or be empty")
      ->type_name("DIR");
  command
      ->add_flag("--explain", arguments->explain,
                 "only say what the scene turns on and what it will take, from a trial on this machine")
      ->disable_flag_override();
  command
      ->add_option(
          "--explain-seconds", arguments->explain_seconds,
          "processor seconds that --explain may run each stage (default: 3 where its steps are known in "
          "advance; else 4 in the grains of the run, and 0.5 in others as dense), and fast compressions "
          "together in fewer grains (default: 2)")
      ->type_name("SECONDS");
  command
      ->add_option("--threads", arguments->threads,
                   "that share each step; the record does not depend on their number (default: 1)")
      ->type_name("N");
  arguments->run.add_to(*command, "go on where an interrupted run stopped");
  command->footer(
      "Examples:\n"
      "  grainlaw simulate data/scenes/d2.json -o out/d2\n"
      "  grainlaw simulate data/scenes/d2.json -o out/d2 --resume\n"
      "  grainlaw simulate data/scenes/d2.json --explain");
  return [arguments] { return run(*arguments); };
}

}  // namespace grainlaw::apps
