// A packing in the data format of LAMMPS, for runs of other codes that start from one of ours.
#pragma once

#include <string>

#include "grainlaw/dem/packing/state.hpp"
#include "grainlaw/element/material.hpp"

namespace grainlaw::dem {

/// A box as LAMMPS wants it: the shortest edges of the lattice, the first along x, the second in the xy
/// plane.
struct LammpsBox {
  /// In the columns, mm: (lx, 0, 0), (xy, ly, 0), (xz, yz, lz), with |xy| and |xz| <= lx/2, |yz| <= ly/2. Of
  /// an orthorhombic box its own.
  Mat3 edges;
  /// Q: x -> Q x leads there from the frame of `state`; its rows are the axes there. 1 where the shortest
  /// edges lie so already, as after simple shear of a cube.
  Mat3 turn;
  Mat3 to_parts;  ///< to parts of the edges

  explicit LammpsBox(const Mat3& box);
  /// Q x, in the image that lies in the box, to rounding.
  Vec3 place(const Vec3& x) const;
};

/// The text of a data file for `atom_style sphere`: one atom type; diameter, density, position (wrapped into
/// the box) and velocity of each grain, atom i + 1 being grain i. All numbers read back to the last bit. A
/// tilted box becomes a LammpsBox, with positions and velocities turned along; its Q stands in comments at
/// the top. The velocity is the fluctuation velocity; where the box is to deform, LAMMPS wants the affine
/// motion added.
std::string lammps_data(const State& state, const Material& material);

}  // namespace grainlaw::dem
