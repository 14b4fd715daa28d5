#include "grainlaw/apps/report/inputs.hpp"

#include <algorithm>
#include <functional>

#include "grainlaw/apps/report/numbers.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/element/file.hpp"
#include "grainlaw/element/material.hpp"

namespace grainlaw::report {
namespace {

namespace fs = std::filesystem;

/// An error's text with the folder cut off the front of its file name.
std::string short_reason(const Error& error, const fs::path& file) {
  std::string reason = error.what();
  const std::string prefix = file.string() + ": ";
  if (reason.starts_with(prefix)) reason.erase(0, prefix.size());
  return reason;
}

/// The key without which a file says nothing, and what it must hold.
struct Core {
  const char* key;
  Json::value_t type;
};
constexpr Core campaign_core{"tests", Json::value_t::array}, parameters_core{"format", Json::value_t::string},
    fits_core{"fits", Json::value_t::array}, predictions_core{"predictions", Json::value_t::array},
    timing_core{"stages", Json::value_t::array}, scene_core{"path", Json::value_t::object},
    provenance_core{"version", Json::value_t::string};

const char* type_name(Json::value_t type) {
  if (type == Json::value_t::array) return "a list";
  return type == Json::value_t::object ? "an object" : "text";
}

Json load_with(const fs::path& file, const Core& core) {
  Json json = load_json(file);
  if (value_in(json, core.key).type() != core.type)
    throw Error(file.string(), core.key, std::string("must be ") + type_name(core.type));
  return json;
}

/// What `load` makes of a file; a gap and an empty result where it is missing or `load` throws Error.
template <class Result>
Result read_or_note(Inputs& inputs, const std::string& name,
                    const std::function<Result(const fs::path&)>& load) {
  const fs::path file = inputs.dir / name;
  std::error_code ignored;
  if (!fs::exists(file, ignored)) {
    inputs.gaps.push_back({Gap::Kind::missing, name, "is not there"});
    return {};
  }
  try {
    return load(file);
  } catch (const Error& error) {
    inputs.gaps.push_back({Gap::Kind::unreadable, name, short_reason(error, file)});
    return {};
  }
}

Json read_json(Inputs& inputs, const std::string& name, const Core& core) {
  return read_or_note<Json>(inputs, name, [&](const fs::path& file) { return load_with(file, core); });
}

std::optional<Record> read_record(Inputs& inputs, const std::string& name) {
  return read_or_note<std::optional<Record>>(inputs, name, [](const fs::path& file) {
    return Record::read_csv(file, {"nu", "eps_dev", "P", "sigma_dev", "s_dev", "F_dev"});
  });
}

/// The first mode of a path that is not relax.
std::string first_mode(const Json& path) {
  const Json& segments = value_in(path, "segments");
  if (!segments.is_array()) return "";
  for (const Json& segment : segments) {
    const std::string nested = first_mode(segment);
    if (!nested.empty()) return nested;
    const std::string mode = text_in(segment, "mode");
    if (!mode.empty() && mode != "relax") return mode;
  }
  return "";
}

/// The campaign's test that a run belongs to: of the same name, or (where `from` lists several states) NAME
/// of NAME-x.
const Json& test_of(const Json& campaign, const std::string& name) {
  static const Json none;
  const Json& tests = value_in(campaign, "tests");
  if (!tests.is_array()) return none;
  const Json* best = &none;
  std::size_t best_length = 0;
  for (const Json& test : tests) {
    const std::string own = text_in(test, "name");
    const bool fits = name == own || name.starts_with(own + "-");
    if (!own.empty() && fits && own.size() > best_length) {
      best = &test;
      best_length = own.size();
    }
  }
  return *best;
}

/// Names TEST of one test of the campaign, with a list of starting states written out.
std::vector<std::string> names_of(const Json& test) {
  const std::string name = text_in(test, "name");
  const std::vector<double> states = numbers_in(value_in(test, "from"), "nu");
  if (states.empty()) return {name};
  std::vector<std::string> names;
  for (const double nu : states) names.push_back(name + "-" + to_text(nu));
  return names;
}

/// Every TEST-sSEED that the campaign asks for, in its order.
std::vector<std::string> expected_runs(const Json& campaign) {
  std::vector<std::string> expected;
  const Json& tests = value_in(campaign, "tests");
  if (!tests.is_array()) return expected;
  for (const Json& test : tests) {
    const std::vector<double> seeds =
        numbers_in(value_in(test, "seeds").is_array() ? test : campaign, "seeds");
    for (const std::string& name : names_of(test)) {
      for (const double seed : seeds) expected.push_back(name + "-s" + to_text(seed));
    }
  }
  return expected;
}

Run read_run(Inputs& inputs, const std::string& name, bool finished) {
  Run run;
  run.name = name;
  std::tie(run.test, run.seed) = split_seed(name);
  run.unfinished = !finished;
  if (finished) {
    const std::string folder = "records/" + name + "/";
    run.record = read_record(inputs, folder + "record.csv");
    run.scene = read_json(inputs, folder + "scene.json", scene_core);
    run.provenance = read_json(inputs, folder + "provenance.json", provenance_core);
  }
  const Json& test = test_of(inputs.campaign, run.test);
  run.role = text_in(test, "role");
  run.mode = first_mode(value_in(run.scene, "path"));
  if (run.mode.empty()) run.mode = first_mode(value_in(test, "path"));
  return run;
}

void read_runs(Inputs& inputs) {
  std::vector<std::string> names = expected_runs(inputs.campaign);
  std::vector<std::string> found;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(inputs.dir / "records", ignored)) {
    const std::string name = entry.path().filename().string();
    if (entry.is_directory(ignored) && !name.ends_with(".part")) found.push_back(name);
  }
  std::sort(found.begin(), found.end());
  for (const std::string& name : found) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  for (const std::string& name : names) {
    inputs.runs.push_back(read_run(inputs, name, std::binary_search(found.begin(), found.end(), name)));
  }
  const auto unfinished =
      std::count_if(inputs.runs.begin(), inputs.runs.end(), [](const Run& run) { return run.unfinished; });
  if (inputs.runs.empty()) inputs.gaps.push_back({Gap::Kind::missing, "records", "holds no test"});
  if (unfinished > 0) {
    inputs.gaps.push_back({Gap::Kind::missing, "records",
                           std::to_string(unfinished) + " of " + std::to_string(names.size()) +
                               " tests of the campaign have not been run to their end"});
  }
}

/// True if a file named by predictions.json lies inside the campaign folder.
bool stays_inside(const fs::path& file) {
  return !file.empty() && file.is_relative() && std::find(file.begin(), file.end(), "..") == file.end();
}

/// True if the predictions name the parameter set they were made with, and parameters.json is another.
bool outdated(const Inputs& inputs) {
  const std::string made_with = text_in(inputs.predictions, "parameters_digest");
  return !made_with.empty() && !inputs.parameters.is_null() &&
         made_with != digest(read_file(inputs.dir / "parameters.json"));
}

std::vector<PredictedRun> predicted_runs(Inputs& inputs, const char* key) {
  std::vector<PredictedRun> runs;
  const Json& entries = value_in(inputs.predictions, key);
  if (!entries.is_array()) return runs;
  for (const Json& entry : entries) {
    PredictedRun run;
    run.entry = entry;
    run.test = split_seed(text_in(entry, "test")).first;
    run.form = text_in(entry, "form");
    const std::string file = text_in(entry, "file");
    if (stays_inside(file)) run.record = read_record(inputs, file);
    runs.push_back(std::move(run));
  }
  return runs;
}

void read_predictions(Inputs& inputs) {
  inputs.predictions_outdated = outdated(inputs);
  inputs.predicted = predicted_runs(inputs, "predictions");
  inputs.predicted_memory = predicted_runs(inputs, "memory");
}

}  // namespace

