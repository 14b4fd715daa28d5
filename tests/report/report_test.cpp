#include "grainlaw/apps/report/report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <regex>

#include "grainlaw/dem/run/element_test.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/element/file.hpp"
#include "grainlaw/element/json.hpp"
#include "grainlaw/element/record.hpp"
#include "grainlaw/element/version.hpp"
#include "synthetic.hpp"
#include "well_formed.hpp"

namespace grainlaw::report {
namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// A folder of its own for one test, removed afterwards.
class ReportTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = ::testing::UnitTest::GetInstance()->current_test_info()->name();
    std::replace(name.begin(), name.end(), '/', '-');
    dir_ = fs::temp_directory_path() / ("grainlaw-report-" + std::to_string(getpid()) + "-" + name);
    fs::remove_all(dir_);
  }
  void TearDown() override { fs::remove_all(dir_); }

  test::Page page() const { return test::parse(report_html(dir_)); }

  void edit(const std::string& file, const std::function<void(Json&)>& change) const {
    Json json = load_json(dir_ / file);
    change(json);
    write_file(dir_ / file, json.dump());
  }

  fs::path dir_;
};

TEST_F(ReportTest, IsWellFormed) {
  test::write_synthetic_campaign(dir_);
  const auto parsed = page();
  EXPECT_THAT(parsed.problems, IsEmpty());
  for (const std::string& link : parsed.links) {
    ASSERT_EQ(link[0], '#') << link;
    EXPECT_THAT(parsed.ids, Contains(link.substr(1)));
  }
}

TEST_F(ReportTest, IsOneFileThatNeedsNothingElse) {
  test::write_synthetic_campaign(dir_);
  write_report(dir_);
  const std::string html = read_file(dir_ / "report.html");
  for (const char* outside :
       {"http://", "https://", "src=", "<script", "<link", "<img", "<iframe", "url(", "@import", "file:"}) {
    EXPECT_THAT(html, Not(HasSubstr(outside)));
  }
  EXPECT_TRUE(html.starts_with("<!DOCTYPE html>"));
  EXPECT_LT(html.size(), 3u << 20);
}

TEST_F(ReportTest, ShowsEveryFigure) {
  test::write_synthetic_campaign(dir_);
  const auto parsed = page();
  for (const char* figure :
       {"isotropic-C_star", "isotropic-phi_r", "isotropic-C_star_free_C0", "isotropic-P", "runs-d2-s_dev",
        "runs-d2-F_dev", "saturation", "prediction-1", "prediction-2", "prediction-3"}) {
    EXPECT_THAT(parsed.ids, Contains(std::string("figure-") + figure));
  }
  EXPECT_EQ(std::count(parsed.tags.begin(), parsed.tags.end(), "figure"), 10);
}

TEST_F(ReportTest, NeverShowsNan) {
  test::write_synthetic_campaign(dir_);
  edit("fits.json", [](Json& json) {
    for (Json& fit : json["fits"]) {
      fit["rms"] = nullptr;
      fit["condition"] = nullptr;
      fit["parameters"][0]["stderr"] = nullptr;
      fit["data"][0]["y"][0] = nullptr;
    }
  });
  const std::string html = report_html(dir_);
  EXPECT_FALSE(std::regex_search(html, std::regex("\\b(nan|inf|null)\\b", std::regex::icase)));
  EXPECT_THAT(html, HasSubstr("—"));
}

TEST_F(ReportTest, SameFilesGiveTheSameBytes) {
  test::write_synthetic_campaign(dir_);
  EXPECT_EQ(report_html(dir_), report_html(dir_));
}

TEST_F(ReportTest, PutsOurParametersBesideTheThesis) {
  test::write_synthetic_campaign(dir_);
  edit("parameters.json", [](Json& json) {
    json["isotropic"]["iso"]["C1"]["value"] = 8.2720 + 3.5 * 0.12;
    json["isotropic"]["iso"]["C1"]["stderr"] = 0.12;
  });
  const std::string html = report_html(dir_);
  EXPECT_THAT(
      html,
      HasSubstr("8.69 ± 0.12</span><div class=\"under\">thesis 8.272 <span class=\"far\">+3.5 σ</span>"));
}

