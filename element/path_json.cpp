// Paths in JSON: what PATH.json may say (docs/formats.md), with named errors, and how a path is written
// again.
#include <algorithm>
#include <cmath>

#include "grainlaw/element/components.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/element/path.hpp"
#include "grainlaw/element/path_limits.hpp"
#include "grainlaw/element/words.hpp"

namespace grainlaw {

namespace {

constexpr std::size_t most_segments = 1'000'000;
constexpr double fastest = 1e6;                // 1/us
constexpr double default_rate = 2.839e-5;      // 28.39 /s, the thesis's D2 (section 4.3)
constexpr double default_rate_iso = 5.0e-6;    // 5 /s, near the thesis's slow isotropic cycle (Fig. 2.2)
constexpr double longest_relaxation = 2000.0;  // us, 24 background relaxation times
const Range any_strain = between(-largest_strain, largest_strain), any_rate = above_up_to(0, fastest),
            any_duration = above_up_to(0, longest_duration);
constexpr double default_residual = 1e-6;  // of a packing in balance, over the mean contact force
constexpr double least_increment = 1e-9, largest_increment = 0.01;
constexpr double servo_over_rate = 10;  // how much faster than the segment a servo may strain a component
constexpr std::array all_modes{
    Mode::iso,     Mode::uni,         Mode::d2,      Mode::d3,       Mode::components,
    Mode::relax,   Mode::constant_p,  Mode::biaxial, Mode::triaxial, Mode::isotropic_stress,
    Mode::control, Mode::simple_shear};

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
    case Mode::constant_p:
    case Mode::biaxial:
    case Mode::triaxial:
      return shape;
    default:
      return none;
  }
}

/// Whether a segment of this mode may prescribe two quantities: the mode then only says the axis of shear.
bool takes_two(Mode mode) {
  return mode == Mode::iso || mode == Mode::uni || mode == Mode::d2 || mode == Mode::d3;
}

/// Reads `controls`: exactly one target, and one that the mode moves; or two quantities, for the law.
void read_controls(Reader reader, Segment& segment) {
  const auto keys = reader.keys();
  const auto by_stress = [](const std::string& key) {
    return key == "P" || key == "sigma_dev" || key == "s_dev";
  };
  const bool two = keys.size() > 1 || std::any_of(keys.begin(), keys.end(), by_stress);
  const bool same = keys.size() == 2 && reader.has("nu") && reader.has("eps_vol");
  if (takes_two(segment.mode) && two && !same) {
    segment.law_controls = read_law_controls(reader);
    return;
  }
  segment.to_nu = reader.maybe_number("nu", inside(0, 1));
  segment.to_eps_vol = reader.maybe_number("eps_vol", any_strain);
  segment.to_eps_dev = reader.maybe_number("eps_dev", any_strain);
  reader.finish();
  const std::string mode = name_of(segment.mode);
  const auto& moved = controls_of(segment.mode);
  for (const auto& key : keys)
    if (std::find(moved.begin(), moved.end(), key) == moved.end())
      reader.fail(key, mode + (key == "eps_dev" ? " does not shear, so eps_dev cannot be a target"
                                                : " keeps the volume, so " + key + " cannot be a target"));
  if (keys.empty()) reader.fail("", "must give one target out of nu, eps_vol, eps_dev, got {}");
  if (keys.size() > 1)
    reader.fail("", "redundant: in " + mode + " each of " + keys[0] + " and " + keys[1] +
                        " fixes the other; give one");
}

void read_residual(Reader& reader, Segment& segment) {
  segment.residual = reader.number("residual", between(1e-12, 0.1), default_residual);
}

void read_relax(Reader& reader, Segment& segment) {
  if (reader.has("residual")) {
    for (const char* key : {"tolerance", "duration"})
      if (reader.has(key))
        reader.fail(key, "means nothing with residual: the energy is minimised, and no time passes");
    segment.duration = longest_relaxation;
    return read_residual(reader, segment);
  }
  segment.tolerance = reader.number("tolerance", inside(0, 1), 1e-6);
  segment.duration = reader.number("duration", any_duration, longest_relaxation);
}

void check_amount(const Reader& reader, double amount) {
  if (std::abs(amount) < least_strain)
    reader.fail("amount", "must be at least " + to_text(least_strain) + " in size, got " + to_text(amount));
}

