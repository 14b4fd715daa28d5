// The fit stage: records of element tests in, a parameter set and a full account of every fit out.
// Records of role predict are fitted as well, but only for the account; no parameter ever depends on them.
#pragma once

#include <filesystem>
#include <optional>

#include "grainlaw/calibrate/fit_selection.hpp"
#include "grainlaw/element/json.hpp"
#include "grainlaw/element/record.hpp"
#include "grainlaw/model/parameters.hpp"

namespace grainlaw::calibrate {

struct FitOutput {
  model::ParameterSet parameters;
  Json fits;  ///< fits.json, see docs/fits.md
  /// over_compression.csv, shear_jamming.csv, relaxed.csv, tapped.csv (memory_tables.hpp); none where no test
  /// of role memory has any.
  std::optional<Record> over_compression, shear_jamming, relaxed, tapped;

  /// Writes fits.json and these tables into a directory.
  void write_account(const std::filesystem::path& dir) const;
};

/// What the fits of groups memory and near_jamming read besides the records.
struct MemorySources {
  /// Tables 5.1 and 5.2 of the thesis as a parameter set, used as `thesis` is; empty: none.
  std::filesystem::path near_jamming = {};
  /// A directory with over_compression.csv and, where they are there, shear_jamming.csv, relaxed.csv and
  /// tapped.csv, of the same material: they count as tests of role memory. Empty: none.
  std::filesystem::path tables = {};
  /// A directory of records, D2 tests of role fit that turn their shear round, of the same material: for the
  /// numbers of reversals in the form with memory. Empty: those of the records themselves.
  std::filesystem::path reversals = {};
};

/// Fits all records of `dir`: the output directory of a campaign (campaign.json says each test's role), or
/// any directory of records (all of role fit). `thesis` is the thesis's parameter set: its values stand
/// beside the fitted ones if it is of the same w, replace what the data leave open, and fill the groups
/// moduli and memory; with an empty path there are none of these. Throws Error for a directory without
/// records, a record that cannot be read, records of different materials, tables that cannot be read, and for
/// `memory.reversals` without such a test.
FitOutput fit_records(const std::filesystem::path& dir, const std::filesystem::path& thesis = {},
                      const Selection& selection = {}, const MemorySources& memory = {});

}  // namespace grainlaw::calibrate
