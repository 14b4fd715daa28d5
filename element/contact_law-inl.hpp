// The contact law: force, energy, stiffness and duration of one contact from scalars. Another law of overlap
// and closing velocity is another struct with the same members; nothing else knows the formula. (One that
// depends on the sizes of the two grains would need them handed to it by the loops.) Its force is a template,
// of what numbers and vectors have alike: sums, differences, products, quotients and root(). Where the
// overlap is negative it may be anything, and is not taken. Included by material.cpp and into grainlaw::dem
// for numbers, and by the force loop once per instruction set for vectors of them, one contact to a lane;
// hence no include guard.

/// Linear visco-elastic contact, Eq. 2.1: f = k delta + gamma d(delta)/dt along the normal while delta >= 0.
/// The force is repulsive where positive and is not clipped: it may pull shortly before the grains part.
struct LinearContact {
  double k = 0;      ///< ug/us^2
  double gamma = 0;  ///< ug/us, the same for every pair

  /// Force, ug mm/us^2; `overlap` delta >= 0 in mm, `closing` d(delta)/dt in mm/us.
  template <class T, class U>
  auto force(T overlap, U closing) const {
    return k * overlap + gamma * closing;
  }
  /// Elastic energy, ug mm^2/us^2.
  double energy(double overlap) const { return 0.5 * k * overlap * overlap; }
  /// Whether the force depends on `closing`; where it does not, the loops leave velocities alone.
  bool damped() const { return gamma != 0; }
  /// d(force)/d(overlap), ug/us^2.
  double stiffness(double /*overlap*/) const { return k; }
  /// About how stiff contacts are, ug/us^2, > 0: the unit of tolerances and of preconditioners.
  double typical_stiffness() const { return k; }
  /// How long two grains touch whose reduced mass is m = m_1 m_2/(m_1 + m_2), ug, after Eq. 2.1: pi/omega
  /// with omega^2 = k/m - (gamma/2m)^2, us. Infinite where the contact is overdamped.
  double duration(double reduced_mass) const {
    const double damping = gamma / (2 * reduced_mass);
    const double omega_squared = k / reduced_mass - damping * damping;
    return omega_squared > 0 ? std::numbers::pi / std::sqrt(omega_squared)
                             : std::numeric_limits<double>::infinity();
  }
  /// The damping, ug/us, from which on a contact of this reduced mass has no finite duration.
  double critical_damping(double reduced_mass) const { return std::sqrt(4 * k * reduced_mass); }
  /// What is left of it where nothing moves.
  LinearContact elastic() const { return {k, 0}; }

  static LinearContact of(const Material& material) { return {material.k, material.gamma}; }
};

/// The law that the engine is built with; all its loops are compiled for this one.
using ContactLaw = LinearContact;
