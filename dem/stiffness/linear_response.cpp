#include "grainlaw/dem/stiffness/linear_response.hpp"

#include <algorithm>
#include <cmath>

#include "grainlaw/dem/numbers/dyad.hpp"
#include "grainlaw/dem/stiffness/six_systems.hpp"
#include "grainlaw/element/error.hpp"

namespace grainlaw::dem {

namespace {

constexpr double floor_share = 1e-3;  // of the contact stiffness, in the preconditioner
constexpr double negligible =
    1e-20;  // of the energy of the affine strain: where a lattice has no forces but rounding

/// E_a l, with the shears as strains that are counted twice.
Vec3 strained(std::size_t a, const Vec3& l) {
  switch (a) {
    case 0:
      return {l[0], 0, 0};
    case 1:
      return {0, l[1], 0};
    case 2:
      return {0, 0, l[2]};
    case 3:
      return {0, 0.5 * l[2], 0.5 * l[1]};
    case 4:
      return {0.5 * l[2], 0, 0.5 * l[0]};
    default:
      return {0.5 * l[1], 0.5 * l[0], 0};
  }
}

/// A contact's block K, applied to a change of its branch.
class Block {
 public:
  Block(const ContactNetwork& network, std::size_t c)
      : n_{network.normal[c].x, network.normal[c].y, network.normal[c].z},
        distance_(network.normal[c].w),
        across_(-network.force[c] / distance_),
        along_(network.stiffness[c] - across_) {}
  Vec3 branch() const { return {distance_ * n_[0], distance_ * n_[1], distance_ * n_[2]}; }
  Vec3 operator*(const Vec3& w) const {
    const double s = along_ * dot(n_, w);
    return {s * n_[0] + across_ * w[0], s * n_[1] + across_ * w[1], s * n_[2] + across_ * w[2]};
  }

