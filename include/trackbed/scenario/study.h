#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/scenario/sampling.h"
#include "trackbed/scenario/scenario.h"

/// A study: many runs of one scenario with different values of some keys.
namespace trackbed {

/// A key of the scenario, the value of the key, and the position of the setting in the study's
/// file.
struct Setting {
  std::string key;    ///< Dotted key, as in the command-line option --set.
  std::string value;  ///< Value of the key, as YAML on one line.
  int line = 0;       ///< Line number of the setting in the study's file, from 1.
  int column = 0;     ///< Column number of the setting in the study's file, from 1.
};

/// A bisection that finds the highest value of a key with which the run passes.
struct BisectSpec {
  std::string key;    ///< Dotted key of the number to bisect.
  double from = 0.0;  ///< Value of the key with which the run is expected to pass.
  double to = 0.0;    ///< Value of the key, above `from`, with which the run is expected to fail.
  double tolerance = 0.0;  ///< Maximum error of the value that the bisection finds.
  int line = 0;
  int column = 0;
};

/// An output that the study's table lists for every run.
struct OutputSpec {
  std::string path;  ///< Dotted path of the output, such as "metrics.mujoco.cross_track.max".
  int line = 0;
  int column = 0;
};

/// Selects the rows of a study whose run folders are kept.
struct KeepSpec {
  enum class Rows {
    kNone,
    kFailed,  ///< Rows of the study whose run did not pass.
    kAll,
    kHighest,  ///< The `count` rows of the study with the highest values of the output `by`.
    kLowest,   ///< The `count` rows of the study with the lowest values of the output `by`.
  };
  Rows rows = Rows::kNone;
  int count = 0;
  std::string by{};
};

/// Formats the selection of kept rows in the notation of study files, such as "worst 10 by
/// metrics.mujoco.cross_track.max".
std::string ToString(const KeepSpec& keep);

/// A condition, which is true if a key of the study has one of the given values.
struct Condition {
  std::string key;
  std::vector<std::string> values;  ///< Values of the key, each as YAML on one line.
};

/// A key of the scenario whose value differs between the runs of a study.
struct Variation {
  std::string key;  ///< Dotted key.
  int line = 0;
  int column = 0;
  /// Values of the key in the grid; empty if the key is sampled.
  std::vector<Setting> alternatives{};
  std::optional<Distribution> distribution{};  ///< Distribution of a sampled key.
  /// The CSV file that contains the values of the key. In each run, all keys with the same CSV file
  /// take their values from the same row.
  std::string rows_of{};
  /// Conditions for setting the key; a run sets the key only if all conditions hold.
  std::vector<Condition> when{};
};

/// A key of the scenario whose value is computed from other keys.
struct DerivedKey {
  std::string key;      ///< Dotted key.
  std::string formula;  ///< Formula that computes the value from other keys of the study.
  int line = 0;
  int column = 0;
};

/// Options of `trackbed falsify`, which varies the keys with distributions to find a run that
/// fails.
struct SearchSpec {
  std::string method = "surrogate";  ///< Search method, one of StudySearches().
  int runs = 200;                    ///< Maximum number of runs of the search.
  /// Number of parallel NLopt searches, which together use the maximum number of runs. If
  /// `restarts` is 0, two parallel searches are run, or one search with the method `direct`.
  int restarts = 0;
  /// Population size of the methods crs2, esch and isres. If `population` is 0, the population size
  /// is 4 n + 4 for n keys.
  int population = 0;
  /// Local search method for the last quarter of the runs: "none", "nelder_mead" or "cobyla".
  std::string finish = "none";
  std::uint64_t seed = 1;
  /// Whether the search stops at the first run that violates an expectation.
  bool stop = true;
  int shrink_runs = 200;  ///< Maximum number of runs to shrink the counterexample.
  /// Tolerance for shrinking the counterexample, as a fraction of each key's range.
  double tolerance = 0.01;
};

/// Returns the allowed values of SearchSpec::method: "random", "latin_hypercube", "sobol",
/// "surrogate" (dlib), and the NLopt methods that need no gradients.
const std::vector<std::string>& StudySearches();

/// A study: many runs of one scenario with different values of some keys. The runs form a grid:
/// each run sets one of the alternatives of each key in `vary`, and the keys of one point in
/// `list`. If keys are sampled, `sample.count` runs are made at each point of the grid. All points
/// of the grid use the same sample, so that the points can be compared under equal conditions.
struct Study {
  std::string name;
  std::string file;  ///< Name of the study file as the user gave it.
  /// Path of the scenario file; a path in the study is relative to the study's folder.
  std::filesystem::path scenario;
  /// Content of the scenario file at the time at which the study was read.
  std::string scenario_text;
  /// Overrides of keys from the command line, which take precedence over `set`.
  std::vector<Override> overrides;
  MetricPaths metrics;  ///< Names of allowed metrics, for ReadScenario.
  std::vector<std::filesystem::path> asset_folders;  ///< Asset folders, for ReadScenario.
  std::vector<Setting> set;                          ///< Settings that apply to every run.
  /// Keys that vary between runs, in the order of the file.
  std::vector<Variation> vary;
  /// Points of the study's `list`, each of which sets several keys; may be empty.
  std::vector<std::vector<Setting>> list;
  /// Options of the sample for the keys of `vary` with distributions.
  std::optional<SampleSpec> sample;
  /// Options for a search over the keys of `vary` with distributions.
  std::optional<SearchSpec> search;
  /// Nominal values of the searched keys, toward which a found counterexample is shrunk.
  std::vector<Setting> nominal;
  /// Keys whose values are computed, in the order of the file.
  std::vector<DerivedKey> derive;
  /// Number of runs at each point, with consecutive random seeds.
  int repeat = 1;
  /// Bisection to carry out at every point of the grid; nullopt: no bisection.
  std::optional<BisectSpec> bisect;
  std::vector<OutputSpec> outputs;
  KeepSpec keep{};
};

/// Formats a value for a table: a number in the shortest form, any other value as YAML.
std::string CellText(const std::string& value);

}  // namespace trackbed
