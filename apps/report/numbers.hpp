// Numbers as people write them in a report: as many digits as the error allows, never "nan".
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "grainlaw/element/json.hpp"

namespace grainlaw::report {

/// What stands where there is no value.
inline constexpr const char* nothing = "—";

/// `x` to so many significant digits as plain UTF-8 text; trailing zeros dropped; very large or small numbers
/// as 1.2×10⁻⁵. Not finite: "—".
std::string number(double x, int digits = 4);
std::string number(std::optional<double> x, int digits = 4);

/// "8.272 ± 0.053": the error to two significant digits, the value to the same decimal. Without an error,
/// five digits.
std::string with_error(std::optional<double> value, std::optional<double> error);

/// Signed, one decimal: "+0.8", "−2.1".
std::string signed_number(double x);

/// A count with thin spaces between thousands.
std::string count(std::uint64_t n);

/// "48 ms", "7.3 s", "4 min 05 s", "2 h 10 min".
std::string seconds(std::optional<double> s);

/// A relative error as "3.4 %".
std::string percent(std::optional<double> fraction);

/// The number under `key`, if `object` is an object that has one.
std::optional<double> number_in(const Json& object, const std::string& key);
/// The text under `key`, or "".
std::string text_in(const Json& object, const std::string& key);
/// The value under `key`, or null.
const Json& value_in(const Json& object, const std::string& key);
/// The numbers of a list under `key`; whatever in it is not a number becomes NaN.
std::vector<double> numbers_in(const Json& object, const std::string& key);

}  // namespace grainlaw::report
