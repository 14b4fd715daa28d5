#include "grainlaw/calibrate/fit_records.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "fit_fixture.hpp"
#include "grainlaw/calibrate/fit_account.hpp"
#include "grainlaw/calibrate/fit_checks.hpp"
#include "grainlaw/element/error.hpp"

namespace grainlaw::calibrate {
namespace {

using testing::AllOf;
using testing::HasSubstr;

void expect_fitted(const model::Parameter& p, double truth, double tolerance = 1e-5) {
  EXPECT_NEAR(p.value, truth, tolerance * std::max(std::abs(truth), 1e-3));
  EXPECT_EQ(p.source, "fit") << p.note;
  EXPECT_TRUE(p.thesis);
}

std::string text_of(const FitOutput& out) { return out.parameters.to_json().dump(2); }

std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

const Json& entry_of(const FitOutput& out, const std::string& name) {
  for (const Json& fit : out.fits.at("fits")) {
    if (fit.at("name") == name) return fit;
  }
  throw std::runtime_error("no fit named " + name);
}

bool has_entry(const FitOutput& out, const std::string& name) {
  for (const Json& fit : out.fits.at("fits")) {
    if (fit.at("name") == name) return true;
  }
  return false;
}

class FitRecords : public testing::Test {
 protected:
  FitRecords() { write_campaign(dir(), thesis_); }
  const std::filesystem::path& dir() const { return scratch_.dir(); }
  std::filesystem::path record(const std::string& name) const { return dir() / "records" / name; }
  FitOutput fitted() const { return fit_records(dir(), thesis_file()); }

  ThesisRecords thesis_;
  Scratch scratch_;
};

TEST_F(FitRecords, ReturnTheParametersThatMadeTheRecords) {
  const FitOutput out = fitted();
  for (const char* mode : {"iso", "d2"}) {
    SCOPED_TRACE(mode);
    const model::PackingLaw &fit = out.parameters.isotropic.at(mode),
                            &truth = thesis_.set().isotropic.at(mode);
    expect_fitted(fit.C1, truth.C1.value);
    expect_fitted(fit.alpha, truth.alpha.value);
    expect_fitted(fit.nu_c_contacts, truth.nu_c_contacts.value);
    expect_fitted(fit.phi_c, truth.phi_c.value);
    expect_fitted(fit.phi_v, truth.phi_v.value);
    expect_fitted(fit.p0, truth.p0.value);
    expect_fitted(fit.gamma_p, truth.gamma_p.value, 1e-4);
    expect_fitted(fit.nu_c, truth.nu_c.value);
    EXPECT_EQ(fit.C0.value, 6);
    EXPECT_EQ(fit.C0.source, "assumed");
  }
  // Table 2.2 counts from 0.6653, the fit from the nu_c of the isotropic pressure: the same curve, another
  // Q_v.
  const double iso_nu_c = thesis_.set().isotropic.at("iso").nu_c.value;
  const auto expect_law = [&](const model::SaturationLaw& fit, const model::SaturationLaw& truth) {
    EXPECT_NEAR(fit.nu_c.value, iso_nu_c, 1e-6);
    for (const double nu : {0.68, 0.72, 0.79}) {
      const double value = model::saturation(truth.values(), nu);
      EXPECT_NEAR(model::saturation(fit.values(), nu), value, 1e-5 * value);
    }
    EXPECT_NEAR(fit.alpha.value, truth.alpha.value * iso_nu_c / truth.nu_c.value, 1e-3 * truth.alpha.value);
  };
  const model::ShearLaws &fit = *out.parameters.shear, &truth = *thesis_.set().shear;
  expect_law(*fit.s_max, *truth.s_max);
  expect_law(*fit.beta_s, *truth.beta_s);
  expect_law(*fit.F_max, *truth.F_max);
  expect_law(*fit.beta_F, *truth.beta_F);
  EXPECT_EQ(fit.F_max->Q_max.value, 0);
  EXPECT_EQ(fit.F_max->Q_max.source, "assumed");
}

/// Such tests stop on the way, for others to start there.
TEST_F(FitRecords, ALoadingInThreeLegsIsOne) {
  const std::string whole = text_of(fitted());
  for (const double nu : d2_densities) {
    std::vector<Row> rows = thesis_.shear("d2", nu);
    for (Row& row : rows) row.segment = (row.eps_dev > 0.05 + 1e-9) + (row.eps_dev > 0.15 + 1e-9);
    write_record(record("d2-" + to_text(nu) + "-s1"), R"({"segments": [
        {"mode": "d2", "controls": {"eps_dev": 0.05}}, {"mode": "d2", "controls": {"eps_dev": 0.15}},
        {"mode": "d2", "controls": {"eps_dev": 0.4}}]})",
                 rows);
  }
  EXPECT_EQ(text_of(fitted()), whole);
}

