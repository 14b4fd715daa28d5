#include "grainlaw/calibrate/kept_record.hpp"

#include "grainlaw/calibrate/campaign.hpp"
#include "grainlaw/dem/files/snapshot.hpp"
#include "grainlaw/dem/observe/names.hpp"
#include "grainlaw/dem/record/moduli_writer.hpp"
#include "grainlaw/dem/scene/scene.hpp"
#include "grainlaw/element/column_groups.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/element/moduli_table.hpp"
#include "grainlaw/element/record.hpp"

namespace grainlaw::calibrate {

namespace fs = std::filesystem;

namespace {

/// Runs `check`; what it throws says how to go on.
template <class Check>
void with_advice(const fs::path& dir, Check&& check) {
  try {
    check();
  } catch (const Error& error) {
    throw Error(std::string(error.what()) + "; remove " + dir.string() + " to have it made again");
  }
}

void check_files(const fs::path& dir) {
  for (const char* file : {"record.csv", "scene.json", "provenance.json"})
    if (!fs::exists(dir / file)) throw Error((dir / file).string(), "", "no such file");
}

/// One row for each state that the scene asks for; at most, where some may never have come.
void check_moduli(const fs::path& dir, std::size_t states, bool all_met) {
  const fs::path table = dir / dem::ModuliWriter::file;
  if (states == 0 || (!all_met && !fs::exists(table))) return;
  const std::size_t rows = read_moduli(table).rows();
  if (rows == states || (!all_met && rows < states)) return;
  throw Error(table.string(), "",
              "must have " + std::to_string(states) + " rows, got " + std::to_string(rows) +
                  ": it is cut short or of another scene");
}

}  // namespace

void check_kept_record(const fs::path& dir, const Json& planned) {
  with_advice(dir, [&] {
    check_files(dir);
    const dem::Scene wanted = dem::Scene::read(Reader(planned, dir.filename().string()), dir);
    const std::string scene = (dir / "scene.json").string();
    // Read and written anew: a record of an earlier version lacks the keys that came since, and their
    // defaults are what it was run with.
    const dem::Scene kept = dem::Scene::read(Reader(load_json(scene), scene), dir);
    if (const auto differs = first_difference(kept.to_json(dir), wanted.to_json(dir)); !differs.empty())
      throw Error(scene, "", "is another scene than is wanted (" + differs + ")");
    const bool ends_early = !cut_short(dir).empty();
    const std::string table = (dir / "record.csv").string();
    std::vector<std::string> columns = record_columns_with(wanted.measure.standard);
    for (const auto& column : dem::observe::lasting_columns(wanted.measure.observe))
      columns.push_back(column);
    const Record record = Record::read_csv(table, columns);
    for (const auto& file : dem::observe::tables(wanted.measure.observe))
      Record::read_csv(dir / file, {"row"});
    const bool all_met = !ends_early && !wanted.path.by_stress();  // else a state may never have come
    check_moduli(dir, wanted.measure.moduli.size(), all_met);
    check_row_count(dir, record.rows(), wanted.record_rows());
  });
}

std::string cut_short(const fs::path& dir) {
  if (!fs::exists(dir / "provenance.json")) return "";
  const Json provenance = load_json(dir / "provenance.json");
  return provenance.contains("cut_short") ? provenance["cut_short"].get<std::string>() : "";
}

void check_row_count(const fs::path& dir, std::size_t rows, std::size_t wanted) {
  const std::string table = (dir / "record.csv").string();
  if (cut_short(dir).empty()) {
    if (rows == wanted) return;
    throw Error(table, "",
                "must have " + std::to_string(wanted) + " rows as its scene says, got " +
                    std::to_string(rows) + ": it is cut short or of another scene");
  }
  const Json provenance = load_json(dir / "provenance.json");
  const bool told = provenance.contains("rows");  // an earlier version did not tell
  const std::size_t most = told ? provenance["rows"].get<std::size_t>() : wanted;
  if (told ? rows == most : rows <= most) return;
  throw Error(table, "",
              "must have " + std::string(told ? "" : "at most ") + std::to_string(most) + " rows, got " +
                  std::to_string(rows) + ": it is not the one that its provenance.json is of");
}

void check_kept_snapshots(const fs::path& dir) {
  with_advice(dir, [&] { dem::list_frames(dir / "snapshots.h5"); });
}

}  // namespace grainlaw::calibrate
