// The report of a campaign: one self-contained page, made of what is on disk and nothing else.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "grainlaw/apps/report/inputs.hpp"

namespace grainlaw::report {

/// The page for a campaign folder: what was run, what came out, each fit, each prediction over the DEM, time,
/// provenance, glossary. A file that is missing or cannot be read is named in the page. The same files give
/// the same bytes. Throws Error if `dir` holds nothing of a campaign, or gnuplot is not installed or fails.
std::string report_html(const std::filesystem::path& dir);

/// Writes report_html(dir) to dir/report.html, whole or not at all. Returns what was missing or unreadable.
std::vector<Gap> write_report(const std::filesystem::path& dir);

}  // namespace grainlaw::report