void read_strain(Reader& reader, Segment& segment) {
  const auto strain = reader.numbers("strain", any_strain, 3);
  if (strain.size() != 3 && strain.size() != 6)
    reader.fail("strain", "must be three numbers [xx, yy, zz] or six [xx, yy, zz, yz, xz, xy], got " +
                              std::to_string(strain.size()));
  std::copy(strain.begin(), strain.end(), segment.strain.begin());
  if (largest_component(segment.strain) < least_strain)
    reader.fail("strain", "must have a component of at least " + to_text(least_strain) + " in size");
}

void read_amount(Reader& reader, Segment& segment) {
  if (!reader.has("controls") && !reader.has("amount"))
    for (const std::string& key : reader.keys())
      if (const std::string meant = nearest_word(key, {"controls", "amount"}); !meant.empty())
        reader.fail(key, "unknown key, did you mean " + meant + "?");
  if (reader.has("controls") == reader.has("amount"))
    reader.fail("", reader.has("amount") ? "redundant: controls and amount both say how far; give one"
                                         : "must give either controls or amount");
  if (reader.has("controls")) read_controls(reader.object("controls"), segment);
  segment.amount = reader.maybe_number("amount", any_strain);
  if (segment.amount) check_amount(reader, *segment.amount);
}

/// What component c of mode control follows.
void read_component(Reader reader, std::size_t c, Segment& segment) {
  if (reader.has("strain") == reader.has("stress"))
    reader.fail("", reader.has("strain")
                        ? "redundant: strain and stress both control this component; give one"
                        : "must give strain or stress");
  if (reader.has("strain"))
    segment.strain[c] = reader.number("strain", any_strain);
  else
    segment.control.component[c] =
        read_target(reader, "stress", c < 3 ? target_range() : shear_target_range());
  reader.finish();
}

/// Shear components by the order that is not theirs: nearest_word would take "yx" for "x".
void refuse_other_order(const Reader& reader) {
  for (std::size_t c = 3; c < 6; ++c) {
    const std::string name = control_keys[c], other(name.rbegin(), name.rend());
    if (reader.has(other)) reader.fail(other, "unknown key, did you mean " + name + "?");
  }
}

/// x, y, z of mode control, the shear components where they are given, and P.
void read_components(Reader& reader, Segment& segment) {
  for (std::size_t c = 0; c < 6; ++c) {
    const char* const name = control_keys[c];
    if (c >= 3) reader.optional({name});
    if (c < 3 || reader.has(name)) read_component(reader.object(name), c, segment);
  }
  refuse_other_order(reader);
  reader.optional({"P"});
  if (!reader.has("P")) return;
  if (segment.control.axis_by_stress())
    reader.fail("P", "needs a strain on each of x, y, z: the isotropic strain that keeps P adds to it");
  segment.control.mean = read_target(reader, "P");
}

/// What the mode controls, and how far it goes.
void read_what(Reader& reader, Segment& segment) {
  Control& control = segment.control;
  switch (segment.mode) {
    case Mode::components:
      return read_strain(reader, segment);
    case Mode::control:
      return read_components(reader, segment);
    case Mode::isotropic_stress:
      control.component[0] = control.component[1] = control.component[2] =
          StressTarget{reader.number("P", target_range())};
      return;
    case Mode::constant_p:
      segment.shear = reader.word("shear", {"d2", "d3"}, "d2") == "d2" ? Mode::d2 : Mode::d3;
      control.mean = read_target_or_start(reader, "P");
      break;
    case Mode::simple_shear:
      if (reader.has("controls"))
        reader.fail("controls", "means nothing in simple_shear; give amount, its gamma");
      segment.amount = reader.number("amount", any_strain);
      check_amount(reader, *segment.amount);
      return;
    case Mode::biaxial:
      control.component[0] = read_target_or_start(reader, "stress");
      break;
    case Mode::triaxial:
      control.component[0] = control.component[1] = read_target_or_start(reader, "stress");
      break;
    default:
      break;
  }
  read_amount(reader, segment);
}

void read_quasistatic(Reader& reader, Segment& segment) {
  if (segment.control.by_stress())
    reader.fail("profile", "must not be quasistatic under stress control: a servo needs time");
  if (segment.mode == Mode::control)
    reader.fail("profile", "must not be quasistatic in control; with strains alone, components is the same");
  for (const char* key : {"rate", "duration"})
    if (reader.has(key)) reader.fail(key, "means nothing in a quasistatic segment: no time passes");
  segment.increment =
      reader.number("increment", between(least_increment, largest_increment), segment.increment);
  read_residual(reader, segment);
}

