#include "grainlaw/dem/stiffness/floppy_modes.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "grainlaw/dem/balance/contact_hessian.hpp"
#include "grainlaw/dem/numbers/field.hpp"
#include "grainlaw/dem/numbers/random.hpp"
#include "grainlaw/dem/stiffness/six_systems.hpp"
#include "grainlaw/element/error.hpp"

namespace grainlaw::dem {

namespace {

constexpr double floor_share = 1e-3;  // of the contact stiffness, in the preconditioner
constexpr double residual = 1e-13;    // of the systems
constexpr double nothing = 1e-3;      // of a random displacement's size along one mode, which is about 1

/// Orthogonal displacements of size one, the translations of the backbone first.
class Modes {
 public:
  explicit Modes(const StaticPacking& packing) {
    Field along_x(packing.count()), along_y(packing.count()), along_z(packing.count());
    const double one = 1 / std::sqrt(static_cast<double>(packing.backbone().grains()));
    for (std::size_t g = 0; g < packing.count(); ++g) {
      if (!packing.backbone().holds(g)) continue;
      along_x[g].x = one;
      along_y[g].y = one;
      along_z[g].z = one;
    }
    list_ = {along_x, along_y, along_z};
  }
  std::size_t beyond_translations() const { return list_.size() - 3; }

  /// What of x is new, of size one; nothing where there is nothing.
  Field rest(Field x) const {
    for (int twice = 0; twice < 2; ++twice)
      for (const Field& mode : list_) add(-dot(mode, x), mode, x);
    const double size = std::sqrt(dot(x, x));
    if (size < nothing) return {};
    for (Quad& q : x) q = {q.x / size, q.y / size, q.z / size, 0};
    return x;
  }
  void take(Field mode) { list_.push_back(std::move(mode)); }

 private:
  std::vector<Field> list_;
};

/// The network without its prestress: springs alone.
ContactNetwork springs_of(const StaticPacking& packing) {
  ContactNetwork network = bearing(packing.network(), packing.backbone());
  std::fill(network.force.begin(), network.force.end(), 0.0);
  return network;
}

Field one_of(const SixFields& fields, std::size_t a) {
  Field one(fields.size());
  for (std::size_t g = 0; g < fields.size(); ++g)
    one[g] = {fields[g].q[0][a], fields[g].q[1][a], fields[g].q[2][a], 0};
  return one;
}

SixFields random_displacements(const StaticPacking& packing, Random& random) {
  SixFields fields(packing.count());
  for (std::size_t g = 0; g < packing.count(); ++g)
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t a = 0; a < 6 && packing.backbone().holds(g); ++a) fields[g].q[k][a] = random.normal();
  return fields;
}

}  // namespace

FloppyModes floppy_modes(const StaticPacking& packing, const FloppyOptions& options) {
  FloppyModes result;
  if (packing.backbone().grains() == 0) return result;
  const ContactNetwork springs = springs_of(packing);
  const double k = packing.law().typical_stiffness();
  ContactHessian hessian;
  hessian.build(springs, packing.count());
  SixSystems systems(springs, packing.count(), floor_share * k);
  SixSystems::Options solver;
  solver.residual = residual;
  solver.most_iterations = options.most_iterations;
  Modes modes(packing);
  Random random(1);
  SixFields resisted(packing.count());
  Field product(packing.count());
  for (bool found = true; found && !result.at_least;) {
    const SixFields start = random_displacements(packing, random);
    SixFields forces = systems.product(start);
    const SixSystems::Result solved = systems.solve(forces, resisted, solver);
    if (solved.gave_up)
      throw Error("floppy modes were not told from soft ones in " + std::to_string(solved.iterations) +
                  " iterations");
    result.iterations += solved.iterations;
    found = false;
    for (std::size_t a = 0; a < 6 && !result.at_least; ++a) {
      Field left = one_of(start, a);
      add(-1, one_of(resisted, a), left);
      Field mode = modes.rest(std::move(left));
      if (mode.empty()) continue;
      hessian.apply(mode, product);
      if (dot(mode, product) > options.softest * k) continue;
      modes.take(std::move(mode));
      found = true;
      result.at_least = modes.beyond_translations() == options.most_modes;
    }
  }
  result.count = modes.beyond_translations();
  return result;
}

}  // namespace grainlaw::dem
