// Bad input, as users make it: each gets one line that names file, key, value and what would be right, status
// 2, and leaves nothing half-written.
#include <gmock/gmock.h>

#include <fstream>

#include "program.hpp"

namespace grainlaw::apps {
namespace {

namespace fs = std::filesystem;
using testing::IsEmpty;

/// A small scene with something put in place of something.
std::string scene(const std::string& what = "", const std::string& by = "") {
  std::string text = R"({
    "material": {"w": 3, "k": 1e5},
    "preparation": {"count": 64, "rate": 1e-3, "relax": {"tolerance": 1e-3, "duration": 20}},
    "path": {"segments": [{"mode": "iso", "controls": {"nu": 0.7}, "rate": 1e-4}]},
    "measure": {"rows": 10, "snapshots": [{"segment": 0}], "time_step": 0.2, "time_step_gas": 0.1}
  })";
  if (!what.empty()) text.replace(text.find(what), what.size(), by);
  return text;
}

class BadInput : public Program {
 protected:
  /// What simulate says to the scene; checks that nothing was written.
  Outcome simulate(const std::string& text) {
    write("s.json", text);
    const Outcome outcome = run({"simulate", "s.json", "-o", "out"});
    EXPECT_FALSE(fs::exists(folder / "out")) << text;
    EXPECT_FALSE(fs::exists(folder / "out.part")) << text;
    return outcome;
  }
};

TEST_F(BadInput, UnknownKey) {
  EXPECT_TRUE(
      refuses(simulate(scene(R"("w")", R"("W")")), {"s.json: material.W: unknown key, did you mean w?"}));
  EXPECT_TRUE(refuses(simulate(scene(R"("rows")", R"("rowss")")),
                      {"s.json: measure.rowss: unknown key, did you mean rows?"}));
  EXPECT_TRUE(refuses(simulate(scene(R"("nu")", R"("density")")),
                      {"s.json: path.segments[0].controls.density: unknown key"}));
}

TEST_F(BadInput, WrongType) {
  EXPECT_TRUE(refuses(simulate(scene("1e5", R"("stiff")")),
                      {"s.json: material.k: must be a number >= 1e-15 and <= 1e+15, got \"stiff\""}));
  EXPECT_TRUE(refuses(simulate(scene("64", "64.5")),
                      {"s.json: preparation.count: must be a whole number", "got 64.5"}));
  EXPECT_TRUE(refuses(simulate("[1, 2]"), {"s.json: must be an object", "got [1,2]"}));
  EXPECT_TRUE(refuses(simulate(scene("[{", "{").substr(0)), {"s.json: line"}));
  EXPECT_TRUE(refuses(simulate(scene("1e5", "1e999")), {"s.json"}));
}

