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
  std::string key;    ///< dotted, as for --set
  std::string value;  ///< YAML on one line
  int line = 0;       ///< 1-based
  int column = 0;     ///< 1-based
};

/// Bisects for the highest passing value of a key.
struct BisectSpec {
  std::string key;         ///< dotted; of a number
  double from = 0.0;       ///< expected to pass
  double to = 0.0;         ///< expected to fail; above `from`
  double tolerance = 0.0;  ///< of the value found
  int line = 0;
  int column = 0;
};

/// An output of every run.
struct OutputSpec {
  std::string path;  ///< dotted, such as "metrics.mujoco.cross_track.max"
  int line = 0;
  int column = 0;
};

/// The rows whose run folders are kept.
struct KeepSpec {
  enum class Rows {
    kNone,
    kFailed,  ///< rows that did not pass
    kAll,
    kHighest,  ///< the `count` with the highest values of the output `by`
    kLowest,   ///< the `count` with the lowest values of the output `by`
  };
  Rows rows = Rows::kNone;
  int count = 0;
  std::string by{};
};

/// The spelling in files, "worst 10 by metrics.mujoco.cross_track.max".
std::string ToString(const KeepSpec& keep);

/// Holds at points at which a key of the study has one of the given values.
struct Condition {
  std::string key;
  std::vector<std::string> values;  ///< each as YAML on one line
};

/// A key that varies between runs.
struct Variation {
  std::string key;  ///< dotted
  int line = 0;
  int column = 0;
  std::vector<Setting> alternatives{};         ///< of the grid; empty if the key is sampled
  std::optional<Distribution> distribution{};  ///< if the key is sampled
  /// The CSV file of its values; keys of the same file take their values from the same row.
  std::string rows_of{};
  /// The key is set only if all of them hold.
  std::vector<Condition> when{};
};

/// A key whose value is computed from other keys.
struct DerivedKey {
  std::string key;      ///< dotted
  std::string formula;  ///< over keys of the study
  int line = 0;
  int column = 0;
};

/// How `trackbed falsify` searches the keys with distributions for a run that fails.
struct SearchSpec {
  std::string method = "surrogate";  ///< one of StudySearches()
  int runs = 200;                    ///< maximum number of runs of the search
  /// Number of parallel NLopt searches, which share the runs; 0: two, or one for `direct`.
  int restarts = 0;
  int population = 0;  ///< of crs2, esch and isres; 0: 4 n + 4 for n keys
  /// Method for the last quarter of the runs: "none", "nelder_mead" or "cobyla".
  std::string finish = "none";
  std::uint64_t seed = 1;
  bool stop = true;         ///< at the first violation
  int shrink_runs = 200;    ///< maximum number of runs to shrink the counterexample
  double tolerance = 0.01;  ///< of shrinking, as a fraction of each key's range
};

/// The allowed values of SearchSpec::method: "random", "latin_hypercube", "sobol", "surrogate"
/// (dlib), and NLopt's searches that need no gradients.
const std::vector<std::string>& StudySearches();

/// Every run of a grid sets one alternative of each key of `vary` and one point of `list`. Sampled
/// keys give `sample.count` runs at each point of the grid. All points of the grid use the same
/// sample, so that the grid compares equal conditions.
struct Study {
  std::string name;
  std::string file;                  ///< as the user named it
  std::filesystem::path scenario;    ///< resolved from the study's folder
  std::string scenario_text;         ///< its content at the time of reading the study
  std::vector<Override> overrides;   ///< from the command line; they take precedence over `set`
  std::vector<std::string> cameras;  ///< as for ReadScenario
  MetricPaths metrics;               ///< as for ReadScenario
  std::vector<std::filesystem::path> asset_folders;  ///< as for ReadScenario
  std::vector<Setting> set;                          ///< the same in every run
  std::vector<Variation> vary;                       ///< in the file's order
  std::vector<std::vector<Setting>> list;            ///< points that set several keys; empty: none
  std::optional<SampleSpec> sample;                  ///< for the keys of `vary` with distributions
  std::optional<SearchSpec> search;                  ///< for the keys of `vary` with distributions
  std::vector<Setting> nominal;      ///< the point toward which a counterexample is shrunk
  std::vector<DerivedKey> derive;    ///< in the file's order
  int repeat = 1;                    ///< runs per point, with consecutive seeds
  std::optional<BisectSpec> bisect;  ///< at every point of the grid
  std::vector<OutputSpec> outputs;
  KeepSpec keep{};
};

