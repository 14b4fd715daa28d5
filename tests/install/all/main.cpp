// One call into every room, the engine's kernels and files among them: usage all_rooms DATA
#include <filesystem>
#include <grainlaw/calibrate/campaign.hpp>
#include <grainlaw/dem/run/element_test.hpp>
#include <grainlaw/model/parameters.hpp>
#include <iostream>
#include <string>

int main(int, char** argv) {
  const std::filesystem::path data = argv[1];
  const auto campaign = grainlaw::calibrate::Campaign::load(data / "campaigns/quick.json");
  const auto parameters = grainlaw::model::ParameterSet::load(data / "thesis/parameters.json");
  const std::string text = R"({"preparation": {"count": 8, "rate": 1e-2, "relax": {"duration": 5}},
    "path": {"segments": [{"mode": "iso", "controls": {"nu": 0.7}, "rate": 1e-2}]},
    "measure": {"rows": 2, "snapshots": [{"segment": 0}]}})";
  const auto json = grainlaw::parse_json(text, "scene.json");
  const auto scene = grainlaw::dem::Scene::read(grainlaw::Reader(json, "scene.json"), "");
  const auto record = std::filesystem::current_path() / "record";
  std::filesystem::remove_all(record);
  if (grainlaw::dem::run_element_test(scene, record).particle_steps == 0) return 1;
  std::cout << campaign.name << ": " << campaign.tests.size() << " tests, laws of " << parameters.name
            << '\n';
  return campaign.tests.empty() ? 1 : 0;
}
