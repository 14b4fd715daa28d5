// Segments of a path as two quantities of the law: modes under stress control, mixes of axes, conditions that
// end a segment, and what cannot be followed.
#include "grainlaw/model/walk/path_control.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "walks.hpp"

namespace grainlaw::model {
namespace {

using testing::HasSubstr;

constexpr Form forms[] = {Form::reduced_closed, Form::reduced, Form::coupled};

Prediction from_711(const std::string& segments, Form form = Form::coupled, int rows = 20) {
  return walk(R"({"start": {"nu": 0.711}, "segments": [)" + segments + "]}", form, rows);
}
std::string refused(const std::string& segments) {
  return refusal([&] { from_711(segments); });
}

void expect_same(const Prediction& a, const Prediction& b, double tolerance = 1e-10) {
  for (const char* column : {"nu", "eps_dev", "P", "sigma_dev", "F_dev"})
    EXPECT_LT(difference(a, b, column), tolerance) << column;
}

TEST(PathControl, ModesAreMixesOfTheirAxes) {
  for (const Form form : forms) {
    expect_same(
        from_711(R"({"mode": "triaxial", "amount": 0.05})", form),
        from_711(
            R"({"mode": "control", "x": {"stress": "start"}, "y": {"stress": "start"}, "z": {"strain": 0.05}})",
            form));
    expect_same(
        from_711(R"({"mode": "d2", "amount": 0.01}, {"mode": "biaxial", "amount": 0.05})", form),
        from_711(
            R"({"mode": "d2", "amount": 0.01}, {"mode": "control", "x": {"stress": "start"}, "y": {"strain": 0.05}, "z": {"strain": 0}})",
            form));
    expect_same(
        from_711(R"({"mode": "constant_p", "shear": "d3", "amount": 0.06, "P": 0.03})", form),
        from_711(
            R"({"mode": "control", "x": {"strain": -0.02}, "y": {"strain": -0.02}, "z": {"strain": 0.04}, "P": 0.03})",
            form));
    expect_same(
        from_711(R"({"mode": "isotropic_stress", "P": 0.03})", form),
        from_711(
            R"({"mode": "control", "x": {"stress": 0.03}, "y": {"stress": 0.03}, "z": {"stress": 0.03}})",
            form));
  }
}

TEST(PathControl, ShearAtConstantPressureAlongAnyAxis) {
  // Pure shear of xy by e is that of D2 by sqrt(3) e, in a frame turned by 45 degrees.
  for (const Form form : forms)
    expect_same(
        from_711(
            R"({"mode": "constant_p", "amount": 0.1, "P": 0.03}, {"mode": "constant_p", "amount": -0.05})",
            form),
        from_711(
            R"({"mode": "control", "x": {"strain": 0}, "y": {"strain": 0}, "z": {"strain": 0}, "xy": {"strain": )" +
                to_text(-0.1 / std::sqrt(3.0)) +
                R"(}, "P": 0.03}, {"mode": "control", "x": {"strain": 0}, "y": {"strain": 0}, "z": {"strain": 0},
                 "xy": {"strain": )" +
                to_text(0.05 / std::sqrt(3.0)) + R"(}, "P": "start"})",
            form));
}

TEST(PathControl, ShearStressesAreRefused) {
  const auto control = [](const std::string& y, const std::string& more) {
    return refused(R"({"mode": "control", "x": {"strain": 0}, "y": )" + y + R"(, "z": {"strain": 0}, )" +
                   more + "}");
  };
  const std::string why = ": cannot be followed by the law, which has one direction of shear: ";
  EXPECT_THAT(control(R"({"strain": 0.01})", R"("xy": {"stress": 0})"),
              HasSubstr("p.json: segments[0].xy" + why + "it has no shear stress as a target"));
  EXPECT_THAT(control(R"({"strain": 0})", R"("xz": {"stress": "start"}, "P": 0.03)"),
              HasSubstr("p.json: segments[0].xz" + why + "it has no shear stress as a target"));
  EXPECT_THAT(control(R"({"stress": 0.03})", R"("yz": {"strain": 0.01})"),
              HasSubstr("p.json: segments[0].yz" + why + "stresses on axes do not go with a shear strain"));
}

TEST(PathControl, SimpleShearIsRefused) {
  const std::string why = "segments[0].mode: must not be simple_shear: its axes of strain turn";
  EXPECT_THAT(refused(R"({"mode": "simple_shear", "amount": 0.1})"), HasSubstr(why));
  EXPECT_THAT(refused(R"({"mode": "simple_shear", "amount": 0.1}, {"mode": "constant_p", "amount": 0.1})"),
              HasSubstr(why));
}

TEST(PathControl, ThreeStressesAreAPressureAndADeviator) {
  for (const Form form : forms) {
    // 0.024 = 0.025 - 0.003/3, 0.027 = 0.025 + 0.003 2/3
    expect_same(
        from_711(R"({"mode": "d3", "controls": {"P": 0.025, "sigma_dev": 0.003}})", form),
        from_711(
            R"({"mode": "control", "x": {"stress": 0.024}, "y": {"stress": 0.024}, "z": {"stress": 0.027}})",
            form));
    const Prediction z = from_711(
        R"({"mode": "uni", "amount": 0.01}, {"mode": "control", "x": {"stress": "start"}, "y": {"stress": "start"}, "z": {"stress": 0.03}})",
        form);
    ASSERT_EQ(z.status.code, Status::Code::ok) << z.status.message;
    const auto &P = z.record["P"], &sigma = z.record["sigma_dev"];
    EXPECT_NEAR(P[40] - sigma[40] / 3, P[20] - sigma[20] / 3, 1e-10);
    EXPECT_NEAR(P[40] + sigma[40] * 2 / 3, 0.03, 1e-10);
  }
}

TEST(PathControl, AStrainOfTheSidesUnderAStressOfTheAxis) {
  // Axial stress kept while the sides are compressed: eps_vol = eps_z + 2 eps_x, eps_dev = eps_z - eps_x.
  const Prediction p = from_711(
      R"({"mode": "d3", "amount": 0.02}, {"mode": "control", "x": {"strain": 0.01}, "y": {"strain": 0.01}, "z": {"stress": "start"}})");
  ASSERT_EQ(p.status.code, Status::Code::ok) << p.status.message;
  const double v = last(p, "eps_vol"), e = last(p, "eps_dev") - 0.02;
  EXPECT_NEAR((v - e) / 3, 0.01, 1e-10);
  const auto &P = p.record["P"], &sigma = p.record["sigma_dev"];
  for (std::size_t i = 20; i <= 40; ++i)
    EXPECT_NEAR(P[i] + sigma[i] * 2 / 3, P[20] + sigma[20] * 2 / 3, 1e-10);
}

TEST(PathControl, WhatIsNotAlongTheAxisIsRefused) {
  EXPECT_THAT(
      refused(
          R"({"mode": "uni", "amount": 0.01}, {"mode": "control", "x": {"stress": 0.02}, "y": {"stress": 0.03}, "z": {"strain": 0.01}})"),
      HasSubstr("p.json: segments[1]: cannot be followed by the law, which has one direction of shear: "
                "the stresses on x and y must be the same"));
  EXPECT_THAT(
      refused(
          R"({"mode": "d2", "amount": 0.01}, {"mode": "control", "x": {"stress": 0.02}, "y": {"strain": 0.01}, "z": {"stress": 0.02}})"),
      HasSubstr("segments[1]: cannot be followed"));
  EXPECT_THAT(
      refused(
          R"({"mode": "control", "x": {"stress": "start"}, "y": {"strain": 0.01}, "z": {"strain": 0.02}})"),
      HasSubstr("segments[0]: cannot be followed"));
  EXPECT_THAT(
      refused(R"({"mode": "control", "x": {"stress": 0.02}, "y": {"stress": 0.03}, "z": {"stress": 0.04}})"),
      HasSubstr("segments[0]: cannot be followed"));
  EXPECT_THAT(refused(R"({"mode": "d2", "amount": 0.1}, {"mode": "triaxial", "amount": 0.1})"),
              HasSubstr("segments[1]: mode triaxial is not coaxial with d2"));
  EXPECT_THAT(
      refused(
          R"({"mode": "d2", "controls": {"P": "start", "sigma_dev": 0.001}}, {"mode": "uni", "controls": {"P": "start", "eps_dev": 0.1}})"),
      HasSubstr("segments[1]: mode uni is not coaxial with d2"));
}

TEST(PathControl, StrainAfterStressGoesOnFromWhereItEnded) {
  for (const Form form : forms) {
    const Prediction p = from_711(
        R"({"mode": "isotropic_stress", "P": 0.05}, {"mode": "d2", "controls": {"eps_dev": 0.1}}, {"mode": "relax"}, {"mode": "iso", "controls": {"nu": 0.74}})",
        form, 5);
    ASSERT_EQ(p.status.code, Status::Code::ok) << p.status.message;
    ASSERT_EQ(p.record.rows(), 1U + 5 + 5 + 1 + 5);
    EXPECT_NEAR(p.record["P"][5], 0.05, 1e-10);
    EXPECT_EQ(p.record["nu"][10], p.record["nu"][5]);
    EXPECT_NEAR(p.record["eps_dev"][10], 0.1, 1e-14);
    EXPECT_NEAR(last(p, "nu"), 0.74, 1e-14);
  }
}

TEST(PathControl, StrainTargetsAfterStressAreThereOrNot) {
  const Prediction there =
      from_711(R"({"mode": "constant_p", "amount": 0.1}, {"mode": "d2", "controls": {"eps_dev": 0.1}})",
               Form::coupled, 5);
  ASSERT_EQ(there.status.code, Status::Code::ok) << there.status.message;
  ASSERT_EQ(there.record.rows(), 11U);
  for (const char* column : {"eps_dev", "P", "sigma_dev"})
    EXPECT_NEAR(last(there, column), there.record[column][5], 1e-14) << column;
  const Prediction far =
      from_711(R"({"mode": "constant_p", "amount": 0.1}, {"mode": "iso", "amount": 1})", Form::reduced, 5);
  EXPECT_TRUE(far.status.failed());
  EXPECT_THAT(far.status.message, HasSubstr("segments[1]: takes the volume fraction to"));
  EXPECT_EQ(far.record.rows(), 6U);
}

TEST(PathControl, PumpedPressureIsToldOfUndrainedStressCycles) {
  ParameterSet set = thesis();
  set.shear->beta_F->Q_v.value = 114;
  const Prediction p = walk(
      R"({"start": {"nu": 0.711}, "segments": [{"mode": "d2", "controls": {"eps_vol": "start", "eps_dev": 0.4}},
      {"mode": "d2", "controls": {"eps_vol": "start", "eps_dev": -0.4}}, {"mode": "d2", "controls": {"eps_vol": "start", "eps_dev": 0.4}}]})",
      Form::coupled, 1, set);
  ASSERT_EQ(p.warnings.size(), 1U);
  EXPECT_THAT(p.warnings[0], HasSubstr("of P per half cycle"));
}

