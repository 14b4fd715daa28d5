#include "grainlaw/calibrate/predict_records.hpp"

#include <array>
#include <cmath>
#include <optional>

#include "grainlaw/calibrate/fit_input.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/element/file.hpp"
#include "grainlaw/model/predict.hpp"

namespace grainlaw::calibrate {

namespace {

constexpr std::array<const char*, 4> compared{"P", "sigma_dev", "s_dev", "F_dev"};

std::string status_of(const model::Status& status) {
  std::string text = name_of(status.code);
  if (!status.message.empty()) text += ": " + status.message;
  return text;
}

Json errors_of(const Record& predicted, const Record& measured) {
  Json errors = Json::object();
  for (const char* column : compared) {
    std::vector<double> y = measured[column];
    y.resize(predicted.rows());  // a failed integration has fewer rows
    errors[column] = relative_error(predicted[column], y);
  }
  return errors;
}

/// One test in one form; fills the entry, and writes the prediction beside the record.
Json predict_one(const std::filesystem::path& dir, const TestRecord& test, model::Form form,
                 const model::ParameterSet& parameters) {
  const std::string file = "predictions/" + test.name + "." + name_of(form) + ".csv";
  Json entry{{"test", test.name}, {"mode", test.mode}, {"seed", test.seed}, {"form", name_of(form)}};
  Path path = test.path;
  path.start = {};
  path.start.nu = test.nu_start;
  model::PredictOptions options;
  options.form = form;
  std::optional<model::Prediction> prediction;
  try {
    const auto samples = model::samples_of(test.rows, path, test.nu_start);
    prediction = model::predict(parameters, path, samples, options);
  } catch (const Error& refusal) {
    entry["status"] = std::string("refused: ") + refusal.what();
  }
  if (prediction) {
    entry["status"] = status_of(prediction->status);
    entry["start"] = prediction->start;
    entry["warnings"] = prediction->warnings;
    entry["errors"] = errors_of(prediction->record, test.rows);
    prediction->record.write_csv(dir / file);
    entry["file"] = file;
  }
  entry["record"] = std::filesystem::relative(test.dir / "record.csv", dir).generic_string();
  return entry;
}

}  // namespace

Json relative_error(const std::vector<double>& predicted, const std::vector<double>& measured) {
  double difference = 0, size = 0;
  for (std::size_t i = 0; i < predicted.size(); ++i) {
    if (std::isnan(predicted[i]) || std::isnan(measured[i])) continue;
    difference += std::pow(predicted[i] - measured[i], 2);
    size += std::pow(measured[i], 2);
  }
  return size > 0 ? Json(std::sqrt(difference / size)) : Json();
}

Json predict_records(const std::filesystem::path& dir, const model::ParameterSet& parameters) {
  const RecordFolder folder = read_records(dir);
  std::filesystem::remove_all(dir / "predictions");
  std::filesystem::create_directories(dir / "predictions");
  Json list = Json::array();
  for (const TestRecord& test : folder.tests) {
    if (test.role != Role::predict) continue;
    for (const model::Form form : {model::Form::reduced_closed, model::Form::reduced, model::Form::coupled})
      list.push_back(predict_one(dir, test, form, parameters));
  }
  Json all{{"predictions", list}};
  write_file(dir / "predictions.json", all.dump(2) + "\n");
  return all;
}

}  // namespace grainlaw::calibrate
