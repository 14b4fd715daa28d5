#include "grainlaw/model/forms/law.hpp"

#include <limits>

#include "grainlaw/model/status.hpp"

namespace grainlaw::model {

namespace {

std::optional<std::string> out_of_range(const char* name, const Saturation& law, double nu,
                                        bool zero_allowed) {
  const double value = saturation(law, nu);
  if (value > 0 || (zero_allowed && value == 0)) return std::nullopt;
  return std::string(name) + " is " + shown(value) + " at nu = " + shown(nu) + " and must be " +
         (zero_allowed ? ">= 0" : "> 0");
}

std::optional<std::string> beyond_table(const Tabulated& form, const Stretch& stretch) {
  for (const double nu : {stretch.nu(0), stretch.nu(1)}) {
    if (form.covers(nu)) continue;
    const double moved = form.laws.moduli.nu_c / form.nu_c;  // with another history
    return "the table of moduli goes from nu = " + shown(moved * form.table.nu().front()) + " to " +
           shown(moved * form.table.nu().back()) + ", the path to " + shown(nu);
  }
  return std::nullopt;
}

}  // namespace

template <class P>
BasicLaw<P> make_law(const ParameterSet& parameters, const Choice& choice, const Reading<P>& read) {
  BasicLaws<P> laws = laws_of(parameters, choice, read);
  switch (choice.form) {
    case Form::reduced_closed:
      return BasicReducedClosed<P>{{std::move(laws)}};
    case Form::reduced:
      return BasicReduced<P>{{std::move(laws)}};
    case Form::memory:
      return BasicMemory<P>{std::move(laws)};
    case Form::coupled_3_14:
      return BasicCoupled314<P>{{std::move(laws)}};
    default:
      if (!choice.terms.moduli_table) return BasicCoupled<P>{std::move(laws)};
      const P nu_c = laws.moduli.nu_c;
      return BasicTabulated<P>{
          {std::move(laws)}, parameters.need_moduli_table("the " + name_of(choice) + " form"), nu_c};
  }
}

template BasicLaw<double> make_law(const ParameterSet&, const Choice&, const Reading<double>&);
template BasicLaw<Slopes> make_law(const ParameterSet&, const Choice&, const Reading<Slopes>&);
template BasicLaw<FewSlopes> make_law(const ParameterSet&, const Choice&, const Reading<FewSlopes>&);

Law make_law(const ParameterSet& parameters, const Choice& choice) {
  return make_law<double>(parameters, choice, [](const Parameter& parameter) { return parameter.value; });
}

std::optional<std::string> objection(const Law& law, const Stretch& stretch) {
  constexpr double most = 1e6;
  if (std::abs(stretch.eps_dev) > most || std::abs(stretch.eps_vol) > 100)
    return "the strain must be at most 1e6 in eps_dev and 100 in eps_vol, got " + shown(stretch.eps_dev) +
           " and " + shown(stretch.eps_vol);
  if (const auto* tabulated = std::get_if<Tabulated>(&law))
    if (auto reason = beyond_table(*tabulated, stretch)) return reason;
  if (stretch.eps_dev == 0) return std::nullopt;
  const Laws& laws = laws_of(law);
  const Form form = form_of(law);
  for (const double nu : {stretch.nu(0), stretch.nu(1)}) {  // Eq. 2.20 is monotonic between
    if (auto reason = out_of_range("s_max", laws.s_max, nu, false)) return reason;
    if (auto reason = out_of_range("F_max", laws.F_max, nu, false)) return reason;
    if (auto reason = out_of_range("beta_F", laws.beta_F, nu, true)) return reason;
    if (form != Form::reduced && form != Form::reduced_closed) continue;
    if (auto reason = out_of_range("beta_s", laws.beta_s, nu, true)) return reason;
  }
  return std::nullopt;
}

namespace {

Contacts contacts_along(const ContactCurve& curve, double g3, const State& state) {
  if (!state.jammed) return {0, 0, std::numeric_limits<double>::quiet_NaN(), 0};
  const double nu = at_least_isostatic(curve, state.nu), C = coordination(curve, nu);
  return {g3 * state.nu * C, C, corrected_coordination(curve, nu), 1 - rattlers(curve, nu)};
}

}  // namespace

Contacts contacts_of(const Law& law, const State& state) {
  const Laws& laws = laws_of(law);
  if (const auto* memory = std::get_if<Memory>(&law))  // contacts go with phi_J
    return contacts_along(memory->contacts_of(state), laws.g3, state);
  return contacts_along(laws.contacts, laws.g3, state);
}

}  // namespace grainlaw::model
