// grainlaw bench: speed against error, of the grains and of the law.
#include "grainlaw/apps/bench_commands.hpp"

namespace grainlaw::apps {

Action add_bench(CLI::App& program) {
  CLI::App* bench = program.add_subcommand("bench", "Measures the program: speed against error");
  bench->require_subcommand(1);
  bench->footer("Examples:\n  grainlaw bench dem\n  grainlaw bench model");
  const Action dem = add_bench_dem(*bench), model = add_bench_model(*bench);
  return [bench, dem, model] { return bench->got_subcommand("dem") ? dem() : model(); };
}

}  // namespace grainlaw::apps
