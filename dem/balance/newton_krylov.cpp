#include "grainlaw/dem/balance/newton_krylov.hpp"

#include <algorithm>
#include <cmath>

namespace grainlaw::dem {

namespace {

constexpr double floor_share = 0.1;               // of the contact stiffness, in the preconditioner
constexpr double most_move = 0.1;                 // of any grain in one step, in mean radii
constexpr double loosest = 0.3, tightest = 1e-8;  // by what the linear residual falls in a step
constexpr double surplus = 0.3;                   // of what is wanted
constexpr double rounding = 1e-13;                // of the energy
constexpr double steepest = 0.5;                  // slope uphill at a step's end, over that at its beginning
constexpr int most_tries = 30;

double length(const Quad& q) { return std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z); }

}  // namespace

NewtonKrylov::NewtonKrylov(StaticPacking& packing)
    : packing_(packing),
      most_radius_(most_move * packing.unit_of_length()),
      radius_(most_radius_),
      share_(loosest),
      r_(packing.count()),
      z_(packing.count()),
      p_(packing.count()),
      hp_(packing.count()) {}

void NewtonKrylov::step(double wanted) {
  find_direction(std::clamp(std::max(share_, surplus * wanted), tightest, loosest));
  go();
}

/// The way from x along p as far as the radius surely allows.
void NewtonKrylov::go_to_edge(Field& x) const {
  const double room = radius_ - std::sqrt(largest_square(x));
  if (room > 0) add(room / std::sqrt(largest_square(p_)), p_, x);
}

/// Rattlers may have no stiffness in some directions. A spring to their place, as strong as the net force on
/// each, keeps them within the radius, and fades as they come to rest.
void NewtonKrylov::hold_rattlers() {
  for (const std::uint32_t i : rattlers_) {
    const double spring = length(packing_.grains().force[i]) / most_radius_;
    hp_[i].x += spring * p_[i].x;
    hp_[i].y += spring * p_[i].y;
    hp_[i].z += spring * p_[i].z;
  }
}

/// Conjugate gradients for H x = F, x in grains().motion, r_ what is left of F.
void NewtonKrylov::find_direction(double share) {
  hessian_.build(packing_.network(), packing_.count(), &packing_.backbone());
  preconditioner_.build(hessian_, floor_share * packing_.law().typical_stiffness());
  rattlers_.clear();
  for (std::uint32_t i = 0; i < packing_.count(); ++i)
    if (!packing_.backbone().holds(i)) rattlers_.push_back(i);
  Field& x = packing_.grains().motion;
  std::fill(x.begin(), x.end(), Quad{});
  r_ = packing_.grains().force;
  preconditioner_.apply(r_, z_);
  p_ = z_;
  double rz = dot(r_, z_);
  const double enough = share * share * rz;
  cut_ = false;
  while (rz > enough) {
    hessian_.apply(p_, hp_);
    hold_rattlers();
    ++products_;
    const double curvature = dot(p_, hp_);
    cut_ = !(curvature > 0);
    if (cut_) return go_to_edge(x);
    const double alpha = rz / curvature;
    add(alpha, p_, x);
    cut_ = largest_square(x) > radius_ * radius_;
    if (cut_) {
      add(-alpha, p_, x);
      return go_to_edge(x);
    }
    add(-alpha, hp_, r_);
    preconditioner_.apply(r_, z_);
    const double next = dot(r_, z_);
    add_to_scaled(z_, next / rz, p_);
    rz = next;
  }
}

/// Along the direction to where the energy is not higher and does not rise steeply, by the secant of its
/// slope.
void NewtonKrylov::go() {
  Grains& grains = packing_.grains();
  const std::uint64_t sorts = packing_.sorts();
  const double before = packing_.network().energy, slope = dot(grains.force, grains.motion),
               size = std::sqrt(dot(grains.force, grains.force)),
               longest = std::sqrt(largest_square(grains.motion));
  double at = 0, next = 1;
  for (int n = 0; n < most_tries; ++n) {
    packing_.move(next - at);
    at = next;
    packing_.find_contacts();
    const double here = dot(grains.force, grains.motion);
    if (packing_.network().energy <= before * (1 + rounding) && here >= -steepest * slope) break;
    next = at * std::clamp(slope / (slope - here), 0.1, 0.7);
  }
  if (at < 1)
    radius_ = 2 * at * longest;
  else if (cut_)
    radius_ = std::min(2 * radius_, most_radius_);
  smooth_ = at == 1 && !cut_;
  share_ = smooth_ && sorts == packing_.sorts() ? misjudged(size) : loosest;
}

/// How far the net forces are from what the Hessian made of them, over their size before.
double NewtonKrylov::misjudged(double size) {
  add(-1, packing_.grains().force, r_);
  return std::sqrt(dot(r_, r_)) / size;
}

}  // namespace grainlaw::dem
