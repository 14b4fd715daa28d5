// Dual numbers: every operation against its difference quotient, and the edges where a derivative is
// infinite.
#include "grainlaw/model/walk/dual.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "checks.hpp"

namespace grainlaw::model {
namespace {

using D = Dual<2>;

TEST(Dual, SlopesOfEveryOperation) {
  struct Case {
    const char* name;
    std::function<D(D, D)> f;
  };
  const Case cases[] = {
      {"sum", [](D x, D y) { return (x + y) * (2 + x) * (y + 3) * x; }},
      {"difference", [](D x, D y) { return (x - y) * (2 - x) * (y - 3) * -x; }},
      {"product", [](D x, D y) { return x * y * (2 * x) * (y * 3); }},
      {"quotient", [](D x, D y) { return x / y / (2 / x) / (y / 3); }},
      {"exp", [](D x, D y) { return exp(x * y); }},
      {"expm1", [](D x, D y) { return expm1(x * y); }},
      {"log", [](D x, D y) { return log(x * x * y); }},
      {"pow", [](D x, D y) { return pow(x, y) + pow(x * y, 0.3); }},
      {"abs", [](D x, D y) { return abs(-x * y) + abs(x * x * y); }},
      {"assignment",
       [](D x, D y) {
         D z = x * x;
         z += y * y;
         z -= x;
         z *= y;
         z /= x;
         return z;
       }},
  };
  const double x = 0.7, y = 1.3;
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name);
    const D both = c.f(D(x, 0), D(y, 1));
    if (c.name != std::string("abs"))  // linear in y
      expect_v_shape([&](double a) { return c.f(D(x), D(a)).value; }, y, both.slope[1], 1);
    expect_v_shape([&](double a) { return c.f(D(a), D(y)).value; }, x, both.slope[0], 1);
  }
}

TEST(Dual, OfDualsGivesSecondDerivatives) {
  // f = x^2 exp(x y) / y at (0.7, 1.3): f_xy by hand.
  using DD = Dual<1, Dual<1>>;
  const double x = 0.7, y = 1.3;
  const DD a(Dual<1>(x), 0), b(Dual<1>(y, 0));
  const DD f = a * a * exp(a * b) / b;
  const double e = std::exp(x * y), f_x = (2 * x + x * x * y) * e / y;
  EXPECT_NEAR(f.slope[0].value, f_x, 1e-15);
  EXPECT_NEAR(f.slope[0].slope[0], f_x * (x - 1 / y) + x * x * e / y, 1e-14);
}

TEST(Dual, InfiniteSlopesOfPowersAtZeroMeetOnlyWhatMoves) {
  const D still = pow(D(0.0), D(0.5, 1));
  EXPECT_EQ(still.value, 0);
  EXPECT_EQ(still.slope, (std::array<double, 2>{0, 0}));
  EXPECT_EQ(pow(D(0.0, 0), D(0.5)).slope[0], std::numeric_limits<double>::infinity());
  EXPECT_EQ(pow(D(0.0, 0), D(2.0)).slope[0], 0);
}

TEST(Dual, ComparesByValue) {
  EXPECT_TRUE(D(1.0, 0) == D(1.0, 1));
  EXPECT_TRUE(D(1.0, 0) < 2.0);
  EXPECT_TRUE(3.0 > D(2.0, 1));
  EXPECT_FALSE(D(std::nan("")) > 0);
}

}  // namespace
}  // namespace grainlaw::model
