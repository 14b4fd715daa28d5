// The output directory of a campaign: taken only if it is new, empty, or holds this very campaign; held by
// one process.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "grainlaw/calibrate/campaign.hpp"
#include "grainlaw/calibrate/lock_file.hpp"
#include "grainlaw/calibrate/run_folder.hpp"

namespace grainlaw::calibrate {

class CampaignFolder {
 public:
  enum class Use { fresh, resume };

  /// Makes `dir`, locks it and writes campaign.json. Throws Error, and changes nothing, if `dir` holds
  /// something else: another campaign (and where it differs), files of an unknown kind, or, for Use::fresh,
  /// this campaign already; for Use::resume, no campaign.
  CampaignFolder(const Campaign& campaign, std::filesystem::path dir, Use use);

  const std::filesystem::path& dir() const { return dir_; }
  RunFolder records() const { return {dir_}; }

 private:
  std::filesystem::path dir_;
  std::unique_ptr<LockFile> lock_;
};

}  // namespace grainlaw::calibrate
