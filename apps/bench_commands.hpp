// The subcommands of `grainlaw bench`.
#pragma once

#include "grainlaw/apps/commands.hpp"

namespace grainlaw::apps {

Action add_bench_dem(CLI::App& bench);
Action add_bench_model(CLI::App& bench);

}  // namespace grainlaw::apps
