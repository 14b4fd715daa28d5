#include "grainlaw/calibrate/campaign_schedule.hpp"

#include <algorithm>
#include <queue>

namespace grainlaw::calibrate {

Schedule::Schedule(const std::vector<Job>& jobs)
    : jobs_(jobs), states_(jobs.size(), State::ready), waiting_for_(jobs.size()), chain_(jobs.size(), 0) {
  for (std::size_t i = 0; i < jobs.size(); ++i)
    if (jobs[i].needs) {
      states_[i] = State::waiting;
      waiting_for_[*jobs[i].needs].push_back(i);
    }
  // A job's chain is known when those of all that wait for it are; walk from every job up to its origin.
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    double after = 0;
    for (std::optional<std::size_t> at = i; at; at = jobs[*at].needs) {
      after += jobs[*at].particle_steps;
      if (chain_[*at] >= after) break;
      chain_[*at] = after;
      after = chain_[*at];
    }
  }
}

std::optional<std::size_t> Schedule::take() {
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < jobs_.size(); ++i)
    if (states_[i] == State::ready && (!best || chain_[i] > chain_[*best])) best = i;
  if (best) states_[*best] = State::running;
  return best;
}

void Schedule::finish(std::size_t job) {
  states_.at(job) = State::done;
  for (const std::size_t next : waiting_for_[job])
    if (states_[next] == State::waiting) states_[next] = State::ready;
}

std::vector<std::size_t> Schedule::fail(std::size_t job) {
  states_.at(job) = State::failed;
  std::vector<std::size_t> skipped = waiting_for_[job];
  for (std::size_t i = 0; i < skipped.size(); ++i) {
    const auto& next = waiting_for_[skipped[i]];
    skipped.insert(skipped.end(), next.begin(), next.end());
  }
  std::erase_if(skipped, [&](std::size_t i) { return states_[i] == State::done; });
  for (const std::size_t i : skipped) states_[i] = State::skipped;
  return skipped;
}

std::size_t Schedule::count(State state) const {
  return static_cast<std::size_t>(std::count(states_.begin(), states_.end(), state));
}

bool Schedule::over() const {
  return std::none_of(states_.begin(), states_.end(),
                      [](State state) { return state == State::ready || state == State::running; });
}

double Schedule::time_left(std::size_t workers, double rate,
                           const std::function<double(std::size_t)>& fraction) const {
  using Waiting = std::pair<double, std::size_t>;  // chain, job
  using Ending = std::pair<double, std::size_t>;   // time, job
  std::priority_queue<Waiting> ready;
  std::priority_queue<Ending, std::vector<Ending>, std::greater<>> running;
  for (std::size_t i = 0; i < jobs_.size(); ++i) {
    if (states_[i] == State::ready) ready.emplace(chain_[i], i);
    if (states_[i] == State::running) running.emplace(jobs_[i].particle_steps * (1 - fraction(i)) / rate, i);
  }
  double now = 0;
  for (;;) {
    while (!ready.empty() && running.size() < workers) {
      const std::size_t job = ready.top().second;
      ready.pop();
      running.emplace(now + jobs_[job].particle_steps / rate, job);
    }
    if (running.empty()) return now;
    const auto [time, job] = running.top();
    running.pop();
    now = time;
    for (const std::size_t next : waiting_for_[job])
      if (states_[next] == State::waiting) ready.emplace(chain_[next], next);
  }
}

}  // namespace grainlaw::calibrate
