// grainlaw probe: small-strain moduli of the packings in snapshots, by linear response and by strains
// applied.
#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "grainlaw/apps/arguments.hpp"
#include "grainlaw/apps/commands.hpp"
#include "grainlaw/apps/snapshot_scene.hpp"
#include "grainlaw/apps/terminal.hpp"
#include "grainlaw/dem/linear_response.hpp"
#include "grainlaw/dem/minimise.hpp"
#include "grainlaw/dem/probe.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/element/record.hpp"

namespace grainlaw::apps {

namespace {

namespace fs = std::filesystem;
constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
constexpr std::array names{"xx", "yy", "zz", "yz", "xz", "xy"};

struct Arguments {
  std::vector<std::string> snapshots, amplitudes;
  std::string output, scene, axis = "d2", residual;
};

struct Plan {
  StrainTensor axis;
  std::vector<double> amplitudes;
  double residual;
};

std::vector<std::string> columns() {
  std::vector<std::string> list{"file",
                                "frame",
                                "segment",
                                "nu",
                                "P",
                                "sigma_dev",
                                "F_v",
                                "F_dev",
                                "C_star",
                                "f_NR",
                                "residual",
                                "amplitude",
                                "B",
                                "A1",
                                "A2",
                                "G_oct",
                                "contacts_changed",
                                "unstable"};
  for (std::size_t a = 0; a < 6; ++a)
    for (std::size_t b = a; b < 6; ++b) list.push_back(fmt::format("E_{}_{}", names[a], names[b]));
  return list;
}

Plan plan_of(const Arguments& arguments) {
  Plan plan;
  if (arguments.axis != "d2" && arguments.axis != "d3")
    throw Error("", "--axis", "must be d2 (-1, 1, 0) or d3 (-1/2, -1/2, 1), got " + arguments.axis);
  plan.axis = arguments.axis == "d2" ? StrainTensor{-1, 1, 0} : StrainTensor{-0.5, -0.5, 1};
  for (const std::string& text : arguments.amplitudes)
    plan.amplitudes.push_back(read_number("--amplitude", text, between(1e-8, 0.1)));
  plan.residual =
      arguments.residual.empty() ? 1e-10 : read_number("--residual", arguments.residual, between(1e-13, 0.1));
  return plan;
}

/// What is measured of one packing, row by row.
class Probing {
 public:
  Probing(const Plan& plan, const Material& material, const dem::State& state, std::vector<double> place)
      : plan_(plan), k_star_(material.stress_unit()), packing_(material, state), head_(std::move(place)) {
    dem::MinimiseOptions options;
    options.residual = plan.residual;
    result_ = dem::minimise(packing_, options);
    const dem::Measurement m = packing_.measure();
    head_.insert(
        head_.end(),
        {m.nu, trace(m.stress) / 3 / k_star_, signed_deviator(m.stress, plan.axis) / k_star_, trace(m.fabric),
         signed_deviator(m.fabric, plan.axis), m.C_star, m.f_NR, result_.balance.residual});
  }
  /// In balance, with a backbone: there is something to probe.
  bool bears() const { return result_.balance.jammed && result_.outcome != dem::Outcome::gave_up; }
  std::string text() const { return result_.text(); }

  void write(Record& record) {
    const dem::LinearResponse response = dem::linear_response(packing_);
    append(record, 0, dem::moduli_of(response.stress, plan_.axis), 0, response.unstable, &response.energy);
    for (const double amplitude : plan_.amplitudes)
      for (const double signed_amplitude : {amplitude, -amplitude}) {
        const dem::Probe probe = dem::probe(packing_, plan_.axis, signed_amplitude, plan_.residual);
        append(record, signed_amplitude, probe.moduli, static_cast<double>(probe.contacts_changed), nothing,
               nullptr);
      }
  }

 private:
  void append(Record& record, double amplitude, const dem::Moduli& moduli, double changed, double unstable,
              const dem::Stiffness* energy) const {
    std::vector<double> row = head_;
    row.insert(row.end(), {amplitude, moduli.B / k_star_, moduli.A1 / k_star_, moduli.A2 / k_star_,
                           moduli.G_oct / k_star_, changed, unstable});
    for (std::size_t a = 0; a < 6; ++a)
      for (std::size_t b = a; b < 6; ++b)
        row.push_back(energy != nullptr ? (*energy)[a][b] / k_star_ : nothing);
    record.append(row);
  }

  const Plan& plan_;
  double k_star_;
  dem::StaticPacking packing_;
  dem::MinimiseResult result_;
  std::vector<double> head_;
};

int run(const Arguments& arguments) {
  const Plan plan = plan_of(arguments);
  std::vector<fs::path> scenes, inputs;
  for (const std::string& file : arguments.snapshots) {
    scenes.push_back(scene_file_of(file, arguments.scene));
    inputs.insert(inputs.end(), {file, scenes.back()});
  }
  check_output("-o", arguments.output, inputs);
  Terminal terminal;
  Record record(columns());
  std::size_t probed = 0;
  for (std::size_t n = 0; n < arguments.snapshots.size(); ++n) {
    const std::string& file = arguments.snapshots[n];
    const std::size_t frames = dem::list_frames(file).size();
    for (std::size_t k = 0; k < frames; ++k) {
      terminal.draw(fmt::format("{}: frame {} of {}", file, k + 1, frames));
      const dem::FrameChoice choice{.nu = {}, .frame = k, .segment = {}};
      const dem::Frame frame = dem::read_whole_frame(file, choice);
      const dem::Scene scene = scene_of_frame(scenes[n], file, choice, frame.state);
      Probing probing(
          plan, scene.material, frame.state,
          {static_cast<double>(n), static_cast<double>(k), static_cast<double>(frame.observables.segment)});
      if (!probing.bears()) {
        terminal.warn(fmt::format("{}: frame {} is left out: {}", file, k, probing.text()));
        continue;
      }
      probing.write(record);
      ++probed;
    }
  }
  record.write_csv(arguments.output);
  terminal.say(fmt::format("wrote {}: moduli of {} packings", arguments.output, probed));
  return all_well;
}

}  // namespace

Action add_probe(CLI::App& program) {
  CLI::App* command = program.add_subcommand(
      "probe",
      "Small-strain moduli of packings: all 21 constants by linear response, and by strains applied");
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("SNAPSHOTS.h5", arguments->snapshots, "snapshots of records; every frame is probed")
      ->required();
  command->add_option("-o,--output", arguments->output, "table to write")
      ->type_name("MODULI.csv")
      ->required();
  command
      ->add_option("--amplitude", arguments->amplitudes,
                   "also apply this strain, forwards and backwards; may be repeated")
      ->type_name("STRAIN");
  command->add_option("--axis", arguments->axis, "axis of shear: d2 or d3 (default: d2)")->type_name("MODE");
  command
      ->add_option("--residual", arguments->residual,
                   "largest net force over the mean contact force of a packing in balance (default: 1e-10)")
      ->type_name("NUMBER");
  command
      ->add_option("--scene", arguments->scene, "where the material stands (default: scene.json beside them)")
      ->type_name("SCENE.json");
  command->footer(
      "Examples:\n"
      "  grainlaw probe out/d2/snapshots.h5 -o moduli.csv\n"
      "  grainlaw probe out/d2/snapshots.h5 --amplitude 1e-6 --amplitude 1e-3 -o moduli.csv");
  return [arguments] { return run(*arguments); };
}

}  // namespace grainlaw::apps
