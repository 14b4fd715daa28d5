// grainlaw predict: the law as a material point along a path.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "grainlaw/apps/arguments.hpp"
#include "grainlaw/apps/commands.hpp"
#include "grainlaw/apps/predict_input.hpp"
#include "grainlaw/apps/prediction_picture.hpp"
#include "grainlaw/apps/terminal.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/element/record.hpp"
#include "grainlaw/model/envelope.hpp"
#include "grainlaw/model/predict.hpp"
#include "grainlaw/model/predict_minimal.hpp"
#include "grainlaw/model/start.hpp"
#include "grainlaw/model/walk/sensitivities.hpp"

namespace grainlaw::apps {

namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::string parameters, path, output, form, rtol, rows, method, nu, P, plot, envelope;
  std::string directions;
  std::vector<std::string> sensitivities;
  bool si = false;
};

/// The name of a column of stress, or of its derivative by something, in kPa; that of any other column as it
/// is.
std::string name_in_kPa(const std::string& name) {
  for (const std::string stress : {"P", "sigma_dev"}) {
    if (name == stress) return stress + "_kPa";
    if (name == "d" + stress) return "d" + stress + "_kPa";  // of a response
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

constexpr const char* form_names = "reduced_closed, reduced, coupled, memory, coupled_3_14 or minimal";

/// The form that is evaluated, not integrated.
bool is_minimal(const Arguments& arguments) { return arguments.form == model::minimal_name; }

/// A form that is integrated, with its terms.
model::Choice read_form(const std::string& text) {
  const std::string name = text.substr(0, text.find('+'));
  if (name == model::minimal_name) throw Error("", "--form", "minimal takes no terms, got \"" + text + "\"");
  try {
    model::form_of(name);
  } catch (const Error&) {
    throw Error("", "--form", std::string("must be one of ") + form_names + ", got \"" + text + "\"");
  }
  return model::choice_of(text);
}

model::PredictOptions read_options(const Arguments& arguments) {
  model::PredictOptions options;
  const model::Choice choice = is_minimal(arguments) ? model::Choice{} : read_form(arguments.form);
  options.form = choice.form;
  options.terms = choice.terms;
  options.method = model::method_of(arguments.method);
  // Below 1e-12 rounding is more than what is asked.
  if (!arguments.rtol.empty()) options.rtol = read_number("--rtol", arguments.rtol, between(1e-12, 0.1));
  if (!arguments.rows.empty())
    options.rows_per_leg = static_cast<int>(read_whole_number("--rows", arguments.rows, 1, 100'000));
  return options;
}

std::vector<fs::path> inputs_of(const Arguments& arguments) {
  auto inputs = files_of(arguments.path);
  inputs.emplace_back(arguments.parameters);
  return inputs;
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
  const auto along_measured = [&](const model::MeasuredPath& measured) {
    auto prediction = predict_at(parameters, measured.path, measured.samples, options, names);
    auto& segments = prediction.record["segment"];
    std::copy_n(measured.segments.begin(), segments.size(), segments.begin());
    return prediction;
  };
  const Path& path = followed.path;
  if (followed.strains && even_rows)
    throw Error("", "--rows", "must be left out: the law follows the rows of the table");
  if (followed.strains) return along_measured(*followed.strains);
  if (!followed.record || (even_rows && !path.by_stress()))
    return predict_at(parameters, path, std::nullopt, options, names);
  if (even_rows)
    throw Error(
        "", "--rows",
        "must be left out: the path is under stress control, and the law follows the rows of the record");
  if (!path.by_stress())
    return predict_at(parameters, path, model::samples_of(*followed.record, path, *path.start.nu), options,
                      names);
  return along_measured(model::measured_path(*followed.record, path));
}

void check_arguments(const Arguments& arguments) {
  for (const auto& [option, file] :
       {std::pair{"-o", &arguments.output}, std::pair{"--plot", &arguments.plot}})
    if (!file->empty()) check_output(option, *file, inputs_of(arguments));
  if (!arguments.plot.empty()) check_picture(arguments.plot);
  if (!arguments.directions.empty() && arguments.envelope.empty())
    throw Error("", "--directions", "goes with --envelope");
  if (!arguments.plot.empty() && arguments.plot == arguments.output)
    throw Error("", "--plot", "must not be the table's own file, got " + arguments.plot);
  if (!arguments.envelope.empty() && !arguments.sensitivities.empty())
    throw Error("", "--sensitivities", "goes with the table along a path, not with --envelope");
  if (is_minimal(arguments) && !(arguments.envelope.empty() && arguments.sensitivities.empty()))
    throw Error("", "--form", "minimal has no rates: it goes without --envelope and --sensitivities");
}

/// Strain increments around the end of a path.
struct Probe {
  double size;
  int directions = 72;
};

std::optional<Probe> read_probe(const Arguments& arguments) {
  if (arguments.envelope.empty()) return std::nullopt;
  Probe probe{read_number("--envelope", arguments.envelope, above_up_to(0, 0.1))};
  if (!arguments.directions.empty())
    probe.directions = static_cast<int>(read_whole_number("--directions", arguments.directions, 1, 100'000));
  return probe;
}

/// The responses of the state where the path ended.
model::Envelope responses_of(const model::ParameterSet& parameters, const Followed& followed,
                             const model::Prediction& prediction, const model::PredictOptions& options,
                             const Probe& probe) {
  const auto start = model::start_of(parameters, followed.path, {options.form, options.terms});
  const model::Tolerance tolerance{options.rtol, options.atol * probe.size};
  return model::envelope(start.law, prediction.end, tolerance, probe.size, probe.directions);
}

void write_table(const Arguments& arguments, const Record& record) {
  if (arguments.output.empty())
    write_stdout(record.to_csv());
  else
    record.write_csv(arguments.output);
  if (arguments.plot.empty()) return;
  if (arguments.envelope.empty())
    write_picture(arguments.plot, record);
  else
    write_envelope_picture(arguments.plot, record);
}

/// The minimal form, along a path by strain or the rows of a record.
model::Prediction predict_minimally(const model::ParameterSet& parameters, const Followed& followed,
                                    const model::PredictOptions& options, bool even_rows) {
  if (followed.strains || followed.path.by_stress())
    throw Error("", "--form", "minimal follows a path by strain or the record of one");
  if (!followed.record || even_rows)
    return model::predict_minimal(parameters, followed.path, options.rows_per_leg);
  return model::predict_minimal(parameters, followed.path,
                                model::samples_of(*followed.record, followed.path, *followed.path.start.nu));
}

int run(const Arguments& arguments) {
  check_arguments(arguments);
  const auto options = read_options(arguments);
  const auto probe = read_probe(arguments);
  const auto parameters = model::ParameterSet::load(arguments.parameters);
  const Followed followed =
      read_followed(arguments.path, arguments.nu, arguments.P, parameters.material.stress_unit_kPa());
  const bool even_rows = !arguments.rows.empty();
  const model::Prediction prediction =
      is_minimal(arguments)
          ? predict_minimally(parameters, followed, options, even_rows)
          : predict_along(parameters, followed, options, even_rows, arguments.sensitivities);
  Terminal terminal;
  model::Status status = prediction.status;
  Record record = prediction.record;
  const bool ended = !status.failed() && status.code != model::Status::Code::limit;
  if (ended && probe) {
    auto responses = responses_of(parameters, followed, prediction, options, *probe);
    status = responses.status;
    record = std::move(responses.responses);
  }
  // A limit leaves the rows up to it; of an envelope there is nothing without its state.
  if (!status.failed() && (ended || !probe))
    write_table(arguments, arguments.si ? in_kPa(record, parameters.material.stress_unit_kPa()) : record);
  echo_start(terminal, prediction);
  if (!status.failed() && status.code != model::Status::Code::limit) return all_well;
  terminal.warn(arguments.path + ": " + status.message);
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
      ->add_option("PATH.json|RECORD_DIR|STRAINS.csv", arguments->path,
                   "path, or a record or a table of strains whose rows to follow")
      ->required();
  command->add_option("-o,--output", arguments->output, "table to write (default: standard output)")
      ->type_name("FILE.csv");
  command->add_option("--form", arguments->form, std::string(form_names) + "; with terms: coupled+energy")
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
  command->add_option("--nu", arguments->nu, "volume fraction at the first row of STRAINS.csv")
      ->type_name("NUMBER");
  command->add_option("--P", arguments->P, "pressure at the first row of STRAINS.csv: over k*, or as 50kPa")
      ->type_name("NUMBER[kPa]");
  command
      ->add_option("--envelope", arguments->envelope,
                   "in place of the path's table, the responses of its end to strains of this size in all "
                   "directions")
      ->type_name("STRAIN");
  command->add_option("--directions", arguments->directions, "how many directions (default: 72)")
      ->type_name("NUMBER");
  command->add_option("--plot", arguments->plot, "also draw the table")->type_name("FILE.svg|FILE.png");
  command->add_flag("--si", arguments->si,
                    "stress in kPa: columns P_kPa, sigma_dev_kPa in place of P, sigma_dev");
  command->footer(
      "Examples:\n"
      "  grainlaw predict data/thesis/parameters.json data/paths/d2-cycle.json -o d2.csv\n"
      "  grainlaw predict out/quick/parameters.json out/quick/records/uni-0.695-s1 --form reduced --si\n"
      "  grainlaw predict data/thesis/parameters.json data/paths/uni.json --sensitivities "
      "moduli.a_I,start.nu\n"
      "  grainlaw predict data/thesis/parameters.json data/paths/triaxial.json -o tri.csv --plot tri.svg\n"
      "  grainlaw predict data/thesis/parameters.json data/paths/d3.json --envelope 1e-4 --plot d3.png");
  return [arguments] { return run(*arguments); };
}

}  // namespace grainlaw::apps
