#include "grainlaw/model/samples.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "grainlaw/element/error.hpp"

namespace grainlaw::model {

namespace {

bool is_shear(const Leg& leg) { return leg.eps_dev[0] != leg.eps_dev[1]; }

/// Strains must be numbers, and the law carries one direction of shear: every leg must keep the axes of the
/// first that shears.
void check_legs(const Path& path, const std::vector<Leg>& legs) {
  for (std::size_t i = 0; i < legs.size(); ++i)
    if (!std::isfinite(legs[i].eps_vol[1]) || !std::isfinite(legs[i].eps_dev[1]))
      throw Error(path.file, path.segments[i].key, "its strain must be a finite number");
  const auto first = std::find_if(legs.begin(), legs.end(), is_shear);
  for (auto leg = first; leg != legs.end(); ++leg)
    if (is_shear(*leg) && !coaxial(leg->strain, first->strain))
      throw Error(path.file, path.segments[static_cast<std::size_t>(leg - legs.begin())].key,
                  "mode " + name_of(leg->mode) + " is not coaxial with " + name_of(first->mode) +
                      " before it: the law carries stress and fabric along one direction of shear only");
}

}  // namespace

std::vector<Leg> legs_of(const Path& path, double nu) {
  path.need_law_can_follow();
  std::vector<Leg> legs = path.legs(nu);
  check_legs(path, legs);
  return legs;
}

std::vector<Sample> even_samples(const std::vector<Leg>& legs, int rows_per_leg) {
  std::vector<Sample> samples{{0, 0}};
  for (std::size_t i = 0; i < legs.size(); ++i) {
    const int rows = legs[i].mode == Mode::relax ? 1 : rows_per_leg;
    for (int row = 1; row <= rows; ++row) samples.push_back({i, static_cast<double>(row) / rows});
  }
  return samples;
}

void check_samples(const std::vector<Sample>& samples, std::size_t legs) {
  Sample last;
  for (const Sample& sample : samples) {
    const bool ordered =
        sample.leg > last.leg || (sample.leg == last.leg && sample.progress >= last.progress);
    if (sample.leg >= legs || !(sample.progress >= 0 && sample.progress <= 1) || !ordered)
      throw Error("", "samples",
                  "must be points of the path in order, got leg " + std::to_string(sample.leg) +
                      ", progress " + to_text(sample.progress));
    last = sample;
  }
}

}  // namespace grainlaw::model
