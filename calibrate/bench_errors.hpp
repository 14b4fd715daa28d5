// What a bench's runs say: the error of every setting against the finest, beside what chance alone makes.
#pragma once

#include <array>
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

/// A value of a knob, and what one run of each test takes with it.
struct Recommendation {
  Knob knob;
  double value;
  double core_s;         ///< NaN where a run did not say
  double excused;        ///< the largest error that is above the wanted one, but within what the judge grants
  BenchTest test;        ///< of which that is,
  std::string quantity;  ///< and of what; empty where none is above
};
/// Of each knob the cheapest value whose errors are all below `wanted` (a share: 0.0025), or within what the
/// judge grants. Of the method there is none; of the number of grains only by chance, as fewer scatter more.
std::vector<Recommendation> recommend(const std::vector<BenchError>& errors, Judge judge, double wanted);

/// Errors that somebody may want.
inline constexpr std::array<double, 4> wanted_errors{0.001, 0.0025, 0.005, 0.01};

/// The file in a record's directory that says what the run cost.
inline constexpr const char* core_time_file = "core_time.json";

std::string to_csv(const std::vector<BenchError>& errors);
Json to_json(const std::vector<BenchError>& errors);

}  // namespace grainlaw::calibrate
