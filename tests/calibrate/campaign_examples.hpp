// Campaigns small enough to see through, for the tests of reading, planning and running them.
#pragma once

#include <string>

#include "grainlaw/calibrate/campaign.hpp"

namespace grainlaw::calibrate {

inline Campaign campaign_of(const std::string& text) {
  return Campaign::read(Reader(parse_json(text, "c.json"), "c.json"));
}

/// A campaign with these tests, two seeds.
inline std::string with_tests(const std::string& tests) {
  return R"({"name": "c", "preparation": {"count": 100}, "seeds": [1, 2], "tests": [)" + tests + "]}";
}

/// Isotropic loading to 0.82 and unloading to 0.64.
inline const std::string iso = R"({"name": "iso", "role": "fit", "path": {"segments": [
    {"mode": "iso", "controls": {"nu": 0.82}}, {"mode": "iso", "controls": {"nu": 0.64}}]}})";

/// D2 from the states that `from` names.
inline std::string d2(const std::string& from, const std::string& name = "d2") {
  return R"({"name": ")" + name + R"(", "role": "fit", "from": )" + from +
         R"(, "path": {"segments": [{"mode": "d2", "controls": {"eps_dev": 0.4}}]}})";
}

}  // namespace grainlaw::calibrate
