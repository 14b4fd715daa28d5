// Predicts a D2 test: usage predict_d2 PARAMETERS.json PATH.json
#include <grainlaw/model/predict.hpp>
#include <iostream>

int main(int, char** argv) {
  const auto parameters = grainlaw::model::ParameterSet::load(argv[1]);
  const auto path = grainlaw::Path::read(grainlaw::Reader(grainlaw::load_json(argv[2]), argv[2]));
  const auto prediction = grainlaw::model::predict(parameters, path);
  const auto& s_dev = prediction.record["s_dev"];
  std::cout << prediction.record.rows() << " rows, s_dev from " << s_dev.front() << " to " << s_dev.back()
            << '\n';
  return s_dev.front() < s_dev.back() && s_dev.back() < 0.3 ? 0 : 1;
}
