// Four doubles at a time, for the kernels: one vector where the target has vectors that wide, else four
// numbers that the compiler vectorises as it can. Included by a kernel's file once per target, between
// Highway's HWY_BEFORE_NAMESPACE and HWY_AFTER_NAMESPACE, hence no include guard.
namespace grainlaw::dem::HWY_NAMESPACE {

#if HWY_MAX_BYTES >= 32

namespace hn = hwy::HWY_NAMESPACE;
constexpr hn::FixedTag<double, 4> tag;
#if HWY_MAX_BYTES >= 64
constexpr std::size_t lanes = 8;
#else
constexpr std::size_t lanes = 4;
#endif
constexpr hn::FixedTag<double, lanes> wide_tag;

template <class V>
struct Vector {
  V v;
};
using Four = Vector<hn::Vec<decltype(tag)>>;
using Wide = Vector<hn::Vec<decltype(wide_tag)>>;
HWY_INLINE Four load(const double* p) { return {hn::LoadU(tag, p)}; }
HWY_INLINE void store(Four a, double* p) { hn::StoreU(a.v, tag, p); }
HWY_INLINE Four all(double a) { return {hn::Set(tag, a)}; }
template <class V>
HWY_INLINE Vector<V> operator+(Vector<V> a, Vector<V> b) {
  return {hn::Add(a.v, b.v)};
}
template <class V>
HWY_INLINE Vector<V> operator-(Vector<V> a, Vector<V> b) {
  return {hn::Sub(a.v, b.v)};
}
template <class V>
HWY_INLINE Vector<V> operator*(Vector<V> a, Vector<V> b) {
  return {hn::Mul(a.v, b.v)};
}
template <class V>
HWY_INLINE Vector<V> operator*(double a, Vector<V> b) {
  return {hn::Mul(hn::Set(hn::DFromV<V>(), a), b.v)};
}
template <class V>
HWY_INLINE Vector<V> operator/(Vector<V> a, Vector<V> b) {
  return {hn::Div(a.v, b.v)};
}
/// a b + c, and c - a b, each rounded once.
template <class V>
HWY_INLINE Vector<V> mul_add(Vector<V> a, Vector<V> b, Vector<V> c) {
  return {hn::MulAdd(a.v, b.v, c.v)};
}
template <class V>
HWY_INLINE Vector<V> mul_sub_from(Vector<V> a, Vector<V> b, Vector<V> c) {
  return {hn::NegMulAdd(a.v, b.v, c.v)};
}
template <class V>
HWY_INLINE Vector<V> root(Vector<V> a) {
  return {hn::Sqrt(a.v)};
}
template <class V>
HWY_INLINE Vector<V> larger(Vector<V> a, Vector<V> b) {
  return {hn::Max(a.v, b.v)};
}
/// `a` where `test` >= 0, else 0; also where `a` is not a number.
template <class V>
HWY_INLINE Vector<V> where_not_negative(Vector<V> test, Vector<V> a) {
  return {hn::IfThenElseZero(hn::Ge(test.v, hn::Zero(hn::DFromV<V>())), a.v)};
}
/// One of each four, four times.
template <int which, class V>
HWY_INLINE Vector<V> spread(Vector<V> a) {
#if HWY_MAX_BYTES >= 64
  if constexpr (sizeof(V) == 64) return {V{_mm512_permutex_pd(a.v.raw, 0x55 * which)}};
#endif
  if constexpr (sizeof(V) == 32) {
    const auto both = hn::Broadcast<which % 2>(a.v);  // of each half
    if constexpr (which < 2)
      return {hn::ConcatLowerLower(tag, both, both)};
    else
      return {hn::ConcatUpperUpper(tag, both, both)};
  }
}
/// The first three of each four of `a`, the last of `b`.
template <class V>
HWY_INLINE Vector<V> with_last(Vector<V> a, Vector<V> b) {
#if HWY_MAX_BYTES >= 64
  if constexpr (sizeof(V) == 64) return {V{_mm512_mask_blend_pd(0x88, a.v.raw, b.v.raw)}};
#endif
  if constexpr (sizeof(V) == 32) return {hn::IfThenElse(hn::FirstN(tag, 3), a.v, b.v)};
}
/// The sum of each four, four times.
template <class V>
HWY_INLINE Vector<V> sum(Vector<V> a) {
  const auto pairs = hn::Add(a.v, hn::Reverse2(hn::DFromV<V>(), a.v));
  return {hn::Add(pairs, hn::SwapAdjacentBlocks(pairs))};
}
HWY_INLINE Wide load_wide(const double* p) { return {hn::LoadU(wide_tag, p)}; }
#if HWY_MAX_BYTES >= 64
HWY_INLINE void store(Wide a, double* p) { hn::StoreU(a.v, wide_tag, p); }
#endif
HWY_INLINE Wide wide(double a) { return {hn::Set(wide_tag, a)}; }
#if HWY_MAX_BYTES >= 64
HWY_INLINE Wide rows(const Quad& a, const Quad& b) {
  return {hn::Combine(wide_tag, hn::LoadU(tag, &b.x), hn::LoadU(tag, &a.x))};
}
HWY_INLINE Four lower(Wide a) { return {hn::LowerHalf(tag, a.v)}; }
HWY_INLINE Four upper(Wide a) { return {hn::UpperHalf(tag, a.v)}; }
/// The columns of rows.
HWY_INLINE void transpose(const Wide (&row)[4], Wide& x, Wide& y, Wide& z, Wide& w) {
  const auto low01 = hn::InterleaveLower(wide_tag, row[0].v, row[1].v),
             low23 = hn::InterleaveLower(wide_tag, row[2].v, row[3].v);
  const auto high01 = hn::InterleaveUpper(wide_tag, row[0].v, row[1].v),
             high23 = hn::InterleaveUpper(wide_tag, row[2].v, row[3].v);
  x = {hn::OddEvenBlocks(hn::SwapAdjacentBlocks(low23), low01)};
  y = {hn::OddEvenBlocks(hn::SwapAdjacentBlocks(high23), high01)};
  z = {hn::OddEvenBlocks(low23, hn::SwapAdjacentBlocks(low01))};
  w = {hn::OddEvenBlocks(high23, hn::SwapAdjacentBlocks(high01))};
}
#else
HWY_INLINE Wide rows(const Quad& a, const Quad&) { return {hn::LoadU(tag, &a.x)}; }
HWY_INLINE Four lower(Wide a) { return a; }
HWY_INLINE Four upper(Wide a) { return a; }
HWY_INLINE void transpose(const Wide (&row)[4], Wide& x, Wide& y, Wide& z, Wide& w) {
  const auto low01 = hn::InterleaveLower(tag, row[0].v, row[1].v),
             low23 = hn::InterleaveLower(tag, row[2].v, row[3].v);
  const auto high01 = hn::InterleaveUpper(tag, row[0].v, row[1].v),
             high23 = hn::InterleaveUpper(tag, row[2].v, row[3].v);
  x = {hn::ConcatLowerLower(tag, low23, low01)};
  y = {hn::ConcatLowerLower(tag, high23, high01)};
  z = {hn::ConcatUpperUpper(tag, low23, low01)};
  w = {hn::ConcatUpperUpper(tag, high23, high01)};
}
#endif
/// The same four, as many times as a vector holds four.
HWY_INLINE Wide wide_quad(const Quad& q) { return rows(q, q); }

#else

struct Four {
  double v[4];
};
using Wide = Four;
constexpr std::size_t lanes = 4;
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
HWY_INLINE Four operator*(double a, Four b) {
  return each([&](int k) { return a * b.v[k]; });
}
HWY_INLINE Wide wide(double a) { return all(a); }
HWY_INLINE Wide load_wide(const double* p) { return load(p); }
HWY_INLINE Wide wide_quad(const Quad& q) { return load(&q.x); }
HWY_INLINE Wide rows(const Quad& a, const Quad&) { return load(&a.x); }
HWY_INLINE Four lower(Wide a) { return a; }
HWY_INLINE Four upper(Wide a) { return a; }
HWY_INLINE void transpose(const Four (&row)[4], Four& x, Four& y, Four& z, Four& w) {
  x = each([&](int k) { return row[k].v[0]; });
  y = each([&](int k) { return row[k].v[1]; });
  z = each([&](int k) { return row[k].v[2]; });
  w = each([&](int k) { return row[k].v[3]; });
}

#endif

HWY_INLINE Four load(const Quad& q) { return load(&q.x); }
HWY_INLINE void store(Four a, Quad& q) { store(a, &q.x); }
/// A vector of one or two fours: those that lie side by side from `first` on, ...
template <class V>
HWY_INLINE V load_fours(const Quad* first) {
  if constexpr (std::is_same_v<V, Four>)
    return load(*first);
  else
    return load_wide(&first->x);
}
HWY_INLINE void store_fours(Four a, Quad* first) { store(a, *first); }
#if HWY_MAX_BYTES >= 64
HWY_INLINE void store_fours(Wide a, Quad* first) { store(a, &first->x); }
#endif
/// ... or the same one in each.
template <class V>
HWY_INLINE V first_three(const Vec3& a, double last) {
  const Quad four{a[0], a[1], a[2], last};
  if constexpr (std::is_same_v<V, Four>)
    return load(four);
  else
    return wide_quad(four);
}

}  // namespace grainlaw::dem::HWY_NAMESPACE
