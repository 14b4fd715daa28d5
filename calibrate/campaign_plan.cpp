#include "grainlaw/calibrate/campaign_plan.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "grainlaw/dem/drive/stage.hpp"

namespace grainlaw::calibrate {

namespace {

/// Part of its longest duration that a relaxation takes, about: the background viscosity damps E_k/E_p below
/// 1e-6 in 7 relaxation times t_b = 83.78 us (Table 2.1's material), out of 2000 us.
constexpr double relaxation_share = 0.3;

/// Snapshots that other tests need of this one, for one seed.
std::vector<dem::StateRequest> needed_snapshots(const Campaign& campaign, const CampaignTest& producer,
                                                std::int64_t seed) {
  std::vector<dem::StateRequest> needed;
  for (const auto& test : campaign.tests) {
    if (!test.from || test.from->test != producer.name) continue;
    if (std::find(test.seeds.begin(), test.seeds.end(), seed) == test.seeds.end()) continue;
    needed.push_back({test.from->segment, test.from->nu, std::nullopt});
  }
  return needed;
}

void add_snapshots(dem::Measure& measure, const std::vector<dem::StateRequest>& needed) {
  for (const auto& request : needed) {
    const auto same = [&](const dem::StateRequest& other) {
      return other.segment == request.segment && other.nu == request.nu && other.eps_dev == request.eps_dev;
    };
    if (std::none_of(measure.snapshots.begin(), measure.snapshots.end(), same))
      measure.snapshots.push_back(request);
  }
}

Json preparation_json(const Campaign& campaign, const CampaignTest& test, std::int64_t seed) {
  if (!test.from) {
    dem::NewPacking packing = campaign.preparation;
    packing.seed = static_cast<std::uint64_t>(seed);
    return packing.to_json();
  }
  Json json{{"snapshot", "../" + record_name(test.from->test, seed) + "/snapshots.h5"}};
  if (test.from->nu) json["nu"] = *test.from->nu;
  json["segment"] = test.from->segment;
  return json;
}

Json scene_json(const Campaign& campaign, const CampaignTest& test, std::int64_t seed) {
  dem::Measure measure = test.measure;
  add_snapshots(measure, needed_snapshots(campaign, test, seed));
  return {{"material", campaign.material.to_json()},
          {"preparation", preparation_json(campaign, test, seed)},
          {"path", test.path.to_json()},
          {"measure", measure.to_json()}};
}

}  // namespace

double estimate_particle_steps(const Campaign& campaign, const CampaignTest& test) {
  const double contact = campaign.material.contact_duration(campaign.material.r_min());
  double steps =
      dem::expected_passes(test.path.nominal_legs(test.nu_start, test.nu_known), test.measure, contact);
  if (!test.from) {
    const auto& packing = campaign.preparation;
    const double compression = std::log(packing.nu / packing.nu_gas) / 3 / packing.rate;
    steps +=
        (compression + relaxation_share * packing.relax.duration) / (test.measure.time_step_gas * contact);
  }
  return steps * static_cast<double>(campaign.preparation.count);
}

std::vector<Job> plan(const Campaign& campaign) {
  std::vector<Job> jobs;
  std::map<std::string, std::size_t> index;
  for (std::size_t i = 0; i < campaign.tests.size(); ++i) {
    const CampaignTest& test = campaign.tests[i];
    const double work = estimate_particle_steps(campaign, test);
    for (const std::int64_t seed : test.seeds) {
      const std::string record = record_name(test.name, seed);
      index[record] = jobs.size();
      jobs.push_back({record, i, seed, std::nullopt, scene_json(campaign, test, seed), work});
    }
  }
  for (Job& job : jobs)
    if (const auto& from = campaign.tests[job.test].from)
      job.needs = index.at(record_name(from->test, job.seed));
  return jobs;
}

}  // namespace grainlaw::calibrate
