#include "grainlaw/apps/report/numbers.hpp"

#include <charconv>
#include <cmath>
#include <limits>

namespace grainlaw::report {
namespace {

const std::string minus = "−";

std::string print(double x, std::chars_format format, int precision) {
  char text[400];
  const auto end = std::to_chars(text, text + sizeof text, x, format, precision).ptr;
  return {text, end};
}

/// Replaces the ASCII hyphen by a minus sign.
std::string proper_minus(std::string text) {
  if (!text.empty() && text[0] == '-') text.replace(0, 1, minus);
  return text;
}

std::string superscript(int n) {
  static const char* const digits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = n < 0 ? "⁻" : "";
  for (const char c : std::to_string(std::abs(n))) text += digits[c - '0'];
  return text;
}

/// Power of ten of the first digit of x once it is rounded to `digits` digits.
int leading_power(double x, int digits) {
  const std::string text = print(std::abs(x), std::chars_format::scientific, digits - 1);
  return std::stoi(text.substr(text.find('e') + 1));
}

std::string drop_trailing_zeros(std::string text) {
  if (text.find('.') == std::string::npos) return text;
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

bool plain_reads_well(int power) { return power >= -3 && power <= 4; }

}  // namespace

std::string number(double x, int digits) {
  if (!std::isfinite(x)) return nothing;
  if (x == 0) return "0";
  const int power = leading_power(x, digits);
  if (plain_reads_well(power)) {
    const int decimals = digits - 1 - power;
    const double unit = decimals < 0 ? std::pow(10.0, -decimals) : 1;
    const double rounded = decimals < 0 ? std::round(x / unit) * unit : x;
    return proper_minus(drop_trailing_zeros(print(rounded, std::chars_format::fixed, std::max(0, decimals))));
  }
  std::string mantissa = print(x, std::chars_format::scientific, digits - 1);
  mantissa.erase(mantissa.find('e'));
  return proper_minus(drop_trailing_zeros(mantissa)) + "×10" + superscript(power);
}

std::string number(std::optional<double> x, int digits) { return x ? number(*x, digits) : nothing; }

std::string with_error(std::optional<double> value, std::optional<double> error) {
  if (!value || !std::isfinite(*value)) return nothing;
  if (!error || !std::isfinite(*error) || *error <= 0) return number(*value, 5);
  const int error_power = leading_power(*error, 2);
  const int value_power = *value == 0 ? error_power : leading_power(*value, 6);
  const int top = std::max(error_power, value_power);
  const int shift = plain_reads_well(top) ? 0 : top;
  const int decimals = std::max(0, 1 - error_power + shift);
  // A value that needs more digits than a double holds is exact for every purpose of a report.
  if (decimals > 15) return number(*value, 6);
  const double unit = std::pow(10.0, shift);
  const std::string text = proper_minus(print(*value / unit, std::chars_format::fixed, decimals)) + " ± " +
                           print(*error / unit, std::chars_format::fixed, decimals);
  return shift == 0 ? text : "(" + text + ")×10" + superscript(shift);
}

std::string signed_number(double x) {
  if (!std::isfinite(x)) return nothing;
  if (std::abs(x) >= 999.95) return (x > 0 ? "+" : "") + number(x, 2);
  const std::string text = print(std::abs(x), std::chars_format::fixed, 1);
  return text == "0.0" ? text : (x > 0 ? "+" : minus) + text;
}

std::string count(std::uint64_t n) {
  std::string text = std::to_string(n);
  for (int at = static_cast<int>(text.size()) - 3; at > 0; at -= 3) {
    text.insert(static_cast<std::size_t>(at), "\u202f");
  }
  return text;
}

std::string seconds(std::optional<double> s) {
  if (!s || !std::isfinite(*s) || *s < 0) return nothing;
  if (*s < 0.9995) return number(std::round(*s * 1e3), 3) + " ms";
  if (*s < 99.95) return number(*s, *s < 9.995 ? 2 : 3) + " s";
  const auto whole = static_cast<std::uint64_t>(std::llround(std::min(*s, 1e15)));
  const auto two_digits = [](std::uint64_t n) { return (n < 10 ? "0" : "") + std::to_string(n); };
  if (whole < 3600) return std::to_string(whole / 60) + " min " + two_digits(whole % 60) + " s";
  return count(whole / 3600) + " h " + two_digits(whole % 3600 / 60) + " min";
}

std::string percent(std::optional<double> fraction) {
  if (!fraction || !std::isfinite(*fraction)) return nothing;
  const double value = 100 * *fraction;
  return number(value, value < 9.95 ? 2 : 3) + " %";
}

std::optional<double> number_in(const Json& object, const std::string& key) {
  const Json& value = value_in(object, key);
  if (!value.is_number() || !std::isfinite(value.get<double>())) return std::nullopt;
  return value.get<double>();
}

std::string text_in(const Json& object, const std::string& key) {
  const Json& value = value_in(object, key);
  return value.is_string() ? value.get<std::string>() : "";
}

const Json& value_in(const Json& object, const std::string& key) {
  static const Json null;
  if (!object.is_object()) return null;
  const auto found = object.find(key);
  return found == object.end() ? null : *found;
}

std::vector<double> numbers_in(const Json& object, const std::string& key) {
  std::vector<double> numbers;
  const Json& list = value_in(object, key);
  if (!list.is_array()) return numbers;
  for (const Json& entry : list) {
    numbers.push_back(entry.is_number() ? entry.get<double>() : std::numeric_limits<double>::quiet_NaN());
  }
  return numbers;
}

}  // namespace grainlaw::report
