// What two quantities the law follows in a segment of a path. In the axes of the path stress and strain are
//   sigma = P I + sigma_dev m,   eps = (eps_vol/3) I + eps_dev m,   m = n/sqrt(3 J2(n)), m:m = 2/3,
// n the axis of shear: m = (-1, 1, 0)/sqrt(3) for D2, (-1, -1, 2)/3 for UNI and D3. A strain that is not
// along n counts with its volume and with its projection (3/2) m:eps.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "grainlaw/element/path.hpp"
#include "grainlaw/model/walk/prescribed.hpp"

namespace grainlaw::model {

class PathControl {
 public:
  /// Segment i of `path`, with the axis of shear in force there. Throws Error (file, key) where no two
  /// quantities of the law say what the segment asks for.
  PathControl(const Path& path, std::size_t i, const StrainTensor& axis);

  using Controls = std::array<Prescribed, 2>;
  /// From the state at the segment's start: the way to its stresses, while what it strains rests; nothing
  /// where they are there already. Stresses that a segment keeps "as at the start" are those of `state`.
  std::optional<Controls> approach(const State& state) const;
  /// The segment itself: from `state`, where the approach has ended, `begin` being the state before it.
  Controls controls(const State& state, const State& begin) const;
  /// Whether the approach has used up the strain that the segment was to make.
  bool passed_by_approach(const State& state, const State& begin) const;

  /// What the law leaves out of this segment, in words; empty if nothing.
  const std::string& remark() const { return remark_; }

 private:
  /// A quantity and how far it goes: to a target, by an amount, or neither, when it rests.
  struct Aim {
    Prescribed quantity;
    std::optional<double> target, amount;
    Prescribed from(const State& state, const State& begin) const;
  };

  double m(std::size_t c) const { return m_[c]; }
  /// (3/2) m_c: what a strain of axis c alone adds to eps_dev.
  double a(std::size_t c) const { return 1.5 * m_[c]; }
  Aim stress_on(std::size_t c, const std::string& name) const;
  Aim shear_aim() const;
  void find_aims();
  void two_quantities();
  void constant_p();
  void sides();
  void isotropic_stress();
  void refuse_shear() const;
  void axes();
  void mean_and_strains();
  void three_stresses();
  void two_stresses(std::size_t strained);
  void one_stress(std::size_t loaded);
  /// `field` of the segment, if one alone is why.
  [[noreturn]] void cannot(const std::string& why, const std::string& field = "") const;

  const Path& path_;
  const Segment& segment_;
  StrainTensor m_{};
  std::array<Aim, 2> aims_;
  bool approaches_ = false;                ///< goes to its stresses first
  std::optional<StrainTensor> start_mix_;  ///< which of three stresses are targets
  std::string remark_;
};

}  // namespace grainlaw::model
