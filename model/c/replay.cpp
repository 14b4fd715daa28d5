#include "grainlaw/model/c/replay.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "grainlaw/element/error.hpp"
#include "grainlaw/element/version.hpp"
#include "grainlaw/model/c/state_table.hpp"

namespace grainlaw::model {

namespace {

constexpr const char* format = "grainlaw-replay-1";

/// Every number of the state but the number of the layout, which is that of the format. NaN is null.
Json state_json(const CoaxialState& state) {
  const auto row = row_of(state);
  Json json = Json::object();
  for (std::size_t i = 1; i < state_length; ++i)
    json[state_names[i]] = std::isfinite(row[i]) ? Json(row[i]) : Json(nullptr);
  return json;
}

CoaxialState read_state(Reader reader) {
  std::array<double, state_length> row{state_version};
  for (std::size_t i = 1; i < state_length; ++i) {
    const bool null = std::string(state_names[i]) == "phi_J" && reader.raw("phi_J").is_null();
    row[i] = null ? std::numeric_limits<double>::quiet_NaN() : reader.number(state_names[i], any_number());
  }
  reader.finish();
  try {
    return state_of(StateRow(row));
  } catch (const Error& error) {
    reader.fail(error.key(), std::string(error.what()).substr(("state: " + error.key() + ": ").size()));
  }
}

Sym6 read_six(Reader& reader, const char* key) {
  const auto numbers = reader.numbers(key, any_number(), 6);
  if (numbers.size() != 6)
    reader.fail(key, "must have 6 numbers, xx, yy, zz, yz, xz, xy, got " + std::to_string(numbers.size()));
  Sym6 six;
  std::copy(numbers.begin(), numbers.end(), six.begin());
  return six;
}

CoaxialSettings read_settings(Reader& reader) {
  CoaxialSettings settings;
  const std::string form = reader.text("form");
  try {
    settings.choice = choice_of(form);
  } catch (const Error& error) {
    reader.fail("form", std::string(error.what()).substr(std::string("form: ").size()));
  }
  settings.tolerance = {reader.number("rtol", above(0)), reader.number("atol", above(0))};
  settings.axis = read_six(reader, "axis");
  settings.coaxial_tolerance = reader.number("coaxial_tolerance", between(0, 1));
  settings.notation = {reader.flag("tension_positive", false), reader.flag("engineering_shear", false)};
  settings.projected_tangent = reader.flag("projected_tangent", false);
  return settings;
}

}  // namespace

Replay Replay::load(const std::filesystem::path& file) {
  return read(Reader(load_json(file), file.string()));
}

Replay Replay::read(Reader reader) {
  reader.word("format", {format});
  Replay replay;
  replay.version = reader.text("version");
  replay.commit = reader.text("commit");
  replay.status = reader.text("status");
  replay.message = reader.text("message");
  replay.settings = read_settings(reader);
  replay.state = read_state(reader.object("state"));
  replay.increment = read_six(reader, "strain_increment");
  replay.tangent = reader.flag("tangent", false);
  replay.parameters = ParameterSet::read(reader.object("parameters"));
  reader.finish();
  return replay;
}

Json Replay::to_json() const {
  const CoaxialSettings& s = settings;
  return {{"format", format},
          {"version", version},
          {"commit", commit},
          {"status", status},
          {"message", message},
          {"form", name_of(s.choice)},
          {"rtol", s.tolerance.rtol},
          {"atol", s.tolerance.atol},
          {"axis", s.axis},
          {"coaxial_tolerance", s.coaxial_tolerance},
          {"tension_positive", s.notation.tension_positive},
          {"engineering_shear", s.notation.engineering_shear},
          {"projected_tangent", s.projected_tangent},
          {"state", state_json(state)},
          {"strain_increment", increment},
          {"tangent", tangent},
          {"parameters", parameters.to_json()}};
}

Replayed replay(const Replay& replay) {
  const CoaxialLaw law(replay.parameters, replay.settings);
  CoaxialLaw::Workspace workspace;
  Replayed now{{}, replay.state};
  now.stress = law.stress(now.state.point);
  Matrix6 tangent;
  now.status =
      law.update(now.state, replay.increment, workspace, now.stress, replay.tangent ? &tangent : nullptr);
  return now;
}

}  // namespace grainlaw::model
