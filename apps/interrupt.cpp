#include "grainlaw/apps/interrupt.hpp"

#include <unistd.h>

#include <array>
#include <csignal>

#include "grainlaw/apps/commands.hpp"

namespace grainlaw::apps {

namespace {

constexpr std::array signals{SIGINT, SIGTERM, SIGHUP};

// A signal handler can reach nothing but globals.
std::atomic<bool> stop_flag{false};
std::string farewell_text;
std::array<struct sigaction, signals.size()> before;

static_assert(std::atomic<bool>::is_always_lock_free);

extern "C" void grainlaw_set_stop(int) { stop_flag.store(true, std::memory_order_relaxed); }

extern "C" void grainlaw_end_at_once(int) {
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, farewell_text.data(), farewell_text.size());
  ::_exit(interrupted);
}

void handle_signals(void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
  for (std::size_t i = 0; i < signals.size(); ++i)
    if (before[i].sa_handler != SIG_IGN) ::sigaction(signals[i], &action, nullptr);  // nohup stays nohup
}

}  // namespace

Interrupt::Interrupt() {
  stop_flag = false;
  for (std::size_t i = 0; i < signals.size(); ++i) ::sigaction(signals[i], nullptr, &before[i]);
  handle_signals(grainlaw_set_stop);
}

Interrupt::~Interrupt() {
  for (std::size_t i = 0; i < signals.size(); ++i) ::sigaction(signals[i], &before[i], nullptr);
}

const std::atomic<bool>& Interrupt::stop() const { return stop_flag; }

void Interrupt::end_at_once(const std::string& farewell) {
  farewell_text = farewell + "\n";
  handle_signals(grainlaw_end_at_once);
}

}  // namespace grainlaw::apps