/// Compression and decompression of a sheared packing are no isotropic test: its jamming density is another.
TEST_F(FitRecords, IsotropicStrainAfterShearIsNoIsotropicTest) {
  const FitOutput before = fitted();
  std::filesystem::copy(record("iso-s1"), record("down-s1"));
  edit(dir() / "campaign.json", [](const std::string& text) {
    Json campaign = Json::parse(text);
    Json test = campaign["tests"][0];
    test["name"] = "down";
    test["from"] = {{"test", "d2-0.71"}, {"segment", 0}};
    test["path"]["segments"][0]["controls"] = {{"nu", 0.72}};
    campaign["tests"].push_back(test);
    return campaign.dump(1);
  });
  edit(record("down-s1") / "scene.json", [](const std::string& text) {
    Json scene = Json::parse(text);
    scene["preparation"] = {{"snapshot", "../d2-0.71-s1/snapshots.h5"}, {"segment", 0}};
    return scene.dump(1);
  });
  EXPECT_EQ(text_of(fitted()), text_of(before));
}

TEST_F(FitRecords, LeaveToTheThesisWhatNoRecordMeasures) {
  const FitOutput out = fitted();
  ASSERT_TRUE(out.parameters.moduli && out.parameters.memory);
  EXPECT_EQ(out.parameters.moduli->a_I.source, "thesis");
  EXPECT_EQ(out.parameters.moduli->a_I.value, thesis_.set().moduli->a_I.value);
  EXPECT_EQ(out.parameters.memory->phi_SJ.source, "thesis");
  EXPECT_EQ(out.parameters.closure.P, "iso");
  EXPECT_EQ(out.parameters.closure.contacts, "d2");
  EXPECT_FALSE(out.parameters.closure.contacts_at_moduli_nu_c);
  EXPECT_EQ(out.parameters.name, "made");
}

TEST_F(FitRecords, WriteAParameterSetThatCanBeRead) {
  const Json json = fitted().parameters.to_json();
  const model::ParameterSet again = model::ParameterSet::read(Reader(json, "parameters.json"));
  EXPECT_EQ(again.to_json(), json);
}

TEST_F(FitRecords, NoDigitDependsOnRecordsToBePredicted) {
  const FitOutput with = fitted();
  EXPECT_FALSE(with.parameters.isotropic.contains("uni"));
  EXPECT_FALSE(with.parameters.isotropic.contains("d3"));
  EXPECT_EQ(entry_of(with, "isotropic.uni.P").at("role"), "predict");
  EXPECT_NEAR(entry_of(with, "isotropic.uni.P").at("parameters")[0].at("value").get<double>(),
              thesis_.set().isotropic.at("uni").p0.value, 1e-6);

  // Other values in them change their own fits, and nothing else.
  std::vector<Row> twice = thesis_.cycle("uni");
  for (Row& row : twice) row.P *= 2;
  write_record(record("uni-s1"), path_json("uni"), twice);
  const FitOutput changed = fitted();
  EXPECT_NE(entry_of(changed, "isotropic.uni.P"), entry_of(with, "isotropic.uni.P"));
  EXPECT_EQ(text_of(changed), text_of(with));

  for (const char* name : {"uni-s1", "d3-0.7-s1", "d3-0.75-s1"}) std::filesystem::remove_all(record(name));
  const FitOutput without = fitted();
  EXPECT_FALSE(has_entry(without, "isotropic.uni.P"));
  EXPECT_EQ(text_of(without), text_of(with));
}

