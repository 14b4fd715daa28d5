// What observers cost, and whether grainlaw simulate --explain says so.
// Usage: grainlaw_bench_observers [COUNT] [ROUNDS]
//        grainlaw_bench_observers memory
//
// Prints the time of a whole test, measured and as explained; the bare scene against the kernel's own loop;
// a step of the bare scene, a row of the standard columns, of each group of them alone and of none, and what
// each observer alone adds to a row, measured and as explained; and the same test with each other option
// alone. Processor seconds of this thread, medians over the rounds; ratios round by round, median and range.
// What is told as a range has it in a line of its own. All but the first test begin from one snapshot, whose
// grains are what the trials have, too. Steps and rows are explained by trials alone, as of scenes too long to
// be run to be explained. With `memory`, the most memory of runs against what --explain says, each run in a
// process of its own.
#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "grainlaw/dem/drive/stage.hpp"
#include "grainlaw/dem/files/snapshot.hpp"
#include "grainlaw/dem/observe/names.hpp"
#include "grainlaw/dem/run/cost.hpp"
#include "grainlaw/dem/run/element_test.hpp"
#include "grainlaw/dem/run/leg_trial.hpp"
#include "grainlaw/dem/run/measured_cost.hpp"
#include "grainlaw/dem/step/dynamics.hpp"
#include "grainlaw/element/column_groups.hpp"
#include "grainlaw/element/error.hpp"

namespace {

using namespace grainlaw;
namespace fs = std::filesystem;

constexpr double long_strain = 0.02;    // to compare steps
constexpr double begun_strain = 0.002;  // what is left beyond it is steps alone
constexpr double short_strain =
    0.0024;  // to compare rows: there is one after every other step, and as many steps without
constexpr std::int64_t rows = 500;
constexpr dem::CostOptions by_trial{1, 60, 1e-3};  // nothing is run as a whole

double median(std::vector<double> list) {
  std::sort(list.begin(), list.end());
  return list[list.size() / 2];
}

dem::Scene scene(const std::string& json) {
  return dem::Scene::read(Reader(parse_json(json, "bench"), "bench"), "");
}

/// A D2 test from the packing in `snapshot`.
dem::Scene shear(const fs::path& snapshot, double strain, std::int64_t with_rows,
                 const std::string& observer = "") {
  return scene(R"({"preparation": {"snapshot": ")" + snapshot.string() +
               R"("}, "path": {"segments": [{"mode": "d2", "amount": )" + std::to_string(strain) +
               R"(}]}, "measure": {"rows": )" + std::to_string(with_rows) + R"(, "observe": [)" +
               (observer.empty() ? "" : "\"" + observer + "\"") + "]}}");
}

double seconds_to_run(const dem::Scene& test, const fs::path& dir) {
  const double begin = dem::thread_seconds();
  dem::run_element_test(test, dir);
  const double spent = dem::thread_seconds() - begin;
  fs::remove_all(dir);
  return spent;
}

dem::Stage stage_of(const dem::Scene& test, const dem::State& state) {
  const dem::LongestSteps longest(test, *std::min_element(state.radius.begin(), state.radius.end()));
  return dem::plan_stages(test, state.volume_fraction(), longest).at(0);
}

/// The same steps by the kernel alone, to the last bit, for another flow has other avalanches and costs some
/// percent more or less: no plan, no rows, no files.
double seconds_of_kernel(const dem::Scene& test, const fs::path& snapshot) {
  const dem::Stage stage = stage_of(test, dem::read_frame(snapshot, {}));
  const double dt = stage.stepping.dt, begin = dem::thread_seconds();
  dem::Dynamics dynamics(test.material, dem::read_frame(snapshot, {}));
  const dem::Drive box(dynamics.cell().edges(), stage.leg);
  dynamics.start_flow(dt, box.gradient(0, dt));
  for (std::uint64_t n = 1; n <= stage.stepping.steps; ++n) {
    const double t = static_cast<double>(n) * dt;
    dynamics.step(box.edges(t), box.gradient(t, dt));
  }
  return dem::thread_seconds() - begin;
}

/// The number that a process of its own prints.
double answer_of(const std::string& command) {
  std::FILE* const child = ::popen(command.c_str(), "r");
  double number = 0;
  const bool told = child != nullptr && std::fscanf(child, "%lf", &number) == 1;
  if (child != nullptr) ::pclose(child);
  if (!told) throw Error("no answer from: " + command);
  return number;
}

/// Seconds of the bare scene ("bare") or of the kernel's loop ("kernel"), in a process of its own: where
/// arrays lie depends on what a process did before, and that makes some percent.
double seconds_apart(const std::string& what, const fs::path& snapshot, double strain) {
  const std::string command = "'" + fs::read_symlink("/proc/self/exe").string() + "' --apart " + what + " '" +
                              snapshot.string() + "' " + std::to_string(strain);
  return answer_of(command);
}

/// What that process does.
int answer(const std::string& what, const fs::path& snapshot, double strain) {
  const dem::Scene test = shear(snapshot, strain, 1);
  const fs::path dir = snapshot.parent_path() / ("apart-" + std::to_string(::getpid()));
  std::printf("%.9f\n", what == "kernel" ? seconds_of_kernel(test, snapshot) : seconds_to_run(test, dir));
  return 0;
}

using Times = std::map<std::string, std::vector<double>>;

/// Gas, compression and shear, with relaxations that last as long as they are planned: what was measured and
/// said.
void compare_preparation(const std::string& count, const fs::path& dir) {
  const dem::Scene prepare = scene(R"({"preparation": {"count": )" + count + R"(, "rate": 1e-3,
    "relax": {"tolerance": 1e-300, "duration": 100}}, "path": {"segments": [
      {"mode": "iso", "controls": {"nu": 0.75}, "rate": 2e-4}, {"mode": "relax", "tolerance": 1e-300, "duration": 300},
      {"mode": "d2", "amount": 0.02, "rate": 1e-4}]}, "measure": {"rows": 1, "snapshots": [{"segment": 2}]}})");
  const double said = dem::cost_of(prepare, by_trial).seconds();
  const double begin = dem::thread_seconds();
  const auto summary = dem::run_element_test(prepare, dir);
  const double spent = dem::thread_seconds() - begin;
  std::printf("%s grains, from gas to shear, %.3g particle-steps: %.2f s, explained %.2f s: ratio %.2f\n",
              count.c_str(), static_cast<double>(summary.particle_steps), spent, said, said / spent);
}

