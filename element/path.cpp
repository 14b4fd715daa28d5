#include "grainlaw/element/path.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "grainlaw/element/error.hpp"

namespace grainlaw {

namespace {

constexpr std::size_t most_segments = 1'000'000;
constexpr double default_rate = 2.839e-5;      // 28.39 /s, the thesis's D2 (section 4.3)
constexpr double default_rate_iso = 5.0e-6;    // 5 /s, near the thesis's slow isotropic cycle (Fig. 2.2)
constexpr double longest_relaxation = 2000.0;  // us, 24 background relaxation times
constexpr double largest_stress =
    1000;  // over k*, and of fabric: far beyond any law, so that nothing overflows
const Range any_strain = between(-100, 100), any_rate = above_up_to(0, 1e6),
            any_duration = above_up_to(0, 1e15);
constexpr Strain3 axis_d2{-1, 1, 0};
constexpr Strain3 axis_uni{-0.5, -0.5, 1};

/// a : b
double dot(const Strain3& a, const Strain3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + 2 * (a[3] * b[3] + a[4] * b[4] + a[5] * b[5]);
}

Strain3 deviator(const Strain3& e) {
  const double mean = (e[0] + e[1] + e[2]) / 3;
  return {e[0] - mean, e[1] - mean, e[2] - mean, e[3], e[4], e[5]};
}

double magnitude(const Strain3& e) { return deviator_magnitude(e); }

bool has_deviator(const Strain3& e) {
  double sum = 0;
  for (const double component : e) sum += std::abs(component);
  return magnitude(e) > 1e-12 * sum;
}

/// The axis of a strain (see SignConvention); `before` is the axis in force, if any.
Strain3 axis_of(Mode mode, const Strain3& strain, const std::optional<Strain3>& before) {
  if (mode == Mode::d2) return axis_d2;
  if (mode == Mode::uni || mode == Mode::d3) return axis_uni;
  if (coaxial(strain, axis_d2)) return axis_d2;
  if (coaxial(strain, axis_uni)) return axis_uni;
  if (before && coaxial(strain, *before)) return *before;
  return deviator(strain);
}

const std::vector<std::string>& controls_of(Mode mode) {
  static const std::vector<std::string> volume{"nu", "eps_vol"}, all{"nu", "eps_vol", "eps_dev"},
      shape{"eps_dev"}, none;
  switch (mode) {
    case Mode::iso:
      return volume;
    case Mode::uni:
      return all;
    case Mode::d2:
    case Mode::d3:
      return shape;
    default:
      return none;
  }
}

/// Reads `controls`: exactly one target, and one that the mode moves.
void read_controls(Reader reader, Segment& segment) {
  segment.to_nu = reader.maybe_number("nu", inside(0, 1));
  segment.to_eps_vol = reader.maybe_number("eps_vol", any_strain);
  segment.to_eps_dev = reader.maybe_number("eps_dev", any_strain);
  reader.finish();
  const std::string mode = name_of(segment.mode);
  const auto& moved = controls_of(segment.mode);
  for (const auto& key : reader.keys())
    if (std::find(moved.begin(), moved.end(), key) == moved.end())
      reader.fail(key, mode + (key == "eps_dev" ? " does not shear, so eps_dev cannot be a target"
                                                : " keeps the volume, so " + key + " cannot be a target"));
  if (reader.keys().empty()) reader.fail("", "must give one target out of nu, eps_vol, eps_dev, got {}");
  if (reader.keys().size() > 1)
    reader.fail("", "redundant: in " + mode + " each of " + reader.keys()[0] + " and " + reader.keys()[1] +
                        " fixes the other; give one");
}

void read_relax(Reader& reader, Segment& segment) {
  segment.tolerance = reader.number("tolerance", inside(0, 1), 1e-6);
  segment.duration = reader.number("duration", any_duration, longest_relaxation);
}

void read_strain(Reader& reader, Segment& segment) {
  const auto strain = reader.numbers("strain", any_strain, 3);
  if (strain.size() != 3 && strain.size() != 6)
    reader.fail("strain", "must be three numbers [xx, yy, zz] or six [xx, yy, zz, yz, xz, xy], got " +
                              std::to_string(strain.size()));
  std::copy(strain.begin(), strain.end(), segment.strain.begin());
  if (segment.strain == Strain3{}) reader.fail("strain", "must not be zero");
}

void read_amount(Reader& reader, Segment& segment) {
  if (reader.has("controls") == reader.has("amount"))
    reader.fail("", reader.has("amount") ? "redundant: controls and amount both say how far; give one"
                                         : "must give either controls or amount");
  if (reader.has("controls")) read_controls(reader.object("controls"), segment);
  segment.amount = reader.maybe_number("amount", any_strain);
  if (segment.amount && *segment.amount == 0) reader.fail("amount", "must not be 0");
}

Segment read_segment(Reader& reader, std::int64_t& repeat) {
  Segment segment;
  segment.key = reader.path_of("");
  const std::string mode = reader.word("mode", {"iso", "uni", "d2", "d3", "components", "relax"});
  for (const Mode m : {Mode::iso, Mode::uni, Mode::d2, Mode::d3, Mode::components, Mode::relax})
    if (mode == name_of(m)) segment.mode = m;
  repeat = 1;
  if (segment.mode == Mode::relax) {
    read_relax(reader, segment);
    reader.finish();
    return segment;
  }
  if (segment.mode == Mode::components)
    read_strain(reader, segment);
  else
    read_amount(reader, segment);
  repeat = reader.integer("repeat", 1, static_cast<std::int64_t>(most_segments), 1);
  if (repeat > 1 && reader.has("controls"))
    reader.fail("repeat", "needs amount: a target is already reached the second time, got controls");
  segment.rate = reader.maybe_number("rate", any_rate);
  segment.duration = reader.maybe_number("duration", any_duration);
  if (segment.rate && segment.duration)
    reader.fail("duration", "redundant: rate and duration both say how fast; give one");
  if (!segment.rate && !segment.duration)
    segment.rate = segment.mode == Mode::iso ? default_rate_iso : default_rate;
  const bool shear = segment.mode == Mode::d2 || segment.mode == Mode::d3;
  const std::string profile = reader.word("profile", {"constant", "cosine"}, shear ? "constant" : "cosine");
  segment.profile = profile == "cosine" ? Profile::cosine : Profile::constant;
  reader.finish();
  return segment;
}

void append(std::vector<Segment>& all, const std::vector<Segment>& some, std::int64_t repeat,
            const Reader& reader) {
  if (some.size() * static_cast<std::size_t>(repeat) > most_segments - all.size())
    reader.fail("", "makes the path longer than " + std::to_string(most_segments) + " segments");
  for (std::int64_t i = 0; i < repeat; ++i) all.insert(all.end(), some.begin(), some.end());
}

std::vector<Segment> read_segments(Reader& owner) {
  std::vector<Segment> all;
  for (Reader& reader : owner.objects("segments")) {
    std::int64_t repeat = 1;
    if (reader.has("segments")) {
      repeat = reader.integer("repeat", 1, static_cast<std::int64_t>(most_segments), 1);
      const auto inner = read_segments(reader);
      reader.finish();
      append(all, inner, repeat, reader);
    } else {
      const Segment segment = read_segment(reader, repeat);
      append(all, {segment}, repeat, reader);
    }
  }
  return all;
}

/// Logarithmic strain of a segment, given volume fraction and accumulated strains where it begins.
Strain3 strain_of(const Segment& segment, double nu, double eps_vol, double eps_dev) {
  if (segment.mode == Mode::components) return segment.strain;
  if (segment.mode == Mode::relax) return {};
  double amount = 0;
  if (segment.amount) amount = *segment.amount;
  if (segment.to_nu) amount = std::log(*segment.to_nu / nu);
  if (segment.to_eps_vol) amount = *segment.to_eps_vol - eps_vol;
  if (segment.to_eps_dev) amount = *segment.to_eps_dev - eps_dev;
  const double d2 = amount / std::numbers::sqrt3, d3 = amount / 1.5;
  switch (segment.mode) {
    case Mode::iso:
      return {amount / 3, amount / 3, amount / 3};
    case Mode::uni:
      return {0, 0, amount};
    case Mode::d2:
      return {-d2, d2, 0};
    default:
      return {-0.5 * d3, -0.5 * d3, d3};
  }
}

/// The mode's own strain (the number `rate` multiplies): the largest component.
double largest(const Strain3& e) {
  double most = 0;
  for (const double component : e) most = std::max(most, std::abs(component));
  return most;
}

/// Three numbers where the axes stay orthogonal, else six.
Json strain_json(const Strain3& e) {
  Json list = Json::array({e[0], e[1], e[2]});
  if (e[3] != 0 || e[4] != 0 || e[5] != 0) list.insert(list.end(), {e[3], e[4], e[5]});
  return list;
}

Json start_json(const Start& start) {
  Json json = Json::object();
  const auto put = [&](const char* key, const std::optional<double>& value) {
    if (value) json[key] = *value;
  };
  put("nu", start.nu);
  put("P", start.P);
  put("sigma_dev", start.sigma_dev);
  put("F_dev", start.F_dev);
  put("phi_J", start.phi_J);
  put("phi_max", start.phi_max);
  return json;
}

Json segment_json(const Segment& segment) {
  Json json{{"mode", name_of(segment.mode)}};
  if (segment.mode == Mode::relax) {
    json["tolerance"] = segment.tolerance;
    json["duration"] = *segment.duration;
    return json;
  }
  if (segment.to_nu) json["controls"] = {{"nu", *segment.to_nu}};
  if (segment.to_eps_vol) json["controls"] = {{"eps_vol", *segment.to_eps_vol}};
  if (segment.to_eps_dev) json["controls"] = {{"eps_dev", *segment.to_eps_dev}};
  if (segment.amount) json["amount"] = *segment.amount;
  if (segment.mode == Mode::components) json["strain"] = strain_json(segment.strain);
  if (segment.rate) json["rate"] = *segment.rate;
  if (segment.duration) json["duration"] = *segment.duration;
  json["profile"] = name_of(segment.profile);
  return json;
}

}  // namespace

std::string name_of(Mode mode) {
  switch (mode) {
    case Mode::iso:
      return "iso";
    case Mode::uni:
      return "uni";
    case Mode::d2:
      return "d2";
    case Mode::d3:
      return "d3";
    case Mode::components:
      return "components";
    case Mode::relax:
      return "relax";
  }
  return "";
}

std::string name_of(Profile profile) { return profile == Profile::cosine ? "cosine" : "constant"; }

bool coaxial(const Strain3& a, const Strain3& b) {
  const Strain3 u = deviator(a), v = deviator(b);
  if (!has_deviator(a) || !has_deviator(b)) return true;
  return std::abs(dot(u, v)) >= (1 - 1e-12) * std::sqrt(dot(u, u) * dot(v, v));
}

double Leg::progress(double t) const {
  const double s = duration > 0 ? std::clamp(t / duration, 0.0, 1.0) : 1.0;
  if (profile == Profile::constant) return s;
  // sin^2 instead of (1 - cos)/2: no cancellation at the start.
  const double half = std::sin(0.5 * std::numbers::pi * s);
  return half * half;
}

double Leg::time_at(double f) const {
  f = std::clamp(f, 0.0, 1.0);
  if (profile == Profile::constant) return f * duration;
  return duration * 2 / std::numbers::pi * std::asin(std::sqrt(f));
}

Path Path::read(Reader reader) {
  Path path;
  path.file = reader.file();
  Reader start = reader.object_or_empty("start");
  path.start.nu = start.maybe_number("nu", inside(0, 1));
  path.start.P = start.maybe_number("P", between(0, largest_stress));
  path.start.sigma_dev = start.maybe_number("sigma_dev", between(-largest_stress, largest_stress));
  path.start.F_dev = start.maybe_number("F_dev", between(-largest_stress, largest_stress));
  path.start.phi_J = start.maybe_number("phi_J", inside(0, 1));
  path.start.phi_max = start.maybe_number("phi_max", inside(0, 1));
  start.finish();
  path.segments = read_segments(reader);
  reader.finish();
  if (path.start.nu) path.legs(*path.start.nu);  // targets checked before any work starts
  return path;
}

Json Path::to_json() const {
  Json list = Json::array();
  for (const Segment& segment : segments) list.push_back(segment_json(segment));
  return {{"start", start_json(start)}, {"segments", list}};
}

std::vector<Leg> Path::legs(double nu) const {
  std::vector<Leg> legs;
  legs.reserve(segments.size());
  const double nu_start = nu;
  double eps_vol = 0, eps_dev = 0;
  std::optional<Strain3> axis;
  for (const Segment& segment : segments) {
    Leg leg{segment.mode,
            strain_of(segment, nu, eps_vol, eps_dev),
            {eps_vol, 0},
            {eps_dev, 0},
            0,
            segment.profile,
            segment.tolerance};
    const double size = largest(leg.strain);
    if (segment.mode != Mode::relax && !(size > 1e-14))
      throw Error(file, segment.key, "has nothing to do: its target is the state already reached");
    leg.duration = segment.duration ? *segment.duration : size / *segment.rate;
    if (has_deviator(leg.strain)) {
      axis = axis_of(leg.mode, leg.strain, axis);
      eps_dev += std::copysign(magnitude(leg.strain), dot(leg.strain, *axis));
    }
    eps_vol += leg.strain[0] + leg.strain[1] + leg.strain[2];
    nu = nu_start * std::exp(eps_vol);
    if (!(nu > 0 && nu < 1))
      throw Error(file, segment.key,
                  "takes the volume fraction to " + to_text(nu) + "; it must stay > 0 and < 1");
    leg.eps_vol[1] = eps_vol;
    leg.eps_dev[1] = eps_dev;
    legs.push_back(leg);
  }
  return legs;
}

SignConvention::SignConvention(const std::vector<Leg>& legs) : axes_(legs.size(), axis_uni) {
  std::optional<Strain3> axis;
  std::size_t leading = 0;  // legs before the first axis is known
  for (std::size_t i = 0; i < legs.size(); ++i) {
    if (has_deviator(legs[i].strain)) {
      const bool first = !axis;
      axis = axis_of(legs[i].mode, legs[i].strain, axis);
      if (first) std::fill_n(axes_.begin(), leading, *axis);
    }
    if (axis)
      axes_[i] = *axis;
    else
      ++leading;
  }
}

double SignConvention::signed_deviator(const Sym6& q, std::size_t leg) const {
  const Strain3& axis = axes_.at(leg);
  return std::copysign(deviator_magnitude(q), dot(q, axis));
}

}  // namespace grainlaw
