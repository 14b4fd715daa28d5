// Which pairs of grains may touch, kept right while grains move and the box deforms.
// Cells give an outer list, seldom; the outer list is filtered to the short inner list that the force loop
// walks.
#pragma once

#include <vector>

#include "grainlaw/dem/packing/cell.hpp"
#include "grainlaw/dem/packing/grains.hpp"
#include "grainlaw/dem/packing/linked_cells.hpp"
#include "grainlaw/dem/step/advance.hpp"
#include "grainlaw/dem/step/pairs.hpp"
#include "grainlaw/element/thread_pool.hpp"

namespace grainlaw::dem {

/// How a list stays right. Let X be the position of a grain when a list was made, E the deformation of the
/// box since then, and w = x - E X what the grain moved on its own. An image lies a fixed number of edges
/// away, so E carries it along: two grains whose images were D apart then are E D + w_i - w_j apart now. That
/// is at least e|D| - |w_i| - |w_j|, where e is the smallest singular value of E (in an orthorhombic box its
/// smallest component), or less, and at most 1. Each grain has a
/// budget s_i for |w_i|, more if it flies; the box has one for e. Every pair with |D| < (r_i + s_i + r_j +
/// s_j)/e_min is listed, so the list is complete as long as |w_i| <= s_i for all i and e >= e_min; `outdated`
/// tests exactly that. The outer list has the same skin for all grains, and is renewed when a filtered list
/// could miss a pair. A few grains that fly too far or too fast for it do not renew it: they are left out of
/// it, and their pairs are looked for among all grains.
class Neighbours {
 public:
  /// `unit` is the length that skins are measured in (the mean radius), mm.
  Neighbours(double unit, double largest_radius) : unit_(unit), largest_radius_(largest_radius) {}

  /// True when a pair missing in the list might touch.
  bool outdated(const Grains& grains, const Cell& cell) const;
  /// The same, where `excess` is what advance() returned for reach(cell).
  bool outdated(const Cell& cell, double excess) const;
  ListReach reach(const Cell& cell) const {
    return {inner_reference_.data(), cell.deformation_from(inner_cell_.edges())};
  }

  /// Renews the list; wraps and sorts the grains and reduces the box where the outer list must be renewed
  /// too. A grain may go `lookahead` us at its speed before the next call. The threads of a team, if any,
  /// share what is done for each inner list, which comes out the same. Throws Error if the box is too narrow
  /// for a grain not to touch its own image, or if two grains lie at the same point.
  void update(Grains& grains, Cell& cell, double lookahead, ThreadPool* team = nullptr);
  /// The same where the outer list need not be renewed, from place and motion of the grains alone; else it
  /// returns false, and renew() must follow.
  bool update_inner(const Grains& grains, const Cell& cell, double lookahead, ThreadPool* team = nullptr);
  /// As update(), where it is known that the outer list must be renewed.
  void renew(Grains& grains, Cell& cell, double lookahead, ThreadPool* team = nullptr);

  const Pairs& pairs() const { return inner_; }
  std::size_t outer_pairs() const { return outer_.count(); }
  std::uint64_t updates() const { return updates_; }  ///< how often the inner list was made
  std::uint64_t sorts() const { return sorts_; }      ///< how often the outer list was made

  /// Keeps what the lists were made from; a reader must rebuild() them.
  template <class Self, class Archive>
  static void keep(Self& self, Archive& archive) {
    archive(self.largest_radius_, self.outer_skin_, self.outer_reference_, self.outer_cell_, self.budget_,
            self.flyers_, self.inner_reference_, self.inner_cell_, self.updates_, self.sorts_);
  }
  /// Makes the same lists again, in the same order.
  void rebuild(const Grains& grains);

 private:
  /// What one thread finds among a run of the grains, and a share of the pairs through faces.
  struct Part {
    std::uint32_t first = 0, last = 0;
    std::vector<std::uint32_t> flyers;
    bool covered = true;                        ///< by the outer list
    std::vector<std::uint32_t> begin, near;     ///< the filtered pairs, grain by grain
    GroupedPairs within;                        ///< the same interleaved, where there is more than one part
    std::vector<CrossingPairs::Pair> crossing;  ///< likewise
    std::size_t groups_before = 0, partners_before = 0, crossing_before = 0;  ///< of the parts before it
  };
  /// The box around the centres of some spheres, and the largest radius of them.
  struct Enclosure {
    double reach = 0;
    Vec3 low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};

    void enclose(const Quad& b);
    void enclose(const Enclosure& other);
    bool may_be_near(const Quad& a) const;
  };
  void cut(std::size_t grains, ThreadPool* team);
  /// Calls f(part) for each, on a thread of its own.
  template <class F>
  void each(ThreadPool* team, F&& f);

  void make_budgets(const Grains& grains, double lookahead, ThreadPool* team);
  bool outer_covers(const Grains& grains, const Cell& cell, ThreadPool* team);
  void enclose_runs(const Part& part);
  std::vector<CrossingPairs::Pair> pairs_of_flyers(const Quads& flying, const std::array<Quad, 27>& shifts);
  void sort_and_list(Grains& grains, Cell& cell);
  double outer_range() const { return 2 * largest_radius_ + outer_skin_; }
  void filter(const Grains& grains, const Cell& cell, ThreadPool* team);
  void filter_within(Part& part) const;
  void filter_crossing(Part& part, const std::array<Quad, 27>& shifts);
  void make_room(std::size_t of_flyers);
  void join(const Part& part);

  double unit_, largest_radius_;
  double outer_skin_ = 0;
  NearPairs outer_;
  Pairs inner_;
  std::vector<Part> parts_;            ///< scratch, one for each thread
  std::vector<Enclosure> runs_;        ///< scratch, of runs of grains
  std::vector<std::uint32_t> flyers_;  ///< whose pairs are looked for among all grains; rising
  std::vector<double> budget_;         ///< s_i, mm
  Quads inner_reference_;              ///< X | s_i^2, of the inner list
  Quads outer_reference_;              ///< X, of the outer list
  Cell inner_cell_, outer_cell_;       ///< when they were made
  std::uint64_t updates_ = 0, sorts_ = 0;
};

}  // namespace grainlaw::dem
