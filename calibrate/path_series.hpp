// Measured paths as a fit of whole paths reads them: per test the mean over its seeds at thinned rows, and
// how far to trust it.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "grainlaw/calibrate/fit_input.hpp"
#include "grainlaw/model/predict.hpp"

namespace grainlaw::calibrate {

/// What a fit of whole paths may compare, in this order.
inline constexpr std::array<const char*, 3> path_columns{"P", "sigma_dev", "F_dev"};
/// Which of them it does.
using ColumnsCompared = std::array<bool, 3>;
inline constexpr ColumnsCompared all_columns{true, true, true};
inline constexpr std::size_t fabric_column = 2;

/// One test.
struct PathSeries {
  std::string test;
  std::size_t seeds = 0;
  Path path;  ///< from the records' mean volume fraction, isotropic
  std::vector<model::Sample> samples;
  std::array<std::vector<double>, 3> measured;  ///< at the samples, mean over the seeds
  /// Of `measured`: root mean square over the rows of the standard error of the mean, and 1 % of the size of
  /// the column, which no law is asked to beat, added in squares. With one seed 5 % of the size.
  std::array<double, 3> error{};
  std::array<bool, 3> from_scatter{};  ///< false: 5 % of the size
};

/// Where `error` is from.
enum class PathWeights {
  scatter,  ///< between seeds, see PathSeries::error
  size      ///< 5 % of the size of each column of each test: all count alike
};

struct PathSelection {
  std::vector<std::string> modes{"d2", "d3"};
  Role role = Role::fit;
  std::size_t rows_per_leg = 30;  ///< closer at the beginning of a leg, where everything happens
  PathWeights weights = PathWeights::scatter;
  bool reversed_only = false;  ///< only tests that turn their shear round
};

/// Tests of `folder`, with those that are left out and why appended to `left_out`.
std::vector<PathSeries> path_series(const RecordFolder& folder, const PathSelection& selection,
                                    std::vector<LeftOut>& left_out);

}  // namespace grainlaw::calibrate
