// Four doubles at a time, for the kernels: one vector where the target has vectors that wide, else four
// numbers that the compiler vectorises as it can. Included by a kernel's file once per target, between
// Highway's HWY_BEFORE_NAMESPACE and HWY_AFTER_NAMESPACE, hence no include guard.
namespace grainlaw::dem::HWY_NAMESPACE {

#if HWY_MAX_BYTES >= 32

namespace hn = hwy::HWY_NAMESPACE;
constexpr hn::FixedTag<double, 4> tag;

struct Four {
  hn::Vec<decltype(tag)> v;
};
HWY_INLINE Four load(const double* p) { return {hn::LoadU(tag, p)}; }
HWY_INLINE void store(Four a, double* p) { hn::StoreU(a.v, tag, p); }
HWY_INLINE Four all(double a) { return {hn::Set(tag, a)}; }
HWY_INLINE Four operator+(Four a, Four b) { return {hn::Add(a.v, b.v)}; }
HWY_INLINE Four operator-(Four a, Four b) { return {hn::Sub(a.v, b.v)}; }
HWY_INLINE Four operator*(Four a, Four b) { return {hn::Mul(a.v, b.v)}; }
HWY_INLINE Four operator/(Four a, Four b) { return {hn::Div(a.v, b.v)}; }
/// a b + c, and c - a b, each rounded once.
HWY_INLINE Four mul_add(Four a, Four b, Four c) { return {hn::MulAdd(a.v, b.v, c.v)}; }
HWY_INLINE Four mul_sub_from(Four a, Four b, Four c) { return {hn::NegMulAdd(a.v, b.v, c.v)}; }
HWY_INLINE Four root(Four a) { return {hn::Sqrt(a.v)}; }
HWY_INLINE Four larger(Four a, Four b) { return {hn::Max(a.v, b.v)}; }
/// `a` where `test` >= 0, else 0; also where `a` is not a number.
HWY_INLINE Four where_not_negative(Four test, Four a) {
  return {hn::IfThenElseZero(hn::Ge(test.v, hn::Zero(tag)), a.v)};
}
/// One of the four, four times.
template <int which>
HWY_INLINE Four spread(Four a) {
  const auto both = hn::Broadcast<which % 2>(a.v);  // of each half
  if constexpr (which < 2)
    return {hn::ConcatLowerLower(tag, both, both)};
  else
    return {hn::ConcatUpperUpper(tag, both, both)};
}
/// The first three of `a`, the last of `b`.
HWY_INLINE Four with_last(Four a, Four b) { return {hn::IfThenElse(hn::FirstN(tag, 3), a.v, b.v)}; }
/// The sum of the four, four times.
HWY_INLINE Four sum(Four a) {
  const auto pairs = hn::Add(a.v, hn::Reverse2(tag, a.v));
  return {hn::Add(pairs, hn::SwapAdjacentBlocks(pairs))};
}
/// The first three columns of four rows.
HWY_INLINE void transpose(const Four (&row)[4], Four& x, Four& y, Four& z) {
  const auto low01 = hn::InterleaveLower(tag, row[0].v, row[1].v),
             low23 = hn::InterleaveLower(tag, row[2].v, row[3].v);
  const auto high01 = hn::InterleaveUpper(tag, row[0].v, row[1].v),
             high23 = hn::InterleaveUpper(tag, row[2].v, row[3].v);
  x = {hn::ConcatLowerLower(tag, low23, low01)};
  y = {hn::ConcatLowerLower(tag, high23, high01)};
  z = {hn::ConcatUpperUpper(tag, low23, low01)};
}

#else

struct Four {
  double v[4];
};
template <class F>
HWY_INLINE Four each(F&& f) {
  return {{f(0), f(1), f(2), f(3)}};
}
HWY_INLINE Four load(const double* p) { return {{p[0], p[1], p[2], p[3]}}; }
HWY_INLINE void store(Four a, double* p) {
  for (int k = 0; k < 4; ++k) p[k] = a.v[k];
}
HWY_INLINE Four all(double a) { return {{a, a, a, a}}; }
HWY_INLINE Four operator+(Four a, Four b) {
  return each([&](int k) { return a.v[k] + b.v[k]; });
}
HWY_INLINE Four operator-(Four a, Four b) {
  return each([&](int k) { return a.v[k] - b.v[k]; });
}
HWY_INLINE Four operator*(Four a, Four b) {
  return each([&](int k) { return a.v[k] * b.v[k]; });
}
HWY_INLINE Four operator/(Four a, Four b) {
  return each([&](int k) { return a.v[k] / b.v[k]; });
}
HWY_INLINE Four mul_add(Four a, Four b, Four c) { return a * b + c; }
HWY_INLINE Four mul_sub_from(Four a, Four b, Four c) { return c - a * b; }
HWY_INLINE Four root(Four a) {
  return each([&](int k) { return std::sqrt(a.v[k]); });
}
HWY_INLINE Four larger(Four a, Four b) {
  return each([&](int k) { return std::max(a.v[k], b.v[k]); });
}
HWY_INLINE Four where_not_negative(Four test, Four a) {
  return each([&](int k) { return test.v[k] >= 0 ? a.v[k] : 0.0; });
}
template <int which>
HWY_INLINE Four spread(Four a) {
  return all(a.v[which]);
}
HWY_INLINE Four with_last(Four a, Four b) { return {{a.v[0], a.v[1], a.v[2], b.v[3]}}; }
HWY_INLINE Four sum(Four a) { return all((a.v[0] + a.v[1]) + (a.v[2] + a.v[3])); }
HWY_INLINE void transpose(const Four (&row)[4], Four& x, Four& y, Four& z) {
  x = each([&](int k) { return row[k].v[0]; });
  y = each([&](int k) { return row[k].v[1]; });
  z = each([&](int k) { return row[k].v[2]; });
}

#endif

HWY_INLINE Four load(const Quad& q) { return load(&q.x); }
HWY_INLINE void store(Four a, Quad& q) { store(a, &q.x); }
HWY_INLINE Four first_three(const Vec3& a, double last) {
  const double four[4] = {a[0], a[1], a[2], last};
  return load(four);
}

}  // namespace grainlaw::dem::HWY_NAMESPACE