TEST_F(FitRecords, ParametersDependOnRecordsToBeFitted) {
  const FitOutput before = fitted();
  std::vector<Row> more = thesis_.cycle("iso");
  for (Row& row : more) row.P *= 1.1;
  write_record(record("iso-s1"), path_json("iso"), more);
  EXPECT_NEAR(fitted().parameters.isotropic.at("iso").p0.value,
              1.1 * before.parameters.isotropic.at("iso").p0.value, 1e-6);
}

TEST_F(FitRecords, FitTheUnloadingAndNotTheLoading) {
  std::vector<Row> rows = thesis_.cycle("iso");
  for (Row& row : rows) {
    if (row.segment == 0) row.P *= 3;
  }
  write_record(record("iso-s1"), path_json("iso"), rows);
  expect_fitted(fitted().parameters.isotropic.at("iso").p0, thesis_.set().isotropic.at("iso").p0.value);
}

TEST_F(FitRecords, FitTheSteadyStateOfShearAndNotItsBeginning) {
  for (const double nu : d2_densities) {
    std::vector<Row> rows = thesis_.shear("d2", nu);
    for (Row& row : rows) {
      if (row.eps_dev < 0.1) row.P *= 0.5;
    }
    write_record(record("d2-" + to_text(nu) + "-s1"), path_json("d2"), rows);
  }
  expect_fitted(fitted().parameters.isotropic.at("d2").p0, thesis_.set().isotropic.at("d2").p0.value);
}

TEST_F(FitRecords, SayWhichRowsWereTaken) {
  const Json fit = entry_of(fitted(), "isotropic.iso.P");
  EXPECT_THAT(fit.at("selection").get<std::string>(),
              AllOf(HasSubstr("P >= 2e-04"), HasSubstr("Ek_over_Ep <= 0.01")));
  EXPECT_GT(fit.at("rows_left_out").get<int>(), 0);  // below jamming
  EXPECT_EQ(fit.at("rows_left_out").get<int>() + fit.at("n").get<int>(), 80);
  for (const double P : fit.at("data")[0].at("y")) EXPECT_GE(P, 2e-4);
}

TEST_F(FitRecords, ChecksHoldOnTheThesisOwnNumbers) {
  const FitOutput out = fitted();
  ASSERT_EQ(out.fits.at("checks").size(), 5u);
  for (const Json& check : out.fits.at("checks")) EXPECT_EQ(check.at("holds"), true) << check.dump();
}

TEST_F(FitRecords, ChecksFailWhereThePhysicsDoes) {
  for (const double nu : d2_densities) {
    std::vector<Row> rows = thesis_.shear("d2", nu);
    for (Row& row : rows) row.s_dev *= 10 * (nu - 0.6);
    write_record(record("d2-" + to_text(nu) + "-s1"), path_json("d2"), rows);
  }
  const FitOutput out = fitted();
  for (const Json& check : out.fits.at("checks")) {
    EXPECT_EQ(check.at("holds"), check.at("name") != "s_max falls with nu") << check.dump();
  }
}

TEST_F(FitRecords, WithoutShearTestsTheThesisStandsInAndSaysSo) {
  for (const double nu : d2_densities) std::filesystem::remove_all(record("d2-" + to_text(nu) + "-s1"));
  const FitOutput out = fitted();
  const model::PackingLaw& d2 = out.parameters.isotropic.at("d2");
  EXPECT_EQ(d2.C1.source, "assumed");
  EXPECT_EQ(d2.C1.value, thesis_.set().isotropic.at("d2").C1.value);
  EXPECT_THAT(d2.C1.note, HasSubstr("no data"));
  EXPECT_EQ(out.parameters.shear->s_max->alpha.source, "assumed");
  expect_fitted(out.parameters.isotropic.at("iso").p0, thesis_.set().isotropic.at("iso").p0.value);
  bool reported = false;
  for (const Json& open : out.fits.at("not_determined")) {
    reported = reported || (open.at("fit") == "shear.s_max" && open.at("parameter") == "alpha" &&
                            open.at("reason") == "no data");
  }
  EXPECT_TRUE(reported) << out.fits.at("not_determined").dump(1);
  bool missing = false;
  for (const Json& left : out.fits.at("left_out")) missing = missing || left.at("test") == "d2-0.71-s1";
  EXPECT_TRUE(missing);
}

