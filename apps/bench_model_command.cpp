// grainlaw bench model: what the law costs against the error of its integration.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>

#include "grainlaw/apps/arguments.hpp"
#include "grainlaw/apps/bench_commands.hpp"
#include "grainlaw/apps/bench_model.hpp"
#include "grainlaw/apps/bench_model_page.hpp"
#include "grainlaw/apps/locations.hpp"
#include "grainlaw/apps/report/gnuplot.hpp"
#include "grainlaw/apps/terminal.hpp"
#include "grainlaw/dem/scene/provenance.hpp"
#include "grainlaw/element/file.hpp"
#include "grainlaw/element/version.hpp"
#include "grainlaw/model/light/light_batch.hpp"

namespace grainlaw::apps {

namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::string parameters, output, seconds, points, threads;
};

ModelBench bench_of(const Arguments& arguments) {
  ModelBench bench;
  if (!arguments.seconds.empty())
    bench.seconds = read_number("--seconds", arguments.seconds, above_up_to(0, 60));
  const long most =
      arguments.points.empty() ? 1'000'000 : read_whole_number("--points", arguments.points, 1, 100'000'000);
  std::erase_if(bench.batches, [&](std::size_t n) { return n > static_cast<std::size_t>(most); });
  bench.threads = arguments.threads.empty()
                      ? static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1U, 1024U))
                      : static_cast<int>(read_whole_number("--threads", arguments.threads, 1, 1024));
  return bench;
}

/// Of a state: the history twice, what shear has left, and whether the stretch began jammed.
constexpr std::size_t memory_bytes =
    2 * sizeof(model::History) + sizeof(model::ShearHistory) + sizeof(double);

std::string spoken(const ModelTiming& t) {
  const std::string where = t.kind == "batch" ? fmt::format("{} points, {} thread{}, volume {}", t.points,
                                                            t.threads, t.threads == 1 ? "" : "s", t.path)
                                              : t.path;
  const std::string cost =
      t.ns < 1e4 ? fmt::format("{:.4g} ns", t.ns) : fmt::format("{:.4g} ms", 1e-6 * t.ns);
  const std::string error = t.error > 0 ? fmt::format("  error {:.2g}", t.error) : "";
  return fmt::format("{:9} {:44} {:16} rtol {:<7g} {:>10}{}", t.kind, where, t.method, t.rtol, cost, error);
}

int run(const Arguments& arguments) {
  const ModelBench bench = bench_of(arguments);
  report::run_gnuplot("");
  const fs::path file =
      arguments.parameters.empty() ? find_data("thesis/parameters.json") : fs::path(arguments.parameters);
  const auto parameters = model::ParameterSet::load(file);
  const fs::path dir = arguments.output.empty() ? fs::path("out/bench-model") : fs::path(arguments.output);
  fs::create_directories(dir);
  Terminal terminal;
  terminal.say(
      fmt::format("state of a point: {} bytes, of which {} are for memory, used or not; coupled form of {}, "
                  "start nu = 0.711",
                  sizeof(model::State), memory_bytes, file.string()));
  const auto timings = time_model(parameters, bench, [&](const ModelTiming& t, double done) {
    terminal.say(spoken(t));
    terminal.draw(fmt::format("{} {:.0f} %", bar_text(done, 30), 100 * done));
  });
  write_file(dir / "model-speed.csv", to_csv(timings));
  write_file(dir / "model-speed.json", Json{{"version", version()},
                                            {"commit", commit()},
                                            {"compiler", dem::compiler_name()},
                                            {"vectors", model::LightBatch::vectors()},
                                            {"parameters", parameters.name},
                                            {"written", dem::utc_now()},
                                            {"state_bytes", sizeof(model::State)},
                                            {"state_bytes_of_memory", memory_bytes}}
                                               .dump(1) +
                                           "\n");
  write_file(dir / "model-speed.svg", bench_model_picture(timings));
  terminal.say("table and picture: " + (dir / "model-speed.csv").string() + ", " +
               (dir / "model-speed.svg").string());
  return all_well;
}

}  // namespace

Action add_bench_model(CLI::App& bench) {
  CLI::App* command = bench.add_subcommand(
      "model", "What the law costs: every method and tolerance, increments, batches, and terms off and on");
  const auto arguments = std::make_shared<Arguments>();
  const auto option = [&](const char* name, std::string& value, const char* what, const char* type) {
    command->add_option(name, value, what)->type_name(type);
  };
  command->add_option("PARAMETERS.json", arguments->parameters, "parameter set (default: the thesis's)");
  option("-o,--output", arguments->output, "output directory (default: out/bench-model)", "DIR");
  option("--seconds", arguments->seconds, "repeat each timing for so long at least (default: 0.02)", "X");
  option("--points", arguments->points, "largest batch (default: 1000000)", "N");
  option("--threads", arguments->threads, "of batches, beside one (default: one per core)", "N");
  command->footer("Example:\n  grainlaw bench model -o out/bench-model");
  return [arguments] { return run(*arguments); };
}

}  // namespace grainlaw::apps
