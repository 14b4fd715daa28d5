// MODULI.csv: small-strain moduli of packings, one row for each packing and strain (docs/formats.md). What
// `grainlaw probe` and the measure of a scene write, and the fits read.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "grainlaw/element/record.hpp"

namespace grainlaw {

/// Largest net force over the mean contact force of a packing whose moduli are any: they err by about as
/// much.
inline constexpr double largest_moduli_residual = 1e-5;

/// Its columns, in order: where the packing comes from (`file`, `frame` only of `grainlaw probe`), its state,
/// the moduli, the 21 constants.
const std::vector<std::string>& moduli_columns();

/// Those that `grainlaw probe --undo` adds.
const std::vector<std::string>& undo_columns();

/// A name of `grainlaw probe --also`, and the columns that it adds.
struct ElasticGroup {
  std::string name;
  std::vector<std::string> columns;
};
/// All of them: eigenvalues, symmetry, young, waves, floppy, invariants, affine, stress.
const std::vector<ElasticGroup>& elastic_groups();

/// Reads one, with or without the columns of --undo and --also. Throws Error (file, column) for a column that
/// is none of these or lacks, and as Record::read_csv does. A packing that was refused has a row with empty
/// moduli.
Record read_moduli(const std::filesystem::path& file);

/// Why the packing of a row has no moduli, from the row itself: no grain bears load, fewer contacts than a
/// stable balance takes (3 n - 2 between n grains in a box that is held), or forces that are left. NaN where
/// the row does not say.
std::string why_no_moduli(double backbone, double contacts, double residual);

/// Fewest contacts between `backbone` grains without friction with which a balance can be stable: 3 n - 3
/// hold all but the three displacements of the whole, and one more lets them press.
double isostatic_contacts(double backbone);

}  // namespace grainlaw
