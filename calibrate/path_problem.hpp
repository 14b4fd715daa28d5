// Least squares between whole measured paths and the law along them, over parameters by name, with the
// sensitivities of the predictions as Jacobian. Internal to the fits (needs Eigen).
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "grainlaw/calibrate/path_series.hpp"
#include "grainlaw/model/parameters.hpp"

namespace grainlaw::calibrate {

/// Weights of P, sigma_dev and F_dev beside 1/error.
using ColumnWeights = std::array<double, 3>;

/// Residuals weight (prediction - measured)/error of all rows, series by series, column by column of those
/// compared.
struct PathResiduals {
  Eigen::VectorXd values;
  Eigen::MatrixXd jacobian;  ///< by value/scale; empty where it was not asked for
};

struct PathMinimum {
  std::vector<double> values;  ///< of the parameters
  double cost = 0;             ///< half the sum of squares
  bool converged = false;
  std::string exit;
};

class PathProblem {
 public:
  /// Throws Error for a name that the set lacks.
  PathProblem(const model::ParameterSet& set, std::vector<std::string> names, std::vector<PathSeries> series,
              const model::PredictOptions& options, const ColumnsCompared& compared = all_columns);

  const std::vector<std::string>& names() const { return names_; }
  const std::vector<PathSeries>& series() const { return series_; }
  /// Indices into path_columns of what is compared, in their order.
  const std::vector<std::size_t>& columns() const { return columns_; }
  const std::vector<double>& start() const { return start_; }
  /// Natural sizes: |start|, 1 where that is 0.
  const std::vector<double>& scales() const { return scales_; }
  /// The set with these values.
  model::ParameterSet with(const std::vector<double>& values) const;
  /// Rests on an end of the values that the parameter may have.
  bool at_bound(std::size_t k, double value) const;
  /// Lengths of the runs of rows that residuals are made of.
  std::vector<std::size_t> run_lengths() const;

  /// None where the law does not come along a path; `why` then says so.
  std::optional<PathResiduals> evaluate(const std::vector<double>& values, const ColumnWeights& weights,
                                        bool with_jacobian, std::string* why = nullptr) const;
  /// The same for one series, written to `residuals` and, unless null, `columns` (one per name).
  bool evaluate_series(const PathSeries& series, const std::vector<double>& values,
                       const ColumnWeights& weights, double* residuals, double** columns,
                       std::string* why) const;

  /// Within the bounds, from `from`; parameters in `fixed` stay. A step to where the law does not come along
  /// a path is not taken.
  PathMinimum minimise(const std::vector<double>& from, const ColumnWeights& weights,
                       const std::set<std::size_t>& fixed) const;

 private:
  model::ParameterSet set_;
  std::vector<std::string> names_;
  std::vector<PathSeries> series_;
  model::PredictOptions options_;
  std::vector<std::size_t> columns_;
  std::vector<double> start_, scales_, low_, high_;
};

}  // namespace grainlaw::calibrate
