// Walking a state along a stretch of strain, through loss of contact and back: the stretch is cut where the
// point unjams or jams, and each jammed piece is handed to a solver. Templates over the form of the law and
// the scalar.
#pragma once

#include <cstddef>
#include <span>

#include "grainlaw/model/state.hpp"
#include "grainlaw/model/status.hpp"

namespace grainlaw::model {

/// Where a point lost its contacts (jammed = false) or found them again.
struct Event {
  bool jammed;
  double nu, eps_vol, eps_dev;
};

/// How a solver came along a stretch.
template <class T>
struct Reached {
  Status status;
  T t = 1;                     ///< where the state belongs: the end, or where the pressure vanished
  bool lost_pressure = false;  ///< the latter
};

/// A stretch that is walked in pieces, and the samples on it (fractions of the whole, ascending) still to be
/// visited.
template <class T>
class Course {
 public:
  Course(const BasicStretch<T>& whole, std::span<const double> samples) : whole_(whole), samples_(samples) {}

  bool done() const { return t_ >= 1 && next_ == samples_.size(); }
  const T& t() const { return t_; }
  const BasicStretch<T>& whole() const { return whole_; }
  /// From where the course stands to the fraction `to` of the whole.
  BasicStretch<T> piece(const T& to) const {
    return {whole_.nu(t_), whole_.eps_vol * (to - t_), whole_.eps_dev * (to - t_)};
  }
  /// Fraction of the whole at which its volume fraction is nu, not before where the course stands; its
  /// eps_vol is not 0.
  T at(const T& nu) const {
    using std::log;
    const T t = log(nu / whole_.nu_0) / whole_.eps_vol;
    if (t < t_) return t_;
    return t;
  }
  /// The next sample as a fraction of piece(to); beyond 1 if none is left on it.
  T next_sample(const T& to) const {
    if (next_ == samples_.size() || samples_[next_] > to) return 2.0;
    if (!(samples_[next_] > t_)) return 0.0;
    return (samples_[next_] - t_) / (to - t_);
  }
  std::size_t pass_sample() { return next_++; }
  /// Goes on by the fraction `f` of piece(to).
  void advance(const T& f, const T& to) {
    if (f < 1)
      t_ = t_ + f * (to - t_);
    else
      t_ = to;
  }

 private:
  BasicStretch<T> whole_;
  std::span<const double> samples_;
  std::size_t next_ = 0;
  T t_ = 0;
};

/// One walk: the course, who is told of samples (`visit(index, state)`) and of events (`note(jammed,
/// state)`), and who integrates: `solve(form, state, stretch, next_sample, visit)` carries the state over a
/// stretch of strain, visiting the fractions that next_sample() gives until that is beyond 1, and returns a
/// Reached<T>.
template <class F, class T, class Solve, class Visit, class Note>
class Walk {
 public:
  Walk(const F& form, BasicState<T>& state, Course<T> course, Solve solve, Visit visit, Note note)
      : form_(form), state_(state), course_(course), solve_(solve), visit_(visit), note_(note) {}

  /// On failure the state is somewhere on the way.
  Status run() {
    const auto q = course_.whole().q();
    if (q == 0) state_.direction = {};  // shear after an isotropic stretch begins a new direction
    if ((state_.jammed || goes_on_unjammed) && q != 0 && q != state_.direction.q)
      form_.begin_direction(state_, q);
    for (int phase = 0; !course_.done(); ++phase) {
      if (phase == most_phases) return {Status::Code::failed, "contact is lost and found again without end"};
      if (!state_.jammed && !goes_on_unjammed) {
        walk_unjammed();
      } else if (Status status = walk_jammed(); status.failed()) {
        return status;
      }
    }
    return {};
  }

 private:
  /// Whether the form integrates without contacts as well, and finds both events itself.
  static constexpr bool goes_on_unjammed = requires { F::goes_on_unjammed; };

  static constexpr const char* not_a_number = "the law gives a stress or fabric that is no number";

  /// A stretch along which contact is lost and found again more often than this is given up.
  static constexpr int most_phases = 1000;

  void visit(const BasicState<T>& state) { visit_(course_.pass_sample(), state); }

  void walk_unjammed() {
    if constexpr (!goes_on_unjammed) walk_to_contacts();
  }
  void walk_to_contacts() requires(!goes_on_unjammed) {
    T end = 1.0;
    bool jams = false;
    if (course_.whole().eps_vol > 0) {
      const T t = course_.at(form_.jamming_density(state_));
      jams = t < 1;
      if (jams) end = t;
    }
    const auto stretch = course_.piece(end);
    for (T t = course_.next_sample(end); jams ? t < 1 : t <= 1; t = course_.next_sample(end))
      visit(state_.moved(stretch, t));
    state_ = state_.moved(stretch, 1.0);
    course_.advance(1.0, end);
    if (!jams) return;
    form_.jam(state_, course_.whole());
    note_(true, state_);
  }

  /// A form that goes on unjammed: its event is the loss of contact or its return.
  Status walk_either() {
    form_.prepare(state_);
    const Reached<T> reached = solve_(
        form_, state_, course_.piece(1.0), [&] { return course_.next_sample(1.0); },
        [&](const BasicState<T>& state) { visit(state); });
    course_.advance(reached.t, 1.0);
    if (reached.status.failed()) return reached.status;
    if (!is_finite(state_)) return {Status::Code::failed, not_a_number};
    if (!reached.lost_pressure) return {};
    if (state_.jammed)
      form_.unjam(state_);
    else
      form_.jam(state_, course_.piece(1.0));
    note_(state_.jammed, state_);
    return {};
  }

  Status walk_jammed() {
    if constexpr (goes_on_unjammed) {
      return walk_either();
    } else {
      return walk_jammed_to_its_end();
    }
  }

  Status walk_jammed_to_its_end() requires(!goes_on_unjammed) {
    T end = 1.0;
    bool leaves = false;
    if (course_.whole().eps_vol < 0) {
      const auto density = form_.unjamming_density();
      const T t = course_.at(density);
      leaves = t <= 1 || course_.whole().nu(T(1.0)) <= density;  // of a breath of volume t is badly rounded
      if (t <= 1) end = t;
    }
    // Where the contacts are lost at `end`, the state there belongs to the unjammed phase that follows.
    const auto next_sample = [&]() -> T {
      const T t = course_.next_sample(end);
      if (leaves && t >= 1) return 2.0;
      return t;
    };
    const Reached<T> reached = solve_(form_, state_, course_.piece(end), next_sample,
                                      [&](const BasicState<T>& state) { visit(state); });
    course_.advance(reached.t, end);
    if (reached.status.failed()) return reached.status;
    if (!is_finite(state_)) return {Status::Code::failed, not_a_number};
    if (!leaves && !reached.lost_pressure && state_.P > 0) return {};
    form_.unjam(state_);
    note_(false, state_);
    return {};
  }

  const F& form_;
  BasicState<T>& state_;
  Course<T> course_;
  Solve solve_;
  Visit visit_;
  Note note_;
};

}  // namespace grainlaw::model
