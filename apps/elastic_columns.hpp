// What `grainlaw probe --also` makes of the elastic constants: columns of its table, by name.
#pragma once

#include <string>
#include <vector>

#include "grainlaw/dem/balance/static_packing.hpp"
#include "grainlaw/dem/stiffness/linear_response.hpp"
#include "grainlaw/element/material.hpp"
#include "grainlaw/element/path.hpp"

namespace grainlaw::apps {

/// Only what is asked for is computed.
class ElasticColumns {
 public:
  /// `wanted`: of the names of elastic_groups(). Throws Error for any other.
  explicit ElasticColumns(const std::vector<std::string>& wanted);

  std::vector<std::string> names() const;
  /// One for each name, of a packing and its linear response to shear along `axis`; not a number where the
  /// stiffness has none.
  std::vector<double> values(const dem::StaticPacking& packing, const dem::LinearResponse& response,
                             const Material& material, const StrainTensor& axis) const;

 private:
  std::vector<std::size_t> wanted_;  ///< which group, each once, in their own order
};

}  // namespace grainlaw::apps
