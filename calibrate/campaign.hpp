// A campaign: which element tests to run, from which states, with which seeds, and what each of them is for.
// Reads and checks CAMPAIGN.json (docs/formats.md) completely, so that nothing starts that cannot end.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "grainlaw/dem/scene/scene.hpp"
#include "grainlaw/element/json.hpp"
#include "grainlaw/element/material.hpp"
#include "grainlaw/element/path.hpp"

namespace grainlaw::calibrate {

/// What a test is for: `fit` is read by the fits, `memory` by the fit of the jamming density alone (group
/// memory), `predict` is only ever compared with a prediction.
enum class Role { fit, predict, memory };
std::string name_of(Role role);

/// The state a test starts from: one that another test of the campaign passes through and keeps.
struct Origin {
  std::string test;          ///< name of the test that keeps it
  std::size_t segment;       ///< segment of that test's path
  std::optional<double> nu;  ///< volume fraction on that segment; none: the segment's end
};

/// One element test, run once per seed.
struct CampaignTest {
  std::string name;
  Role role;
  std::optional<Origin> from;       ///< none: the prepared packing
  std::vector<std::int64_t> seeds;  ///< a subset of the campaign's
  Path path;
  dem::Measure measure;  ///< without the snapshots that other tests need
  double nu_start;       ///< nominal volume fraction it starts from, as if servos strained nothing
  bool nu_known = true;  ///< whether it starts from there: not where a servo comes before
  std::string key;       ///< where it stands in its file ("tests[2]")
};

struct Campaign {
  std::string file;  ///< for error messages
  std::string name;
  Material material;
  dem::NewPacking preparation;  ///< its seed means nothing: every test runs once per seed
  std::vector<std::int64_t> seeds;
  dem::Measure measure;  ///< the tests' defaults
  std::vector<CampaignTest> tests;

  /// Reads CAMPAIGN.json: lists of `from.nu` are written out as tests NAME-x, states are looked up on the
  /// path of the test that passes them. Throws Error for anything that could not be run to its end.
  static Campaign read(Reader reader);
  static Campaign load(const std::filesystem::path& file);
  /// The campaign as run; reading it again gives the same campaign.
  Json to_json() const;

  bool has_test(std::string_view name) const;
  /// Throws Error if there is no such test.
  const CampaignTest& test(std::string_view name) const;
  Role role_of(std::string_view test_name) const { return test(test_name).role; }
};

/// The directory name of a record: TEST-sSEED.
std::string record_name(std::string_view test, std::int64_t seed);

/// Where two JSON values first differ, in words ("rows: 100 there, 200 here"), below `key`; the order of keys
/// does not count. Empty if they are the same.
std::string first_difference(const Json& there, const Json& here, const std::string& key = "");

/// Where two campaigns first differ, in words ("preparation.count: 500 there, 1000 here"); empty if they are
/// the same.
std::string difference(const Campaign& there, const Campaign& here);

}  // namespace grainlaw::calibrate
