#include "grainlaw/calibrate/fit_input.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "grainlaw/calibrate/kept_record.hpp"
#include "grainlaw/dem/scene/scene.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/element/json.hpp"
#include "grainlaw/element/moduli_table.hpp"

namespace grainlaw::calibrate {
namespace {

namespace fs = std::filesystem;

/// Fewer rows of a record that is cut short are nothing to fit or to compare with.
constexpr std::size_t fewest_rows_cut_short = 10;

/// What the fits read; a record may hold more.
const std::vector<std::string> needed_columns{"segment", "eps_vol", "eps_dev", "nu",     "P",
                                              "s_dev",   "F_dev",   "C",       "C_star", "f_NR"};

/// Where a scene says which columns are written, also the one by which rows at rest are told.
std::vector<std::string> columns_needed(const Json& scene) {
  std::vector<std::string> columns = needed_columns;
  if (scene.value("measure", Json::object()).contains("standard")) columns.emplace_back("Ek_over_Ep");
  return columns;
}

std::string mode_of(const Path& path) {
  std::set<Mode> modes;
  for (const Segment& segment : path.segments) {
    if (segment.mode != Mode::relax) modes.insert(segment.mode);
  }
  return modes.size() == 1 ? name_of(*modes.begin()) : "mixed";
}

/// Splits "d2-0.7-s1" into test and seed.
void split_name(TestRecord& test) {
  const auto at = test.name.rfind("-s");
  const bool seeded = at != std::string::npos && at > 0 && at + 2 < test.name.size() &&
                      test.name.find_first_not_of("0123456789", at + 2) == std::string::npos;
  test.test = seeded ? test.name.substr(0, at) : test.name;
  test.seed = seeded ? test.name.substr(at + 2) : test.name;
}

/// Where the scene says how many rows a segment has, the table must have them all: one that was cut between
/// two lines looks whole.
void check_rows(const Json& scene, const Path& path, const Record& rows, const fs::path& dir) {
  if (!scene.contains("measure") || !scene["measure"].contains("rows")) return;
  dem::Scene wanted;
  wanted.path = path;
  wanted.measure.rows = scene["measure"]["rows"].get<std::int64_t>();
  check_row_count(dir, rows.rows(), wanted.record_rows());
}

/// One row by linear response for each state that the scene asks for; a table of strains alone is of another
/// kind, and so is one that the scene does not ask for.
void check_moduli_count(const Json& scene, const std::optional<Record>& moduli, const fs::path& file,
                        bool ends_early) {
  const Json measure = scene.value("measure", Json::object());
  if (!measure.contains("moduli") || measure["moduli"].empty()) return;
  const std::size_t states = measure["moduli"].size();
  if (!moduli && ends_early) return;  // no state may have come
  if (!moduli) throw Error(file.string(), "", "no such file, and the scene asks for moduli");
  const std::vector<double>& amplitude = (*moduli)["amplitude"];
  const auto rows = static_cast<std::size_t>(std::count(amplitude.begin(), amplitude.end(), 0.0));
  if (rows > states || (rows < states && !ends_early && (rows > 0 || amplitude.empty())))
    throw Error(file.string(), "",
                "must have " + std::to_string(states) + " states as its scene says, got " +
                    std::to_string(rows) + ": it is cut short or of another scene");
}

/// Rows must say where on the path they belong.
std::optional<Record> kept_moduli(const Json& scene, const fs::path& file, bool ends_early) {
  std::optional<Record> moduli;
  if (fs::exists(file)) moduli = read_moduli(file);
  check_moduli_count(scene, moduli, file, ends_early);
  if (!moduli) return moduli;
  for (const char* column : {"segment", "eps_dev", "backbone", "contacts"})
    if (!moduli->has(column)) throw Error(file.string(), column, "column is missing");
  return moduli;
}

/// The axis of the last shear before this scene, in the records that it starts from.
std::optional<StrainTensor> shear_axis_before(const Json& scene, const fs::path& dir);

/// The same with the record `dir` itself.
std::optional<StrainTensor> shear_axis(const fs::path& dir) {
  const fs::path file = dir / "scene.json";
  if (!fs::exists(file)) return std::nullopt;
  const Json scene = load_json(file);
  Reader reader(scene, file.string());
  const Path path = Path::read(reader.object("path"));
  const std::vector<Leg> legs = path.nominal_legs(0.5, false);  // axes are those of any volume fraction
  for (std::size_t i = legs.size(); i > 0; --i)
    if (legs[i - 1].eps_dev[0] != legs[i - 1].eps_dev[1]) return SignConvention(legs).axis(i - 1);
  return shear_axis_before(scene, dir);
}

std::optional<StrainTensor> shear_axis_before(const Json& scene, const fs::path& dir) {
  const Json preparation = scene.value("preparation", Json::object());
  if (!preparation.contains("snapshot")) return std::nullopt;
  return shear_axis((dir / preparation["snapshot"].get<std::string>()).parent_path());
}

/// Tells the path as far as the rows go.
void shorten(TestRecord& test) {
  const auto last = static_cast<std::size_t>(test.rows["segment"].back());
  if (last >= test.legs.size()) return;  // read_record() says so
  const Leg& leg = test.legs[last];
  Segment& segment = test.path.segments[last];
  const double eps_vol = test.rows["eps_vol"].back() - leg.eps_vol[0];
  const double eps_dev = test.rows["eps_dev"].back() - leg.eps_dev[0];
  test.path.segments.resize(last + 1);
  if (leg.mode == Mode::iso || leg.mode == Mode::uni || leg.mode == Mode::d2 || leg.mode == Mode::d3) {
    segment.to_nu = segment.to_eps_vol = segment.to_eps_dev = std::nullopt;
    segment.amount = leg.mode == Mode::iso || leg.mode == Mode::uni ? eps_vol : eps_dev;
    if (*segment.amount == 0) test.path.segments.pop_back();
  }
  test.legs = test.path.legs(test.nu_start);
}

TestRecord read_record(const fs::path& dir, Role role) {
  TestRecord test;
  test.name = dir.filename().string();
  test.role = role;
  test.dir = dir;
  split_name(test);
  const fs::path scene = dir / "scene.json", table = dir / "record.csv";
  const Json json = load_json(scene);
  Reader reader(json, scene.string());
  test.material = Material::read(reader.object("material"));
  test.path = Path::read(reader.object("path"));
  test.mode = mode_of(test.path);
  test.sheared_along = shear_axis_before(json, dir);
  test.rows = Record::read_csv(table, columns_needed(json));
  test.cut_short = cut_short(dir);
  check_rows(json, test.path, test.rows, dir);
  test.moduli = kept_moduli(json, dir / "moduli.csv", !test.cut_short.empty());
  for (const char* column : {"segment", "eps_vol", "eps_dev", "nu", "P"}) {
    for (const double value : test.rows[column]) {
      if (std::isnan(value))
        throw Error(table.string(), column, "must be a number in every row, got an empty field");
    }
  }
  test.nu_start = test.rows["nu"].front() * std::exp(-test.rows["eps_vol"].front());
  test.legs = test.path.legs(test.nu_start);
  if (!test.cut_short.empty()) shorten(test);
  for (const double segment : test.rows["segment"]) {
    if (segment < 0 || segment >= static_cast<double>(test.legs.size())) {
      throw Error(table.string(), "segment",
                  "must be less than " + std::to_string(test.legs.size()) + ", the number of segments of " +
                      scene.string() + ", got " + to_text(segment));
    }
  }
  return test;
}

/// Why a record is no matter for fits and predictions; empty if it is. One that is cut short may be, as far
/// as it goes; but what memory is measured by are whole histories.
std::string why_left_out(const fs::path& dir, Role role) {
  const fs::path scene = dir / "scene.json";
  Reader reader(load_json(scene), scene.string());
  const Path path = Path::read(reader.object("path"));
  if (path.by_stress()) return "its path is under stress control, and the law follows strains";
  if (path.spins()) return "its path has simple_shear, and the law one direction of shear";
  const std::string why = cut_short(dir);
  if (why.empty()) return "";
  const std::size_t rows = Record::read_csv(dir / "record.csv", {"segment"}).rows();
  if (role != Role::memory && rows >= fewest_rows_cut_short) return "";
  return "cut short after " + std::to_string(rows) + " rows: " + why;
}

RecordFolder read_campaign(const fs::path& dir) {
  const Campaign campaign = Campaign::load(dir / "campaign.json");
  RecordFolder out;
  out.name = campaign.name;
  out.campaign = true;
  for (const CampaignTest& test : campaign.tests) {
    for (const auto seed : test.seeds) {
      const std::string name = record_name(test.name, seed);
      const fs::path record = dir / "records" / name;
      if (!fs::exists(record / "record.csv")) {
        out.left_out.push_back({name, test.role, "there is no record of it"});
        continue;
      }
      if (const std::string why = why_left_out(record, test.role); !why.empty()) {
        out.left_out.push_back({name, test.role, why});
        continue;
      }
      out.tests.push_back(read_record(record, test.role));
      out.tests.back().test = test.name;
      out.tests.back().seed = std::to_string(seed);
      if (test.from)
        out.tests.back().from = RecordOrigin{record_name(test.from->test, seed), test.from->segment};
    }
  }
  return out;
}

RecordFolder read_folder(const fs::path& dir) {
  RecordFolder out;
  const fs::path absolute = fs::absolute(dir).lexically_normal();
  out.name =
      absolute.has_filename() ? absolute.filename().string() : absolute.parent_path().filename().string();
  std::vector<fs::path> found;
  for (const fs::path& place : {dir, dir / "records"}) {
    if (!fs::is_directory(place)) continue;
    for (const auto& entry : fs::directory_iterator(place)) {
      const bool complete = entry.path().extension() != ".part" && fs::exists(entry.path() / "record.csv");
      if (complete) found.push_back(entry.path());
    }
  }
  std::sort(found.begin(), found.end());
  for (const fs::path& record : found) {
    if (const std::string why = why_left_out(record, Role::fit); !why.empty())
      out.left_out.push_back({record.filename().string(), Role::fit, why});
    else
      out.tests.push_back(read_record(record, Role::fit));
  }
  return out;
}

}  // namespace

RecordFolder read_records(const fs::path& dir) {
  if (!fs::is_directory(dir)) throw Error(dir.string(), "", "must be a directory with records");
  RecordFolder out = fs::exists(dir / "campaign.json") ? read_campaign(dir) : read_folder(dir);
  if (out.tests.empty()) {
    throw Error(dir.string(), "", "must hold records (directories with a record.csv), found none");
  }
  return out;
}

std::size_t first_shear_leg(const TestRecord& test) {
  const auto shears = [](const Leg& leg) { return leg.mode == Mode::d2 || leg.mode == Mode::d3; };
  return static_cast<std::size_t>(std::find_if(test.legs.begin(), test.legs.end(), shears) -
                                  test.legs.begin());
}

std::size_t end_of_first_loading(const TestRecord& test) {
  const std::size_t first = first_shear_leg(test);
  const auto forward = [&](std::size_t i) { return test.legs[i].eps_dev[1] > test.legs[i].eps_dev[0]; };
  std::size_t end = first;
  while (end < test.legs.size() && test.legs[end].mode == test.legs[first].mode &&
         forward(end) == forward(first))
    ++end;
  return end;
}

std::size_t last_unloading_leg(const TestRecord& test) {
  for (std::size_t i = test.legs.size(); i > 0; --i) {
    const Leg& leg = test.legs[i - 1];
    if ((leg.mode == Mode::iso || leg.mode == Mode::uni) && leg.eps_vol[1] < leg.eps_vol[0]) return i - 1;
  }
  return test.legs.size();
}

bool reverses(const TestRecord& test) {
  const auto shears = [&](const Leg& leg, double sign) {
    return sign * (leg.eps_dev[1] - leg.eps_dev[0]) > 0;
  };
  return std::any_of(test.legs.begin(), test.legs.end(), [&](const Leg& leg) { return shears(leg, 1); }) &&
         std::any_of(test.legs.begin(), test.legs.end(), [&](const Leg& leg) { return shears(leg, -1); });
}

}  // namespace grainlaw::calibrate
