// grainlaw fit: the fits alone, from records on disk.
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "grainlaw/apps/arguments.hpp"
#include "grainlaw/apps/commands.hpp"
#include "grainlaw/apps/locations.hpp"
#include "grainlaw/apps/summary.hpp"
#include "grainlaw/apps/terminal.hpp"
#include "grainlaw/calibrate/fit_records.hpp"
#include "grainlaw/calibrate/lock_file.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/element/file.hpp"

namespace grainlaw::apps {

namespace {

struct Arguments {
  std::string dir, output, fits, memory, reversals;
};

namespace fs = std::filesystem;

/// Every file below `dir` that belongs to a campaign or a record.
std::vector<fs::path> inputs_in(const fs::path& dir) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(dir))
    for (const char* name :
         {"campaign.json", "scene.json", "record.csv", "moduli.csv", "provenance.json", "snapshots.h5"})
      if (entry.path().filename() == name) files.push_back(entry.path());
  return files;
}

/// Keeps other processes from writing into a campaign's folder; nothing where the results go elsewhere.
std::optional<calibrate::LockFile> lock_of(const Arguments& arguments) {
  const fs::path dir = arguments.dir;
  if (!arguments.output.empty() || !fs::exists(dir / "campaign.json")) return std::nullopt;
  return std::optional<calibrate::LockFile>(std::in_place, dir / ".lock", dir);
}

int run(const Arguments& arguments) {
  const fs::path dir = arguments.dir;
  const fs::path output = arguments.output.empty() ? dir / "parameters.json" : fs::path(arguments.output);
  fs::path fits = arguments.fits;
  if (arguments.output.empty() && fits.empty()) fits = dir / "fits.json";
  if (!fs::is_directory(dir)) throw Error(dir.string(), "", "no such directory");
  const std::vector<fs::path> inputs = inputs_in(dir);
  check_output("-o", output, inputs);
  if (!fits.empty()) check_output("--fits", fits, inputs);
  if (!fits.empty() && fs::absolute(fits).lexically_normal() == fs::absolute(output).lexically_normal())
    throw Error("", "--fits", "must be another file than -o, got " + fits.string());
  const auto lock = lock_of(arguments);
  if (!arguments.memory.empty() && !fs::is_directory(arguments.memory))
    throw Error("", "--memory", "must be a directory with over_compression.csv, got " + arguments.memory);
  if (!arguments.reversals.empty() && !fs::is_directory(arguments.reversals))
    throw Error("", "--reversals", "must be a directory of records, got " + arguments.reversals);
  calibrate::MemorySources memory = memory_sources(arguments.memory);
  memory.reversals = arguments.reversals;
  const calibrate::FitOutput fitted =
      calibrate::fit_records(dir, find_thesis(size_ratio_of_records(dir)), {}, memory);
  write_file(output, fitted.parameters.to_json().dump(2) + "\n");
  if (arguments.output.empty() && arguments.fits.empty())
    fitted.write_account(dir);
  else if (!fits.empty())
    write_file(fits, fitted.fits.dump(2) + "\n");
  write_stdout(parameter_table(fitted.parameters) + fit_remarks(fitted.fits) + "wrote " + output.string() +
               (fits.empty() ? "" : " and " + fits.string()) + "\n");
  return all_well;
}

}  // namespace

Action add_fit(CLI::App& program) {
  CLI::App* command = program.add_subcommand("fit", "Fits the law to the records in DIR");
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("DIR", arguments->dir, "output directory of a campaign, or a directory of records")
      ->required();
  command
      ->add_option("-o,--output", arguments->output,
                   "parameter set to write (default: DIR/parameters.json, with DIR/fits.json)")
      ->type_name("FILE");
  command->add_option("--fits", arguments->fits, "every fit with its data, curve, error, residual and exit")
      ->type_name("FILE");
  command
      ->add_option("--memory", arguments->memory,
                   "directory with tables of memory of the same material (over_compression.csv, "
                   "shear_jamming.csv, relaxed.csv, tapped.csv), read as tests of role memory are")
      ->type_name("DIR");
  command
      ->add_option(
          "--reversals", arguments->reversals,
          "records of D2 tests that turn their shear round, of the same material: to those of role fit "
          "the form with memory fits what a reversal does (default: to those in DIR)")
      ->type_name("DIR");
  command->footer(
      "Examples:\n"
      "  grainlaw fit out/quick -o parameters.json --fits fits.json\n"
      "  grainlaw fit data/records/base --memory data/memory \\\n"
      "    --reversals data/records/small-cycles -o parameters.json");
  return [arguments] { return run(*arguments); };
}

}  // namespace grainlaw::apps
