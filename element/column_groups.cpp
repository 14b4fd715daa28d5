#include "grainlaw/element/column_groups.hpp"

#include <algorithm>

#include "grainlaw/element/components.hpp"
#include "grainlaw/element/record.hpp"

namespace grainlaw {

namespace {

struct ColumnGroup {
  std::string name;
  std::vector<std::string> columns;
};

const std::vector<ColumnGroup>& table() {
  static const std::vector<ColumnGroup> groups = [] {
    std::vector<ColumnGroup> list{{"stress", {"P", "sigma_dev", "s_dev"}},
                                  {"fabric", {"F_v", "F_dev"}},
                                  {"coordination", {"C", "C_star", "f_NR"}},
                                  {"energy_ratio", {"Ek_over_Ep"}}};
    list[0].columns.insert(list[0].columns.end(), stress_columns.begin(), stress_columns.end());
    list[1].columns.insert(list[1].columns.end(), fabric_columns.begin(), fabric_columns.end());
    return list;
  }();
  return groups;
}

}  // namespace

const std::vector<std::string>& column_groups() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const ColumnGroup& group : table()) list.push_back(group.name);
    return list;
  }();
  return names;
}

std::vector<std::string> record_columns_with(const std::vector<std::string>& groups) {
  std::vector<std::string> columns;
  for (const std::string& column : record_columns()) {
    const std::string group = group_of_column(column);
    if (group.empty() || std::find(groups.begin(), groups.end(), group) != groups.end())
      columns.push_back(column);
  }
  return columns;
}

std::string group_of_column(std::string_view column) {
  for (const ColumnGroup& group : table())
    if (std::find(group.columns.begin(), group.columns.end(), column) != group.columns.end())
      return group.name;
  return "";
}

}  // namespace grainlaw
