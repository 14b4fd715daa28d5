// The readers and the schemas accept and refuse the same documents: this test holds the tables in documents/
// against the readers, check_schemas.py holds them against the schemas.
#include "documents.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>

#include "grainlaw/calibrate/campaign.hpp"
#include "grainlaw/dem/scene/scene.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/element/json.hpp"
#include "grainlaw/element/path.hpp"
#include "grainlaw/model/parameters.hpp"

namespace grainlaw::tests {
namespace {

const std::filesystem::path data = GRAINLAW_DATA_DIR;
const std::filesystem::path documents = GRAINLAW_DOCUMENTS_DIR;

using Read = std::function<void(Reader)>;

/// What a reader says of a document: empty if it accepts it.
std::string complaint(const Read& read, const Json& document, const std::string& file) {
  try {
    read(Reader(document, file));
    return "";
  } catch (const Error& error) {
    EXPECT_EQ(error.file(), file) << error.what();
    return error.what();
  }
}

void check(const std::string& kind, const Read& read) {
  const Json table = load_json(documents / (kind + ".json"));
  const Json base = base_of(table, data);
  for (const char* verdict : {"accept", "reject", "reject by program"})
    for (const auto& one : table.at(verdict)) {
      const std::string said = complaint(read, edited(base, one), kind + ".json");
      EXPECT_EQ(said.empty(), std::string(verdict) == "accept")
          << kind << ": " << one.at("name") << ": " << said;
    }
}

TEST(Documents, Path) {
  check("path", [](Reader reader) { Path::read(reader); });
}

TEST(Documents, Scene) {
  check("scene", [](Reader reader) { dem::Scene::read(reader, "."); });
}

TEST(Documents, Campaign) {
  check("campaign", [](Reader reader) { calibrate::Campaign::read(reader); });
}

TEST(Documents, Parameters) {
  check("parameters", [](Reader reader) { model::ParameterSet::read(reader); });
}

}  // namespace
}  // namespace grainlaw::tests
