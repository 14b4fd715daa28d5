// The subcommands of the program grainlaw: each has a file of its own that declares its arguments and does
// its work.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace grainlaw::apps {

/// Exit statuses of the program.
inline constexpr int all_well = 0;
inline constexpr int failed = 1;         ///< a test or an integration failed, or a fault of the program
inline constexpr int bad_input = 2;      ///< what was given cannot be used, or a file cannot be written
inline constexpr int interrupted = 130;  ///< by Ctrl-C or SIGTERM

/// Does the work of a subcommand once its arguments are read; returns the exit status. Throws Error for bad
/// input.
using Action = std::function<int()>;

/// Each adds its subcommand to the program.
Action add_calibrate(CLI::App& program);
Action add_simulate(CLI::App& program);
Action add_predict(CLI::App& program);
Action add_fit(CLI::App& program);
Action add_polish(CLI::App& program);
Action add_report(CLI::App& program);
Action add_bench(CLI::App& program);
Action add_export(CLI::App& program);
Action add_probe(CLI::App& program);
Action add_replay(CLI::App& program);
Action add_infer(CLI::App& program);

}  // namespace grainlaw::apps
