#include "synthetic.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <random>
#include <tuple>

#include "grainlaw/element/file.hpp"
#include "grainlaw/element/json.hpp"
#include "grainlaw/element/record.hpp"
#include "grainlaw/model/laws/packing_laws.hpp"
#include "grainlaw/model/laws/saturation.hpp"

namespace grainlaw::report::test {
namespace {

namespace fs = std::filesystem;
using Noise = std::function<double()>;

/// Table 2.1: C1, alpha, nu_c of the contacts, phi_c, phi_v, p0, gamma_p, nu_c of the pressure.
const std::map<std::string, std::array<double, 8>>& table_2_1() {
  static const std::map<std::string, std::array<double, 8>> table{
      {"iso", {8.2720, 0.5814, 0.6646, 0.1216, 15.8950, 0.04172, 0.06228, 0.6649}},
      {"uni", {8.370, 0.5998, 0.6625, 0.1507, 15.6835, 0.04006, 0.03270, 0.6619}},
      {"d2", {7.9219, 0.5769, 0.6601, 0.1363, 15.0010, 0.03886, 0.03219, 0.6581}},
      {"d3", {7.9289, 0.5764, 0.6603, 0.1327, 14.6813, 0.03899, 0.02893, 0.6583}},
  };
  return table;
}
const std::vector<std::string> packing_names{"C1",    "alpha", "nu_c_contacts", "phi_c",
                                             "phi_v", "p0",    "gamma_p",       "nu_c"};
/// Standard errors in the same order.
const std::array<double, 8> packing_errors{0.12, 0.006, 0.0006, 0.004, 0.4, 0.0004, 0.02, 0.0005};

/// Table 2.2.
const std::vector<std::pair<std::string, std::array<double, 4>>> table_2_2{
    {"s_max", {0.1137, 0.09166, 7.916, 0.6653}},
    {"beta_s", {30.76, 57.00, 16.86, 0.6653}},
    {"F_max", {0, 0.1694, 4.562, 0.6653}},
    {"beta_F", {0, 57.89, 5.366, 0.6653}},
};

model::PressureCurve pressure_curve(const std::string& mode) {
  const auto& row = table_2_1().at(mode);
  model::PressureCurve curve;
  curve.contacts = {6, row[0], row[1], row[2], row[3], row[4]};
  curve.p0 = row[5];
  curve.gamma_p = row[6];
  curve.nu_c = row[7];
  return curve;
}

double saturated(const std::string& quantity, double nu) {
  for (const auto& [name, q] : table_2_2) {
    if (name == quantity) return model::saturation(model::Saturation{q[0], q[1], q[2], q[3]}, nu);
  }
  return std::nan("");
}

Noise noise(unsigned seed) {
  return [engine = std::mt19937(seed), normal = std::normal_distribution<double>()]() mutable {
    return normal(engine);
  };
}

/// A row of a record: the isotropic laws of the mode, and the stress ratio and anisotropy given.
std::vector<double> state_row(const std::vector<std::string>& columns, const std::string& mode, double nu,
                              double nu_0, double eps_dev, double s, double F, double segment,
                              const Noise& random, double scatter) {
  const auto curve = pressure_curve(mode);
  const bool jammed = nu > model::jamming_density(curve);
  const double C = model::coordination(curve.contacts, nu);
  const double P = model::pressure(curve, nu) * (1 + 0.01 * scatter * random());
  const double phi = std::max(0.0, model::rattlers(curve.contacts, nu) + 0.004 * scatter * random());
  std::map<std::string, double> row{
      {"segment", segment},
      {"eps_vol", std::log(nu / nu_0)},
      {"eps_dev", eps_dev},
      {"nu", nu},
      {"P", jammed ? P : 0},
      {"sigma_dev", jammed ? s * P : 0},
      {"s_dev", jammed ? s : std::nan("")},
      {"F_v", 1.22475 * nu * C},
      {"F_dev", jammed ? F : 0},
      {"C", C},
      {"C_star",
       jammed ? model::corrected_coordination(curve.contacts, nu) + 0.02 * scatter * random() : std::nan("")},
      {"f_NR", jammed ? 1 - phi : 0},
      {"phi_J", std::nan("")},
      {"Ek_over_Ep", 1e-4},
  };
  std::vector<double> values;
  for (const std::string& column : columns) values.push_back(row.contains(column) ? row[column] : 0);
  return values;
}

/// One straight stretch of shear strain and volume fraction.
struct Leg {
  double eps_0, eps_1, nu_0, nu_1;
};

/// A test along legs; scatter 0 is the law itself, 1 looks like a small DEM. `speed` bends the law, to tell
/// forms apart.
Record walk(const std::vector<std::string>& columns, const std::string& mode, const std::vector<Leg>& legs,
            double scatter, unsigned seed, double speed = 1) {
  Record record(columns);
  const Noise random = noise(seed);
  double s = 0, F = 0, wobble_s = 0, wobble_F = 0;
  for (std::size_t leg = 0; leg < legs.size(); ++leg) {
    const Leg& l = legs[leg];
    const int rows = 100;
    const double step = (l.eps_1 - l.eps_0) / rows, q = step < 0 ? -1 : 1;
    for (int i = leg == 0 ? 0 : 1; i <= rows; ++i) {
      const double t = static_cast<double>(i) / rows, nu = l.nu_0 + t * (l.nu_1 - l.nu_0);
      const bool sheared = step != 0 && i > 0 && nu > 0.67;
      if (sheared) {
        s = model::approach(q * saturated("s_max", nu), s, speed * saturated("beta_s", nu), std::abs(step));
        F = model::approach(q * saturated("F_max", nu), F, speed * saturated("beta_F", nu), std::abs(step));
        wobble_s = 0.7 * wobble_s + 0.01 * scatter * random();
        wobble_F = 0.7 * wobble_F + 0.005 * scatter * random();
      }
      record.append(state_row(columns, mode, nu, legs[0].nu_0, l.eps_0 + i * step, s + wobble_s, F + wobble_F,
                              static_cast<double>(leg), random, scatter));
    }
  }
  return record;
}

/// A test of the made-up campaign.
struct Test {
  std::string name, role, mode;
  std::vector<Leg> legs;
  Json segments;
};

std::vector<Test> tests_of(const Synthetic& options) {
  std::vector<Test> tests;
  const Json up_down = Json::array(
      {{{"mode", "iso"}, {"controls", {{"nu", 0.82}}}}, {{"mode", "iso"}, {"controls", {{"nu", 0.64}}}}});
  tests.push_back({"iso", "fit", "iso", {{0, 0, 0.64, 0.82}, {0, 0, 0.82, 0.64}}, up_down});
  for (const double nu : {0.671, 0.695, 0.711, 0.728, 0.75}) {
    std::string name = "d2-" + std::to_string(nu).substr(0, 5);
    if (name.back() == '0') name.pop_back();
    tests.push_back(
        {name, "fit", "d2", {{0, 0.4, nu, nu}}, Json::array({{{"mode", "d2"}, {"amount", 0.4}}})});
  }
  const double uni = std::log(0.82 / 0.69);
  tests.push_back({options.uniaxial_test,
                   "predict",
                   "uni",
                   {{0, uni, 0.69, 0.82}},
                   Json::array({{{"mode", "uni"}, {"controls", {{"nu", 0.82}}}}})});
  tests.push_back({"d3-0.72",
                   "predict",
                   "d3",
                   {{0, 0.35, 0.72, 0.72}},
                   Json::array({{{"mode", "d3"}, {"amount", 0.35}}})});
  tests.push_back({"d2-cycle",
                   "predict",
                   "d2",
                   {{0, 0.4, 0.711, 0.711}, {0.4, -0.4, 0.711, 0.711}, {-0.4, 0.4, 0.711, 0.711}},
                   Json::array({{{"mode", "d2"}, {"amount", 0.4}},
                                {{"mode", "d2"}, {"amount", -0.8}},
                                {{"mode", "d2"}, {"amount", 0.8}}})});
  return tests;
}

const Json& material() {
  static const Json grains{{"w", 3},      {"k", 1e5},      {"r_mean", 1},
                           {"rho", 2000}, {"gamma", 1000}, {"gamma_b", 100}};
  return grains;
}

std::string run_name(const std::string& test, int seed) { return test + "-s" + std::to_string(seed); }

void write_json(const fs::path& file, const Json& json) { write_file(file, json.dump(1) + "\n"); }

void write_campaign_file(const fs::path& dir, const Synthetic& options, const std::vector<Test>& tests) {
  Json list = Json::array();
  for (const Test& test : tests) {
    list.push_back({{"name", test.name},
                    {"role", test.role},
                    {"seeds", options.seeds},
                    {"path", {{"segments", test.segments}}}});
  }
  write_json(
      dir / "campaign.json",
      {{"name", options.name},
       {"material", material()},
       {"preparation", {{"count", 1000}, {"nu_gas", 0.3}, {"speed", 0.02}, {"nu", 0.64}, {"rate", 2e-4}}},
       {"seeds", options.seeds},
       {"tests", list}});
}

void write_records(const fs::path& dir, const Synthetic& options, const std::vector<Test>& tests) {
  unsigned n = 0;
  for (const Test& test : tests) {
    for (const int seed : options.seeds) {
      const fs::path folder = dir / "records" / run_name(test.name, seed);
      fs::create_directories(folder);
      walk(record_columns(), test.mode, test.legs, 1, ++n).write_csv(folder / "record.csv");
      write_json(folder / "scene.json", {{"material", material()}, {"path", {{"segments", test.segments}}}});
      const double wall = 4.5 + n;
      Json warnings = Json::array();
      if (n == 3)
        warnings.push_back(
            "E_k/E_p was 2e-3 at eps_dev = 0.01, above 1e-3: the flow is not quasi-static there");
      write_json(folder / "provenance.json", {{"version", "0.1.0"},
                                              {"commit", "abc1234"},
                                              {"seed", seed},
                                              {"compiler", "GNU 12.2.0"},
                                              {"simd", "AVX2"},
                                              {"started", "2025-01-31T12:00:" + std::to_string(10 + n) + "Z"},
                                              {"wall_time_s", wall},
                                              {"particle_steps", 4e7 * wall},
                                              {"particle_steps_per_s", 4e7},
                                              {"k_star", 5e4},
                                              {"k_star_kPa", 5e7},
                                              {"time_step", 0.0228},
                                              {"warnings", warnings}});
    }
  }
}

Json parameter(double thesis, double error, const Noise& random) {
  const double value = error > 0 ? thesis + 0.3 * error * random() : thesis;
  return {{"value", value},
          {"stderr", error > 0 ? Json(error) : Json()},
          {"unit", "1"},
          {"source", "fit"},
          {"thesis", thesis}};
}

Json taken(double value, const std::string& source) {
  return {{"value", value}, {"stderr", nullptr}, {"unit", "1"}, {"source", source}, {"thesis", value}};
}

Json packing_row(const std::string& mode, const Noise& random) {
  Json row{{"C0",
            {{"value", 6},
             {"stderr", nullptr},
             {"unit", "1"},
             {"source", "assumed"},
             {"thesis", 6},
             {"note", "isostatic"}}}};
  for (std::size_t i = 0; i < packing_names.size(); ++i) {
    row[packing_names[i]] = parameter(table_2_1().at(mode)[i], packing_errors[i], random);
  }
  return row;
}

Json parameter_set(const Noise& random) {
  Json set{{"format", "grainlaw-parameters-1"},
           {"name", "synthetic"},
           {"material", material()},
           {"closure", {{"P", "iso"}, {"contacts", "d2"}, {"contacts_nu_c", "moduli"}}}};
  set["isotropic"] = {{"iso", packing_row("iso", random)}, {"d2", packing_row("d2", random)}};
  for (const auto& [quantity, q] : table_2_2) {
    Json row{{"Q_max", parameter(q[0], 0.05 * (q[0] + q[1]), random)},
             {"Q_v", parameter(q[1], 0.06 * q[1], random)},
             {"alpha", parameter(q[2], 0.1 * q[2], random)},
             {"nu_c", taken(q[3], "thesis")}};
    set["shear"][quantity] = row;
  }
  set["moduli"] = {{"p0", taken(0.0425, "thesis")},  {"gamma_p", taken(0.2, "thesis")},
                   {"nu_c", taken(0.658, "thesis")}, {"g3", taken(1.22, "thesis")},
                   {"a_I", taken(0.66, "thesis")},   {"a_II", taken(1, "thesis")},
                   {"g_I", taken(86, "thesis")},     {"GB_max", taken(0.51, "thesis")},
                   {"Fv_min", taken(4.2, "thesis")}, {"Fv_alpha", taken(1.9, "thesis")}};
  return set;
}

/// A parameter of fits.json from one of the parameter set.
Json fit_parameter(const std::string& name, const Json& entry, bool held = false) {
  return {{"name", name},
          {"value", entry["value"]},
          {"stderr", entry["stderr"]},
          {"thesis", entry["thesis"]},
          {"unit", "1"},
          {"at_bound", false},
          {"determined", true},
          {"held", held},
          {"interval95", nullptr}};
}

Json fit_entry(const std::string& name, const std::string& law, const std::string& role,
               const std::string& mode, const std::string& x, const std::string& y) {
  return {{"name", name},
          {"law", law},
          {"role", role},
          {"mode", mode},
          {"tests", Json::array()},
          {"x", {{"name", x}, {"label", x}}},
          {"y", {{"name", y}, {"label", y}}},
          {"selection", "rows of the last leg in which nu decreases, with P >= 1e-4"},
          {"rows_left_out", 12},
          {"data", Json::array()},
          {"curve", nullptr},
          {"thesis_curve", nullptr},
          {"parameters", Json::array()},
          {"rms", 0.0213},
          {"n", 200},
          {"n_effective", 61.3},
          {"degrees_of_freedom", 58.1},
          {"extra_scatter", 0},
          {"stderr_from", "residual autocorrelation"},
          {"condition", 182.4},
          {"starts", 8},
          {"best_found", 7},
          {"exit", "converged: the sum of squares no longer falls"}};
}

Json curve(double low, double high, const std::function<double(double)>& law) {
  Json points{{"x", Json::array()}, {"y", Json::array()}};
  for (int i = 0; i <= 119; ++i) {
    const double x = low + (high - low) * i / 119;
    points["x"].push_back(x);
    points["y"].push_back(law(x));
  }
  return points;
}

/// The three isotropic laws by name.
const std::vector<std::pair<std::string, std::string>> packing_fits{
    {"C_star", "C* = C0 + C1 (ν/ν_c − 1)^α (Eq. 2.11)"},
    {"C_star_free_C0", "C* = C0 + C1 (ν/ν_c − 1)^α with C0 free (Eq. 2.11)"},
    {"phi_r", "φ_r = φ_c exp[−φ_v (ν/ν_c − 1)] (Eq. 2.12)"},
    {"P", "p = p0 (ν C/ν_c) ε (1 − γ_p ε), ε = ln(ν/ν_c), with the measured C (Eq. 2.14)"}};

std::function<double(double)> packing_value(const std::string& name, const model::PressureCurve& curve_of) {
  return [=](double nu) {
    if (name == "phi_r") return model::rattlers(curve_of.contacts, nu);
    if (name == "P") return model::pressure(curve_of, nu);
    return model::corrected_coordination(curve_of.contacts, std::max(nu, curve_of.contacts.nu_c));
  };
}

std::vector<std::string> packing_parameters(const std::string& name) {
  if (name == "phi_r") return {"phi_c", "phi_v", "nu_c_contacts"};
  if (name == "P") return {"p0", "gamma_p", "nu_c"};
  return {"C0", "C1", "alpha", "nu_c_contacts"};
}

model::PressureCurve fitted_curve(const Json& row) {
  const auto value = [&](const char* name) { return row[name]["value"].get<double>(); };
  model::PressureCurve fitted;
  fitted.contacts = {6, value("C1"), value("alpha"), value("nu_c_contacts"), value("phi_c"), value("phi_v")};
  fitted.p0 = value("p0");
  fitted.gamma_p = value("gamma_p");
  fitted.nu_c = value("nu_c");
  return fitted;
}

/// Points of one run: rows of an unloading branch, or one steady state with its error.
Json packing_points(const std::string& run, const std::function<double(double)>& law, double scatter,
                    bool steady, const Noise& random) {
  Json points{{"test", run}, {"x", Json::array()}, {"y", Json::array()}};
  for (double nu = steady ? 0.695 : 0.668; nu < 0.82; nu += steady ? 0.03 : 0.0015) {
    points["x"].push_back(nu);
    points["y"].push_back(law(nu) + scatter * random());
    if (steady) points["error"].push_back(scatter);
  }
  return points;
}

void add_isotropic_fits(Json& fits, const Synthetic& options, const std::string& mode,
                        const std::string& role, const Json& row) {
  for (const auto& [name, law] : packing_fits) {
    Json fit = fit_entry("isotropic." + mode + "." + name, law, role, mode, "nu",
                         name == "C_star_free_C0" ? "C_star" : name);
    const double scatter = name == "phi_r" ? 0.003 : name == "P" ? 1e-4 : 0.02;
    for (const int seed : options.seeds) {
      const Noise random =
          noise(static_cast<unsigned>(1000 * seed) + static_cast<unsigned>(mode[0] + mode[1]));
      fit["data"].push_back(packing_points(run_name(mode, seed), packing_value(name, pressure_curve(mode)),
                                           scatter, mode[0] == 'd', random));
    }
    for (const std::string& parameter : packing_parameters(name)) {
      const bool held =
          (parameter == "C0" && name == "C_star") || (name == "phi_r" && parameter == "nu_c_contacts");
      fit["parameters"].push_back(fit_parameter(parameter, row[parameter], held));
    }
    if (name == "C_star_free_C0") fit["parameters"][0].update({{"value", 6.31}, {"stderr", 0.08}});
    if (mode == "iso") fit["parameters"].back()["shift_at_four_P_min"] = -0.0003;
    fit["curve"] = curve(0.6651, 0.82, packing_value(name, fitted_curve(row)));
    fit["thesis_curve"] = curve(0.6651, 0.82, packing_value(name, pressure_curve(mode)));
    fits.push_back(fit);
  }
}

/// s_dev(eps) or F_dev(eps) of one run; returns what it gives for the saturation value and the rate.
std::array<double, 2> add_run_fit(Json& fits, const fs::path& dir, const std::string& test, int seed,
                                  const std::string& y, const Noise& random) {
  const bool stress = y == "s_dev";
  const Record record = Record::read_csv(dir / "records" / run_name(test, seed) / "record.csv");
  const double nu = record["nu"].front();
  const double top = saturated(stress ? "s_max" : "F_max", nu) * (1 + 0.02 * random());
  const double beta = saturated(stress ? "beta_s" : "beta_F", nu) * (1 + 0.06 * random());
  Json fit = fit_entry(run_name(test, seed) + "." + y,
                       stress ? "s_dev = s_max − (s_max − s_0) exp(−β_s ε_dev) (Eq. 2.17)"
                              : "F_dev = F_max − (F_max − F_0) exp(−β_F ε_dev) (Eq. 2.18)",
                       "fit", "d2", "eps_dev", y);
  fit["tests"].push_back(run_name(test, seed));
  fit["data"].push_back({{"test", run_name(test, seed)}, {"x", record["eps_dev"]}, {"y", record[y]}});
  for (const auto& [name, value, error] :
       {std::tuple{"max", top, 0.02 * top}, {"initial", 0.003, 0.002}, {"beta", beta, 0.06 * beta}}) {
    fit["parameters"].push_back(
        {{"name", name}, {"value", value}, {"stderr", error}, {"thesis", nullptr}, {"unit", "1"}});
  }
  fit["curve"] = curve(0, 0.4, [&](double eps) { return model::approach(top, 0, beta, eps); });
  fits.push_back(fit);
  return {top, beta};
}

/// Eq. 2.20 through the points that the runs gave.
void add_density_fit(Json& fits, const std::string& quantity, const Json& points, const Json& row) {
  Json fit = fit_entry("shear." + quantity, "Q = Q_max + Q_v exp[−α (ν/ν_c − 1)] (Eq. 2.20)", "fit", "d2",
                       "nu", quantity);
  fit["data"] = points;
  fit["stderr_from"] = "scatter of the runs about the law";
  for (const char* name : {"Q_max", "Q_v", "alpha"})
    fit["parameters"].push_back(fit_parameter(name, row[name]));
  fit["parameters"].push_back(fit_parameter("nu_c", row["nu_c"], true));
  if (quantity == "beta_F") {
    fit["parameters"][0]["at_bound"] = true;
    fit["parameters"][2]["determined"] = false;
  }
  const auto law_of = [&](const char* which) {
    const auto value = [&](const char* name) { return row[name][which].get<double>(); };
    const model::Saturation law{value("Q_max"), value("Q_v"), value("alpha"), value("nu_c")};
    return [law](double nu) { return model::saturation(law, nu); };
  };
  fit["curve"] = curve(0.6653, 0.75, law_of("value"));
  fit["thesis_curve"] = curve(0.6653, 0.75, law_of("thesis"));
  fits.push_back(fit);
}

void add_shear_fits(Json& fits, const fs::path& dir, const Synthetic& options, const std::vector<Test>& tests,
                    const Json& shear) {
  std::map<std::string, Json> points;
  const Noise random = noise(77);
  for (const Test& test : tests) {
    if (test.mode != "d2" || test.role != "fit") continue;
    for (const int seed : options.seeds) {
      const auto s = add_run_fit(fits, dir, test.name, seed, "s_dev", random);
      const auto F = add_run_fit(fits, dir, test.name, seed, "F_dev", random);
      for (const auto& [quantity, value, relative] : {std::tuple{"s_max", s[0], 0.02},
                                                      {"beta_s", s[1], 0.06},
                                                      {"F_max", F[0], 0.02},
                                                      {"beta_F", F[1], 0.06}}) {
        points[quantity].push_back({{"test", run_name(test.name, seed)},
                                    {"x", {test.legs[0].nu_0}},
                                    {"y", {value}},
                                    {"error", {relative * value}}});
      }
    }
  }
  for (const auto& [quantity, q] : table_2_2)
    add_density_fit(fits, quantity, points[quantity], shear[quantity]);
}

Json predictions_of(const fs::path& dir, const Synthetic& options, const std::vector<Test>& tests) {
  fs::create_directories(dir / "predictions");
  Json list = Json::array();
  for (const Test& test : tests) {
    if (test.role != "predict") continue;
    for (const int seed : options.seeds) {
      double speed = 1.3;
      for (const char* form : {"reduced_closed", "reduced", "coupled"}) {
        const std::string file = "predictions/" + run_name(test.name, seed) + "." + form + ".csv";
        walk(prediction_columns(), "d2", test.legs, 0, 1, speed).write_csv(dir / file);
        speed -= 0.3;
        list.push_back({{"test", run_name(test.name, seed)},
                        {"mode", test.mode},
                        {"seed", seed},
                        {"form", form},
                        {"status", "ok"},
                        {"start",
                         {{"nu", {{"value", test.legs[0].nu_0}, {"from", "record"}}},
                          {"phi_J", {{"value", 0.6649}, {"from", "parameters"}}}}},
                        {"errors",
                         {{"P", 0.03 + 0.004 * seed},
                          {"sigma_dev", 0.11},
                          {"s_dev", 0.1 + 0.02 * seed},
                          {"F_dev", nullptr}}},
                        {"file", file},
                        {"record", "records/" + run_name(test.name, seed) + "/record.csv"}});
      }
    }
  }
  return {{"predictions", list}};
}

}  // namespace

void write_synthetic_campaign(const fs::path& dir, const Synthetic& options) {
  fs::create_directories(dir);
  const auto tests = tests_of(options);
  write_campaign_file(dir, options, tests);
  write_records(dir, options, tests);
  const Noise random = noise(5);
  const Json set = parameter_set(random);
  write_json(dir / "parameters.json", set);
  Json fits = Json::array();
  add_isotropic_fits(fits, options, "iso", "fit", set["isotropic"]["iso"]);
  add_isotropic_fits(fits, options, "d2", "fit", set["isotropic"]["d2"]);
  add_isotropic_fits(fits, options, "uni", "predict", packing_row("uni", random));
  add_shear_fits(fits, dir, options, tests, set["shear"]);
  const Json checks =
      Json::array({{{"name", "nu_c(ISO) > nu_c(D2)"}, {"value", "0.6650 > 0.6585"}, {"holds", true}},
                   {{"name", "C0, left free, is 6 within 0.2"}, {"value", "6.31 ± 0.08"}, {"holds", false}}});
  const Json missing = Json::array({{{"fit", "shear.beta_F"},
                                     {"parameter", "alpha"},
                                     {"reason", "five volume fractions lie too close together"}}});
  const Json left_out =
      Json::array({{{"test", "d2-0.671-s2"}, {"role", "fit"}, {"reason", "its steady state is not jammed"}}});
  write_json(dir / "fits.json",
             {{"fits", fits}, {"not_determined", missing}, {"left_out", left_out}, {"checks", checks}});
  write_json(dir / "predictions.json", predictions_of(dir, options, tests));
  write_json(dir / "timing.json", {{"stages",
                                    {{{"name", "simulate"}, {"wall_s", 512.4}, {"core_s", 1001.7}},
                                     {{"name", "fit"}, {"wall_s", 3.2}, {"core_s", 3.2}},
                                     {{"name", "predict"}, {"wall_s", 0.8}, {"core_s", 0.8}},
                                     {{"name", "report"}, {"wall_s", 2.1}, {"core_s", nullptr}}}},
                                   {"tests", Json::array()}});
}

}  // namespace grainlaw::report::test