TEST_F(ReportTest, MarksDifferencesAsItSays) {
  test::write_synthetic_campaign(dir_);
  const auto html_at = [&](double sigmas) {
    edit("parameters.json", [&](Json& json) {
      json["isotropic"]["iso"]["C1"]["value"] = 8.2720 + sigmas * 0.12;
      json["isotropic"]["iso"]["C1"]["stderr"] = 0.12;
    });
    return report_html(dir_);
  };
  EXPECT_THAT(html_at(1.5), HasSubstr("<span class=\"near\">+1.5 σ</span>"));
  EXPECT_THAT(html_at(2.5), HasSubstr("<span class=\"off\">+2.5 σ</span>"));
  const std::string html = html_at(3.5);
  EXPECT_THAT(html, HasSubstr("<span class=\"far\">+3.5 σ</span>"));
  EXPECT_THAT(html, HasSubstr("bold beyond 2\u00a0σ, underlined as well beyond 3\u00a0σ"));
  EXPECT_TRUE(std::regex_search(html, std::regex("\\.far \\{[^}]*underline")));
  EXPECT_THAT(html, Not(HasSubstr("combined standard error")));
}

TEST_F(ReportTest, SaysWhichNumbersWereNotFitted) {
  test::write_synthetic_campaign(dir_);
  const std::string html = report_html(dir_);
  EXPECT_THAT(
      html, HasSubstr("<td><var>a</var><sub>I</sub> (moduli)</td><td class=\"n\">0.66</td><td>thesis</td>"));
  EXPECT_THAT(
      html, HasSubstr("<td><var>C</var><sub>0</sub> of D2, ISO</td><td class=\"n\">6</td><td>assumed</td>"));
}

TEST_F(ReportTest, ShowsModuliBesideTable4_1) {
  test::write_synthetic_campaign(dir_);
  EXPECT_THAT(report_html(dir_), Not(HasSubstr("Small-strain moduli</h3>")));
  const Json points{{"test", "d2-0.711-s1"}, {"x", {0.01, 0.08, 0.12}}, {"y", {0.006, 0.05, 0.08}}};
  const Json line{{"x", {0, 0.12}}, {"y", {0, 0.08}}};
  edit("fits.json", [&](Json& json) {
    json["fits"].push_back(
        {{"name", "moduli.A1"},
         {"law", "A1/B = a_I F_dev (Eq. 4.12)"},
         {"role", "fit"},
         {"mode", "d2"},
         {"x", {{"name", "F_dev"}, {"label", "F_dev"}}},
         {"y", {{"name", "A1"}, {"label", "A1/B"}}},
         {"data", {points}},
         {"curve", line},
         {"thesis_curve", line},
         {"parameters",
          {{{"name", "a_I"}, {"value", 0.7}, {"stderr", 0.02}, {"thesis", 0.66}, {"determined", true}}}}});
  });
  edit("parameters.json", [](Json& json) {
    json["moduli"]["a_I"] = {
        {"value", 0.7}, {"stderr", 0.02}, {"unit", "1"}, {"source", "fit"}, {"thesis", 0.66}};
  });
  const std::string html = report_html(dir_);
  EXPECT_THAT(html, HasSubstr("<h3>Small-strain moduli</h3>"));
  EXPECT_THAT(html, HasSubstr("<h3>Small-strain moduli (Eqs. 4.11 – 4.15), beside Table 4.1</h3>"));
  EXPECT_THAT(html, HasSubstr("0.700 ± 0.020</span><div class=\"under\">thesis 0.66"));
  EXPECT_THAT(html, Not(HasSubstr("<var>a</var><sub>I</sub> (moduli)</td>")));
}