TEST_F(FitRecords, TwoDensitiesLeaveAlphaToTheThesis) {
  for (const double nu : {0.69, 0.71, 0.74, 0.77})
    std::filesystem::remove_all(record("d2-" + to_text(nu) + "-s1"));
  const FitOutput out = fitted();
  const model::SaturationLaw& law = *out.parameters.shear->s_max;
  EXPECT_EQ(law.alpha.source, "assumed");
  EXPECT_EQ(law.alpha.value, thesis_.set().shear->s_max->alpha.value);
  EXPECT_THAT(law.alpha.note, HasSubstr("2 different x for 3 parameters"));
}

TEST_F(FitRecords, WithoutTheThesisARowThatCannotBeFittedIsAbsent) {
  for (const double nu : d2_densities) std::filesystem::remove_all(record("d2-" + to_text(nu) + "-s1"));
  const FitOutput out = fit_records(dir());
  EXPECT_TRUE(out.parameters.isotropic.contains("iso"));
  EXPECT_FALSE(out.parameters.isotropic.contains("d2"));
  EXPECT_FALSE(out.parameters.shear->s_max);
  EXPECT_FALSE(out.parameters.moduli);
  EXPECT_EQ(out.parameters.closure.contacts, "iso");
  EXPECT_FALSE(out.parameters.isotropic.at("iso").p0.thesis);
  EXPECT_TRUE(entry_of(out, "shear.s_max").at("parameters")[0].at("value").is_null());
  const Json json = out.parameters.to_json();
  EXPECT_EQ(model::ParameterSet::read(Reader(json, "p.json")).to_json(), json);
}

TEST_F(FitRecords, ADirectoryWithoutCampaignIsFittedAsAWhole) {
  std::filesystem::remove(dir() / "campaign.json");
  const FitOutput out = fitted();
  EXPECT_TRUE(out.parameters.isotropic.contains("uni"));
  expect_fitted(out.parameters.isotropic.at("uni").p0, thesis_.set().isotropic.at("uni").p0.value);
  EXPECT_EQ(entry_of(out, "isotropic.uni.P").at("role"), "fit");
  expect_fitted(fit_records(dir() / "records", thesis_file()).parameters.isotropic.at("iso").nu_c,
                thesis_.set().isotropic.at("iso").nu_c.value);
}

TEST_F(FitRecords, OfAnotherMaterialTheThesisIsOnlyAssumed) {
  Scratch other;
  write_record(other.dir() / "iso-s1", path_json("iso"), thesis_.cycle("iso"), 1.5);
  const FitOutput out = fit_records(other.dir(), thesis_file());
  EXPECT_FALSE(out.parameters.isotropic.at("iso").p0.thesis);
  EXPECT_EQ(out.parameters.moduli->a_I.source, "assumed");
  EXPECT_FALSE(out.parameters.moduli->a_I.thesis);
  EXPECT_NEAR(out.parameters.moduli->g3.value, 1.04172, 1e-5);  // Eq. 3.8 at w = 1.5
  EXPECT_THAT(out.parameters.isotropic.at("d2").C1.note, HasSubstr("w = 3"));
}

TEST_F(FitRecords, RefuseRecordsOfDifferentMaterials) {
  write_record(record("d2-0.69-s1"), path_json("d2"), thesis_.shear("d2", 0.69), 2);
  EXPECT_THAT(message_of([&] { fitted(); }),
              AllOf(HasSubstr("d2-0.69-s1/scene.json"), HasSubstr("material.w")));
}

