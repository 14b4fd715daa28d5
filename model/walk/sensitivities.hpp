// Derivatives of a prediction with respect to the numbers that stand behind it: parameters of the set by name
// ("moduli.a_I", "isotropic.d2.C1", "shear.s_max.Q_max") and start values that the path gives ("start.P").
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "grainlaw/element/path.hpp"
#include "grainlaw/model/predict.hpp"
#include "grainlaw/model/start.hpp"
#include "grainlaw/model/walk/sensitive_point.hpp"

namespace grainlaw::model {

/// Variables by name: which slope of a number belongs to which.
class Seeds {
 public:
  /// Throws Error for a name that neither the set nor the start has, a name given twice, or more than
  /// most_slopes. `parameters` must outlive the seeds.
  Seeds(const ParameterSet& parameters, const Path& path, const std::vector<std::string>& names);

  const std::vector<std::string>& names() const { return names_; }
  /// Natural sizes: |value|, 1 where that is 0.
  const std::vector<double>& scales() const { return scales_; }
  /// The start, its numbers with their slopes. S is Slopes or FewSlopes.
  template <class S>
  BasicStartState<S> start(const ParameterSet& parameters, const Path& path, const Choice& choice) const;

 private:
  std::vector<std::string> names_;
  std::vector<double> scales_;
  std::map<const Parameter*, std::size_t> by_parameter_;
  std::map<std::string, std::size_t> by_start_;
};

/// Every parameter that the form reads, and every start value that the path gives.
std::vector<std::string> names_of_sensitivities(const ParameterSet& parameters, const Path& path,
                                                const Choice& choice);

/// Columns that have sensitivities: P, sigma_dev, F_dev, phi_J.
const std::vector<std::string>& sensitive_columns();
/// "dP/d(moduli.a_I)".
std::string sensitivity_column(const std::string& column, const std::string& name);

struct SensitivePrediction {
  Prediction prediction;  ///< its record has sensitivity_column() of all sensitive_columns(), name by name
  std::vector<std::string> idle;       ///< names on which nothing on this path depends: their columns are 0
  std::vector<SensitiveEvent> events;  ///< slope k belongs to name k
};

/// As predict(), with derivatives by `names`, each at fixed strain: with respect to start.nu too the strains
/// of the path stay as they are. Values and derivatives are both within options.rtol (of name n, n dx/dn is
/// held to the tolerance of x). Derivatives do not exist where a direction of shear begins exactly at
/// saturation, or where a path ends exactly at jamming.
SensitivePrediction predict_sensitivities(const ParameterSet& parameters, const Path& path,
                                          const std::vector<Sample>& samples,
                                          const std::vector<std::string>& names,
                                          const PredictOptions& options = {});
SensitivePrediction predict_sensitivities(const ParameterSet& parameters, const Path& path,
                                          const std::vector<std::string>& names,
                                          const PredictOptions& options = {});

}  // namespace grainlaw::model
