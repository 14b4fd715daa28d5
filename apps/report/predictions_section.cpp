#include <algorithm>
#include <array>
#include <cmath>

#include "grainlaw/apps/report/axis.hpp"
#include "grainlaw/apps/report/figure.hpp"
#include "grainlaw/apps/report/numbers.hpp"
#include "grainlaw/apps/report/prose.hpp"
#include "grainlaw/apps/report/sections.hpp"
#include "grainlaw/apps/report/seed_scatter.hpp"
#include "grainlaw/apps/report/symbols.hpp"

namespace grainlaw::report {
namespace {

constexpr std::size_t dots_per_run = 160, points_per_line = 400;

const std::vector<std::string>& quantities() {
  static const std::vector<std::string> names{"P", "sigma_dev", "s_dev", "F_dev"};
  return names;
}

/// All predictions of one test: every seed, every form.
struct TestPredictions {
  std::string test, mode;
  std::vector<const PredictedRun*> runs;
};

std::vector<TestPredictions> by_test(const Inputs& inputs) {
  std::vector<TestPredictions> tests;
  for (const PredictedRun& run : inputs.predicted) {
    auto found = std::find_if(tests.begin(), tests.end(), [&](const auto& t) { return t.test == run.test; });
    if (found == tests.end()) found = tests.insert(tests.end(), {run.test, text_in(run.entry, "mode"), {}});
    found->runs.push_back(&run);
  }
  return tests;
}

/// Runs of the DEM that the predictions of a test belong to, each once.
std::vector<const Run*> measured_runs(const Inputs& inputs, const TestPredictions& test) {
  std::vector<const Run*> runs;
  for (const PredictedRun* predicted : test.runs) {
    const Run* run = inputs.run(text_in(predicted->entry, "test"));
    if (run && run->record && std::find(runs.begin(), runs.end(), run) == runs.end()) runs.push_back(run);
  }
  return runs;
}

std::vector<std::string> forms_of(const TestPredictions& test) {
  std::vector<std::string> forms;
  for (const PredictedRun* run : test.runs) {
    if (std::find(forms.begin(), forms.end(), run->form) == forms.end()) forms.push_back(run->form);
  }
  return forms;
}

Draw draw_of(const std::string& form) {
  if (form == "reduced_closed") return Draw::dotted;
  return form == "reduced" ? Draw::dashes : Draw::line;
}

double span(const Record& record, const std::string& column) {
  double low = INFINITY, high = -INFINITY;
  for (const double x : record[column]) {
    if (!std::isfinite(x)) continue;
    low = std::min(low, x);
    high = std::max(high, x);
  }
  return high - low;
}

/// Shear strain where the test shears, else volume fraction.
std::string abscissa(const TestPredictions& test, const std::vector<const Run*>& measured) {
  const Record* record = !measured.empty() ? &*measured[0]->record : nullptr;
  if (!record && test.runs[0]->record) record = &*test.runs[0]->record;
  return record && span(*record, "eps_dev") < 1e-3 ? "nu" : "eps_dev";
}

Series series_of(const Record& record, const std::string& x, const std::string& y, std::size_t most) {
  Series series;
  series.x = thinned(record[x], most);
  series.y = thinned(record[y], most);
  return series;
}

/// The range of s_dev where the packing carries load: the ratio of two vanishing stresses is noise.
std::array<double, 2> loaded_range(const std::vector<const Record*>& records) {
  double largest = 0;
  for (const Record* record : records) {
    for (const double P : (*record)["P"]) largest = std::max(largest, std::isfinite(P) ? P : 0);
  }
  std::vector<double> values;
  for (const Record* record : records) {
    const auto& P = (*record)["P"];
    const auto& s = (*record)["s_dev"];
    for (std::size_t i = 0; i < P.size(); ++i) {
      if (P[i] > 0.01 * largest) values.push_back(s[i]);
    }
  }
  return padded_range(values);
}

std::vector<const Record*> records_of(const std::vector<const Run*>& measured) {
  std::vector<const Record*> records;
  for (const Run* run : measured) records.push_back(&*run->record);
  return records;
}

/// Records of the DEM and of the law.
std::vector<const Record*> all_records(const TestPredictions& test, const std::vector<const Run*>& measured) {
  std::vector<const Record*> records = records_of(measured);
  for (const PredictedRun* run : test.runs) {
    if (run->record) records.push_back(&*run->record);
  }
  return records;
}

Series measured_style(const Run& run, std::size_t n) {
  const std::string label = run.seed ? "DEM, seed " + std::to_string(*run.seed) : "DEM";
  return {label, Draw::dots, seed_grey(n), {}, {}};
}

Series prediction_style(const std::string& form) {
  return {form_name(form), draw_of(form), form_colour(form), {}, {}};
}

Panel quantity_panel(const Inputs& inputs, const TestPredictions& test,
                     const std::vector<const Run*>& measured, const std::string& quantity, Area area) {
  const std::string x = abscissa(test, measured);
  Panel panel{area, "", axis_label(x, ""), axis_label(quantity, ""), {}, {}, {}};
  const auto add = [&](Series style, const Record& record, std::size_t most) {
    Series series = series_of(record, x, quantity, most);
    style.x = std::move(series.x);
    style.y = std::move(series.y);
    style.in_legend = false;
    panel.series.push_back(std::move(style));
  };
  for (std::size_t i = 0; i < measured.size(); ++i)
    add(measured_style(*measured[i], i), *measured[i]->record, dots_per_run);
  // Whole lines first, broken ones over them: forms that coincide can both be seen.
  for (const Draw draw : {Draw::line, Draw::dashes, Draw::dotted}) {
    for (const PredictedRun* run : test.runs) {
      if (run->record && draw_of(run->form) == draw)
        add(prediction_style(run->form), *run->record, points_per_line);
    }
  }
  if (quantity == "s_dev") panel.y_range = loaded_range(all_records(test, measured));
  const auto unit = inputs.stress_unit_kPa();
  if (unit && (quantity == "P" || quantity == "sigma_dev")) {
    panel.right_unit = *unit;
    panel.right_label =
        (quantity == "P" ? std::string("{/:Italic P}") : std::string("{/:Italic σ}_{dev}")) + " (kPa)";
  }
  return panel;
}

/// "3.4 % (2.9, 3.9)": the mean over seeds, and each.
std::string error_cell(const TestPredictions& test, const std::string& form, const std::string& quantity) {
  std::vector<double> errors;
  for (const PredictedRun* run : test.runs) {
    const auto error = number_in(value_in(run->entry, "errors"), quantity);
    if (run->form == form && error) errors.push_back(*error);
  }
  if (errors.empty()) return nothing;
  double sum = 0;
  for (const double error : errors) sum += error;
  std::string cell = percent(sum / static_cast<double>(errors.size()));
  if (errors.size() == 1 || errors.size() > 5) return cell;
  cell += " (";
  for (std::size_t i = 0; i < errors.size(); ++i) cell += (i == 0 ? "" : ", ") + number(100 * errors[i], 2);
  return cell + ")";
}

/// Different texts of the runs of one form, in order of appearance.
void add_if_new(std::vector<std::string>& texts, const std::string& text) {
  if (!text.empty() && std::find(texts.begin(), texts.end(), text) == texts.end()) texts.push_back(text);
}

/// How the predictions of one form ended; a form that failed or was refused stands out.
Markup status_cell(const TestPredictions& test, const std::string& form) {
  std::vector<std::string> endings;
  for (const PredictedRun* run : test.runs) {
    const std::string status = text_in(run->entry, "status");
    if (run->form == form) add_if_new(endings, status == "ok" ? "to the end" : status);
  }
  std::vector<Markup> words;
  for (const std::string& ending : endings) {
    const bool bad = ending.starts_with("failed") || ending.starts_with("refused");
    words.push_back(bad ? element("span", prose(ending), {{"class", "bad"}}) : prose(ending));
  }
  return words.empty() ? text(nothing) : join(words, "; "_html);
}

/// What the law said about its own predictions of this test.
Markup law_warnings(const TestPredictions& test) {
  std::vector<std::string> warnings;
  for (const PredictedRun* run : test.runs) {
    const Json& list = value_in(run->entry, "warnings");
    if (!list.is_array()) continue;
    for (const Json& warning : list) {
      if (warning.is_string()) add_if_new(warnings, form_name(run->form) + ": " + warning.get<std::string>());
    }
  }
  Markup items;
  for (const std::string& warning : warnings) items += element("li", prose(warning)) + "\n"_html;
  return items.empty() ? items : element("ul", items, {{"class", "note"}});
}

/// The last line of a table of errors: how much of them is noise.
std::vector<Markup> scatter_row(const std::vector<const Run*>& measured) {
  std::vector<Markup> cells{element("span", "scatter between seeds"_html, {{"class", "quiet"}})};
  for (const std::string& quantity : quantities())
    cells.push_back(text(percent(seed_scatter(records_of(measured), quantity))));
  cells.push_back({});
  return cells;
}

Markup error_table(const TestPredictions& test, const std::vector<const Run*>& measured) {
  Table table;
  table.column("Relative error along the path"_html);
  for (const std::string& quantity : quantities()) table.column(symbol(quantity), Table::Kind::figures);
  table.column("How it ended"_html);
  for (const std::string& form : forms_of(test)) {
    std::vector<Markup> cells{text(form_name(form))};
    for (const std::string& quantity : quantities()) cells.push_back(text(error_cell(test, form, quantity)));
    cells.push_back(status_cell(test, form));
    table.row(cells);
  }
  if (measured.size() > 1) table.row(scatter_row(measured));
  return table.html("small");
}

std::string plain_value(const Json& value) {
  if (value.is_number()) return number(value.get<double>(), 5);
  if (value.is_string()) return value.get<std::string>();
  if (!value.is_object()) return nothing;
  const std::string from = text_in(value, "from").empty() ? text_in(value, "source") : text_in(value, "from");
  const std::string shown = number(number_in(value, "value"), 5);
  return from.empty() ? shown : shown + " (" + from + ")";
}

/// Where the first prediction of a test started from, as it echoed it.
Markup start_sentence(const TestPredictions& test) {
  const Json& start = value_in(test.runs[0]->entry, "start");
  if (!start.is_object() || start.empty()) return {};
  std::vector<Markup> pieces;
  for (const auto& [name, value] : start.items()) {
    if (!value.is_null()) pieces.push_back(symbol(name) + " = "_html + prose(plain_value(value)));
  }
  return " Start of the first: "_html + join(pieces, ", "_html) + "."_html;
}

Markup test_figure(const Inputs& inputs, const TestPredictions& test, std::size_t n) {
  const auto measured = measured_runs(inputs, test);
  Figure figure;
  figure.name = "prediction-" + std::to_string(n);
  figure.alt =
      "DEM and predictions of " + test.test + ": pressure, shear stress, stress ratio, contact anisotropy";
  figure.smallest_width = "640px";
  const auto areas = grid(figure, quantities().size(), 2, 210, 64);
  for (std::size_t i = 0; i < areas.size(); ++i) {
    figure.panels.push_back(quantity_panel(inputs, test, measured, quantities()[i], areas[i]));
  }
  figure.key = {{"DEM", Draw::dots, measured_colour, {}, {}}};
  for (const std::string& form : forms_of(test)) figure.key.push_back(prediction_style(form));
  const std::string seeds = std::to_string(measured.size()) + (measured.size() == 1 ? " seed." : " seeds.");
  figure.caption = element("b", text(test.test)) + text(" (" + mode_name(test.mode) + "), " + seeds) +
                   start_sentence(test);
  return "<h3>"_html + text(mode_name(test.mode) + ": " + test.test) + "</h3>\n"_html + draw(figure) +
         error_table(test, measured) + law_warnings(test);
}

}  // namespace

Markup outdated_predictions(const Inputs& inputs) {
  if (!inputs.predictions_outdated) return {};
  return "<p class=\"gaps\"><b>These predictions are out of date</b>: made with another parameter set than "
         "<code>parameters.json</code> holds now; run <code>grainlaw calibrate -o DIR --resume</code> to "
         "renew "
         "them.</p>\n"_html;
}

Markup predictions_section(const Inputs& inputs) {
  const auto tests = by_test(inputs);
  if (tests.empty()) return absent("No predictions: predictions.json is not there, or holds none.");
  Markup section =
      outdated_predictions(inputs) +
      "<p>The law, with the fitted parameters, follows the strain path of tests that no fit behind these "
      "parameters has read. Dots are the DEM's, a shade of grey per seed; lines are the law in its three "
      "forms: the reduced law with the current <var>ν</var> in Eqs. 2.17 and 2.18 (closed form), the same as "
      "rate equations (rate form), and the coupled law of Eq. 4.16, in which stress and fabric act on each "
      "other; and beside them the coupled law with the terms past the thesis that the parameters have "
      "numbers "
      "for (named after a plus). The scale of <var>s</var><sub>dev</sub> leaves out where <var>P</var>* is "
      "below a hundredth of "
      "its largest value. In the tables: mean over seeds, each seed in brackets. Scatter between seeds: the "
      "same relative distance between two packings of the DEM itself, mean over pairs; a law that met the "
      "mean of all packings would still miss each of them by about 0.7 of it.</p>\n"_html;
  std::size_t n = 0;
  for (const TestPredictions& test : tests) section += test_figure(inputs, test, ++n);
  return section;
}

}  // namespace grainlaw::report
