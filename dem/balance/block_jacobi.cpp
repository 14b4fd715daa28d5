#include "grainlaw/dem/balance/block_jacobi.hpp"

#include <cstddef>

namespace grainlaw::dem {

void BlockJacobi::build(const ContactHessian& hessian, double floor) {
  inverse_.resize(hessian.diagonal().size());
  for (std::size_t i = 0; i < inverse_.size(); ++i) {
    const Sym6& q = hessian.diagonal()[i];
    const double a = q[0] + floor, b = q[1] + floor, c = q[2] + floor, d = q[3], e = q[4], f = q[5];
    const double aa = b * c - d * d, ff = d * e - c * f, ee = d * f - b * e;
    const double scale = 1 / (a * aa + f * ff + e * ee);
    inverse_[i].on = {aa * scale, (a * c - e * e) * scale, (a * b - f * f) * scale, 0};
    inverse_[i].off = {(e * f - a * d) * scale, ee * scale, ff * scale, 0};
  }
}

void BlockJacobi::apply(const Field& r, Field& z) const {
  for (std::size_t i = 0; i < z.size(); ++i) {
    const auto& [on, off] = inverse_[i];
    const Quad& q = r[i];
    z[i] = {on.x * q.x + off.z * q.y + off.y * q.z, off.z * q.x + on.y * q.y + off.x * q.z,
            off.y * q.x + off.x * q.y + on.z * q.z, 0};
  }
}

}  // namespace grainlaw::dem
