// What the program says while it works: lines, and on a terminal one live line below them that is drawn over
// and over.
#pragma once

#include <cstddef>
#include <cstdio>
#include <string>

namespace grainlaw::apps {

class Terminal {
 public:
  Terminal();
  /// Takes the live line away.
  ~Terminal();
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  /// Whether standard output is a terminal that can draw a line over.
  bool live() const { return live_; }
  /// A line on standard output, above the live line.
  void say(const std::string& line);
  /// A line on standard error.
  void warn(const std::string& line);
  /// The live line, cut to the width of the terminal; nothing elsewhere.
  void draw(const std::string& line);

 private:
  void clear();
  bool live_;
  bool drawn_ = false;
};

/// "12.3 M particle-steps/s"
std::string speed_text(double particle_steps_per_s);
/// "8.1 s", "45 s", "3 min 20 s", "2 h 5 min"
std::string time_text(double seconds);
/// "[#####.....]" of so many characters.
std::string bar_text(double fraction, std::size_t width);

/// Writes `text` to standard output; throws Error where that fails (a full disk behind a redirection).
void write_stdout(const std::string& text);

}  // namespace grainlaw::apps
