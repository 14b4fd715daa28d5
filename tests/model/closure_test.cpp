// The closure picks rows as it says, and names what is missing.
#include "grainlaw/model/closure.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "checks.hpp"

namespace grainlaw::model {
namespace {

using testing::HasSubstr;

TEST(Closure, TakesPressureAndContactsFromTheirRows) {
  const Laws laws = laws_of(thesis(), Form::coupled);
  EXPECT_EQ(laws.pressure.p0, 0.04172);  // iso
  EXPECT_EQ(laws.contacts.C1, 7.9219);   // d2
  EXPECT_EQ(laws.contacts.nu_c, 0.658);  // moduli
  EXPECT_NEAR(isotropic_fabric(laws.contacts, laws.g3, 0.711), 6.534, 5e-4);
  EXPECT_NEAR(bulk_modulus(laws.moduli, laws.contacts, 0.711), 0.4279, 5e-5);
}

TEST(Closure, RowKeepsTheRowsOwnJammingDensity) {
  ParameterSet set = thesis();
  set.closure = {"d2", "uni", false};
  const Laws laws = laws_of(set, Form::reduced);
  EXPECT_EQ(laws.pressure.p0, 0.03886);
  EXPECT_EQ(laws.contacts.nu_c, 0.6625);
}

TEST(Closure, AnotherHistoryMovesEveryLaw) {
  const Laws laws = laws_of(thesis(), Form::coupled), moved = with_jamming_density(laws, 0.65);
  const double factor = 0.65 / 0.6649, F_v = isotropic_fabric(laws.contacts, 1, 0.711);
  EXPECT_EQ(moved.pressure.nu_c, 0.65);
  EXPECT_EQ(moved.contacts.nu_c, moved.moduli.nu_c);  // B is finite where contacts begin
  EXPECT_NEAR(isotropic_fabric(moved.contacts, 1, 0.711 * factor), F_v * factor, 1e-13);
  EXPECT_NEAR(pressure(moved.pressure, 0.711 * factor), pressure(laws.pressure, 0.711), 1e-15);
  EXPECT_NEAR(bulk_modulus(moved.moduli, moved.contacts, 0.711 * factor), 0.4279, 5e-5);
  for (const auto law : {&Laws::s_max, &Laws::F_max, &Laws::beta_F})
    EXPECT_NEAR(saturation(moved.*law, 0.711 * factor), saturation(laws.*law, 0.711), 1e-12);
}

TEST(Closure, SizeFactorFollowsTheMaterialWhereNoModuliAreKnown) {
  ParameterSet set = thesis();
  EXPECT_EQ(laws_of(set, Form::reduced).g3, 1.22);
  set.closure.contacts_at_moduli_nu_c = false;
  set.moduli.reset();
  EXPECT_NEAR(laws_of(set, Form::reduced).g3, 1.22475, 5e-6);  // Eq. 3.8 at w = 3
}

TEST(Closure, SaysWhatAFormNeeds) {
  ParameterSet set = thesis();
  set.file = "p.json";
  set.shear->beta_s.reset();
  EXPECT_EQ(refusal([&] { laws_of(set, Form::reduced); }),
            "p.json: shear.beta_s: is missing; the reduced form needs it");
  EXPECT_EQ(refusal([&] { laws_of(set, Form::coupled); }), "accepted");  // 4.16 has no beta_s
  set.moduli.reset();
  EXPECT_THAT(refusal([&] { laws_of(set, Form::coupled); }), HasSubstr("p.json: moduli: is missing"));
  set.isotropic.erase("iso");
  EXPECT_THAT(refusal([&] { laws_of(set, Form::coupled); }),
              HasSubstr("isotropic.iso: is missing; the coupled form (closure.P)"));
}

TEST(Closure, FormsHaveNames) {
  for (const Form form : {Form::reduced_closed, Form::reduced, Form::coupled})
    EXPECT_EQ(form_of(name_of(form)), form);
  EXPECT_THAT(refusal([] { form_of("coupeld"); }), HasSubstr("reduced_closed, reduced, coupled"));
}

}  // namespace
}  // namespace grainlaw::model
