#include "grainlaw/model/jamming_events.hpp"

#include <algorithm>

namespace grainlaw::model {

namespace {

/// So many are listed.
constexpr std::size_t most_events = 10;

}  // namespace

void tell_events(const std::vector<Event>& events, std::vector<std::string>& warnings) {
  for (std::size_t i = 0; i < std::min(events.size(), most_events); ++i)
    warnings.push_back((events[i].jammed ? "jams " : "unjams: loses its pressure ") +
                       where(events[i].nu, events[i].eps_dev));
  if (events.size() > most_events)
    warnings.push_back("unjams and jams " + std::to_string(events.size() - most_events) + " times more");
}

Status end_status(const Status& status, const State& end) {
  if (status.code != Status::Code::ok || end.jammed) return status;
  return {Status::Code::unjammed, "carries no stress at the end: unjammed " + where(end.nu, end.eps_dev)};
}

std::string where(double nu, double eps_dev) {
  return "at nu = " + shown(nu) + ", eps_dev = " + shown(eps_dev);
}

}  // namespace grainlaw::model
