// Small-strain moduli of a packing in balance by straining it: what a probe test measures.
#pragma once

#include <cstdint>

#include "grainlaw/dem/balance/static_packing.hpp"
#include "grainlaw/dem/stiffness/linear_response.hpp"
#include "grainlaw/element/path.hpp"

namespace grainlaw::dem {

/// Contacts between grains that bear load, opened or closed.
struct Changes {
  std::uint64_t by_volume = 0, by_shear = 0;  ///< in the isotropic probe, in the other
  std::uint64_t both() const { return by_volume + by_shear; }
};

struct Probe {
  double amplitude =
      0;          ///< strain: 3 d(eps_v) of the isotropic probe, d(eps_dev) of the other; negative: backwards
  Moduli moduli;  ///< secant: change of stress over `amplitude`, ug/(mm us^2)
  Changes changed;  ///< moduli are elastic where there are none
  double residual =
      0;  ///< largest net force over the mean contact force that was reached, the largest of all balances
  /// Where the strain was undone: what is left of the stresses, over `amplitude` as the moduli are, and of
  /// the changes of contacts. All zero for an elastic packing.
  Moduli left;
  Changes contacts_left;
};

struct ProbeOptions {
  double residual = 1e-10;
  bool undo = false;  ///< also take each strain back, which doubles the cost
};

/// Strains two copies of `packing`, which must be in balance, one isotropically and one along `axis`
/// (diagonal; d(eps_dev) = amplitude), brings each back into balance and takes the changes of stress
/// (Eq. 4.10). An axis that compresses, as UNI's (0, 0, 1), gives its two moduli less what the isotropic
/// probe has of B and A2 for as much volume strain. The stress of a packing that is out of balance by the
/// residual errs by about that times P: keep it well below |amplitude|. Throws Error where the energy cannot
/// be minimised.
Probe probe(const StaticPacking& packing, const StrainTensor& axis, double amplitude,
            const ProbeOptions& options = {});

}  // namespace grainlaw::dem
