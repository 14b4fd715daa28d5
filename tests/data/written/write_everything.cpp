// write_everything DATA DOCUMENTS DIR: writes one of everything grainlaw writes into DIR/files, and what the
// readers say of spoilt documents into DIR/mutants, for check_schemas.py to hold against the schemas.
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include "../documents.hpp"
#include "grainlaw/calibrate/campaign.hpp"
#include "grainlaw/dem/observe/names.hpp"
#include "grainlaw/dem/run/element_test.hpp"
#include "grainlaw/dem/scene/scene.hpp"
#include "grainlaw/element/file.hpp"
#include "grainlaw/element/json.hpp"
#include "grainlaw/element/path.hpp"
#include "grainlaw/model/c/replay.hpp"
#include "grainlaw/model/parameters.hpp"
#include "grainlaw/model/predict.hpp"
#include "mutants.hpp"

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

/// An increment that a host would keep because it failed.
Json refused_increment(const model::ParameterSet& parameters) {
  model::CoaxialSettings settings;
  settings.axis = {-1, 1, 0, 0, 0, 0};
  const auto begin = model::CoaxialLaw(parameters, settings).start(Start{0.711, {}, {}, {}, {}, {}});
  return model::Replay{parameters,     settings, begin.state, {0, 0, 1e-3, 0, 0, 0}, false, "not_coaxial",
                       "another axis", "0.1.0",  "unknown"}
      .to_json();
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
  write(dir, "replay", "d2.json", refused_increment(parameters));
}

/// Element tests with few grains, the others from a snapshot of the first.
void run_element_tests(const fs::path& dir) {
  const Json first = Json::parse(R"({
    "preparation": {"count": 64, "nu": 0.6, "relax": {"duration": 20}},
    "path": {"segments": [{"mode": "iso", "controls": {"nu": 0.7}, "rate": 1e-3},
                          {"mode": "relax", "duration": 20}, {"mode": "d2", "amount": 0.01, "rate": 1e-3}]},
    "measure": {"rows": 10, "snapshots": [{"segment": 2}],
                "moduli": [{"segment": 0, "nu": 0.61}, {"segment": 1}, {"segment": 2}]}})");
  dem::run_element_test(dem::Scene::read(Reader(first, "first"), dir), dir / "first");
  Json second = Json::parse(R"({
    "preparation": {"snapshot": "first/snapshots.h5"},
    "path": {"segments": [{"mode": "d3", "amount": 0.01, "rate": 1e-3}]},
    "measure": {"rows": 3}})");
  for (const auto& name : dem::observe::names()) second["measure"]["observe"].push_back(name);
  dem::run_element_test(dem::Scene::read(Reader(second, "second"), dir), dir / "second");
  second["measure"] = {{"rows", 3}, {"standard", {"coordination"}}};
  dem::run_element_test(dem::Scene::read(Reader(second, "third"), dir), dir / "third");
}

/// The documents that a table accepts.
std::vector<Json> good_documents(const Json& table, const Json& base) {
  std::vector<Json> list;
  for (const Json& one : table.at("accept")) list.push_back(tests::edited(base, one));
  return list;
}

void write_mutants(const fs::path& data, const fs::path& documents, const fs::path& dir) {
  const auto write = [&](const std::string& kind, const std::vector<Json>& good, const tests::Read& read) {
    write_file(dir / (kind + ".json"), tests::mutants(good, kind + ".json", read).dump(1));
  };
  const auto good = [&](const std::string& kind) {
    const Json table = load_json(documents / (kind + ".json"));
    return good_documents(table, tests::base_of(table, data));
  };
  write("path", good("path"), [](Reader reader) { Path::read(reader); });
  write("scene", good("scene"), [](Reader reader) { dem::Scene::read(reader, "."); });
  write("campaign", good("campaign"), [](Reader reader) { calibrate::Campaign::read(reader); });
  Json one_row = load_json(data / "thesis" / "parameters.json");  // the other rows are like these
  for (const char* mode : {"uni", "d2", "d3"}) one_row["isotropic"].erase(mode);
  for (const char* quantity : {"beta_s", "F_max", "beta_F"}) one_row["shear"].erase(quantity);
  write("parameters", {one_row}, [](Reader reader) { model::ParameterSet::read(reader); });
  Json replay = refused_increment(model::ParameterSet::load(data / "thesis" / "parameters.json"));
  for (const char* group : {"isotropic", "shear", "moduli", "memory"}) replay["parameters"].erase(group);
  write("replay", {replay}, [](Reader reader) { model::Replay::read(reader); });
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fputs("usage: write_everything DATA DOCUMENTS DIR\n", stderr);
    return 2;
  }
  try {
    const fs::path dir = argv[3];
    fs::remove_all(dir);
    fs::create_directories(dir / "files");
    fs::create_directories(dir / "mutants");
    write_examples(argv[1], dir / "files");
    run_element_tests(dir / "files");
    write_mutants(argv[1], argv[2], dir / "mutants");
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
