#include "grainlaw/apps/locations.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <system_error>
#include <vector>

#include "grainlaw/element/error.hpp"
#include "grainlaw/element/json.hpp"
#include "grainlaw/element/material.hpp"

namespace grainlaw::apps {

namespace fs = std::filesystem;

namespace {

std::vector<fs::path> data_folders() {
  std::vector<fs::path> folders{"data"};
  if (const char* home = std::getenv("GRAINLAW_HOME"); home != nullptr && *home != '\0')
    folders.push_back(fs::path(home) / "data");
  std::error_code code;
  const fs::path program = fs::read_symlink("/proc/self/exe", code);
  if (!code)
    for (const char* from_program :
         {"../data", GRAINLAW_DATA_FROM_PROGRAM})  // of the build tree, of an installation
      folders.push_back(program.parent_path() / from_program);
  return folders;
}

}  // namespace

fs::path find_data(const std::string& name) {
  std::error_code code;
  const auto folders = data_folders();
  for (const auto& folder : folders)
    if (fs::is_regular_file(folder / name, code)) return (folder / name).lexically_normal();
  throw Error((folders.front() / name).string(), "",
              "no such file, nor where the program was built or installed");
}

std::string program_name() {
  const char* home = std::getenv("GRAINLAW_HOME");
  if (home == nullptr || *home == '\0') return "grainlaw";
  std::error_code code;
  return fs::equivalent(home, fs::current_path(code), code) ? "./grainlaw"
                                                            : (fs::path(home) / "grainlaw").string();
}

fs::path find_thesis(double w) {
  constexpr double main_set_w = 3;
  std::error_code code;
  const fs::path main_set = find_data("thesis/parameters.json");
  if (w == main_set_w) return main_set;
  const std::string text = to_text(w) + (w == std::nearbyint(w) ? ".0" : "");
  const fs::path own = main_set.parent_path() / ("w-" + text + ".json");
  return fs::is_regular_file(own, code) ? own : main_set;
}

calibrate::MemorySources memory_sources(const fs::path& tables) {
  return {find_data("thesis/near-jamming.json"), tables};
}

double size_ratio_of_records(const fs::path& dir) {
  const fs::path records = fs::is_directory(dir / "records") ? dir / "records" : dir;
  if (!fs::is_directory(records)) throw Error(dir.string(), "", "no such directory");
  std::vector<fs::path> scenes;
  for (const auto& entry : fs::directory_iterator(records))
    if (fs::is_regular_file(entry.path() / "record.csv")) scenes.push_back(entry.path() / "scene.json");
  if (scenes.empty()) throw Error(dir.string(), "", "holds no records");
  const fs::path first = *std::min_element(scenes.begin(), scenes.end());
  return Material::read(Reader(load_json(first), first.string()).object("material")).w;
}

}  // namespace grainlaw::apps
