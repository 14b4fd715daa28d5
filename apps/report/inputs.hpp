// What a campaign folder holds, as far as it holds it: whatever is missing or unreadable becomes a note, not
// an error.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "grainlaw/element/json.hpp"
#include "grainlaw/element/record.hpp"

namespace grainlaw::report {

/// Something the report would have shown, and why it cannot.
struct Gap {
  enum class Kind { missing, unreadable };
  Kind kind;
  std::string file;  ///< within the campaign folder
  std::string reason;
};

/// One element test of one seed: records/TEST-sSEED.
struct Run {
  std::string name;  ///< TEST-sSEED
  std::string test;  ///< TEST
  std::optional<int> seed;
  bool unfinished = false;       ///< the folder still ends in .part, or there is none
  std::optional<Record> record;  ///< absent if missing or unreadable
  Json scene, provenance;        ///< null where missing or unreadable
  std::string mode;              ///< mode of its first segment that is not relax; "" if unknown
  std::string role;              ///< "fit", "predict" or ""
};

/// One entry of predictions.json with its table.
struct PredictedRun {
  Json entry;
  std::string test;  ///< without the seed
  std::string form;
  std::optional<Record> record;
};

/// A campaign folder in memory. Every Json is null where its file is missing or unreadable.
struct Inputs {
  std::filesystem::path dir;
  Json campaign, parameters, fits, predictions, timing;
  std::vector<Run> runs;  ///< in the order of the campaign, then by seed
  std::vector<PredictedRun> predicted;
  std::vector<PredictedRun> predicted_memory;  ///< tests of role memory, which the fits have read
  std::vector<Gap> gaps;
  /// True if predictions.json was made with another parameter set than parameters.json holds now.
  bool predictions_outdated = false;

  const Run* run(const std::string& name) const;
  /// Stress unit k*, kPa: from the parameters' material, else from the campaign's; nothing if neither is
  /// there.
  std::optional<double> stress_unit_kPa() const;
};

/// Throws Error if `dir` is not a folder, or nothing of a campaign is in it.
Inputs read_inputs(const std::filesystem::path& dir);

/// "uni-0.69" and 1 of "uni-0.69-s1"; the whole name and nothing if it does not end in -sN.
std::pair<std::string, std::optional<int>> split_seed(const std::string& name);

}  // namespace grainlaw::report