/// What a scene may ask for besides observers, each alone: segments, and more of `measure`.
std::map<std::string, dem::Scene> options(const fs::path& snapshot) {
  const auto with = [&](const std::string& segment, const std::string& measure) {
    return scene(R"({"preparation": {"snapshot": ")" + snapshot.string() + R"("}, "path": {"segments": [)" +
                 segment + R"(]}, "measure": {"rows": 20)" + measure + "}}");
  };
  const std::string d2 = R"({"mode": "d2", "amount": 0.02})";
  const auto states = [](int count) {
    std::string list;
    for (int k = 1; k <= count; ++k)
      list +=
          (k == 1 ? "" : ", ") + (R"({"segment": 0, "eps_dev": )" + std::to_string(0.02 * k / count) + "}");
    return "[" + list + "]";
  };
  const std::string shear_of_tilt =
      R"({"mode": "components", "strain": [0, 0, 0, 0, 0, 0.0115], "rate": 1.6e-5})";
  return {{"20 rows alone", with(d2, "")},
          {"50 snapshots", with(d2, R"(, "snapshots": )" + states(50))},
          {"10 states of moduli", with(d2, R"(, "moduli": )" + states(10))},
          {"tilted box", with(shear_of_tilt, "")},
          {"constant_p", with(R"({"mode": "constant_p", "amount": 0.02})", "")},
          {"biaxial", with(R"({"mode": "biaxial", "amount": 0.02})", "")},
          {"triaxial", with(R"({"mode": "triaxial", "amount": 0.02})", "")},
          {"steered", with(R"({"mode": "d2", "amount": 0.02, "profile": "steered"})", "")},
          {"quasistatic", with(R"({"mode": "d2", "amount": 0.02, "profile": "quasistatic"})", "")}};
}

constexpr std::int64_t memory_grains = 60000, empty_grains = 100;

/// What holds memory, each alone: name, threads and scene. The flow is fast, for memory does not mind.
struct MemoryCase {
  std::string name;
  int threads;
  dem::Scene test;
};

