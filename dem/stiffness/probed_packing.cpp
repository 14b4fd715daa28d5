#include "grainlaw/dem/stiffness/probed_packing.hpp"

#include <limits>

#include "grainlaw/element/moduli_table.hpp"
#include "grainlaw/element/tensor.hpp"

namespace grainlaw::dem {

namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

MinimiseOptions down_to(double residual) {
  MinimiseOptions options;
  options.residual = residual;
  return options;
}

}  // namespace

ProbedPacking::ProbedPacking(const Material& material, const State& state, const StrainTensor& axis,
                             double residual)
    : axis_(axis), residual_(residual), k_star_(material.stress_unit()), packing_(material, state) {
  result_ = minimise(packing_, down_to(residual));
  const Measurement m = packing_.measure();
  const Backbone& backbone = packing_.backbone();
  state_ = {m.nu,
            trace(m.stress) / 3 / k_star_,
            deviator_along(m.stress, axis) / k_star_,
            trace(m.fabric),
            deviator_along(m.fabric, axis),
            m.C_star,
            m.f_NR,
            static_cast<double>(backbone.grains()),
            static_cast<double>(backbone.contacts())};
}

std::string ProbedPacking::refusal() const {
  const Backbone& backbone = packing_.backbone();
  if (in_balance() && backbone.grains() > 0 && backbone.contacts() >= backbone.isostatic()) return "";
  return why_no_moduli(static_cast<double>(backbone.grains()), static_cast<double>(backbone.contacts()),
                       result_.balance.residual);
}

std::vector<double> ProbedPacking::row_without_moduli() const {
  return row_of(result_.balance.residual, 0, {nothing, nothing, nothing, nothing}, 0, nothing, nullptr);
}

std::vector<double> ProbedPacking::row() {
  if (!refusal().empty()) return row_without_moduli();
  return row(response());
}

std::vector<double> ProbedPacking::row(const LinearResponse& response) const {
  return row_of(result_.balance.residual, 0, moduli_of(response.stress, axis_), 0, response.unstable,
                &response.energy);
}

Probe ProbedPacking::probe(double amplitude, bool undo) const {
  return dem::probe(packing_, axis_, amplitude, {.residual = residual_, .undo = undo});
}

std::vector<double> ProbedPacking::row(const Probe& probe) const {
  return row_of(probe.residual, probe.amplitude, probe.moduli, static_cast<double>(probe.changed.both()),
                nothing, nullptr);
}

std::vector<double> ProbedPacking::row_of(double residual, double amplitude, const Moduli& moduli,
                                          double changed, double unstable, const Stiffness* energy) const {
  std::vector<double> row = state_;
  row.insert(row.end(), {residual, amplitude, moduli.B / k_star_, moduli.A1 / k_star_, moduli.A2 / k_star_,
                         moduli.G_oct / k_star_, changed, unstable});
  for (std::size_t a = 0; a < 6; ++a)
    for (std::size_t b = a; b < 6; ++b)
      row.push_back(energy != nullptr ? (*energy)[a][b] / k_star_ : nothing);
  return row;
}

}  // namespace grainlaw::dem
