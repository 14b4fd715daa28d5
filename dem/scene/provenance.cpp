#include "grainlaw/dem/scene/provenance.hpp"

#include <chrono>
#include <ctime>

#include "grainlaw/dem/numbers/simd.hpp"
#include "grainlaw/element/version.hpp"

namespace grainlaw::dem {

std::string compiler_name() {
#if defined(__clang__)
  return "clang " + std::to_string(__clang_major__) + "." + std::to_string(__clang_minor__) + "." +
         std::to_string(__clang_patchlevel__);
#elif defined(__GNUC__)
  return "gcc " + std::to_string(__GNUC__) + "." + std::to_string(__GNUC_MINOR__) + "." +
         std::to_string(__GNUC_PATCHLEVEL__);
#else
  return "unknown";
#endif
}

std::string utc_now() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm utc{};
  gmtime_r(&now, &utc);
  char text[sizeof "2024-05-31T12:34:56Z"];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

Provenance Provenance::begin(const Scene& scene) {
  Provenance provenance;
  provenance.version = grainlaw::version();
  provenance.commit = grainlaw::commit();
  if (const auto* packing = std::get_if<NewPacking>(&scene.preparation)) provenance.seed = packing->seed;
  provenance.compiler = compiler_name();
  provenance.simd = simd_target();
  provenance.started = utc_now();
  provenance.k_star = scene.material.stress_unit();
  provenance.k_star_kPa = scene.material.stress_unit_kPa();
  return provenance;
}

double Provenance::particle_steps_per_s() const {
  return wall_time_s > 0 ? static_cast<double>(particle_steps) / wall_time_s : 0;
}

Json Provenance::to_json() const {
  Json json{{"version", version},
            {"commit", commit},
            {"seed", seed ? Json(*seed) : Json(nullptr)},
            {"compiler", compiler},
            {"simd", simd},
            {"started", started},
            {"wall_time_s", wall_time_s},
            {"particle_steps", particle_steps},
            {"particle_steps_per_s", particle_steps_per_s()},
            {"k_star", k_star},
            {"k_star_kPa", k_star_kPa},
            {"time_step", time_step},
            {"warnings", warnings}};
  if (cut_short.empty()) return json;
  json["cut_short"] = cut_short;
  json["rows"] = rows;
  return json;
}

}  // namespace grainlaw::dem
