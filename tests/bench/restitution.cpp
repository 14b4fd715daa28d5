// How far the time step of the gas bends collisions: the restitution of two grains over the closed form
// exp(-eta t_c) (Eq. 2.1), where contacts begin at all moments of a step. Usage: grainlaw_bench_restitution
#include <cmath>
#include <cstdio>
#include <numbers>

#include "grainlaw/dem/packing/cell.hpp"
#include "grainlaw/dem/step/dynamics.hpp"

namespace {

using namespace grainlaw;

constexpr double closing = 0.01;  // mm/us
constexpr int moments = 200;

dem::State two_grains(double r, double gap) {
  dem::State state;
  const double edge = 20 * r;
  state.box = dem::Mat3::diagonal({edge, edge, edge});
  state.radius = {r, r};
  state.position = {{edge / 2 - r - gap / 2, edge / 2, edge / 2},
                    {edge / 2 + r + gap / 2, edge / 2, edge / 2}};
  state.velocity = {{closing / 2, 0, 0}, {-closing / 2, 0, 0}};
  return state;
}

/// Relative velocity after over that before, for a contact that begins `moment` of a step after a step.
double restitution(const Material& material, double r, double dt, double moment) {
  dem::Dynamics dynamics(material, two_grains(r, moment * closing * dt));
  dynamics.start(dt, {});
  const auto apart = [&] {
    const auto v = dynamics.velocities();
    return v[0].x - v[1].x < 0;
  };
  const auto touch = [&] {
    const auto& g = dynamics.grains();
    return g.place[1].x - g.place[0].x < 2 * r;
  };
  do dynamics.step();
  while (touch() || !apart());
  const auto v = dynamics.velocities();
  return (v[1].x - v[0].x) / closing;
}

}  // namespace

int main() {
  Material material;
  material.gamma_b = 0;
  std::printf("%6s %10s %12s %12s %12s\n", "t_c/", "radius", "e", "mean error", "scatter");
  for (const double steps : {5.0, 10.0, 20.0, 50.0, 100.0})
    for (const double r : {0.5, 1.0, 1.5}) {
      const double dt = material.contact_duration(0.5) / steps;
      const double mass = material.rho * dem::sphere_volume(r) / 2, eta = material.gamma / (2 * mass);
      const double exact = std::exp(-eta * material.contact_duration(r));
      double mean = 0, square = 0;
      for (int k = 0; k < moments; ++k) {
        const double error = restitution(material, r, dt, (k + 0.5) / moments) / exact - 1;
        mean += error / moments;
        square += error * error / moments;
      }
      std::printf("%6g %10g %12.5f %12.2e %12.2e\n", steps, r, exact, mean, std::sqrt(square - mean * mean));
    }
}
