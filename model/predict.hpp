// The law as a material point along a path: parameter set and path in, a record out, with the columns of a
// DEM record.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "grainlaw/element/json.hpp"
#include "grainlaw/element/path.hpp"
#include "grainlaw/element/record.hpp"
#include "grainlaw/model/forms/law.hpp"
#include "grainlaw/model/parameters.hpp"
#include "grainlaw/model/status.hpp"
#include "grainlaw/model/walk/integrator.hpp"

namespace grainlaw::model {

struct PredictOptions {
  Form form = Form::coupled;
  double rtol = 1e-8;      ///< relative error of the state, > 0
  double atol = 1e-12;     ///< absolute error of P*, sigma*_dev, F_dev, s_dev, > 0
  int rows_per_leg = 100;  ///< evenly spaced in the leg's strain; a relaxation has one row, its end
  Terms terms = {};        ///< past the thesis
  Method method = Method::bdf;
};

/// A point of the path: leg (segment) and the fraction of its strain that is done.
struct Sample {
  std::size_t leg = 0;
  double progress = 0;  ///< in [0, 1]; of a relaxation only its end counts
};

struct Prediction {
  Record record;  ///< prediction_columns(); rows up to the failure where status is failed
  Json start;     ///< every start value: {"P": {"value": 0.0222, "from": "pressure law isotropic.iso
                  ///< (Eq. 2.14)"}, ...}
  std::vector<std::string> warnings;
  Status status;
  State end = {};  ///< where the path ended
};

/// Walks `path` from its start: one row for the start (segment 0), then options.rows_per_leg rows per leg.
/// Segments may prescribe stresses or end on a condition; one that ends early has its end as its last row.
/// Throws Error (file, key) for a start or path the law cannot take, or a group the parameter set lacks; a
/// target that cannot be reached and a failure of the integration are not thrown but returned as the status.
Prediction predict(const ParameterSet& parameters, const Path& path, const PredictOptions& options = {});

/// The same with one row per sample; samples are in the order of the path.
Prediction predict(const ParameterSet& parameters, const Path& path, const std::vector<Sample>& samples,
                   const PredictOptions& options = {});

/// The samples at which a record of the same path was written, row by row (columns segment, eps_vol,
/// eps_dev), so that a prediction compares with it line by line. `nu_start` is where the record starts.
/// Throws Error for a row that is not on the path.
std::vector<Sample> samples_of(const Record& record, const Path& path, double nu_start);

/// The strain that the grains of a record took, from row to row, as a path of its own: what the law can
/// follow of a path under stress control. `path` is the one that was asked of the grains.
struct MeasuredPath {
  Path path;                     ///< from the volume fraction of the first row
  std::vector<Sample> samples;   ///< one per row
  std::vector<double> segments;  ///< of `path` as asked, one per row
};
MeasuredPath measured_path(const Record& record, const Path& path);

}  // namespace grainlaw::model
