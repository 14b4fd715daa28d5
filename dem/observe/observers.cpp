#include "grainlaw/dem/observe/observers.hpp"

namespace grainlaw::dem::observe {

namespace {

std::vector<std::string> table_columns(const auto& columns) {
  std::vector<std::string> list{"row"};
  list.insert(list.end(), columns.begin(), columns.end());
  return list;
}

}  // namespace

const std::vector<std::string>& names() {
  static const std::vector<std::string> all = [] {
    std::vector<std::string> list;
    for_each_kind([&]<class O>(std::type_identity<O>) { list.emplace_back(O::name); });
    return list;
  }();
  return all;
}

std::vector<std::string> columns(const std::vector<std::string>& asked) {
  std::vector<std::string> list;
  for_each_asked(asked, [&]<class O>(std::type_identity<O>) {
    list.insert(list.end(), O::columns.begin(), O::columns.end());
  });
  return list;
}

std::vector<std::string> lasting_columns(const std::vector<std::string>& asked) {
  std::vector<std::string> list;
  for_each_asked(asked, [&]<class O>(std::type_identity<O>) {
    std::size_t later = 0;
    if constexpr (requires { O::later_columns; }) later = O::later_columns;
    list.insert(list.end(), O::columns.begin(), O::columns.end() - later);
  });
  return list;
}

std::vector<std::string> tables(const std::vector<std::string>& asked) {
  std::vector<std::string> list;
  for_each_asked(asked, [&]<class O>(std::type_identity<O>) {
    if constexpr (Tabulates<O>) list.emplace_back(O::file);
  });
  return list;
}

std::vector<std::vector<double>> columns_of(const Record& record) {
  std::vector<std::vector<double>> columns;
  for (const auto& name : record.columns()) columns.push_back(record[name]);
  return columns;
}

Record record_of(const std::vector<std::string>& names, const std::vector<std::vector<double>>& columns) {
  Record record(names);
  for (std::size_t row = 0; row < columns.at(0).size(); ++row) {
    std::vector<double> values;
    for (const auto& column : columns) values.push_back(column.at(row));
    record.append(values);
  }
  return record;
}

Observers::Observers(const std::vector<std::string>& asked) : columns_(observe::columns(asked)) {
  for_each_asked(asked, [&]<class O>(std::type_identity<O>) {
    list_.emplace_back(O{});
    walks_contacts_ = walks_contacts_ || O::walks_contacts;
    reads_ = reads_ | O::reads;
    if constexpr (Tabulates<O>)
      tables_.push_back({std::string(O::file), Record(table_columns(O::table_columns))});
  });
}

std::vector<double> Observers::observe(const Dynamics& dynamics, const Quads& velocity,
                                       const Measurement& measured, const Material& material,
                                       const SignConvention& sign, std::size_t segment, std::size_t row) {
  std::vector<double> values;
  if (list_.empty()) return values;
  if (walks_contacts_) network_.gather(dynamics, velocity);
  const View view{material, dynamics, velocity, measured, sign, segment, network_};
  auto table = tables_.begin();
  for (Observer& any : list_)
    std::visit(
        [&]<class O>(O& observer) {
          const auto found = observer.values(view);
          values.insert(values.end(), found.begin(), found.end());
          if constexpr (Tabulates<O>) {
            observer.tabulate(view, [&](const std::array<double, O::table_columns.size()>& cells) {
              std::vector<double> line{static_cast<double>(row)};
              line.insert(line.end(), cells.begin(), cells.end());
              table->rows.append(line);
            });
            ++table;
          }
        },
        any);
  return values;
}

}  // namespace grainlaw::dem::observe
