// write_everything DATA DIR: writes one of everything grainlaw writes into DIR, for check_schemas.py to hold
// against the schemas.
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include "grainlaw/calibrate/campaign.hpp"
#include "grainlaw/dem/element_test.hpp"
#include "grainlaw/dem/scene.hpp"
#include "grainlaw/element/file.hpp"
#include "grainlaw/element/json.hpp"
#include "grainlaw/element/path.hpp"
#include "grainlaw/model/parameters.hpp"
#include "grainlaw/model/predict.hpp"

namespace {

using namespace grainlaw;
namespace fs = std::filesystem;

std::vector<fs::path> examples(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  return files;
}

/// Writes KIND-NAME.json, which tells check_schemas.py which schema it is under.
void write(const fs::path& dir, const std::string& kind, const fs::path& example, const Json& json) {
  write_file(dir / (kind + "-" + example.stem().string() + ".json"), json.dump(2));
}

void write_examples(const fs::path& data, const fs::path& dir) {
  const auto parameters = model::ParameterSet::load(data / "thesis" / "parameters.json");
  for (const auto& file : examples(data / "paths")) {
    const Path path = Path::read(Reader(load_json(file), file.string()));
    write(dir, "path", file, path.to_json());
    model::predict(parameters, path).record.write_csv(dir / ("record-" + file.stem().string() + ".csv"));
  }
  for (const auto& file : examples(data / "scenes"))
    write(dir, "scene", file, dem::Scene::load(file).to_json());
  for (const auto& file : examples(data / "campaigns"))
    write(dir, "campaign", file, calibrate::Campaign::load(file).to_json());
  for (const auto& file : examples(data / "thesis"))
    write(dir, "parameters", file, model::ParameterSet::load(file).to_json());
}

/// Two element tests with few grains, the second from a snapshot of the first.
void run_element_tests(const fs::path& dir) {
  const Json first = Json::parse(R"({
    "preparation": {"count": 64, "nu": 0.6, "relax": {"duration": 20}},
    "path": {"segments": [{"mode": "iso", "controls": {"nu": 0.7}, "rate": 1e-3},
                          {"mode": "relax", "duration": 20}, {"mode": "d2", "amount": 0.01, "rate": 1e-3}]},
    "measure": {"rows": 10, "snapshots": [{"segment": 2}]}})");
  dem::run_element_test(dem::Scene::read(Reader(first, "first"), dir), dir / "first");
  const Json second = Json::parse(R"({
    "preparation": {"snapshot": "first/snapshots.h5"},
    "path": {"segments": [{"mode": "d3", "amount": 0.01, "rate": 1e-3}]},
    "measure": {"rows": 3}})");
  dem::run_element_test(dem::Scene::read(Reader(second, "second"), dir), dir / "second");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fputs("usage: write_everything DATA DIR\n", stderr);
    return 2;
  }
  try {
    const fs::path dir = argv[2];
    fs::remove_all(dir);
    fs::create_directories(dir);
    write_examples(argv[1], dir);
    run_element_tests(dir);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
