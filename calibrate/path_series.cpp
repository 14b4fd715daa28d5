#include "grainlaw/calibrate/path_series.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "grainlaw/element/error.hpp"

namespace grainlaw::calibrate {
namespace {

constexpr double least_relative_error = 0.01, error_without_scatter = 0.05;

/// Rows of each leg at (i/n)^2 of its rows, and its last one.
std::vector<std::size_t> thinned_rows(const std::vector<model::Sample>& samples, std::size_t rows_per_leg) {
  std::set<std::size_t> rows{0};
  for (std::size_t begin = 0; begin < samples.size();) {
    std::size_t end = begin;
    while (end < samples.size() && samples[end].leg == samples[begin].leg) ++end;
    for (std::size_t i = 1; i <= rows_per_leg; ++i) {
      const double part = std::pow(static_cast<double>(i) / static_cast<double>(rows_per_leg), 2);
      rows.insert(begin + static_cast<std::size_t>(std::lround(part * static_cast<double>(end - 1 - begin))));
    }
    begin = end;
  }
  return {rows.begin(), rows.end()};
}

/// Why this record cannot stand beside the others of its test, or nothing.
std::string mismatch(const TestRecord& record, const TestRecord& first) {
  constexpr double same_strain = 1e-3;
  if (record.rows.rows() != first.rows.rows()) return "has another number of rows than " + first.name;
  for (const char* column : {"eps_vol", "eps_dev"})
    for (std::size_t i = 0; i < record.rows.rows(); ++i)
      if (std::abs(record.rows[column][i] - first.rows[column][i]) > same_strain)
        return "is elsewhere on the path than " + first.name + " in row " + std::to_string(i + 1);
  for (const char* column : path_columns) {
    if (!record.rows.has(column)) return std::string("has no column ") + column;
    for (const double value : record.rows[column])
      if (!std::isfinite(value)) return std::string("has an empty field in ") + column;
  }
  return "";
}

struct Mean {
  std::vector<double> values;
  double error = 0;  ///< root mean square over the rows of the standard error
  double size = 0;   ///< root mean square
};

Mean mean_over(const std::vector<const TestRecord*>& seeds, const char* column,
               const std::vector<std::size_t>& rows) {
  const auto n = static_cast<double>(seeds.size()), count = static_cast<double>(rows.size());
  Mean out;
  for (const std::size_t row : rows) {
    double mean = 0, square = 0;
    for (const TestRecord* seed : seeds) mean += seed->rows[column][row] / n;
    for (const TestRecord* seed : seeds) square += std::pow(seed->rows[column][row] - mean, 2);
    out.values.push_back(mean);
    out.size += mean * mean / count;
    if (seeds.size() > 1) out.error += square / (n - 1) / n / count;
  }
  out.error = std::sqrt(out.error);
  out.size = std::sqrt(out.size);
  return out;
}

PathSeries series_of(const std::vector<const TestRecord*>& seeds, const PathSelection& selection) {
  const TestRecord& first = *seeds.front();
  PathSeries series;
  series.test = first.test;
  series.seeds = seeds.size();
  series.path = first.path;
  double nu = 0;
  for (const TestRecord* seed : seeds) nu += seed->nu_start / static_cast<double>(seeds.size());
  series.path.start = Start{};
  series.path.start.nu = nu;
  const auto samples = model::samples_of(first.rows, first.path, first.nu_start);
  const auto rows = thinned_rows(samples, selection.rows_per_leg);
  const bool scatter = seeds.size() > 1 && selection.weights == PathWeights::scatter;
  for (const std::size_t row : rows) series.samples.push_back(samples[row]);
  for (std::size_t q = 0; q < path_columns.size(); ++q) {
    const Mean mean = mean_over(seeds, path_columns[q], rows);
    series.measured[q] = mean.values;
    series.from_scatter[q] = scatter;
    series.error[q] = scatter ? std::hypot(mean.error, least_relative_error * mean.size)
                              : error_without_scatter * mean.size;
  }
  return series;
}

}  // namespace

std::vector<PathSeries> path_series(const RecordFolder& folder, const PathSelection& selection,
                                    std::vector<LeftOut>& left_out) {
  std::map<std::string, std::vector<const TestRecord*>> tests;
  for (const TestRecord& record : folder.tests) {
    const bool wanted =
        record.role == selection.role && (!selection.reversed_only || reverses(record)) &&
        std::find(selection.modes.begin(), selection.modes.end(), record.mode) != selection.modes.end();
    if (!wanted) continue;
    auto& seeds = tests[record.test];
    const std::string reason = mismatch(record, seeds.empty() ? record : *seeds.front());
    if (reason.empty())
      seeds.push_back(&record);
    else
      left_out.push_back({record.name, record.role, reason});
  }
  std::vector<PathSeries> series;
  for (const auto& [name, seeds] : tests) {
    if (seeds.empty()) continue;
    try {
      series.push_back(series_of(seeds, selection));
    } catch (const Error& error) {
      left_out.push_back({name, selection.role, error.what()});
      continue;
    }
    const auto& errors = series.back().error;
    if (std::all_of(errors.begin(), errors.end(), [](double e) { return e > 0; })) continue;
    series.pop_back();
    left_out.push_back({name, selection.role, "P, sigma_dev or F_dev is 0 all along"});
  }
  return series;
}

}  // namespace grainlaw::calibrate
