#include "grainlaw/dem/balance/minimise.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "grainlaw/dem/balance/fire.hpp"
#include "grainlaw/dem/balance/newton_krylov.hpp"
#include "grainlaw/dem/numbers/field.hpp"
#include "grainlaw/element/error.hpp"

namespace grainlaw::dem {

namespace {

constexpr int between_looks = 10;   // steps of FIRE between two looks at the largest net force
constexpr int between_counts = 10;  // such looks between two at the contacts
constexpr int burst = 200;          // steps of FIRE after a Newton step that was not smooth
constexpr double rounded = 8;       // roundings of a place that add up in a net force

}  // namespace

Goal::Goal(const StaticPacking& packing, const MinimiseOptions& options)
    : options_(options), evaluations_before_(packing.evaluations()) {}

/// The residual that rounding of the places leaves: overlaps are small differences of large numbers.
double Goal::rounding_floor(const StaticPacking& packing, const Balance& balance) const {
  const Vec3 heights = packing.cell().heights();
  return rounded * std::numeric_limits<double>::epsilon() * std::max({heights[0], heights[1], heights[2]}) *
         packing.law().typical_stiffness() / balance.mean_force;
}

bool Goal::ends(const StaticPacking& packing, MinimiseResult& result) const {
  const Balance balance = packing.balance();
  result.balance = balance;
  result.energy = packing.network().energy;
  result.evaluations = packing.evaluations() - evaluations_before_;
  double finite = result.energy;  // grains that are nowhere touch nothing
  for (const Quad& p : packing.grains().place) finite += 0 * (p.x + p.y + p.z);
  if (!std::isfinite(finite)) throw Error("the places or the elastic energy of the grains are not finite");
  if (!balance.jammed && balance.residual <= options_.zero_overlap)
    result.outcome = Outcome::unjammed;
  else if (balance.jammed && balance.residual <= options_.residual)
    result.outcome = Outcome::balanced;
  else if (balance.jammed && balance.residual <= rounding_floor(packing, balance))
    result.outcome = Outcome::rounding;
  else if (options_.stop != nullptr && options_.stop->load(std::memory_order_relaxed))
    result.outcome = Outcome::stopped;
  else {
    result.outcome = Outcome::gave_up;
    const bool at_rest = balance.largest_net_force == 0;  // and load without a backbone: nothing would move
    return at_rest || result.evaluations + result.products >= options_.most_passes;
  }
  return true;
}

std::string MinimiseResult::text() const {
  const std::string reached =
      balance.jammed
          ? "largest net force " + to_text(balance.residual) + " of the mean contact force"
          : "no grain bears load, largest overlap " + to_text(balance.residual) + " of the mean radius";
  switch (outcome) {
    case Outcome::balanced:
      return "in balance: " + reached;
    case Outcome::unjammed:
      return "unjammed: " + reached;
    case Outcome::rounding:
      return "in balance as far as rounding allows: " + reached;
    case Outcome::gave_up:
    case Outcome::stopped:
      break;
  }
  return std::string(outcome == Outcome::stopped ? "stopped" : "not in balance") + " after " +
         std::to_string(evaluations + products) + " passes over the contacts: " + reached;
}

namespace {

void minimise_by_fire(StaticPacking& packing, const Goal& goal, MinimiseResult& result) {
  Fire fire(packing);
  fire.start();
  while (!goal.ends(packing, result)) {
    const double enough = goal.residual() * packing.balance().mean_force;
    for (int n = 0; n < between_counts; ++n) {
      fire.run(between_looks);
      result.iterations += between_looks;
      if (largest_square(packing.grains().force) <= enough * enough) break;
    }
    packing.find_contacts();
  }
}

void minimise_by_newton_krylov(StaticPacking& packing, const Goal& goal, MinimiseResult& result) {
  NewtonKrylov newton(packing);
  Fire fire(packing);
  while (!goal.ends(packing, result)) {
    newton.step(goal.residual() / result.balance.residual);
    result.products = newton.products();
    ++result.iterations;
    if (newton.smooth()) continue;
    fire.start();
    fire.run(burst);
    packing.find_contacts();
    result.iterations += burst;
  }
}

}  // namespace

MinimiseResult minimise(StaticPacking& packing, const MinimiseOptions& options) {
  MinimiseResult result;
  const Goal goal(packing, options);
  packing.find_contacts();
  if (options.method == Minimiser::fire)
    minimise_by_fire(packing, goal, result);
  else
    minimise_by_newton_krylov(packing, goal, result);
  return result;
}

}  // namespace grainlaw::dem