std::vector<MemoryCase> memory_cases(std::int64_t grains) {
  const auto with = [&](const std::string& segment, const std::string& measure) {
    return scene(R"({"material": {"w": 3}, "preparation": {"count": )" + std::to_string(grains) +
                 R"(, "nu": 0.8, "rate": 0.2, "relax": {"tolerance": 1e-300, "duration": 1}},
      "path": {"segments": [)" +
                 segment + R"(]}, "measure": {"rows": 3)" + measure + "}}");
  };
  const std::string iso = R"({"mode": "iso", "controls": {"nu": 0.82}, "rate": 0.01})";
  dem::Scene all = with(iso, "");
  all.measure.observe = dem::observe::names();
  return {{"bare", 1, with(iso, "")},
          {"2 threads", 2, with(iso, "")},
          {"a snapshot", 1, with(iso, R"(, "snapshots": [{"segment": 0}])")},
          {"nonaffine", 1, with(iso, R"(, "observe": ["nonaffine"])")},
          {"all observers", 1, all},
          {"moduli", 1, with(iso, R"(, "moduli": [{"segment": 0}])")},
          {"quasistatic", 1, with(iso + R"(, {"mode": "relax", "residual": 1e-3})", "")}};
}

/// The most memory of a run in a process of its own, in bytes.
double peak_apart(std::int64_t grains, std::size_t of, const fs::path& dir) {
  const std::string command = "'" + fs::read_symlink("/proc/self/exe").string() + "' --memory " +
                              std::to_string(grains) + " " + std::to_string(of) + " '" + dir.string() + "'";
  return answer_of(command);
}

int answer_memory(std::int64_t grains, std::size_t of, const fs::path& dir) {
  const MemoryCase one = memory_cases(grains).at(of);
  dem::RunHooks hooks;
  hooks.threads = one.threads;
  dem::run_element_test(one.test, dir, hooks);
  fs::remove_all(dir);
  rusage used{};
  ::getrusage(RUSAGE_SELF, &used);
  std::printf("%.9g\n", 1024 * static_cast<double>(used.ru_maxrss));
  return 0;
}

/// Peaks beyond those of the same run with next to no grains, and what --explain says.
void compare_memory(const fs::path& dir) {
  std::printf("memory of %lld grains:     measured MB explained MB ratio\n",
              static_cast<long long>(memory_grains));
  const std::vector<MemoryCase> cases = memory_cases(memory_grains);
  for (std::size_t k = 0; k < cases.size(); ++k) {
    const double empty = peak_apart(empty_grains, k, dir), whole = peak_apart(memory_grains, k, dir);
    // Little is run: memory is known from the trials, and from the runs above what is held.
    const double said = dem::cost_of(cases[k].test, {cases[k].threads, 60, 1.0}).bytes();
    std::printf("%-24s %12.1f %12.1f %6.2f\n", cases[k].name.c_str(), 1e-6 * (whole - empty), 1e-6 * said,
                said / (whole - empty));
    std::fflush(stdout);
  }
}

/// A row of the standard columns: of all, of each group alone, and of none.
std::vector<std::pair<std::string, std::vector<std::string>>> row_kinds() {
  std::vector<std::pair<std::string, std::vector<std::string>>> kinds{{"standard columns", column_groups()}};
  for (const std::string& group : column_groups()) kinds.push_back({group + " alone", {group}});
  kinds.push_back({"no standard columns", {}});
  return kinds;
}

void measure_rows(const fs::path& snapshot, const fs::path& dir, Times& spent, Times& said) {
  for (const auto& [name, standard] : row_kinds()) {
    dem::Scene with = shear(snapshot, short_strain, rows), without = shear(snapshot, short_strain, 1);
    with.measure.standard = without.measure.standard = standard;
    const double beside = seconds_to_run(without, dir);
    spent[name].push_back((seconds_to_run(with, dir) - beside) / static_cast<double>(rows - 1));
    said[name].push_back(dem::cost_of(with, by_trial).row_seconds);
  }
}

/// One round: each scene once, and once what --explain says of it.
void measure_round(const fs::path& snapshot, const fs::path& dir, std::uint64_t& steps, Times& spent,
                   Times& said) {
  const dem::Scene bare = shear(snapshot, long_strain, 1);
  steps = stage_of(bare, dem::read_frame(snapshot, {})).stepping.steps;
  // In turns that begin and end alike, so that a drift of the machine's speed favours neither.
  const auto twice = [&](double strain) {
    double kernel = seconds_apart("kernel", snapshot, strain);
    const double runs = seconds_apart("bare", snapshot, strain) + seconds_apart("bare", snapshot, strain);
    kernel += seconds_apart("kernel", snapshot, strain);
    return std::pair{kernel / 2, runs / 2};
  };
  const auto [kernel, run] = twice(long_strain);
  const auto [kernel_begun, run_begun] = twice(begun_strain);
  spent["kernel"].push_back(kernel);
  spent["bare"].push_back(run);
  spent["kernel going on"].push_back(kernel - kernel_begun);
  spent["bare going on"].push_back(run - run_begun);
  said["bare"].push_back(dem::cost_of(bare, by_trial).seconds());
  measure_rows(snapshot, dir, spent, said);
  dem::Scene all = shear(snapshot, short_strain, rows);
  all.measure.observe = dem::observe::names();
  const dem::SceneCost cost = dem::cost_of(all, by_trial);
  for (const auto& observer : cost.observers) {
    // Each beside its own run without: a machine's speed drifts within a round.
    const double with = seconds_to_run(shear(snapshot, short_strain, rows, observer.name), dir);
    const double beside = seconds_to_run(shear(snapshot, short_strain, rows), dir);
    spent[observer.name].push_back((with - beside) / static_cast<double>(rows + 1));
    said[observer.name].push_back(observer.seconds_per_row);
  }
  for (const auto& [name, test] : options(snapshot)) {
    spent[name].push_back(seconds_to_run(test, dir));
    const bool told_by_trial = !dem::needs_trial(stage_of(test, dem::read_frame(snapshot, {})));
    const dem::SceneCost told = dem::cost_of(test, told_by_trial ? by_trial : dem::CostOptions{});
    said[name].push_back(told.seconds());
    said[name + ", least"].push_back(told.least());
    said[name + ", most"].push_back(told.most());
  }
}

struct Ratios {
  double middle, least, most;
};

/// Round by round: a machine's speed drifts from one to the next.
Ratios ratios_of(const std::vector<double>& over, const std::vector<double>& under) {
  std::vector<double> ratios;
  for (std::size_t k = 0; k < over.size(); ++k) ratios.push_back(over[k] / under[k]);
  const auto [least, most] = std::minmax_element(ratios.begin(), ratios.end());
  return {median(ratios), *least, *most};
}

void print(const Times& spent, const Times& said, std::uint64_t steps, const fs::path& snapshot) {
  const Ratios bare = ratios_of(spent.at("bare"), spent.at("kernel"));
  std::printf("bare scene over the kernel's own loop: %.3f (%.3f-%.3f), begin and files included\n",
              bare.middle, bare.least, bare.most);
  const Ratios on = ratios_of(spent.at("bare going on"), spent.at("kernel going on"));
  std::printf("its steps over the loop's: %.3f (%.3f-%.3f)\n", on.middle, on.least, on.most);
  const double step = median(spent.at("kernel")) / static_cast<double>(steps);
  std::printf("%-24s %12s %12s %20s %10s\n", "", "measured us", "explained us", "ratio", "in steps");
  const auto line = [&](const std::string& name, double divisor) {
    const double measured = median(spent.at(name)) / divisor, explained = median(said.at(name)) / divisor;
    const Ratios ratio = ratios_of(said.at(name), spent.at(name));
    std::printf("%-24s %12.1f %12.1f %6.2f (%5.2f-%5.2f) %10.2f\n", name.c_str(), 1e6 * measured,
                1e6 * explained, ratio.middle, ratio.least, ratio.most, measured / step);
  };
  line("bare", static_cast<double>(steps));
  for (const auto& [name, standard] : row_kinds()) line(name, 1);
  for (const auto& name : dem::observe::names()) line(name, 1);
  std::printf("rows over one of all standard columns:\n");
  for (const auto& [name, standard] : row_kinds()) {
    const Ratios share = ratios_of(spent.at(name), spent.at("standard columns"));
    std::printf("%-24s %.3f (%.3f-%.3f)\n", name.c_str(), share.middle, share.least, share.most);
  }
  std::printf("whole tests, each with one option:\n");
  for (const auto& [name, test] : options(snapshot)) {
    line(name, 1);
    const std::vector<double>&least = said.at(name + ", least"), &most = said.at(name + ", most");
    std::size_t within = 0;
    for (std::size_t k = 0; k < least.size(); ++k)
      within += least[k] <= spent.at(name)[k] && spent.at(name)[k] <= most[k];
    if (median(least) < 0.99 * median(most))
      std::printf("%24s as a range, last of %.3g to %.3g s; %zu of %zu within\n", "", least.back(),
                  most.back(), within, least.size());
  }
}

}  // namespace

