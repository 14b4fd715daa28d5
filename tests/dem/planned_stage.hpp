// A stage as a scene plans it, for tests that try or drive one.
#pragma once

#include <string>

#include "grainlaw/dem/drive/stage.hpp"
#include "grainlaw/dem/scene/scene.hpp"
#include "grainlaw/element/error.hpp"

namespace grainlaw::dem::test {

/// The last stage of a path with this segment, of 200 grains from `nu` on.
inline Stage planned_stage(const std::string& segment, double nu, int rows) {
  const std::string json = R"({"preparation": {"count": 200, "nu": )" + to_text(nu) +
                           R"(}, "path": {"segments": [)" + segment + R"(]}, "measure": {"rows": )" +
                           std::to_string(rows) + "}}";
  const Scene scene = Scene::read(Reader(parse_json(json, "s.json"), "s.json"), "");
  return plan_stages(scene, nu, LongestSteps(scene, scene.material.r_min())).back();
}

}  // namespace grainlaw::dem::test
