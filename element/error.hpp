// The one exception type of grainlaw: bad input, named by file, key and what would be right.
#pragma once

#include <stdexcept>
#include <string>

namespace grainlaw {

/// Thrown by every library for input that cannot be used or a file that cannot be read or written.
/// what() reads "scene.json: material.w: must be >= 1, got 0.5"; the program prints it and exits with
/// status 2.
class Error : public std::runtime_error {
 public:
  /// Any of `file` and `key` may be empty where there is none.
  Error(std::string file, std::string key, const std::string& message);
  explicit Error(const std::string& message) : Error("", "", message) {}
  /// "out/record.csv: cannot be written: No space left on device": the disk is at fault, so that trying
  /// another test will not help.
  static Error cannot_write(std::string file, const std::string& reason);

  const std::string& file() const noexcept { return file_; }
  const std::string& key() const noexcept { return key_; }
  /// Whether a file could not be written, as said by cannot_write().
  bool unwritable() const noexcept { return unwritable_; }

 private:
  std::string file_;
  std::string key_;
  bool unwritable_ = false;
};

/// Shortest decimal text that reads back as the same double.
std::string to_text(double value);

}  // namespace grainlaw