TEST_F(ReportTest, ShowsTheMemoryOfTheJammingDensity) {
  test::write_synthetic_campaign(dir_);
  EXPECT_THAT(report_html(dir_), Not(HasSubstr("Memory of the jamming density</h3>")));
  const auto parameter = [](const char* name, double value, double thesis) {
    return Json{
        {"name", name}, {"value", value}, {"stderr", 0.1 * value}, {"thesis", thesis}, {"determined", true}};
  };
  const auto fit_of = [](const char* name, const char* x, Json points, Json parameters) {
    const Json line{{"x", {0.657, 0.66}}, {"y", {0.2, 0.1}}};
    return Json{{"name", name},
                {"law", "law of " + std::string(name)},
                {"role", "memory"},
                {"mode", "iso"},
                {"x", {{"name", x}, {"label", x}}},
                {"y", {{"name", "y"}, {"label", "y"}}},
                {"data", Json::array({std::move(points)})},
                {"curve", line},
                {"thesis_curve", line},
                {"parameters", std::move(parameters)}};
  };
  edit("fits.json", [&](Json& json) {
    json["fits"].push_back(fit_of(
        "memory.phi_J", "phi_max",
        {{"test", "oc-s1"}, {"x", {0.82, 0.82, 0.68}}, {"y", {0.665, 0.6666, 0.661}}, {"M", {1, 10, 1}}},
        {parameter("phi_SJ", 0.657, 0.6567), parameter("alpha_max", 0.019, 0.02),
         parameter("alpha_phi", 0.3, 0.3), parameter("mu", 1, 1), parameter("beta", 0.4, 0.3)}));
    json["fits"].push_back(
        fit_of("memory.eps_SJ", "nu",
               {{"test", "sj-s1"}, {"x", {0.658, 0.66}}, {"y", {0.15, 0.1}}, {"phi_J0", {0.665, 0.665}}},
               {parameter("phi_SJ_sheared", 0.6569, 0.6567), parameter("alpha", 1.3, 1.37),
                parameter("eps0", 0.11, 0.102)}));
    json["fits"].push_back(fit_of("memory.eps_SJ_R", "nu",
                                  {{"test", "sj-s1"}, {"x", {0.658, 0.66}}, {"y", {0.2, 0}}},
                                  {parameter("eps0_R", 0.16, 0.17), parameter("phi_cr", 0.662, 0.66)}));
  });
  EXPECT_THAT(report_html(dir_), Not(HasSubstr("Packings at rest along shear")));
  edit("fits.json", [](Json& json) {
    json["memory"]["relaxed"] = {{"phi_J0", {0.665, 0.665, 0.665}},
                                 {"nu", {0.655, 0.658, 0.66}},
                                 {"eps_dev", {0.03, 0.12, 0.24}},
                                 {"P_flow", {0, 3e-4, 1e-3}},
                                 {"P", {0, 0, 8e-4}},
                                 {"s_dev", {nullptr, nullptr, 0.2}},
                                 {"C", {0, 3, 5}}};
    json["memory"]["tapped"] = {
        {"phi_max", {0.68, 0.82}}, {"amplitude", {0.02, 0.02}}, {"phi_J", {0.663, 0.667}}};
  });
  edit("parameters.json", [](Json& json) {
    json["memory"]["eps0"] = {
        {"value", 0.11}, {"stderr", 0.011}, {"unit", "1"}, {"source", "fit"}, {"thesis", 0.102}};
  });
  const std::string html = report_html(dir_);
  EXPECT_THAT(html, HasSubstr("<h3>Memory of the jamming density</h3>"));
  EXPECT_THAT(html, HasSubstr("<h3>Memory of the jamming density (Eqs. 5.1 – 5.13), beside chapter 5</h3>"));
  EXPECT_THAT(html, HasSubstr("0.110 ± 0.011</span><div class=\"under\">thesis 0.102"));
  EXPECT_THAT(html, HasSubstr("φ_max = 0.82"));
  EXPECT_THAT(html, HasSubstr("Packings at rest along shear"));
  EXPECT_THAT(html, HasSubstr("in flow only (fragile)"));
  EXPECT_THAT(html, HasSubstr("φ_max = 0.68 before"));
  EXPECT_THAT(html, Not(HasSubstr("NaN")));
}

