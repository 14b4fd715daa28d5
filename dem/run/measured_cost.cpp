#include "grainlaw/dem/run/measured_cost.hpp"

#include <malloc.h>

#include <algorithm>
#include <ctime>
#include <fstream>
#include <limits>
#include <string>

namespace grainlaw::dem {

namespace {

/// A line of /proc/self/status, in bytes; 0 where it is missing.
double status_bytes(const std::string& key) {
  std::ifstream status("/proc/self/status");
  std::string word;
  double kilobytes = 0;
  while (status >> word)
    if (word == key + ":") {
      status >> kilobytes;
      break;
    }
  return 1024 * kilobytes;
}

}  // namespace

double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double heap_bytes() {
  const auto heap = mallinfo2();
  if (heap.arena == 0) return std::numeric_limits<double>::quiet_NaN();
  return static_cast<double>(heap.uordblks) + static_cast<double>(heap.hblkhd);
}

double peak_bytes(const std::function<void()>& call) {
  malloc_trim(0);
  std::ofstream marks("/proc/self/clear_refs");
  marks << "5" << std::flush;  // the high water mark begins anew
  const bool begins_anew = marks.good();
  const double before = status_bytes("VmRSS");
  call();
  return begins_anew ? std::max(status_bytes("VmHWM") - before, 0.0) : 0;
}

}  // namespace grainlaw::dem
