#include "grainlaw/dem/scene/scene.hpp"

#include <algorithm>
#include <cmath>

#include "grainlaw/dem/observe/names.hpp"
#include "grainlaw/dem/step/dynamics.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/element/short_text.hpp"
#include "grainlaw/element/words.hpp"

namespace grainlaw::dem {

namespace {

constexpr std::int64_t fewest_grains = 8, most_grains = 10'000'000;
constexpr std::int64_t largest_seed = std::int64_t{1} << 53;  ///< JSON readers keep whole numbers up to here
constexpr std::int64_t most_frames = 1'000'000'000;
constexpr std::int64_t most_rows = 100'000, most_segments = 1'000'000;
constexpr double fastest = 1e6;       // mm/us, 1/us: far beyond sense, so that nothing overflows
constexpr double densest_gas = 0.45;  ///< random placement without overlap slows down without limit beyond
constexpr double largest_step = 0.2;  ///< of the smallest contact duration
constexpr double smallest_contact_error = 1e-12, largest_contact_error = 0.0169;  ///< at that step
constexpr double radius_slack =
    0.01;  ///< mean and spread of radii may differ so much from the material's, in r_mean
constexpr double target_slack = 1e-9;  ///< a target equal to an end of its segment up to rounding is inside

Relaxation read_relaxation(Reader reader) {
  Relaxation relax;
  relax.tolerance = reader.number("tolerance", inside(0, 1), relax.tolerance);
  relax.duration = reader.number("duration", above(0), relax.duration);
  reader.finish();
  return relax;
}

StateRequest read_request(Reader& reader) {
  StateRequest request;
  request.segment = static_cast<std::size_t>(reader.integer("segment", 0, most_segments - 1));
  request.nu = reader.maybe_number("nu", inside(0, 1));
  request.eps_dev = reader.maybe_number("eps_dev", any_number());
  if (request.nu && request.eps_dev)
    reader.fail("eps_dev", "redundant: nu already says where in the segment; give one");
  reader.finish();
  return request;
}

/// Some of the words that are known, in their order, which is that of their columns.
std::vector<std::string> read_asked(Reader& reader, const char* key, const std::vector<std::string>& known,
                                    const std::vector<std::string>& fallback, const HintOnWord& hint) {
  std::vector<std::string> asked = read_words(reader, key, known, fallback, hint);
  const auto rank = [&](const std::string& name) { return std::find(known.begin(), known.end(), name); };
  std::sort(asked.begin(), asked.end(), [&](const auto& a, const auto& b) { return rank(a) < rank(b); });
  return asked;
}

/// Who asks for one column by its name in place of what brings it.
std::string hint_on_column(const std::string& word) {
  if (const std::string group = group_of_column(word); !group.empty())
    return ", a column of " + group + " in measure.standard";
  for (const std::string& name : observe::names()) {
    const std::vector<std::string> columns = observe::columns({name});
    if (std::find(columns.begin(), columns.end(), word) != columns.end())
      return ", a column of " + name + " in measure.observe";
  }
  return "";
}

/// A DEM measures these at the start; only nu can be chosen.
void refuse_prescribed(const Path& path, const Reader& reader) {
  const std::pair<const char*, std::optional<double>> measured[] = {{"P", path.start.P},
                                                                    {"sigma_dev", path.start.sigma_dev},
                                                                    {"F_dev", path.start.F_dev},
                                                                    {"phi_J", path.start.phi_J},
                                                                    {"phi_max", path.start.phi_max}};
  for (const auto& [key, value] : measured)
    if (value)
      reader.fail(
          std::string("path.start.") + key,
          "must be left out: grains measure it, they cannot be given it (only nu may be given), got " +
              to_text(*value));
}

/// Lets path.start.nu and the preparation say the same.
void agree_on_start(Scene& scene, const Reader& reader) {
  const auto& nu = scene.path.start.nu;
  if (!nu) return;
  if (const auto* packing = std::get_if<NewPacking>(&scene.preparation)) {
    if (*nu != packing->nu)
      reader.fail("path.start.nu",
                  "must be preparation.nu = " + to_text(packing->nu) + ", got " + to_text(*nu));
    return;
  }
  auto& choice = std::get<FromSnapshot>(scene.preparation).choice;
  if (choice.frame)
    reader.fail("path.start.nu", "redundant: preparation.frame already chooses the state; give one");
  if (choice.nu && *choice.nu != *nu)
    reader.fail("path.start.nu", "must be preparation.nu = " + to_text(*choice.nu) + ", got " + to_text(*nu));
  choice.nu = nu;
}

/// Throws Error unless the value lies between the two ends of a segment that moves it.
void check_target(const StateRequest& request, const std::string& list, std::size_t index, const Leg& leg,
                  double nu_start, const std::string& file) {
  if (!request.nu && !request.eps_dev) return;
  const bool by_nu = request.nu.has_value();
  const std::string name = by_nu ? "nu" : "eps_dev";
  const double wanted = by_nu ? *request.nu : *request.eps_dev;
  double low = by_nu ? nu_start * std::exp(leg.eps_vol[0]) : leg.eps_dev[0];
  double high = by_nu ? nu_start * std::exp(leg.eps_vol[1]) : leg.eps_dev[1];
  const std::string segment = "segment " + std::to_string(request.segment) + " (" + name_of(leg.mode) + ")";
  const std::string key = "measure." + list + "[" + std::to_string(index) + "]." + name;
  if (std::abs(high - low) <= target_slack)
    throw Error(file, key,
                segment + " does not change " + name + ", so it has no such place, got " + to_text(wanted));
  const std::string range = to_text(low) + " to " + to_text(high);
  if (low > high) std::swap(low, high);
  if (wanted < low - target_slack || wanted > high + target_slack)
    throw Error(file, key,
                "must lie in " + segment + ", " + name + " from " + range + ", got " + to_text(wanted));
}

/// Without links and dots, whether or not there is something at that place.
std::filesystem::path resolved(const std::filesystem::path& path) {
  return std::filesystem::weakly_canonical(std::filesystem::absolute(path));
}

void check_segments_exist(const Scene& scene, const std::string& list,
                          const std::vector<StateRequest>& requests) {
  const std::size_t count = scene.path.segments.size();
  for (std::size_t i = 0; i < requests.size(); ++i)
    if (requests[i].segment >= count)
      throw Error(scene.file, "measure." + list + "[" + std::to_string(i) + "].segment",
                  "must be a segment of the path, 0 to " + std::to_string(count - 1) + ", got " +
                      std::to_string(requests[i].segment));
}

std::vector<StateRequest> read_requests(Reader& reader, const char* list,
                                        const std::vector<StateRequest>& fallback) {
  if (!reader.has(list)) return fallback;
  std::vector<StateRequest> requests;
  for (Reader& request : reader.objects_or_none(list)) requests.push_back(read_request(request));
  return requests;
}

Json requests_json(const std::vector<StateRequest>& requests) {
  Json list = Json::array();
  for (const StateRequest& request : requests) {
    Json item{{"segment", request.segment}};
    if (request.nu) item["nu"] = *request.nu;
    if (request.eps_dev) item["eps_dev"] = *request.eps_dev;
    list.push_back(item);
  }
  return list;
}

/// Each has one row in moduli.csv.
void check_different(const Reader& reader, const std::vector<StateRequest>& moduli) {
  for (std::size_t i = 1; i < moduli.size(); ++i)
    if (std::find(moduli.begin(), moduli.begin() + static_cast<std::ptrdiff_t>(i), moduli[i]) !=
        moduli.begin() + static_cast<std::ptrdiff_t>(i))
      reader.fail("moduli[" + std::to_string(i) + "]", "asks for the same state as an earlier one");
}

}  // namespace

NewPacking NewPacking::read(Reader reader, SeedKey seed_key) {
  NewPacking packing;
  packing.count = reader.integer("count", fewest_grains, most_grains, packing.count);
  if (seed_key == SeedKey::optional)
    packing.seed = static_cast<std::uint64_t>(reader.integer("seed", 0, largest_seed, 1));
  else if (reader.has("seed"))
    reader.fail("seed", "must be left out: the campaign's seeds are used");
  packing.nu_gas = reader.number("nu_gas", above_up_to(0, densest_gas), packing.nu_gas);
  packing.speed = reader.number("speed", above_up_to(0, fastest), packing.speed);
  packing.nu = reader.number("nu", inside(packing.nu_gas, 1), packing.nu);
  packing.rate = reader.number("rate", above_up_to(0, fastest), packing.rate);
  packing.relax = read_relaxation(reader.object_or_empty("relax"));
  reader.finish();
  return packing;
}

Json NewPacking::to_json() const {
  return {{"count", count},
          {"seed", seed},
          {"nu_gas", nu_gas},
          {"speed", speed},
          {"nu", nu},
          {"rate", rate},
          {"relax", {{"tolerance", relax.tolerance}, {"duration", relax.duration}}}};
}

FromSnapshot FromSnapshot::read(Reader reader, const std::filesystem::path& scene_dir) {
  FromSnapshot from;
  from.snapshot = reader.text("snapshot");
  if (from.snapshot.empty()) reader.fail("snapshot", "must be the path of a snapshots.h5, got \"\"");
  from.file = scene_dir / from.snapshot;
  from.choice.nu = reader.maybe_number("nu", inside(0, 1));
  const auto index = [&](std::string_view key, std::int64_t most) -> std::optional<std::uint64_t> {
    const std::int64_t value = reader.integer(key, 0, most, -1);
    if (value < 0) return std::nullopt;
    return static_cast<std::uint64_t>(value);
  };
  from.choice.frame = index("frame", most_frames);
  from.choice.segment = index("segment", most_segments - 1);
  if (from.choice.frame && from.choice.nu)
    reader.fail("frame", "redundant: nu already chooses the state; give one");
  if (from.choice.frame && from.choice.segment)
    reader.fail("segment", "redundant: frame already chooses the state; give one");
  reader.finish();
  return from;
}

Json FromSnapshot::to_json(const std::filesystem::path& dir) const {
  auto path = snapshot;
  if (!dir.empty() && path.is_relative()) path = resolved(file).lexically_relative(resolved(dir));
  Json json{{"snapshot", path.generic_string()}};
  if (choice.nu) json["nu"] = *choice.nu;
  if (choice.frame) json["frame"] = *choice.frame;
  if (choice.segment) json["segment"] = *choice.segment;
  return json;
}

/// A share of the contact duration, or {"error": x}: the step at which a contact lasts too short by a share
/// x.
double read_step(Reader& reader, const std::string& key, double fallback) {
  if (!reader.has(key) || !reader.raw(key).is_object())
    return reader.number(key, above_up_to(0, largest_step), fallback);
  Reader wanted = reader.object(key);
  const double error = wanted.number("error", between(smallest_contact_error, largest_contact_error));
  wanted.finish();
  return step_of_contact_error(error);
}

Measure Measure::read(Reader reader, const Measure& fallback) {
  Measure measure = fallback;
  measure.rows = reader.integer("rows", 1, most_rows, fallback.rows);
  measure.snapshots = read_requests(reader, "snapshots", fallback.snapshots);
  measure.moduli = read_requests(reader, "moduli", fallback.moduli);
  check_different(reader, measure.moduli);
  measure.time_step = read_step(reader, "time_step", fallback.time_step);
  measure.time_step_gas = read_step(reader, "time_step_gas", fallback.time_step_gas);
  measure.standard = read_asked(reader, "standard", column_groups(), fallback.standard, hint_on_column);
  measure.observe = read_asked(reader, "observe", observe::names(), fallback.observe, hint_on_column);
  reader.finish();
  return measure;
}

Json Measure::to_json() const {
  return {
      {"rows", rows},           {"snapshots", requests_json(snapshots)}, {"moduli", requests_json(moduli)},
      {"time_step", time_step}, {"time_step_gas", time_step_gas},        {"standard", standard},
      {"observe", observe}};
}

Scene Scene::read(Reader reader, const std::filesystem::path& scene_dir) {
  Scene scene;
  scene.file = reader.file();
  scene.material = Material::read(reader.object_or_empty("material"));
  Reader preparation = reader.object_or_empty("preparation");
  if (preparation.has("snapshot"))
    scene.preparation = FromSnapshot::read(preparation, scene_dir);
  else
    scene.preparation = NewPacking::read(preparation);
  scene.path = Path::read(reader.object("path"));
  scene.measure = Measure::read(reader.object_or_empty("measure"));
  reader.finish();
  scene.path.need_grains_can_follow();
  refuse_prescribed(scene.path, reader);
  agree_on_start(scene, reader);
  check_segments_exist(scene, "snapshots", scene.measure.snapshots);
  check_segments_exist(scene, "moduli", scene.measure.moduli);
  if (const auto nu = scene.start_nu(); nu && std::holds_alternative<NewPacking>(scene.preparation))
    scene.legs(*nu);
  return scene;
}

Scene Scene::load(const std::filesystem::path& file) {
  const Json json = load_json(file);
  Scene scene = read(Reader(json, file.string()), file.parent_path());
  if (const auto* from = std::get_if<FromSnapshot>(&scene.preparation)) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(from->file, ignored))
      throw Error(scene.file, "preparation.snapshot",
                  "must be a file, seen from the directory of the scene, got \"" + from->snapshot.string() +
                      "\" (there is no " + from->file.string() + ")");
  }
  return scene;
}

