// The law in its forms behind one interface, as a material point with numbers of type double takes it.
#pragma once

#include <optional>
#include <string>
#include <variant>

#include "grainlaw/model/closure.hpp"
#include "grainlaw/model/forms/coupled.hpp"
#include "grainlaw/model/forms/coupled_3_14.hpp"
#include "grainlaw/model/forms/memory.hpp"
#include "grainlaw/model/forms/reduced.hpp"
#include "grainlaw/model/forms/tabulated.hpp"
#include "grainlaw/model/state.hpp"
#include "grainlaw/model/status.hpp"

namespace grainlaw::model {

template <class P>
using BasicLaw = std::variant<BasicReducedClosed<P>, BasicReduced<P>, BasicCoupled<P>, BasicTabulated<P>,
                              BasicMemory<P>, BasicCoupled314<P>>;
using Law = BasicLaw<double>;

/// Throws Error where the set lacks what the form needs.
template <class P>
BasicLaw<P> make_law(const ParameterSet& parameters, const Choice& choice, const Reading<P>& read);
Law make_law(const ParameterSet& parameters, const Choice& choice);
inline Law make_law(const ParameterSet& parameters, Form form) { return make_law(parameters, {form, {}}); }

template <class P>
Form form_of(const BasicLaw<P>& law) {
  return std::visit([](const auto& form) { return form.form; }, law);
}
template <class P>
const BasicLaws<P>& laws_of(const BasicLaw<P>& law) {
  return std::visit([](const auto& form) -> const BasicLaws<P>& { return form.laws; }, law);
}
template <class P>
BasicLaws<P>& laws_of(BasicLaw<P>& law) {
  return std::visit([](auto& form) -> BasicLaws<P>& { return form.laws; }, law);
}

/// The volume fraction at and below which a point has no contacts whatever it carries.
template <class P>
P unjamming_density(const BasicLaw<P>& law) {
  return std::visit([](const auto& form) { return form.unjamming_density(); }, law);
}

/// Takes stress, fabric and direction away. In the coupled form phi_J becomes the current nu.
template <class P, class T>
void unjam(const BasicLaw<P>& law, BasicState<T>& state) {
  std::visit([&](const auto& form) { form.unjam(state); }, law);
}

/// What is no finite number of a state and a stretch from it, in words, if anything.
template <class T>
std::optional<std::string> not_finite(const BasicState<T>& state, double eps_vol, double eps_dev) {
  if (!is_finite(state)) return "the state holds what is not a number: nu, P, sigma_dev or F_dev";
  if (std::isfinite(eps_vol) && std::isfinite(eps_dev)) return std::nullopt;
  return "the strain is not a number: eps_vol = " + shown(eps_vol) + ", eps_dev = " + shown(eps_dev);
}

/// What keeps the law from this stretch, in words ("s_max is -0.01 at nu = 0.9 and must be > 0"), if
/// anything.
std::optional<std::string> objection(const Law& law, const Stretch& stretch);

/// Isotropic contact quantities of a state. Unjammed: no contacts, C_star is NaN (undefined). Where the point
/// is jammed below the density at which the contact law begins, C, C_star and f_NR are those of that density.
struct Contacts {
  double F_v, C, C_star, f_NR;
};
Contacts contacts_of(const Law& law, const State& state);

}  // namespace grainlaw::model
