// Where the records of a set of runs lie.
#pragma once

#include <filesystem>
#include <string>

namespace grainlaw::calibrate {

struct RunFolder {
  std::filesystem::path dir;

  /// records/NAME, and records/NAME.part while it is being made.
  std::filesystem::path record(const std::string& name) const { return dir / "records" / name; }
  std::filesystem::path part(const std::string& name) const { return dir / "records" / (name + ".part"); }
  /// Whether there is a directory of that record; see check_kept_record() for what is in it.
  bool has_record(const std::string& name) const { return std::filesystem::exists(record(name)); }
};

}  // namespace grainlaw::calibrate
