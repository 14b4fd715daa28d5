// Least squares for a law y = f(x; parameters): what a fit is given and what it reports.
// Bounded, scaled, with several starts; says which parameters the data determine and where each error comes
// from.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace grainlaw::calibrate {

/// One parameter of a law.
struct FitParameter {
  std::string name;
  std::string unit = "1";
  double initial = 0;
  double low = 0, high = 1;
  /// Natural size: the solver works on value/scale, and a standard error beyond it counts as not determined.
  double scale = 1;
  /// No size is natural to it (a rate): not determined where the standard error exceeds the value itself.
  bool judged_by_value = false;
  /// The law ends at the lowest x of the data, and the bounds are counted from there: a fit to some of the
  /// series has bounds of its own.
  bool bounds_follow_data = false;
  /// The law itself ends at `low` (a saturation value cannot be negative), so that a fit may rest there.
  bool low_is_natural = false;
  /// Not fitted: stays at `initial`, whose standard error goes into the errors of the others.
  bool held = false;
  double held_error = 0;
  /// Where to hold it if the data cannot determine it, with that value's own error (0: none is stated), and
  /// which one to hold first (the lowest).
  std::optional<double> fallback;
  double fallback_error = 0;
  int hold_order = 0;
};

/// One measurement. `known` is a second measured quantity that the law needs (C in the pressure law).
struct FitPoint {
  double x = 0;
  double y = 0;
  double known = 0;
  double error = 0;  ///< standard error of y; 0: unknown
};

/// Points in the order they were measured: rows of one run, which are correlated, or results of several runs.
struct FitSeries {
  std::string test;   ///< name of the record
  std::string group;  ///< series of one group (a seed) are not independent of each other
  std::vector<FitPoint> points;
};

/// f(x; p) and, unless `gradient` is empty, its derivatives by all parameters.
using LawFunction =
    std::function<double(std::span<const double> p, const FitPoint& at, std::span<double> gradient)>;

/// What the points of a series are to each other.
enum class Points {
  rows,  ///< successive states of one run: errors from the residuals' autocorrelation, or over >= 3 groups
  runs   ///< results of independent runs: errors from their scatter about the law
};

struct FitProblem {
  std::vector<FitParameter> parameters;
  LawFunction law;
  std::vector<FitSeries> series;
  Points points = Points::rows;
  /// Values of x closer than this count as one when asking whether there are enough of them.
  double x_resolution = 0;
  int starts = 1;  ///< the given start and starts - 1 of a Latin hypercube between the bounds
  std::uint64_t seed = 1;
};

struct FitEstimate {
  std::string name, unit;
  double value = 0;                                     ///< NaN: nobody knows it
  std::optional<double> stderr_;                        ///< none where held without error, or unknown
  std::optional<std::pair<double, double>> interval95;  ///< Student's t with the fit's degrees of freedom
  bool at_bound = false;
  bool determined = true;
  bool held = false;   ///< given, or held at its fallback because the data do not determine it
  std::string reason;  ///< why it is not determined
};

struct FitResult {
  std::vector<FitEstimate> parameters;
  double rms = 0;  ///< of the residuals, in units of y
  std::size_t n = 0;
  double n_effective = 0;         ///< independent points, after the residuals' autocorrelation
  double degrees_of_freedom = 0;  ///< of the standard errors
  double extra_scatter = 0;       ///< between runs, beyond their own errors (Points::runs), in units of y
  std::string stderr_from;        ///< where the standard errors come from, in words
  double condition = 0;           ///< of the scaled Jacobian; infinity where it is singular
  int starts = 0;
  int best_found = 0;  ///< starts that ended in the best minimum
  std::string exit;    ///< why the solver stopped, in words
  bool ran = false;    ///< false: nothing could be fitted, see exit and the reasons

  const FitEstimate& operator[](const std::string& name) const;
  double value(const std::string& name) const { return (*this)[name].value; }
  std::vector<double> values() const;
  bool determined() const;  ///< every parameter
};

/// Fits the law. Parameters that the data cannot determine are held at their fallback, one after the other,
/// and the rest is fitted again; without a fallback they are reported as not determined. Throws Error only
/// for a problem that makes no sense (no parameters, a bound that excludes its initial value, points that are
/// not finite).
FitResult fit(const FitProblem& problem);

/// The result of a fit that cannot even be tried: every free parameter is at its fallback, or unknown (NaN),
/// for this reason.
FitResult not_fitted(const FitProblem& problem, const std::string& why);

}  // namespace grainlaw::calibrate
