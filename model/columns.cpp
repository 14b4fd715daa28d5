#include "grainlaw/model/columns.hpp"

#include <string>
#include <vector>

#include "grainlaw/element/error.hpp"
#include "grainlaw/element/record.hpp"

namespace grainlaw::model {

namespace {

double value_of(std::string_view column, const State& state, const Contacts& contacts) {
  if (column == "eps_vol") return state.eps_vol;
  if (column == "eps_dev") return state.eps_dev;
  if (column == "nu") return state.nu;
  if (column == "P") return state.P;
  if (column == "sigma_dev") return state.sigma_dev;
  if (column == "s_dev") return state.s_dev();
  if (column == "F_v") return contacts.F_v;
  if (column == "F_dev") return state.jammed ? state.F_dev : 0;  // without contacts there is no fabric
  if (column == "C") return contacts.C;
  if (column == "C_star") return contacts.C_star;
  if (column == "f_NR") return contacts.f_NR;
  if (column == "phi_J") return state.phi_J;
  throw Error("the law has no column " + std::string(column));
}

}  // namespace

double column_value(std::string_view column, const Law& law, const State& state) {
  return value_of(column, state, contacts_of(law, state));
}

std::vector<double> row_of(const Contacts& contacts, const State& state, std::size_t segment) {
  std::vector<double> row;
  for (const auto& column : prediction_columns())
    row.push_back(column == "segment" ? static_cast<double>(segment) : value_of(column, state, contacts));
  return row;
}

std::vector<double> row_of(const Law& law, const State& state, std::size_t segment) {
  return row_of(contacts_of(law, state), state, segment);
}

}  // namespace grainlaw::model
