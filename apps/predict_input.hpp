// What `grainlaw predict` follows: a path, a record of grains, or a table of strains.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "grainlaw/element/path.hpp"
#include "grainlaw/element/record.hpp"
#include "grainlaw/model/predict.hpp"

namespace grainlaw::apps {

struct Followed {
  Path path;
  std::optional<Record> record;  ///< of a record directory: its rows are those of the prediction
  std::optional<model::MeasuredPath> strains;  ///< of a table: the same
};

/// A PATH.json, the path that a record ran, from the volume fraction it began at, or a table of strains
/// (.csv), whose start `nu` and `P` may say; `P` is over k* or, as 50kPa, over `unit_kPa`, which is k* in
/// kPa. Throws Error where they mean nothing.
Followed read_followed(const std::filesystem::path& where, const std::string& nu, const std::string& P,
                       double unit_kPa);

/// Files that are read, so that none of them is written over.
std::vector<std::filesystem::path> files_of(const std::filesystem::path& where);

}  // namespace grainlaw::apps
