// A trial of a scene's engine in one packing: what steps, rows, observers and files take on this machine now.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "grainlaw/dem/drive/stage.hpp"
#include "grainlaw/dem/packing/state.hpp"
#include "grainlaw/dem/run/moduli_cost.hpp"
#include "grainlaw/dem/step/dynamics.hpp"
#include "grainlaw/element/material.hpp"

namespace grainlaw::dem {

/// Per grain of the packing, in seconds and bytes.
struct TrialCost {
  double nu = 0;
  double step = 0, force = 0;
  double damping = 0;  ///< of `force`: the viscous term
  double row = 0;
  std::vector<double> observers;
  double contacts = 0, pairs = 0;
  double engine_bytes = 0;
  double threads_bytes = 0;  ///< what several threads hold beside that
  double snapshot = 0, checkpoint = 0, checkpoint_bytes = 0;
  ModuliCost moduli;  ///< of a state, not per grain
};

/// The largest component of a leg's strain, or its gamma.
double largest_strain(const Leg& leg);

constexpr double usual_steps = 0.15;  ///< s, of steps at each density
constexpr double own_steps = 1;       ///< s, of grains as the run finds them: their flow is the run's own

class Trial {
 public:
  /// At the mean rate of `stage` and with its step; where that minimises, with a step of the default. The box
  /// is strained to and fro, by little where that changes the density.
  Trial(const Material& material, const State& state, const Stage& stage);

  /// What was brought to rest comes to move as a fast flow does, in 0.4 s at most: at rest, lists live
  /// longer.
  void flow_in();
  void steps(double seconds = usual_steps);
  /// Of the columns of the groups `standard`, and of each observer, with what is measured for it beside
  /// these.
  void rows(const std::vector<std::string>& standard, const std::vector<std::string>& observers);
  /// What `threads` hold.
  void threads(int threads);
  void snapshot();
  void checkpoint();
  /// Of a state of `grains` grains, the mean over some that `flowing` ones go through in `stage`, no more
  /// than are `asked` for, or three: few take much longer than most.
  void moduli(const State& flowing, const Stage& stage, std::size_t grains, std::size_t asked);
  const TrialCost& cost() const { return cost_; }
  /// Where box and grains are now.
  const Dynamics& dynamics() const { return dynamics_; }

 private:
  template <class Call, class Before>
  double seconds_between_steps(Call&& call, Before&& before);
  double seconds_to_measure(const Wanted& wanted);
  double seconds_to_observe(const std::string& name, const Wanted& standard);
  void step();

  const Material& material_;
  State start_;
  double dt_;
  double grains_;
  Mat3 gradient_, stretch_;        ///< of a step
  std::uint64_t steps_a_way_ = 0;  ///< 0: as many as there are
  std::uint64_t steps_gone_ = 0;   ///< since it turned round
  double heap_before_;
  Dynamics dynamics_;
  TrialCost cost_;
};

}  // namespace grainlaw::dem
