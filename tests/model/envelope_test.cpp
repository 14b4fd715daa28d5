// Response envelopes: moduli in their axes, elastic and plastic sides, and a state that is left alone.
#include "grainlaw/model/envelope.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "grainlaw/model/start.hpp"
#include "walks.hpp"

namespace grainlaw::model {
namespace {

constexpr Tolerance tight{tight_rtol, 1e-17};

struct Sheared {
  Law law;
  State state;
};
Sheared after(const std::string& segments, Form form) {
  const std::string text = R"({"start": {"nu": 0.711}, "segments": [)" + segments + "]}";
  return {start_of(thesis(), path_of(text), {form, {}}).law, walk(text, form, 1).end};
}

TEST(Envelope, IsTheModuliInTheirAxes) {
  // After shear to eps_dev = 0.05 and a rest: Eq. 4.16 is elastic in both directions, [dP, dsigma] = [[B,
  // A1], [A2, G]] [d ln nu, d eps_dev].
  const Sheared sheared = after(R"({"mode": "d2", "amount": 0.05}, {"mode": "relax"})", Form::coupled);
  const double size = 1e-7;
  const Envelope e = envelope(sheared.law, sheared.state, tight, size, 8);
  ASSERT_FALSE(e.status.failed()) << e.status.message;
  ASSERT_EQ(e.responses.rows(), 8U);
  EXPECT_EQ(e.responses.columns(), envelope_columns());
  const Laws& laws = laws_of(sheared.law);
  const double B = bulk_modulus(laws.moduli, laws.contacts, 0.711), F = sheared.state.F_dev;
  const double ini = initial_shear_ratio(laws.moduli, isotropic_fabric(laws.contacts, laws.g3, 0.711));
  const double G = shear_modulus(laws.moduli, B, ini, sheared.state.sigma_dev, F);
  for (std::size_t i = 0; i < 8; ++i) {
    const double v = e.responses["eps_vol"][i], s = e.responses["eps_dev"][i];
    EXPECT_EQ(e.responses["direction"][i], 45.0 * static_cast<double>(i));
    EXPECT_NEAR(std::hypot(v, s), size, 1e-15);
    EXPECT_NEAR(e.responses["dP"][i], B * v + 0.66 * B * F * s, 2e-5 * size * B);
    EXPECT_NEAR(e.responses["dsigma_dev"][i], B * F * v + G * s, 2e-5 * size * B);
    EXPECT_EQ(e.responses["P"][i], sheared.state.P + e.responses["dP"][i]);
  }
}

TEST(Envelope, IsStifferBackwardsThanForwards) {
  for (const Form form : {Form::reduced_closed, Form::reduced, Form::coupled, Form::coupled_3_14}) {
    const Sheared sheared = after(R"({"mode": "d2", "amount": 0.05})", form);
    const Envelope e = envelope(sheared.law, sheared.state, tight, 1e-5, 4);
    ASSERT_EQ(e.responses.rows(), 4U);
    const auto& d = e.responses["dsigma_dev"];
    EXPECT_GT(d[1], 0);
    EXPECT_LT(d[3], -1.5 * d[1]) << name_of(form);
    EXPECT_EQ(e.responses["dF_dev"][0], form == Form::coupled_3_14 ? e.responses["dF_dev"][0] : 0);
  }
}

TEST(Envelope, EveryDirectionBeginsInTheSameState) {
  for (const Form form : {Form::reduced_closed, Form::coupled}) {
    const Sheared sheared = after(R"({"mode": "d2", "amount": 0.03})", form);
    const Envelope few = envelope(sheared.law, sheared.state, tight, 1e-3, 4),
                   many = envelope(sheared.law, sheared.state, tight, 1e-3, 12);
    for (const auto& column : envelope_columns())
      for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(few.responses[column][i], many.responses[column][3 * i]);
  }
}

TEST(Envelope, WhereContactIsLostThereIsNoStress) {
  const Sheared loose = after(R"({"mode": "iso", "controls": {"nu": 0.67}})", Form::reduced);
  const Envelope e = envelope(loose.law, loose.state, tight, 0.05, 2);
  ASSERT_EQ(e.responses.rows(), 2U);
  EXPECT_GT(e.responses["P"][0], loose.state.P);
  EXPECT_EQ(e.responses["P"][1], 0);
}

}  // namespace
}  // namespace grainlaw::model
