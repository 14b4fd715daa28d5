// A failed increment as a file that replays it: law, state and strain (REPLAY.json in docs/formats.md).
#pragma once

#include <filesystem>
#include <string>

#include "grainlaw/element/json.hpp"
#include "grainlaw/model/c/coaxial.hpp"

namespace grainlaw::model {

struct Replay {
  ParameterSet parameters;
  CoaxialSettings settings;
  CoaxialState state;    ///< before the increment
  Sym6 increment{};      ///< as the host wrote it
  bool tangent = false;  ///< whether it was asked for
  std::string status;    ///< what came of it when the file was written: name_of(Status::Code)
  std::string message;
  std::string version, commit;  ///< of the grainlaw that wrote it

  /// Throws Error naming file and key.
  static Replay load(const std::filesystem::path& file);
  static Replay read(Reader reader);
  Json to_json() const;
};

/// What an increment does now.
struct Replayed {
  Status status;
  CoaxialState state;  ///< after it; as before where it failed
  Sym6 stress{};       ///< of that state, as the host writes it
};
/// Throws Error where the law cannot be made.
Replayed replay(const Replay& replay);

}  // namespace grainlaw::model
