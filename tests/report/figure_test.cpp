#include "grainlaw/apps/report/figure.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "grainlaw/apps/report/svg.hpp"
#include "grainlaw/apps/report/symbols.hpp"
#include "grainlaw/element/error.hpp"
#include "well_formed.hpp"

namespace grainlaw::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::size_t occurrences(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

Figure figure_with(std::vector<Series> series) {
  Figure figure;
  figure.name = "test";
  figure.alt = "a test";
  const auto areas = grid(figure, 1, 1, 200, 64);
  figure.panels.push_back(
      {areas[0], "a title", axis_label("nu", ""), axis_label("P", ""), std::move(series), {}, {}});
  return figure;
}

TEST(ReportFigure, DrawsEveryDot) {
  const auto html =
      draw(figure_with({{"DEM", Draw::dots, "#0072b2", {1, 2, std::nan(""), 4}, {1, 2, 3, 5}}})).str();
  EXPECT_EQ(occurrences(html, "h0"), 3u);
  EXPECT_TRUE(test::parse(html).problems.empty()) << test::parse(html).problems[0];
}

TEST(ReportFigure, AnUndefinedValueBreaksALine) {
  const double nan = std::nan("");
  const auto html =
      draw(figure_with({{"law", Draw::line, "#123456", {1, 2, 3, 4, 5}, {1, 2, nan, 4, 5}}})).str();
  const auto at = html.find("<path stroke='rgb( 18,  52,  86)'");
  ASSERT_NE(at, std::string::npos);
  EXPECT_EQ(occurrences(html.substr(at, html.find("/>", at) - at), "M"), 2u);
}

TEST(ReportFigure, AShadeReachesDownToTheEdgeOfThePanel) {
  const Figure figure = figure_with({{"chance", Draw::shade, "#0072b2", {1, 2}, {0.5, 0.5}},
                                     {"error", Draw::dots, "#0072b2", {1, 2}, {0.1, 1}}});
  const auto html = draw(figure).str();
  const auto at = html.find("<polygon fill = 'rgb(  0, 114, 178)' fill-opacity = '0.15");
  ASSERT_NE(at, std::string::npos);
  const std::string shape = html.substr(at, html.find("/>", at) - at);
  const double bottom = figure.panels[0].area.top + figure.panels[0].area.height;
  double lowest = 0, highest = bottom;  // points are x,y, downwards
  for (auto comma = shape.find(',', shape.find("points")); comma != std::string::npos;
       comma = shape.find(',', comma + 1)) {
    const double y = std::stod(shape.substr(comma + 1));
    lowest = std::max(lowest, y);
    highest = std::min(highest, y);
  }
  EXPECT_NEAR(lowest, bottom, 0.5);
  EXPECT_LT(highest, bottom - 50);  // 0.5 of axes that begin below 0.1 and end above 1
}

TEST(ReportFigure, SaysSoWhereThereIsNothingToDraw) {
  EXPECT_THAT(draw(figure_with({})).str(), HasSubstr("nothing to draw"));
  EXPECT_THAT(draw(figure_with({{"a", Draw::line, "black", {std::nan("")}, {1}}})).str(),
              HasSubstr("nothing to draw"));
}

TEST(ReportFigure, ALogarithmicAxisLeavesOutWhatHasNoLogarithm) {
  Figure figure = figure_with({{"error", Draw::dots, "#0072b2", {10, 1000, 1e5, 1e6}, {1, 0.1, 0.01, 0}}});
  figure.panels[0].log_x = figure.panels[0].log_y = true;
  EXPECT_THAT(script(figure), HasSubstr("1 0\n3 -1\n5 -2\n"));
  const auto html = draw(figure).str();
  EXPECT_EQ(occurrences(html, "h0"), 3u);
  EXPECT_TRUE(test::parse(html).problems.empty()) << test::parse(html).problems[0];
}

TEST(ReportFigure, LegendNamesEachLabelOnce) {
  const auto html = draw(figure_with({{"seed 1", Draw::dots, "black", {1}, {1}},
                                      {"seed 1", Draw::line, "black", {1, 2}, {1, 2}}}))
                        .str();
  const std::string legend = html.substr(0, html.find("class=\"plot\""));
  EXPECT_EQ(occurrences(legend, "seed 1"), 1u);
}

TEST(ReportFigure, HasNoIdsThatCouldClash) {
  const auto html = draw(figure_with({{"a", Draw::dots, "black", {1, 2}, {1, 2}},
                                      {"b", Draw::bars, "black", {1, 2}, {1, 2}, {0.1, 0.1}}}))
                        .str();
  EXPECT_EQ(test::parse(html).ids, std::vector<std::string>{"figure-test"});
  EXPECT_THAT(html, Not(HasSubstr("href")));
}

TEST(ReportFigure, HoverTextNamesTheSeriesThatWasDrawn) {
  const auto html = draw(figure_with({{"absent", Draw::dots, "black", {}, {}},
                                      {"a < b", Draw::dots, "black", {1, 2}, {1, 2}}}))
                        .str();
  EXPECT_THAT(html, HasSubstr("<title>a &lt; b</title>"));
  EXPECT_THAT(html, Not(HasSubstr("<title>absent</title>")));
}

TEST(ReportFigure, KeepsAllTextInsideTheDrawing) {
  Figure figure = figure_with({{"a", Draw::line, "black", {0.66, 0.82}, {-0.0241234, -0.0241289}}});
  figure.panels[0].right_unit = 5e7;
  figure.panels[0].right_label = "{/:Italic P} (kPa)";
  const std::string html = draw(figure).str();
  std::size_t texts = 0;
  for (auto at = html.find("<g transform=\"translate("); at != std::string::npos;
       at = html.find("<g transform=\"translate(", at + 1)) {
    const double x = std::stod(html.substr(at + 24)), y = std::stod(html.substr(html.find(',', at) + 1));
    EXPECT_GT(x, 8);
    EXPECT_LT(x, figure.width - 4);
    EXPECT_GT(y, 8);
    EXPECT_LT(y, figure.height - 2);
    ++texts;
  }
  EXPECT_GT(texts, 10u);
  EXPECT_THAT(html, HasSubstr("kPa)"));
}

TEST(ReportFigure, HostileTitlesAreText) {
  Figure figure = figure_with({{"a", Draw::line, "black", {0, 1}, {0, 1}}});
  figure.panels[0].title = enhanced("</svg><script>'`id`{x}_^@&~\\");
  const auto page = test::parse(draw(figure).str());
  EXPECT_THAT(page.problems, ::testing::IsEmpty());
  EXPECT_THAT(page.text, HasSubstr("</svg><script>’`id`{x}_^@&~\\"));
  EXPECT_THAT(page.tags, Not(::testing::Contains("script")));
}

TEST(ReportFigure, RefusesSeriesOfUnequalLength) {
  EXPECT_THROW(draw(figure_with({{"a", Draw::line, "black", {0, 1}, {0}}})), std::logic_error);
}

TEST(ReportFigure, ThinningKeepsFirstAndLast) {
  std::vector<double> many(1001);
  for (std::size_t i = 0; i < many.size(); ++i) many[i] = static_cast<double>(i);
  const auto few = thinned(many, 11);
  EXPECT_EQ(few, (std::vector<double>{0, 100, 200, 300, 400, 500, 600, 700, 800, 900, 1000}));
  EXPECT_EQ(thinned({1, 2}, 10), (std::vector<double>{1, 2}));
}

TEST(ReportSvg, RefusesWhatIsNotGnuplots) {
  EXPECT_THROW(inline_svg("", {}, ""), Error);
  EXPECT_THROW(inline_svg("<svg viewBox=\"0 0 1 1\"></svg>", {}, ""), Error);
}

}  // namespace
}  // namespace grainlaw::report
