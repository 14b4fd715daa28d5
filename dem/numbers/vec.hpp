// Small vectors: three numbers to compute with, four to store (one 32-byte line per grain and field).
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <new>
#include <vector>

namespace grainlaw::dem {

using Vec3 = std::array<double, 3>;

/// Four doubles in one aligned line; what the fourth one is, the owner says.
struct alignas(32) Quad {
  double x = 0, y = 0, z = 0, w = 0;
};

/// Begins where a cache line does, so that no vector of two Quads lies across two lines.
template <class T>
struct CacheLineAllocator {
  using value_type = T;
  static constexpr std::align_val_t line{64};
  CacheLineAllocator() = default;
  template <class U>
  CacheLineAllocator(const CacheLineAllocator<U>&) {}
  T* allocate(std::size_t count) { return static_cast<T*>(::operator new(count * sizeof(T), line)); }
  void deallocate(T* at, std::size_t) { ::operator delete(at, line); }
  bool operator==(const CacheLineAllocator&) const { return true; }
};
using Quads = std::vector<Quad, CacheLineAllocator<Quad>>;

/// As vectors of numbers have it, for a contact law.
inline double root(double a) { return std::sqrt(a); }
inline double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline double norm(const Vec3& a) { return std::sqrt(dot(a, a)); }

}  // namespace grainlaw::dem
