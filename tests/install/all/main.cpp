// One call into every room: usage all_rooms DATA
#include <filesystem>
#include <grainlaw/calibrate/campaign.hpp>
#include <grainlaw/dem/scene.hpp>
#include <grainlaw/model/parameters.hpp>
#include <iostream>

int main(int, char** argv) {
  const std::filesystem::path data = argv[1];
  const auto campaign = grainlaw::calibrate::Campaign::load(data / "campaigns/quick.json");
  const auto parameters = grainlaw::model::ParameterSet::load(data / "thesis/parameters.json");
  std::cout << campaign.name << ": " << campaign.tests.size() << " tests, laws of " << parameters.name
            << '\n';
  return campaign.tests.empty() ? 1 : 0;
}