void read_profile(Reader& reader, Segment& segment) {
  const bool rests =
      segment.mode == Mode::iso || segment.mode == Mode::uni || segment.mode == Mode::components;
  static const std::array all{Profile::constant, Profile::cosine, Profile::steered, Profile::quasistatic};
  std::vector<std::string> names;
  for (const Profile profile : all)
    if (segment.mode != Mode::simple_shear || profile == Profile::constant || profile == Profile::cosine)
      names.push_back(name_of(profile));
  const std::string profile = reader.word("profile", names, rests ? "cosine" : "constant");
  segment.profile =
      all[static_cast<std::size_t>(std::find(names.begin(), names.end(), profile) - names.begin())];
  if (segment.profile == Profile::quasistatic) return read_quasistatic(reader, segment);
  if (segment.profile == Profile::steered) {
    segment.wanted_ratio = reader.number("Ek_over_Ep", inside(0, 1), segment.wanted_ratio);
    if (segment.duration) reader.fail("duration", "means nothing with a steered rate; give rate");
  }
  const bool axial = segment.mode == Mode::biaxial || segment.mode == Mode::triaxial;
  if (!axial || !segment.to_eps_dev) return;
  const std::string why =
      " with controls.eps_dev: how far the axis goes is known only then; give amount, the axial strain";
  if (segment.profile == Profile::cosine) reader.fail("profile", "must not be cosine" + why);
  if (segment.duration) reader.fail("duration", "must not be given" + why);
}

void read_pace(Reader& reader, Segment& segment) {
  segment.rate = reader.maybe_number("rate", any_rate);
  if (segment.mode != Mode::isotropic_stress) {
    segment.duration = reader.maybe_number("duration", any_duration);
    if (segment.rate && segment.duration)
      reader.fail("duration", "redundant: rate and duration both say how fast; give one");
  }
  if (!segment.rate && !segment.duration)
    segment.rate =
        segment.mode == Mode::iso || segment.mode == Mode::isotropic_stress ? default_rate_iso : default_rate;
  if (segment.mode != Mode::isotropic_stress) read_profile(reader, segment);
  if (!segment.control.by_stress()) return;
  const double rate = segment.rate.value_or(default_rate) * (segment.only_waits() ? 1 : servo_over_rate);
  segment.control.servo = read_servo(reader.object_or_empty("servo"), std::min(rate, fastest));
}

void check_drive(const Reader& reader, const Segment& segment) {
  if (segment.mode != Mode::control) return;
  if (!segment.only_waits() && largest_component(segment.strain) < least_strain)
    reader.fail("", "must have a strain of at least " + to_text(least_strain) +
                        " in size, or none but 0, got " + to_text(largest_component(segment.strain)));
  if (!segment.only_waits()) return;
  if (!segment.control.by_stress())
    reader.fail("", "has nothing to do: no component has a strain or a stress");
  for (const char* key : {"duration", "profile"})
    if (reader.has(key)) reader.fail(key, "means nothing here: no component is strained");
}