TEST_F(FitRecords, RefuseARecordWithNaNNamingFileAndColumn) {
  edit(record("d2-0.69-s1") / "record.csv", [](std::string text) {
    const auto at = text.find('\n', text.find('\n') + 1) + 1;
    return text.substr(0, at) + "0,0,nan" +
           text.substr(text.find(',', text.find(',', text.find(',', at) + 1) + 1));
  });
  EXPECT_THAT(message_of([&] { fitted(); }),
              AllOf(HasSubstr("d2-0.69-s1/record.csv"), HasSubstr("eps_dev"), HasSubstr("nan")));
}

TEST_F(FitRecords, RefuseARecordWithoutAColumnNamingIt) {
  edit(record("iso-s1") / "record.csv",
       [](std::string text) { return text.replace(text.find("C_star"), 6, "C_stir"); });
  EXPECT_THAT(message_of([&] { fitted(); }), AllOf(HasSubstr("iso-s1/record.csv"), HasSubstr("C_star")));
}

/// Of a scene that says which columns it writes: the fits need them all, also the one that tells rows at
/// rest.
TEST_F(FitRecords, RefuseARecordWhoseSceneLeavesColumnsOut) {
  const auto leave_out = [&](const std::string& column, const std::string& standard) {
    write_campaign(dir(), thesis_);
    edit(record("iso-s1") / "record.csv",
         [&](std::string text) { return text.replace(text.find(column), column.size(), "other"); });
    edit(record("iso-s1") / "scene.json", [&](const std::string& text) {
      Json scene = Json::parse(text);
      scene["measure"]["standard"] = Json::parse(standard);
      return scene.dump(1);
    });
    return message_of([&] { fitted(); });
  };
  EXPECT_THAT(leave_out("F_dev", R"(["stress", "coordination", "energy_ratio"])"),
              AllOf(HasSubstr("iso-s1/record.csv: F_dev: column is missing"),
                    HasSubstr("where measure.standard of its scene names \"fabric\"")));
  EXPECT_THAT(leave_out("Ek_over_Ep", R"(["stress", "fabric", "coordination"])"),
              AllOf(HasSubstr("iso-s1/record.csv: Ek_over_Ep: column is missing"),
                    HasSubstr("where measure.standard of its scene names \"energy_ratio\"")));
}

TEST_F(FitRecords, RefuseAnEmptyFieldWhereANumberMustBe) {
  std::vector<Row> rows = thesis_.cycle("iso");
  rows[5].P = std::nan("");
  write_record(record("iso-s1"), path_json("iso"), rows);
  EXPECT_THAT(message_of([&] { fitted(); }), AllOf(HasSubstr("iso-s1/record.csv"), HasSubstr("P")));
}

TEST_F(FitRecords, RefuseADirectoryWithoutRecords) {
  Scratch empty;
  EXPECT_THAT(message_of([&] { fit_records(empty.dir()); }), HasSubstr("found none"));
  EXPECT_THAT(message_of([&] { fit_records(empty.dir() / "nowhere"); }), HasSubstr("nowhere"));
}

TEST_F(FitRecords, RecordsStillBeingMadeDoNotCount) {
  std::filesystem::remove(dir() / "campaign.json");
  const std::string before = text_of(fitted());
  std::vector<Row> wild = thesis_.cycle("iso");
  for (Row& row : wild) row.P *= 7;
  write_record(record("iso-s9.part"), path_json("iso"), wild);
  EXPECT_EQ(text_of(fitted()), before);
}

TEST_F(FitRecords, ThreeSeedsGiveTheirScatter) {
  std::filesystem::remove(dir() / "campaign.json");
  for (const int seed : {2, 3}) {
    std::vector<Row> rows = thesis_.cycle("iso");
    for (Row& row : rows) row.P *= 1 + 0.01 * (2 * seed - 5);
    write_record(record("iso-s" + std::to_string(seed)), path_json("iso"), rows);
  }
  const FitOutput out = fitted();
  EXPECT_EQ(entry_of(out, "isotropic.iso.P").at("stderr_from"), "scatter over seeds");
  // p0 of the seeds: 1, 0.99, 1.01 times the thesis's, so a standard error of 1 %/sqrt(3).
  const model::Parameter& p0 = out.parameters.isotropic.at("iso").p0;
  EXPECT_NEAR(*p0.stderr_ / p0.value, 0.01 / std::sqrt(3.0), 1e-5);
}

