// Walking the law in a test: predictions from a text, and the state at the end of a record.
#pragma once

#include <array>
#include <functional>
#include <string>

#include "checks.hpp"
#include "grainlaw/model/predict.hpp"

namespace grainlaw::model {

constexpr double tight_rtol = 1e-11, tight_atol = 1e-14;

inline Prediction walk(const std::string& path, const Choice& choice, int rows = 20,
                       const ParameterSet& parameters = thesis()) {
  return predict(parameters, path_of(path), {choice.form, tight_rtol, tight_atol, rows, choice.terms});
}
inline Prediction walk(const std::string& path, Form form, int rows = 20,
                       const ParameterSet& parameters = thesis()) {
  return walk(path, Choice{form, {}}, rows, parameters);
}

inline double last(const Prediction& prediction, const char* column) {
  return prediction.record[column].back();
}

/// Largest |a - b| over a column.
inline double difference(const Prediction& a, const Prediction& b, const char* column) {
  double most = a.record.rows() == b.record.rows() ? 0 : INFINITY;
  for (std::size_t i = 0; i < a.record.rows() && std::isfinite(most); ++i)
    most = std::max(most, std::abs(a.record[column][i] - b.record[column][i]));
  return most;
}

/// dy_i/dt of a form of the law at t of a stretch as a function of variable j, the others as in y.
template <class Form>
std::function<double(double)> rate_by(const Form& form, const Stretch& stretch, const Direction& direction,
                                      double t, const std::array<double, 3>& y, std::size_t i,
                                      std::size_t j) {
  return [=](double value) {
    auto moved = y;
    moved[j] = value;
    std::array<double, 3> dy{};
    EXPECT_TRUE(rate_at(form, stretch, direction, t, moved.data(), dy.data()));
    return dy[i];
  };
}

}  // namespace grainlaw::model
