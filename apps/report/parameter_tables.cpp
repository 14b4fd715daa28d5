#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "grainlaw/apps/report/numbers.hpp"
#include "grainlaw/apps/report/prose.hpp"
#include "grainlaw/apps/report/sections.hpp"
#include "grainlaw/apps/report/symbols.hpp"

namespace grainlaw::report {
namespace {

/// A number of the law, where it comes from, and the thesis's.
struct Entry {
  std::optional<double> value, error, thesis;
  std::string source, note;
  bool at_bound = false, determined = true;
  bool in_set = false;  ///< of parameters.json: what predictions read
};

/// By group, row (mode or quantity; "" for groups without rows) and name.
using Key = std::array<std::string, 3>;
using Entries = std::map<Key, Entry>;

Entry read_entry(const Json& json) {
  Entry entry;
  entry.value = number_in(json, "value");
  entry.error = number_in(json, "stderr");
  entry.thesis = number_in(json, "thesis");
  entry.source = text_in(json, "source");
  entry.note = text_in(json, "note");
  entry.in_set = true;
  return entry;
}

void read_row(Entries& entries, const std::string& group, const std::string& row, const Json& json) {
  if (!json.is_object()) return;
  for (const auto& [name, value] : json.items()) {
    if (value.is_object()) entries[{group, row, name}] = read_entry(value);
  }
}

/// Adds what only fits.json knows: rows that no prediction reads, bounds, what could not be determined.
void read_fit(Entries& entries, const FitView& fit) {
  for (const FitParameter& parameter : fit.parameters) {
    const Key key{fit.group, fit.row, parameter.name};
    const bool known = entries.contains(key);
    Entry& entry = entries[key];
    if (!known) {
      entry.value = parameter.value;
      entry.error = parameter.error;
      entry.thesis = parameter.thesis;
      entry.source = parameter.held && parameter.determined ? "assumed" : "fit";
    }
    entry.at_bound = entry.at_bound || parameter.at_bound;
    entry.determined = entry.determined && parameter.determined;
  }
}

/// The second fit of C*(nu) gives C0 a line of its own.
void read_free_C0(Entries& entries, const FitView& fit) {
  const Key key{fit.group, fit.row, "C0_free"};
  for (const FitParameter& parameter : fit.parameters) {
    if (parameter.name != "C0" || entries.contains(key)) continue;
    entries[key] = {parameter.value,    parameter.error,     parameter.thesis, "fit", "",
                    parameter.at_bound, parameter.determined};
  }
}

Entries collect(const Inputs& inputs, const std::vector<FitView>& fits) {
  Entries entries;
  for (const char* group : {"isotropic", "shear", "shear_axial", "near_jamming"}) {
    const Json& rows = value_in(inputs.parameters, group);
    if (!rows.is_object()) continue;
    for (const auto& [row, json] : rows.items()) read_row(entries, group, row, json);
  }
  for (const char* group : {"moduli", "memory", "volumetric"})
    read_row(entries, group, "", value_in(inputs.parameters, group));
  // The first fit of a law and mode counts; one of tests kept back for prediction comes later and only stands
  // in for none.
  std::set<std::array<std::string, 3>> seen;
  for (const FitView& fit : fits) {
    if (fit.group.empty()) continue;
    if (fit.family == "C_star_free_C0") {
      read_free_C0(entries, fit);
    } else if (seen.insert({fit.group, fit.row, fit.family}).second) {
      read_fit(entries, fit);
    }
  }
  return entries;
}

/// Difference from the thesis in standard errors: plain up to 2, bold beyond, underlined too beyond 3.
Markup difference(const Entry& entry) {
  if (!entry.value || !entry.thesis || !entry.error || *entry.error <= 0) return {};
  const double sigmas = (*entry.value - *entry.thesis) / *entry.error;
  const char* css = std::abs(sigmas) <= 2 ? "near" : std::abs(sigmas) <= 3 ? "off" : "far";
  return " "_html + element("span", text(signed_number(sigmas) + " σ"), {{"class", css}});
}

/// What stands under a value: the thesis's, the difference, or where the value is from.
Markup below(const Entry& entry) {
  const bool fitted = entry.source == "fit";
  if (fitted) {
    Markup line;
    if (entry.thesis) line += "thesis "_html + text(number(*entry.thesis, 6));
    if (entry.determined) line += difference(entry);
    if (!entry.note.empty()) line += element("div", prose(entry.note));
    return line;
  }
  Markup line = text(entry.source == "thesis" ? "from the thesis" : entry.source);
  if (entry.thesis && entry.source != "thesis") line += ", thesis "_html + text(number(*entry.thesis, 6));
  if (!entry.determined) line += "; not determined here"_html;
  return line;
}

Markup cell(const Entries& entries, const Key& key) {
  const auto found = entries.find(key);
  if (found == entries.end()) return text(nothing);
  const Entry& entry = found->second;
  const bool fitted = entry.source == "fit";
  Markup value =
      fitted && !entry.determined ? "not determined"_html : text(with_error(entry.value, entry.error));
  if (!fitted) value = element("i", value);
  value = element("span", value, {{"class", "whole"}});
  if (entry.at_bound) value += element("span", " at its bound"_html, {{"class", "off"}});
  const Markup under = below(entry);
  return value + (under.empty() ? Markup() : element("div", under, {{"class", "under"}}));
}

bool row_exists(const Entries& entries, const std::string& group, const std::string& row) {
  for (const auto& [key, entry] : entries) {
    if (key[0] == group && key[1] == row) return true;
  }
  return false;
}

/// Rows of a group in the thesis's order, then any other.
std::vector<std::string> rows_of(const Entries& entries, const std::string& group,
                                 const std::vector<std::string>& first) {
  std::vector<std::string> rows;
  for (const std::string& row : first) {
    if (row_exists(entries, group, row)) rows.push_back(row);
  }
  for (const auto& [key, entry] : entries) {
    if (key[0] == group && std::find(rows.begin(), rows.end(), key[1]) == rows.end()) rows.push_back(key[1]);
  }
  return rows;
}

/// A table with a column per row of the group (mode or quantity) and a line per parameter.
Markup matrix(const Entries& entries, const std::string& group, const std::vector<std::string>& rows,
              const std::vector<Markup>& heads, const std::vector<std::string>& names,
              const std::string& letters = "") {
  const std::string& alphabet = letters.empty() ? group : letters;
  Table table;
  table.column("Parameter"_html);
  for (const Markup& head : heads) table.column(head);
  for (const std::string& name : names) {
    const bool known =
        std::any_of(rows.begin(), rows.end(), [&, &g = group, &n = name](const std::string& row) {
          return entries.contains({g, row, n});
        });
    if (!known) continue;
    std::vector<Markup> cells{name == "C0_free" ? symbol("C0", alphabet) + ", left free"_html
                                                : symbol(name, alphabet)};
    for (const std::string& row : rows) cells.push_back(cell(entries, {group, row, name}));
    table.row(cells);
  }
  return table.html("matrix");
}

bool in_parameter_set(const Inputs& inputs, const std::string& mode) {
  return value_in(value_in(inputs.parameters, "isotropic"), mode).is_object();
}

Markup isotropic_table(const Inputs& inputs, const Entries& entries) {
  const auto rows = rows_of(entries, "isotropic", {"iso", "uni", "d2", "d3"});
  if (rows.empty()) return {};
  std::vector<Markup> heads;
  for (const std::string& row : rows) {
    Markup head = text(mode_name(row));
    if (!inputs.parameters.is_null() && !in_parameter_set(inputs, row)) {
      head += element("div", "for comparison only"_html, {{"class", "under"}});
    }
    heads.push_back(head);
  }
  return "<h3>Isotropic laws (Eqs. 2.11, 2.12, 2.14), beside Table 2.1</h3>\n"_html +
         matrix(entries, "isotropic", rows, heads,
                {"nu_c", "p0", "gamma_p", "nu_c_contacts", "C0", "C0_free", "C1", "alpha", "phi_c", "phi_v"});
}

Markup shear_table(const Entries& entries, const std::string& group, const Markup& title) {
  const auto rows = rows_of(entries, group, {"s_max", "beta_s", "F_max", "beta_F"});
  if (rows.empty()) return {};
  std::vector<Markup> heads;
  for (const std::string& row : rows) heads.push_back(symbol(row));
  return "<h3>"_html + title + "</h3>\n"_html +
         matrix(entries, group, rows, heads, {"Q_max", "Q_v", "alpha", "nu_c"});
}

Markup shear_tables(const Entries& entries) {
  return shear_table(entries, "shear", "Shear laws (Eq. 2.20), beside Table 2.2"_html) +
         shear_table(entries, "shear_axial", "The same of axisymmetric strain (D3), past the thesis"_html);
}

/// Nothing where no test changed the volume of a sheared packing alone.
Markup volumetric_table(const Entries& entries) {
  const bool any = std::any_of(entries.begin(), entries.end(), [](const auto& one) {
    return one.first[0] == "volumetric" && one.second.in_set;
  });
  if (!any) return {};
  return "<h3>Fabric under change of volume alone, past the thesis</h3>\n"_html +
         matrix(entries, "volumetric", {""}, {"Value"_html}, {"compression", "decompression"});
}

/// Nothing where none of the moduli is fitted: they stand among the numbers that are not.
Markup moduli_table(const Entries& entries) {
  const bool fitted = std::any_of(entries.begin(), entries.end(), [](const auto& one) {
    return one.first[0] == "moduli" && one.second.source == "fit";
  });
  if (!fitted) return {};
  return "<h3>Small-strain moduli (Eqs. 4.11 – 4.15), beside Table 4.1</h3>\n"_html +
         matrix(entries, "moduli", {""}, {"Value"_html},
                {"p0", "gamma_p", "nu_c", "a_I", "a_II", "a_F", "a_s", "GB_max", "Fv_min", "Fv_alpha", "g_I",
                 "g3"});
}

/// The same of the memory.
Markup memory_table(const Entries& entries) {
  const bool fitted = std::any_of(entries.begin(), entries.end(), [](const auto& one) {
    return one.first[0] == "memory" && one.second.in_set && one.second.source == "fit";
  });
  if (!fitted) return {};
  return "<h3>Memory of the jamming density (Eqs. 5.1 – 5.13), beside chapter 5</h3>\n"_html +
         matrix(entries, "memory", {""}, {"Value"_html},
                {"phi_SJ", "alpha_max", "alpha_phi", "mu", "beta", "alpha", "eps0", "eps0_R", "phi_cr",
                 "alpha_P", "eps0_P", "eps0_R_P", "eps_r", "hold", "pack_rate", "phi_pack"});
}

/// Tables 5.1 and 5.2; nothing where the fits have no memory.
Markup near_jamming_tables(const Entries& entries) {
  std::vector<std::string> columns, quantities;
  for (const char* row : {"iso", "d2", "d2_at_rest"})
    if (row_exists(entries, "near_jamming", row)) columns.emplace_back(row);
  for (const char* row : {"s_max", "beta_s", "F_max", "beta_F"})
    if (row_exists(entries, "near_jamming", row)) quantities.emplace_back(row);
  if (columns.empty() || quantities.empty()) return {};
  std::vector<Markup> heads, shear_heads;
  for (const std::string& column : columns)
    heads.push_back(column == "iso"  ? "isotropic"_html
                    : column == "d2" ? "shear"_html
                                     : "shear, at rest"_html);
  for (const std::string& quantity : quantities) shear_heads.push_back(symbol(quantity));
  return "<h3>Near jamming (Eqs. 5.7 – 5.12), beside Tables 5.1 and 5.2</h3>\n"_html +
         matrix(entries, "near_jamming", columns, heads,
                {"nu_c", "p0", "gamma_p", "nu_c_contacts", "C0", "C1", "alpha", "phi_c", "phi_v"}) +
         matrix(entries, "near_jamming", quantities, shear_heads, {"Q_max", "Q_v", "alpha", "nu_c"}, "shear");
}

/// A number that was not fitted here, with every row that shares it.
struct Taken {
  std::string group, name;
  Entry entry;
  std::vector<std::string> rows;
};

bool same(const Entry& a, const Entry& b) {
  return a.value == b.value && a.error == b.error && a.source == b.source && a.note == b.note;
}

std::vector<Taken> not_fitted(const Entries& entries) {
  std::vector<Taken> list;
  for (const auto& [key, entry] : entries) {
    const auto& [group, row, name] = key;
    if (entry.source == "fit" || !entry.in_set) continue;
    const auto shared =
        std::find_if(list.begin(), list.end(), [&, &g = group, &n = name, &e = entry](const Taken& t) {
          return t.group == g && t.name == n && same(t.entry, e);
        });
    if (shared == list.end()) {
      list.push_back({group, name, entry, {row}});
    } else {
      shared->rows.push_back(row);
    }
  }
  return list;
}

Markup owner(const Taken& taken) {
  if (taken.group != "isotropic" && taken.group != "shear") return text(" (" + taken.group + ")");
  std::vector<Markup> rows;
  for (const std::string& row : taken.rows) {
    rows.push_back(taken.group == "shear" ? symbol(row) : text(mode_name(row)));
  }
  return " of "_html + join(rows, ", "_html);
}

/// Which rows the law takes where the set holds several.
Markup closure_sentence(const Inputs& inputs) {
  const Json& closure = value_in(inputs.parameters, "closure");
  const std::string P = text_in(closure, "P"), contacts = text_in(closure, "contacts");
  if (P.empty() || contacts.empty()) return {};
  const bool own = text_in(closure, "contacts_nu_c") == "row";
  return "<p>A prediction takes its pressure from the row "_html + text(mode_name(P)) +
         " and its contacts and rattlers from the row "_html + text(mode_name(contacts)) +
         (own ? ", at that row's own <var>ν</var><sub>c</sub>.</p>\n"_html
              : ", at the <var>ν</var><sub>c</sub> of the moduli.</p>\n"_html);
}

Markup sources_table(const Entries& entries) {
  const Markup title = "<h3>Numbers that were not fitted here</h3>\n"_html;
  const auto list = not_fitted(entries);
  if (list.empty())
    return title + "<p>None: every number of the parameter set comes from these fits.</p>\n"_html;
  Table table;
  table.column("Number"_html)
      .column("Value"_html, Table::Kind::figures)
      .column("From"_html)
      .column("Meaning"_html);
  for (const Taken& taken : list) {
    const Symbol* known = find_symbol(taken.name, taken.group);
    Markup meaning = known ? prose(known->meaning, taken.group) : Markup();
    if (!taken.entry.note.empty()) meaning += " "_html + element("i", prose(taken.entry.note, taken.group));
    table.row({symbol(taken.name, taken.group) + owner(taken),
               text(with_error(taken.entry.value, taken.entry.error)),
               text(taken.entry.source.empty() ? "not stated" : taken.entry.source), meaning});
  }
  return title +
         "<p>The law needs these too. They are taken from the thesis or assumed, not measured in this campaign.</p>\n"_html +
         table.html("small");
}

}  // namespace

Markup parameter_tables(const Inputs& inputs, const std::vector<FitView>& fits) {
  const Entries entries = collect(inputs, fits);
  if (entries.empty()) return absent("No parameters: neither parameters.json nor fits.json holds any.");
  Markup tables = isotropic_table(inputs, entries) + shear_tables(entries) + moduli_table(entries) +
                  volumetric_table(entries) + memory_table(entries) + near_jamming_tables(entries);
  tables += element(
      "p",
      "Each cell: our value ± one standard error; under it the thesis's value and our difference from it in "
      "units of σ, our own standard error (the thesis prints none for these numbers): bold beyond 2\u00a0σ, "
      "underlined as well beyond 3\u00a0σ. <i>Italic</i>: not fitted here. Rows for comparison only are "
      "fitted to tests that the law has to predict; no prediction reads them."_html,
      {{"class", "note"}});
  return tables +
         (inputs.parameters.is_null() ? Markup() : closure_sentence(inputs) + sources_table(entries));
}

}  // namespace grainlaw::report