double value_of(const Json& fit, const std::string& parameter) {
  for (const Json& p : fit.at("parameters")) {
    if (p.at("name") == parameter) return p.at("value").get<double>();
  }
  throw std::runtime_error("no parameter " + parameter);
}

constexpr StrainTensor d2_axis{-1 / 1.7320508075688772, 1 / 1.7320508075688772, 0},
    d3_axis{-1. / 3, -1. / 3, 2. / 3};

TEST_F(FitRecords, FitTheStressAndFabricAlongTheMode) {
  // sqrt(3 J2) of these records is larger, since they deviate in another direction too.
  const model::ShearLaws& truth = *thesis_.set().shear;
  add_components(record("d2-0.71-s1"), d2_axis, d3_axis, 0.08);
  add_components(record("d3-0.7-s1"), d3_axis, d2_axis, 0.08);
  const FitOutput out = fitted();
  for (const auto& [name, nu] : {std::pair("d2-0.71-s1", 0.71), std::pair("d3-0.7-s1", 0.7)}) {
    const Json stress = entry_of(out, std::string(name) + ".s_dev");
    const Json fabric = entry_of(out, std::string(name) + ".F_dev");
    EXPECT_NEAR(value_of(stress, "max"), model::saturation(truth.s_max->values(), nu), 1e-6);
    EXPECT_NEAR(value_of(stress, "initial"), 0.01, 1e-6);
    EXPECT_NEAR(value_of(stress, "beta"), model::saturation(truth.beta_s->values(), nu), 1e-3);
    EXPECT_NEAR(value_of(fabric, "max"), model::saturation(truth.F_max->values(), nu), 1e-6);
    EXPECT_NEAR(value_of(fabric, "beta"), model::saturation(truth.beta_F->values(), nu), 1e-3);
    EXPECT_THAT(stress.at("selection").get<std::string>(), HasSubstr("projection of sxx, syy, szz"));
    EXPECT_THAT(fabric.at("y").at("label").get<std::string>(), HasSubstr("along the mode"));
  }
}

TEST_F(FitRecords, WithoutComponentsFitTheSignedColumnsAndSaySo) {
  const Json stress = entry_of(fitted(), "d2-0.71-s1.s_dev");
  EXPECT_THAT(stress.at("selection").get<std::string>(), HasSubstr("signed column s_dev"));
  EXPECT_THAT(stress.at("y").at("label").get<std::string>(), HasSubstr("signed"));
}

TEST_F(FitRecords, ARunThatHardlyRelaxesGivesItsSteadyMeanAndNoRate) {
  // A line is the beginning of any exponential: the rate goes to its bound, and max to an extrapolation.
  std::vector<Row> rows = thesis_.shear("d2", 0.74);
  for (Row& row : rows) row.s_dev = 0.14 + 0.02 * row.eps_dev;
  write_record(record("d2-0.74-s1"), path_json("d2"), rows);
  const FitOutput out = fitted();
  EXPECT_GT(value_of(entry_of(out, "d2-0.74-s1.s_dev"), "max"), 0.155);
  const Json s_max = entry_of(out, "shear.s_max"), beta_s = entry_of(out, "shear.beta_s");
  EXPECT_THAT(s_max.at("selection").get<std::string>(), HasSubstr("(d2-0.74-s1)"));
  double steady = 0;
  for (const Json& point : s_max.at("data")) {
    if (point.at("test") == "d2-0.74-s1") steady = point.at("y")[0].get<double>();
  }
  EXPECT_NEAR(steady, 0.14 + 0.02 * (0.152 + 0.4) / 2, 1e-9);  // rows from 0.152 to 0.4
  EXPECT_EQ(s_max.at("n"), d2_densities.size());
  EXPECT_EQ(beta_s.at("n"), d2_densities.size() - 1);
}

