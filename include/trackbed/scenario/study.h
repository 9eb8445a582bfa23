#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/scenario/sampling.h"
#include "trackbed/scenario/scenario.h"

/// A study: many runs of one scenario with different values of some keys.
namespace trackbed {

/// A key of the scenario, its value, and the position in the study's file.
struct Setting {
  std::string key;    ///< Dotted key, as for --set.
  std::string value;  ///< Value as YAML on one line.
  int line = 0;       ///< Line number from 1.
  int column = 0;     ///< Column number from 1.
};

/// A bisection for the highest passing value of a key.
struct BisectSpec {
  std::string key;         ///< Dotted key of a number.
  double from = 0.0;       ///< Value that is expected to pass.
  double to = 0.0;         ///< Value above `from` that is expected to fail.
  double tolerance = 0.0;  ///< Tolerance of the result.
  int line = 0;
  int column = 0;
};

/// An output that the study's table lists for every run.
struct OutputSpec {
  std::string path;  ///< Dotted path, such as "metrics.mujoco.cross_track.max".
  int line = 0;
  int column = 0;
};

/// Selects the rows of a study whose run folders are kept.
struct KeepSpec {
  enum class Rows {
    kNone,
    kFailed,  ///< Rows that did not pass.
    kAll,
    kHighest,  ///< The `count` rows with the highest values of the output `by`.
    kLowest,   ///< The `count` rows with the lowest values of the output `by`.
  };
  Rows rows = Rows::kNone;
  int count = 0;
  std::string by{};
};

/// Formats the selection as in files: "worst 10 by metrics.mujoco.cross_track.max".
std::string ToString(const KeepSpec& keep);

/// A condition that holds if a key of the study has one of the given values.
struct Condition {
  std::string key;
  std::vector<std::string> values;  ///< Values, each as YAML on one line.
};

/// A key that varies between runs.
struct Variation {
  std::string key;  ///< Dotted key.
  int line = 0;
  int column = 0;
  std::vector<Setting> alternatives{};         ///< Values in the grid; empty if the key is sampled.
  std::optional<Distribution> distribution{};  ///< Distribution of a sampled key.
  /// The CSV file with the key's values. All keys of the same file take their values from the same
  /// row.
  std::string rows_of{};
  /// The key is only set if all of these conditions hold.
  std::vector<Condition> when{};
};

/// A key whose value is computed from other keys.
struct DerivedKey {
  std::string key;      ///< Dotted key.
  std::string formula;  ///< Formula over keys of the study.
  int line = 0;
  int column = 0;
};

/// How `trackbed falsify` searches the keys with distributions for a run that fails.
struct SearchSpec {
  std::string method = "surrogate";  ///< One of StudySearches().
  int runs = 200;                    ///< Maximum number of runs of the search.
  /// Number of parallel NLopt searches, which share the runs. With 0, there are two, or one for
  /// `direct`.
  int restarts = 0;
  /// Population of the methods crs2, esch and isres. With 0, the population is 4 n + 4 for n keys.
  int population = 0;
  /// Method for the last quarter of the runs: "none", "nelder_mead" or "cobyla".
  std::string finish = "none";
  std::uint64_t seed = 1;
  bool stop = true;         ///< Whether to stop at the first violation.
  int shrink_runs = 200;    ///< Maximum number of runs to shrink the counterexample.
  double tolerance = 0.01;  ///< Tolerance of shrinking, as a fraction of each key's range.
};

/// The allowed values of SearchSpec::method: "random", "latin_hypercube", "sobol", "surrogate"
/// (dlib), and NLopt's searches that need no gradients.
const std::vector<std::string>& StudySearches();

/// Every run of a grid sets one alternative of each key of `vary` and one point of `list`. Sampled
/// keys give `sample.count` runs at each point of the grid. All points of the grid use the same
/// sample, so that the grid compares equal conditions.
struct Study {
  std::string name;
  std::string file;                ///< File name as the user gave it.
  std::filesystem::path scenario;  ///< Scenario file, resolved from the study's folder.
  std::string scenario_text;       ///< Content of the scenario when the study was read.
  /// Overrides from the command line, which take precedence over `set`.
  std::vector<Override> overrides;
  std::vector<std::string> cameras;                  ///< Argument of ReadScenario.
  MetricPaths metrics;                               ///< Argument of ReadScenario.
  std::vector<std::filesystem::path> asset_folders;  ///< Argument of ReadScenario.
  std::vector<Setting> set;                          ///< Settings that apply to every run.
  std::vector<Variation> vary;                       ///< Varied keys, in the file's order.
  std::vector<std::vector<Setting>> list;  ///< Points that each set several keys; may be empty.
  std::optional<SampleSpec> sample;        ///< Sample for the keys of `vary` with distributions.
  std::optional<SearchSpec> search;        ///< Search over the keys of `vary` with distributions.
  std::vector<Setting> nominal;            ///< Point toward which a counterexample is shrunk.
  std::vector<DerivedKey> derive;          ///< Computed keys, in the file's order.
  int repeat = 1;                          ///< Number of runs per point, with consecutive seeds.
  std::optional<BisectSpec> bisect;        ///< Bisection at every point of the grid.
  std::vector<OutputSpec> outputs;
  KeepSpec keep{};
};

/// A point of a study.
struct StudyPoint {
  std::vector<Setting> settings;  ///< Settings of `vary`, `list` and `derive`.
  Scenario scenario;              ///< Scenario with these settings, and the bisected key at `from`.
  std::string refused{};          ///< Reason why the scenario is invalid; empty if it is valid.
};

/// Whether the file has the key `scenario`, which studies have and scenarios do not. False if the
/// file cannot be read.
bool IsStudy(const std::filesystem::path& file);

/// Reads a study and the text of its scenario, as strictly as ReadScenario. InputError lists
/// **every** problem of the study's keys, including keys that overwrite each other.
Study ReadStudy(const std::filesystem::path& file, const std::vector<Override>& overrides = {},
                const std::vector<std::string>& cameras = {}, const MetricPaths& metrics = {},
                const std::vector<std::filesystem::path>& asset_folders = {});

/// Reads the scenario at a point, with the bisected key set to `bisected`. Throws the InputErrors
/// of ReadScenario. Problems of the study's settings are reported at their place in the study's
/// file.
Scenario ReadPoint(const Study& study, const std::vector<Setting>& settings,
                   std::optional<double> bisected = {});

/// Makes the point with the given settings and the derived keys. If the scenario is invalid,
/// StudyPoint::refused is the first problem.
StudyPoint PointWith(const Study& study, std::vector<Setting> settings);

/// Returns the number at a key of a scenario with all defaults filled in; nullopt if there is no
/// such key.
std::optional<double> NumberAt(const Scenario& scenario, const std::string& key);

/// The points of a study, computed on demand and not stored. In the grid, the last key changes
/// fastest. Points of the list change faster than all keys of `vary`; points of the sample change
/// faster than the list.
///
/// Guarantees: a point depends only on the study. The object is immutable: several threads may read
/// points at the same time. Points of the grid that differ only in a key whose condition does not
/// hold are merged.
class StudyPoints {
 public:
  /// InputError if keys have distributions and there is no `sample`.
  explicit StudyPoints(Study study);

