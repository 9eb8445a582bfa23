#pragma once

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
  int line = 0;       ///< Line number in the study's file, from 1.
  int column = 0;     ///< Column number in the study's file, from 1.
};

/// A bisection that finds the highest value of a key with which the run passes.
struct BisectSpec {
  std::string key;         ///< Dotted key of the number to bisect.
  double from = 0.0;       ///< Value with which the run is expected to pass.
  double to = 0.0;         ///< Value above `from` with which the run is expected to fail.
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
    kFailed,  ///< Rows whose run did not pass.
    kAll,
    kHighest,  ///< The `count` rows with the highest values of the output `by`.
    kLowest,   ///< The `count` rows with the lowest values of the output `by`.
  };
  Rows rows = Rows::kNone;
  int count = 0;
  std::string by{};
};

/// Formats the selection in the notation of study files, such as "worst 10 by
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
  /// Conditions; the key is only set in runs in which all conditions hold.
  std::vector<Condition> when{};
};

/// A key whose value is computed from other keys.
struct DerivedKey {
  std::string key;      ///< Dotted key.
  std::string formula;  ///< Formula that computes the value from other keys of the study.
  int line = 0;
  int column = 0;
};

/// Options of `trackbed falsify`, which varies the keys with distributions to find a run that
/// fails.
struct SearchSpec {
  std::string method = "surrogate";  ///< One of StudySearches().
  int runs = 200;                    ///< Maximum number of runs of the search.
  /// Number of parallel NLopt searches, which together use the maximum number of runs. The value 0
  /// means two searches, or one search with the method `direct`.
  int restarts = 0;
  /// Population size of the methods crs2, esch and isres. The value 0 means a population of 4 n + 4
  /// for n keys.
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
  std::string file;  ///< File name as the user gave it.
  /// Path of the scenario file; a path in the study is relative to the study's folder.
  std::filesystem::path scenario;
  /// Content of the scenario file at the time at which the study was read.
  std::string scenario_text;
  /// Overrides of keys from the command line, which take precedence over `set`.
  std::vector<Override> overrides;
  MetricPaths metrics;                               ///< Argument of ReadScenario.
  std::vector<std::filesystem::path> asset_folders;  ///< Argument of ReadScenario.
  std::vector<Setting> set;                          ///< Settings that apply to every run.
  /// Keys that vary between runs, in the order of the file.
  std::vector<Variation> vary;
  /// Points of the list, each of which sets several keys; may be empty.
  std::vector<std::vector<Setting>> list;
  /// Options of the sample for the keys of `vary` with distributions.
  std::optional<SampleSpec> sample;
  /// Options for a search over the keys of `vary` with distributions.
  std::optional<SearchSpec> search;
  /// Nominal values of the searched keys, toward which a counterexample is shrunk.
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

/// A point of a study: the settings of one run, and the scenario with these settings.
struct StudyPoint {
  std::vector<Setting> settings;  ///< Settings at this point, from `vary`, `list` and `derive`.
  /// Scenario with the settings of this point; a bisected key has the value `from`.
  Scenario scenario;
  /// Reason why the scenario at this point is invalid; empty if the scenario is valid.
  std::string refused{};
};

/// Returns true if the file has the key `scenario`, which studies have but scenarios do not.
/// Returns false if the file cannot be read.
bool IsStudy(const std::filesystem::path& file);

/// Reads a study and the text of the study's scenario, and rejects any invalid key. Throws
/// InputError, which lists **every** problem of the study's keys, including keys that overwrite
/// each other.
Study ReadStudy(const std::filesystem::path& file, const std::vector<Override>& overrides = {},
                const MetricPaths& metrics = {},
                const std::vector<std::filesystem::path>& asset_folders = {});

/// Reads the scenario at a point, with the bisected key set to `bisected`. Throws InputError in the
/// same cases as ReadScenario. For a problem in a setting of the study, the InputError states the
/// position in the study's file.
Scenario ReadPoint(const Study& study, const std::vector<Setting>& settings,
                   std::optional<double> bisected = {});

/// Makes the point of the study with the given settings, and computes the derived keys. If the
/// scenario is invalid, StudyPoint::refused is the first problem.
StudyPoint PointWith(const Study& study, std::vector<Setting> settings);

/// Returns the number that a key has in the scenario, including default values; nullopt if there is
/// no such key.
std::optional<double> NumberAt(const Scenario& scenario, const std::string& key);

/// The points of a study, which are computed on demand and not stored. Points are ordered as in
/// nested loops: the keys of `vary` are the outer loops in the order of the file, `list` is the
/// next inner loop, and the sample is the innermost loop.
///
/// Guarantees: the same study always has the same points. Several threads may read points at the
/// same time, because StudyPoints cannot be changed after construction. If points of the grid
/// differ only in a key whose condition does not hold, only one of these points is kept.
class StudyPoints {
 public:
  /// Throws InputError if keys have distributions but the study has no section `sample`.
  explicit StudyPoints(Study study);

  [[nodiscard]] const Study& study() const { return study_; }
  [[nodiscard]] std::size_t size() const { return combinations_ * samples(); }
  /// Returns the settings of the point with index `i`. Throws InputError if a formula cannot be
  /// evaluated at this point.
  [[nodiscard]] std::vector<Setting> Settings(std::size_t i) const;
  /// Returns the point with index `i`. If the scenario is invalid, StudyPoint::refused is the first
  /// problem.
  [[nodiscard]] StudyPoint Read(std::size_t i) const;

 private:
  [[nodiscard]] std::size_t samples() const;
  [[nodiscard]] std::vector<Setting> OfGrid(std::size_t combination) const;
  void KeepDistinctPoints();

  Study study_;
  std::size_t combinations_ = 1;  // Number of points in the grid.
  // Indices of the distinct points of the grid; empty if all points are distinct.
  std::vector<std::size_t> distinct_{};
  // Sample with one row per point and one column per sampled key.
  Eigen::MatrixXd unit_sample_;
  // Column in `unit_sample_` of each key of `vary`; -1 if the key is not sampled.
  std::vector<int> dimensions_;
};

/// Returns the indices of the points that are checked before a study is run: all points, or 1000
/// evenly spaced points that include the first and the last point.
std::vector<std::size_t> PointsToCheck(const StudyPoints& points);

/// Checks the scenarios at the points from PointsToCheck. Throws InputError, which lists each
/// problem once, with one of the affected points unless all points are affected. For a bisection,
/// the scenario is checked at both ends of the bisected range and at one value in between. If `all`
/// is true, every point must be valid; otherwise one valid point is enough.
void CheckPoints(const StudyPoints& points, bool all);

/// Formats a value for a table: a number in the shortest form, any other value as YAML.
std::string CellText(const std::string& value);

}  // namespace trackbed