TEST_F(FitRecords, SayThatTheErrorLeavesOutThatOfAHeldParameter) {
  for (const double nu : {0.69, 0.71, 0.74, 0.77})
    std::filesystem::remove_all(record("d2-" + to_text(nu) + "-s1"));
  write_record(record("d2-0.8-s1"), path_json("d2"), thesis_.shear("d2", 0.79));
  std::filesystem::remove(dir() / "campaign.json");  // more runs at the same two densities
  write_record(record("d2-0.8-s2"), path_json("d2"), thesis_.shear("d2", 0.79));
  write_record(record("d2-0.675-s2"), path_json("d2"), thesis_.shear("d2", 0.675));
  const FitOutput out = fitted();
  EXPECT_THAT(out.parameters.shear->s_max->Q_v.note,
              HasSubstr("its error leaves out that of alpha, held at the thesis's value, which has none"));
  EXPECT_EQ(out.parameters.isotropic.at("iso").p0.note, "");
}

TEST_F(FitRecords, TellHowFarTheLowestPressureMoves) {
  // Contacts that leave their law below P = 8e-4.
  std::vector<Row> rows = thesis_.cycle("iso", 400);
  for (Row& row : rows) row.C_star += row.P < 8e-4 ? 0.05 : 0;
  write_record(record("iso-s1"), path_json("iso"), rows);
  const FitOutput out = fitted();
  const Json& C0 = entry_of(out, "isotropic.iso.C_star_free_C0").at("parameters")[0];
  const double shift = C0.at("shift_at_four_P_min").get<double>(),
               narrow = C0.at("value").get<double>() + shift;
  EXPECT_GT(std::abs(shift), 1e-3);
  EXPECT_NEAR(narrow, 6, 1e-5);
  EXPECT_THAT(out.fits.at("checks")[1].at("value").get<std::string>(),
              AllOf(HasSubstr(" ± "), HasSubstr("; 6.00 from P >= 8e-04")));

  // Without a row between 2e-4 and 8e-4, nothing has been tried.
  std::erase_if(rows, [](const Row& row) { return row.P < 8e-4; });
  write_record(record("iso-s1"), path_json("iso"), rows);
  const FitOutput none = fitted();
  const Json& alone = entry_of(none, "isotropic.iso.C_star_free_C0").at("parameters")[0];
  ASSERT_TRUE(alone.contains("shift_at_four_P_min"));
  EXPECT_TRUE(alone.at("shift_at_four_P_min").is_null());
  EXPECT_THAT(none.fits.at("checks")[1].at("value").get<std::string>(), testing::Not(HasSubstr("from P")));
}

TEST_F(FitRecords, TheSizeFactorIsThatOfTheRecordsOwnSizes) {
  const model::Parameter g3 = fitted().parameters.moduli->g3;
  EXPECT_NEAR(g3.value, 1.22475, 1e-5);  // Eq. 3.8 at w = 3, which the thesis prints as 1.22
  EXPECT_EQ(g3.thesis, 1.22);
  EXPECT_THAT(g3.note, HasSubstr("Eq. 3.8 for w = 3"));
}

/// An account of nothing but the pressure laws of two modes.
Account jamming_at(double iso, double d2, double error) {
  Account account;
  for (const auto& [mode, nu_c] : {std::pair("iso", iso), std::pair("d2", d2)}) {
    FitEstimate at, p0;
    at.name = "nu_c";
    at.value = nu_c;
    at.stderr_ = error;
    p0.name = "p0";
    account.packing[mode].pressure.parameters = {at, p0};
    account.packing[mode].pressure.ran = true;
  }
  return account;
}

TEST(Checks, JammingOrderNeedsTwoStandardErrors) {
  const auto order = [](const Account& account) { return physics_checks(account)[0]; };
  EXPECT_EQ(order(jamming_at(0.665, 0.657, 2e-3)).at("holds"), true);
  EXPECT_EQ(order(jamming_at(0.665, 0.657, 4e-3)).at("holds"), false);  // by 0.008 +- 0.0057
  EXPECT_EQ(order(jamming_at(0.657, 0.665, 1e-3)).at("holds"), false);
  EXPECT_THAT(order(jamming_at(0.665, 0.657, 3e-3)).at("value").get<std::string>(),
              HasSubstr("by 0.0080 ± 0.0042"));
}

}  // namespace
}  // namespace grainlaw::calibrate
