#include "grainlaw/calibrate/campaign_boxes.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "grainlaw/dem/drive/drive.hpp"
#include "grainlaw/dem/drive/stage.hpp"
#include "grainlaw/dem/packing/size_distribution.hpp"
#include "grainlaw/dem/scene/preparation.hpp"

namespace grainlaw::calibrate {

namespace {

using dem::Mat3;

/// The edges of the box at the end of a leg, or where `nu` is on it.
Mat3 edges_after(const Mat3& edges, Leg leg, double nu_start, std::optional<double> nu) {
  if (nu) {
    const double share = (std::log(*nu / nu_start) - leg.eps_vol[0]) / (leg.eps_vol[1] - leg.eps_vol[0]);
    for (double& component : leg.strain) component *= share;
  }
  return dem::Drive(edges, leg).edges(leg.duration);
}

/// The box that a test starts in, where the packing is prepared in `prepared`; none where a servo has
/// strained it.
std::optional<Mat3> start_edges(const Campaign& campaign, const CampaignTest& test, const Mat3& prepared) {
  if (!test.nu_known) return std::nullopt;
  if (!test.from) return prepared;
  const CampaignTest& producer = campaign.test(test.from->test);
  std::optional<Mat3> edges = start_edges(campaign, producer, prepared);
  if (!edges) return std::nullopt;
  const std::vector<Leg> legs = producer.path.nominal_legs(producer.nu_start, producer.nu_known);
  for (std::size_t k = 0; k <= test.from->segment; ++k)
    edges = edges_after(*edges, legs[k], producer.nu_start,
                        k == test.from->segment ? test.from->nu : std::nullopt);
  return edges;
}

}  // namespace

void check_boxes(const Campaign& campaign) {
  dem::Random random(0);  // it orders the radii, which are the same for all seeds
  dem::State start = dem::without_places(
      dem::draw_radii(campaign.material, static_cast<std::size_t>(campaign.preparation.count), random),
      campaign.preparation.nu);
  const Mat3 prepared = start.box;
  const double smallest = *std::min_element(start.radius.begin(), start.radius.end());
  for (const CampaignTest& test : campaign.tests) {
    const std::optional<Mat3> edges = start_edges(campaign, test, prepared);
    if (!edges) continue;
    start.box = *edges;
    const dem::Scene path{campaign.material, dem::FromSnapshot{}, test.path, test.measure, campaign.file};
    check_width(plan_stages(path, test.nu_start, dem::LongestSteps(path, smallest)), start, path);
  }
}

}  // namespace grainlaw::calibrate
