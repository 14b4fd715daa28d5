// The records that fits and predictions read: every record directory of a campaign's output, or of any
// folder. Each with its role, its mode and the path it ran.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "grainlaw/calibrate/campaign.hpp"
#include "grainlaw/element/material.hpp"
#include "grainlaw/element/path.hpp"
#include "grainlaw/element/record.hpp"

namespace grainlaw::calibrate {

/// The record that kept the state a test starts from, and the leg of its path where that lies.
struct RecordOrigin {
  std::string record;  ///< "iso-s1"
  std::size_t leg = 0;
};

struct TestRecord {
  std::string name;  ///< of its directory, "d2-0.7-s1"
  std::string test;  ///< "d2-0.7"
  std::string seed;  ///< "1"; the whole name where it does not end in -sNUMBER
  Role role = Role::fit;
  std::string mode;  ///< of all segments but relaxations: iso, uni, d2, d3; components; "mixed"
  std::filesystem::path dir;
  Material material;
  Path path;
  double nu_start = 0;  ///< where the path starts
  std::vector<Leg> legs;
  /// The axis along which its packing was sheared before, as the scenes of the records say that it starts
  /// from; none where it was not, or where these records are not beside it.
  std::optional<StrainTensor> sheared_along;
  Record rows;
  /// Why it ends before its path did, which is then told as far as it goes; empty where it does not.
  std::string cut_short;
  std::optional<Record> moduli;      ///< of states along the path, where moduli.csv is kept
  std::optional<RecordOrigin> from;  ///< none: a packing as prepared, or nothing says
};

/// A record that should be there and is not, or one that no fit takes, and why.
struct LeftOut {
  std::string name;
  Role role = Role::fit;
  std::string reason;
};

struct RecordFolder {
  std::string name;  ///< the campaign's, or the directory's
  bool campaign = false;
  std::vector<TestRecord> tests;
  std::vector<LeftOut> left_out;
};

/// Reads `dir`: if it holds campaign.json, the records of that campaign with their roles; otherwise every
/// directory with a record.csv in it, in `records` or in `dir`, with role fit. Records still being made
/// (.part) do not count. Throws Error for a directory without any record, and naming file, line and column
/// for a record that cannot be read.
RecordFolder read_records(const std::filesystem::path& dir);

/// The index of the first leg that shears, and of the last one that decompresses; legs.size() if there is
/// none.
std::size_t first_shear_leg(const TestRecord& test);
/// The index after the last leg that goes on from there in the same mode and direction.
std::size_t end_of_first_loading(const TestRecord& test);
std::size_t last_unloading_leg(const TestRecord& test);
/// Whether it shears both ways.
bool reverses(const TestRecord& test);

}  // namespace grainlaw::calibrate