/// A point of a study.
struct StudyPoint {
  std::vector<Setting> settings;  ///< of `vary`, `list` and `derive`
  Scenario scenario;              ///< with these settings, and the bisected key at `from`
  std::string refused{};          ///< why the scenario is invalid; empty: it is valid
};

/// Whether the file has the key `scenario`, which studies have and scenarios do not. False when it
/// cannot be read.
bool IsStudy(const std::filesystem::path& file);

/// Reads a study as strictly as ReadScenario reads a scenario, and the text of its scenario.
/// InputError with **every** problem of the study's keys, including keys that overwrite each other.
Study ReadStudy(const std::filesystem::path& file, const std::vector<Override>& overrides = {},
                const std::vector<std::string>& cameras = {}, const MetricPaths& metrics = {},
                const std::vector<std::filesystem::path>& asset_folders = {});

/// The scenario at a point, with the bisected key at `bisected`. InputError as ReadScenario;
/// problems of the study's settings are placed in the study's file.
Scenario ReadPoint(const Study& study, const std::vector<Setting>& settings,
                   std::optional<double> bisected = {});

/// The point with these settings and the derived keys; refused with the first problem if the
/// scenario is invalid.
StudyPoint PointWith(const Study& study, std::vector<Setting> settings);

/// The number at a key of a scenario with all defaults filled in; none if there is no such key.
std::optional<double> NumberAt(const Scenario& scenario, const std::string& key);

/// The points of a study, computed on demand and not stored. The last key of the grid changes
/// fastest, points of the list change faster than all keys of `vary`, and those of the sample
/// faster than the list.
///
/// Guarantees: a point depends only on the study. Immutable: several threads may read points at a
/// time. Points of the grid that differ only in a key whose condition does not hold are merged.
class StudyPoints {
 public:
  /// InputError when keys have distributions and there is no `sample`.
  explicit StudyPoints(Study study);

  [[nodiscard]] const Study& study() const { return study_; }
  [[nodiscard]] std::size_t size() const { return combinations_ * samples(); }
  /// The settings of the point `i` of `size()`. InputError if a formula has no value there.
  [[nodiscard]] std::vector<Setting> Settings(std::size_t i) const;
  /// The point `i`; refused with the first problem if its scenario is invalid.
  [[nodiscard]] StudyPoint Read(std::size_t i) const;

 private:
  [[nodiscard]] std::size_t samples() const;
  [[nodiscard]] std::vector<Setting> OfGrid(std::size_t combination) const;
  void KeepDistinctPoints();

  Study study_;
  std::size_t combinations_ = 1;         // of the grid
  std::vector<std::size_t> distinct_{};  // indices among all combinations; empty: all are distinct
  Eigen::MatrixXd unit_sample_;          // one row per point of the sample
  std::vector<int> dimensions_;          // column of each key of `vary`; -1: not sampled
};

/// The points that are checked before a study runs: all, or 1000 evenly spaced points, including
/// the first and the last.
std::vector<std::size_t> PointsToCheck(const StudyPoints& points);

/// InputError with the problems of PointsToCheck, each reported once, with one point that has it
/// unless all do. Bisections are checked at both ends and at a value in between. With `all`, every
/// point must be valid; otherwise one valid point is enough.
void CheckPoints(const StudyPoints& points, bool all);

/// A value as text in a table: numbers in their shortest form, other values as YAML.
std::string CellText(const std::string& value);

}  // namespace trackbed
