#include "grainlaw/calibrate/campaign.hpp"

#include <algorithm>
#include <cmath>

#include "grainlaw/calibrate/campaign_origins.hpp"
#include "grainlaw/element/column_groups.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/element/json_difference.hpp"

namespace grainlaw::calibrate {

namespace {

constexpr std::int64_t largest_seed = std::int64_t{1} << 53;
constexpr std::size_t longest_name = 100;
constexpr std::size_t most_jobs = 10'000;

std::string read_name(Reader& reader) {
  const std::string name = reader.text("name");
  const auto plain = [](unsigned char c) {
    return (c < 128 && std::isalnum(c) != 0) || c == '-' || c == '_' || c == '.';
  };
  const bool good = !name.empty() && name.size() <= longest_name &&
                    std::all_of(name.begin(), name.end(), plain) && name.front() != '-' &&
                    name.front() != '.';
  if (!good)
    reader.fail("name", "must be 1 to " + std::to_string(longest_name) +
                            " letters, digits, '-', '_', '.', not beginning with '-' or '.', got \"" + name +
                            "\"");
  return name;
}

std::vector<std::int64_t> read_seeds(Reader& reader) {
  std::vector<std::int64_t> seeds;
  for (const double x : reader.numbers("seeds", between(0, static_cast<double>(largest_seed)))) {
    const std::string key = "seeds[" + std::to_string(seeds.size()) + "]";
    if (x != std::nearbyint(x)) reader.fail(key, "must be a whole number, got " + to_text(x));
    const auto seed = static_cast<std::int64_t>(x);
    if (std::find(seeds.begin(), seeds.end(), seed) != seeds.end())
      reader.fail(key, "is given twice, got " + std::to_string(seed));
    seeds.push_back(seed);
  }
  return seeds;
}

WrittenOrigin read_origin(Reader reader) {
  WrittenOrigin origin;
  origin.test = reader.text("test");
  if (reader.has("segment")) origin.segment = reader.integer("segment", 0, 999'999);
  if (reader.has("nu")) {
    origin.list = reader.raw("nu").is_array();
    origin.nu =
        origin.list ? reader.numbers("nu", inside(0, 1)) : std::vector{reader.number("nu", inside(0, 1))};
  }
  reader.optional({"segment", "nu"});
  reader.finish();
  return origin;
}

/// The path of a test, which must leave its start to the state the test starts from.
Path read_path(Reader reader) {
  Path path = Path::read(reader);
  path.need_grains_can_follow();
  const Json start = path.to_json().at("start");
  if (!start.empty())
    throw Error(
        reader.file(), reader.path_of("start." + start.begin().key()),
        "means nothing in a campaign: a test starts from the state that `from` or `preparation` names");
  return path;
}

/// With all columns of its records, which fits, comparisons and reports read.
dem::Measure read_measure(const Reader& reader, const dem::Measure& fallback) {
  const dem::Measure measure = dem::Measure::read(reader, fallback);
  for (const std::string& group : column_groups())
    if (std::find(measure.standard.begin(), measure.standard.end(), group) == measure.standard.end())
      throw Error(
          reader.file(), reader.path_of("standard"),
          "must have \"" + group + "\" in a campaign, whose fits, comparisons and report read its columns");
  return measure;
}

Role role_from(const std::string& word) {
  if (word == "memory") return Role::memory;
  return word == "fit" ? Role::fit : Role::predict;
}

/// Reads a test and writes out its list of states.
std::vector<WrittenTest> read_test(Reader& reader, const Campaign& campaign) {
  CampaignTest test;
  test.key = reader.path_of("");
  test.name = read_name(reader);
  test.role = role_from(reader.word("role", {"fit", "predict", "memory"}));
  std::optional<WrittenOrigin> from;
  if (reader.has("from")) from = read_origin(reader.object("from"));
  test.seeds = reader.has("seeds") ? read_seeds(reader) : campaign.seeds;
  for (const auto seed : test.seeds)
    if (std::find(campaign.seeds.begin(), campaign.seeds.end(), seed) == campaign.seeds.end())
      reader.fail("seeds", "must be some of the campaign's seeds, got " + std::to_string(seed));
  test.path = read_path(reader.object("path"));
  if (test.role != Role::predict && test.path.by_stress())
    reader.fail("role", "must be predict where the path is under stress control, got " + name_of(test.role) +
                            ": the laws follow strains");
  if (test.role != Role::predict && test.path.spins())
    reader.fail("role", "must be predict where the path has simple_shear, got " + name_of(test.role) +
                            ": the laws have one direction of shear");
  test.measure = read_measure(reader.object_or_empty("measure"), campaign.measure);
  reader.finish();
  if (!from || !from->list) return {{test, from}};
  std::vector<WrittenTest> tests;
  for (const double nu : from->nu) {
    WrittenTest one{test, from};
    one.test.name.append("-").append(to_text(nu));
    if (one.test.name.size() > longest_name)
      reader.fail("name", "is too long: with the volume fraction it becomes \"" + one.test.name + "\"");
    one.from->nu = {nu};
    tests.push_back(std::move(one));
  }
  return tests;
}

Json test_json(const CampaignTest& test) {
  Json json{{"name", test.name}, {"role", name_of(test.role)}};
  if (test.from) {
    json["from"] = {{"test", test.from->test}, {"segment", test.from->segment}};
    if (test.from->nu) json["from"]["nu"] = *test.from->nu;
  }
  json["seeds"] = test.seeds;
  json["path"] = test.path.to_json();
  json["measure"] = test.measure.to_json();
  return json;
}

}  // namespace

std::string first_difference(const Json& there, const Json& here, const std::string& key) {
  return grainlaw::first_difference(there, here, key);
}

std::string name_of(Role role) {
  if (role == Role::memory) return "memory";
  return role == Role::fit ? "fit" : "predict";
}

std::string record_name(std::string_view test, std::int64_t seed) {
  return std::string(test) + "-s" + std::to_string(seed);
}

Campaign Campaign::read(Reader reader) {
  Campaign campaign;
  campaign.file = reader.file();
  campaign.name = read_name(reader);
  campaign.material = Material::read(reader.object_or_empty("material"));
  campaign.preparation =
      dem::NewPacking::read(reader.object_or_empty("preparation"), dem::NewPacking::SeedKey::refused);
  campaign.seeds = read_seeds(reader);
  campaign.measure = read_measure(reader.object_or_empty("measure"), {});
  std::vector<WrittenTest> written;
  std::size_t jobs = 0;
  for (Reader& test : reader.objects("tests"))
    for (auto& one : read_test(test, campaign)) {
      jobs += one.test.seeds.size();
      if (jobs > most_jobs) test.fail("", "makes more than " + std::to_string(most_jobs) + " runs");
      written.push_back(std::move(one));
    }
  reader.finish();
  resolve_origins(campaign, written);
  return campaign;
}

Campaign Campaign::load(const std::filesystem::path& file) {
  return read(Reader(load_json(file), file.string()));
}

Json Campaign::to_json() const {
  Json prepared = preparation.to_json();
  prepared.erase("seed");
  Json list = Json::array();
  for (const auto& test : tests) list.push_back(test_json(test));
  return {{"name", name},   {"material", material.to_json()}, {"preparation", prepared},
          {"seeds", seeds}, {"measure", measure.to_json()},   {"tests", list}};
}

bool Campaign::has_test(std::string_view wanted) const {
  return std::any_of(tests.begin(), tests.end(), [&](const auto& test) { return test.name == wanted; });
}

const CampaignTest& Campaign::test(std::string_view wanted) const {
  for (const auto& test : tests)
    if (test.name == wanted) return test;
  throw Error(file, "tests", "no such test: \"" + std::string(wanted) + "\"");
}

std::string difference(const Campaign& there, const Campaign& here) {
  return first_difference(there.to_json(), here.to_json());
}

}  // namespace grainlaw::calibrate
