// The runs of a campaign: one scene per test and seed, what each waits for, and how much work it is.
// A test that others start from gets the snapshots they need.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "grainlaw/calibrate/campaign.hpp"
#include "grainlaw/element/json.hpp"

namespace grainlaw::calibrate {

struct Job {
  std::string record;  ///< name of the record's directory, TEST-sSEED
  std::size_t test;    ///< index in Campaign::tests
  std::int64_t seed;
  std::optional<std::size_t> needs;  ///< index of the job whose snapshots it starts from
  Json scene;             ///< SCENE.json for records/TEST-sSEED/; snapshot paths lead to the neighbours
  double particle_steps;  ///< estimate: grains times time steps, preparation included
};

/// All jobs, in the order of tests and seeds.
std::vector<Job> plan(const Campaign& campaign);

/// Estimated grains times time steps of one test: every leg's duration over its time step; a relaxation
/// counts a fraction of its longest duration, because it mostly ends earlier.
double estimate_particle_steps(const Campaign& campaign, const CampaignTest& test);

}  // namespace grainlaw::calibrate
