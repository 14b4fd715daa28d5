#include "grainlaw/calibrate/path_problem.hpp"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "grainlaw/element/error.hpp"
#include "grainlaw/model/walk/sensitivities.hpp"

namespace grainlaw::calibrate {
namespace {

/// An open end of a range is kept off by this part of the parameter's size.
constexpr double off_the_end = 1e-6;

/// One series as Ceres takes it; every parameter is a block of its own, in units of its scale.
class SeriesCost : public ceres::CostFunction {
 public:
  SeriesCost(const PathProblem& problem, const PathSeries& series, const ColumnWeights& weights)
      : problem_(problem), series_(series), weights_(weights) {
    set_num_residuals(static_cast<int>(problem.columns().size() * series.samples.size()));
    mutable_parameter_block_sizes()->assign(problem.names().size(), 1);
  }

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    std::vector<double> values(problem_.names().size());
    for (std::size_t k = 0; k < values.size(); ++k) values[k] = *blocks[k] * problem_.scales()[k];
    return problem_.evaluate_series(series_, values, weights_, residuals, jacobians, nullptr);
  }

 private:
  const PathProblem& problem_;
  const PathSeries& series_;
  ColumnWeights weights_;
};

std::string exit_in_words(const ceres::Solver::Summary& summary) {
  switch (summary.termination_type) {
    case ceres::CONVERGENCE:
      return "converged: " + summary.message;
    case ceres::NO_CONVERGENCE:
      return "not converged: " + summary.message;
    default:
      return "failed: " + summary.message;
  }
}

}  // namespace

PathProblem::PathProblem(const model::ParameterSet& set, std::vector<std::string> names,
                         std::vector<PathSeries> series, const model::PredictOptions& options,
                         const ColumnsCompared& compared)
    : set_(set), names_(std::move(names)), series_(std::move(series)), options_(options) {
  for (std::size_t q = 0; q < compared.size(); ++q)
    if (compared[q]) columns_.push_back(q);
  const auto known = set_.named();
  for (const std::string& name : names_) {
    start_.push_back(set_.parameter(name).value);
    scales_.push_back(start_.back() != 0 ? std::abs(start_.back()) : 1);
    const Range& range = std::find_if(known.begin(), known.end(), [&](const auto& entry) {
                           return entry.name == name;
                         })->range;
    const double margin = off_the_end * scales_.back();
    low_.push_back(range.low + (range.low_open ? margin : 0));
    high_.push_back(range.high - (range.high_open ? margin : 0));
  }
}

model::ParameterSet PathProblem::with(const std::vector<double>& values) const {
  model::ParameterSet set = set_;
  for (std::size_t k = 0; k < names_.size(); ++k) set.parameter(names_[k]).value = values[k];
  return set;
}

bool PathProblem::at_bound(std::size_t k, double value) const {
  const double near = off_the_end * scales_[k];
  return value <= low_[k] + near || value >= high_[k] - near;
}

std::vector<std::size_t> PathProblem::run_lengths() const {
  std::vector<std::size_t> lengths;
  for (const PathSeries& series : series_)
    lengths.insert(lengths.end(), columns_.size(), series.samples.size());
  return lengths;
}

bool PathProblem::evaluate_series(const PathSeries& series, const std::vector<double>& values,
                                  const ColumnWeights& weights, double* residuals, double** columns,
                                  std::string* why) const {
  const auto fail = [&](const std::string& reason) {
    if (why) *why = series.test + ": " + reason;
    return false;
  };
  model::Prediction prediction;
  try {
    const model::ParameterSet set = with(values);
    prediction =
        columns ? model::predict_sensitivities(set, series.path, series.samples, names_, options_).prediction
                : model::predict(set, series.path, series.samples, options_);
  } catch (const Error& error) {
    return fail(error.what());
  }
  if (prediction.status.failed()) return fail(prediction.status.message);
  std::size_t row = 0;
  for (const std::size_t q : columns_) {
    const double factor = weights[q] / series.error[q];
    const auto& predicted = prediction.record[path_columns[q]];
    for (std::size_t i = 0; i < predicted.size(); ++i)
      residuals[row + i] = factor * (predicted[i] - series.measured[q][i]);
    for (std::size_t k = 0; columns && k < names_.size(); ++k) {
      if (!columns[k]) continue;
      const auto& slopes = prediction.record[model::sensitivity_column(path_columns[q], names_[k])];
      for (std::size_t i = 0; i < slopes.size(); ++i) columns[k][row + i] = factor * scales_[k] * slopes[i];
    }
    row += predicted.size();
  }
  return true;
}

std::optional<PathResiduals> PathProblem::evaluate(const std::vector<double>& values,
                                                   const ColumnWeights& weights, bool with_jacobian,
                                                   std::string* why) const {
  std::size_t rows = 0;
  for (const PathSeries& series : series_) rows += columns_.size() * series.samples.size();
  PathResiduals out;
  out.values.resize(static_cast<Eigen::Index>(rows));
  if (with_jacobian)
    out.jacobian.resize(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(names_.size()));
  Eigen::Index row = 0;
  for (const PathSeries& series : series_) {
    std::vector<double*> columns;
    for (Eigen::Index k = 0; k < out.jacobian.cols(); ++k) columns.push_back(&out.jacobian(row, k));
    if (!evaluate_series(series, values, weights, &out.values(row), with_jacobian ? columns.data() : nullptr,
                         why))
      return std::nullopt;
    row += static_cast<Eigen::Index>(columns_.size() * series.samples.size());
  }
  return out;
}

PathMinimum PathProblem::minimise(const std::vector<double>& from, const ColumnWeights& weights,
                                  const std::set<std::size_t>& fixed) const {
  PathMinimum out;
  out.values = from;
  std::string why;
  if (!evaluate(from, weights, false, &why)) {
    out.exit = "failed: the law does not come along the paths from the start: " + why;
    out.cost = std::numeric_limits<double>::infinity();
    return out;
  }
  std::vector<double> u(from.size());
  std::vector<double*> blocks;
  ceres::Problem problem;
  for (std::size_t k = 0; k < u.size(); ++k) {
    u[k] = from[k] / scales_[k];
    blocks.push_back(&u[k]);
  }
  for (const PathSeries& series : series_)
    problem.AddResidualBlock(new SeriesCost(*this, series, weights), nullptr, blocks);
  for (std::size_t k = 0; k < u.size(); ++k) {
    if (fixed.contains(k)) {
      problem.SetParameterBlockConstant(blocks[k]);
      continue;
    }
    if (std::isfinite(low_[k])) problem.SetParameterLowerBound(blocks[k], 0, low_[k] / scales_[k]);
    if (std::isfinite(high_[k])) problem.SetParameterUpperBound(blocks[k], 0, high_[k] / scales_[k]);
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.logging_type = ceres::SILENT;
  options.max_num_iterations = 100;
  options.max_num_consecutive_invalid_steps = 20;
  options.function_tolerance = 1e-7;  // what is fitted is known to some per cent
  options.parameter_tolerance = 1e-7;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  for (std::size_t k = 0; k < u.size(); ++k)
    if (!fixed.contains(k)) out.values[k] = u[k] * scales_[k];
  out.cost = summary.final_cost;
  out.converged = summary.termination_type == ceres::CONVERGENCE;
  out.exit = exit_in_words(summary);
  return out;
}

}  // namespace grainlaw::calibrate
