// Where the program finds the files it comes with.
#pragma once

#include <filesystem>
#include <string>

#include "grainlaw/calibrate/fit_records.hpp"

namespace grainlaw::apps {

/// A file of data/ ("campaigns/quick.json"): in ./data, in the data/ of the source tree that the program was
/// built in, or where it was installed. Throws Error naming ./data/... if it is nowhere.
std::filesystem::path find_data(const std::string& name);

/// What the user types to run the program: "./grainlaw" or its full path where the entry script of a source
/// tree runs it (GRAINLAW_HOME), else "grainlaw".
std::string program_name();

/// The thesis's parameter set to hold beside fits of a material of this w = r_max/r_min: the one for the same
/// w (thesis/w-W.json) if there is one, else thesis/parameters.json (w = 3).
std::filesystem::path find_thesis(double w);

/// What the fits of memory read besides records: chapter 5's tables of the thesis, and our own of `tables`
/// (a directory; empty: none).
calibrate::MemorySources memory_sources(const std::filesystem::path& tables = {});

/// w of the records in `dir` (a campaign's output directory or a directory of records): that of the first
/// one. Throws Error if there is none.
double size_ratio_of_records(const std::filesystem::path& dir);

}  // namespace grainlaw::apps