/// Rows of a test of two segments, over nu or over shear.
std::string two_segments(bool shear) {
  std::string csv = "segment,eps_vol,eps_dev,nu,P,sigma_dev,s_dev,F_v,F_dev,C,C_star,f_NR,phi_J\n";
  for (int i = 0; i <= 20; ++i) {
    const double there = i <= 10 ? i / 10.0 : 2 - i / 10.0, nu = shear ? 0.66 : 0.64 + 0.09 * there;
    csv += std::to_string(i > 10) + ",0," + std::to_string(shear ? 0.28 * there : 0) + "," +
           std::to_string(nu) + "," + std::to_string(0.02 * there) + ",0.001,0.2,5,0.1,5.5,6.5,0.85,0.66\n";
  }
  return csv;
}

TEST_F(ReportTest, ShowsTheMinimalFormBesideTestsOfMemory) {
  test::write_synthetic_campaign(dir_);
  EXPECT_THAT(report_html(dir_), Not(HasSubstr("The minimal form")));
  for (const char* name : {"oc-s1", "sj-s1"}) {
    const std::string csv = two_segments(std::string(name) == "sj-s1");
    std::filesystem::create_directories(dir_ / "records" / name);
    write_file(dir_ / "records" / name / "record.csv", csv);
    write_file(dir_ / "predictions" / (std::string(name) + ".minimal.csv"), csv);
  }
  edit("predictions.json", [](Json& json) {
    for (const auto& [test, mode] : {std::pair{"oc-s1", "iso"}, {"sj-s1", "d2"}})
      json["memory"].push_back({{"test", test},
                                {"mode", mode},
                                {"form", "minimal"},
                                {"file", "predictions/" + std::string(test) + ".minimal.csv"}});
  });
  const std::string html = report_html(dir_);
  EXPECT_THAT(html, HasSubstr("<b>The minimal form</b> (Fig. 5.4 of the thesis"));
  EXPECT_THAT(html, HasSubstr("First and last cycle of <code>oc-s1</code>"));
  EXPECT_THAT(html, HasSubstr("Shear at constant volume: <code>sj-s1</code>"));
}

TEST_F(ReportTest, ShowsTheNumbersNearJamming) {
  test::write_synthetic_campaign(dir_);
  EXPECT_THAT(report_html(dir_), Not(HasSubstr("beside Tables 5.1 and 5.2")));
  edit("parameters.json", [](Json& json) {
    const Json number{{"value", 8.14}, {"stderr", 0.04}, {"unit", "1"}, {"source", "fit"}, {"thesis", 8.5}};
    for (const char* row : {"iso", "d2"}) json["near_jamming"][row]["C1"] = number;
    for (const char* row : {"s_max", "beta_s", "F_max", "beta_F"}) json["near_jamming"][row]["Q_v"] = number;
  });
  const std::string html = report_html(dir_);
  EXPECT_THAT(html, HasSubstr("beside Tables 5.1 and 5.2"));
  EXPECT_THAT(html, HasSubstr("8.140 ± 0.040"));
}

TEST_F(ReportTest, MarksFitsThatNoPredictionReads) {
  test::write_synthetic_campaign(dir_);
  EXPECT_THAT(page().text, HasSubstr("UNIfor comparison only"));
}

TEST_F(ReportTest, TellsChecksThatHoldFromThoseThatFail) {
  test::write_synthetic_campaign(dir_);
  const auto text = page().text;
  EXPECT_THAT(text, HasSubstr("1 of 2 checks"));
  EXPECT_THAT(text, HasSubstr("0.6650 > 0.6585✓ holds"));
  EXPECT_THAT(text, HasSubstr("6.31 ± 0.08✗ fails"));
}

TEST_F(ReportTest, GivesStressInKiloPascals) {
  test::write_synthetic_campaign(dir_);
  edit("parameters.json", [](Json& json) { json["material"]["k"] = 2.0; });
  const auto text = page().text;
  // k/(2<r>) = 1 ug/(mm us^2) = 1 MPa.
  EXPECT_THAT(text, HasSubstr("k/(2⟨r⟩) = 1000 kPa"));
  EXPECT_THAT(text, HasSubstr("P (kPa)"));
}

TEST_F(ReportTest, ShowsPredictionErrorsOfEverySeed) {
  test::write_synthetic_campaign(dir_);
  EXPECT_THAT(page().text, HasSubstr("3.6 % (3.4, 3.8)"));
}

