#include "grainlaw/apps/terminal.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <string_view>

#include "grainlaw/element/error.hpp"

namespace grainlaw::apps {

namespace {

bool can_draw() {
  const char* kind = std::getenv("TERM");
  return ::isatty(STDOUT_FILENO) == 1 && kind != nullptr && std::string_view(kind) != "dumb";
}

std::size_t columns() {
  struct winsize size {};
  return ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

}  // namespace

Terminal::Terminal() : live_(can_draw()) {}

Terminal::~Terminal() { clear(); }

void Terminal::clear() {
  if (!drawn_) return;
  std::fputs("\r\033[K", stdout);
  std::fflush(stdout);
  drawn_ = false;
}

void Terminal::say(const std::string& line) {
  clear();
  std::fputs((line + "\n").c_str(), stdout);
  std::fflush(stdout);
}

void Terminal::warn(const std::string& line) {
  clear();
  std::fputs((line + "\n").c_str(), stderr);
}

void Terminal::draw(const std::string& line) {
  if (!live_) return;
  clear();
  std::fputs(line.substr(0, columns() - 1).c_str(), stdout);
  std::fflush(stdout);
  drawn_ = true;
}

std::string speed_text(double particle_steps_per_s) {
  return fmt::format("{:.1f} M particle-steps/s", particle_steps_per_s / 1e6);
}

std::string time_text(double seconds) {
  if (seconds < 9.95) return fmt::format("{:.1f} s", std::max(0.0, seconds));
  const auto s = static_cast<long long>(std::llround(std::clamp(seconds, 0.0, 1e12)));
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{} min {} s", s / 60, s % 60);
  return fmt::format("{} h {} min", s / 3600, s % 3600 / 60);
}

std::string bar_text(double fraction, std::size_t width) {
  const auto full = static_cast<std::size_t>(std::clamp(fraction, 0.0, 1.0) * static_cast<double>(width));
  return "[" + std::string(full, '#') + std::string(width - full, '.') + "]";
}

void write_stdout(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
    throw Error::cannot_write("standard output", std::strerror(errno));
}

}  // namespace grainlaw::apps
