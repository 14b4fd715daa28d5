// How several threads share one step, so that its result does not depend on how many they are.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <span>
#include <vector>

#include "grainlaw/dem/packing/grains.hpp"
#include "grainlaw/dem/step/advance.hpp"
#include "grainlaw/dem/step/contact_law.hpp"
#include "grainlaw/dem/step/pairs.hpp"
#include "grainlaw/element/thread_pool.hpp"

namespace grainlaw::dem {

/// What one thread does: a run of grains, and all the forces on them. Pairs with a grain of another share are
/// computed on both sides, each for its own; so no two threads add to the same grain, and each grain's forces
/// are added in the order in which one thread alone would add them.
struct Share {
  std::uint32_t first = 0, last = 0;            ///< its grains
  std::size_t first_group = 0, last_group = 0;  ///< their groups in the list
  HaloPairs halo;                               ///< pairs of earlier groups with partners in here
  CrossingPairs crossing;                       ///< those pairs that have a grain in here
  std::vector<std::uint32_t> foreign;           ///< grains of other shares in all of its pairs, rising
  Grains grains;  ///< right for its own, without id; of the foreign ones, place and motion are when forces
                  ///< are added
  using Letter = std::array<double, 6>;  ///< place and motion of a grain, mm and mm/us
  /// Where each foreign grain is, and its motion, as the share that it belongs to left them; of this step and
  /// of the one before, which others may still read.
  std::array<std::vector<Letter>, 2> inbox;
  /// Its own among the foreign grains of another share: numbers first ... last - 1 of that one's `foreign`.
  struct Listed {
    std::size_t share, first, last;
  };
  std::vector<Listed> listed;
  std::vector<std::span<std::byte>> outbox;  ///< scratch: where it leaves these next

  bool owns(std::uint32_t grain) const { return grain - first < last - first; }
};

/// Share `index` of `shares`, of `grains` grains, for loops that compute so many pairs at a time as `lanes`
/// (4 or 8): in what order they add forces depends on it. Leaves the share's grains, its inbox and what
/// others list of it as they were.
void deal(const Pairs& pairs, std::size_t grains, std::size_t index, std::size_t shares, std::size_t lanes,
          Share& share);

/// The shares of one packing and the threads that work on them. Each thread keeps its grains in arrays that
/// no other reads: what others need of them it leaves in their inboxes, line by line, so that a step fetches
/// from another core no more than that, and in one go. Forces are added when the grains move on, or when
/// somebody looks, so that the threads meet once in a step. Copies of a team take turns with its threads.
class Team {
 public:
  /// Throws std::system_error where the system has no more threads.
  explicit Team(int threads);

  int threads() const { return pool_->threads(); }
  ThreadPool& pool() { return *pool_; }

  /// The list of pairs is new, and where `moved` is set, `grains` are in another order or state than the
  /// shares.
  void deal(const Pairs& pairs, const Grains& grains, bool moved);
  /// As dem::advance of all grains, after the forces of the place where they are, in `cell`, where they are
  /// due: they are from now on.
  double advance(const ContactLaw& law, const Pairs& pairs, const Cell& cell, const Stride& stride,
                 const ListReach& list);
  /// As dem::add_contact_forces to all grains, to the last bit, where they are due.
  void add_contact_forces(const ContactLaw& law, const Pairs& pairs, const Cell& cell);
  /// All grains as the shares have them.
  void gather(Grains& grains) const;
  /// Their place and motion alone.
  void gather_motion(Grains& grains) const;

 private:
  template <class F>
  void each(F&& f) const {
    pool_->run([f](int t) { f(static_cast<std::size_t>(t)); });
  }
  void gather(std::initializer_list<Quads Grains::*> fields, Grains& grains) const;
  void find_listed(std::size_t from);
  std::span<const std::span<std::byte>> outbox(std::size_t from, std::size_t box);
  void send(std::size_t from, std::size_t box);
  void take(Share& share) const;

  std::shared_ptr<ThreadPool> pool_;
  std::vector<Share> shares_;
  std::size_t box_ = 0;  ///< which inbox is to be read next
  bool due_ = false;     ///< forces have not been added
};

}  // namespace grainlaw::dem
