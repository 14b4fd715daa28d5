// The C interface: increments of one point and of many.
#include <algorithm>
#include <array>
#include <exception>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "grainlaw/element/file.hpp"
#include "grainlaw/element/version.hpp"
#include "grainlaw/model/c/c_interface-inl.hpp"
#include "grainlaw/model/c/replay.hpp"

using namespace grainlaw::model;  // NOLINT: the functions below cannot be in it
using grainlaw::Error;
using grainlaw::Sym6;

namespace {

int number_of(Status::Code code) {
  switch (code) {
    case Status::Code::ok:
      return GRAINLAW_OK;
    case Status::Code::unjammed:
      return GRAINLAW_UNJAMMED;
    case Status::Code::not_coaxial:
      return GRAINLAW_NOT_COAXIAL;
    default:
      return GRAINLAW_FAILED;
  }
}

/// The increment of one point.
Status update(const CoaxialLaw& law, CoaxialLaw::Workspace& workspace, double* state, const double* increment,
              double* stress, double* tangent) {
  CoaxialState moved = read_state(state);
  Sym6 stress_there;
  Matrix6 tangent_there;
  Status status =
      law.update(moved, six(increment), workspace, stress_there, tangent ? &tangent_there : nullptr);
  if (status.failed()) return status;
  write_state(moved, state);
  std::copy(stress_there.begin(), stress_there.end(), stress);
  if (tangent) std::copy(tangent_there.begin(), tangent_there.end(), tangent);
  return status;
}

/// Writes the increment to the replay file. What keeps it from that is added to the message.
void keep(grainlaw_context& context, const double* state, const double* increment, bool tangent,
          Status& status) {
  if (context.replay_file.empty()) return;
  try {
    const Replay replay{
        context.law->parameters(), context.law->settings(), read_state(state),   six(increment),    tangent,
        name_of(status.code),      status.message,          grainlaw::version(), grainlaw::commit()};
    grainlaw::write_file(context.replay_file, replay.to_json().dump(2) + "\n");
  } catch (const std::exception& error) {
    status.message += "; " + std::string(error.what());
  }
}

/// One point, with its message, which begins with `who`, and its replay file.
int update_aloud(grainlaw_context& context, double* state, const double* increment, double* stress,
                 double* tangent, const std::string& who) {
  Status status;
  try {
    status = update(*context.law, context.workspaces.front(), state, increment, stress, tangent);
  } catch (const Error& error) {
    throw Error(who + error.what());
  }
  if (status.failed()) {
    keep(context, state, increment, tangent != nullptr, status);
    Message{context.message, sizeof context.message}.say((who + status.message).c_str());
  }
  return number_of(status.code);
}

/// Many points: what the call gave.
struct Points {
  double* states;
  std::size_t stride;
  const double* increments;
  double *stresses, *tangents;
  int* statuses;

