#include "grainlaw/dem/record/moduli_writer.hpp"

#include "grainlaw/dem/stiffness/probed_packing.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/element/moduli_table.hpp"

namespace grainlaw::dem {

namespace {

/// Those of a table of moduli that say where on its path a state lies, and all that follow.
std::vector<std::string> columns() {
  std::vector<std::string> names = moduli_columns();
  std::erase_if(names, [](const std::string& name) { return name == "file" || name == "frame"; });
  return names;
}

}  // namespace

ModuliWriter::ModuliWriter(const Material& material, const std::vector<Leg>& legs)
    : material_(material), sign_(legs), record_(columns()) {}

void ModuliWriter::append(const State& state, std::size_t segment, double eps_dev) {
  ProbedPacking packing(material_, state, sign_.axis(segment));
  std::string why = packing.refusal();
  std::vector<double> measured;
  try {
    measured = packing.row();
  } catch (const Error& error) {
    why = error.what();
    measured = packing.row_without_moduli();
  }
  if (!why.empty())
    warnings_.push_back("no moduli in segment " + std::to_string(segment) +
                        " at eps_dev = " + to_text(eps_dev) + ": " + why);
  std::vector<double> row{static_cast<double>(segment), eps_dev};
  row.insert(row.end(), measured.begin(), measured.end());
  record_.append(row);
}

}  // namespace grainlaw::dem
