// The fast inertial relaxation engine of Bitzek et al. (2006) with the corrections of Guenole et al. (2020):
// damped dynamics of grains of equal mass whose time step adapts.
#pragma once

#include "grainlaw/dem/balance/static_packing.hpp"

namespace grainlaw::dem {

class Fire {
 public:
  explicit Fire(StaticPacking& packing);
  /// From rest; needs the forces at the places as they are.
  void start();
  /// Some steps on; needs the forces before and computes those after it.
  void run(int steps);

 private:
  StaticPacking& packing_;
  double unit_;  ///< of pseudo time
  double dt_ = 0, mixing_ = 0;
  int downhill_ = 0;
};

}  // namespace grainlaw::dem
