#include "grainlaw/calibrate/memory_tables.hpp"

#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>

#include "grainlaw/element/error.hpp"

namespace grainlaw::calibrate {
namespace {

const std::vector<std::string> cycle_columns{"seed",
                                             "phi_max",
                                             "M",
                                             "phi_J",
                                             "phi_J_error",
                                             "phi_J_contacts",
                                             "phi_J_contacts_error",
                                             "phi_J_nonrattlers",
                                             "phi_J_nonrattlers_error",
                                             "p0",
                                             "rows"};
const std::vector<std::string> shear_columns{"seed",
                                             "phi_max",
                                             "M",
                                             "phi_J0",
                                             "phi_J0_error",
                                             "nu",
                                             "reversals",
                                             "jammed_before",
                                             "eps_contacts",
                                             "eps_percolation",
                                             "eps_pressure",
                                             "percolating",
                                             "longest"};

const std::vector<std::string> relaxed_columns{"seed", "phi_max", "M",          "phi_J0", "phi_J0_error",
                                               "nu",   "eps_dev", "P_flow",     "P",      "s_dev",
                                               "C",    "C_star",  "percolating"};
const std::vector<std::string> tapped_columns{"seed",
                                              "phi_max",
                                              "nu",
                                              "amplitude",
                                              "strain",
                                              "phi_J",
                                              "phi_J_error",
                                              "phi_J_contacts",
                                              "phi_J_contacts_error",
                                              "phi_J_nonrattlers",
                                              "phi_J_nonrattlers_error",
                                              "p0",
                                              "rows"};

/// Seeds are numbers in a campaign; a record of another name has none.
double seed_number(const std::string& group) {
  char* end = nullptr;
  const double seed = std::strtod(group.c_str(), &end);
  return !group.empty() && *end == '\0' ? seed : std::numeric_limits<double>::quiet_NaN();
}

std::string seed_text(const std::filesystem::path& file, double seed) {
  if (!(seed == std::nearbyint(seed)))
    throw Error(file.string(), "seed", "must be a whole number, got " + to_text(seed));
  return std::to_string(static_cast<long long>(seed));
}

/// To 1e-7, far below any error of theirs.
double rounded(double value) { return std::isfinite(value) ? std::nearbyint(value * 1e7) / 1e7 : value; }

std::vector<double> rounded(std::vector<double> row) {
  for (double& value : row) value = rounded(value);
  return row;
}

/// What both tables of unloadings say of one.
void read_densities(const Record& table, std::size_t i, CycleDensity& c) {
  c.from_P = {table["phi_J"][i], table["phi_J_error"][i]};
  c.from_C_star = {table["phi_J_contacts"][i], table["phi_J_contacts_error"][i]};
  c.from_f_NR = {table["phi_J_nonrattlers"][i], table["phi_J_nonrattlers_error"][i]};
  c.p0 = table["p0"][i];
  c.rows = static_cast<std::size_t>(table["rows"][i]);
}

/// What both tables of shear say of the packing that is sheared.
template <class Run>
void read_packing(const Record& table, std::size_t i, const std::filesystem::path& file, Run& run) {
  run.group = seed_text(file, table["seed"][i]);
  run.phi_max = table["phi_max"][i];
  run.M = table["M"][i];
  run.phi_J0 = {table["phi_J0"][i], table["phi_J0_error"][i]};
  run.nu = table["nu"][i];
}

std::string record_of(const std::string& kind, double phi, const std::string& seed) {
  return kind + "-" + to_text(phi) + "-s" + seed;
}

}  // namespace

Record over_compression_table(const std::vector<CycleDensity>& cycles) {
  Record table(cycle_columns);
  for (const CycleDensity& c : cycles)
    table.append(rounded({seed_number(c.group), c.phi_max, c.M, c.from_P.value, c.from_P.error,
                          c.from_C_star.value, c.from_C_star.error, c.from_f_NR.value, c.from_f_NR.error,
                          c.p0, static_cast<double>(c.rows)}));
  return table;
}

Record shear_jamming_table(const std::vector<ShearJamming>& runs) {
  Record table(shear_columns);
  for (const ShearJamming& r : runs)
    table.append(
        rounded({seed_number(r.group), r.phi_max, r.M, r.phi_J0.value, r.phi_J0.error, r.nu,
                 static_cast<double>(r.reversals), r.jammed_before ? 1.0 : 0.0, r.by(JamSign::contacts),
                 r.by(JamSign::percolation), r.by(JamSign::pressure), r.percolating, r.longest}));
  return table;
}

Record relaxed_table(const std::vector<RelaxedState>& states) {
  Record table(relaxed_columns);
  for (const RelaxedState& s : states)
    table.append(rounded({seed_number(s.group), s.phi_max, s.M, s.phi_J0.value, s.phi_J0.error, s.nu,
                          s.eps_dev, s.P_flow, s.P, s.s_dev, s.C, s.C_star, s.percolating}));
  return table;
}

Record tapped_table(const std::vector<TappedDensity>& packings) {
  Record table(tapped_columns);
  for (const TappedDensity& t : packings) {
    const CycleDensity& c = t.density;
    table.append(rounded({seed_number(c.group), t.phi_max, c.phi_max, t.amplitude, t.strain, c.from_P.value,
                          c.from_P.error, c.from_C_star.value, c.from_C_star.error, c.from_f_NR.value,
                          c.from_f_NR.error, c.p0, static_cast<double>(c.rows)}));
  }
  return table;
}

std::vector<CycleDensity> read_over_compression(const std::filesystem::path& file) {
  const Record table = Record::read_csv(file, cycle_columns);
  std::vector<CycleDensity> cycles;
  for (std::size_t i = 0; i < table.rows(); ++i) {
    CycleDensity c;
    c.group = seed_text(file, table["seed"][i]);
    c.phi_max = table["phi_max"][i];
    c.test = record_of("over-compression", c.phi_max, c.group);
    c.M = table["M"][i];
    read_densities(table, i, c);
    cycles.push_back(c);
  }
  return cycles;
}

std::vector<ShearJamming> read_shear_jamming(const std::filesystem::path& file) {
  const Record table = Record::read_csv(file, shear_columns);
  std::vector<ShearJamming> runs;
  for (std::size_t i = 0; i < table.rows(); ++i) {
    ShearJamming r;
    read_packing(table, i, file, r);
    r.test = record_of("shear-" + to_text(r.phi_max), r.nu, r.group);
    r.reversals = static_cast<std::size_t>(table["reversals"][i]);
    r.jammed_before = table["jammed_before"][i] != 0;
    r.strain = {table["eps_contacts"][i], table["eps_percolation"][i], table["eps_pressure"][i]};
    r.percolating = table["percolating"][i];
    r.longest = table["longest"][i];
    runs.push_back(r);
  }
  return runs;
}

std::vector<RelaxedState> read_relaxed(const std::filesystem::path& file) {
  const Record table = Record::read_csv(file, relaxed_columns);
  std::vector<RelaxedState> states;
  for (std::size_t i = 0; i < table.rows(); ++i) {
    RelaxedState s;
    read_packing(table, i, file, s);
    s.test = record_of("relaxed-" + to_text(s.phi_max), s.nu, s.group);
    s.eps_dev = table["eps_dev"][i];
    s.P_flow = table["P_flow"][i];
    s.P = table["P"][i];
    s.s_dev = table["s_dev"][i];
    s.C = table["C"][i];
    s.C_star = table["C_star"][i];
    s.percolating = table["percolating"][i];
    states.push_back(s);
  }
  return states;
}

std::vector<TappedDensity> read_tapped(const std::filesystem::path& file) {
  const Record table = Record::read_csv(file, tapped_columns);
  std::vector<TappedDensity> packings;
  for (std::size_t i = 0; i < table.rows(); ++i) {
    TappedDensity t;
    CycleDensity& c = t.density;
    c.group = seed_text(file, table["seed"][i]);
    c.phi_max = table["nu"][i];
    c.test = record_of("tapped-" + to_text(table["amplitude"][i]), table["strain"][i], c.group);
    c.M = 1;
    read_densities(table, i, c);
    t.phi_max = table["phi_max"][i];
    t.amplitude = table["amplitude"][i];
    t.strain = table["strain"][i];
    packings.push_back(t);
  }
  return packings;
}

}  // namespace grainlaw::calibrate
