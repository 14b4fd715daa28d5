// Eq. 3.14: an independent integration, what sets it apart from Eq. 4.16, and its Jacobian.
#include "grainlaw/model/forms/coupled_3_14.hpp"

#include <gtest/gtest.h>

#include "grainlaw/model/forms/law.hpp"
#include "walks.hpp"
#include "written.hpp"

namespace grainlaw::model {
namespace {

/// Over F_dev in place of A, which is 0.66 B F_dev.
struct Written314 : Tables {
  void begin(const Vector&) {}
  void operator()(const Vector& y, Vector& dy, double t) const {
    const double n = nu(t), B = bulk(n), A = 0.66 * B * y[2], S = 1 - q() * y[1] / y[0] / s_max(n);
    dy[0] = B * v + A * S * e;
    dy[1] = A * v + B * shear_ratio(n, y[1], y[2]) * S * e;
    // dA = beta (q A_max - A)|d eps_dev|, and A is constant over volume: F_dev goes with 1/B.
    const double h = 1e-5, slope = std::log(bulk(n * std::exp(h)) / bulk(n * std::exp(-h))) / (2 * h);
    dy[2] = beta_F(n) * (q() * F_max(n) - y[2]) * std::abs(e) - y[2] * slope * v;
  }
};

TEST(Coupled314, AgainstAnIndependentIntegrationOfTheD2Cycle) {
  const Prediction p = walk(R"({"start": {"nu": 0.711}, "segments": [
    {"mode": "d2", "controls": {"eps_dev": 0.4}}, {"mode": "d2", "controls": {"eps_dev": -0.4}}]})",
                            Form::coupled_3_14);
  expect_agreement<Written314>(0.711, {p.record["P"][0], 0, 0}, {{0, 0.4}, {0, -0.8}}, p, 20);
}

TEST(Coupled314, AgainstAnIndependentIntegrationOfUniaxialLoadingAndUnloading) {
  const Prediction p =
      walk(R"({"start": {"nu": 0.69, "P": 0.012, "sigma_dev": -0.001, "F_dev": 0.03}, "segments": [
      {"mode": "uni", "amount": 0.12}, {"mode": "uni", "amount": -0.08}]})",
           Form::coupled_3_14);
  expect_agreement<Written314>(0.69, {0.012, -0.001, 0.03}, {{0.12, 0.12}, {-0.08, -0.08}}, p, 20);
}

TEST(Coupled314, IsEquation4_16OnFirstLoadingAtConstantVolume) {
  const auto loaded = [](Form form) {
    return walk(R"({"start": {"nu": 0.711}, "segments": [{"mode": "d2", "amount": 0.2}]})", form);
  };
  const Prediction earlier = loaded(Form::coupled_3_14), later = loaded(Form::coupled);
  for (const char* column : {"P", "sigma_dev", "F_dev"})  // A = A1, S_I = 1: the two are one at constant nu
    EXPECT_LT(difference(earlier, later, column), 1e-9) << column;
}

/// From saturation S = 2 after a reversal, not 1: twice as stiff as elastic.
TEST(Coupled314, ForgetsWhereADirectionBegan) {
  const Prediction p = walk(R"({"start": {"nu": 0.711}, "segments": [
    {"mode": "d2", "amount": 0.4}, {"mode": "d2", "amount": -1e-7}]})",
                            Form::coupled_3_14, 1);
  const auto &sigma = p.record["sigma_dev"], &F = p.record["F_dev"];
  const double G = Tables::bulk(0.711) * Tables::shear_ratio(0.711, sigma[1], F[1]);
  EXPECT_NEAR((sigma[2] - sigma[1]) / -1e-7, 2 * G, 2e-3 * G);
  EXPECT_NEAR((F[2] - F[1]) / -1e-7, 2 * Tables::beta_F(0.711) * Tables::F_max(0.711), 1e-2);
}

TEST(Coupled314, FabricFallsWhereBRises) {
  const Prediction p =
      walk(R"({"start": {"nu": 0.7, "F_dev": 0.1}, "segments": [{"mode": "iso", "amount": 0.1}]})",
           Form::coupled_3_14);
  EXPECT_NEAR(last(p, "F_dev"), 0.1 * Tables::bulk(0.7) / Tables::bulk(0.7 * std::exp(0.1)), 1e-12);
}

TEST(Coupled314, Jacobian) {
  const Coupled314 law{{laws_of(thesis(), Form::coupled_3_14)}};
  const Stretch stretch{0.7, 0.1, -0.3};
  const Direction direction{.q = -1, .S_I = 1.7, .S_F_I = 1.9};
  const std::array<double, 3> y{0.02, 0.0012, 0.02}, size{0.01, 0.001, 0.01};
  std::array<double, 9> J{};
  ASSERT_TRUE(jacobian_of(law, stretch, direction, 0.4, y.data(), J.data()));
  for (std::size_t j = 0; j < 3; ++j)
    for (std::size_t i = 0; i < 3; ++i) {
      const auto f = rate_by(law, stretch, direction, 0.4, y, i, j);
      if ((j == 0 && i < 2) || (j == 1 && i == 1))
        expect_v_shape(f, y[j], J[i + 3 * j], size[j]);
      else
        EXPECT_NEAR((f(y[j] + size[j]) - f(y[j])) / size[j], J[i + 3 * j], 1e-11) << i << j;
    }
}

TEST(Coupled314, NeedsAnAnisotropyModulus) {
  ParameterSet set = thesis();
  set.moduli->a_I.value = 0;
  EXPECT_NE(refusal([&] { laws_of(set, Form::coupled_3_14); }).find("moduli.a_I.value: must not be 0"),
            std::string::npos);
}

}  // namespace
}  // namespace grainlaw::model