std::string stopping(const std::string& segment, const std::string& column, const std::string& way) {
  return segment + R"(, "stop": {"column": ")" + column + "\", " + way + "}}";
}

TEST(Stop, EndsExactlyWhereTheColumnPassesTheValue) {
  const double s_max = 0.1137 + 0.09166 * std::exp(-7.916 * (0.711 / 0.6653 - 1)),
               beta = 30.76 + 57 * std::exp(-16.86 * (0.711 / 0.6653 - 1));
  for (const Form form : forms) {
    const Prediction p =
        from_711(stopping(R"({"mode": "d2", "amount": 0.4)", "s_dev", R"("above": 0.15)") + "," +
                     stopping(R"({"mode": "d2", "amount": -0.4)", "s_dev", R"("below": -0.15)") + "," +
                     R"({"mode": "d2", "controls": {"eps_dev": 0.1}})",
                 form, 10);
    ASSERT_EQ(p.status.code, Status::Code::ok) << p.status.message;
    std::vector<std::size_t> ends;
    for (std::size_t i = 0; i + 1 < p.record.rows(); ++i)
      if (p.record["segment"][i] != p.record["segment"][i + 1]) ends.push_back(i);
    ASSERT_EQ(ends.size(), 2U);
    EXPECT_NEAR(p.record["s_dev"][ends[0]], 0.15, 1e-12);
    EXPECT_NEAR(p.record["s_dev"][ends[1]], -0.15, 1e-12);
    if (form != Form::coupled) {
      EXPECT_NEAR(p.record["eps_dev"][ends[0]], -std::log(1 - 0.15 / s_max) / beta, 1e-9);
    }
    EXPECT_NEAR(last(p, "eps_dev"), 0.1, 1e-14);
    EXPECT_TRUE(p.warnings.empty());
  }
}

