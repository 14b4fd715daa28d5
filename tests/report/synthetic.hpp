// A campaign folder made up from the thesis's laws with noise: what a report is made of, without a
// simulation.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace grainlaw::report::test {

struct Synthetic {
  std::string name = "synthetic";          ///< of the campaign
  std::string uniaxial_test = "uni-0.69";  ///< name of one of the tests to predict, for hostile names
  std::vector<int> seeds{1, 2};
};

/// Writes a complete campaign folder into `dir`, which is created.
void write_synthetic_campaign(const std::filesystem::path& dir, const Synthetic& options = {});

}  // namespace grainlaw::report::test
