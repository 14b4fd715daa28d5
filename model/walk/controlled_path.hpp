// The law along a path of which some segments prescribe stresses, or end on a condition: the strain of each
// is known only when it has been walked.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "grainlaw/element/path.hpp"
#include "grainlaw/model/walk/integrator.hpp"
#include "grainlaw/model/walk/point.hpp"

namespace grainlaw::model {

struct WalkedPath {
  Status status;                  ///< limit and failed: the rest of the path was not walked
  std::vector<Leg> legs;          ///< the strains that were walked, of the segments so far
  std::vector<double> P_at_ends;  ///< of these
  std::vector<std::string> warnings;
};

/// Visits `rows` states of each segment, evenly spaced in what it prescribes (of a relaxation its end), and
/// the one where a segment ends early. Throws Error (file, key) for a segment that the law cannot follow.
WalkedPath walk_controlled(MaterialPoint& point, Tolerance tolerance, const Path& path, int rows,
                           const std::function<void(std::size_t segment, const State&)>& visit);

}  // namespace grainlaw::model
