// What the functions of the C interface share: handles, messages, and the wall at which every exception ends.
// Part of their sources only.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <exception>
#include <memory>
#include <new>
#include <string>
#include <vector>

#include "grainlaw.h"
#include "grainlaw/element/error.hpp"
#include "grainlaw/element/thread_pool.hpp"
#include "grainlaw/model/c/coaxial.hpp"
#include "grainlaw/model/c/state_table.hpp"

struct grainlaw_law {
  std::shared_ptr<const grainlaw::model::CoaxialLaw> law;
};

struct grainlaw_context {
  std::shared_ptr<const grainlaw::model::CoaxialLaw> law;
  std::vector<grainlaw::model::CoaxialLaw::Workspace> workspaces;  // one per thread, at least one
  std::unique_ptr<grainlaw::ThreadPool> team;                      // of the last call with several threads
  std::string replay_file;
  char message[1024] = "";
};

namespace grainlaw::model {

/// Where a message goes: a buffer of the caller or of a context, or nowhere.
struct Message {
  char* text;
  std::size_t size;
  void say(const char* what) const noexcept {
    if (text && size > 0) std::snprintf(text, size, "%s", what);
  }
};

/// Runs `action`, which returns a status; an Error becomes `blame`.
template <class Action>
int guarded(Message message, int blame, Action action) noexcept {
  try {
    return action();
  } catch (const Error& error) {
    message.say(error.what());
    return blame;
  } catch (const std::bad_alloc&) {
    message.say("out of memory");
  } catch (const std::exception& error) {
    message.say(error.what());
  } catch (...) {
    message.say("a fault of the library, please report it");
  }
  return GRAINLAW_FAILED;
}

/// The same for a call with a context, which may be NULL.
template <class Action>
int guarded(grainlaw_context* context, Action action) noexcept {
  if (!context) return GRAINLAW_BAD_ARGUMENT;
  const Message message{context->message, sizeof context->message};
  message.say("");
  return guarded(message, GRAINLAW_BAD_ARGUMENT, action);
}

inline void must_be_there(const void* pointer, const char* name) {
  if (!pointer) throw Error("", name, "must not be NULL");
}

inline Sym6 six(const double* values) {
  Sym6 result;
  std::copy_n(values, 6, result.begin());
  return result;
}

inline void check_length(std::size_t length) {
  if (length != state_length)
    throw Error("", "length",
                "must be grainlaw_state_length() = " + std::to_string(state_length) + ", got " +
                    std::to_string(length));
}

inline CoaxialState read_state(const double* state) { return state_of(StateRow(state, state_length)); }
inline void write_state(const CoaxialState& state, double* to) {
  const auto row = row_of(state);
  std::copy(row.begin(), row.end(), to);
}

}  // namespace grainlaw::model
