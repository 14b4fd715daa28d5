// Where the tests of a campaign start: finds the state that each `from` means on the path of the test that
// passes it. Private to calibrate; used while a campaign is read.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "grainlaw/calibrate/campaign.hpp"

namespace grainlaw::calibrate {

/// `from` as written in CAMPAIGN.json.
struct WrittenOrigin {
  std::string test;
  std::optional<std::int64_t> segment;
  std::vector<double> nu;  ///< as written: none, one or several
  bool list = false;       ///< nu is a list: one test per value, named NAME-x
};

/// A test whose list of states is written out: `from.nu` has at most one value.
struct WrittenTest {
  CampaignTest test;
  std::optional<WrittenOrigin> from;
};

/// Puts the tests into the campaign, each with its origin and the volume fraction it starts from, and checks
/// them: names are different, `from` names a test of the campaign, goes in no circle and means a state on
/// that test's path, targets and snapshots lie on the test's own path. Throws Error.
void resolve_origins(Campaign& campaign, const std::vector<WrittenTest>& written);

}  // namespace grainlaw::calibrate
