#include "grainlaw/element/error.hpp"

#include <array>
#include <charconv>

namespace grainlaw {

namespace {

std::string join(const std::string& file, const std::string& key, const std::string& message) {
  std::string text;
  if (!file.empty()) text += file + ": ";
  if (!key.empty()) text += key + ": ";
  return text + message;
}

}  // namespace

Error::Error(std::string file, std::string key, const std::string& message)
    : std::runtime_error(join(file, key, message)), file_(std::move(file)), key_(std::move(key)) {}

Error Error::cannot_write(std::string file, const std::string& reason) {
  Error error(std::move(file), "", "cannot be written: " + reason);
  error.unwritable_ = true;
  return error;
}

std::string to_text(double value) {
  std::array<char, 32> buffer;
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), end.ptr};
}

}  // namespace grainlaw
