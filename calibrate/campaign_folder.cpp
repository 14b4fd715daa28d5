#include "grainlaw/calibrate/campaign_folder.hpp"

#include <vector>

#include "grainlaw/element/error.hpp"
#include "grainlaw/element/file.hpp"

namespace grainlaw::calibrate {

namespace fs = std::filesystem;

namespace {

constexpr auto campaign_name = "campaign.json";
constexpr auto lock_name = ".lock";

/// Whether a file may lie in a directory that counts as empty: our lock, or a campaign.json that a kill cut
/// short.
bool of_no_account(const std::string& name) {
  return name == lock_name || name.starts_with(std::string(campaign_name) + ".part");
}

/// A file in `dir` that is not ours; empty if there is none.
std::string something_else(const fs::path& dir) {
  for (const auto& entry : fs::directory_iterator(dir))
    if (const std::string name = entry.path().filename().string(); !of_no_account(name)) return name;
  return "";
}

void check_usable(const fs::path& dir, const Campaign& campaign, CampaignFolder::Use use) {
  const fs::path written = dir / campaign_name;
  if (!fs::exists(written)) {
    if (const std::string other = something_else(dir); !other.empty())
      throw Error(dir.string(), "",
                  "is not empty and holds no campaign (there is \"" + other +
                      "\" in it); give another directory with -o");
    return;
  }
  const Campaign there = Campaign::load(written);
  if (const std::string differs = difference(there, campaign); !differs.empty())
    throw Error(dir.string(), "",
                "holds another campaign than " + campaign.file + " (" + differs +
                    "); give another directory with -o");
  if (use == CampaignFolder::Use::fresh)
    throw Error(dir.string(), "",
                "holds this campaign already; go on with --resume, or give another directory with -o");
}

}  // namespace

CampaignFolder::CampaignFolder(const Campaign& campaign, fs::path dir, Use use) : dir_(std::move(dir)) {
  std::error_code code;
  if (fs::exists(dir_, code) && !fs::is_directory(dir_, code))
    throw Error(dir_.string(), "", "is a file, must be a directory");
  if (use == Use::resume && !fs::exists(dir_ / campaign_name, code))
    throw Error(dir_.string(), "", "holds no campaign to go on with; leave --resume out to start one there");
  if (fs::is_directory(dir_, code)) check_usable(dir_, campaign, use);
  const bool made = fs::create_directories(dir_, code);
  if (code) throw Error(dir_.string(), "", "cannot be made: " + code.message());
  try {
    lock_ = std::make_unique<LockFile>(dir_ / lock_name, dir_);
    for (const fs::path& place : {dir_, dir_ / "predictions"})
      if (fs::is_directory(place)) remove_half_written(place);
    if (fs::exists(dir_ / campaign_name))
      check_usable(dir_, campaign, use);  // another process was quicker
    else
      write_file(dir_ / campaign_name, campaign.to_json().dump(2) + "\n");
    if (fs::create_directory(dir_ / "records", code); code)
      throw Error((dir_ / "records").string(), "", "cannot be made: " + code.message());
  } catch (...) {
    lock_.reset();
    if (made) fs::remove(dir_, code);  // only if nothing is in it
    throw;
  }
}

}  // namespace grainlaw::calibrate
