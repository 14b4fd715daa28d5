// What only the law can follow of a path: two prescribed quantities, and a condition that ends a segment.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "grainlaw/element/json.hpp"

namespace grainlaw {

enum class Quantity { nu, eps_vol, eps_dev, P, sigma_dev, s_dev };
std::string name_of(Quantity quantity);

/// One of the two quantities that a segment prescribes, linear from where it stands to the target.
struct LawControl {
  Quantity quantity = Quantity::eps_dev;
  std::optional<double> target;  ///< none: as at the segment's start
};

/// Ends a segment where a column of the prediction passes a value.
struct Stop {
  std::string column;  ///< of prediction_columns(), not `segment`
  bool above = true;   ///< else below
  double value = 0;
};

/// Reads `controls` where it holds two of nu, eps_vol, eps_dev, P, sigma_dev, s_dev, each a number or
/// "start".
std::vector<LawControl> read_law_controls(Reader reader);
Json to_json(const std::vector<LawControl>& controls);

Stop read_stop(Reader reader);
Json to_json(const Stop& stop);

}  // namespace grainlaw
