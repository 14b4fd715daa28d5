// grainlaw predict: the law as a material point along a path.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "grainlaw/apps/arguments.hpp"
#include "grainlaw/apps/commands.hpp"
#include "grainlaw/apps/terminal.hpp"
#include "grainlaw/dem/scene.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/element/record.hpp"
#include "grainlaw/model/predict.hpp"
#include "grainlaw/model/sensitivities.hpp"

namespace grainlaw::apps {

namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::string parameters, path, output, form, rtol, rows, method;
  std::vector<std::string> sensitivities;
  bool si = false;
};

/// What a prediction follows.
struct Followed {
  Path path;
  std::optional<Record> record;  ///< of a record directory: its rows are those of the prediction
};

/// A PATH.json, or the path that a record ran, from the volume fraction it began at.
Followed read_followed(const fs::path& where) {
  if (!fs::is_directory(where)) return {Path::read(Reader(load_json(where), where.string())), std::nullopt};
  const fs::path file = where / "scene.json";
  Followed followed{dem::Scene::read(Reader(load_json(file), file.string()), where).path,
                    Record::read_csv(where / "record.csv", {"segment", "eps_vol", "eps_dev", "nu"})};
  const Record& record = *followed.record;
  followed.path.start.nu = record["nu"].front() * std::exp(-record["eps_vol"].front());
  return followed;
}

/// The name of a column of stress, or of its derivative by something, in kPa; that of any other column as it
/// is.
std::string name_in_kPa(const std::string& name) {
  for (const std::string stress : {"P", "sigma_dev"}) {
    if (name == stress) return stress + "_kPa";
    if (name.starts_with("d" + stress + "/d(")) return "d" + stress + "_kPa" + name.substr(1 + stress.size());
  }
  return name;
}

/// The record with stress in kPa: P_kPa and sigma_dev_kPa in place of P and sigma_dev.
Record in_kPa(const Record& record, double unit_kPa) {
  std::vector<std::string> names = record.columns();
  for (auto& name : names) name = name_in_kPa(name);
  Record result(names);
  for (std::size_t i = 0; i < record.rows(); ++i) {
    std::vector<double> row;
    for (const auto& name : record.columns())
      row.push_back(record[name][i] * (name_in_kPa(name) != name ? unit_kPa : 1.0));
    result.append(row);
  }
  return result;
}

/// Every start value and where it comes from, on standard error: standard output may be the table.
void echo_start(Terminal& terminal, const model::Prediction& prediction) {
  for (const auto& [name, entry] : prediction.start.items()) {
    const Json& value = entry.at("value");
    terminal.warn(fmt::format("start {:<10} {:<12} {}", name,
                              value.is_number() ? to_text(value.get<double>()) : "unknown",
                              entry.at("from").get<std::string>()));
  }
  for (const auto& warning : prediction.warnings) terminal.warn("warning: " + warning);
}

