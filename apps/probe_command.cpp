// grainlaw probe: small-strain moduli of the packings in snapshots, by linear response and by strains
// applied.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "grainlaw/apps/arguments.hpp"
#include "grainlaw/apps/commands.hpp"
#include "grainlaw/apps/elastic_columns.hpp"
#include "grainlaw/apps/snapshot_scene.hpp"
#include "grainlaw/apps/terminal.hpp"
#include "grainlaw/dem/stiffness/probed_packing.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/element/moduli_table.hpp"

namespace grainlaw::apps {

namespace {

namespace fs = std::filesystem;
constexpr double least_over_residual = 1000;  // amplitude; else the strained packing may pass for balanced
constexpr double rounding = 1e-12;
constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

struct Arguments {
  std::vector<std::string> snapshots, amplitudes, also;
  std::string output, scene, axis = "d2", residual;
  bool undo = false;
};

struct Plan {
  StrainTensor axis;
  std::vector<double> amplitudes;
  double residual;
  bool undo;
  ElasticColumns also;
};

/// The strain of the probe beside the isotropic one.
StrainTensor axis_of(const std::string& name) {
  if (name == "d2") return {-1, 1, 0};
  if (name == "d3") return {-0.5, -0.5, 1};
  if (name == "uni") return {0, 0, 1};
  throw Error("", "--axis", "must be d2 (-1, 1, 0), d3 (-1/2, -1/2, 1) or uni (0, 0, 1), got " + name);
}

std::vector<std::string> columns(const Plan& plan) {
  std::vector<std::string> list = moduli_columns();
  if (plan.undo) list.insert(list.end(), undo_columns().begin(), undo_columns().end());
  const std::vector<std::string> also = plan.also.names();
  list.insert(list.end(), also.begin(), also.end());
  return list;
}

Plan plan_of(const Arguments& arguments) {
  const double residual = arguments.residual.empty() ? dem::ProbedPacking::balance
                                                     : read_number("--residual", arguments.residual,
                                                                   between(1e-13, largest_moduli_residual));
  Plan plan{axis_of(arguments.axis), {}, residual, arguments.undo, ElasticColumns(arguments.also)};
  if (plan.undo && arguments.amplitudes.empty())
    throw Error("", "--undo", "must come with a strain to undo: --amplitude");
  for (const std::string& text : arguments.amplitudes) {
    const double amplitude = read_number("--amplitude", text, between(1e-9, 0.1));
    if (std::ranges::find(plan.amplitudes, amplitude) != plan.amplitudes.end())
      throw Error("", "--amplitude", "must be given once for each strain; got " + text + " again");
    plan.amplitudes.push_back(amplitude);
    if (plan.amplitudes.back() < (1 - rounding) * least_over_residual * plan.residual)
      throw Error(
          "", "--amplitude",
          "must be at least 1000 times the residual, which is " + to_text(plan.residual) + "; got " + text);
  }
  return plan;
}

/// The rows of one packing that has moduli: what the options ask for stands behind the columns of every
/// table.
class Rows {
 public:
  Rows(const Plan& plan, const Material& material, dem::ProbedPacking& packing)
      : plan_(plan), material_(material), packing_(packing) {}

  std::vector<std::vector<double>> all() {
    std::vector<std::vector<double>> list{of_response()};
    for (const double amplitude : plan_.amplitudes)
      for (const double strain : {amplitude, -amplitude}) list.push_back(of_strain(strain));
    return list;
  }

 private:
  std::vector<double> of_response() {
    const dem::LinearResponse response = packing_.response();
    std::vector<double> row = packing_.row(response);
    if (plan_.undo) row.insert(row.end(), undo_columns().size(), nothing);
    const std::vector<double> also = plan_.also.values(packing_.packing(), response, material_, plan_.axis);
    row.insert(row.end(), also.begin(), also.end());
    return row;
  }
  std::vector<double> of_strain(double strain) const {
    const dem::Probe probe = packing_.probe(strain, plan_.undo);
    const double k_star = material_.stress_unit();
    std::vector<double> row = packing_.row(probe);
    if (plan_.undo)
      row.insert(row.end(), {count(probe.changed.by_volume), count(probe.changed.by_shear),
                             count(probe.contacts_left.by_volume), count(probe.contacts_left.by_shear),
                             probe.left.B / k_star, probe.left.A1 / k_star, probe.left.A2 / k_star,
                             probe.left.G_oct / k_star});
    row.insert(row.end(), plan_.also.names().size(), nothing);
    return row;
  }
  static double count(std::uint64_t n) { return static_cast<double>(n); }