  double* state(std::size_t i) const { return states + i * stride; }
  const double* increment(std::size_t i) const { return increments + 6 * i; }
  double* stress(std::size_t i) const { return stresses + 6 * i; }
  double* tangent(std::size_t i) const { return tangents ? tangents + 36 * i : nullptr; }
};

/// Says what is wrong with a point that failed, by doing the same to a copy of it.
int explain(grainlaw_context& context, const Points& points, std::size_t i) {
  std::array<double, state_length> state;
  std::copy_n(points.state(i), state_length, state.begin());
  Sym6 stress;
  Matrix6 tangent;
  const std::string who = "point " + std::to_string(i) + ": ";
  const int status = update_aloud(context, state.data(), points.increment(i), stress.data(),
                                  points.tangents ? tangent.data() : nullptr, who);
  if (status < 0) return status;
  Message{context.message, sizeof context.message}.say((who + "failed, but not when tried again").c_str());
  return GRAINLAW_FAILED;
}

/// Points `first` to `last` together, where they are an ordinary block. False where they are none, or where
/// anything is wrong with one of them: nothing has changed then.
bool update_together(const CoaxialLaw& law, CoaxialLaw::Workspace& workspace, const Points& points,
                     std::size_t first, std::size_t last, grainlaw_outcome& outcome) noexcept {
  if (points.tangents || 2 * (last - first) < CoaxialLaw::block) return false;
  const int status = guarded(Message{nullptr, 0}, GRAINLAW_BAD_ARGUMENT, [&] {
    std::array<CoaxialState, CoaxialLaw::block> states;
    for (std::size_t i = first; i < last; ++i) states[i - first] = read_state(points.state(i));
    const std::span<CoaxialState> all(states.data(), last - first);
    if (!law.update_block(all, points.increment(first), workspace, points.stress(first)))
      return GRAINLAW_FAILED;
    for (std::size_t i = first; i < last; ++i) {
      const CoaxialState& moved = states[i - first];
      write_state(moved, points.state(i));
      if (!moved.point.jammed) ++outcome.unjammed;
      if (points.statuses) points.statuses[i] = moved.point.jammed ? GRAINLAW_OK : GRAINLAW_UNJAMMED;
    }
    return GRAINLAW_OK;
  });
  return status == GRAINLAW_OK;
}

/// Point `i` alone.
void update_alone(const CoaxialLaw& law, CoaxialLaw::Workspace& workspace, const Points& points,
                  std::size_t i, grainlaw_outcome& outcome) noexcept {
  const int status = guarded(Message{nullptr, 0}, GRAINLAW_BAD_ARGUMENT, [&] {
    return number_of(
        update(law, workspace, points.state(i), points.increment(i), points.stress(i), points.tangent(i))
            .code);
  });
  if (points.statuses) points.statuses[i] = status;
  if (status == GRAINLAW_UNJAMMED) ++outcome.unjammed;
  if (status < 0 && outcome.failed++ == 0) outcome.first = i;
}

/// Points `first` to `last` in silence.
grainlaw_outcome update_range(const CoaxialLaw& law, CoaxialLaw::Workspace& workspace, const Points& points,
                              std::size_t first, std::size_t last) noexcept {
  grainlaw_outcome outcome{0, 0, 0};
  for (std::size_t begin = first; begin < last; begin += CoaxialLaw::block) {
    const std::size_t end = std::min(begin + CoaxialLaw::block, last);
    if (update_together(law, workspace, points, begin, end, outcome)) continue;
    for (std::size_t i = begin; i < end; ++i) update_alone(law, workspace, points, i, outcome);
  }
  return outcome;
}

/// All points, in shares of whole blocks, so that a point has the same answer on any number of threads.
grainlaw_outcome update_all(grainlaw_context& context, const Points& points, std::size_t count, int threads) {
  const auto shares = static_cast<std::size_t>(threads);
  const std::size_t blocks = (count + CoaxialLaw::block - 1) / CoaxialLaw::block;
  if (context.workspaces.size() < shares) context.workspaces.resize(shares);
  std::vector<grainlaw_outcome> outcomes(shares);
  auto work = [&](int thread) noexcept {
    const auto share = static_cast<std::size_t>(thread);
    const auto edge = [&](std::size_t s) { return std::min(count, blocks * s / shares * CoaxialLaw::block); };
    outcomes[share] =
        update_range(*context.law, context.workspaces[share], points, edge(share), edge(share + 1));
  };
  if (threads == 1) {
    work(0);
  } else {
    if (!context.team || context.team->threads() != threads) {
      context.team.reset();
      context.team = std::make_unique<grainlaw::ThreadPool>(threads);
    }
    context.team->run(work);
  }
  grainlaw_outcome all{0, 0, 0};
  for (const grainlaw_outcome& outcome : outcomes) {
    if (all.failed == 0) all.first = outcome.first;
    all.failed += outcome.failed;
    all.unjammed += outcome.unjammed;
  }
  return all;
}

void check_points(const Points& points, int threads) {
  must_be_there(points.states, "states");
  must_be_there(points.increments, "strain_increments");
  must_be_there(points.stresses, "stresses");
  if (points.stride < state_length)
    throw Error("", "stride",
                "must be >= grainlaw_state_length() = " + std::to_string(state_length) + ", got " +
                    std::to_string(points.stride));
  if (threads < 1) throw Error("", "threads", "must be >= 1, got " + std::to_string(threads));
}

}  // namespace

extern "C" {

int grainlaw_update(grainlaw_context* context, double* state, size_t length, const double strain_increment[6],
                    double stress[6], double* tangent) {
  return guarded(context, [&] {
    must_be_there(state, "state");
    must_be_there(strain_increment, "strain_increment");
    must_be_there(stress, "stress");
    check_length(length);
    return update_aloud(*context, state, strain_increment, stress, tangent, "");
  });
}

int grainlaw_update_many(grainlaw_context* context, size_t count, double* states, size_t stride,
                         const double* strain_increments, double* stresses, double* tangents, int threads,
                         int* statuses, grainlaw_outcome* outcome) {
  return guarded(context, [&]() -> int {
    const Points points{states, stride, strain_increments, stresses, tangents, statuses};
    check_points(points, threads);
    const std::size_t blocks = count / CoaxialLaw::block + 1;
    const auto team = static_cast<int>(std::min(blocks, static_cast<std::size_t>(threads)));
    const grainlaw_outcome all = update_all(*context, points, count, team);
    if (outcome) *outcome = all;
    if (all.failed == 0) return all.unjammed > 0 ? GRAINLAW_UNJAMMED : GRAINLAW_OK;
    return explain(*context, points, all.first);
  });
}

}  // extern "C"