TEST_F(ReportTest, ShowsThatAPredictionStopped) {
  test::write_synthetic_campaign(dir_);
  edit("predictions.json",
       [](Json& json) { json["predictions"][2]["status"] = "failed: <0.1> is too stiff"; });
  EXPECT_THAT(page().text, HasSubstr("failed: <0.1> is too stiff"));
}

TEST_F(ReportTest, SaysHowFarTheSeedsLieApart) {
  test::write_synthetic_campaign(dir_);
  Record first = Record::read_csv(dir_ / "records/uni-0.69-s1/record.csv");
  for (double& P : first["P"]) P = 1;
  first.write_csv(dir_ / "records/uni-0.69-s1/record.csv");
  for (double& P : first["P"]) P = 1.1;
  first.write_csv(dir_ / "records/uni-0.69-s2/record.csv");
  // 0.1 / sqrt((1 + 1.1^2) / 2)
  EXPECT_THAT(page().text, HasSubstr("scatter between seeds9.5 %"));
}

TEST_F(ReportTest, TellsSeedsApartByTheirGrey) {
  test::write_synthetic_campaign(dir_);
  const std::string html = report_html(dir_);
  const std::string figure = html.substr(html.find("id=\"figure-prediction-1\""));
  const auto colour_of = [&](const std::string& label) {
    const std::string group = figure.substr(figure.find("<title>" + label + "</title>"));
    std::smatch found;
    return std::regex_search(group, found, std::regex("rgb\\([^)]*\\)")) ? found.str() : "";
  };
  EXPECT_EQ(colour_of("DEM, seed 1"), "rgb(102, 102, 102)");
  EXPECT_EQ(colour_of("DEM, seed 2"), "rgb(176, 176, 176)");
  const std::string legend = figure.substr(0, figure.find("class=\"plot\""));
  EXPECT_THAT(legend, HasSubstr("</svg>DEM</span>"));
  EXPECT_THAT(legend, Not(HasSubstr("seed")));
}

TEST_F(ReportTest, DoesNotClaimThatNoFitReadThePredictedTests) {
  test::write_synthetic_campaign(dir_);  // fits the uniaxial tests, for comparison
  const auto text = page().text;
  EXPECT_THAT(text, HasSubstr("tests that no fit behind these parameters has read"));
  EXPECT_THAT(text, Not(HasSubstr("tests that no fit has read")));
}

TEST_F(ReportTest, SaysThatPredictionsAreOfOtherParameters) {
  test::write_synthetic_campaign(dir_);
  const auto text_with = [&](const Json& parameters_digest) {
    edit("predictions.json", [&](Json& json) { json["parameters_digest"] = parameters_digest; });
    return page().text;
  };
  const std::string note = "made with another parameter set than parameters.json holds now";
  EXPECT_THAT(page().text, Not(HasSubstr(note)));
  EXPECT_THAT(text_with(digest(read_file(dir_ / "parameters.json"))), Not(HasSubstr(note)));
  EXPECT_THAT(text_with(digest("other")), HasSubstr(note));
  fs::remove(dir_ / "parameters.json");
  EXPECT_THAT(text_with(digest("other")), Not(HasSubstr(note)));
}

TEST_F(ReportTest, NamesItsOwnBuildAndRecordsOfOthers) {
  test::write_synthetic_campaign(dir_);
  const auto text = page().text;
  EXPECT_THAT(text, HasSubstr("grainlaw " + version() + ", commit " + commit() + ": constitutive laws"));
  EXPECT_THAT(text, HasSubstr("another grainlaw than this report: 0.1.0, commit abc1234 (18 runs)."));
  for (const auto& record : fs::directory_iterator(dir_ / "records")) {
    edit(fs::relative(record.path(), dir_) / "provenance.json", [](Json& json) {
      json["version"] = version();
      json["commit"] = commit();
    });
  }
  EXPECT_THAT(page().text, Not(HasSubstr("Warning: records")));
  edit("records/iso-s1/provenance.json", [](Json& json) { json["simd"] = "sse2"; });
  EXPECT_THAT(page().text,
              HasSubstr("Warning: records were made with different instruction sets: sse2 (1 run), "
                        "AVX2 (17 runs)."));
}