  const Plan& plan_;
  const Material& material_;
  dem::ProbedPacking& packing_;
};

/// The snapshots of one file, all opened before the work begins.
struct Input {
  std::string file;
  fs::path scene;
  std::size_t frames;
};

std::vector<Input> open_all(const Arguments& arguments) {
  std::vector<Input> list;
  std::vector<fs::path> files;
  for (const std::string& file : arguments.snapshots) {
    const fs::path scene = scene_file_of(file, arguments.scene);
    const std::size_t frames = dem::list_frames(file).size();
    const dem::FrameChoice last;
    scene_of_frame(scene, file, last, dem::read_frame(file, last));
    list.push_back({file, scene, frames});
    files.insert(files.end(), {fs::path(file), scene});
  }
  check_output("-o", arguments.output, files);
  return list;
}

enum class Found { moduli, no_load, no_balance };

/// Adds the rows of a frame; says what became of it.
Found probe_frame(const Plan& plan, const Input& input, std::size_t number, std::size_t frame,
                  Terminal& terminal, Record& record) {
  const auto left_out = [&](const std::string& why) {
    terminal.warn(fmt::format("{}: frame {} is left out: {}", input.file, frame, why));
  };
  const dem::FrameChoice choice{.nu = {}, .frame = frame, .segment = {}};
  const dem::Frame read = dem::read_whole_frame(input.file, choice);
  const dem::Scene scene = scene_of_frame(input.scene, input.file, choice, read.state);
  const std::vector<double> place{static_cast<double>(number), static_cast<double>(frame),
                                  static_cast<double>(read.observables.segment), read.observables.eps_dev};
  const auto add = [&](const std::vector<double>& row) {
    std::vector<double> whole = place;
    whole.insert(whole.end(), row.begin(), row.end());
    record.append(whole);
  };
  try {
    dem::ProbedPacking packing(scene.material, read.state, plan.axis, plan.residual);
    if (const std::string why = packing.refusal(); !why.empty()) {
      left_out(why);
      return packing.in_balance() ? Found::no_load : Found::no_balance;
    }
    for (const auto& row : Rows(plan, scene.material, packing).all()) add(row);
    return Found::moduli;
  } catch (const Error& error) {
    left_out(error.what());
    return Found::no_balance;
  }
}

int run(const Arguments& arguments) {
  const Plan plan = plan_of(arguments);
  const std::vector<Input> inputs = open_all(arguments);
  Terminal terminal;
  Record record(columns(plan));
  std::size_t probed = 0, unbalanced = 0;
  for (std::size_t n = 0; n < inputs.size(); ++n)
    for (std::size_t k = 0; k < inputs[n].frames; ++k) {
      terminal.draw(fmt::format("{}: frame {} of {}", inputs[n].file, k + 1, inputs[n].frames));
      const Found found = probe_frame(plan, inputs[n], n, k, terminal, record);
      probed += found == Found::moduli ? 1 : 0;
      unbalanced += found == Found::no_balance ? 1 : 0;
    }
  record.write_csv(arguments.output);
  terminal.say(
      fmt::format("wrote {}: moduli of {} packing{}", arguments.output, probed, probed == 1 ? "" : "s"));
  return probed > 0 && unbalanced == 0 ? all_well : failed;
}

}  // namespace

Action add_probe(CLI::App& program) {
  CLI::App* command = program.add_subcommand("probe",
                                             "Small-strain moduli of packings: their 21 elastic constants by "
                                             "linear response, and by strains applied");
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("SNAPSHOTS.h5", arguments->snapshots, "snapshots of records; every frame is probed")
      ->required();
  command->add_option("-o,--output", arguments->output, "table to write")
      ->type_name("MODULI.csv")
      ->required();
  command
      ->add_option("--amplitude", arguments->amplitudes,
                   "also apply this strain, forwards and backwards; may be repeated")
      ->type_name("STRAIN")
      ->allow_extra_args(false);
  command->add_option("--axis", arguments->axis, "axis of shear: d2, d3 or uni (default: d2)")
      ->type_name("MODE");
  command->add_flag("--undo", arguments->undo, "take each strain back, too, and say what is left of it");
  command
      ->add_option("--also", arguments->also,
                   "more columns: eigenvalues, symmetry, young, waves, floppy, invariants, affine, stress; "
                   "separated by commas")
      ->type_name("NAMES")
      ->delimiter(',')
      ->allow_extra_args(false);
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
      "  grainlaw probe out/d2/snapshots.h5 --also eigenvalues,symmetry -o moduli.csv\n"
      "  grainlaw probe out/d2/snapshots.h5 --amplitude 1e-6 --amplitude 1e-3 --undo -o moduli.csv");
  return [arguments] { return run(*arguments); };
}

}  // namespace grainlaw::apps
