// Where a record comes from: program, machine code, time and effort (provenance.json in docs/formats.md).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "grainlaw/dem/scene/scene.hpp"
#include "grainlaw/element/json.hpp"

namespace grainlaw::dem {

struct Provenance {
  std::string version, commit;        ///< of grainlaw
  std::optional<std::uint64_t> seed;  ///< of a new packing; none (null) where the test starts from a snapshot
  std::string compiler;               ///< name and version
  std::string simd;                   ///< instruction set of the kernels, see simd_target()
  std::string started;                ///< UTC, ISO 8601: 2024-05-31T12:34:56Z
  double wall_time_s = 0;
  std::uint64_t particle_steps =
      0;              ///< grains times time steps or passes of a minimiser, preparation included
  double k_star = 0;  ///< unit of stress k/(2<r>), ug/(mm us^2) = MPa
  double k_star_kPa = 0;
  double time_step = 0;  ///< us, during the path
  std::vector<std::string> warnings;
  /// A sentence, where the path could not be followed to its end: the record has the rows up to there.
  std::string cut_short;
  std::size_t rows = 0;  ///< of that record; only of one that is cut short

  /// All that is known when a test begins; `started` is now. The engine adds the effort at the end.
  static Provenance begin(const Scene& scene);
  /// 0 where no time has passed.
  double particle_steps_per_s() const;
  Json to_json() const;
};

/// "gcc 12.2.0", "clang 16.0.6", ...
std::string compiler_name();
/// Now in UTC, to the second.
std::string utc_now();

}  // namespace grainlaw::dem
