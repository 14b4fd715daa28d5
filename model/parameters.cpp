#include "grainlaw/model/parameters.hpp"

#include <array>
#include <limits>
#include <string_view>
#include <utility>

#include "grainlaw/element/error.hpp"

namespace grainlaw::model {

namespace {

constexpr const char* format_name = "grainlaw-parameters-1";
const std::vector<std::string> modes{"iso", "uni", "d2", "d3"};

/// One key of a group: its name, where it is kept, what values it may have. Read and written from the same
/// table.
template <class Group>
struct Key {
  const char* name;
  Parameter Group::*member;
  Range range;
};

Range share() { return {0, 1, false, true}; }  // of rattlers, of the rate of fabric

const std::vector<Key<PackingLaw>>& keys(const PackingLaw&) {
  static const std::vector<Key<PackingLaw>> list{
      {"C0", &PackingLaw::C0, above(0)},        {"C1", &PackingLaw::C1, at_least(0)},
      {"alpha", &PackingLaw::alpha, above(0)},  {"nu_c_contacts", &PackingLaw::nu_c_contacts, inside(0, 1)},
      {"phi_c", &PackingLaw::phi_c, share()},   {"phi_v", &PackingLaw::phi_v, at_least(0)},
      {"p0", &PackingLaw::p0, above(0)},        {"gamma_p", &PackingLaw::gamma_p, any_number()},
      {"nu_c", &PackingLaw::nu_c, inside(0, 1)}};
  return list;
}

const std::vector<Key<SaturationLaw>>& keys(const SaturationLaw&) {
  static const std::vector<Key<SaturationLaw>> list{{"Q_max", &SaturationLaw::Q_max, any_number()},
                                                    {"Q_v", &SaturationLaw::Q_v, any_number()},
                                                    {"alpha", &SaturationLaw::alpha, any_number()},
                                                    {"nu_c", &SaturationLaw::nu_c, inside(0, 1)}};
  return list;
}

const std::vector<Key<ModuliLaws>>& keys(const ModuliLaws&) {
  static const std::vector<Key<ModuliLaws>> list{{"p0", &ModuliLaws::p0, above(0)},
                                                 {"gamma_p", &ModuliLaws::gamma_p, any_number()},
                                                 {"nu_c", &ModuliLaws::nu_c, inside(0, 1)},
                                                 {"g3", &ModuliLaws::g3, above(0)},
                                                 {"a_I", &ModuliLaws::a_I, any_number()},
                                                 {"a_II", &ModuliLaws::a_II, any_number()},
                                                 {"g_I", &ModuliLaws::g_I, any_number()},
                                                 {"GB_max", &ModuliLaws::GB_max, above(0)},
                                                 {"Fv_min", &ModuliLaws::Fv_min, at_least(0)},
                                                 {"Fv_alpha", &ModuliLaws::Fv_alpha, above(0)}};
  return list;
}

const std::vector<Key<VolumetricLaws>>& keys(const VolumetricLaws&) {
  static const std::vector<Key<VolumetricLaws>> list{
      {"compression", &VolumetricLaws::compression, any_number()},
      {"decompression", &VolumetricLaws::decompression, any_number()}};
  return list;
}

const std::vector<Key<MemoryLaws>>& keys(const MemoryLaws&) {
  static const std::vector<Key<MemoryLaws>> list{
      {"phi_SJ", &MemoryLaws::phi_SJ, inside(0, 1)},   {"mu", &MemoryLaws::mu, above(0)},
      {"beta", &MemoryLaws::beta, above(0)},           {"alpha_max", &MemoryLaws::alpha_max, at_least(0)},
      {"alpha_phi", &MemoryLaws::alpha_phi, above(0)}, {"alpha", &MemoryLaws::alpha, above(0)},
      {"eps0", &MemoryLaws::eps0, above(0)},           {"eps0_R", &MemoryLaws::eps0_R, above(0)}};
  return list;
}

/// shear.QUANTITY: name and where it is kept.
constexpr std::array<std::pair<const char*, std::optional<SaturationLaw> ShearLaws::*>, 4> quantities{
    {{"s_max", &ShearLaws::s_max},
     {"beta_s", &ShearLaws::beta_s},
     {"F_max", &ShearLaws::F_max},
     {"beta_F", &ShearLaws::beta_F}}};

Parameter read_parameter(Reader reader, const Range& range) {
  Parameter parameter;
  parameter.value = reader.number("value", range);
  if (!reader.raw("stderr").is_null()) parameter.stderr_ = reader.number("stderr", at_least(0));
  parameter.unit = reader.word("unit", {"1"});  // of a pure number; another unit would be misread
  parameter.source = reader.word("source", {"fit", "thesis", "assumed"});
  parameter.thesis = reader.maybe_number("thesis", any_number());
  parameter.note = reader.text("note", "");
  reader.finish();
  return parameter;
}

Json parameter_json(const Parameter& parameter) {
  Json json{{"value", parameter.value},
            {"stderr", nullptr},
            {"unit", parameter.unit},
            {"source", parameter.source}};
  if (parameter.stderr_) json["stderr"] = *parameter.stderr_;
  if (parameter.thesis) json["thesis"] = *parameter.thesis;
  if (!parameter.note.empty()) json["note"] = parameter.note;
  return json;
}

template <class Group>
Group read_keys(Reader& reader) {
  Group group;
  for (const auto& key : keys(group)) group.*key.member = read_parameter(reader.object(key.name), key.range);
  return group;
}

template <class Group>
Group read_group(Reader reader) {
  Group group = read_keys<Group>(reader);
  reader.finish();
  return group;
}

template <class Group>
Json group_json(const Group& group) {
  Json json = Json::object();
  for (const auto& key : keys(group)) json[key.name] = parameter_json(group.*key.member);
  return json;
}

/// The object at a key that may be absent; the key counts as known either way.
std::optional<Reader> maybe_object(Reader& reader, const char* key) {
  Reader object = reader.object_or_empty(key);
  if (!reader.has(key)) return std::nullopt;
  return object;
}

ShearLaws read_shear(Reader reader) {
  ShearLaws shear;
  for (const auto& [name, member] : quantities)
    if (auto object = maybe_object(reader, name)) shear.*member = read_group<SaturationLaw>(*object);
  reader.finish();
  return shear;
}

/// What of the memory may be unknown.
struct MemoryOption {
  const char* name;
  std::optional<Parameter> MemoryLaws::*member;
  Range range;
};
const MemoryOption memory_options[] = {{"phi_cr", &MemoryLaws::phi_cr, inside(0, 1)},
                                       {"alpha_P", &MemoryLaws::alpha_P, above_up_to(0, 10)},
                                       {"eps0_P", &MemoryLaws::eps0_P, above(0)},
                                       {"eps0_R_P", &MemoryLaws::eps0_R_P, above(0)},
                                       {"eps_r", &MemoryLaws::eps_r, above(0)},
                                       {"hold", &MemoryLaws::hold, share()},
                                       {"pack_rate", &MemoryLaws::pack_rate, at_least(0)},
                                       {"phi_pack", &MemoryLaws::phi_pack, inside(0, 1)}};

/// near_jamming.ROW: name and where it is kept.
constexpr std::array<std::pair<const char*, PackingLaw NearJammingLaws::*>, 2> near_modes{
    {{"iso", &NearJammingLaws::iso}, {"d2", &NearJammingLaws::d2}}};
constexpr std::array<std::pair<const char*, SaturationLaw NearJammingLaws::*>, 4> near_quantities{
    {{"s_max", &NearJammingLaws::s_max},
     {"beta_s", &NearJammingLaws::beta_s},
     {"F_max", &NearJammingLaws::F_max},
     {"beta_F", &NearJammingLaws::beta_F}}};

/// Calls `f` with name and group of every row.
template <class Laws, class F>
void for_each_row(Laws& laws, F f) {
  for (const auto& [name, member] : near_modes) f(name, laws.*member);
  for (const auto& [name, member] : near_quantities) f(name, laws.*member);
}

NearJammingLaws read_near_jamming(Reader reader) {
  NearJammingLaws laws;
  for_each_row(laws, [&](const char* name, auto& row) {
    row = read_group<std::remove_reference_t<decltype(row)>>(reader.object(name));
  });
  reader.finish();
  return laws;
}

Json near_jamming_json(const NearJammingLaws& laws) {
  Json json = Json::object();
  for_each_row(laws, [&](const char* name, const auto& row) { json[name] = group_json(row); });
  return json;
}

Json shear_json(const ShearLaws& shear) {
  Json json = Json::object();
  for (const auto& [quantity, member] : quantities)
    if (shear.*member) json[quantity] = group_json(*(shear.*member));
  return json;
}

MemoryLaws read_memory(Reader reader) {
  auto memory = read_keys<MemoryLaws>(reader);
  for (const auto& [name, member, range] : memory_options)
    if (auto object = maybe_object(reader, name)) memory.*member = read_parameter(*object, range);
  reader.finish();
  return memory;
}

ModuliLaws read_moduli(Reader reader) {
  auto moduli = read_keys<ModuliLaws>(reader);
  reader.optional({"a_F", "a_s", "F_v"});
  if (reader.has("F_v")) moduli.F_v = read_parameter(reader.object("F_v"), above(0));
  if (reader.has("a_F") || reader.has("a_s")) {  // one means nothing without the other
    moduli.a_F = read_parameter(reader.object("a_F"), any_number());
    moduli.a_s = read_parameter(reader.object("a_s"), any_number());
  }
  reader.finish();
  return moduli;
}

TabulatedLaws read_moduli_table(Reader reader) {
  const std::vector<double> nu = reader.numbers("nu", inside(0, 1), 2);
  for (std::size_t i = 1; i < nu.size(); ++i)
    if (!(nu[i] > nu[i - 1]))
      throw Error(reader.file(), reader.path_of("nu[" + std::to_string(i) + "]"),
                  "must be > the one before, " + to_text(nu[i - 1]) + ", got " + to_text(nu[i]));
  std::array<std::vector<double>, ModuliTable::columns> values;
  for (std::size_t column = 0; column < ModuliTable::columns; ++column) {
    const char* name = ModuliTable::names[column];
    const bool positive = column == ModuliTable::B || column == ModuliTable::GB_ini;
    values[column] = reader.numbers(name, positive ? above(0) : any_number());
    if (values[column].size() != nu.size())
      throw Error(reader.file(), reader.path_of(name),
                  "must have one number for each of the " + std::to_string(nu.size()) + " nu, got " +
                      std::to_string(values[column].size()));
  }
  TabulatedLaws laws{
      {nu, std::move(values)}, reader.word("source", {"fit", "thesis", "assumed"}), reader.text("note", "")};
  reader.finish();
  return laws;
}

Json moduli_table_json(const TabulatedLaws& laws) {
  Json json{{"nu", laws.table.nu()}};
  for (std::size_t column = 0; column < ModuliTable::columns; ++column)
    json[ModuliTable::names[column]] = laws.table.values(static_cast<ModuliTable::Column>(column));
  json["source"] = laws.source;
  if (!laws.note.empty()) json["note"] = laws.note;
  return json;
}

std::map<std::string, PackingLaw> read_isotropic(Reader reader) {
  std::map<std::string, PackingLaw> rows;
  for (const auto& mode : modes)
    if (auto object = maybe_object(reader, mode.c_str())) rows[mode] = read_group<PackingLaw>(*object);
  reader.finish();
  return rows;
}

Closure read_closure(Reader reader) {
  Closure closure;
  closure.P = reader.word("P", modes);
  closure.contacts = reader.word("contacts", modes);
  closure.contacts_at_moduli_nu_c = reader.word("contacts_nu_c", {"row", "moduli"}) == "moduli";
  reader.finish();
  return closure;
}

}  // namespace

ContactCurve PackingLaw::contacts() const {
  return {C0.value, C1.value, alpha.value, nu_c_contacts.value, phi_c.value, phi_v.value};
}

PressureCurve PackingLaw::pressure() const { return {contacts(), p0.value, gamma_p.value, nu_c.value}; }

Saturation SaturationLaw::values() const { return {Q_max.value, Q_v.value, alpha.value, nu_c.value}; }

Moduli ModuliLaws::values() const {
  return {p0.value,   gamma_p.value, nu_c.value,   g3.value,     a_I.value,
          a_II.value, g_I.value,     GB_max.value, Fv_min.value, Fv_alpha.value};
}

OverCompression MemoryLaws::over_compression() const {
  return {phi_SJ.value, mu.value, beta.value, alpha_max.value, alpha_phi.value};
}

ParameterSet ParameterSet::load(const std::filesystem::path& file) {
  return read(Reader(load_json(file), file.string()));
}

ParameterSet ParameterSet::read(Reader reader) {
  ParameterSet set;
  set.file = reader.file();
  reader.word("format", {format_name});
  set.name = reader.text("name");
  set.material = Material::read(reader.object("material"));
  set.closure = read_closure(reader.object("closure"));
  set.isotropic = read_isotropic(reader.object_or_empty("isotropic"));
  if (auto object = maybe_object(reader, "shear")) set.shear = read_shear(*object);
  if (auto object = maybe_object(reader, "shear_axial")) set.shear_axial = read_shear(*object);
  if (auto object = maybe_object(reader, "near_jamming")) set.near_jamming = read_near_jamming(*object);
  if (auto object = maybe_object(reader, "moduli")) set.moduli = read_moduli(*object);
  if (auto object = maybe_object(reader, "moduli_table")) set.moduli_table = read_moduli_table(*object);
  if (auto object = maybe_object(reader, "volumetric")) set.volumetric = read_group<VolumetricLaws>(*object);
  if (auto object = maybe_object(reader, "memory")) set.memory = read_memory(*object);
  reader.finish();
  return set;
}

Json ParameterSet::to_json() const {
  Json json{{"format", format_name}, {"name", name}, {"material", material.to_json()}};
  json["closure"] = {{"P", closure.P},
                     {"contacts", closure.contacts},
                     {"contacts_nu_c", closure.contacts_at_moduli_nu_c ? "moduli" : "row"}};
  json["isotropic"] = Json::object();
  for (const auto& mode : modes)
    if (isotropic.contains(mode)) json["isotropic"][mode] = group_json(isotropic.at(mode));
  if (shear) json["shear"] = shear_json(*shear);
  if (shear_axial) json["shear_axial"] = shear_json(*shear_axial);
  if (near_jamming) json["near_jamming"] = near_jamming_json(*near_jamming);
  if (moduli) {
    json["moduli"] = group_json(*moduli);
    if (moduli->a_F) json["moduli"]["a_F"] = parameter_json(*moduli->a_F);
    if (moduli->a_s) json["moduli"]["a_s"] = parameter_json(*moduli->a_s);
    if (moduli->F_v) json["moduli"]["F_v"] = parameter_json(*moduli->F_v);
  }
  if (moduli_table) json["moduli_table"] = moduli_table_json(*moduli_table);
  if (volumetric) json["volumetric"] = group_json(*volumetric);
  if (memory) {
    json["memory"] = group_json(*memory);
    for (const auto& [key, member, range] : memory_options)
      if ((*memory).*member) json["memory"][key] = parameter_json(*((*memory).*member));
  }
  return json;
}

std::vector<NamedParameter> ParameterSet::named() const {
  std::vector<NamedParameter> list;
  const auto add = [&](const std::string& prefix, const auto& group) {
    for (const auto& key : keys(group))
      list.push_back({prefix + "." + key.name, &(group.*key.member), key.range});
  };
  for (const auto& mode : modes)
    if (isotropic.contains(mode)) add("isotropic." + mode, isotropic.at(mode));
  const auto add_shear = [&](const std::string& group, const std::optional<ShearLaws>& laws) {
    for (const auto& [quantity, member] : quantities)
      if (laws && (*laws).*member) add(group + "." + quantity, *((*laws).*member));
  };
  add_shear("shear", shear);
  add_shear("shear_axial", shear_axial);
  if (near_jamming)
    for_each_row(*near_jamming,
                 [&](const char* row, const auto& laws) { add(std::string("near_jamming.") + row, laws); });
  if (moduli) {
    add("moduli", *moduli);
    if (moduli->a_F) list.push_back({"moduli.a_F", &*moduli->a_F, any_number()});
    if (moduli->a_s) list.push_back({"moduli.a_s", &*moduli->a_s, any_number()});
    if (moduli->F_v) list.push_back({"moduli.F_v", &*moduli->F_v, above(0)});
  }
  if (volumetric) add("volumetric", *volumetric);
  if (memory) {
    add("memory", *memory);
    for (const auto& [key, member, range] : memory_options)
      if ((*memory).*member) list.push_back({std::string("memory.") + key, &*((*memory).*member), range});
  }
  return list;
}

Parameter& ParameterSet::parameter(const std::string& key) {
  for (const NamedParameter& entry : named())
    if (entry.name == key) return const_cast<Parameter&>(*entry.parameter);  // of this very set
  throw Error(file, key, "no such parameter in the set");
}

const PackingLaw& ParameterSet::packing(const std::string& mode, const std::string& why) const {
  const auto row = isotropic.find(mode);
  if (row == isotropic.end()) throw Error(file, "isotropic." + mode, "is missing; " + why + " needs it");
  return row->second;
}

const SaturationLaw& ParameterSet::saturation(const std::string& quantity, const std::string& why,
                                              bool axial) const {
  const std::optional<ShearLaws>& laws = axial ? shear_axial : shear;
  const std::string group = axial ? "shear_axial" : "shear";
  if (!laws) throw Error(file, group, "is missing; " + why + " needs it");
  for (const auto& [name_, member] : quantities)
    if (quantity == name_ && (*laws).*member) return *((*laws).*member);
  throw Error(file, group + "." + quantity, "is missing; " + why + " needs it");
}

const ModuliLaws& ParameterSet::need_moduli(const std::string& why) const {
  if (!moduli) throw Error(file, "moduli", "is missing; " + why + " needs it");
  return *moduli;
}

std::pair<const Parameter&, const Parameter&> ParameterSet::need_energy(const std::string& why) const {
  const ModuliLaws& laws = need_moduli(why);
  if (!laws.a_F) throw Error(file, "moduli.a_F", "is missing; " + why + " needs it");
  return {*laws.a_F, *laws.a_s};
}

const Parameter& ParameterSet::need_constant_F_v(const std::string& why) const {
  const ModuliLaws& laws = need_moduli(why);
  if (!laws.F_v)
    throw Error(file, "moduli.F_v",
                "is missing; " + why + " needs it (predict writes F_v, that of a path's first row, say)");
  return *laws.F_v;
}

const ModuliTable& ParameterSet::need_moduli_table(const std::string& why) const {
  if (!moduli_table) throw Error(file, "moduli_table", "is missing; " + why + " needs it");
  return moduli_table->table;
}

const VolumetricLaws& ParameterSet::need_volumetric(const std::string& why) const {
  if (!volumetric) throw Error(file, "volumetric", "is missing; " + why + " needs it");
  return *volumetric;
}

const MemoryLaws& ParameterSet::need_memory(const std::string& why) const {
  if (!memory) throw Error(file, "memory", "is missing; " + why + " needs it");
  return *memory;
}

}  // namespace grainlaw::model
