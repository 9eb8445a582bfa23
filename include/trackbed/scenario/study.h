#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/scenario/scenario.h"

/// A study: one scenario, many runs of it, each with other values of some of its keys.
namespace trackbed {

/// A key of the scenario, the value that it is to have, and where the study's file says so.
struct Setting {
  std::string key;    ///< dotted, as for --set
  std::string value;  ///< YAML on one line
  int line = 0;       ///< 1-based
  int column = 0;     ///< 1-based
};

/// Looks for the highest value of a key that still passes.
struct BisectSpec {
  std::string key;         ///< dotted; of a number
  double from = 0.0;       ///< taken to pass
  double to = 0.0;         ///< taken to fail; above `from`
  double tolerance = 0.0;  ///< of the value found
  int line = 0;
  int column = 0;
};

/// A result that the study asks of every run.
struct OutputSpec {
  std::string path;  ///< dotted, such as "metrics.mujoco.cross_track.max"
  int line = 0;
  int column = 0;
};

/// Every run of a grid sets one alternative of each key of `vary` and one point of `list`.
struct Study {
  std::string name;
  std::string file;                        ///< as the user named it
  std::filesystem::path scenario;          ///< found from the study's folder
  std::string scenario_text;               ///< what stood there when the study was read
  std::vector<Override> overrides;         ///< from the command line; they replace `set`
  std::vector<std::string> cameras;        ///< as for ReadScenario
  MetricPaths metrics;                     ///< likewise
  std::vector<Setting> set;                ///< what is the same in every run
  std::vector<std::vector<Setting>> vary;  ///< the alternatives of each key, in the file's order
  std::vector<std::vector<Setting>> list;  ///< points of several keys; empty: none
  int repeat = 1;                          ///< runs of each point, the seed counted up
  std::optional<BisectSpec> bisect;        ///< at every point of the grid
  std::vector<OutputSpec> outputs;
};

/// A point of a study's grid.
struct StudyPoint {
  std::vector<Setting> settings;  ///< of `vary` and `list`
  Scenario scenario;              ///< as they make it, with the bisected key at `from`
};

/// Whether the file has the key `scenario`, as studies have and scenarios have not. False when it
/// cannot be read.
bool IsStudy(const std::filesystem::path& file);

/// Reads a study as strictly as ReadScenario reads a scenario, and the text of its scenario.
/// InputError with **every** problem of the study's own keys, those that replace each other among
/// them.
Study ReadStudy(const std::filesystem::path& file, const std::vector<Override>& overrides = {},
                const std::vector<std::string>& cameras = {}, const MetricPaths& metrics = {});

/// The settings of every point in the grid's order: the last key changes fastest, points of the
/// list faster than all keys of `vary`. Pure; the grid of a study without either is one point.
std::vector<std::vector<Setting>> GridOf(const Study& study);

/// The scenario at a point, with the bisected key at `bisected`. InputError as ReadScenario, a
/// problem of what the study sets with its place there.
Scenario ReadPoint(const Study& study, const std::vector<Setting>& settings,
                   std::optional<double> bisected = {});

/// Every point of the grid, read before anything is driven. InputError with the problems of all of
/// them, each once, and with one point that has it where not all do; bisections are tried at both
/// ends and at a value between that is not round.
std::vector<StudyPoint> ReadPoints(const Study& study);

/// What a table shows of a value: numbers in shortest form, all else as YAML.
std::string CellText(const std::string& value);

}  // namespace trackbed
