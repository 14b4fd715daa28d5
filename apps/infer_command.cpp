// grainlaw infer-phij: the jamming density along a measured path.
#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "grainlaw/apps/arguments.hpp"
#include "grainlaw/apps/commands.hpp"
#include "grainlaw/apps/locations.hpp"
#include "grainlaw/apps/terminal.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/element/record.hpp"
#include "grainlaw/model/infer_jamming.hpp"

namespace grainlaw::apps {

namespace {

struct Arguments {
  std::string record, parameters, mode = "iso", scatter = "0", output;
};

constexpr double thesis_size_ratio = 3;

int run(const Arguments& arguments) {
  const std::filesystem::path file = arguments.parameters.empty()
                                         ? find_thesis(thesis_size_ratio)
                                         : std::filesystem::path(arguments.parameters);
  if (!arguments.output.empty()) check_output("-o", arguments.output, {arguments.record, file});
  if (const std::vector<std::string> rows{"iso", "uni", "d2", "d3"};
      std::find(rows.begin(), rows.end(), arguments.mode) == rows.end())
    throw Error("", "--mode", "must be one of iso, uni, d2, d3, got \"" + arguments.mode + "\"");
  const double scatter = read_number("--scatter", arguments.scatter, between(0, 0.1));
  const auto set = model::ParameterSet::load(file);
  const model::PackingLaw& law = set.packing(arguments.mode, "infer-phij, which inverts its laws,");
  const Record record = Record::read_csv(arguments.record, {"nu", "P"});
  const Record inferred = model::infer_jamming_density(record, law, scatter);
  if (arguments.output.empty())
    write_stdout(inferred.to_csv());
  else
    inferred.write_csv(arguments.output);
  return all_well;
}

}  // namespace

Action add_infer(CLI::App& program) {
  CLI::App* command = program.add_subcommand(
      "infer-phij", "The jamming density along a measured path, from pressure and contacts");
  const auto arguments = std::make_shared<Arguments>();
  command
      ->add_option("RECORD.csv", arguments->record,
                   "table with columns nu and P; C, C_star and f_NR where measured")
      ->required();
  command
      ->add_option("-p,--parameters", arguments->parameters,
                   "parameter set whose laws are inverted (default: the thesis's, w = 3)")
      ->type_name("PARAMETERS.json");
  command->add_option("--mode", arguments->mode, "row of these laws: iso, uni, d2 or d3")
      ->type_name("MODE")
      ->capture_default_str();
  command
      ->add_option("--scatter", arguments->scatter,
                   "how far packings differ in their jamming density (standard deviation), to be added to "
                   "the stated errors, which are of the laws' numbers alone: 5e-4 for 1000 or 2000 grains")
      ->type_name("X")
      ->capture_default_str();
  command->add_option("-o,--output", arguments->output, "table to write (default: standard output)")
      ->type_name("FILE.csv");
  command->footer(
      "Example:\n  grainlaw infer-phij out/quick/records/iso-s1/record.csv -p out/quick/parameters.json -o "
      "phij.csv");
  return [arguments] { return run(*arguments); };
}

}  // namespace grainlaw::apps
