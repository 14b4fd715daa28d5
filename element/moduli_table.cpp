#include "grainlaw/element/moduli_table.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

#include "grainlaw/element/error.hpp"

namespace grainlaw {

namespace {

constexpr std::array components{"xx", "yy", "zz", "yz", "xz", "xy"};

/// What a fit cannot do without.
const std::vector<std::string> needed{
    "nu",        "P", "sigma_dev", "F_v", "F_dev", "C_star",           "f_NR",    "residual",
    "amplitude", "B", "A1",        "A2",  "G_oct", "contacts_changed", "unstable"};

std::string rounded(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g", value);
  return text.data();
}

}  // namespace

const std::vector<std::string>& moduli_columns() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all{
        "file",  "frame",  "segment", "eps_dev",          "nu",       "P",        "sigma_dev", "F_v",
        "F_dev", "C_star", "f_NR",    "backbone",         "contacts", "residual", "amplitude", "B",
        "A1",    "A2",     "G_oct",   "contacts_changed", "unstable"};
    for (std::size_t a = 0; a < components.size(); ++a)
      for (std::size_t b = a; b < components.size(); ++b)
        all.push_back(std::string("E_") + components[a] + "_" + components[b]);
    return all;
  }();
  return names;
}

Record read_moduli(const std::filesystem::path& file) {
  Record record = Record::read_csv(file, needed);
  const auto& known = moduli_columns();
  for (const std::string& name : record.columns())
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw Error(file.string(), name, "is no column of a table of moduli (docs/formats.md lists them)");
  return record;
}

double isostatic_contacts(double backbone) { return 3 * backbone - 2; }

std::string why_no_moduli(double backbone, double contacts, double residual) {
  if (backbone == 0) return "unjammed: no grain bears load";
  if (contacts < isostatic_contacts(backbone))
    return "contacts below isostatic: " + to_text(contacts) + " between the " + to_text(backbone) +
           " grains that bear load, a stable balance takes at least " + to_text(isostatic_contacts(backbone));
  return "not in balance: the largest net force on a grain is " + rounded(residual) +
         " times the mean contact force";
}

}  // namespace grainlaw
