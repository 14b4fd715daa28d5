// Response envelopes (Gudehus 1979): strain increments of one size in all directions of the (eps_vol,
// eps_dev) plane, each from the same state, and the stresses they lead to.
#pragma once

#include <string>
#include <vector>

#include "grainlaw/element/record.hpp"
#include "grainlaw/model/forms/law.hpp"
#include "grainlaw/model/status.hpp"
#include "grainlaw/model/walk/integrator.hpp"

namespace grainlaw::model {

/// Columns of a table of responses: `direction` in degrees, 0 for isotropic compression, 90 for shear with
/// eps_dev growing; the increment `eps_vol`, `eps_dev` of size sqrt(eps_vol^2 + eps_dev^2); what it changes
/// stress and fabric by; and the values that it leads to.
const std::vector<std::string>& envelope_columns();

struct Envelope {
  Record responses;  ///< a row per direction that was walked
  Status status;     ///< failed: that of the first direction that was not
};

/// `directions` >= 1, evenly spaced from 0 degrees; `size` > 0.
Envelope envelope(const Law& law, const State& from, Tolerance tolerance, double size, int directions);

}  // namespace grainlaw::model
