// grainlaw export: the frame that was asked for, and bad input named before anything is written.
#include <gmock/gmock.h>

#include "program.hpp"

namespace grainlaw::apps {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class Export : public Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    write("s.json", R"({
      "preparation": {"count": 64, "rate": 1e-3, "relax": {"tolerance": 1e-3, "duration": 20}},
      "path": {"segments": [{"mode": "iso", "controls": {"nu": 0.74}, "rate": 1e-3},
                            {"mode": "iso", "controls": {"nu": 0.7}, "rate": 1e-3}]},
      "measure": {"rows": 2, "time_step": 0.2, "time_step_gas": 0.1, "snapshots": [
        {"segment": 0, "nu": 0.72}, {"segment": 0}, {"segment": 1, "nu": 0.72}, {"segment": 1}]}})");
    ASSERT_EQ(run({"simulate", "s.json", "-o", "r"}).status, 0);
  }
  std::string said(Arguments arguments) {
    arguments.insert(arguments.begin(), {"export", "r/snapshots.h5"});
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.out;
  }
};

TEST_F(Export, TheFrameThatWasAskedFor) {
  EXPECT_EQ(said({"-o", "p.vtp"}), "wrote p.vtp: frame 3, 64 grains at nu = 0.7\n");
  EXPECT_THAT(read("p.vtp"), HasSubstr("<VTKFile type=\"PolyData\""));
  EXPECT_THAT(said({"--frame", "1", "-o", "p.data"}), HasSubstr("frame 1, 64 grains at nu = 0.74"));
  EXPECT_THAT(read("p.data"), HasSubstr("64 atoms"));
  EXPECT_THAT(said({"--nu", "0.72", "--segment", "1", "-o", "p.data"}), HasSubstr("frame 2"));
}

TEST_F(Export, BadInput) {
  const auto refused = [&](Arguments arguments, const std::vector<std::string>& parts) {
    arguments.insert(arguments.begin(), {"export", "r/snapshots.h5"});
    return refuses(run(arguments), parts);
  };
  EXPECT_TRUE(refused({"-o", "p.png"}, {"-o: must end in .vtp (ParaView) or .data (LAMMPS), got p.png"}));
  EXPECT_TRUE(refused({"-o", "no/p.vtp"}, {"-o: must lie in a directory that exists, got no/p.vtp"}));
  EXPECT_TRUE(refused({"-o", "p.vtp", "--nu", "2"}, {"--nu: must be a number > 0 and < 1, got 2"}));
  EXPECT_TRUE(refused({"-o", "p.vtp", "--nu", "0.72"}, {"r/snapshots.h5", "segment"}));
  EXPECT_TRUE(refused({"-o", "p.vtp", "--frame", "4"}, {"r/snapshots.h5", "frame"}));
  EXPECT_TRUE(refused({"-o", "p.vtp", "--frame", "1", "--nu", "0.7"}, {"--nu excludes --frame"}));
  EXPECT_TRUE(refuses(run({"export", "no.h5", "-o", "p.vtp"}), {"no.h5: no such file"}));
  EXPECT_TRUE(refuses(run({"export", "s.json", "-o", "p.vtp"}), {"s.json"}));
  write("other.json", R"({"material": {"r_mean": 2}, "preparation": {"count": 64}, "path": {"segments": [
    {"mode": "relax"}]}})");
  EXPECT_TRUE(
      refused({"-o", "p.vtp", "--scene", "other.json"},
              {"other.json: material.r_mean: must be that of the grains in r/snapshots.h5, 1 mm, got 2"}));
  EXPECT_TRUE(refused({"-o", "p.vtp", "--scene", "no.json"}, {"no.json: no such file"}));
  fs::remove(folder / "r/scene.json");
  EXPECT_TRUE(refused({"-o", "p.vtp"}, {"r/snapshots.h5: has no scene.json beside it", "--scene"}));
  EXPECT_FALSE(fs::exists(folder / "p.vtp"));
}

}  // namespace
}  // namespace grainlaw::apps
