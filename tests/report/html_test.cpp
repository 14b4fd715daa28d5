#include "grainlaw/apps/report/html.hpp"

#include <gtest/gtest.h>

#include "grainlaw/apps/report/prose.hpp"
#include "well_formed.hpp"

namespace grainlaw::report {
namespace {

TEST(ReportHtml, EscapesWhatMarkupReserves) {
  EXPECT_EQ(text("<b a=\"1\" c='2'>&").str(), "&lt;b a=&quot;1&quot; c=&#39;2&#39;&gt;&amp;");
}

TEST(ReportHtml, DropsWhatAPageMayNotContain) {
  EXPECT_EQ(text(std::string_view("a\0b\x01\x1f"
                                  "c\n",
                                  7))
                .str(),
            "abc\n");
  EXPECT_EQ(text("\xff\xc0\xaf ok \xed\xa0\x80").str(), "\uFFFD\uFFFD\uFFFD ok \uFFFD\uFFFD\uFFFD");
  EXPECT_EQ(text("ν → 𝛼 —").str(), "ν → 𝛼 —");
  EXPECT_EQ(text("cut \xe2\x88").str(), "cut \uFFFD\uFFFD");
}

TEST(ReportHtml, EscapesAttributes) {
  EXPECT_EQ(element("a", text("x"), {{"href", "\"><script>"}}).str(),
            "<a href=\"&quot;&gt;&lt;script&gt;\">x</a>");
}

TEST(ReportHtml, TablesNeedACellPerColumn) {
  Table table;
  table.column("A"_html).column("B"_html, Table::Kind::figures);
  EXPECT_THROW(table.row({"1"_html}), std::logic_error);
  table.row({"1"_html, "2"_html});
  EXPECT_TRUE(test::parse(table.html().str()).problems.empty());
  EXPECT_NE(table.html().str().find("<td class=\"n\">2</td>"), std::string::npos);
}

TEST(ReportHtml, TheCheckerOfTheseTestsFindsWhatIsWrong) {
  for (const char* bad :
       {"<p>", "<p></b>", "<p a=b></p>", "a & b", "<p id=\"x\"></p><p id=\"x\"></p>", "a < b", "&nbsp;"}) {
    EXPECT_FALSE(test::parse(bad).problems.empty()) << bad;
  }
  EXPECT_TRUE(test::parse("<p id=\"x\">a &lt; b<br/></p>").problems.empty());
}

TEST(ReportProse, TurnsNamesIntoSymbols) {
  EXPECT_EQ(prose("nu_c(ISO) > nu_c(D2)").str(),
            "<var>ν</var><sub>c</sub>(ISO) &gt; <var>ν</var><sub>c</sub>(D2)");
  EXPECT_EQ(prose("(nu - 1)^alpha").str(), "(<var>ν</var> − 1)<sup><var>α</var></sup>");
  EXPECT_EQ(prose("C* and P* and P").str(), "<var>C</var>* and <var>P</var>* and <var>P</var>*");
}

TEST(ReportProse, ReadsGreekLettersAndIndices) {
  EXPECT_EQ(
      prose("φ_c exp[−φ_v (ν/ν_c − 1)]").str(),
      "<var>φ</var><sub>c</sub> exp[−<var>φ</var><sub>v</sub> (<var>ν</var>/<var>ν</var><sub>c</sub> − 1)]");
  EXPECT_EQ(prose("s_0, x^α").str(), "<var>s</var><sub>0</sub>, x<sup><var>α</var></sup>");
  EXPECT_EQ(prose("rows with P >= 1e-4").str(), "rows with <var>P</var>* ≥ 1×10⁻⁴");
  EXPECT_EQ(prose("slope -0.5 ± 1e-12").str(), "slope −0.5 ± 1×10⁻¹²");
}

TEST(ReportProse, LeavesWordsAloneAndEscapesThem) {
  EXPECT_EQ(prose("a number <i>of</i> nuts").str(), "a number &lt;i&gt;of&lt;/i&gt; nuts");
  EXPECT_EQ(prose("d2-0.711-s1, C_star_free_C0, 4_x").str(), "d2-0.711-s1, C_star_free_C0, 4_x");
  EXPECT_EQ(prose("\xce").str(), "\uFFFD");
  EXPECT_EQ(prose("^").str(), "^");
  EXPECT_EQ(prose("").str(), "");
}

}  // namespace
}  // namespace grainlaw::report
