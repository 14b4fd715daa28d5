// Timings of the law that the model's bench takes besides those of its integrators: what is off and on, and
// the C interface.
#pragma once

#include <chrono>
#include <functional>
#include <limits>

#include "grainlaw/apps/bench_model.hpp"
#include "grainlaw/model/status.hpp"

namespace grainlaw::apps {

/// Nanoseconds of the fastest of the repetitions that fit into `seconds`, at least one; `before` each is not
/// timed.
template <class Before, class F>
double fastest_of(double seconds, Before before, F f) {
  using Clock = std::chrono::steady_clock;
  double best = std::numeric_limits<double>::infinity(), total = 0;
  while (total < seconds) {
    before();
    const auto begin = Clock::now();
    f();
    const double took = std::chrono::duration<double>(Clock::now() - begin).count();
    best = std::min(best, took);
    total += took;
  }
  return 1e9 * best;
}

template <class F>
double fastest(double seconds, F f) {
  return fastest_of(
      seconds, [] {}, f);
}

/// Throws Error for a status that failed.
void check(const model::Status& status);

using TimingSink = std::function<void(const ModelTiming&)>;

/// Kind "term": increments of 1e-4 at nu = 0.711 with each of tangent, terms and memory off and on, at rest
/// and with a volume that moves, and a path with all sensitivities and none. Numbers of a term that the set
/// lacks are made up: time does not depend on them.
void time_terms(const model::ParameterSet& parameters, double seconds, const TimingSink& told);

/// Kind "host": the same increments through the C interface, one point and many of many densities.
void time_hosts(const model::ParameterSet& parameters, const ModelBench& bench, const TimingSink& told);

}  // namespace grainlaw::apps
