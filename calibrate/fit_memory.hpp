// Fits of the jamming density's memory: over-compression over amplitude and cycles (Eqs. 5.1, 5.5), and the
// strains that jam a packing by shear and again after a reversal (Eqs. 5.2, 5.13). Group memory of a
// parameter set.
#pragma once

#include <string>
#include <vector>

#include "grainlaw/calibrate/fit_packing.hpp"
#include "grainlaw/calibrate/fit_problem.hpp"
#include "grainlaw/calibrate/memory_branches.hpp"
#include "grainlaw/calibrate/memory_shear.hpp"

namespace grainlaw::calibrate {

/// How the share of its limit that phi_J has reached grows with the number M of cycles; all 0 at M = 0 and 1
/// at infinity, with a scale mu and an exponent or strength beta.
enum class Growth {
  stretched,    ///< 1 - exp[-(M/mu)^beta] (Eq. 5.1)
  inverse_log,  ///< 1 - 1/[1 + beta ln(1 + M/mu)], the law of tapping
  tanh          ///< tanh[(M/mu)^beta]
};
inline constexpr Growth growths[] = {Growth::stretched, Growth::inverse_log, Growth::tanh};
std::string name_of(Growth growth);
/// That share. M >= 0.
double grown(Growth growth, double M, double mu, double beta);

/// phi_J = phi_SJ + alpha_max (phi_max/phi_SJ - 1)^alpha_phi {1 - exp[-(M/mu)^beta]} (Eqs. 5.1, 5.5; another
/// growth in place of the braces) over phi_max, with M as the known. Parameters phi_SJ, alpha_max, alpha_phi,
/// mu, beta. One series per record, cycle after cycle; cycles without a phi_J are left out, and with
/// them all of an amplitude where they are more than a tenth: those that jam are no fair sample. phi_SJ stays
/// below every phi_max and phi_J of the data, where the slope by it is finite.
FitProblem over_compression_problem(const std::vector<CycleDensity>& cycles, Growth growth,
                                    const KnownValues& known);

/// What speaks for each growth law: each record has an amplitude of its own, so that the scatter between
/// packings and the law of amplitudes (Eq. 5.5) do not take part.
struct GrowthComparison {
  Growth growth = Growth::stretched;
  double mu = 0, beta = 0, rms = 0;
  /// Akaike's criterion for small samples, over the effective number of points, less that of the best.
  double delta_AIC = 0;
};
/// Its fit for one law: y = phi_J - phi_SJ is amplitude times share, x the number of the record. Parameters
/// mu, beta, and an amplitude per record of three cycles or more.
FitProblem growth_problem(const std::vector<CycleDensity>& cycles, Growth growth, double phi_SJ);
std::vector<GrowthComparison> compare_growths(const std::vector<CycleDensity>& cycles, double phi_SJ);

/// Correlation of the estimates of each pair of free parameters at the minimum of a pooled fit: near +-1, the
/// data know only a combination of the two.
struct Entanglement {
  std::string first, second;
  double correlation = 0;
};
std::vector<Entanglement> entanglement(const FitProblem& problem, const FitResult& at);

/// eps_SJ = eps0 {-ln[(phi - phi_SJ)/(phi_J0 - phi_SJ)]}^(1/alpha) (Eq. 5.2) over phi, with phi_J0 as the
/// known: first loadings that jam, of packings that are not jammed before. Parameters phi_SJ_sheared (of
/// these runs alone; where they do not tell, held at `phi_SJ`, at most just below the loosest run), alpha,
/// eps0.
FitProblem shear_jamming_problem(const std::vector<ShearJamming>& runs, const KnownValue& phi_SJ,
                                 const KnownValues& known);

/// The same after reversals, with phi_cr in place of phi_J0 (Eq. 5.13): one point for each packing at one
/// volume fraction, the mean over its reversals that followed a jammed leg; those that stay jammed count with
/// strain 0. Parameters phi_SJ_sheared (held), alpha (held), eps0_R, phi_cr.
FitProblem reversal_problem(const std::vector<ShearJamming>& runs, const KnownValue& phi_SJ,
                            const KnownValue& alpha, const KnownValues& known);

/// phi_SJ: one number for all laws, the weighted mean of what over-compression, the strains that jam and
/// relaxed steady states say of it, each by itself; that of the thesis where none does.
struct LimitDensity {
  double value = 0, error = 0;
  Estimate by_over_compression, by_shear, by_rest;  ///< unknown where not determined
  bool found() const { return by_over_compression.known() || by_shear.known() || by_rest.known(); }
};

/// Group memory. Where shear or rest tells phi_SJ, the fits stand at the common one, held with its error.
struct MemoryFit {
  LimitDensity phi_SJ;
  FitResult over_compression, shear, reversal;
  FitProblem over_compression_law, shear_law, reversal_law;  ///< as fitted, with their data
  std::vector<GrowthComparison> growth;
  std::vector<Entanglement> entangled;  ///< of over_compression with phi_SJ free
};

/// All of them; never throws for want of data, see FitEstimate::determined. `at_rest` is phi_SJ of relaxed
/// steady states (memory_relaxed.hpp), unknown where there are none.
MemoryFit fit_memory(const std::vector<CycleDensity>& cycles, const std::vector<ShearJamming>& runs,
                     const KnownValues& known, const Estimate& at_rest = {});

}  // namespace grainlaw::calibrate
