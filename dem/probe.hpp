// Small-strain moduli of a packing in balance by straining it: what a probe test measures.
#pragma once

#include <cstdint>

#include "grainlaw/dem/linear_response.hpp"
#include "grainlaw/dem/static_packing.hpp"
#include "grainlaw/element/path.hpp"

namespace grainlaw::dem {

struct Probe {
  double amplitude =
      0;          ///< strain: 3 d(eps_v) of the isotropic probe, d(eps_dev) of the other; negative: backwards
  Moduli moduli;  ///< secant: change of stress over `amplitude`, ug/(mm us^2)
  /// Contacts between grains that bear load which opened or closed, in both probes together. Moduli are
  /// elastic where there are none.
  std::uint64_t contacts_changed = 0;
  double residual =
      0;  ///< largest net force over the mean contact force that was reached, the larger of both
};

/// Strains two copies of `packing`, which must be in balance, one isotropically and one along `axis`
/// (diagonal), brings each back into balance to `residual` and takes the changes of stress (Eq. 4.10). The
/// stress of a packing that is out of balance by `residual` errs by about that times P: keep it well below
/// |amplitude|. Throws Error where the energy cannot be minimised.
Probe probe(const StaticPacking& packing, const StrainTensor& axis, double amplitude,
            double residual = 1e-10);

}  // namespace grainlaw::dem