// Sixty grains sheared to and fro so fast that they fly: what their run warned of, and in how many of its
// rows, stands in the report; of jammed ones that are sheared more slowly it says nothing like it.
TEST_F(ReportTest, WarnsOfARateThatMakesGrainsFly) {
  const auto run = [&](const std::string& name, const std::string& nu, const std::string& rate) {
    const auto shear = [&](const std::string& amount) {
      return R"({"mode": "d2", "amount": )" + amount + R"(, "rate": )" + rate + "}";
    };
    const std::string scene =
        R"({"preparation": {"count": 60, "rate": 1e-2, "relax": {"duration": 10}, "nu": )" + nu +
        R"(}, "measure": {"rows": 10}, "path": {"segments": [{"repeat": 3, "segments": [)" + shear("0.4") +
        ", " + shear("-0.4") + "]}]}}";
    dem::run_element_test(dem::Scene::read(Reader(parse_json(scene, "scene.json"), "scene.json"), ""),
                          dir_ / "records" / name);
  };
  run("fast", "0.55", "0.3");
  run("slow", "0.75", "0.003");
  const Record record = Record::read_csv(dir_ / "records/fast/record.csv");
  int bearing = 0, flying = 0;
  for (std::size_t i = 0; i < record.rows(); ++i) {
    if (!(record["P"][i] >= 1e-3)) continue;  // load-bearing
    ++bearing;
    if (record["Ek_over_Ep"][i] > 1) ++flying;
  }
  ASSERT_GT(flying, 0);
  const std::string warning = "fast: Ek/Ep is above 1 in " + std::to_string(flying) + " of " +
                              std::to_string(bearing) + " load-bearing rows: the grains fly";
  const auto parsed = page();
  EXPECT_THAT(parsed.problems, IsEmpty());
  EXPECT_THAT(parsed.ids, Contains("warnings"));
  EXPECT_THAT(parsed.links, Contains("#warnings"));
  EXPECT_THAT(parsed.text, HasSubstr(warning));
  EXPECT_THAT(parsed.text, Not(HasSubstr("slow: Ek/Ep is above 1 in")));
}

TEST_F(ReportTest, ExplainsItsSymbols) {
  test::write_synthetic_campaign(dir_);
  const auto text = page().text;
  for (const char* name : {"nu_c_contacts", "phi_SJ", "gamma_b", "particle-step", "Fv_alpha"})
    EXPECT_THAT(text, HasSubstr(name));
}

TEST_F(ReportTest, EscapesHostileNames) {
  const fs::path canary = dir_.parent_path() / (dir_.filename().string() + "-canary");
  test::Synthetic options;
  options.name = "<script>alert(1)</script>\"'&";
  options.uniaxial_test = "u<script>\"'&{x}^_@`id > " + canary.filename().string() + "`\\ν";
  test::write_synthetic_campaign(dir_, options);
  const auto parsed = page();
  EXPECT_THAT(parsed.problems, IsEmpty());
  EXPECT_THAT(parsed.tags, Not(Contains("script")));
  EXPECT_THAT(parsed.text, HasSubstr(options.name));
  EXPECT_THAT(parsed.text, HasSubstr("UNI: " + options.uniaxial_test));
  EXPECT_FALSE(fs::exists(canary));
}

TEST_F(ReportTest, NamesRunsOfTheCampaignThatAreMissing) {
  test::write_synthetic_campaign(dir_);
  fs::rename(dir_ / "records" / "d3-0.72-s2", dir_ / "records" / "d3-0.72-s2.part");
  const auto parsed = page();
  EXPECT_THAT(parsed.problems, IsEmpty());
  EXPECT_THAT(parsed.text, HasSubstr("1 of 18 tests of the campaign have not been run to their end"));
  EXPECT_THAT(parsed.text, HasSubstr("not finished"));
}

