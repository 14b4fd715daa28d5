// Walking a material point while two quantities out of strain, nu and stress are prescribed: the strains that
// this takes are found on the way, with the direction of shear, its reversals, the loss of contact and
// limits.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include "grainlaw/model/walk/integrator.hpp"
#include "grainlaw/model/walk/point.hpp"
#include "grainlaw/model/walk/prescribed.hpp"

namespace grainlaw::model {

/// Ends a segment where a column of a prediction passes a value.
struct StopCondition {
  std::string column;
  bool above = true;  ///< else below
  double value = 0;

  /// Positive from where it holds on; NaN where the column has no value.
  double excess(const Law& law, const State& state) const;
};

class Controlled {
 public:
  /// Walks `point`, which must outlive it, and notes its events.
  Controlled(MaterialPoint& point, Tolerance tolerance);

  /// How a segment ended.
  struct Ended {
    Status status;         ///< ok, limit (with the state where the way ended) or failed (the state as before)
    double t = 1;          ///< where
    bool stopped = false;  ///< at the stop condition
  };
  /// Both quantities begin at the state's own values. Visits the states at the fractions `samples`
  /// (ascending, in [0, 1]) up to where the segment ends.
  ///
  /// The status is limit where no strain in either direction of shear makes both change as they should (s_dev
  /// at s_max, P at its maximum), and where contact is lost while a stress is to be kept or raised.
  Ended walk(const std::array<Prescribed, 2>& controls, const std::optional<StopCondition>& stop,
             std::span<const double> samples, const MaterialPoint::Visit& visit);

 private:
  MaterialPoint& point_;
  Integrator integrator_;
};

}  // namespace grainlaw::model