int main(int argc, char** argv) {
  ::mallopt(M_MMAP_THRESHOLD, 1 << 20);  // as grainlaw does
  ::mallopt(M_TRIM_THRESHOLD, 8 << 20);
  if (argc == 5 && std::string(argv[1]) == "--memory")
    return answer_memory(std::atoll(argv[2]), static_cast<std::size_t>(std::atoll(argv[3])), argv[4]);
  if (argc == 5 && std::string(argv[1]) == "--apart") return answer(argv[2], argv[3], std::atof(argv[4]));
  const std::string count = argc > 1 ? argv[1] : "2000";
  const int rounds = argc > 2 ? std::atoi(argv[2]) : 5;
  const fs::path dir = fs::temp_directory_path() / ("grainlaw-bench-observers-" + std::to_string(::getpid()));
  fs::create_directories(dir);
  if (count == "memory") {
    compare_memory(dir / "memory");
    fs::remove_all(dir);
    return 0;
  }
  compare_preparation(count, dir / "prepare");
  Times spent, said;
  std::uint64_t steps = 0;
  for (int round = 0; round < rounds; ++round)
    measure_round(dir / "prepare" / "snapshots.h5", dir / "run", steps, spent, said);
  print(spent, said, steps, dir / "prepare" / "snapshots.h5");
  fs::remove_all(dir);
}
