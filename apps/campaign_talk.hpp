// What a running campaign says: on a terminal a live line and a line per finished test, elsewhere lines
// alone; and the same with the time of day in the campaign's log file. What nearly every run warns of (rows
// that are not quasi-static) goes to the log alone, and is counted at the end.
#pragma once

#include <spdlog/logger.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>

#include "grainlaw/apps/terminal.hpp"
#include "grainlaw/calibrate/run_campaign.hpp"

namespace grainlaw::apps {

class CampaignTalk {
 public:
  /// Appends to campaign.log in `dir`. A log that cannot be written is given up silently: the campaign's own
  /// files tell.
  CampaignTalk(Terminal& terminal, const std::filesystem::path& dir);

  /// What goes well.
  void say(const std::string& line);
  /// What does not, on standard error.
  void complain(const std::string& line);
  /// Hooks for run_campaign; the talk must outlive them.
  calibrate::CampaignHooks hooks(const std::atomic<bool>& stop);

 private:
  void remark(const std::string& record, const std::string& warning);
  /// Once no job is left: how many runs left the quasi-static range, if any did.
  void sum_up();
  void show(const calibrate::CampaignProgress& progress);
  void finished(const calibrate::FinishedJob& job, const calibrate::CampaignProgress& progress);
  void failed(const calibrate::FailedJob& job);

  Terminal& terminal_;
  std::shared_ptr<spdlog::logger> log_;
  std::chrono::steady_clock::time_point last_line_ = std::chrono::steady_clock::now();
  std::size_t jobs_ = 0, done_ = 0, lost_ = 0;  ///< of the campaign; lost ones failed or were skipped
  std::size_t runs_ = 0;                        ///< finished by this process
  std::size_t restless_ = 0;                    ///< those of them with rows that are not quasi-static
  double worst_ratio_ = 0;                      ///< largest E_k/E_p among them
  std::string worst_record_;
};

}  // namespace grainlaw::apps
