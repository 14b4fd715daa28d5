#include "grainlaw/apps/stage_times.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>

#include "grainlaw/apps/terminal.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/element/file.hpp"

namespace grainlaw::apps {

namespace fs = std::filesystem;

namespace {

constexpr auto accumulating_stage = "simulate";  ///< the only one that --resume goes on with

/// Seconds of all cores that this process and the programs it has run took.
double core_seconds() {
  double sum = 0;
  for (const auto who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    struct rusage usage {};
    ::getrusage(who, &usage);
    for (const timeval& time : {usage.ru_utime, usage.ru_stime})
      sum += static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  }
  return sum;
}

/// The provenance of a record; an Error says which directory to remove where it cannot be read.
Json load_provenance(const fs::path& record) {
  try {
    return load_json(record / "provenance.json");
  } catch (const Error& error) {
    throw Error(fmt::format("{}; remove the directory {} and go on with --resume to make the record again",
                            error.what(), record.string()));
  }
}

/// One entry per record on disk, by name.
Json test_times(const fs::path& records) {
  std::vector<fs::path> folders;
  for (const auto& entry : fs::directory_iterator(records))
    if (fs::exists(entry.path() / "record.csv") && entry.path().extension() != ".part")
      folders.push_back(entry.path());
  std::sort(folders.begin(), folders.end());
  Json list = Json::array();
  for (const auto& folder : folders) {
    const Json provenance = load_provenance(folder);
    Json test{{"name", folder.filename().string()}};
    for (const char* key : {"wall_time_s", "particle_steps", "particle_steps_per_s"})
      test[key] = provenance.contains(key) ? provenance.at(key) : Json();
    list.push_back(test);
  }
  return list;
}

}  // namespace

StageTimes::StageTimes(fs::path dir, bool resumed) : dir_(std::move(dir)) {
  const fs::path file = dir_ / "timing.json";
  if (!resumed || !fs::exists(file)) return;
  try {
    stages_ = read(file);
  } catch (const Error& error) {
    Terminal().warn(fmt::format("warning: {}; times are counted anew", error.what()));
  }
}

/// The stage that goes on, if it had begun.
std::vector<StageTimes::Stage> StageTimes::read(const fs::path& file) {
  std::vector<Stage> stages;
  for (Reader& stage : Reader(load_json(file), file.string()).objects_or_none("stages"))
    if (stage.text("name") == accumulating_stage)
      stages.push_back(
          {accumulating_stage, stage.number("wall_s", at_least(0)), stage.number("core_s", at_least(0))});
  return stages;
}

void StageTimes::measure(const std::string& stage, const std::function<void()>& work) {
  auto entry =
      std::find_if(stages_.begin(), stages_.end(), [&](const Stage& one) { return one.name == stage; });
  if (entry == stages_.end()) entry = stages_.insert(stages_.end(), {stage, 0, 0});
  const auto begin = std::chrono::steady_clock::now();
  const double core_begin = core_seconds();
  const auto note = [&] {
    entry->wall_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    entry->core_s += core_seconds() - core_begin;
  };
  try {
    work();
  } catch (const Error& error) {
    note();
    if (!error.unwritable()) write();
    throw;
  }
  note();
  write();
}

double StageTimes::total_s() const {
  double sum = 0;
  for (const Stage& stage : stages_) sum += stage.wall_s;
  return sum;
}

void StageTimes::write() const {
  Json stages = Json::array();
  for (const Stage& stage : stages_)
    stages.push_back({{"name", stage.name}, {"wall_s", stage.wall_s}, {"core_s", stage.core_s}});
  write_file(dir_ / "timing.json",
             Json{{"stages", stages}, {"tests", test_times(dir_ / "records")}}.dump(2) + "\n");
}

}  // namespace grainlaw::apps
