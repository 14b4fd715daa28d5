// The packing of a scene, or one like it that is made in seconds: what steps and rows cost is measured in it.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "grainlaw/dem/drive/stage.hpp"
#include "grainlaw/dem/packing/state.hpp"
#include "grainlaw/dem/run/leg_trial.hpp"
#include "grainlaw/dem/scene/scene.hpp"
#include "grainlaw/element/material.hpp"

namespace grainlaw::dem {

constexpr std::size_t largest_trial = 200'000;  ///< beyond, a grain costs the same

/// Whether a trial packing of a scene of so many grains is made of copies of a smaller one.
bool is_laid_out(std::size_t count);

/// A packing beside itself, so many times along each edge of its box.
State laid_out(const State& one, const std::array<std::size_t, 3>& times);
/// The same along all.
State laid_out(const State& one, std::size_t times);

/// The scene's own grains, or others like them, which are made and moved much faster than real ones: only
/// what their neighbourhoods cost matters.
class TrialPacking {
 public:
  TrialPacking(const Material& material, std::size_t count, const NewPacking& like);
  /// The scene's own grains, as a run finds them.
  TrialPacking(const Material& material, const State& own);

  /// Whether nothing has moved the scene's own grains so far.
  bool is_own() const { return own_; }

  void compress_to(double nu);
  /// Into flow, with grains that rearrange.
  void shear();
  /// To rest, about where it is: what was done in haste has left more motion than there is in a slow flow.
  void settle();
  /// Takes a stage as a run does, for `budget` processor seconds at most (see try_leg).
  std::optional<LegCost> run(const Stage& stage, double budget);

  /// Without copies beside it.
  const State& base() const { return state_; }
  State state() const;

 private:
  /// `strain_per_step` at the trial's step; a relaxation takes a thousand steps.
  void go(Mode mode, const StrainTensor& strain, double strain_per_step);

  Material material_;
  std::size_t times_ = 1;
  bool own_ = false;
  State state_;
  double step_ = 0;
};

}  // namespace grainlaw::dem