std::pair<std::string, std::optional<int>> split_seed(const std::string& name) {
  const auto at = name.rfind("-s");
  if (at == std::string::npos || at + 2 == name.size() || name.size() - at > 10) return {name, std::nullopt};
  const std::string digits = name.substr(at + 2);
  if (digits.find_first_not_of("0123456789") != std::string::npos) return {name, std::nullopt};
  return {name.substr(0, at), std::stoi(digits)};
}

const Run* Inputs::run(const std::string& name) const {
  const auto found = std::find_if(runs.begin(), runs.end(), [&](const Run& r) { return r.name == name; });
  return found == runs.end() ? nullptr : &*found;
}

std::optional<double> Inputs::stress_unit_kPa() const {
  for (const Json* source : {&parameters, &campaign}) {
    const Json& material = value_in(*source, "material");
    const auto k = number_in(material, "k"), r_mean = number_in(material, "r_mean");
    if (!k || !r_mean || *k <= 0 || *r_mean <= 0) continue;
    Material grains;
    grains.k = *k;
    grains.r_mean = *r_mean;
    return grains.stress_unit_kPa();
  }
  return std::nullopt;
}

Inputs read_inputs(const fs::path& dir) {
  std::error_code ignored;
  if (!fs::is_directory(dir, ignored)) throw Error(dir.string(), "", "is not a folder");
  Inputs inputs;
  inputs.dir = dir;
  inputs.campaign = read_json(inputs, "campaign.json", campaign_core);
  inputs.parameters = read_json(inputs, "parameters.json", parameters_core);
  inputs.fits = read_json(inputs, "fits.json", fits_core);
  inputs.predictions = read_json(inputs, "predictions.json", predictions_core);
  inputs.timing = read_json(inputs, "timing.json", timing_core);
  read_runs(inputs);
  read_predictions(inputs);
  const bool nothing_there = inputs.campaign.is_null() && inputs.parameters.is_null() &&
                             inputs.fits.is_null() && inputs.predictions.is_null() &&
                             inputs.timing.is_null() && inputs.runs.empty();
  if (nothing_there)
    throw Error(dir.string(), "",
                "holds nothing of a campaign: no campaign.json, records/, parameters.json, "
                "fits.json, predictions.json or timing.json that can be read");
  return inputs;
}

}  // namespace grainlaw::report