model::PredictOptions read_options(const Arguments& arguments) {
  model::PredictOptions options;
  const model::Choice choice = model::choice_of(arguments.form);
  options.form = choice.form;
  options.terms = choice.terms;
  options.method = model::method_of(arguments.method);
  if (!arguments.rtol.empty()) options.rtol = read_number("--rtol", arguments.rtol, above_up_to(0, 0.1));
  if (!arguments.rows.empty())
    options.rows_per_leg = static_cast<int>(read_whole_number("--rows", arguments.rows, 1, 100'000));
  return options;
}

std::vector<fs::path> inputs_of(const Arguments& arguments) {
  const fs::path path = arguments.path;
  return {arguments.parameters, path, path / "scene.json", path / "record.csv"};
}

/// At these samples, or at even rows; with the derivatives by `names`, if any.
model::Prediction predict_at(const model::ParameterSet& parameters, const Path& path,
                             const std::optional<std::vector<model::Sample>>& samples,
                             const model::PredictOptions& options, std::vector<std::string> names) {
  if (names.empty())
    return samples ? model::predict(parameters, path, *samples, options)
                   : model::predict(parameters, path, options);
  if (names == std::vector<std::string>{"all"})
    names = model::names_of_sensitivities(parameters, path, {options.form, options.terms});
  auto result = samples ? model::predict_sensitivities(parameters, path, *samples, names, options)
                        : model::predict_sensitivities(parameters, path, names, options);
  if (!result.idle.empty())
    result.prediction.warnings.push_back(
        fmt::format("sensitivities of 0: nothing on this path depends on {}", fmt::join(result.idle, ", ")));
  return result.prediction;
}

/// Along a record: row by row, unless `even_rows` are asked for. Under stress control along the strain that
/// was measured.
model::Prediction predict_along(const model::ParameterSet& parameters, const Followed& followed,
                                const model::PredictOptions& options, bool even_rows,
                                const std::vector<std::string>& names) {
  const Path& path = followed.path;
  if (!followed.record || (even_rows && !path.by_stress()))
    return predict_at(parameters, path, std::nullopt, options, names);
  if (even_rows)
    throw Error(
        "", "--rows",
        "must be left out: the path is under stress control, and the law follows the rows of the record");
  if (!path.by_stress())
    return predict_at(parameters, path, model::samples_of(*followed.record, path, *path.start.nu), options,
                      names);
  const auto measured = model::measured_path(*followed.record, path);
  auto prediction = predict_at(parameters, measured.path, measured.samples, options, names);
  auto& segments = prediction.record["segment"];
  std::copy_n(measured.segments.begin(), segments.size(), segments.begin());
  return prediction;
}

int run(const Arguments& arguments) {
  if (!arguments.output.empty()) check_output("-o", arguments.output, inputs_of(arguments));
  const auto options = read_options(arguments);
  const auto parameters = model::ParameterSet::load(arguments.parameters);
  const Followed followed = read_followed(arguments.path);
  const model::Prediction prediction =
      predict_along(parameters, followed, options, !arguments.rows.empty(), arguments.sensitivities);
  Terminal terminal;
  if (prediction.status.failed()) {
    echo_start(terminal, prediction);
    terminal.warn(arguments.path + ": " + prediction.status.message);
    return failed;
  }
  const Record record =
      arguments.si ? in_kPa(prediction.record, parameters.material.stress_unit_kPa()) : prediction.record;
  if (arguments.output.empty())
    write_stdout(record.to_csv());
  else
    record.write_csv(arguments.output);
  echo_start(terminal, prediction);
  if (prediction.status.code != model::Status::Code::limit) return all_well;
  terminal.warn(arguments.path + ": " + prediction.status.message);
  return failed;
}

}  // namespace

Action add_predict(CLI::App& program) {
  CLI::App* command =
      program.add_subcommand("predict", "The law along a path: a table, to FILE.csv or standard output");
  const auto arguments = std::make_shared<Arguments>();
  arguments->form = name_of(model::PredictOptions{}.form);
  arguments->method = name_of(model::PredictOptions{}.method);
  command->add_option("PARAMETERS.json", arguments->parameters, "parameter set")->required();
  command
      ->add_option("PATH.json|RECORD_DIR", arguments->path, "path, or a record whose path and rows to follow")
      ->required();
  command->add_option("-o,--output", arguments->output, "table to write (default: standard output)")
      ->type_name("FILE.csv");
  command
      ->add_option("--form", arguments->form,
                   "reduced_closed, reduced, coupled or coupled_3_14; coupled takes terms: coupled+energy")
      ->type_name("FORM")
      ->capture_default_str();
  command->add_option("--rtol", arguments->rtol, "relative tolerance of the integration (default: 1e-8)")
      ->type_name("NUMBER");
  command
      ->add_option("--rows", arguments->rows, "rows per segment (default: 100; along a record, its own rows)")
      ->type_name("NUMBER");
  command->add_option("--method", arguments->method, "formulas of the integration: bdf or adams")
      ->type_name("METHOD")
      ->capture_default_str();
  command
      ->add_option(
          "--sensitivities", arguments->sensitivities,
          "add the derivatives by these parameters and start values (moduli.a_I, start.P, ...), or by "
          "all that the form uses")
      ->type_name("NAME[,NAME...]|all")
      ->delimiter(',');
  command->add_flag("--si", arguments->si,
                    "stress in kPa: columns P_kPa, sigma_dev_kPa in place of P, sigma_dev");
  command->footer(
      "Examples:\n"
      "  grainlaw predict data/thesis/parameters.json data/paths/d2-cycle.json -o d2.csv\n"
      "  grainlaw predict out/quick/parameters.json out/quick/records/uni-0.695-s1 --form reduced --si\n"
      "  grainlaw predict data/thesis/parameters.json data/paths/uni.json --sensitivities "
      "moduli.a_I,start.nu");
  return [arguments] { return run(*arguments); };
}

}  // namespace grainlaw::apps
