// timing.json: how long each stage of a calibration took, added up over interruptions, and how fast each test
// ran.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "grainlaw/element/json.hpp"

namespace grainlaw::apps {

class StageTimes {
 public:
  /// `resumed`: the simulation goes on, so its time adds to what timing.json in `dir` says. One that cannot
  /// be read is ignored with a warning.
  StageTimes(std::filesystem::path dir, bool resumed);

  /// Runs `work`, notes its seconds (on the clock, and of all cores together) and writes timing.json, also
  /// where it throws Error.
  void measure(const std::string& stage, const std::function<void()>& work);
  /// Seconds on the clock of all stages.
  double total_s() const;

 private:
  struct Stage {
    std::string name;
    double wall_s, core_s;
  };
  static std::vector<Stage> read(const std::filesystem::path& file);
  void write() const;

  std::filesystem::path dir_;
  std::vector<Stage> stages_;
};

}  // namespace grainlaw::apps
