// The program grainlaw: reads the command line, runs one subcommand and turns its errors into one line and an
// exit status.
#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <cctype>
#include <csignal>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "grainlaw/apps/commands.hpp"
#include "grainlaw/apps/terminal.hpp"
#include "grainlaw/apps/version_text.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/element/words.hpp"

namespace grainlaw::apps {

namespace {

constexpr auto description =
    "grainlaw: constitutive laws for granular matter, calibrated from the grains up.\n"
    "Simulates element tests of real grains, fits a law to them, and predicts tests that the law never saw.";

constexpr auto examples =
    "Examples:\n"
    "  grainlaw calibrate                                        the quick campaign, into out/quick\n"
    "  grainlaw calibrate mine.json -o out/mine --jobs 8         your own campaign\n"
    "  grainlaw simulate data/scenes/d2.json -o out/d2           one element test by DEM\n"
    "  grainlaw predict data/thesis/parameters.json data/paths/d2-cycle.json -o d2.csv --si\n"
    "                                                            the law along a path, stress in kPa\n"
    "  grainlaw fit out/quick -o parameters.json                 the fits alone, from records on disk\n"
    "  grainlaw polish parameters.json out/quick -o polished.json  the fit of whole paths, after it\n"
    "  grainlaw report out/quick                                 pictures and tables from what is on disk\n"
    "  grainlaw bench dem                                        what a wanted error of the DEM costs\n"
    "  grainlaw probe out/d2/snapshots.h5 -o moduli.csv          small-strain moduli of packings\n"
    "  grainlaw infer-phij out/d2/record.csv -o phij.csv         the jamming density along a record\n"
    "  grainlaw export out/d2/snapshots.h5 -o d2.vtp             a packing and its force chains, for "
    "ParaView\n"
    "  grainlaw replay failed.json                               an increment of the law that failed in a "
    "host\n"
    "File formats: docs/formats.md. Every command at length: docs/commands.md.\n"
    "Exit status: 0 well; 1 a test or an integration failed; 2 bad input or a full disk; 130 interrupted.";

/// One line on standard error, whatever the message holds.
void complain(std::string message) {
  std::replace(message.begin(), message.end(), '\n', ' ');
  std::fputs((message + "\n").c_str(), stderr);
}

/// A line for a mistake on the command line.
int complain_usage(const CLI::App& program, const std::string& what) {
  const auto chosen = program.get_subcommands();
  const std::string command = "grainlaw" + (chosen.empty() ? "" : " " + chosen.front()->get_name());
  complain(fmt::format("{}: {}; see {} --help", command, what, command));
  return bad_input;
}

/// The commands of a program, or of a command that has some itself.
std::vector<std::string> commands_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const auto* command : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  return names;
}

std::string listed(const std::vector<std::string>& names) {
  return fmt::format("{}", fmt::join(names, ", "));
}

/// The end of a complaint about `given`.
std::string hint(const std::string& given, const std::vector<std::string>& known) {
  const std::string near = nearest_word(given, known);
  return near.empty() ? "" : " (did you mean " + near + "?)";
}

/// `bench` of `grainlaw bench dem`, and `dem` of `bench`.
const CLI::App* chosen_in(const CLI::App& app) {
  const auto chosen = app.get_subcommands();
  return chosen.empty() ? nullptr : chosen.front();
}

std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

bool looks_like_option(const std::string& word) {
  return word.starts_with("--")
             ? word.size() > 2
             : word.size() > 1 && word[0] == '-' && std::isalpha(static_cast<unsigned char>(word[1])) != 0;
}

/// Whether `command`, or one within it that was named, has an option of this name.
bool has_option(const CLI::App* command, const std::string& name) {
  if (command == nullptr) return false;
  const std::vector<std::string> known = option_names(*command);
  return std::find(known.begin(), known.end(), name) != known.end() || has_option(chosen_in(*command), name);
}

/// What is wrong with an option that was left over; empty where none was.
std::string unknown_option(const CLI::App& program) {
  for (const CLI::App* app = &program; app != nullptr; app = chosen_in(*app))
    for (const std::string& left : app->remaining()) {
      const std::string name = left.substr(0, left.find('='));
      if (!looks_like_option(name)) continue;
      const CLI::App* const within = chosen_in(*app);
      if (has_option(within, name))
        return fmt::format("option {} must stand behind {}", name, within->get_name());
      return fmt::format("unknown option {}{}", name, hint(name, option_names(*app)));
    }
  return "";
}

/// What is wrong with a command line; `literal`: some of its words stand behind "--" and are no options.
std::string reason(const CLI::App& program, const CLI::ParseError& error, bool literal) {
  if (const std::string unknown = literal ? "" : unknown_option(program); !unknown.empty()) return unknown;
  const CLI::App* const chosen = chosen_in(program);
  if (chosen != nullptr && chosen_in(*chosen) == nullptr)
    if (const auto known = commands_of(*chosen); !known.empty())
      return fmt::format("must be followed by one of {}", listed(known));
  return error.what();
}

int run_command_line(int argc, char** argv) {
  CLI::App program(description, "grainlaw");
  program.footer(examples);
  program.set_version_flag("--version", version_text(), "version, commit, compiler and libraries");
  program.require_subcommand(1);
  const std::vector<Action> actions{add_calibrate(program), add_simulate(program), add_predict(program),
                                    add_fit(program),       add_polish(program),   add_report(program),
                                    add_bench(program),     add_export(program),   add_probe(program),
                                    add_replay(program),    add_infer(program)};
  const std::vector<std::string> known = commands_of(program);
  if (const std::string name = argc > 1 ? argv[1] : "-";
      name[0] != '-' && std::find(known.begin(), known.end(), name) == known.end())
    return complain_usage(program, fmt::format("unknown command \"{}\"; known are {}{}", name, listed(known),
                                               hint(name, known)));
  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& success) {  // --help, --version
    write_stdout(success.get_name() == "CallForVersion" ? success.what() : program.help());
    return all_well;
  } catch (const CLI::ParseError& error) {
    const bool literal = std::find(argv, argv + argc, std::string_view("--")) != argv + argc;
    return complain_usage(program, reason(program, error, literal));
  }
  const auto commands = program.get_subcommands([](const CLI::App*) { return true; });
  for (std::size_t i = 0; i < commands.size(); ++i)
    if (commands[i]->parsed()) return actions.at(i)();
  return bad_input;
}

}  // namespace

}  // namespace grainlaw::apps

int main(int argc, char** argv) {
  using namespace grainlaw;
  mallopt(M_MMAP_THRESHOLD, 1 << 20);  // arrays of large packings go back to the system when they are freed
  mallopt(M_TRIM_THRESHOLD, 8 << 20);  // those that a row of few grains needs do not, row by row
  std::signal(SIGXFSZ,
              SIG_IGN);  // a file that may not grow is an error like a full disk, not the end of the process
  try {
    return apps::run_command_line(argc, argv);
  } catch (const Error& error) {
    apps::complain(error.what());
    return apps::bad_input;
  } catch (const std::filesystem::filesystem_error& error) {
    apps::complain(fmt::format("{}: {}", error.path1().string(), error.code().message()));
    return apps::bad_input;
  } catch (const std::bad_alloc&) {
    apps::complain("grainlaw: out of memory");
    return apps::failed;
  } catch (const std::exception& error) {
    apps::complain(fmt::format("grainlaw: fault of the program, please report it: {}", error.what()));
    return apps::failed;
  }
}
