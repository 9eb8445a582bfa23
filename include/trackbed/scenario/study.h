#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

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

/// Every run of a grid sets one alternative of each key of `vary` and one point of `list`.
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
  std::vector<std::vector<Setting>> vary;  ///< the alternatives of each key, in the file's order
  std::vector<std::vector<Setting>> list;  ///< points of several keys; empty: none
  int repeat = 1;                          ///< runs per point, with consecutive seeds
  std::optional<BisectSpec> bisect;        ///< at every point of the grid
  std::vector<OutputSpec> outputs;
};

/// A point of a study's grid.
struct StudyPoint {
  std::vector<Setting> settings;  ///< of `vary` and `list`
  Scenario scenario;              ///< with these settings, and the bisected key at `from`
  std::string refused{};          ///< why there is no such scenario; empty: there is
};

/// What happens to a study some of whose points are no scenarios.
enum class BadPoints {
  kThrow,  ///< it is refused
  kKeep,   ///< it is read, unless all of its points are bad; see StudyPoint::refused
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

/// The settings of every point in the grid's order: the last key changes fastest, points of the
/// list faster than all keys of `vary`. Pure; the grid of a study without either is one point.
std::vector<std::vector<Setting>> ExpandGrid(const Study& study);

/// The scenario at a point, with the bisected key at `bisected`. InputError as ReadScenario,
/// problems of the study's settings with their position there.
Scenario ReadPoint(const Study& study, const std::vector<Setting>& settings,
                   std::optional<double> bisected = {});

/// All points of the grid, validated before the first run. InputError with the problems of all
/// points, each once, with one point that has it unless all do, unless bad points are to be kept
/// and others are good; bisections are checked at both ends and at a value in between.
std::vector<StudyPoint> ReadPoints(const Study& study, BadPoints bad_points = BadPoints::kThrow);

/// A value as text in a table: numbers in shortest form, all else as YAML.
std::string CellText(const std::string& value);

}  // namespace trackbed