  [[nodiscard]] const Study& study() const { return study_; }
  [[nodiscard]] std::size_t size() const { return combinations_ * samples(); }
  /// Returns the settings of the point with index `i`. InputError if a formula has no value at this
  /// point.
  [[nodiscard]] std::vector<Setting> Settings(std::size_t i) const;
  /// Returns the point with index `i`. If the scenario is invalid, StudyPoint::refused is the first
  /// problem.
  [[nodiscard]] StudyPoint Read(std::size_t i) const;

 private:
  [[nodiscard]] std::size_t samples() const;
  [[nodiscard]] std::vector<Setting> OfGrid(std::size_t combination) const;
  void KeepDistinctPoints();

  Study study_;
  std::size_t combinations_ = 1;         // Number of combinations in the grid.
  std::vector<std::size_t> distinct_{};  // Indices of the distinct combinations; empty: all.
  Eigen::MatrixXd unit_sample_;          // One row per point of the sample.
  std::vector<int> dimensions_;          // Column of each key of `vary`; -1: not sampled.
};

/// Returns the points that are checked before a study runs: all, or 1000 evenly spaced points,
/// including the first and the last.
std::vector<std::size_t> PointsToCheck(const StudyPoints& points);

/// Checks the points of PointsToCheck. InputError lists each problem once, with one of the affected
/// points unless all points are affected. Bisections are checked at both ends and at a value in
/// between. If `all` is true, every point must be valid; otherwise one valid point is enough.
void CheckPoints(const StudyPoints& points, bool all);

/// Formats a value for a table: numbers in their shortest form, other values as YAML.
std::string CellText(const std::string& value);

}  // namespace trackbed