Json Scene::to_json(const std::filesystem::path& dir) const {
  const Json prepared = std::holds_alternative<NewPacking>(preparation)
                            ? std::get<NewPacking>(preparation).to_json()
                            : std::get<FromSnapshot>(preparation).to_json(dir);
  return {{"material", material.to_json()},
          {"preparation", prepared},
          {"path", path.to_json()},
          {"measure", measure.to_json()}};
}

std::optional<double> Scene::start_nu() const {
  if (const auto* packing = std::get_if<NewPacking>(&preparation)) return packing->nu;
  return std::get<FromSnapshot>(preparation).choice.nu;
}

void Scene::check_grains(const State& state) const {
  const auto* from = std::get_if<FromSnapshot>(&preparation);
  if (from == nullptr) return;
  double sum = 0, squares = 0;
  for (const double r : state.radius) sum += r;
  const double mean = sum / static_cast<double>(state.count());
  for (const double r : state.radius) squares += (r - mean) * (r - mean);
  const double spread = std::sqrt(squares / static_cast<double>(state.count()));
  const double wanted_spread = (material.r_max() - material.r_min()) / std::sqrt(12.0);
  const double slack = radius_slack * material.r_mean;
  if (std::abs(mean - material.r_mean) > slack)
    throw Error(file, "material.r_mean",
                "must be that of the grains in " + from->file.string() + ", " + short_text(mean, 4) +
                    " mm, got " + to_text(material.r_mean));
  if (std::abs(spread - wanted_spread) > slack)
    throw Error(file, "material.w",
                "must be that of the grains in " + from->file.string() + ", whose radii deviate by " +
                    short_text(spread, 4) + " mm from their mean; got " + to_text(material.w) +
                    ", with which they would by " + short_text(wanted_spread, 4) + " mm");
}

std::size_t Scene::record_rows() const {
  std::size_t rows = 1;
  for (const Segment& segment : path.segments)
    rows += segment.only_waits() ? 1 : static_cast<std::size_t>(measure.rows);
  return rows;
}

std::vector<Leg> Scene::legs(double nu) const {
  auto legs = path.nominal_legs(nu);
  const auto& segments = path.segments;
  const auto first_servo = std::find_if(segments.begin(), segments.end(),
                                        [](const Segment& segment) { return segment.control.by_stress(); });
  const auto certain = static_cast<std::size_t>(first_servo - segments.begin());
  const auto check = [&](const std::string& list, const std::vector<StateRequest>& requests) {
    for (std::size_t i = 0; i < requests.size(); ++i)
      if (const std::size_t segment = requests[i].segment; segment < certain)
        check_target(requests[i], list, i, legs.at(segment), nu, file);
  };
  check("snapshots", measure.snapshots);
  check("moduli", measure.moduli);
  return legs;
}

}  // namespace grainlaw::dem
