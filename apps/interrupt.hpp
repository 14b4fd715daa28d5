// Ctrl-C and SIGTERM, turned into a flag that long work looks at. Signals belong to the whole process, so
// there is at most one Interrupt at a time.
#pragma once

#include <atomic>
#include <string>

namespace grainlaw::apps {

class Interrupt {
 public:
  /// From now on SIGINT, SIGTERM and SIGHUP set stop(); a second one ends the process as if nobody listened.
  /// One that is ignored (nohup) stays so.
  Interrupt();
  /// Signals do again what they did before.
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  const std::atomic<bool>& stop() const;
  /// For work that does not look at stop(): from now on a signal prints `farewell` and ends the process with
  /// status 130.
  void end_at_once(const std::string& farewell);
};

}  // namespace grainlaw::apps
