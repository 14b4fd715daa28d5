#include "grainlaw/calibrate/fit_records.hpp"

#include <algorithm>

#include "grainlaw/calibrate/fit_account.hpp"
#include "grainlaw/calibrate/fit_checks.hpp"
#include "grainlaw/calibrate/fit_memory_numbers.hpp"
#include "grainlaw/calibrate/fit_near_jamming_account.hpp"
#include "grainlaw/calibrate/fit_parameters.hpp"
#include "grainlaw/calibrate/memory_tables.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/element/file.hpp"

namespace grainlaw::calibrate {
namespace {

/// The material of all records; predictions would be for none of them if they differed.
void check_material(const RecordFolder& folder, const TestRecord& first) {
  const Json material = first.material.to_json();
  for (const TestRecord& test : folder.tests) {
    const Json other = test.material.to_json();
    for (const auto& [key, value] : material.items()) {
      if (other.at(key) == value) continue;
      throw Error((test.dir / "scene.json").string(), "material." + key,
                  "must be " + value.dump() + " as in " + first.name +
                      ", since one parameter set is one material, got " + other.at(key).dump());
    }
  }
}

void set_row(model::ShearLaws& shear, ShearQuantity quantity,
             const std::optional<model::SaturationLaw>& row) {
  switch (quantity) {
    case ShearQuantity::s_max:
      shear.s_max = row;
      break;
    case ShearQuantity::beta_s:
      shear.beta_s = row;
      break;
    case ShearQuantity::F_max:
      shear.F_max = row;
      break;
    case ShearQuantity::beta_F:
      shear.beta_F = row;
      break;
  }
}

/// Group shear from the fits of d2, shear_axial from those of d3.
model::ShearLaws shear_laws(const Account& account, const std::string& mode, const Reference& reference) {
  model::ShearLaws shear;
  const bool nu_c_fitted = account.nu_c_fitted, of_thesis = mode == "d2";
  for (const ShearQuantity quantity : shear_quantities) {
    const std::string name = name_of(quantity);
    const FitResult& fit = account.density.at(mode).at(quantity);
    auto row = saturation_law(fit, of_thesis ? reference.shear(name) : KnownValues{},
                              of_thesis ? reference.thesis_shear(name) : KnownValues{}, reference);
    if (row && nu_c_fitted && row->nu_c.value == account.nu_c) {
      row->nu_c.source = "fit";
      row->nu_c.note = "nu_c of isotropic.iso";
    }
    if (row && fit["Q_max"].determined && row->Q_max.source == "assumed") {
      row->Q_max.note = "held at 0, as in Table 2.2";
    }
    set_row(shear, quantity, row);
  }
  return shear;
}

/// As fitted; that of the thesis where no test has moduli.
std::optional<model::ModuliLaws> moduli(const Account& account, const Reference& reference) {
  if (!account.moduli) return reference.moduli();
  auto group = moduli_laws(*account.moduli, reference);
  if (group && account.moduli_nu_c_fitted && group->nu_c.value == account.moduli->B.value("nu_c")) {
    group->nu_c.source = "fit";
    group->nu_c.note = "nu_c of isotropic.d2";
  }
  return group;
}

Reference reference_of(const std::filesystem::path& thesis, const Material& material) {
  std::optional<model::ParameterSet> set;
  if (!thesis.empty()) set = model::ParameterSet::load(thesis);
  return Reference(set, material);
}

MeasuredMemory read_tables(const std::filesystem::path& dir) {
  MeasuredMemory measured;
  if (dir.empty()) return measured;
  const auto has = [&](const char* name) { return std::filesystem::exists(dir / name); };
  measured.cycles = read_over_compression(dir / "over_compression.csv");
  if (has("shear_jamming.csv")) measured.shear_jammings = read_shear_jamming(dir / "shear_jamming.csv");
  if (has("relaxed.csv")) measured.relaxed = read_relaxed(dir / "relaxed.csv");
  if (has("tapped.csv")) measured.tapped = read_tapped(dir / "tapped.csv");
  return measured;
}

}  // namespace

void FitOutput::write_account(const std::filesystem::path& dir) const {
  write_file(dir / "fits.json", fits.dump(2) + "\n");
  if (over_compression) over_compression->write_csv(dir / "over_compression.csv");
  if (shear_jamming) shear_jamming->write_csv(dir / "shear_jamming.csv");
  if (relaxed) relaxed->write_csv(dir / "relaxed.csv");
  if (tapped) tapped->write_csv(dir / "tapped.csv");
}

FitOutput fit_records(const std::filesystem::path& dir, const std::filesystem::path& thesis,
                      const Selection& selection, const MemorySources& memory) {
  const RecordFolder folder = read_records(dir),
                     reversals = memory.reversals.empty() ? RecordFolder() : read_records(memory.reversals);
  const TestRecord& first = folder.tests.front();
  check_material(folder, first);
  check_material(reversals, first);
  if (!memory.reversals.empty() &&
      std::none_of(reversals.tests.begin(), reversals.tests.end(), tells_of_reversals))
    throw Error(memory.reversals.string(), "",
                "must hold d2 tests of role fit that turn their shear round, found none");
  FitOutput out;
  out.parameters.name = folder.name;
  out.parameters.material = first.material;
  const Reference reference = reference_of(thesis, out.parameters.material),
                  near_jamming = reference_of(memory.near_jamming, out.parameters.material);
  const Account account = fit_all(folder, reference, near_jamming, read_tables(memory.tables), selection);

  for (const auto& [mode, fit] : account.packing) {
    const auto row = packing_law(fit, reference.packing(mode), reference.thesis_packing(mode), reference);
    if (row) out.parameters.isotropic[mode] = *row;
  }
  out.parameters.shear = shear_laws(account, "d2", reference);
  if (account.density.contains("d3")) out.parameters.shear_axial = shear_laws(account, "d3", reference);
  out.parameters.near_jamming = near_jamming_laws(account, near_jamming);
  out.parameters.moduli = moduli(account, reference);
  if (account.volumetric) out.parameters.volumetric = volumetric_laws(*account.volumetric, reference);
  if (!out.parameters.volumetric && out.parameters.shear) out.parameters.volumetric = usual_volumetric_laws();
  out.parameters.memory = account.memory ? memory_laws(*account.memory, reference) : reference.memory();
  if (!account.cycles.empty()) out.over_compression = over_compression_table(account.cycles);
  if (!account.shear_jammings.empty()) out.shear_jamming = shear_jamming_table(account.shear_jammings);
  if (!account.relaxed.empty()) out.relaxed = relaxed_table(account.relaxed);
  if (!account.tapped.empty()) out.tapped = tapped_table(account.tapped);
  out.parameters.closure = {"iso", out.parameters.isotropic.contains("d2") ? "d2" : "iso", false};
  const auto in_vain = add_memory_numbers(folder, reversals, out.parameters);
  out.fits = account.to_json();
  for (const std::string& name : in_vain)
    out.fits["not_determined"].push_back({{"fit", "memory.paths"},
                                          {"role", "fit"},
                                          {"parameter", name.substr(name.find('.') + 1)},
                                          {"reason", out.parameters.parameter(name).note}});
  out.fits["checks"] = physics_checks(account);
  return out;
}

}  // namespace grainlaw::calibrate
