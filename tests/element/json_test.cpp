// Every refusal names file, key, value and what would be right.
#include "grainlaw/element/json.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "grainlaw/element/error.hpp"

namespace grainlaw {
namespace {

template <class Action>
std::string refusal(Action action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

Reader reader_of(const std::string& text) { return {parse_json(text, "a.json"), "a.json"}; }

TEST(Json, SyntaxErrorNamesTheLine) {
  EXPECT_EQ(refusal([] { parse_json("{\n\"a\": 1,\n}", "a.json"); }), "a.json: line 3 is not valid JSON");
  EXPECT_EQ(refusal([] { parse_json("", "a.json"); }), "a.json: line 1 is not valid JSON");
  EXPECT_EQ(refusal([] { parse_json("{\"a\": [1,\nNaN]}", "a.json"); }),
            "a.json: line 2 is not valid JSON: a number must be finite, got NaN");
  EXPECT_EQ(refusal([] { parse_json("{\"a\": -Infinity}", "a.json"); }),
            "a.json: line 1 is not valid JSON: a number must be finite, got -Infinity");
  EXPECT_EQ(refusal([] { parse_json("{\"a\": null, nan}", "a.json"); }),
            "a.json: line 1 is not valid JSON: a number must be finite, got nan");
  EXPECT_EQ(refusal([] { parse_json("{\n\"a\": 1,\n\"b\": -1e400}", "a.json"); }),
            "a.json: line 3: a number must be finite, got -1e400");
  EXPECT_EQ(refusal([] { parse_json("{\"note\": \"was 1e400\",\n\n\"a\": 1e400}", "a.json"); }),
            "a.json: line 3: a number must be finite, got 1e400");
  EXPECT_LT(refusal([] { parse_json("[" + std::string(100000, '9') + "]", "a.json"); }).size(), 120u);
}

TEST(Json, KeyGivenTwiceIsRefused) {
  EXPECT_EQ(refusal([] { parse_json(R"({"a": 1, "b": {"a": 2}, "a": 3})", "a.json"); }),
            "a.json: a: is given twice in one object");
}

TEST(Json, DeepNestingIsRefused) {
  EXPECT_THAT(refusal([] { parse_json(std::string(100000, '['), "a.json"); }),
              testing::HasSubstr("nested deeper"));
}

TEST(Json, MissingFileIsNamed) {
  EXPECT_EQ(refusal([] { load_json("/nowhere/scene.json"); }), "/nowhere/scene.json: no such file");
  EXPECT_EQ(refusal([] { load_json("/tmp"); }), "/tmp: is a directory, not a file");
}

TEST(Reader, NumberOutOfRange) {
  auto reader = reader_of(R"({"material": {"w": 0.5, "k": "hard"}})").object("material");
  EXPECT_EQ(refusal([&] { reader.number("w", at_least(1)); }), "a.json: material.w: must be >= 1, got 0.5");
  EXPECT_EQ(refusal([&] { reader.number("k", above(0)); }),
            "a.json: material.k: must be a number > 0, got \"hard\"");
  EXPECT_EQ(refusal([&] { reader.number("rho", above(0)); }), "a.json: material.rho: is missing");
  EXPECT_EQ(reader.number("rho", above(0), 2000), 2000);
}

TEST(Reader, OverflowingNumberIsRefused) {
  EXPECT_THAT(refusal([] { reader_of(R"({"a": 1e999})").number("a", any_number()); }),
              testing::HasSubstr("a.json"));
}

TEST(Reader, WholeNumbers) {
  auto reader = reader_of(R"({"a": 7, "b": 8.5, "c": 1e3, "d": 1e300})");
  EXPECT_EQ(refusal([&] { reader.integer("a", 8, 100); }),
            "a.json: a: must be a whole number from 8 to 100, got 7");
  EXPECT_THAT(refusal([&] { reader.integer("b", 8, 100); }), testing::HasSubstr("got 8.5"));
  EXPECT_EQ(reader.integer("c", 8, 1000), 1000);
  EXPECT_THAT(refusal([&] { reader.integer("d", 8, 1000); }), testing::HasSubstr("whole number"));
}

TEST(Reader, UnknownKeyNamesTheNearestKnownOne) {
  auto reader = reader_of(R"({"gama": 1})");
  reader.number("gamma", above(0), 1);
  reader.number("rho", above(0), 1);
  EXPECT_EQ(refusal([&] { reader.finish(); }), "a.json: gama: unknown key, did you mean gamma?");
  auto far = reader_of(R"({"zzzzzz": 1})");
  far.number("gamma", above(0), 1);
  far.number("rho", above(0), 1);
  EXPECT_EQ(refusal([&] { far.finish(); }), "a.json: zzzzzz: unknown key, known are gamma, rho");
}

TEST(Reader, WordsAndLists) {
  auto reader = reader_of(R"({"role": "guess", "list": [1, 2, "x"], "objects": [{"a": 1}, 5], "none": []})");
  EXPECT_EQ(refusal([&] {
              reader.word("role", {"fit", "predict"});
            }),
            "a.json: role: must be one of fit, predict, got \"guess\"");
  EXPECT_EQ(refusal([&] { reader.numbers("list", any_number()); }),
            "a.json: list[2]: must be a finite number, got \"x\"");
  EXPECT_EQ(refusal([&] { reader.objects("objects"); }),
            "a.json: objects[1]: must be an object {...}, got 5");
  EXPECT_EQ(refusal([&] { reader.objects("none"); }), "a.json: none: must have at least one entry, got []");
}

}  // namespace
}  // namespace grainlaw
