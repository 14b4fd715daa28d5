// grainlaw polish: chosen parameters fitted to whole measured paths, after the fits law by law.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "grainlaw/apps/arguments.hpp"
#include "grainlaw/apps/commands.hpp"
#include "grainlaw/apps/terminal.hpp"
#include "grainlaw/calibrate/fit_paths.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/element/file.hpp"

namespace grainlaw::apps {

namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::string parameters, dir, output, account, rows, form;
  std::vector<std::string> names, modes{"d2", "d3"};
  std::vector<std::string> columns{calibrate::path_columns.begin(), calibrate::path_columns.end()};
  std::string weights = "scatter";
  bool brief = false;
};

std::string misfit_line(const char* when, const Json& misfit) {
  const auto text = [&](const char* key) {
    return misfit.at(key).is_number() ? fmt::format("{:.3g}", misfit.at(key).get<double>()) : "unknown";
  };
  return fmt::format("misfit {:<7} stress {:>8}  fabric {:>8}   (in units of the errors)\n", when,
                     text("stress"), text("fabric"));
}

/// Mean over seeds of the relative errors of held-out predictions, before and after.
std::string held_out_table(const Json& held_out) {
  struct Sum {
    double before = 0, after = 0;
    int n = 0;
  };
  std::map<std::string, std::map<std::string, Sum>> tests;
  for (const Json& entry : held_out)
    for (const char* column : {"P", "sigma_dev", "F_dev"}) {
      if (!entry.contains("errors") || !entry.at("errors").contains(column)) continue;
      const Json& error = entry.at("errors").at(column);
      if (!error.value("before", Json()).is_number() || !error.value("after", Json()).is_number()) continue;
      Sum& sum = tests[entry.at("test")][column];
      sum.before += error.at("before").get<double>();
      sum.after += error.at("after").get<double>();
      ++sum.n;
    }
  if (tests.empty()) return "";
  std::string text = fmt::format("{:<20} {:>17} {:>17} {:>17}   (held out: relative error before > after)\n",
                                 "", "P", "sigma_dev", "F_dev");
  int grew = 0, all = 0;
  for (const auto& [test, columns] : tests) {
    text += fmt::format("{:<20}", test);
    for (const auto& [column, sum] : columns) {
      grew += sum.after > sum.before ? 1 : 0;
      ++all;
    }
    for (const char* column : {"P", "sigma_dev", "F_dev"}) {
      const auto sum = columns.find(column);
      text += sum == columns.end() ? fmt::format(" {:>17}", "-")
                                   : fmt::format("   {:>6.3f} > {:<6.3f}", sum->second.before / sum->second.n,
                                                 sum->second.after / sum->second.n);
    }
    text += "\n";
  }
  text += fmt::format("of {} errors on tests that were held out {} grew{}\n", all, grew,
                      2 * grew > all ? ": what was gained on the fitted tests does not carry over" : "");
  return text;
}

/// `columns` as what to compare.
calibrate::ColumnsCompared compared(const std::vector<std::string>& columns) {
  const auto& known = calibrate::path_columns;
  calibrate::ColumnsCompared compared{};
  for (const std::string& column : columns) {
    const auto at = std::find(known.begin(), known.end(), column);
    if (at == known.end())
      throw Error("", "--columns", "must be of P, sigma_dev, F_dev, got \"" + column + "\"");
    compared[static_cast<std::size_t>(at - known.begin())] = true;
  }
  return compared;
}

int run(const Arguments& arguments) {
  const fs::path dir = arguments.dir;
  if (!fs::is_directory(dir)) throw Error(dir.string(), "", "no such directory");
  check_output("-o", arguments.output, {arguments.parameters});
  if (!arguments.account.empty())
    check_output("--account", arguments.account, {arguments.parameters, arguments.output});
  calibrate::PolishOptions options;
  options.names = arguments.names;
  options.form = model::choice_of(arguments.form);
  options.selection.modes = arguments.modes;
  options.compared = compared(arguments.columns);
  if (arguments.weights != "scatter" && arguments.weights != "size")
    throw Error("", "--weights", "must be one of scatter, size, got \"" + arguments.weights + "\"");
  if (arguments.weights == "size") options.selection.weights = calibrate::PathWeights::size;
  options.trade_off = options.profiles = !arguments.brief;
  if (!arguments.rows.empty())
    options.selection.rows_per_leg =
        static_cast<std::size_t>(read_whole_number("--rows", arguments.rows, 3, 10'000));
  const auto start = model::ParameterSet::load(arguments.parameters);
  const auto polished = calibrate::polish(dir, start, options);
  const Json& account = polished.account;
  std::string text;
  for (const Json& sentence : account.at("sentences")) text += sentence.get<std::string>() + "\n";
  text +=
      misfit_line("before", account.at("misfit_before")) + misfit_line("after", account.at("misfit_after"));
  text += held_out_table(account.at("held_out")) + account.at("exit").get<std::string>() + "\n";
  if (!arguments.account.empty()) write_file(arguments.account, account.dump(2) + "\n");
  const bool fitted = !account.at("exit").get<std::string>().starts_with("failed");
  if (fitted) write_file(arguments.output, polished.parameters.to_json().dump(2) + "\n");
  write_stdout(text + (fitted ? "wrote " + arguments.output + "\n" : ""));
  return fitted ? all_well : failed;
}

}  // namespace

Action add_polish(CLI::App& program) {
  CLI::App* command =
      program.add_subcommand("polish", "Fits chosen parameters to whole measured paths, after grainlaw fit");
  const auto arguments = std::make_shared<Arguments>();
  arguments->form = name_of(model::Choice{});
  command->add_option("PARAMETERS.json", arguments->parameters, "parameter set to start from")->required();
  command->add_option("DIR", arguments->dir, "output directory of a campaign, or a directory of records")
      ->required();
  command->add_option("-o,--output", arguments->output, "parameter set to write")
      ->type_name("FILE")
      ->required();
  command
      ->add_option("--account", arguments->account,
                   "data, errors, correlations, profiles, trade-off and held-out predictions")
      ->type_name("FILE");
  command
      ->add_option("--parameters", arguments->names,
                   "parameters to fit (moduli.a_I, ...; default: moduli and saturation laws of shear)")
      ->type_name("NAME[,NAME...]")
      ->delimiter(',');
  command->add_option("--form", arguments->form, "form of the law, as of predict")
      ->type_name("FORM")
      ->capture_default_str();
  command->add_option("--modes", arguments->modes, "tests to read")
      ->type_name("MODE[,MODE...]")
      ->delimiter(',')
      ->capture_default_str();
  command->add_option("--columns", arguments->columns, "what is compared")
      ->type_name("COLUMN[,COLUMN...]")
      ->delimiter(',')
      ->capture_default_str();
  command
      ->add_option("--weights", arguments->weights,
                   "scatter: errors from the scatter over seeds; size: 5 % of each column of each test")
      ->type_name("WEIGHTS")
      ->capture_default_str();
  command->add_option("--rows", arguments->rows, "rows of each leg that are compared (default: 30)")
      ->type_name("NUMBER");
  command->add_flag("--brief", arguments->brief, "no profiles and no trade-off: several times faster");
  command->footer(
      "Example:\n"
      "  grainlaw polish fitted.json data/records/base -o polished.json --account polish.json\n"
      "with fitted.json from: grainlaw fit data/records/base -o fitted.json");
  return [arguments] { return run(*arguments); };
}

}  // namespace grainlaw::apps
