// The schemas state the defaults and columns that the program has.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <set>

#include "grainlaw/calibrate/campaign.hpp"
#include "grainlaw/calibrate/memory_tables.hpp"
#include "grainlaw/dem/observe/observers.hpp"
#include "grainlaw/dem/scene/provenance.hpp"
#include "grainlaw/dem/scene/scene.hpp"
#include "grainlaw/element/column_groups.hpp"
#include "grainlaw/element/json.hpp"
#include "grainlaw/element/moduli_table.hpp"
#include "grainlaw/element/path.hpp"
#include "grainlaw/element/record.hpp"
#include "grainlaw/model/c/replay.hpp"

namespace grainlaw::tests {
namespace {

Json schema(const std::string& kind) {
  return load_json(std::filesystem::path(GRAINLAW_DATA_DIR) / "schema" / (kind + ".schema.json"));
}

std::vector<std::string> keys(const Json& object) {
  std::vector<std::string> names;
  for (const auto& [name, value] : object.items()) names.push_back(name);
  return names;
}

/// The default that a property states, itself or by its reference into the same file or path.schema.json.
Json default_of(const Json& property, const Json& file) {
  if (property.contains("default")) return property["default"];
  const std::string reference = property.at("$ref");
  const auto hash = reference.find('#');
  const Json other = hash == 0 ? file : schema(reference.substr(0, reference.find('.')));
  return default_of(other.at(Json::json_pointer(reference.substr(hash + 1))), other);
}

/// Every key of `written` but those excepted has this default in `properties`.
void expect_defaults(const Json& written, const Json& properties, const Json& file,
                     const std::set<std::string>& except = {}) {
  for (const auto& [key, value] : written.items())
    if (!except.contains(key)) {
      EXPECT_EQ(default_of(properties.at(key), file), value) << key;
    }
}

dem::Scene plain_scene() {
  const Json json = Json::parse(R"({"path": {"segments": [{"mode": "iso", "amount": 0.1}]}})");
  return dem::Scene::read(Reader(json, "scene.json"), ".");
}

TEST(Schema, DefaultsOfAScene) {
  const Json file = schema("scene"), written = plain_scene().to_json();
  expect_defaults(written["material"], file["$defs"]["material"]["properties"], file);
  expect_defaults(written["measure"], file["$defs"]["measure"]["properties"], file);
  const Json packing = file["$defs"]["packing_keys"]["properties"];
  expect_defaults(written["preparation"], packing, file, {"seed", "relax"});
  expect_defaults(written["preparation"]["relax"], packing["relax"]["properties"], file);
  EXPECT_EQ(file["$defs"]["new_packing"]["properties"]["seed"]["default"], written["preparation"]["seed"]);
  EXPECT_EQ(keys(file["properties"]), keys(written));
}

TEST(Schema, DefaultsOfAPath) {
  const Json file = schema("path");
  const auto path_of = [](const char* text) {
    return Path::read(Reader(Json::parse(text), "path.json")).segments.at(0);
  };
  const auto relax = path_of(R"({"segments": [{"mode": "relax"}]})");
  EXPECT_EQ(file["$defs"]["tolerance"]["default"], relax.tolerance);
  EXPECT_EQ(file["$defs"]["longest"]["default"], *relax.duration);
  const std::string rate = file["$defs"]["rate"]["description"],
                    profile = file["$defs"]["profile"]["description"];
  const auto iso = path_of(R"({"segments": [{"mode": "iso", "amount": 0.1}]})"),
             uni = path_of(R"({"segments": [{"mode": "uni", "amount": 0.1}]})"),
             d2 = path_of(R"({"segments": [{"mode": "d2", "amount": 0.1}]})"),
             d3 = path_of(R"({"segments": [{"mode": "d3", "amount": 0.1}]})");
  EXPECT_THAT(rate, testing::HasSubstr("Default: 5.0e-6 for iso and isotropic_stress, else 2.839e-5."));
  EXPECT_EQ(iso.rate, 5.0e-6);
  for (const auto& other : {uni, d2, d3}) EXPECT_EQ(other.rate, 2.839e-5);
  EXPECT_THAT(profile, testing::HasSubstr("Default: cosine for iso, uni and components, else constant."));
  for (const auto& shear : {d2, d3}) EXPECT_EQ(shear.profile, Profile::constant);
  for (const auto& other : {iso, uni}) EXPECT_EQ(other.profile, Profile::cosine);
}

TEST(Schema, KeysOfACampaign) {
  const Json file = schema("campaign");
  const auto campaign = calibrate::Campaign::load(std::string(GRAINLAW_DATA_DIR) + "/campaigns/quick.json");
  const Json written = campaign.to_json();
  EXPECT_EQ(keys(file["properties"]), keys(written));
  EXPECT_EQ(keys(schema("scene")["$defs"]["packing_keys"]["properties"]), keys(written["preparation"]));
}

TEST(Schema, KeysOfProvenance) {
  dem::Provenance provenance = dem::Provenance::begin(plain_scene());
  const Json file = schema("provenance");
  EXPECT_EQ(file["required"].get<std::vector<std::string>>(), keys(provenance.to_json()));
  provenance.cut_short = "the target is out of reach";
  EXPECT_EQ(keys(file["properties"]), keys(provenance.to_json()));
}

TEST(Schema, Observers) {
  const Json known = schema("scene")["$defs"]["measure"]["properties"]["observe"]["items"]["enum"];
  EXPECT_EQ(known.get<std::vector<std::string>>(), dem::observe::names());
  const dem::observe::Observers all(dem::observe::names());
  for (const auto& table : all.tables()) {
    const Json file = schema(table.file.substr(0, table.file.find('.')));
    EXPECT_EQ(keys(file["properties"]), table.rows.columns()) << table.file;
    EXPECT_EQ(file["required"].get<std::vector<std::string>>(), table.rows.columns()) << table.file;
  }
}

TEST(Schema, KeysOfAReplay) {
  model::Replay replay;
  const Json file = schema("replay"), written = replay.to_json();
  EXPECT_EQ(keys(file["properties"]), keys(written));
  EXPECT_EQ(keys(file["properties"]["state"]["properties"]), keys(written["state"]));
}

TEST(Schema, ColumnsOfTheTablesOfMemory) {
  EXPECT_EQ(keys(schema("over_compression")["properties"]), calibrate::over_compression_table({}).columns());
  EXPECT_EQ(keys(schema("shear_jamming")["properties"]), calibrate::shear_jamming_table({}).columns());
  EXPECT_EQ(schema("over_compression")["required"].get<std::vector<std::string>>(),
            calibrate::over_compression_table({}).columns());
  EXPECT_EQ(schema("shear_jamming")["required"].get<std::vector<std::string>>(),
            calibrate::shear_jamming_table({}).columns());
  EXPECT_EQ(schema("relaxed")["required"].get<std::vector<std::string>>(),
            calibrate::relaxed_table({}).columns());
  EXPECT_EQ(schema("tapped")["required"].get<std::vector<std::string>>(),
            calibrate::tapped_table({}).columns());
  for (const char* kind : {"relaxed", "tapped"})
    EXPECT_EQ(keys(schema(kind)["properties"]), schema(kind)["required"].get<std::vector<std::string>>());
}

TEST(Schema, ColumnsOfATableOfModuli) {
  std::vector<std::string> columns = moduli_columns();
  columns.insert(columns.end(), undo_columns().begin(), undo_columns().end());
  for (const ElasticGroup& group : elastic_groups())
    columns.insert(columns.end(), group.columns.begin(), group.columns.end());
  EXPECT_EQ(keys(schema("moduli")["properties"]), columns);
}

TEST(Schema, ColumnsOfARecord) {
  const Json file = schema("record");
  auto columns = record_columns();
  for (const auto& column : dem::observe::columns(dem::observe::names())) columns.push_back(column);
  EXPECT_EQ(keys(file["properties"]), columns);
  // Those of a prediction: the ones of no group, and the rest of them where it is no DEM record.
  std::set<std::string> required;
  for (const Json& list : {file["required"], file["else"]["required"]})
    for (const auto& column : list) required.insert(column);
  EXPECT_EQ(required, std::set<std::string>(prediction_columns().begin(), prediction_columns().end()));
}

/// Each column of a group asks for all others, if by way of its first.
TEST(Schema, GroupsOfColumnsOfARecord) {
  const Json needed = schema("record")["then"]["dependentRequired"];
  std::map<std::string, std::vector<std::string>> groups;
  for (const std::string& column : record_columns())
    if (const std::string group = group_of_column(column); !group.empty()) groups[group].push_back(column);
  EXPECT_EQ(keys(Json(groups)).size(), column_groups().size());
  for (const auto& [group, columns] : groups) {
    const std::vector<std::string> others(columns.begin() + 1, columns.end());
    if (others.empty()) continue;
    EXPECT_EQ(needed.at(columns[0]).get<std::vector<std::string>>(), others) << group;
    for (const std::string& other : others) EXPECT_EQ(needed.at(other), Json::array({columns[0]})) << other;
  }
  const Json asked = schema("scene")["$defs"]["measure"]["properties"]["standard"];
  EXPECT_EQ(asked["items"]["enum"].get<std::vector<std::string>>(), column_groups());
}

}  // namespace
}  // namespace grainlaw::tests
