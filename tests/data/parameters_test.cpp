// The parameter sets of the thesis hold the cells of its tables, and give the numbers its text gives.
#include "grainlaw/model/parameters.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "grainlaw/element/material.hpp"
#include "table.hpp"

namespace grainlaw::tests {
namespace {

using model::Parameter;

model::ParameterSet load(const std::string& name) {
  return model::ParameterSet::load(std::string(GRAINLAW_DATA_DIR) + "/thesis/" + name);
}

/// A parameter that stands in a cell of a table: the same number, from the thesis, with the cell's error.
void expect_cell(const Parameter& parameter, const Row& row, const std::string& column) {
  EXPECT_EQ(parameter.value, number(row, column)) << column;
  EXPECT_EQ(parameter.thesis, parameter.value) << column;
  EXPECT_EQ(parameter.source, "thesis") << column;
  const auto error = row.find(column == "value" ? "pm" : column + "_pm");
  const bool given = error != row.end() && !error->second.empty();
  EXPECT_EQ(parameter.stderr_.has_value(), given) << column;
  if (given && parameter.stderr_) {
    EXPECT_EQ(*parameter.stderr_, number(row, error->first)) << column;
  }
  const bool suspect = (";" + row.at("suspect") + ";").find(";" + column + ";") != std::string::npos;
  EXPECT_EQ(parameter.note.find("suspect") != std::string::npos, suspect) << column << ": " << parameter.note;
}

Row constant(const std::string& group, const std::string& name) {
  return row_where(read_table("text-constants"), {{"group", group}, {"parameter", name}});
}

void expect_packing(const model::PackingLaw& law, const Row& row) {
  expect_cell(law.C0, constant("isotropic", "C0"), "value");
  expect_cell(law.C1, row, "C1");
  expect_cell(law.phi_c, row, "phi_c");
  expect_cell(law.phi_v, row, "phi_v");
  expect_cell(law.p0, row, "p0");
  expect_cell(law.gamma_p, row, "gamma_p");
  expect_cell(law.nu_c, row, "nu_c");
}

TEST(ThesisParameters, W3HoldsTable21) {
  const auto set = load("parameters.json");
  ASSERT_EQ(set.isotropic.size(), 4U);
  for (const auto& [mode, law] : set.isotropic) {
    SCOPED_TRACE(mode);
    const Row row = row_where(read_table("table-2.1"), {{"mode", mode}, {"data", "thesis"}});
    expect_packing(law, row);
    expect_cell(law.alpha, row, "alpha");
    expect_cell(law.nu_c_contacts, row, "nu_c_contacts");
  }
}

TEST(ThesisParameters, W3HoldsTable22) {
  const auto set = load("parameters.json");
  for (const Row& row : read_table("table-2.2")) {
    SCOPED_TRACE(row.at("quantity"));
    const auto& law = set.saturation(row.at("quantity"), "the test");
    expect_cell(law.Q_max, row, "Q_max");
    expect_cell(law.Q_v, row, "Q_v");
    expect_cell(law.alpha, row, "alpha");
    expect_cell(law.nu_c, constant("shear", "nu_c"), "value");
  }
}

/// Numbers of the moduli, by name.
std::map<std::string, Parameter> moduli_of(const model::ParameterSet& set) {
  const auto& m = set.need_moduli("the test");
  return {{"p0", m.p0},         {"gamma_p", m.gamma_p},  {"nu_c", m.nu_c}, {"g3", m.g3},
          {"a_I", m.a_I},       {"a_II", m.a_II},        {"g_I", m.g_I},   {"GB_max", m.GB_max},
          {"Fv_min", m.Fv_min}, {"Fv_alpha", m.Fv_alpha}};
}

TEST(ThesisParameters, W3HoldsTable41) {
  const auto moduli = moduli_of(load("parameters.json"));
  std::size_t cells = 0;
  for (const Row& row : read_table("table-4.1")) {
    expect_cell(moduli.at(row.at("parameter")), row, "value");
    ++cells;
  }
  for (const char* name : {"g3", "GB_max", "Fv_min", "Fv_alpha"}) {
    expect_cell(moduli.at(name), constant("moduli", name), "value");
    ++cells;
  }
  EXPECT_EQ(cells, moduli.size());
}

TEST(ThesisParameters, W3HoldsTheMemoryConstants) {
  const auto set = load("parameters.json");
  const auto& m = set.need_memory("the test");
  const std::map<std::string, Parameter> memory{
      {"phi_SJ", m.phi_SJ},       {"mu", m.mu},       {"beta", m.beta}, {"alpha_max", m.alpha_max},
      {"alpha_phi", m.alpha_phi}, {"alpha", m.alpha}, {"eps0", m.eps0}, {"eps0_R", m.eps0_R}};
  for (const auto& [name, parameter] : memory) expect_cell(parameter, constant("memory", name), "value");
  EXPECT_FALSE(m.phi_cr) << "the thesis gives no number";
}

TEST(ThesisParameters, NearJammingHoldsTables51And52) {
  const auto set = load("near-jamming.json");
  const auto rows = read_table("table-5.1");
  for (const auto& [mode, column] :
       std::map<std::string, std::string>{{"iso", "isotropic"}, {"d2", "shear"}}) {
    SCOPED_TRACE(mode);
    const auto& law = set.packing(mode, "the test");
    const auto value = [&](const char* parameter) {
      return number(row_where(rows, {{"parameter", parameter}}), column);
    };
    EXPECT_EQ(law.C1.value, value("C1"));
    EXPECT_EQ(law.alpha.value, value("theta"));
    EXPECT_EQ(law.phi_c.value, value("phi_c"));
    EXPECT_EQ(law.phi_v.value, value("phi_v"));
    EXPECT_EQ(law.p0.value, value("p0"));
    EXPECT_EQ(law.gamma_p.value, value("gamma_p"));
    EXPECT_EQ(law.nu_c.value, law.nu_c_contacts.value);
  }
  EXPECT_EQ(set.isotropic.size(), 2U);
  EXPECT_EQ(set.isotropic.at("iso").nu_c.value, 0.6652);
  EXPECT_EQ(set.isotropic.at("d2").nu_c.value, set.memory->phi_SJ.value);
  for (const Row& row : read_table("table-5.2")) {
    const auto& law = set.saturation(row.at("quantity"), "the test");
    EXPECT_EQ(law.Q_max.value, number(row, "Q_a"));
    EXPECT_EQ(law.Q_v.value, number(row, "Q_c"));
    EXPECT_EQ(law.alpha.value, number(row, "Psi"));
    EXPECT_EQ(law.nu_c.value, set.memory->phi_SJ.value);
  }
}

TEST(ThesisParameters, MaterialHoldsTable31) {
  const auto rows = read_table("table-3.1");
  for (const auto* name : {"parameters.json", "near-jamming.json", "w-1.3.json"}) {
    const Material material = load(name).material;
    const auto value = [&](const char* symbol) {
      return number(row_where(rows, {{"symbol", symbol}}), "value");
    };
    EXPECT_EQ(material.k, value("k"));
    EXPECT_EQ(material.r_mean, value("r_mean"));
    EXPECT_EQ(material.rho, value("rho"));
    EXPECT_EQ(material.gamma, value("gamma"));
    EXPECT_EQ(material.gamma_b, value("gamma_b"));
  }
}

/// The sets of all polydispersities, by w as Table 3.3 prints it.
class ThesisPolydispersity : public testing::TestWithParam<std::string> {
 protected:
  Row row() const { return row_where(read_table("table-3.3"), {{"w", GetParam()}}); }
  double w() const { return number(row(), "w"); }
  model::ParameterSet set() const { return load("w-" + GetParam() + ".json"); }
};

TEST_P(ThesisPolydispersity, HoldsTable34) {
  const auto parameters = set();
  EXPECT_EQ(parameters.material.w, w());
  ASSERT_EQ(parameters.isotropic.size(), 3U);
  for (const auto& [mode, law] : parameters.isotropic) {
    SCOPED_TRACE(mode);
    const Row cells = row_where(read_table("table-3.4"), {{"mode", mode}, {"w", GetParam()}});
    expect_packing(law, cells);
    expect_cell(law.nu_c_contacts, cells, "nu_c");
    EXPECT_EQ(law.alpha.value, number(constant("isotropic", "alpha_w"), "value"));
  }
}

TEST_P(ThesisPolydispersity, HoldsTable33) {
  const auto parameters = set();
  const Row cells = row();
  ASSERT_TRUE(parameters.shear);
  const std::map<std::string, std::optional<model::SaturationLaw>> laws{{"s_max", parameters.shear->s_max},
                                                                        {"beta_s", parameters.shear->beta_s},
                                                                        {"F_max", parameters.shear->F_max},
                                                                        {"beta_F", parameters.shear->beta_F}};
  for (const auto& [quantity, law] : laws) {
    SCOPED_TRACE(quantity);
    ASSERT_EQ(law.has_value(), !cells.at(quantity + "_Q_v").empty());
    if (!law) continue;
    expect_cell(law->Q_v, cells, quantity + "_Q_v");
    expect_cell(law->alpha, cells, quantity + "_alpha");
    expect_cell(law->nu_c, cells, "nu_c");
    if (quantity == "s_max" || quantity == "beta_s")
      expect_cell(law->Q_max, cells, quantity + "_Q_max");
    else
      EXPECT_EQ(law->Q_max.value, 0);
  }
  EXPECT_EQ(parameters.shear->beta_s.has_value(), w() > 1);
}

TEST_P(ThesisPolydispersity, HoldsTable42) {
  const auto moduli = moduli_of(set());
  const auto rows = read_table("table-4.2");
  for (const char* name : {"a_I", "a_II", "g_I"})
    expect_cell(moduli.at(name), row_where(rows, {{"parameter", name}}), "value");
  // b multiplies the p0 of the text; the product stands for both.
  const double b = number(row_where(rows, {{"parameter", "b"}}), "value");
  EXPECT_DOUBLE_EQ(moduli.at("p0").value, b * number(constant("moduli", "p0_w"), "value"));
  EXPECT_NEAR(moduli.at("g3").value, fabric_size_factor(w()), 1e-6);
  const Row limits = row_where(read_table("table-3.2"), {{"mode", "d2"}});
  const double h = 3 / (w() * w()) - 2 / (w() * w() * w());
  EXPECT_NEAR(moduli.at("nu_c").value, number(limits, "nu_c_inf") * (1 - h) + number(limits, "nu_c_0") * h,
              1e-6);
  for (const char* name : {"gamma_p", "GB_max", "Fv_alpha"})
    EXPECT_EQ(moduli.at(name).value, moduli_of(load("parameters.json")).at(name).value);
  for (const char* name : {"gamma_p", "GB_max", "Fv_min", "Fv_alpha"})
    EXPECT_EQ(moduli.at(name).source, w() == 3 ? "thesis" : "assumed");
}

std::vector<std::string> all_w() {
  std::vector<std::string> list;
  for (const Row& row : read_table("table-3.3")) list.push_back(row.at("w"));
  return list;
}

/// "w1_3" for w = 1.3.
std::string test_name(const testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  name[name.find('.')] = '_';
  return name.insert(0, 1, 'w');
}

INSTANTIATE_TEST_SUITE_P(AllW, ThesisPolydispersity, testing::ValuesIn(all_w()), test_name);

// Fabric and moduli of the closure at nu = 0.711: the D2 row's contact law, taken from the moduli's nu_c.
TEST(ThesisClosure, FabricAndModuliAt0711) {
  const auto set = load("parameters.json");
  EXPECT_EQ(set.closure.P, "iso");
  EXPECT_EQ(set.closure.contacts, "d2");
  ASSERT_TRUE(set.closure.contacts_at_moduli_nu_c);
  const auto& row = set.packing("d2", "the test");
  const auto& m = set.need_moduli("the test");
  const double g3 = m.g3.value, nu_c = m.nu_c.value;
  const auto F_v = [&](double nu) {
    const double x = nu / nu_c - 1;
    const double C_star = row.C0.value + row.C1.value * std::pow(x, row.alpha.value);
    return g3 * nu * C_star * (1 - row.phi_c.value * std::exp(-row.phi_v.value * x));
  };
  const double nu = 0.711, e = std::log(nu / nu_c), h = 1e-5;
  const double slope = (std::log(F_v(nu * std::exp(h))) - std::log(F_v(nu * std::exp(-h)))) / (2 * h);
  const double bracket = 1 - 2 * m.gamma_p.value * e + e * (1 - m.gamma_p.value * e) * slope;
  EXPECT_NEAR(F_v(nu), 6.534, 5e-4);
  EXPECT_NEAR(m.p0.value * F_v(nu) / (g3 * nu_c) * bracket, 0.4279, 5e-5);
  EXPECT_NEAR(m.GB_max.value * (1 - std::exp(-(F_v(nu) - m.Fv_min.value) / m.Fv_alpha.value)), 0.3607, 5e-5);
  // Just above jamming, with the rounded numbers of the text (C* = 6, phi_r = 0.13).
  EXPECT_NEAR(g3 * nu_c * 6 * 0.87, m.Fv_min.value, 0.02);
  EXPECT_NEAR(m.p0.value * m.Fv_min.value / (g3 * nu_c), number(constant("moduli", "B_min"), "value"), 0.005);
}

TEST(ThesisShear, SaturationOverVolumeFraction) {
  const auto set = load("parameters.json");
  const auto Q = [&](const char* quantity, double nu) {
    const auto& law = set.saturation(quantity, "the test");
    return law.Q_max.value + law.Q_v.value * std::exp(-law.alpha.value * (nu / law.nu_c.value - 1));
  };
  const struct {
    double nu, s_max, beta_s, F_max, beta_F;
  } expected[] = {{0.671, 0.19935, 80.093, 0.16291, 55.289},
                  {0.695, 0.17807, 57.613, 0.13819, 45.559},
                  {0.711, 0.16691, 48.662, 0.12383, 40.043},
                  {0.728, 0.15717, 42.396, 0.11020, 34.912},
                  {0.75, 0.14716, 37.423, 0.09477, 29.236}};
  for (const auto& at : expected) {
    EXPECT_NEAR(Q("s_max", at.nu), at.s_max, 1e-5);
    EXPECT_NEAR(Q("beta_s", at.nu), at.beta_s, 1e-3);
    EXPECT_NEAR(Q("F_max", at.nu), at.F_max, 1e-5);
    EXPECT_NEAR(Q("beta_F", at.nu), at.beta_F, 1e-3);
  }
  for (const Row& quoted : read_table("text-results"))  // Fig. 4.14, to its last digit
    if (quoted.at("where") == "Fig. 4.14") {
      const double half_digit = quoted.at("quantity") == "beta_F" ? 0.005 : 0.0005;
      EXPECT_NEAR(Q(quoted.at("quantity").c_str(), 0.711), number(quoted, "value"), half_digit);
    }
}

TEST(ThesisMemory, OverCompressionAndShearJamming) {
  const auto set = load("parameters.json");
  const auto& m = set.need_memory("the test");
  const auto phi_J = [&](double phi_max, double cycles) {
    const double rise = m.alpha_max.value * std::pow(phi_max / m.phi_SJ.value - 1, m.alpha_phi.value);
    return m.phi_SJ.value + rise * (1 - std::exp(-std::pow(cycles / m.mu.value, m.beta.value)));
  };
  const struct {
    double phi_max, first, hundredth, last;
  } expected[] = {{0.68, 0.66134, 0.66391, 0.66405},
                  {0.73, 0.66325, 0.66687, 0.66706},
                  {0.82, 0.66503, 0.66963, 0.66987}};
  for (const auto& at : expected) {
    EXPECT_NEAR(phi_J(at.phi_max, 1), at.first, 1e-5);
    EXPECT_NEAR(phi_J(at.phi_max, 100), at.hundredth, 1e-5);
    EXPECT_NEAR(phi_J(at.phi_max, 1e30), at.last, 1e-5);
  }
  const auto strain_to_jam = [&](double phi, double phi_J0) {
    return m.eps0.value *
           std::pow(-std::log((phi - m.phi_SJ.value) / (phi_J0 - m.phi_SJ.value)), 1 / m.alpha.value);
  };
  EXPECT_NEAR(strain_to_jam(0.6584, 0.6652), 0.1444, 1e-4);
  EXPECT_NEAR(strain_to_jam(0.6593, 0.6652), 0.1154, 1e-4);
  EXPECT_NEAR(strain_to_jam(0.66, 0.6652), 0.0980, 1e-4);
}

}  // namespace
}  // namespace grainlaw::tests
