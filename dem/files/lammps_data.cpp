#include "grainlaw/dem/files/lammps_data.hpp"

#include <array>

#include "grainlaw/dem/packing/cell.hpp"
#include "grainlaw/element/error.hpp"

namespace grainlaw::dem {

std::string lammps_data(const State& state, const Material& material) {
  const Cell cell(state.box);
  if (cell.tilted())
    throw Error("the box must be orthorhombic to be written for LAMMPS, but its edges are tilted");
  const std::array<const char*, 3> bounds{" xlo xhi\n", " ylo yhi\n", " zlo zhi\n"};
  std::string text =
      "Packing of grainlaw in mm, us, ug\n\n" + std::to_string(state.count()) + " atoms\n1 atom types\n\n";
  for (std::size_t c = 0; c < 3; ++c) text += "0 " + to_text(state.box(c, c)) + bounds[c];
  text += "\nAtoms # sphere\n\n";
  const std::string rho = to_text(material.rho);
  for (std::size_t i = 0; i < state.count(); ++i) {
    text += std::to_string(i + 1) + " 1 " + to_text(2 * state.radius[i]) + " " + rho;
    for (const double x : cell.wrap(state.position[i])) text += " " + to_text(x);
    text += "\n";
  }
  text += "\nVelocities\n\n";
  for (std::size_t i = 0; i < state.count(); ++i) {
    text += std::to_string(i + 1);
    for (const double v : state.velocity[i]) text += " " + to_text(v);
    text += " 0 0 0\n";
  }
  return text;
}

}  // namespace grainlaw::dem
