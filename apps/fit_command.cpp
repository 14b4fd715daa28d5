// grainlaw fit: the fits alone, from records on disk.
#include <filesystem>
#include <memory>
#include <string>

#include "grainlaw/apps/commands.hpp"
#include "grainlaw/apps/locations.hpp"
#include "grainlaw/apps/summary.hpp"
#include "grainlaw/apps/terminal.hpp"
#include "grainlaw/calibrate/fit_records.hpp"
#include "grainlaw/element/file.hpp"

namespace grainlaw::apps {

namespace {

struct Arguments {
  std::string dir, output, fits;
};

int run(const Arguments& arguments) {
  namespace fs = std::filesystem;
  const fs::path dir = arguments.dir;
  const fs::path output = arguments.output.empty() ? dir / "parameters.json" : fs::path(arguments.output);
  fs::path fits = arguments.fits;
  if (arguments.output.empty() && fits.empty()) fits = dir / "fits.json";
  const calibrate::FitOutput fitted = calibrate::fit_records(dir, find_thesis(size_ratio_of_records(dir)));
  write_file(output, fitted.parameters.to_json().dump(2) + "\n");
  if (!fits.empty()) write_file(fits, fitted.fits.dump(2) + "\n");
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
  command->footer("Example:\n  grainlaw fit out/quick -o parameters.json --fits fits.json");
  return [arguments] { return run(*arguments); };
}

}  // namespace grainlaw::apps
