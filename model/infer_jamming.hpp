// The jamming density that measured states imply: Eqs. 5.7, 5.8 and 5.9 inverted, along a record (section 5.I
// of the thesis).
#pragma once

#include <optional>
#include <string>

#include "grainlaw/element/record.hpp"
#include "grainlaw/model/parameters.hpp"

namespace grainlaw::model {

/// Eq. 5.7 inverted: the phi_J at which `c` gives C* at nu. Nothing where C* < C0: not jammed.
std::optional<double> jamming_density_from_contacts(const ContactCurve& c, double nu, double C_star);

/// Eq. 5.8 inverted, for the share f_NR of grains that bear load. Nothing where more than phi_c rattle, or
/// none.
std::optional<double> jamming_density_from_nonrattlers(const ContactCurve& c, double nu, double f_NR);

/// Eq. 5.9 inverted with the measured C (M4/N). Nothing where P* <= 0, or is more than the law gives up to
/// ln(nu/phi_J) = 1.
std::optional<double> jamming_density_from_pressure_and_contacts(const PressureCurve& law, double nu,
                                                                 double P, double C);

/// What a record tells: columns segment, eps_vol, eps_dev, nu (those that it has), then phi_J and its error
/// from P with the measured C (`phi_J`), from P with the C of the law (`phi_J_pressure_alone`), from C*
/// (`phi_J_contacts`) and from f_NR (`phi_J_nonrattlers`); an empty field where a column lacks or the state
/// is not jammed. Errors are those of the law's numbers, each by itself, and `scatter`, how far phi_J of one
/// packing is from that of another (standard deviation, >= 0), in quadrature; empty where none is stated.
/// Needs columns nu and P.
Record infer_jamming_density(const Record& record, const PackingLaw& law, double scatter = 0);

}  // namespace grainlaw::model