TEST(Stop, OnEveryColumn) {
  struct Case {
    const char *segment, *column, *way;
    double value;
  };
  const Case cases[] = {{R"({"mode": "uni", "amount": 0.1)", "eps_vol", R"("above": 0.03)", 0.03},
                        {R"({"mode": "uni", "amount": 0.1)", "eps_dev", R"("above": 0.03)", 0.03},
                        {R"({"mode": "iso", "amount": -0.05)", "nu", R"("below": 0.7)", 0.7},
                        {R"({"mode": "iso", "amount": -0.05)", "P", R"("below": 0.01)", 0.01},
                        {R"({"mode": "d2", "amount": 0.2)", "sigma_dev", R"("above": 0.003)", 0.003},
                        {R"({"mode": "constant_p", "amount": 0.2)", "s_dev", R"("above": 0.1)", 0.1},
                        {R"({"mode": "iso", "amount": 0.1)", "F_v", R"("above": 7)", 7},
                        {R"({"mode": "triaxial", "amount": -0.2)", "F_dev", R"("below": -0.1)", -0.1},
                        {R"({"mode": "iso", "amount": 0.1)", "C", R"("above": 8)", 8},
                        {R"({"mode": "iso", "amount": 0.1)", "C_star", R"("above": 8.5)", 8.5},
                        {R"({"mode": "iso", "amount": 0.1)", "f_NR", R"("above": 0.97)", 0.97}};
  for (const Form form : forms)
    for (const Case& c : cases) {
      SCOPED_TRACE(name_of(form) + " " + c.column);
      const Prediction p = from_711(stopping(c.segment, c.column, c.way), form, 10);
      ASSERT_EQ(p.status.code, Status::Code::ok) << p.status.message;
      EXPECT_NEAR(last(p, c.column), c.value, 1e-11);
      EXPECT_LT(p.record.rows(), 11U);
    }
}

