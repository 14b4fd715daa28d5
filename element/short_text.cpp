#include "grainlaw/element/short_text.hpp"

#include <array>
#include <cstdio>

namespace grainlaw {

std::string short_text(double x, int digits) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.*g", digits, x);
  return text.data();
}

}  // namespace grainlaw
