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

/// Of which rows the run folders are kept.
struct KeepSpec {
  enum class Rows {
    kNone,
    kFailed,  ///< that did not pass
    kAll,
    kHighest,  ///< the `count` with the highest values of the output `by`
    kLowest,   ///< likewise, the lowest
  };
  Rows rows = Rows::kNone;
  int count = 0;
  std::string by{};
};

/// "worst 10 by metrics.mujoco.cross_track.max", as files have it.
std::string ToString(const KeepSpec& keep);

/// Holds at the points where a key of the study has one of some values.
struct Condition {
  std::string key;
  std::vector<std::string> values;  ///< YAML on one line each
};

/// A key that is not the same in all runs.
struct Variation {
  std::string key;  ///< dotted
  int line = 0;
  int column = 0;
  std::vector<Setting> alternatives{};         ///< of the grid; none where it is sampled
  std::optional<Distribution> distribution{};  ///< where it is sampled
  std::string rows_of{};  ///< the CSV file of its values; keys of one file take them of one row
  std::vector<Condition> when{};  ///< all of them; where one does not hold the key is not set
};

/// A key whose value follows from those of others.
struct DerivedKey {
  std::string key;      ///< dotted
  std::string formula;  ///< of keys of the study
  int line = 0;
  int column = 0;
};

/// How `trackbed falsify` searches the keys that have distributions for a run that fails.
struct SearchSpec {
  std::string method = "surrogate";  ///< one of StudySearches()
  int runs = 200;                    ///< of the search at most
  int restarts = 0;                  ///< searches of NLopt side by side, each with its share of the
                                     ///< runs; 0: two, of direct one
  int population = 0;                ///< of crs2, esch and isres; 0: 4 n + 4 for n keys
  std::string finish = "none";       ///< "nelder_mead", "cobyla": for the last quarter of the runs
  std::uint64_t seed = 1;
  bool stop = true;         ///< with the first violation
  int shrink_runs = 200;    ///< at most, to make the counterexample smaller
  double tolerance = 0.01;  ///< of that, as a share of each key's range
};

/// The names that SearchSpec::method may have: "random", "latin_hypercube", "sobol", "surrogate"
/// (dlib), and the searches of NLopt that take no gradients.
const std::vector<std::string>& StudySearches();

/// Every run of a grid sets one alternative of each key of `vary` and one point of `list`. Where
/// keys are sampled there are `sample.count` runs at each point of the grid, which is the same
/// sample for each, so that what the grid compares meets the same conditions.
struct Study {
  std::string name;
  std::string file;                                  ///< as the user named it
  std::filesystem::path scenario;                    ///< found from the study's folder
  std::string scenario_text;                         ///< its content when the study was read
  std::vector<Override> overrides;                   ///< from the command line; they replace `set`
  std::vector<std::string> cameras;                  ///< as for ReadScenario
  MetricPaths metrics;                               ///< likewise
  std::vector<std::filesystem::path> asset_folders;  ///< likewise
  std::vector<Setting> set;                          ///< the same in every run
  std::vector<Variation> vary;                       ///< in the file's order
  std::vector<std::vector<Setting>> list;            ///< points of several keys; empty: none
  std::optional<SampleSpec> sample;  ///< with keys of `vary` that have distributions
  std::optional<SearchSpec> search;  ///< likewise
  std::vector<Setting> nominal;      ///< toward which a counterexample is made smaller
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
  std::string refused{};          ///< why there is no such scenario; empty: there is
};

/// Whether the file has the key `scenario`, which studies have and scenarios do not. False when it
/// cannot be read.
bool IsStudy(const std::filesystem::path& file);

/// Reads a study as strictly as ReadScenario reads a scenario, and the text of its scenario.
/// InputError with **every** problem of the study's own keys, including keys that overwrite each
/// other.
Study ReadStudy(const std::filesystem::path& file, const std::vector<Override>& overrides = {},
                const std::vector<std::string>& cameras = {}, const MetricPaths& metrics = {},
                const std::vector<std::filesystem::path>& asset_folders = {});

/// The scenario at a point, with the bisected key at `bisected`. InputError as ReadScenario,
/// problems of the study's settings with their position there.
Scenario ReadPoint(const Study& study, const std::vector<Setting>& settings,
                   std::optional<double> bisected = {});

/// The point that sets these keys, with the derived ones added; refused with the first problem
/// where there is no such scenario.
StudyPoint PointWith(const Study& study, std::vector<Setting> settings);

/// The number that a key has in a scenario with all defaults filled in; none if it has no such key.
std::optional<double> NumberAt(const Scenario& scenario, const std::string& key);

/// The points of a study, one at a time: none is kept, however many there are. The last key of the
/// grid changes fastest, points of the list faster than all keys of `vary`, and those of the sample
/// faster than the list.
///
/// Guarantees: a point depends on the study alone. Immutable: several threads may read points at a
/// time. Points of the grid that differ only in a key whose condition does not hold are one.
class StudyPoints {
 public:
  /// InputError when keys have distributions and there is no `sample`.
  explicit StudyPoints(Study study);

  [[nodiscard]] const Study& study() const { return study_; }
  [[nodiscard]] std::size_t size() const { return combinations_ * samples(); }
  /// What the point `i` of `size()` sets. InputError when a formula has no value there.
  [[nodiscard]] std::vector<Setting> Settings(std::size_t i) const;
  /// The point `i`, refused with the first problem where there is no such scenario.
  [[nodiscard]] StudyPoint Read(std::size_t i) const;

 private:
  [[nodiscard]] std::size_t samples() const;
  [[nodiscard]] std::vector<Setting> OfGrid(std::size_t combination) const;
  void KeepDistinctPoints();

  Study study_;
  std::size_t combinations_ = 1;         // of the grid
  std::vector<std::size_t> distinct_{};  // of all combinations; empty: all of them
  Eigen::MatrixXd unit_sample_;          // a row for each point of the sample
  std::vector<int> dimensions_;          // of each key of `vary` in it; -1: not sampled
};

/// The points that tell whether a study makes sense: all, or 1000 from the first to the last,
/// evenly spaced.
std::vector<std::size_t> PointsToCheck(const StudyPoints& points);

/// InputError with the problems of PointsToCheck, each once, with one point that has it unless all
/// do; bisections are checked at both ends and at a value in between. Unless `all` must be good, it
/// is enough that one is.
void CheckPoints(const StudyPoints& points, bool all);

/// A value as text in a table: numbers in shortest form, all else as YAML.
std::string CellText(const std::string& value);

}  // namespace trackbed
