#include "grainlaw/apps/locations.hpp"

#include <cstdlib>
#include <system_error>
#include <vector>

#include "grainlaw/element/error.hpp"

namespace grainlaw::apps {

namespace fs = std::filesystem;

namespace {

constexpr int levels_up = 4;  // build/apps/grainlaw lies two below the source tree

std::vector<fs::path> data_folders() {
  std::vector<fs::path> folders{"data"};
  if (const char* home = std::getenv("GRAINLAW_HOME"); home != nullptr && *home != '\0')
    folders.push_back(fs::path(home) / "data");
  std::error_code code;
  const fs::path program = fs::read_symlink("/proc/self/exe", code);
  if (!code) {
    fs::path above = program.parent_path();
    folders.push_back(above / GRAINLAW_DATA_FROM_PROGRAM);
    for (int i = 0; i < levels_up && above.has_relative_path(); ++i) {
      above = above.parent_path();
      folders.push_back(above / "data");
    }
  }
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

}  // namespace grainlaw::apps
