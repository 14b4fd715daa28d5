#include "grainlaw/calibrate/predict_records.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "grainlaw/calibrate/fit_input.hpp"
#include "grainlaw/calibrate/memory_tapping.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/element/file.hpp"
#include "grainlaw/model/predict.hpp"
#include "grainlaw/model/predict_minimal.hpp"

namespace grainlaw::calibrate {
namespace {

namespace fs = std::filesystem;

/// The thesis's forms, the coupled one with every term past the thesis that the set has numbers for and the
/// test can show, and the one with memory with these.
std::vector<model::Choice> choices_for(const TestRecord& test, const model::ParameterSet& parameters) {
  std::vector<model::Choice> choices;
  for (const model::Form form : {model::Form::reduced_closed, model::Form::reduced, model::Form::coupled})
    choices.push_back({form, {}});
  model::Terms terms;
  terms.axial = (test.mode == "uni" || test.mode == "d3") && parameters.shear_axial.has_value();
  terms.volumetric = test.mode == "uni" && parameters.volumetric.has_value();
  terms.energy = parameters.moduli && parameters.moduli->a_F.has_value();
  if (terms != model::Terms{}) choices.push_back({model::Form::coupled, terms});
  terms.energy = false;
  const auto& memory = parameters.memory;
  if (memory && memory->eps_r) choices.push_back({model::Form::memory, terms});
  return choices;
}

/// What a prediction and a record have in common and the law claims to know.
const std::vector<std::string> compared{"P", "sigma_dev", "s_dev", "F_v", "F_dev", "C", "C_star", "f_NR"};

const std::vector<double>& column_or_none(const Record& record, const std::string& column) {
  static const std::vector<double> none;
  return record.has(column) ? record[column] : none;
}

Json errors_of(const Record& predicted, const Record& measured) {
  Json errors = Json::object();
  for (const std::string& column : compared) {
    const double distance =
        relative_distance(column_or_none(predicted, column), column_or_none(measured, column));
    errors[column] = nullptr;
    if (std::isfinite(distance)) errors[column] = distance;
  }
  return errors;
}

/// How many rows stand behind each of these errors, and how many do not.
Json rows_of(const Record& predicted, const Record& measured) {
  Json rows = Json::object();
  for (const std::string& column : compared) {
    const RowCount count = count_rows(column_or_none(predicted, column), column_or_none(measured, column));
    rows[column] = {{"compared", count.compared}, {"missed", count.missed}};
  }
  return rows;
}

/// Path of the test, to be started where the record starts. Nothing else of the record is used.
Path path_of(const TestRecord& test) {
  Path path = test.path;
  path.start = Start{};
  path.start.nu = test.nu_start;
  return path;
}

/// "ok", or "unjammed: carries no stress at the end: ..."
std::string in_words(const model::Status& status) {
  return model::name_of(status.code) + (status.message.empty() ? "" : ": " + status.message);
}

/// One form of the law, as it follows a path.
struct Predictor {
  std::string form;
  std::function<model::Prediction(const Path&, const std::vector<model::Sample>&)> predict;
};

Predictor integrated(const model::Choice& choice, const model::ParameterSet& parameters) {
  return {model::name_of(choice), [&parameters, choice](const Path& path, const auto& samples) {
            model::PredictOptions options;
            options.form = choice.form;
            options.terms = choice.terms;
            return model::predict(parameters, path, samples, options);
          }};
}

Predictor minimal(const model::ParameterSet& parameters) {
  return {model::minimal_name, [&parameters](const Path& path, const auto& samples) {
            return model::predict_minimal(parameters, path, samples);
          }};
}

Json predict_one(const TestRecord& test, const Path& path, const Predictor& law, const fs::path& dir) {
  Json json{{"test", test.name}, {"mode", test.mode}, {"seed", nullptr}, {"form", law.form}};
  if (test.seed.find_first_not_of("0123456789") == std::string::npos) json["seed"] = std::stoll(test.seed);
  model::Prediction prediction;
  try {
    prediction = law.predict(path, model::samples_of(test.rows, path, test.nu_start));
    json["status"] = in_words(prediction.status);
  } catch (const Error& error) {
    // A path that the law cannot take, or a group that the set lacks, is a finding about this form, not the
    // end.
    json["status"] = std::string("refused: ") + error.what();
  }
  const bool walked = prediction.record.rows() > 0;
  json["start"] = walked ? prediction.start : Json();
  json["errors"] = errors_of(prediction.record, test.rows);
  json["rows"] = rows_of(prediction.record, test.rows);
  json["warnings"] = prediction.warnings;
  json["file"] = nullptr;
  json["record"] = fs::relative(test.dir / "record.csv", dir).generic_string();
  if (!walked) return json;
  const fs::path file = fs::path("predictions") / (test.name + "." + law.form + ".csv");
  prediction.record.write_csv(dir / file);
  json["file"] = file.generic_string();
  return json;
}

/// The largest volume fraction of the one compression on whose way back this packing of role memory was taken
/// up, or nothing where it starts as prepared; none where its past is another.
std::optional<Start> past_of(const RecordFolder& folder, const TestRecord& test) {
  Start start;
  start.nu = test.nu_start;
  if (!test.from) return start;
  for (const TestRecord& origin : folder.tests) {
    if (origin.name != test.from->record || origin.sheared_along) continue;
    std::size_t compressions = 0;
    for (std::size_t leg = 0; leg <= test.from->leg && leg < origin.legs.size(); ++leg)
      compressions += origin.legs[leg].eps_vol[1] > origin.legs[leg].eps_vol[0] ? 1 : 0;
    if (compressions > 1) return std::nullopt;
    if (compressions == 1) start.phi_max = largest_nu(origin, test.from->leg);
    return start;
  }
  return std::nullopt;
}

/// Fig. 5.4: over-compression and shear of role memory by the minimal form, from what the campaign did to
/// their packings before.
Json predict_memory(const RecordFolder& folder, const model::ParameterSet& parameters, const fs::path& dir) {
  Json predictions = Json::array();
  if (!parameters.memory || !parameters.near_jamming) return predictions;
  for (const TestRecord& test : folder.tests) {
    const bool takes = (test.mode == "iso" || test.mode == "d2") && !test.sheared_along;
    if (test.role != Role::memory || !takes) continue;
    const auto start = past_of(folder, test);
    if (!start) continue;
    Path path = test.path;
    path.start = *start;
    predictions.push_back(predict_one(test, path, minimal(parameters), dir));
  }
  return predictions;
}

}  // namespace

double relative_distance(const std::vector<double>& predicted, const std::vector<double>& measured) {
  double difference = 0, size = 0;
  for (std::size_t i = 0; i < std::min(predicted.size(), measured.size()); ++i) {
    if (!std::isfinite(predicted[i]) || !std::isfinite(measured[i])) continue;
    difference += (predicted[i] - measured[i]) * (predicted[i] - measured[i]);
    size += measured[i] * measured[i];
  }
  return size > 0 ? std::sqrt(difference / size) : std::numeric_limits<double>::quiet_NaN();
}

RowCount count_rows(const std::vector<double>& predicted, const std::vector<double>& measured) {
  RowCount count;
  for (std::size_t i = 0; i < std::max(predicted.size(), measured.size()); ++i) {
    const bool here = i < predicted.size() && std::isfinite(predicted[i]);
    const bool there = i < measured.size() && std::isfinite(measured[i]);
    count.compared += here && there ? 1 : 0;
    count.missed += here != there ? 1 : 0;
  }
  return count;
}

Json predict_records(const fs::path& dir, const model::ParameterSet& parameters) {
  const RecordFolder folder = read_records(dir);
  Json predictions = Json::array();
  if (folder.campaign) fs::remove_all(dir / "predictions");  // of an earlier parameter set
  fs::create_directories(dir / "predictions");
  for (const TestRecord& test : folder.tests) {
    if (test.role != Role::predict) continue;
    for (const model::Choice& choice : choices_for(test, parameters))
      predictions.push_back(predict_one(test, path_of(test), integrated(choice, parameters), dir));
    if (parameters.memory && parameters.near_jamming)
      predictions.push_back(predict_one(test, path_of(test), minimal(parameters), dir));
  }
  Json out{{"parameters_digest", digest(parameters.to_json().dump(2) + "\n")},
           {"predictions", predictions},
           {"memory", predict_memory(folder, parameters, dir)}};
  write_file(dir / "predictions.json", out.dump(2) + "\n");
  return out;
}

}  // namespace grainlaw::calibrate