TEST_F(ReportTest, ReadsNoPredictionOutsideItsFolder) {
  test::write_synthetic_campaign(dir_);
  fs::copy(dir_ / "predictions" / "d3-0.72-s1.coupled.csv", dir_.string() + "-outside.csv");
  edit("predictions.json", [&](Json& json) {
    for (Json& entry : json["predictions"]) entry["file"] = "../" + dir_.filename().string() + "-outside.csv";
  });
  const std::string html = report_html(dir_);
  fs::remove(dir_.string() + "-outside.csv");
  EXPECT_THAT(html, Not(HasSubstr("<title>coupled</title>")));
}

TEST_F(ReportTest, RefusesAFolderThatHoldsNothing) {
  EXPECT_THROW(report_html(dir_), Error);
  fs::create_directories(dir_);
  EXPECT_THROW(report_html(dir_), Error);
}

/// What may happen to a file.
enum class Harm { gone, cut, empty_object, wrong_type };

/// "missing" or "unreadable" with each file that the report could not show, in alphabetical order.
std::vector<std::string> names_of(const std::vector<Gap>& gaps) {
  std::vector<std::string> names;
  for (const Gap& gap : gaps)
    names.push_back((gap.kind == Gap::Kind::missing ? "missing " : "unreadable ") + gap.file);
  std::sort(names.begin(), names.end());
  return names;
}

TEST_F(ReportTest, TellsUnreadableFilesFromMissingOnes) {
  test::write_synthetic_campaign(dir_);
  EXPECT_THAT(write_report(dir_), IsEmpty());
  write_file(dir_ / "campaign.json", "[");
  write_file(dir_ / "fits.json", "{}");
  write_file(dir_ / "parameters.json", "{}");
  fs::remove(dir_ / "timing.json");
  Record record = Record::read_csv(dir_ / "records/iso-s1/record.csv");
  std::string csv = record.to_csv();
  write_file(dir_ / "records/iso-s1/record.csv", csv.replace(csv.find(",s_dev,"), 7, ",other,"));
  EXPECT_THAT(names_of(write_report(dir_)),
              ElementsAre("missing timing.json", "unreadable campaign.json", "unreadable fits.json",
                          "unreadable parameters.json", "unreadable records/iso-s1/record.csv"));
  EXPECT_TRUE(fs::exists(dir_ / "report.html"));
}

class DamagedReport : public ReportTest,
                      public ::testing::WithParamInterface<std::tuple<const char*, Harm>> {};

TEST_P(DamagedReport, SaysWhatIsMissing) {
  const auto& [file, harm] = GetParam();
  test::write_synthetic_campaign(dir_);
  const std::string whole = read_file(dir_ / file);
  const bool csv = fs::path(file).extension() == ".csv";
  if (harm == Harm::gone) fs::remove(dir_ / file);
  if (harm == Harm::cut)
    std::ofstream(dir_ / file, std::ios::binary) << whole.substr(0, whole.size() / 2 - 3);
  if (harm == Harm::empty_object) std::ofstream(dir_ / file) << (csv ? "" : "{}");
  if (harm == Harm::wrong_type) {
    std::ofstream(dir_ / file) << (csv ? "nu,eps_dev\n0.7,nan\n"
                                       : R"([{"fits": 3, "stages": "x", "material": []}])");
  }
  const auto gaps = names_of(write_report(dir_));
  const auto parsed = test::parse(read_file(dir_ / "report.html"));
  EXPECT_THAT(parsed.problems, IsEmpty());
  EXPECT_THAT(gaps, Contains((harm == Harm::gone ? "missing " : "unreadable ") + std::string(file)));
  EXPECT_THAT(parsed.text, HasSubstr(file));
  EXPECT_FALSE(std::regex_search(parsed.text, std::regex("\\b(nan|inf)\\b")) && harm != Harm::wrong_type);
}

INSTANTIATE_TEST_SUITE_P(
    EachFile, DamagedReport,
    ::testing::Combine(::testing::Values("campaign.json", "parameters.json", "fits.json", "predictions.json",
                                         "timing.json", "records/iso-s1/record.csv",
                                         "records/iso-s1/scene.json", "records/d2-0.711-s1/provenance.json",
                                         "predictions/uni-0.69-s1.coupled.csv"),
                       ::testing::Values(Harm::gone, Harm::cut, Harm::empty_object, Harm::wrong_type)));

}  // namespace
}  // namespace grainlaw::report
