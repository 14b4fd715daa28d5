#include "grainlaw/calibrate/fit_selection.hpp"

#include <cmath>

#include "grainlaw/calibrate/fit_errors.hpp"
#include "grainlaw/calibrate/shear_projection.hpp"
#include "grainlaw/element/error.hpp"

namespace grainlaw::calibrate {
namespace {

/// Rows of the legs from `leg` to before `end`.
std::vector<std::size_t> rows_of_legs(const TestRecord& test, std::size_t leg, std::size_t end) {
  std::vector<std::size_t> rows;
  const std::vector<double>& segment = test.rows["segment"];
  for (std::size_t i = 0; i < segment.size(); ++i) {
    const auto at = static_cast<std::size_t>(segment[i]);
    if (at >= leg && at < end) rows.push_back(i);
  }
  return rows;
}

std::vector<std::size_t> rows_of_first_loading(const TestRecord& test) {
  return rows_of_legs(test, first_shear_leg(test), end_of_first_loading(test));
}

/// Slow enough to be a state; a record that does not say is taken at its word.
bool at_rest(const TestRecord& test, std::size_t row, const Selection& selection) {
  if (!test.rows.has("Ek_over_Ep")) return true;
  const double ratio = test.rows["Ek_over_Ep"][row];
  return ratio <= selection.Ek_over_Ep_max;  // an empty field (no contact) is not at rest
}

bool has_contacts(const TestRecord& test, std::size_t row) {
  return std::isfinite(test.rows["C"][row] + test.rows["C_star"][row] + test.rows["f_NR"][row]);
}

PackingState state_at(const TestRecord& test, std::size_t row) {
  PackingState s;
  s.nu = test.rows["nu"][row];
  s.P = test.rows["P"][row];
  s.C = test.rows["C"][row];
  s.C_star = test.rows["C_star"][row];
  s.phi_r = 1 - test.rows["f_NR"][row];
  return s;
}

SeriesMean mean_over(const TestRecord& test, const std::string& column,
                     const std::vector<std::size_t>& rows) {
  std::vector<double> values;
  for (const std::size_t row : rows) values.push_back(test.rows[column][row]);
  return mean_of_series(values);
}

std::string number(double value) { return to_text(value); }

std::string cut_short_at(const TestRecord& test, const std::string& column, const std::string& what_lacks) {
  return "it was cut short at " + column + " = " + number(test.rows[column].back()) + ", " + what_lacks +
         ": " + test.cut_short;
}

}  // namespace

PackingSeries unloading_leg(const TestRecord& test, std::size_t leg, const Selection& selection,
                            Counted& counted) {
  PackingSeries series{test.name, test.seed, {}};
  counted = {};
  for (const std::size_t row : rows_of_legs(test, leg, leg + 1)) {
    const bool take =
        test.rows["P"][row] >= selection.P_min && at_rest(test, row, selection) && has_contacts(test, row);
    if (take) series.states.push_back(state_at(test, row));
    ++(take ? counted.rows : counted.left_out);
  }
  const bool reached = leg + 1 < test.legs.size() || test.cut_short.empty();
  if (!reached && test.rows["P"].back() >= selection.P_min) {
    series.states.clear();
    counted.reason = cut_short_at(test, "nu", "before its unloading came to P < " + number(selection.P_min));
  } else if (counted.rows == 0)
    counted.reason = "no row of its unloading is jammed (P >= " + number(selection.P_min) + ")";
  return series;
}

PackingSeries unloading_branch(const TestRecord& test, const Selection& selection, Counted& counted) {
  const std::size_t leg = last_unloading_leg(test);
  if (leg < test.legs.size()) return unloading_leg(test, leg, selection, counted);
  counted = {};
  counted.reason = "its path never decreases the volume fraction, and these laws are fitted to unloading";
  return {test.name, test.seed, {}};
}

std::string unloading_rule(const Selection& selection) {
  return "rows of the last leg in which nu decreases, with P >= " + number(selection.P_min) +
         " and Ek_over_Ep <= " + number(selection.Ek_over_Ep_max);
}

PackingSeries steady_state(const TestRecord& test, const Selection& selection, Counted& counted) {
  PackingSeries series{test.name, test.seed, {}};
  counted = {};
  std::vector<std::size_t> rows;
  for (const std::size_t row : rows_of_first_loading(test)) {
    const bool take = std::abs(test.rows["eps_dev"][row]) >= selection.steady_from && has_contacts(test, row);
    if (take) rows.push_back(row);
    ++(take ? counted.rows : counted.left_out);
  }
  if (rows.size() < selection.steady_rows) {
    counted.reason = "only " + std::to_string(rows.size()) +
                     " rows of its first loading have |eps_dev| >= " + number(selection.steady_from) +
                     ", and a steady state takes " + std::to_string(selection.steady_rows);
    return series;
  }
  const SeriesMean P = mean_over(test, "P", rows), C_star = mean_over(test, "C_star", rows);
  const SeriesMean f_NR = mean_over(test, "f_NR", rows);
  if (P.mean < selection.P_min) {
    counted.reason = "its steady state is not jammed throughout: mean P " + number(P.mean) + " < " +
                     number(selection.P_min);
    return series;
  }
  series.states.push_back({mean_over(test, "nu", rows).mean, P.mean, mean_over(test, "C", rows).mean,
                           C_star.mean, 1 - f_NR.mean, P.error, C_star.error, f_NR.error});
  return series;
}

std::string steady_rule(const Selection& selection) {
  return "one point per run: means over the rows of the first loading with |eps_dev| >= " +
         number(selection.steady_from) + ", of runs whose mean P >= " + number(selection.P_min);
}

ShearCurve first_loading(const TestRecord& test, const std::string& quantity, const Selection& selection,
                         Counted& counted) {
  ShearCurve curve{test.name, test.seed, 0, {}, {}, false};
  counted = {};
  const std::size_t leg = first_shear_leg(test);
  if (leg == test.legs.size()) {
    counted.reason = "its path has no d2 or d3 segment";
    return curve;
  }
  const Leg& ran = test.legs[leg];
  const ShearColumn column = shear_column(test, leg, quantity);
  curve.projected = column.projected;
  const double direction = ran.eps_dev[1] > ran.eps_dev[0] ? 1 : -1;
  double P = 0;
  for (const std::size_t row : rows_of_first_loading(test)) {
    const double value = column.values[row];
    ++(std::isfinite(value) ? counted.rows : counted.left_out);
    if (!std::isfinite(value)) continue;
    curve.strain.push_back(direction * (test.rows["eps_dev"][row] - ran.eps_dev[0]));
    curve.value.push_back(direction * value);
    curve.nu += test.rows["nu"][row];
    P += test.rows["P"][row];
  }
  const auto rows = static_cast<double>(counted.rows);
  curve.nu /= rows;
  const bool steady = !curve.strain.empty() && curve.strain.back() >= selection.steady_from;
  if (!test.cut_short.empty() && !steady) {
    counted.reason = cut_short_at(
        test, "eps_dev", "and a rate takes a loading to |eps_dev| >= " + number(selection.steady_from));
  } else if (counted.rows < selection.loading_rows) {
    counted.reason = "its first loading has only " + std::to_string(counted.rows) + " rows with " + quantity;
  } else if (P / rows < selection.P_min) {
    counted.reason = "it is not jammed throughout its first loading: mean P " + number(P / rows) + " < " +
                     number(selection.P_min);
  }
  return curve;
}

std::string loading_rule(const Selection& selection) {
  return "rows of the first loading, of runs whose mean P there >= " + number(selection.P_min);
}

std::optional<RunValue> steady_mean(const ShearCurve& curve, const Selection& selection) {
  std::vector<double> values;
  for (std::size_t i = 0; i < curve.strain.size(); ++i) {
    if (curve.strain[i] >= selection.steady_from) values.push_back(curve.value[i]);
  }
  if (values.size() < selection.steady_rows) return std::nullopt;
  const SeriesMean mean = mean_of_series(values);
  return RunValue{curve.test, curve.group, curve.nu, mean.mean, mean.error, true};
}

std::string steady_mean_rule(const Selection& selection) {
  return "the mean over the rows with |eps_dev| >= " + number(selection.steady_from);
}

}  // namespace grainlaw::calibrate
