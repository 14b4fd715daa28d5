#include "grainlaw/calibrate/campaign_boxes.hpp"

#include <algorithm>

#include "grainlaw/dem/drive/stage.hpp"
#include "grainlaw/dem/packing/size_distribution.hpp"
#include "grainlaw/dem/scene/preparation.hpp"

namespace grainlaw::calibrate {

namespace {

bool begins_in_a_cube(const Campaign& campaign, const CampaignTest& test) {
  if (!test.nu_known) return false;
  if (!test.from) return true;
  const CampaignTest& producer = campaign.test(test.from->test);
  const auto first = producer.path.segments.begin();
  return begins_in_a_cube(campaign, producer) &&
         std::all_of(first, first + static_cast<std::ptrdiff_t>(test.from->segment) + 1,
                     [](const Segment& s) { return s.mode == Mode::iso || s.mode == Mode::relax; });
}

}  // namespace

void check_boxes(const Campaign& campaign) {
  dem::Random random(0);  // it orders the radii, which are the same for all seeds
  const auto radii =
      dem::draw_radii(campaign.material, static_cast<std::size_t>(campaign.preparation.count), random);
  const double smallest = *std::min_element(radii.begin(), radii.end());
  for (const CampaignTest& test : campaign.tests) {
    if (!begins_in_a_cube(campaign, test)) continue;
    const dem::Scene path{campaign.material, dem::FromSnapshot{}, test.path, test.measure, campaign.file};
    const dem::LongestSteps longest(path, smallest);
    check_width(plan_stages(path, test.nu_start, longest), dem::without_places(radii, test.nu_start), path);
  }
}

}  // namespace grainlaw::calibrate
