// Tables 2.1 and 2.2 of the thesis, one test for each fit to the records of the base campaign (9261 grains,
// three packings): every cell agrees within combined errors, or is named here with what explains it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "grainlaw/calibrate/fit_records.hpp"
#include "grainlaw/calibrate/fit_selection.hpp"
#include "grainlaw/calibrate/fit_shear.hpp"

namespace grainlaw::calibrate {
namespace {

const Json& fits() {
  static const Json all =
      fit_records(GRAINLAW_DATA_DIR "/records/base", GRAINLAW_DATA_DIR "/thesis/parameters.json")
          .fits.at("fits");
  return all;
}

const Json& fit_named(const std::string& name) {
  const auto found =
      std::find_if(fits().begin(), fits().end(), [&](const Json& fit) { return fit.at("name") == name; });
  if (found == fits().end()) throw std::runtime_error("no fit " + name);
  return *found;
}

/// What the difference between ours and the thesis's may be in 19 cases of 20: the whole width of our
/// interval of 95 %. Ours is the mean of three packings with the error e, the thesis has one packing without
/// a stated error, whose own scatter is sqrt(3) e: their difference scatters by 2 e.
double combined95(const Json& p) {
  const auto& interval = p.at("interval95");
  return interval[1].get<double>() - interval[0].get<double>();
}

double difference(const Json& p) { return p.at("value").get<double>() - p.at("thesis").get<double>(); }

struct Row {
  const char* fit;
  int cells;
  /// Cells that differ beyond combined errors. Tests below say what we know of why.
  std::set<std::string> differ = {};
};

void PrintTo(const Row& row, std::ostream* out) { *out << row.fit; }

class Refit : public testing::TestWithParam<Row> {};

TEST_P(Refit, AgreesWithTheThesisOrIsNamed) {
  int cells = 0;
  for (const Json& p : fit_named(GetParam().fit).at("parameters")) {
    if (p.at("held") == true || p.at("thesis").is_null()) continue;
    ++cells;
    EXPECT_EQ(p.at("determined"), true) << p.dump();
    const bool agrees = std::abs(difference(p)) <= combined95(p);
    EXPECT_NE(agrees, GetParam().differ.contains(p.at("name"))) << p.dump();
  }
  EXPECT_EQ(cells, GetParam().cells);
}

std::string name_of_row(const testing::TestParamInfo<Row>& info) {
  std::string name = info.param.fit;
  std::replace(name.begin(), name.end(), '.', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Table2_1, Refit,
                         testing::Values(Row{"isotropic.iso.C_star", 3}, Row{"isotropic.iso.phi_r", 2},
                                         Row{"isotropic.iso.P", 3}, Row{"isotropic.uni.C_star", 3},
                                         Row{"isotropic.uni.phi_r", 2, {"phi_c"}},
                                         Row{"isotropic.uni.P", 3, {"p0", "gamma_p"}},
                                         Row{"isotropic.d2.C_star", 3}, Row{"isotropic.d2.phi_r", 2},
                                         Row{"isotropic.d2.P", 3}, Row{"isotropic.d3.C_star", 3},
                                         Row{"isotropic.d3.phi_r", 2}, Row{"isotropic.d3.P", 3}),
                         name_of_row);

INSTANTIATE_TEST_SUITE_P(Table2_2, Refit,
                         testing::Values(Row{"shear.s_max", 3}, Row{"shear.beta_s", 3}, Row{"shear.F_max", 2},
                                         Row{"shear.beta_F", 2}),
                         name_of_row);

const RecordFolder& records() {
  static const RecordFolder folder = read_records(GRAINLAW_DATA_DIR "/records/base");
  return folder;
}

/// Mean over three packings, and its standard error.
struct Mean {
  double value = 0, error = 0;
  /// Whether one more packing may have this value, 19 times in 20: 4.30 is Student's t of two degrees of
  /// freedom.
  bool agrees_with(double one_packing) const { return std::abs(value - one_packing) <= 4.30 * 2 * error; }
  bool within_two_errors_of(double other) const { return std::abs(value - other) <= 2 * error; }
};

Mean mean_of(const std::vector<double>& v) {
  double mean = 0, squares = 0;
  for (const double x : v) mean += x / static_cast<double>(v.size());
  for (const double x : v) squares += (x - mean) * (x - mean);
  return {mean, std::sqrt(squares / static_cast<double>(v.size() * (v.size() - 1)))};
}

/// UNI three and ten times as fast as in the base campaign.
const RecordFolder& faster() {
  static const RecordFolder folder = read_records(GRAINLAW_DATA_DIR "/records/uni-rates");
  return folder;
}

constexpr double states = 1e-2;  ///< E_k/E_p that rows of a fit may have (Selection)
constexpr double every_row = std::numeric_limits<double>::infinity();

/// The unloading of each packing of a test: rows with E_k/E_p up to this.
std::vector<PackingSeries> unloadings(const RecordFolder& folder, const std::string& test,
                                      double Ek_over_Ep_max) {
  Selection selection;
  selection.Ek_over_Ep_max = Ek_over_Ep_max;
  std::vector<PackingSeries> packings;
  for (const TestRecord& record : folder.tests) {
    if (record.test != test) continue;
    Counted counted;
    packings.push_back(unloading_branch(record, selection, counted));
  }
  EXPECT_EQ(packings.size(), 3u);
  return packings;
}

/// A parameter of Eq. 2.14 in each packing, of states up to this volume fraction.
std::vector<double> pressure_of_each(const std::string& test, double nu_below, const std::string& parameter) {
  std::vector<double> values;
  for (PackingSeries& series : unloadings(records(), test, states)) {
    std::erase_if(series.states, [&](const PackingState& s) { return s.nu > nu_below; });
    values.push_back(fit(pressure_problem({series}, Points::rows, {})).value(parameter));
  }
  return values;
}

constexpr double near = 0.75, all = 1;  ///< volume fractions up to which Eq. 2.14 is fitted

/// How much a parameter of each packing moves where it is fitted up to nu = 0.75 only.
std::vector<double> shift_of_each(const std::string& test, const std::string& parameter) {
  std::vector<double> shift = pressure_of_each(test, near, parameter);
  const std::vector<double> whole = pressure_of_each(test, all, parameter);
  for (std::size_t i = 0; i < shift.size(); ++i) shift[i] -= whole[i];
  return shift;
}

/// The pressure of UNI in the thesis, which fits it twice (Table 3.4 at w = 3).
struct OfUni {
  const char* parameter;
  double table2_1, table3_4;
};
constexpr OfUni uni_pressure[] = {
    {"p0", 0.04006, 0.0376}, {"gamma_p", 0.0327, -0.1962}, {"nu_c", 0.6619, 0.6605}};

/// The numbers of Eq. 2.14 for UNI depend on how far up it is fitted.
TEST(UniPressure, UpTo075IsThatOfTable2_1AndNotThatOfTable3_4) {
  for (const OfUni& of : uni_pressure) {
    const Mean ours = mean_of(pressure_of_each("uni-cycle", near, of.parameter));
    EXPECT_TRUE(ours.within_two_errors_of(of.table2_1)) << of.parameter << " " << ours.value;
    EXPECT_FALSE(ours.within_two_errors_of(of.table3_4)) << of.parameter << " " << ours.value;
  }
}

TEST(UniPressure, OverAllIsThatOfTable3_4AndNotThatOfTable2_1) {
  for (const OfUni& of : uni_pressure) {
    const Mean ours = mean_of(pressure_of_each("uni-cycle", all, of.parameter));
    if (std::string(of.parameter) == "nu_c")
      EXPECT_NEAR(ours.value, of.table3_4, 5e-4);  // beyond the scatter of our packings
    else
      EXPECT_TRUE(ours.within_two_errors_of(of.table3_4)) << of.parameter << " " << ours.value;
    EXPECT_FALSE(ours.within_two_errors_of(of.table2_1)) << of.parameter << " " << ours.value;
  }
  EXPECT_FALSE(mean_of(pressure_of_each("uni-cycle", all, "p0")).agrees_with(0.04006));
}

/// Every packing is nearer to Table 2.1 where it is fitted up to 0.75 only.
TEST(UniPressure, OfEachPackingComesNearerToTable2_1) {
  for (const OfUni& of : uni_pressure) {
    const auto up_to_075 = pressure_of_each("uni-cycle", near, of.parameter);
    const auto whole = pressure_of_each("uni-cycle", all, of.parameter);
    for (std::size_t i = 0; i < whole.size(); ++i)
      EXPECT_LT(std::abs(up_to_075[i] - of.table2_1), std::abs(whole[i] - of.table2_1)) << of.parameter;
  }
}

/// The shift is 2.9 of its errors: three packings without any would show as much one time in ten (Student's
/// t, two degrees of freedom; 4.30 one time in twenty).
TEST(UniPressure, MovesByLessThanThreePackingsProve) {
  const Mean p0 = mean_of(shift_of_each("uni-cycle", "p0"));
  EXPECT_NEAR(p0.value, 0.00172, 5e-5);
  EXPECT_NEAR(p0.error, 0.00060, 5e-5);
  EXPECT_LT(p0.value, 4.30 * p0.error);
  const Mean gamma_p = mean_of(shift_of_each("uni-cycle", "gamma_p"));
  EXPECT_NEAR(gamma_p.value, 0.29, 0.005);
  EXPECT_NEAR(gamma_p.error, 0.10, 0.005);
  EXPECT_LT(gamma_p.value, 4.30 * gamma_p.error);
}

/// ISO moves less, in every packing (the same seeds), and to the same p0.
TEST(UniPressure, MovesMoreThanThatOfIso) {
  const std::vector<double> uni = shift_of_each("uni-cycle", "p0"), iso = shift_of_each("iso", "p0");
  for (std::size_t i = 0; i < uni.size(); ++i) EXPECT_GT(uni[i], 1.5 * std::abs(iso[i]));
  const Mean of_iso = mean_of(pressure_of_each("iso", all, "p0"));
  EXPECT_NEAR(of_iso.value + mean_of(iso).value, of_iso.value, 0.015 * of_iso.value);
}

using OneFit = FitResult PackingFit::*;

/// A parameter of Eq. 2.11, 2.12 or 2.14 of UNI, each packing fitted alone, from rows with E_k/E_p up to
/// this. None of them may rest on a bound: that is no estimate.
Mean row_of_table2_1(const RecordFolder& folder, const std::string& test, double Ek_over_Ep_max,
                     const std::string& parameter) {
  OneFit law = &PackingFit::contacts;
  if (parameter.starts_with("phi")) law = &PackingFit::rattlers;
  if (parameter == "p0" || parameter == "gamma_p" || parameter == "nu_c") law = &PackingFit::pressure;
  std::vector<double> values;
  for (const PackingSeries& series : unloadings(folder, test, Ek_over_Ep_max)) {
    const PackingFit packing = fit_packing({series}, Points::rows, {});
    for (const FitEstimate& estimate : packing.contacts.parameters)
      EXPECT_FALSE(estimate.at_bound) << test << " " << series.group << ": " << estimate.name;
    for (const FitEstimate& estimate : (packing.*law).parameters)
      EXPECT_FALSE(estimate.at_bound) << test << " " << series.group << ": " << estimate.name;
    values.push_back((packing.*law).value(parameter));
  }
  return mean_of(values);
}

/// Rows of the faster records with a larger E_k/E_p come from packings that fall apart, with fewer contacts
/// than bear a load: read as well, they put nu_c on its bound, the lowest volume fraction there is.
TEST(UniAtOtherRates, OfEveryRowHasNoEstimate) {
  for (const std::string test : {"uni-x3", "uni-x10"})
    for (const PackingSeries& series : unloadings(faster(), test, every_row)) {
      EXPECT_TRUE(fit(contacts_problem({series}, Points::rows, {}))["nu_c_contacts"].at_bound)
          << test << " " << series.group;
      EXPECT_LT(series.states.back().C_star, 6);
    }
}

struct Rattlers {
  double read, ours, three_times, ten_times;  ///< E_k/E_p of the rows; phi_c
};

/// phi_c grows with the rate, and with rows that move. Table 2.1 has 0.1507: more than ours whichever rows
/// are read, as much as at three times our rate with rows up to 0.05, and less than at ten times with rows up
/// to 0.02.
TEST(UniAtOtherRates, HasRattlersByTheRateAndByWhatIsRead) {
  for (const Rattlers& row :
       {Rattlers{states, 0.1341, 0.1402, 0.1442}, Rattlers{0.02, 0.1361, 0.1437, 0.1544},
        Rattlers{0.03, 0.1380, 0.1492, 0.1574}, Rattlers{0.05, 0.1380, 0.1503, 0.1617}}) {
    SCOPED_TRACE(row.read);
    const Mean ours = row_of_table2_1(records(), "uni-cycle", row.read, "phi_c");
    EXPECT_NEAR(ours.value, row.ours, 5e-4);
    EXPECT_LT(ours.value + 4 * ours.error, 0.1507);
    EXPECT_NEAR(row_of_table2_1(faster(), "uni-x3", row.read, "phi_c").value, row.three_times, 5e-4);
    EXPECT_NEAR(row_of_table2_1(faster(), "uni-x10", row.read, "phi_c").value, row.ten_times, 5e-4);
  }
}

/// Those of Table 2.1 at three times our rate, whichever rows are read; at ours they are too few, at ten
/// times too many.
TEST(UniAtThreeTimesOurRate, HasTheContactsOfTable2_1) {
  for (const double read : {states, 0.02, 0.03, 0.05})
    for (const auto& [parameter, of_table] : {std::pair{"C1", 8.370}, {"alpha", 0.5998}}) {
      SCOPED_TRACE(std::string(parameter) + ", E_k/E_p up to " + std::to_string(read));
      const Mean ours = row_of_table2_1(records(), "uni-cycle", read, parameter);
      EXPECT_LT(ours.value + 4 * ours.error, of_table);
      EXPECT_TRUE(row_of_table2_1(faster(), "uni-x3", read, parameter).within_two_errors_of(of_table));
      const Mean ten_times = row_of_table2_1(faster(), "uni-x10", read, parameter);
      EXPECT_GT(ten_times.value - 4 * ten_times.error, of_table);
    }
}

constexpr double moving = 0.05;

/// With rows up to an E_k/E_p of 0.05, phi_c; with states alone, phi_v. Never both, nor nu_c.
TEST(UniAtThreeTimesOurRate, HasEitherOfTheRattlerNumbersOfTable2_1) {
  const auto of = [](const std::string& parameter, double read) {
    return row_of_table2_1(faster(), "uni-x3", read, parameter);
  };
  constexpr double phi_c = 0.1507, phi_v = 15.6835;
  EXPECT_TRUE(of("phi_c", moving).within_two_errors_of(phi_c)) << of("phi_c", moving).value;
  EXPECT_FALSE(of("phi_v", moving).within_two_errors_of(phi_v)) << of("phi_v", moving).value;
  EXPECT_TRUE(of("phi_v", moving).agrees_with(phi_v)) << of("phi_v", moving).value;
  EXPECT_FALSE(of("phi_c", states).within_two_errors_of(phi_c)) << of("phi_c", states).value;
  EXPECT_TRUE(of("phi_v", states).within_two_errors_of(phi_v)) << of("phi_v", states).value;
  EXPECT_NEAR(of("nu_c_contacts", moving).value, 0.6625, 5e-4);
  for (const double read : {states, moving})
    EXPECT_FALSE(of("nu_c_contacts", read).within_two_errors_of(0.6625)) << read;
  const Mean ten_times = row_of_table2_1(faster(), "uni-x10", moving, "phi_c");
  EXPECT_GT(ten_times.value - 4 * ten_times.error, phi_c);
}

TEST(UniAtThreeTimesOurRate, HasThePressureOfTable3_4) {
  for (const OfUni& of : uni_pressure) {
    const Mean ours = row_of_table2_1(faster(), "uni-x3", moving, of.parameter);
    EXPECT_TRUE(ours.within_two_errors_of(of.table3_4)) << of.parameter << " " << ours.value;
  }
  for (const auto& [folder, test] : {std::pair{&records(), "uni-cycle"}, {&faster(), "uni-x10"}})
    EXPECT_FALSE(row_of_table2_1(*folder, test, moving, "nu_c").within_two_errors_of(0.6605)) << test;
}

/// A quantity at a volume fraction of the unloading, between the rows about it.
double on_unloading(const std::string& dir, const std::string& quantity, double nu) {
  const Record record =
      Record::read_csv(GRAINLAW_DATA_DIR "/records/" + dir + "/record.csv", {"segment", "nu", quantity});
  const auto &segment = record["segment"], &density = record["nu"], &value = record[quantity];
  for (std::size_t k = 1; k < density.size(); ++k)
    if (segment[k - 1] == 1 && density[k - 1] >= nu && density[k] < nu)
      return value[k] + (value[k - 1] - value[k]) * (nu - density[k]) / (density[k - 1] - density[k]);
  throw std::runtime_error(dir + " does not pass nu = " + std::to_string(nu));
}

/// Three times as fast, three packings have the means of the base campaign within two combined errors; a
/// third as fast, one packing is where one more of the base campaign would be, 19 times in 20 (Student's t,
/// two degrees of freedom).
TEST(IsoAtOtherRates, HasThePressureAndContactsOfTheBaseCampaign) {
  for (const std::string quantity : {"P", "C_star"})
    for (const double nu : {0.67, 0.68, 0.70, 0.72, 0.75, 0.80}) {
      SCOPED_TRACE(quantity + " at " + std::to_string(nu));
      std::vector<double> base, fast;
      for (const std::string seed : {"1", "2", "3"}) {
        base.push_back(on_unloading("base/records/iso-s" + seed, quantity, nu));
        fast.push_back(on_unloading("iso-rates/records/iso-x3-s" + seed, quantity, nu));
      }
      const Mean ours = mean_of(base), faster = mean_of(fast);
      EXPECT_LT(std::abs(faster.value - ours.value), 2 * std::hypot(faster.error, ours.error));
      EXPECT_TRUE(ours.agrees_with(on_unloading("iso-rates/records/iso-slow-s1", quantity, nu)));
    }
}

/// Mean over the densities of ours over the thesis's, per packing, of the rates of D2 fitted up to a strain,
/// with the value at the start free or as measured in the first row.
Mean rate_over_thesis(const std::string& quantity, double up_to, bool measured_start) {
  std::vector<std::vector<double>> ratios(3);
  for (const TestRecord& record : records().tests) {
    if (record.mode != "d2" || record.role != Role::fit) continue;
    Counted counted;
    ShearCurve curve = first_loading(record, quantity, {}, counted);
    const auto rows = static_cast<std::size_t>(
        std::upper_bound(curve.strain.begin(), curve.strain.end(), up_to + 1e-9) - curve.strain.begin());
    curve.strain.resize(rows);
    curve.value.resize(rows);
    FitProblem problem = approach_problem(curve);
    if (measured_start) {
      problem.parameters[1].initial = curve.value.front();
      problem.parameters[1].held = true;
    }
    const double x = curve.nu / 0.6653 - 1;
    const double thesis =
        quantity == "s_dev" ? 30.76 + 57.00 * std::exp(-16.86 * x) : 57.89 * std::exp(-5.366 * x);
    ratios[std::stoul(record.seed) - 1].push_back(fit(problem).value("beta") / thesis);
  }
  std::vector<double> packings;
  for (const auto& of_packing : ratios) {
    EXPECT_EQ(of_packing.size(), 8u);
    packings.push_back(mean_of(of_packing).value);
  }
  return mean_of(packings);
}

/// A rate depends on how far the exponential is fitted, since s_dev goes through a maximum (Section 2.6.2.1),
/// and on the value at the start. The thesis prints neither choice.
TEST(ShearRates, DependOnTheRangeOfStrainAndOnTheStart) {
  EXPECT_NEAR(rate_over_thesis("s_dev", 1, false).value, 1.103, 0.001);
  EXPECT_NEAR(rate_over_thesis("s_dev", 0.3, true).value, 1.011, 0.001);
  EXPECT_NEAR(rate_over_thesis("s_dev", 0.2, true).value, 0.941, 0.001);
  EXPECT_NEAR(rate_over_thesis("F_dev", 1, false).value, 1.265, 0.001);
  EXPECT_NEAR(rate_over_thesis("F_dev", 0.3, true).value, 1.128, 0.001);
  EXPECT_NEAR(rate_over_thesis("F_dev", 0.2, true).value, 1.028, 0.001);
}

}  // namespace
}  // namespace grainlaw::calibrate
