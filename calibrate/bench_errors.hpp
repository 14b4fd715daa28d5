// What a bench's runs say: the error of every setting against the finest, beside what chance alone makes.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "grainlaw/calibrate/bench.hpp"
#include "grainlaw/calibrate/run_folder.hpp"

namespace grainlaw::calibrate {

/// Runs by group, one series of numbers each; all series are of one length.
using Series = std::vector<double>;
using Groups = std::vector<std::vector<Series>>;

/// How far means over runs lie apart. With d = mean over groups of (mean of a group's runs - mean of the
/// reference's), row by row, and m the reference's mean:
struct Comparison {
  double error = 0;   ///< |d|/|m|, root mean squares over the rows
  double band = 0;    ///< what it would be, were chance the only difference
  double offset = 0;  ///< mean of d over mean of m: with a sign
};

/// `variance`, `of_reference`: of a single run about its group's mean, row by row.
Comparison compare(const Groups& runs, const Groups& reference, const Series& variance,
                   const Series& of_reference);
/// The variance within the groups of all sets together, row by row; NaN where no group has two runs.
Series pooled_variance(const std::vector<const Groups*>& sets);
/// The variance of one run of one group about the mean over groups, row by row: that between the groups and
/// that within. NaN for a single group, or where no group has two runs.
Series variance_over_groups(const Groups& groups);

/// One line of the result: a value of a knob, and one quantity in one test.
struct BenchError {
  Knob knob;
  BenchTest test;
  double value;
  std::string quantity;
  std::size_t runs;
  double particle_steps;  ///< of one run, mean
  double core_s;          ///< of one run, median of those that say, for others may use the machine; else NaN
  Comparison comparison;  ///< with the finest value; zero for that one itself
  double scatter;         ///< of a single run about the mean of its twins, over |m|: the chaos of the flow
  double packings;        ///< of a single run about the mean over packings, over |m|; NaN for one packing
  bool finest;
};

/// Of all sweeps whose finest runs are there; values whose runs are not all there are left out.
std::vector<BenchError> bench_errors(const Bench& bench, const RunFolder& folder);

/// What an error is held against: twice the band, which the more runs the narrower is, for means over many
/// tests; or what packings scatter, which one test cannot be told from. Where only one packing was run,
/// nothing is known of the latter.
enum class Judge { chance, one_packing };

/// The cheapest value of a knob whose errors are all within what the judge grants, or below a thousandth.
/// `worst` is the largest error over that measure (band or scatter of packings) at that value, of errors
/// above a thousandth; else 0; and `quantity` says of what.
struct Recommendation {
  Knob knob;
  double value;
  double worst;
  BenchTest test;
  std::string quantity;
};
std::vector<Recommendation> recommend(const std::vector<BenchError>& errors, Judge judge);

/// The file in a record's directory that says what the run cost.
inline constexpr const char* core_time_file = "core_time.json";

std::string to_csv(const std::vector<BenchError>& errors);
Json to_json(const std::vector<BenchError>& errors);

}  // namespace grainlaw::calibrate