 private:
  Vec3 n_;
  double distance_, across_, along_;
};

/// -g_a: the forces on each grain when the branches are strained and the grains held.
SixFields forces_of_strain(const ContactNetwork& network, std::size_t grains) {
  SixFields force(grains);
  for (std::size_t c = 0; c < network.count; ++c) {
    const Block block(network, c);
    SixVectors &on_i = force[network.pairs[c].i], &on_j = force[network.pairs[c].j];
    for (std::size_t a = 0; a < 6; ++a) {
      const Vec3 f = block * strained(a, block.branch());
      for (std::size_t k = 0; k < 3; ++k) {
        on_i.q[k][a] -= f[k];
        on_j.q[k][a] += f[k];
      }
    }
  }
  return force;
}

Stiffness second_order(const ContactNetwork& network, double volume, const SixFields* displacement) {
  Stiffness sum{};
  for (std::size_t c = 0; c < network.count; ++c) {
    const Block block(network, c);
    const Vec3 branch = block.branch();
    std::array<Vec3, 6> w{};
    for (std::size_t a = 0; a < 6; ++a) {
      w[a] = strained(a, branch);
      if (displacement == nullptr) continue;
      const SixVectors &i = (*displacement)[network.pairs[c].i], &j = (*displacement)[network.pairs[c].j];
      for (std::size_t k = 0; k < 3; ++k) w[a][k] += i.q[k][a] - j.q[k][a];
    }
    for (std::size_t b = 0; b < 6; ++b) {
      const Vec3 kw = block * w[b];
      for (std::size_t a = 0; a <= b; ++a) sum[a][b] += dot(w[a], kw);
    }
  }
  for (std::size_t b = 0; b < 6; ++b)
    for (std::size_t a = 0; a <= b; ++a) sum[a][b] = sum[b][a] = sum[a][b] / volume;
  return sum;
}

}  // namespace

Stiffness derivative_of_stress(const Stiffness& energy, const Sym6& sigma) {
  Stiffness c = energy;
  const Mat3 s = matrix_of(sigma);
  for (std::size_t b = 0; b < 6; ++b) {
    Sym6 component{};
    component[b] = b < 3 ? 1 : 0.5;
    const Mat3 e = matrix_of(component), se = s * e, es = e * s;
    const Mat3 turned = 0.5 * (se + es);
    const Sym6 both{turned(0, 0), turned(1, 1), turned(2, 2), turned(1, 2), turned(0, 2), turned(0, 1)};
    for (std::size_t a = 0; a < 6; ++a) c[a][b] += (b < 3 ? sigma[a] : 0) - both[a];
  }
  return c;
}

LinearResponse linear_response(StaticPacking& packing, const LinearResponseOptions& options) {
  packing.find_contacts();
  const Backbone& backbone = packing.backbone();
  if (backbone.grains() == 0)
    throw Error("the packing is unjammed: no grain bears load, so it has no stiffness");
  if (backbone.contacts() < backbone.isostatic())
    throw Error("the packing is not held: " + std::to_string(backbone.contacts()) + " contacts between the " +
                std::to_string(backbone.grains()) + " grains that bear load, below the " +
                std::to_string(backbone.isostatic()) + " of an isostatic one");
  const ContactNetwork network = bearing(packing.network(), backbone);
  const std::size_t grains = packing.count();
  const double volume = packing.cell().volume();
  LinearResponse response;
  response.backbone = backbone.grains();
  response.contacts = network.count;
  for (std::size_t c = 0; c < network.count; ++c)
    add_dyad(response.prestress, network.force[c] / network.normal[c].w / volume, Block(network, c).branch());
  response.affine = second_order(network, volume, nullptr);
  SixSystems systems(network, grains, floor_share * packing.law().typical_stiffness());
  SixSystems::Options solver;
  solver.residual = options.residual;
  solver.most_iterations = options.most_iterations;
  for (std::size_t a = 0; a < 6; ++a) solver.enough[a] = negligible * volume * response.affine[a][a];
  SixFields forces = forces_of_strain(network, grains), displacement(grains);
  const SixSystems::Result result = systems.solve(forces, displacement, solver);
  if (result.gave_up)
    throw Error("the contact network's stiffness was not found in " + std::to_string(result.iterations) +
                " iterations: it is too soft, or its residual too small");
  response.iterations = result.iterations;
  response.products = result.products;
  response.unstable = static_cast<int>(std::count(result.unstable.begin(), result.unstable.end(), true));
  response.energy = second_order(network, volume, &displacement);
  response.stress = derivative_of_stress(response.energy, response.prestress);
  return response;
}

Moduli moduli_of(const Stiffness& c, const StrainTensor& axis) {
  // Along a unit deviator n (n : n = 1): sigma_dev = sqrt(3/2) n : sigma, and e = sqrt(2/3) eps_dev n,
  // because sqrt(3 J2) of a tensor is sqrt(3/2) times the size of its deviator, for stress and for strain
  // alike.
  const double mean = (axis[0] + axis[1] + axis[2]) / 3;
  Sym6 n{axis[0] - mean, axis[1] - mean, axis[2] - mean, axis[3], axis[4], axis[5]};
  const double size =
      std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] + 2 * (n[3] * n[3] + n[4] * n[4] + n[5] * n[5]));
  if (!(size > 0)) throw Error("moduli need an axis of shear, got a tensor without deviator");
  for (double& component : n) component /= size;
  const auto contracted = [&](const Sym6& left, const Sym6& right) {
    double sum = 0;
    for (std::size_t a = 0; a < 6; ++a)
      for (std::size_t b = 0; b < 6; ++b)
        sum += (a < 3 ? 1 : 2) * (b < 3 ? 1 : 2) * left[a] * c[a][b] * right[b];
    return sum;
  };
  const Sym6 one{1, 1, 1, 0, 0, 0};
  const double of_stress = std::sqrt(1.5), of_strain = std::sqrt(2.0 / 3);
  Moduli moduli;
  moduli.B = contracted(one, one) / 9;
  moduli.A1 = of_strain * contracted(one, n) / 3;
  moduli.A2 = of_stress * contracted(n, one) / 3;
  moduli.G_oct = contracted(n, n);
  return moduli;
}

}  // namespace grainlaw::dem
