#include "grainlaw/apps/predict_input.hpp"

#include <cmath>

#include "grainlaw/apps/arguments.hpp"
#include "grainlaw/dem/scene.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/element/path_limits.hpp"
#include "grainlaw/model/strain_table.hpp"

namespace grainlaw::apps {

namespace {

namespace fs = std::filesystem;

Followed read_strains(const fs::path& file, const std::string& nu, const std::string& P) {
  std::optional<double> start_nu, start_P;
  if (!nu.empty()) start_nu = read_number("--nu", nu, inside(0, 1));
  if (!P.empty()) start_P = read_number("--P", P, between(0, largest_stress));
  const Record table = Record::read_csv(file, {"eps_vol", "eps_dev"});
  auto strains = model::strain_path(table, file.string(), start_nu, start_P);
  return {strains.path, std::nullopt, std::move(strains)};
}

}  // namespace

Followed read_followed(const fs::path& where, const std::string& nu, const std::string& P) {
  if (where.extension() == ".csv") return read_strains(where, nu, P);
  for (const auto& [option, value] : {std::pair{"--nu", &nu}, std::pair{"--P", &P}})
    if (!value->empty())
      throw Error("", option, "goes with a table of strains (.csv); a path has its start itself");
  if (!fs::is_directory(where))
    return {Path::read(Reader(load_json(where), where.string())), std::nullopt, std::nullopt};
  const fs::path file = where / "scene.json";
  Followed followed{dem::Scene::read(Reader(load_json(file), file.string()), where).path,
                    Record::read_csv(where / "record.csv", {"segment", "eps_vol", "eps_dev", "nu"}),
                    std::nullopt};
  const Record& record = *followed.record;
  followed.path.start.nu = record["nu"].front() * std::exp(-record["eps_vol"].front());
  return followed;
}

std::vector<fs::path> files_of(const fs::path& where) {
  return {where, where / "scene.json", where / "record.csv"};
}

}  // namespace grainlaw::apps
