// Many points of one law, for solvers that come with an increment for all of them: states as a structure of
// arrays, eight points to a vector, on as many threads as are asked for. What is out of the ordinary, a
// reversal, a loss of contact, a step that needs to be cut, goes through LightLaw, point by point.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "grainlaw/element/thread_pool.hpp"
#include "grainlaw/model/light/light_law.hpp"

namespace grainlaw::model {

class LightBatch {
 public:
  /// `count` points at `start`. `law` must outlive the batch.
  LightBatch(const LightLaw& law, std::size_t count, const State& start);

  std::size_t size() const { return count_; }
  State state(std::size_t i) const;
  void set_state(std::size_t i, const State& state);
  /// Of every point.
  std::span<const double> P() const { return {column(pressure), count_}; }
  std::span<const double> sigma_dev() const { return {column(stress), count_}; }
  std::span<const double> F_dev() const { return {column(fabric), count_}; }
  std::span<const double> nu() const { return {column(density), count_}; }

  struct Outcome {
    std::size_t failed = 0;  ///< points whose increment failed: their states are as before
    std::size_t first = 0;   ///< the first of them
    Status status;           ///< of the first, else ok
  };
  /// Whether points of this law run eight at a time; else each goes through LightLaw.
  static bool runs_in_lanes(const Law& law) { return std::holds_alternative<Coupled>(law); }
  /// The instruction set whose vectors this machine runs it on: "avx512", "avx2" or "baseline".
  static std::string vectors();

  /// An increment for every point: eps_vol[i], eps_dev[i] as in LightLaw::update. The answers are LightLaw's
  /// within the tolerance. Throws Error where the spans do not have size() numbers or `threads` < 1.
  Outcome update(std::span<const double> eps_vol, std::span<const double> eps_dev, int threads = 1);

 private:
  /// Columns: the state, then what its volume fraction gave when it was last asked.
  enum Column : std::size_t {
    density,
    volume_strain,
    shear_strain,
    pressure,
    stress,
    fabric,
    jamming_density_,
    jammed,
    direction,
    S_I,
    S_F_I,
    s_0,
    F_0,
    shear_strain_0,
    isotropic_jamming,
    largest_density,
    history_density,
    memory_plus,
    memory_minus,
    memory_packed,
    memory_steady,
    known_density,
    known_B,
    known_F_v,
    known_ratio,
    known_s_max,
    known_F_max,
    known_beta_F,
    columns
  };
  struct Kernel;  // light_batch.cpp

  double* column(Column which) { return values_.data() + which * stride_; }
  const double* column(Column which) const { return values_.data() + which * stride_; }
  Outcome update_range(std::size_t first, std::size_t last, const double* eps_vol, const double* eps_dev);

  const LightLaw& law_;
  std::size_t count_, stride_;  // the latter a multiple of the lanes
  std::vector<double> values_;
  std::unique_ptr<ThreadPool> team_;  // kept from update to update
};

}  // namespace grainlaw::model
