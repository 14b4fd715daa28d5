// The C interface: law, state and context.
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <string_view>

#include "grainlaw/element/version.hpp"
#include "grainlaw/model/c/c_interface-inl.hpp"

using namespace grainlaw::model;  // NOLINT: the functions below cannot be in it
using grainlaw::Error;
using grainlaw::Sym6;

namespace {

CoaxialSettings read_settings(const grainlaw_settings* given) {
  must_be_there(given, "settings");
  if (given->size != sizeof(grainlaw_settings))
    throw Error("", "settings.size",
                "must be " + std::to_string(sizeof(grainlaw_settings)) + ", as GRAINLAW_SETTINGS says, got " +
                    std::to_string(given->size));
  must_be_there(given->form, "settings.form");
  CoaxialSettings settings;
  settings.choice = choice_of(given->form);
  settings.tolerance = {given->rtol, given->atol};
  settings.axis = six(given->axis);
  settings.coaxial_tolerance = given->coaxial_tolerance;
  settings.notation = {given->tension_positive != 0, given->engineering_shear != 0};
  settings.projected_tangent = given->projected_tangent != 0;
  check(settings);
  return settings;
}

/// Makes a law of what `read()` gives. The settings are to blame before it, the parameter set after it.
template <class Read>
int make(const grainlaw_settings* given, grainlaw_law** law, Message message, Read read) noexcept {
  message.say("");
  if (law) *law = nullptr;
  CoaxialSettings settings;
  const int status = guarded(message, GRAINLAW_BAD_ARGUMENT, [&] {
    must_be_there(law, "law");
    settings = read_settings(given);
    return GRAINLAW_OK;
  });
  if (status != GRAINLAW_OK) return status;
  return guarded(message, GRAINLAW_BAD_INPUT, [&] {
    auto made = std::make_shared<const CoaxialLaw>(read(), settings);
    *law = new grainlaw_law{std::move(made)};
    return GRAINLAW_OK;
  });
}

/// The start of a path, by names.
grainlaw::Start read_start(std::size_t count, const char* const* names, const double* values) {
  must_be_there(names, "names");
  must_be_there(values, "values");
  grainlaw::Json start = grainlaw::Json::object();
  for (std::size_t i = 0; i < count; ++i) {
    must_be_there(names[i], ("names[" + std::to_string(i) + "]").c_str());
    if (start.contains(names[i])) throw Error("start", names[i], "is given twice");
    if (!std::isfinite(values[i]))
      throw Error("start", names[i], "must be finite, got " + grainlaw::to_text(values[i]));
    start[names[i]] = values[i];
  }
  return grainlaw::Start::read(grainlaw::Reader(start, "start"));
}

}  // namespace

extern "C" {

const char* grainlaw_status_text(int status) {
  switch (status) {
    case GRAINLAW_OK:
      return "ok";
    case GRAINLAW_UNJAMMED:
      return "ok, and unjammed: the point carries no stress";
    case GRAINLAW_FAILED:
      return "the increment could not be integrated";
    case GRAINLAW_NOT_COAXIAL:
      return "the increment is not coaxial with the law's axis";
    case GRAINLAW_BAD_ARGUMENT:
      return "bad argument";
    case GRAINLAW_BAD_INPUT:
      return "bad parameter set";
    default:
      return "unknown status";
  }
}

const char* grainlaw_version(void) {
  static const std::string text = grainlaw::version();
  return text.c_str();
}

int grainlaw_axis(const char* mode, double axis[6]) {
  const std::string_view name = mode ? mode : "";
  const bool d2 = name == "d2";
  if (!axis || (!d2 && name != "uni" && name != "d3")) return GRAINLAW_BAD_ARGUMENT;
  const Sym6 chosen = d2 ? Sym6{-1, 1, 0, 0, 0, 0} : Sym6{-0.5, -0.5, 1, 0, 0, 0};
  std::copy(chosen.begin(), chosen.end(), axis);
  return GRAINLAW_OK;
}

int grainlaw_law_from_text(const char* text, const grainlaw_settings* settings, grainlaw_law** law,
                           char* message, size_t message_size) {
  return make(settings, law, {message, message_size}, [&] {
    must_be_there(text, "text");
    return ParameterSet::read(grainlaw::Reader(grainlaw::parse_json(text, "parameters"), "parameters"));
  });
}

int grainlaw_law_from_file(const char* file, const grainlaw_settings* settings, grainlaw_law** law,
                           char* message, size_t message_size) {
  return make(settings, law, {message, message_size}, [&] {
    must_be_there(file, "file");
    return ParameterSet::load(file);
  });
}

void grainlaw_law_destroy(grainlaw_law* law) { delete law; }

double grainlaw_stress_unit(const grainlaw_law* law) {
  return law ? law->law->parameters().material.stress_unit_kPa() : std::numeric_limits<double>::quiet_NaN();
}

int grainlaw_state_version(void) { return state_version; }

size_t grainlaw_state_length(const grainlaw_law* law) { return law ? state_length : 0; }

const char* grainlaw_state_name(const grainlaw_law* law, size_t index) {
  return law && index < state_length ? state_names[index] : nullptr;
}

int grainlaw_state_index(const grainlaw_law* law, const char* name) {
  if (!law || !name) return -1;
  const auto index = state_index(name);
  return index ? static_cast<int>(*index) : -1;
}

int grainlaw_context_create(const grainlaw_law* law, grainlaw_context** context) {
  if (context) *context = nullptr;
  if (!law || !context) return GRAINLAW_BAD_ARGUMENT;
  return guarded(Message{nullptr, 0}, GRAINLAW_FAILED, [&] {
    *context = new grainlaw_context{law->law, std::vector<CoaxialLaw::Workspace>(1), {}, {}};
    return GRAINLAW_OK;
  });
}

void grainlaw_context_destroy(grainlaw_context* context) { delete context; }

const char* grainlaw_message(const grainlaw_context* context) {
  return context ? context->message : "the context is NULL";
}

int grainlaw_context_replay_file(grainlaw_context* context, const char* file) {
  return guarded(context, [&] {
    context->replay_file = file ? file : "";
    return GRAINLAW_OK;
  });
}

int grainlaw_start(grainlaw_context* context, size_t count, const char* const* names, const double* values,
                   double* state, size_t length) {
  return guarded(context, [&] {
    must_be_there(state, "state");
    check_length(length);
    const CoaxialLaw::Begin begin = context->law->start(read_start(count, names, values));
    std::string warnings;
    for (const std::string& warning : begin.warnings) warnings += (warnings.empty() ? "" : "; ") + warning;
    write_state(begin.state, state);
    Message{context->message, sizeof context->message}.say(warnings.c_str());
    return begin.state.point.jammed ? GRAINLAW_OK : GRAINLAW_UNJAMMED;
  });
}

int grainlaw_stress(grainlaw_context* context, const double* state, size_t length, double stress[6]) {
  return guarded(context, [&] {
    must_be_there(state, "state");
    must_be_there(stress, "stress");
    check_length(length);
    const CoaxialState read = read_state(state);
    const Sym6 there = context->law->stress(read.point);
    std::copy(there.begin(), there.end(), stress);
    return read.point.jammed ? GRAINLAW_OK : GRAINLAW_UNJAMMED;
  });
}

}  // extern "C"