TEST(Stop, WhereThePointIsUnjammedAndWhereItJams) {
  for (const Form form : forms) {
    const std::string start = R"({"start": {"nu": 0.64}, "segments": [)";
    const Prediction loose =
        walk(start + stopping(R"({"mode": "uni", "amount": 0.1)", "nu", R"("above": 0.65)") + "]}", form);
    EXPECT_NEAR(last(loose, "nu"), 0.65, 1e-14);
    EXPECT_EQ(loose.status.code, Status::Code::unjammed);
    const Prediction first =
        walk(start + stopping(R"({"mode": "uni", "amount": 0.1)", "P", R"("above": 1e-5)") + "]}", form);
    ASSERT_EQ(first.status.code, Status::Code::ok) << first.status.message;
    EXPECT_NEAR(last(first, "P"), 1e-5, 1e-12);
    EXPECT_GT(last(first, "nu"), 0.6649);
    const Prediction lost =
        from_711(stopping(R"({"mode": "uni", "amount": -0.1)", "P", R"("below": 0)"), form);
    EXPECT_EQ(lost.status.code, Status::Code::unjammed);
    EXPECT_EQ(last(lost, "P"), 0);
    EXPECT_GT(last(lost, "eps_vol"), -0.08);
  }
}

TEST(Stop, SaysWhereItDoesNotOrAtOnce) {
  const Prediction never =
      from_711(stopping(R"({"mode": "d2", "amount": 0.1)", "s_dev", R"("above": 0.3)"), Form::coupled, 5);
  EXPECT_EQ(never.record.rows(), 6U);
  ASSERT_EQ(never.warnings.size(), 1U);
  EXPECT_THAT(never.warnings[0],
              HasSubstr("segments[0]: does not stop before its end: s_dev stays below 0.3"));
  const Prediction once =
      from_711(stopping(R"({"mode": "d2", "amount": 0.1)", "P", R"("above": 0.01)"), Form::coupled, 5);
  EXPECT_EQ(once.record.rows(), 2U);
  EXPECT_EQ(last(once, "eps_dev"), 0);
  ASSERT_EQ(once.warnings.size(), 1U);
  EXPECT_THAT(once.warnings[0], HasSubstr("segments[0]: stops where it begins"));
}

TEST(Stop, AStoppedWalkIsTheWalkToThere) {
  for (const Form form : forms) {
    const Prediction stopped =
        from_711(stopping(R"({"mode": "uni", "amount": 0.1)", "eps_vol", R"("above": 0.04)"), form, 1);
    const Prediction whole = from_711(R"({"mode": "uni", "amount": 0.04})", form, 1);
    expect_same(stopped, whole);
  }
}

}  // namespace
}  // namespace grainlaw::model
