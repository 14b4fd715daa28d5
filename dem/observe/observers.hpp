// The observers that a scene asked for: what they add to each row, and the tables they fill.
#pragma once

#include <algorithm>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "grainlaw/dem/observe/contact_fabric.hpp"
#include "grainlaw/dem/observe/contact_numbers.hpp"
#include "grainlaw/dem/observe/energy.hpp"
#include "grainlaw/dem/observe/force_distribution.hpp"
#include "grainlaw/dem/observe/kinetic_stress.hpp"
#include "grainlaw/dem/observe/names.hpp"
#include "grainlaw/dem/observe/nonaffine.hpp"
#include "grainlaw/dem/observe/overlap.hpp"
#include "grainlaw/dem/observe/percolation.hpp"
#include "grainlaw/dem/observe/radius.hpp"
#include "grainlaw/dem/observe/unbalanced.hpp"
#include "grainlaw/element/record.hpp"

namespace grainlaw::dem::observe {

/// An observer has a name, the bytes per grain that it needs (kept and while it looks), whether it walks the
/// contacts of the View, what it reads of the Measurement there beside nu, the columns it adds to record.csv
/// and their values for a View; one that fills a table has its file, the columns of it, the rows it adds each
/// time, and a function that appends rows. Its place here is that of its columns. A new one
/// is a file of its own and a word in this list.
using Observer = std::variant<ContactNumbers, Energy, KineticStress, ContactFabric, Overlap, Unbalanced,
                              Percolation, Nonaffine, ForceDistribution, OverlapDistribution, Radius>;

template <class O>
concept Tabulates = requires {
  O::file;
};

/// Calls f(std::type_identity<O>{}) for every kind of observer, in order.
template <class F>
void for_each_kind(F&& f) {
  [&]<class... Os>(std::type_identity<std::variant<Os...>>) {
    (f(std::type_identity<Os>{}), ...);
  }(std::type_identity<Observer>{});
}
template <class F>
void for_each_asked(const std::vector<std::string>& asked, F&& f) {
  for_each_kind([&]<class O>(std::type_identity<O> kind) {
    if (std::find(asked.begin(), asked.end(), O::name) != asked.end()) f(kind);
  });
}

struct Table {
  std::string file;
  Record rows;  ///< column `row`, the index of the row in record.csv, and the observer's
};

/// A table's numbers column by column, and back.
std::vector<std::vector<double>> columns_of(const Record& record);
Record record_of(const std::vector<std::string>& names, const std::vector<std::vector<double>>& columns);

class Observers {
 public:
  /// `asked` are of names(); any order.
  explicit Observers(const std::vector<std::string>& asked);

  const std::vector<std::string>& columns() const { return columns_; }
  /// What observe() must be told of beside nu.
  const Wanted& reads() const { return reads_; }
  /// Whether any looks at velocities: contact forces depend on them.
  bool sees_velocity() const { return walks_contacts_; }
  /// Values of columns() for row `row` of the record; tables are filled too.
  std::vector<double> observe(const Dynamics& dynamics, const Quads& velocity, const Measurement& measured,
                              const Material& material, const SignConvention& sign, std::size_t segment,
                              std::size_t row);
  const std::vector<Table>& tables() const { return tables_; }

  /// What the rows to come depend on, and the tables so far, for a run that is interrupted between two rows.
  template <class Self, class Archive>
  static void keep(Self& self, Archive& archive) {
    for (auto& any : self.list_)
      std::visit(
          [&](auto& observer) {
            if constexpr (requires { std::decay_t<decltype(observer)>::keep(observer, archive); })
              archive(observer);
          },
          any);
    for (auto& table : self.tables_) {
      std::vector<std::vector<double>> columns = columns_of(table.rows);
      archive(columns);
      if constexpr (!std::is_const_v<Self>) table.rows = record_of(table.rows.columns(), columns);
    }
  }

 private:
  std::vector<Observer> list_;
  std::vector<std::string> columns_;
  std::vector<Table> tables_;  ///< of those that tabulate, in order
  bool walks_contacts_ = false;
  Wanted reads_;
  Network network_;  ///< of the last row
};

}  // namespace grainlaw::dem::observe
