// The parameter file: read, written, read again; and each way of being wrong, named.
#include "grainlaw/model/parameters.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "checks.hpp"

namespace grainlaw::model {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// The thesis's file with one thing changed, read back.
std::string refused(const std::function<void(Json&)>& change) {
  Json json = load_json(thesis_file());
  change(json);
  return refusal([&] { ParameterSet::read(Reader(json, "parameters.json")); });
}

TEST(Parameters, ReadAllGroups) {
  const ParameterSet set = thesis();
  EXPECT_EQ(set.material.w, 3);
  EXPECT_EQ(set.closure.P, "iso");
  EXPECT_EQ(set.closure.contacts, "d2");
  EXPECT_TRUE(set.closure.contacts_at_moduli_nu_c);
  EXPECT_EQ(set.isotropic.size(), 4U);
  EXPECT_EQ(set.isotropic.at("d2").C1.value, 7.9219);
  EXPECT_EQ(set.isotropic.at("iso").pressure().nu_c, 0.6649);
  EXPECT_EQ(set.isotropic.at("iso").contacts().nu_c, 0.6646);
  EXPECT_EQ(set.shear->beta_F->values().Q_v, 57.89);
  EXPECT_EQ(set.moduli->values().Fv_alpha, 1.9);
  EXPECT_EQ(set.memory->over_compression().phi_SJ, 0.6567);
  EXPECT_EQ(set.isotropic.at("iso").C1.source, "thesis");
}

TEST(Parameters, RoundTrip) {
  ParameterSet set = thesis();
  set.isotropic.at("uni").p0.stderr_ = 1.25e-4;
  set.memory->phi_cr = Parameter{0.655, 0.001, "1", "fit", std::nullopt, "measured"};
  const Json once = set.to_json();
  const ParameterSet back = ParameterSet::read(Reader(once, "again.json"));
  EXPECT_EQ(back.to_json(), once);
  EXPECT_EQ(back.isotropic.at("uni").p0.stderr_, 1.25e-4);
  EXPECT_FALSE(back.isotropic.at("uni").C1.stderr_.has_value());
  EXPECT_EQ(back.memory->phi_cr->note, "measured");
}

TEST(Parameters, FileIsWrittenAsItIsRead) {
  const Json json = load_json(thesis_file());
  EXPECT_EQ(ParameterSet::read(Reader(json, "p")).to_json(), json);
}

TEST(Parameters, AGroupMayBeAbsentUntilItIsNeeded) {
  Json json = load_json(thesis_file());
  json.erase("moduli");
  json.erase("memory");
  json["shear"].erase("beta_s");
  json["isotropic"].erase("uni");
  const ParameterSet set = ParameterSet::read(Reader(json, "parameters.json"));
  EXPECT_FALSE(set.moduli || set.memory);
  EXPECT_EQ(set.to_json(), json);
  EXPECT_EQ(refusal([&] { set.need_moduli("a test"); }),
            "parameters.json: moduli: is missing; a test needs it");
  EXPECT_THAT(refusal([&] { set.need_memory("a test"); }), HasSubstr("memory: is missing"));
  EXPECT_THAT(refusal([&] { set.packing("uni", "a test"); }), HasSubstr("isotropic.uni: is missing"));
  EXPECT_THAT(refusal([&] { set.saturation("beta_s", "a test"); }), HasSubstr("shear.beta_s: is missing"));
  EXPECT_EQ(set.saturation("beta_F", "a test").Q_v.value, 57.89);
}

TEST(Parameters, ErrorsNameFileKeyAndValue) {
  EXPECT_THAT(refused([](Json& j) { j["isotropic"]["iso"]["C2"] = 1; }),
              AllOf(HasSubstr("parameters.json: isotropic.iso.C2"), HasSubstr("unknown key")));
  EXPECT_THAT(refused([](Json& j) { j["shear"]["s_max"]["Q_v"]["sterr"] = 0.1; }),
              HasSubstr("shear.s_max.Q_v.sterr: unknown key, did you mean stderr?"));
  EXPECT_THAT(refused([](Json& j) { j["isotropic"]["d4"] = Json::object(); }), HasSubstr("isotropic.d4"));
  EXPECT_THAT(refused([](Json& j) { j["shear"]["s_max"]["Q_max"]["value"] = "big"; }),
              AllOf(HasSubstr("parameters.json: shear.s_max.Q_max.value"), HasSubstr("\"big\"")));
  EXPECT_THAT(refused([](Json& j) { j["moduli"]["g3"].erase("value"); }),
              HasSubstr("parameters.json: moduli.g3.value: is missing"));
  EXPECT_THAT(refused([](Json& j) { j["moduli"].erase("a_I"); }),
              HasSubstr("parameters.json: moduli.a_I: is missing"));
  EXPECT_THAT(refused([](Json& j) { j.erase("closure"); }), HasSubstr("closure: is missing"));
  EXPECT_THAT(refused([](Json& j) { j["closure"]["P"] = "ISO"; }), HasSubstr("closure.P: must be one of"));
  EXPECT_THAT(refused([](Json& j) { j["format"] = "grainlaw-parameters-9"; }), HasSubstr("format"));
  EXPECT_THAT(refused([](Json& j) { j["isotropic"]["iso"]["nu_c"]["value"] = 1.2; }),
              AllOf(HasSubstr("isotropic.iso.nu_c.value"), HasSubstr("1.2")));
  EXPECT_THAT(refused([](Json& j) { j["isotropic"]["iso"]["p0"]["unit"] = "kPa"; }),
              AllOf(HasSubstr("isotropic.iso.p0.unit"), HasSubstr("kPa")));
  EXPECT_THAT(refused([](Json& j) { j["isotropic"]["iso"]["p0"]["stderr"] = -1; }),
              HasSubstr("isotropic.iso.p0.stderr"));
  EXPECT_THAT(refused([](Json& j) { j["isotropic"]["iso"]["p0"]["source"] = "guess"; }),
              HasSubstr("isotropic.iso.p0.source"));
  EXPECT_THAT(refusal([] { ParameterSet::load("/nowhere/p.json"); }), HasSubstr("/nowhere/p.json"));
}

}  // namespace
}  // namespace grainlaw::model