Segment read_segment(Reader& reader, std::int64_t& repeat) {
  Segment segment;
  segment.key = reader.path_of("");
  std::vector<std::string> modes;
  for (const Mode mode : all_modes) modes.push_back(name_of(mode));
  const std::string mode = reader.word("mode", modes);
  segment.mode =
      all_modes[static_cast<std::size_t>(std::find(modes.begin(), modes.end(), mode) - modes.begin())];
  repeat = 1;
  if (segment.mode == Mode::relax) {
    read_relax(reader, segment);
    reader.finish();
    return segment;
  }
  read_what(reader, segment);
  if (segment.mode != Mode::isotropic_stress)
    repeat = reader.integer("repeat", 1, static_cast<std::int64_t>(most_segments), 1);
  if (repeat > 1 && reader.has("controls"))
    reader.fail("repeat", "needs amount: a target is already reached the second time, got controls");
  read_pace(reader, segment);
  check_drive(reader, segment);
  reader.optional({"stop"});
  if (reader.has("stop")) segment.stop = read_stop(reader.object("stop"));
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

/// Three numbers where the axes stay orthogonal, else six.
Json strain_json(const StrainTensor& e) {
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

void put_components(Json& json, const Segment& segment) {
  for (std::size_t c = 0; c < 6; ++c) {
    if (const auto* target = std::get_if<StressTarget>(&segment.control.component[c]))
      json[control_keys[c]] = {{"stress", grainlaw::to_json(*target)}};
    else if (c < 3 || segment.strain[c] != 0)
      json[control_keys[c]] = {{"strain", segment.strain[c]}};
  }
}

void put_targets(Json& json, const Segment& segment) {
  const auto& component = segment.control.component;
  const auto target = [&](std::size_t c) { return grainlaw::to_json(std::get<StressTarget>(component[c])); };
  if (segment.mode == Mode::constant_p) json["shear"] = name_of(segment.shear);
  if (segment.mode == Mode::control) put_components(json, segment);
  if (segment.mode == Mode::biaxial || segment.mode == Mode::triaxial) json["stress"] = target(0);
  if (segment.mode == Mode::isotropic_stress) json["P"] = target(0);
  if (segment.control.mean) json["P"] = grainlaw::to_json(*segment.control.mean);
}

Json segment_json(const Segment& segment) {
  Json json{{"mode", name_of(segment.mode)}};
  if (segment.stop) json["stop"] = grainlaw::to_json(*segment.stop);
  if (segment.mode == Mode::relax) {
    if (segment.residual) return {{"mode", "relax"}, {"residual", *segment.residual}};
    json["tolerance"] = segment.tolerance;
    json["duration"] = *segment.duration;
    return json;
  }
  if (segment.to_nu) json["controls"] = {{"nu", *segment.to_nu}};
  if (segment.to_eps_vol) json["controls"] = {{"eps_vol", *segment.to_eps_vol}};
  if (segment.to_eps_dev) json["controls"] = {{"eps_dev", *segment.to_eps_dev}};
  if (!segment.law_controls.empty()) json["controls"] = grainlaw::to_json(segment.law_controls);
  if (segment.amount) json["amount"] = *segment.amount;
  if (segment.mode == Mode::components) json["strain"] = strain_json(segment.strain);
  put_targets(json, segment);
  if (segment.residual) {
    json["profile"] = name_of(segment.profile);
    json["increment"] = segment.increment;
    json["residual"] = *segment.residual;
    return json;
  }
  if (segment.rate) json["rate"] = *segment.rate;
  if (segment.duration) json["duration"] = *segment.duration;
  if (!segment.only_waits()) json["profile"] = name_of(segment.profile);
  if (segment.profile == Profile::steered) json["Ek_over_Ep"] = segment.wanted_ratio;
  if (segment.control.by_stress()) json["servo"] = grainlaw::to_json(segment.control.servo);
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
    case Mode::constant_p:
      return "constant_p";
    case Mode::biaxial:
      return "biaxial";
    case Mode::triaxial:
      return "triaxial";
    case Mode::isotropic_stress:
      return "isotropic_stress";
    case Mode::control:
      return "control";
    case Mode::simple_shear:
      return "simple_shear";
  }
  return "";
}

std::string name_of(Profile profile) {
  switch (profile) {
    case Profile::constant:
      return "constant";
    case Profile::cosine:
      return "cosine";
    case Profile::steered:
      return "steered";
    case Profile::quasistatic:
      return "quasistatic";
  }
  return "";
}

Start Start::read(Reader reader) {
  Start start;
  start.nu = reader.maybe_number("nu", inside(0, 1));
  start.P = reader.maybe_number("P", of_k_star(between(0, largest_stress)));
  start.sigma_dev = reader.maybe_number("sigma_dev", of_k_star(between(-largest_stress, largest_stress)));
  start.F_dev = reader.maybe_number("F_dev", between(-largest_ratio, largest_ratio));
  start.phi_J = reader.maybe_number("phi_J", inside(0, 1));
  start.phi_max = reader.maybe_number("phi_max", inside(0, 1));
  reader.finish();
  return start;
}

Path Path::read(Reader reader) {
  Path path;
  path.file = reader.file();
  path.start = Start::read(reader.object_or_empty("start"));
  path.segments = read_segments(reader);
  reader.finish();
  if (path.start.nu) path.nominal_legs(*path.start.nu);  // targets checked before any work starts
  return path;
}

Json Path::to_json() const {
  Json list = Json::array();
  for (const Segment& segment : segments) list.push_back(segment_json(segment));
  return {{"start", start_json(start)}, {"segments", list}};
}

}  // namespace grainlaw
