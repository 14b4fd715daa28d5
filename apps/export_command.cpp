// grainlaw export: a frame of snapshots.h5 in a format that other programs read.
#include <fmt/format.h>

#include <filesystem>
#include <limits>
#include <memory>
#include <string>

#include "grainlaw/apps/arguments.hpp"
#include "grainlaw/apps/commands.hpp"
#include "grainlaw/apps/snapshot_scene.hpp"
#include "grainlaw/apps/terminal.hpp"
#include "grainlaw/dem/files/lammps_data.hpp"
#include "grainlaw/dem/files/snapshot.hpp"
#include "grainlaw/dem/record/vtp.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/element/file.hpp"

namespace grainlaw::apps {

namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::string snapshots, output, scene, nu, frame, segment;
};

void check_extension(const fs::path& output) {
  if (output.extension() != ".vtp" && output.extension() != ".data")
    throw Error("", "-o", "must end in .vtp (ParaView) or .data (LAMMPS), got " + output.string());
}

dem::FrameChoice read_choice(const Arguments& arguments) {
  constexpr long most = std::numeric_limits<long>::max();
  dem::FrameChoice choice;
  if (!arguments.nu.empty()) choice.nu = read_number("--nu", arguments.nu, inside(0, 1));
  if (!arguments.frame.empty())
    choice.frame = static_cast<std::uint64_t>(read_whole_number("--frame", arguments.frame, 0, most));
  if (!arguments.segment.empty())
    choice.segment = static_cast<std::uint64_t>(read_whole_number("--segment", arguments.segment, 0, most));
  return choice;
}

int run(const Arguments& arguments) {
  check_extension(arguments.output);
  const dem::FrameChoice choice = read_choice(arguments);
  const fs::path scene_file = scene_file_of(arguments.snapshots, arguments.scene);
  check_output("-o", arguments.output, {arguments.snapshots, scene_file});
  const dem::Frame frame = dem::read_whole_frame(arguments.snapshots, choice);
  const dem::Scene scene = scene_of_frame(scene_file, arguments.snapshots, choice, frame.state);
  write_file(arguments.output, fs::path(arguments.output).extension() == ".vtp"
                                   ? dem::vtp_text(frame, scene.material)
                                   : dem::lammps_data(frame.state, scene.material));
  Terminal().say(fmt::format("wrote {}: frame {}, {} grains at nu = {:.6g}", arguments.output, frame.index,
                             frame.state.count(), frame.observables.nu));
  return all_well;
}

}  // namespace

Action add_export(CLI::App& program) {
  CLI::App* command = program.add_subcommand(
      "export",
      "A packing and its force chains for ParaView (FILE.vtp), or a packing for LAMMPS (FILE.data)");
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("SNAPSHOTS.h5", arguments->snapshots, "snapshots of a record")->required();
  command->add_option("-o,--output", arguments->output, "file to write; its ending says the format")
      ->type_name("FILE.vtp|FILE.data")
      ->required();
  CLI::Option* nu = command->add_option("--nu", arguments->nu, "the frame nearest to this volume fraction")
                        ->type_name("NUMBER");
  CLI::Option* segment = command->add_option("--segment", arguments->segment, "only frames of this segment")
                             ->type_name("NUMBER");
  command->add_option("--frame", arguments->frame, "this frame, from 0 (default: the last)")
      ->type_name("NUMBER")
      ->excludes(nu)
      ->excludes(segment);
  command
      ->add_option("--scene", arguments->scene, "where the material stands (default: scene.json beside them)")
      ->type_name("SCENE.json");
  command->footer(
      "Examples:\n"
      "  grainlaw export out/d2/snapshots.h5 -o d2.vtp\n"
      "  grainlaw export out/quick/records/iso-s1/snapshots.h5 --nu 0.7 -o packing.data");
  return [arguments] { return run(*arguments); };
}

}  // namespace grainlaw::apps
