#include "grainlaw/element/elastic_moduli.hpp"

#include <cmath>
#include <cstddef>

#include "grainlaw/element/error.hpp"

namespace grainlaw {

namespace {

/// n n/|n|^2
Sym6 dyad(const Direction& n) {
  const double square = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
  if (!(square > 0)) throw Error("a modulus needs a direction, got one of length 0");
  return {n[0] * n[0] / square, n[1] * n[1] / square, n[2] * n[2] / square,
          n[1] * n[2] / square, n[0] * n[2] / square, n[0] * n[1] / square};
}

}  // namespace

/// aa : S : ff. Shears of S C = 1 are counted twice, as the dyad of the strain's direction wants them.
double ElasticModuli::strain(const Direction& along, const Direction& from) const {
  const Sym6 a = dyad(along), f = dyad(from);
  double sum = 0;
  for (std::size_t r = 0; r < 6; ++r)
    for (std::size_t c = 0; c < 6; ++c) sum += a[r] * compliance_[r][c] * f[c];
  return sum;
}

double ElasticModuli::young(const Direction& n) const { return 1 / strain(n, n); }

double ElasticModuli::poisson(const Direction& n, const Direction& m) const {
  const double product = n[0] * m[0] + n[1] * m[1] + n[2] * m[2];
  if (!(std::abs(product) <= 1e-9 * std::hypot(n[0], n[1], n[2]) * std::hypot(m[0], m[1], m[2])))
    throw Error("Poisson's ratio needs two orthogonal directions, got some that are not");
  return -strain(m, n) / strain(n, n);
}

}  // namespace grainlaw