TEST_F(BadInput, NotJson) {
  EXPECT_TRUE(refuses(simulate(""), {"s.json: line 1 is not valid JSON"}));
  EXPECT_TRUE(refuses(simulate(scene().substr(0, 200)), {"s.json: line", "is not valid JSON"}));
  EXPECT_TRUE(refuses(simulate(std::string(100, '\0')), {"s.json: line 1 is not valid JSON"}));
  EXPECT_TRUE(refuses(simulate(std::string(100'000, '[')), {"s.json"}));
  EXPECT_TRUE(refuses(simulate(scene(R"("w": 3)", R"("w": 3, "w": 2)")), {"s.json: w: is given twice"}));
}

TEST_F(BadInput, MissingFile) {
  EXPECT_TRUE(refuses(run({"simulate", "no.json", "-o", "out"}), {"no.json: no such file"}));
  EXPECT_TRUE(refuses(run({"calibrate", "no.json"}), {"no.json: no such file"}));
  EXPECT_TRUE(refuses(run({"predict", "no.json", "data/paths/uni.json"}), {"no.json: no such file"}));
  EXPECT_TRUE(refuses(run({"predict", "data/thesis/parameters.json", "no.json"}), {"no.json: no such file"}));
  EXPECT_TRUE(refuses(run({"fit", "no"}), {"no: no such directory"}));
  EXPECT_TRUE(refuses(run({"report", "no"}), {"no"}));
  EXPECT_TRUE(refuses(run({"simulate", "data", "-o", "out"}), {"data: is a directory, not a file"}));
  EXPECT_TRUE(
      refuses(simulate(scene(R"("count": 64, "rate": 1e-3, "relax": {"tolerance": 1e-3, "duration": 20})",
                             R"("snapshot": "no.h5")")),
              {"s.json: preparation.snapshot: must be a file", "no.h5"}));
}

TEST_F(BadInput, NumbersOutOfRange) {
  EXPECT_TRUE(
      refuses(simulate(scene(R"("w": 3)", R"("w": 0.5)")), {"s.json: material.w: must be >= 1", "got 0.5"}));
  EXPECT_TRUE(refuses(simulate(scene("64", "7")),
                      {"s.json: preparation.count: must be a whole number from 8", "got 7"}));
  EXPECT_TRUE(refuses(simulate(scene("1e5", "-1e5")),
                      {"s.json: material.k: must be >= 1e-15 and <= 1e+15, got -100000"}));
  for (const char* nu : {"0", "-0.0", "1", "-0.7", "1.5", "1e308"})
    EXPECT_TRUE(refuses(simulate(scene("0.7", nu)),
                        {"s.json: path.segments[0].controls.nu: must be > 0 and < 1, got"}))
        << nu;
}

TEST_F(BadInput, PathsThatCannotBeFollowed) {
  EXPECT_TRUE(refuses(simulate(scene(R"({"nu": 0.7})", R"({"nu": 0.7, "eps_vol": 0.1})")),
                      {"path.segments[0].controls", "redundant"}));
  EXPECT_TRUE(refuses(simulate(scene(R"([{"mode": "iso", "controls": {"nu": 0.7}, "rate": 1e-4}])", "[]")),
                      {"s.json: path.segments: must have at least one entry"}));
  write(
      "p.json",
      R"({"start": {"nu": 0.7}, "segments": [{"mode": "uni", "amount": 0.01}, {"mode": "d2", "amount": 0.1}]})");
  EXPECT_TRUE(refuses(run({"predict", "data/thesis/parameters.json", "p.json", "-o", "p.csv"}),
                      {"p.json: segments[1]"}));
  EXPECT_FALSE(fs::exists(folder / "p.csv"));
}

TEST_F(BadInput, ASnapshotCutShort) {
  write("s.json", scene());
  ASSERT_EQ(run({"simulate", "s.json", "-o", "first"}).status, 0);
  const auto full = fs::file_size(folder / "first/snapshots.h5");
  const std::string go_on =
      scene(R"("count": 64, "rate": 1e-3, "relax": {"tolerance": 1e-3, "duration": 20})",
            R"("snapshot": "first/snapshots.h5")");
  const std::string on = std::string(go_on).replace(go_on.find("0.7"), 3, "0.72");
  for (const double share : {0.9, 0.5, 0.1, 0.0}) {
    fs::resize_file(folder / "first/snapshots.h5",
                    static_cast<std::uintmax_t>(share * static_cast<double>(full)));
    EXPECT_TRUE(refuses(simulate(on), {"first/snapshots.h5: "})) << share;
  }
}

TEST_F(BadInput, ADirectoryThatHoldsSomething) {
  write("mine/notes.txt", "precious");
  write("s.json", scene());
  write("c.json", tiny_campaign());
  EXPECT_TRUE(refuses(run({"simulate", "s.json", "-o", "mine"}), {"mine: is not empty"}));
  EXPECT_TRUE(
      refuses(run({"calibrate", "c.json", "-o", "mine"}), {"mine: is not empty and holds no campaign"}));
  EXPECT_TRUE(refuses(run({"calibrate", "c.json", "-o", "mine", "--resume"}),
                      {"mine: holds no campaign to go on with"}));
  EXPECT_TRUE(
      refuses(run({"calibrate", "-o", "mispelt", "--resume"}), {"mispelt: holds no campaign to go on with"}));
  EXPECT_FALSE(fs::exists(folder / "mispelt"));
  EXPECT_TRUE(refuses(run({"calibrate", "c.json", "-o", "mine/notes.txt"}), {"mine/notes.txt: is a file"}));
  EXPECT_THAT(listing("mine"), testing::ElementsAre("notes.txt"));
}

TEST_F(BadInput, ADiskThatIsFull) {
  EXPECT_TRUE(
      refuses(run({"predict", "data/thesis/parameters.json", "data/paths/uni.json"}, {"/dev/full", -1}),
              {"standard output: cannot be written: No space left on device"}));
  EXPECT_TRUE(refuses(
      run({"predict", "data/thesis/parameters.json", "data/paths/uni.json", "-o", "p.csv"}, {"", 1000}),
      {"p.csv: cannot be written: File too large"}));
  write("s.json", scene());
  for (const long limit : {300L, 1000L, 3000L})  // scene.json, record.csv and snapshots.h5 do not fit
    EXPECT_TRUE(refuses(run({"simulate", "s.json", "-o", "out"}, {"", limit}), {"out"})) << limit;
  EXPECT_THAT(listing("out"), IsEmpty());
  for (const auto& name : listing(".")) EXPECT_EQ(name.find(".part"), std::string::npos) << name;
}

TEST_F(BadInput, AFolderThatCannotBeMade) {
  write("s.json", scene());
  write("c.json", tiny_campaign());
  EXPECT_TRUE(refuses(run({"simulate", "s.json", "-o", "/proc/no/out"}), {"/proc/no"}));
  EXPECT_TRUE(refuses(run({"calibrate", "c.json", "-o", "/proc/no/out"}), {"/proc/no/out: cannot be made"}));
  EXPECT_TRUE(
      refuses(run({"predict", "data/thesis/parameters.json", "data/paths/uni.json", "-o", "no/p.csv"}),
              {"-o: must lie in a directory that exists, got no/p.csv"}));
}

TEST_F(BadInput, AnOutputThatIsAnInput) {
  write("s.json", scene());
  ASSERT_EQ(run({"simulate", "s.json", "-o", "r/one"}).status, 0);
  const std::string record = read("r/one/record.csv");
  fs::copy_file(folder / "data/thesis/parameters.json", folder / "p.json");
  const std::string parameters = read("p.json");
  EXPECT_TRUE(
      refuses(run({"predict", "p.json", "data/paths/uni.json", "-o", "p.json"}), {"-o: must not be p.json"}));
  EXPECT_TRUE(refuses(run({"predict", "p.json", "r/one", "-o", "r/one/record.csv"}),
                      {"-o: must not be r/one/record.csv"}));
  EXPECT_TRUE(refuses(run({"fit", "r", "-o", "r/one/record.csv"}), {"-o: must not be r/one/record.csv"}));
  EXPECT_TRUE(refuses(run({"fit", "r", "-o", "f.json", "--fits", "./f.json"}),
                      {"--fits: must be another file than -o"}));
  EXPECT_TRUE(
      refuses(run({"fit", "r", "-o", "f.json", "--fits", "no/f.json"}), {"--fits: must lie in a directory"}));
  EXPECT_TRUE(refuses(run({"fit", "r", "-o", "f.json", "--memory", "no"}),
                      {"--memory: must be a directory with over_compression.csv, got no"}));
  EXPECT_TRUE(refuses(run({"fit", "r", "-o", "f.json", "--reversals", "no"}),
                      {"--reversals: must be a directory of records, got no"}));
  EXPECT_TRUE(refuses(run({"fit", "r", "-o", "f.json", "--reversals", "r"}),
                      {"r: must hold d2 tests of role fit that turn their shear round, found none"}));
  EXPECT_TRUE(refuses(run({"polish", "p.json", "r", "-o", "f.json", "--columns", "P,s_dev"}),
                      {"--columns: must be of P, sigma_dev, F_dev, got \"s_dev\""}));
  EXPECT_EQ(read("r/one/record.csv"), record);
  EXPECT_EQ(read("p.json"), parameters);
  EXPECT_FALSE(fs::exists(folder / "f.json"));
}

TEST_F(BadInput, NumbersBeyondSense) {
  for (const char* k : {"1e308", "1e-300", "0", "-0.0"})
    EXPECT_TRUE(refuses(simulate(scene("1e5", k)), {"s.json: material.k: must be >= 1e-15"})) << k;
  EXPECT_TRUE(refuses(simulate(scene("1e-3", "1e308")), {"s.json: preparation.rate: must be > 0 and <= "}));
  write("p.json", R"({"start": {"nu": 0.7, "P": 1e308}, "segments": [{"mode": "uni", "amount": 0.01}]})");
  EXPECT_TRUE(refuses(run({"predict", "data/thesis/parameters.json", "p.json", "--si"}),
                      {"p.json: start.P: must be"}));
  write("p.json", R"({"start": {"nu": 0.7}, "segments": [{"mode": "d2", "controls": {"eps_dev": 1e308}}]})");
  EXPECT_TRUE(refuses(run({"predict", "data/thesis/parameters.json", "p.json"}),
                      {"p.json: segments[0].controls.eps_dev: must be >= -100 and <= 100"}));
}

TEST_F(BadInput, ARecordThatNoPackingCanHave) {
  write("s.json", scene());
  ASSERT_EQ(run({"simulate", "s.json", "-o", "r/one"}).status, 0);
  const std::string table = read("r/one/record.csv");
  write("r/one/record.csv", table.substr(0, table.rfind('\n', table.size() - 2) + 1));  // a line less
  EXPECT_TRUE(refuses(run({"fit", "r"}), {"r/one/record.csv: must have ", "rows as its scene says, got "}));
  const auto line = table.find('\n') + 1;
  const auto nu =
      table.find(",0.", line);  // eps_vol and eps_dev are 0 in the first row, written without a point
  write("r/one/record.csv", table.substr(0, nu) + ",-7." + table.substr(nu + 3));
  EXPECT_TRUE(refuses(run({"fit", "r"}), {"r/one/record.csv: nu: line 2: must be > 0 and < 1, got -7."}));
}

TEST_F(BadInput, CommandLines) {
  const std::vector<std::pair<Arguments, std::string>> lines{
      {{}, "grainlaw: A subcommand is required"},
      {{"calibrat"}, "unknown command \"calibrat\"; known are calibrate, simulate, predict"},
      {{"calibrat"}, "infer-phij (did you mean calibrate?); see grainlaw --help"},
      {{"polarise"}, "infer-phij; see grainlaw --help"},
      {{"bench"}, "grainlaw bench: must be followed by one of dem, model; see grainlaw bench --help"},
      {{"bench", "models"},
       "grainlaw bench: must be followed by one of dem, model; see grainlaw bench --help"},
      {{"infer-phij", "r.csv", "--mode", "iso2"}, "--mode: must be one of iso, uni, d2, d3, got \"iso2\""},
      {{"infer-phij", "r.csv", "--scatter", "-1"}, "--scatter: must be a number >= 0 and <= 0.1, got -1"},
      {{"--vesion"}, "grainlaw: unknown option --vesion (did you mean --version?); see grainlaw --help"},
      {{"simulate", "s.json", "--explian"},
       "grainlaw simulate: unknown option --explian (did you mean --explain?); see grainlaw simulate --help"},
      {{"simulate", "s.json", "--thread=2", "-o", "out"},
       "unknown option --thread (did you mean --threads?)"},
      {{"--threads", "2", "simulate", "s.json", "-o", "out"}, "option --threads must stand behind simulate"},
      {{"bench", "dem", "--cuont", "9261"}, "unknown option --cuont (did you mean --count?)"},
      {{"simulate", "s.json", "-q"}, "grainlaw simulate: unknown option -q; see grainlaw simulate --help"},
      {{"simulate", "s.json", "--", "-t.json"}, "The following argument was not expected: -t.json"},
      {{"predict", "a", "b", "-3"}, "grainlaw predict: The following argument was not expected: -3"},
      {{"predict", "a", "b", "--=3"}, "grainlaw predict: The following argument was not expected: --=3"},
      {{"simulate"}, "grainlaw simulate: SCENE.json is required; see grainlaw simulate --help"},
      {{"simulate", "s.json"}, "simulate: -o DIR is missing"},
      {{"calibrate", "--jobs", "0"}, "--jobs: must be a whole number from 1 to 1024, got 0"},
      {{"calibrate", "--jobs", "many"}, "--jobs: must be a whole number from 1 to 1024, got many"},
      {{"calibrate", "a", "b"}, "grainlaw calibrate: The following argument was not expected: b"},
      {{"predict", "a", "b", "--rtol", "0"}, "--rtol: must be a number >= 1e-12 and <= 0.1, got 0"},
      {{"predict", "a", "b", "--rows", "-3"}, "--rows: must be a whole number from 1 to 100000, got -3"},
      {{"predict", "a", "b", "--form", "plastic"}, "coupled_3_14 or minimal, got \"plastic\""},
      {{"predict", "a", "b", "--form", "minimal+axial"}, "--form: minimal takes no terms"},
  };
  for (const auto& [arguments, message] : lines) EXPECT_TRUE(refuses(run(arguments), {message})) << message;
}

}  // namespace
}  // namespace grainlaw::apps
