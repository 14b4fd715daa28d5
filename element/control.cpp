#include "grainlaw/element/control.hpp"

#include <algorithm>

#include "grainlaw/element/path_limits.hpp"

namespace grainlaw {

namespace {

constexpr double fastest = 1e6, longest = 1e15;
constexpr double least_wait = 2000;    // us, 24 background relaxation times of the thesis's material
constexpr double waited_strain = 0.5;  // at the servo's rate: from a gas to a dense packing and beyond

}  // namespace

Range target_range() {
  Range range = above_up_to(0, largest_stress);
  range.unit = "of k* = k/(2<r>) (at 0 grains have lost their contacts)";
  return range;
}

Range shear_target_range() { return of_k_star(between(-largest_stress, largest_stress)); }

StressTarget read_target(Reader& reader, std::string_view key, const Range& range) {
  if (const Json& given = reader.raw(key); given.is_string()) {
    if (given != "start")
      reader.fail(key, "must be \"start\" or a number " + range.text() + ", got " + given.dump());
    return {};
  }
  return {reader.number(key, range)};
}

StressTarget read_target_or_start(Reader& reader, std::string_view key) {
  reader.optional({key});
  return reader.has(key) ? read_target(reader, key) : StressTarget{};
}

ServoLimits read_servo(Reader reader, double rate) {
  ServoLimits servo;
  servo.tolerance = reader.number("tolerance", inside(0, 1), servo.tolerance);
  servo.rate = reader.number("rate", above_up_to(0, fastest), rate);
  servo.wait = reader.number("wait", above_up_to(0, longest),
                             std::min(std::max(least_wait, waited_strain / servo.rate), longest));
  reader.finish();
  return servo;
}

Json to_json(const StressTarget& target) { return target.stress ? Json(*target.stress) : Json("start"); }

Json to_json(const ServoLimits& servo) {
  return {{"tolerance", servo.tolerance}, {"rate", servo.rate}, {"wait", servo.wait}};
}

}  // namespace grainlaw
