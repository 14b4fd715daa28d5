#include "grainlaw/apps/predict_input.hpp"

#include <cmath>
#include <string_view>

#include "grainlaw/apps/arguments.hpp"
#include "grainlaw/dem/scene/scene.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/model/strain_table.hpp"

namespace grainlaw::apps {

namespace {

namespace fs = std::filesystem;

/// Over k*, from a number without a unit or in kPa. Packings of this engine stay below 0.1: a larger number
/// without a unit is one of kPa.
double read_pressure(const std::string& text, double unit_kPa) {
  constexpr std::string_view kPa = "kPa";
  if (text.ends_with(kPa)) {
    const std::string number = text.substr(0, text.size() - kPa.size());
    return read_number("--P", number.substr(0, number.find_last_not_of(' ') + 1), between(0, unit_kPa)) /
           unit_kPa;
  }
  try {
    return read_number("--P", text, between(0, 1));
  } catch (const Error&) {
    throw Error("", "--P",
                "must be a number between 0 and 1, over k* = " + to_text(unit_kPa) +
                    " kPa, or in kPa with that unit, as 50kPa, got " + text);
  }
}

/// The pressure of the first row of a table that has it in kPa, as predict --si writes it, over k*.
std::optional<double> pressure_in_kPa(const Record& table, const std::string& file, bool by_option,
                                      double unit_kPa) {
  const std::string column = "P_kPa";
  if (!table.has(column) || std::isnan(table[column].front())) return std::nullopt;
  const double P = table[column].front();
  const bool twice = table.has("P") && !std::isnan(table["P"].front());
  if (by_option || twice)
    throw Error(file, column,
                std::string("line 2: says the start already; leave out ") + (twice ? "column P" : "--P"));
  const Range range = between(0, unit_kPa);
  if (!range.contains(P))
    throw Error(file, column, "line 2: must be " + range.text() + ", got " + to_text(P));
  return P / unit_kPa;
}

Followed read_strains(const fs::path& file, const std::string& nu, const std::string& P, double unit_kPa) {
  std::optional<double> start_nu, start_P;
  if (!nu.empty()) start_nu = read_number("--nu", nu, inside(0, 1));
  if (!P.empty()) start_P = read_pressure(P, unit_kPa);
  const Record table = Record::read_csv(file, {"eps_vol", "eps_dev"});
  if (const auto in_kPa = pressure_in_kPa(table, file.string(), start_P.has_value(), unit_kPa))
    start_P = in_kPa;
  auto strains = model::strain_path(table, file.string(), start_nu, start_P);
  return {strains.path, std::nullopt, std::move(strains)};
}

}  // namespace

Followed read_followed(const fs::path& where, const std::string& nu, const std::string& P, double unit_kPa) {
  if (where.extension() == ".csv") return read_strains(where, nu, P, unit_kPa);
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
