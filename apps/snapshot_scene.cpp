#include "grainlaw/apps/snapshot_scene.hpp"

#include "grainlaw/element/error.hpp"
#include "grainlaw/element/file.hpp"

namespace grainlaw::apps {

namespace fs = std::filesystem;

fs::path scene_file_of(const std::string& snapshots, const std::string& given) {
  if (!fs::exists(snapshots)) throw Error(snapshots, "", "no such file");
  if (fs::is_directory(snapshots))
    throw Error(snapshots, "", "is a directory; the snapshots of a record are its snapshots.h5");
  if (!given.empty()) return given;
  const fs::path beside = fs::path(snapshots).parent_path() / "scene.json";
  if (!fs::exists(beside))
    throw Error(snapshots, "",
                "has no scene.json beside it that says of which material its grains are; give one with "
                "--scene");
  return beside;
}

dem::Scene scene_of_frame(const fs::path& scene_file, const std::string& snapshots,
                          const dem::FrameChoice& choice, const dem::State& state) {
  auto scene = dem::Scene::read(Reader(load_json(scene_file), scene_file.string()), scene_file.parent_path());
  scene.preparation = dem::FromSnapshot{snapshots, snapshots, choice};
  scene.check_grains(state);
  return scene;
}

}  // namespace grainlaw::apps
