#include "grainlaw/element/moduli_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "grainlaw/element/components.hpp"
#include "grainlaw/element/error.hpp"

namespace grainlaw {

namespace {

constexpr std::array axes{"x", "y", "z"};

/// What a fit cannot do without.
const std::vector<std::string> needed{
    "nu",        "P", "sigma_dev", "F_v", "F_dev", "C_star",           "f_NR",    "residual",
    "amplitude", "B", "A1",        "A2",  "G_oct", "contacts_changed", "unstable"};

std::vector<std::string> young_columns() {
  std::vector<std::string> list;
  for (const char* n : axes) list.push_back(std::string("Young_") + n);
  for (const char* n : axes)
    for (const char* m : axes)
      if (n != m) list.push_back(std::string("Poisson_") + n + m);
  return list;
}

std::vector<std::string> wave_columns() {
  std::vector<std::string> list;
  std::vector<std::string> rays(control_keys.begin(), control_keys.end());
  rays.emplace_back("xyz");
  for (const std::string& ray : rays)
    for (const char* k : {"1", "2", "3"}) list.push_back("speed_" + ray + "_" + k);
  return list;
}

/// Stress in balance, and its 36 derivatives, which have no symmetry.
std::vector<std::string> columns_of_stress() {
  std::vector<std::string> list;
  for (const char* a : tensor_components) list.push_back(std::string("sigma_") + a);
  for (const char* a : tensor_components)
    for (const char* b : tensor_components) list.push_back(std::string("S_") + a + "_" + b);
  return list;
}

bool is_in(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

bool is_known(const std::string& name) {
  const auto& groups = elastic_groups();
  return is_in(moduli_columns(), name) || is_in(undo_columns(), name) ||
         std::any_of(groups.begin(), groups.end(),
                     [&](const ElasticGroup& group) { return is_in(group.columns, name); });
}

/// Over k*, as stresses: beyond that a number is no modulus.
void check_sizes(const Record& record, const std::string& file) {
  constexpr double largest = 1000;
  for (const char* modulus : {"B", "A1", "A2", "G_oct"})
    for (std::size_t row = 0; row < record.rows(); ++row)
      if (std::abs(record[modulus][row]) > largest)
        throw Error(file, modulus,
                    "line " + std::to_string(row + 2) + ": must be in [-1000, 1000], got " +
                        to_text(record[modulus][row]));
}

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
    for (std::size_t a = 0; a < tensor_components.size(); ++a)
      for (std::size_t b = a; b < tensor_components.size(); ++b)
        all.push_back(std::string("E_") + tensor_components[a] + "_" + tensor_components[b]);
    return all;
  }();
  return names;
}

const std::vector<std::string>& undo_columns() {
  static const std::vector<std::string> names{"changed_by_volume", "changed_by_shear", "left_by_volume",
                                              "left_by_shear",     "B_left",           "A1_left",
                                              "A2_left",           "G_oct_left"};
  return names;
}

const std::vector<ElasticGroup>& elastic_groups() {
  static const std::vector<ElasticGroup> groups{
      {"eigenvalues",
       {"eigenvalue_1", "eigenvalue_2", "eigenvalue_3", "eigenvalue_4", "eigenvalue_5", "eigenvalue_6"}},
      {"symmetry",
       {"iso_share", "ti_x_share", "ti_y_share", "ti_z_share", "ti_best_share", "ti_axis_x", "ti_axis_y",
        "ti_axis_z", "ortho_share", "ortho_best_share"}},
      {"young", young_columns()},
      {"waves", wave_columns()},
      {"floppy", {"floppy"}},
      {"invariants", {"sigma_dev_inv", "F_dev_inv", "A2_inv", "G_oct_inv"}},
      {"affine", {"B_affine", "A1_affine", "A2_affine", "G_oct_affine"}},
      {"stress", columns_of_stress()}};
  return groups;
}

Record read_moduli(const std::filesystem::path& file) {
  Record record = Record::read_csv(file, needed);
  for (const std::string& name : record.columns())
    if (!is_known(name))
      throw Error(file.string(), name, "is no column of a table of moduli (docs/formats.md lists them)");
  check_sizes(record, file.string());
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
