// What the law costs against the error of its integration: every method and tolerance on three paths, in
// increments, and in batches; and what a term costs when it is on.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "grainlaw/model/parameters.hpp"

namespace grainlaw::apps {

/// One line of the table. What does not belong to its kind is 0.
struct ModelTiming {
  /// "path": whole segments with samples, `ns` per path; "increment": one point, "batch": many, both per
  /// increment and point; "term": an increment with something off or on; "host": through the C interface, per
  /// increment and point.
  std::string kind;
  std::string path;  ///< "monotonic", "cycles", "jamming"; of a batch "at rest" or "moving" (its volume); of
                     ///< a term its name
  std::string method;  ///< "CVODE BDF", "CVODE Adams", "light", "Bogacki-Shampine", "Dormand-Prince", "RODAS"
  double rtol = 0;
  std::size_t points = 1;
  int threads = 1;
  double ns = 0;     ///< the fastest of several repetitions
  double error = 0;  ///< the largest relative L2 error of P*, sigma*_dev, F_dev along the path
};

struct ModelBench {
  std::vector<double> tolerances{1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10};
  std::vector<std::size_t> batches{1, 8, 64, 512, 4096, 32768, 262144, 1'000'000};
  int threads = 1;        ///< batches are timed with one and with so many
  double seconds = 0.02;  ///< each timing repeats for so long, at least
};

/// Times the coupled form of `parameters` (start as Fig. 4.14: nu = 0.711). `told` is called with each line
/// as it comes, and with the share of the work that is done.
std::vector<ModelTiming> time_model(const model::ParameterSet& parameters, const ModelBench& bench,
                                    const std::function<void(const ModelTiming&, double done)>& told);

/// The table as CSV, and as JSON.
std::string to_csv(const std::vector<ModelTiming>& timings);

}  // namespace grainlaw::apps
