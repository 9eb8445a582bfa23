#pragma once

#include <functional>

#include "src/scenario/key_lister.h"
#include "src/scenario/visit.h"
#include "src/scenario/yaml_reader.h"
#include "trackbed/scenario/study.h"

/// The keys of a study, each named once for reading and listing alike.
namespace trackbed {

enum class GridScale { kLinear, kLog };

/// An even grid of values, in place of a list of them.
struct GridRange {
  double from = 0.0;
  double to = 0.0;
  int steps = 0;
  GridScale scale = GridScale::kLinear;
};

inline void Visit(KeyVisitor& a, GridRange& range) {
  a.Field({"from", "", "the first value"}, range.from, Need::kRequired);
  a.Field({"to", "", "the last value, above the first"}, range.to, Need::kRequired);
  a.Field({"steps", "", "how many values, both ends included"}, range.steps, Need::kRequired,
          Range{.min = 2, .max = 10000});
  static const EnumNames<GridScale> scales{{GridScale::kLinear, "linear"},
                                           {GridScale::kLog, "log"}};
  a.Field({"scale", "", "equal differences, or equal ratios between positive ends"}, range.scale,
          Need::kOptional, scales);
}

inline void Visit(KeyVisitor& a, BisectSpec& bisect) {
  a.Field({"key", "", "of a number, dotted"}, bisect.key, Need::kRequired);
  a.Field({"from", "", "a value that passes"}, bisect.from, Need::kRequired);
  a.Field({"to", "", "a value that fails, above the first"}, bisect.to, Need::kRequired);
  a.Field({"tolerance", "", "how near the value found is to one that fails"}, bisect.tolerance,
          Need::kRequired, kPositive);
}

/// The file of a study. What is under keys of the scenario's is read by the functions.
struct StudyFile {
  using Read = std::function<void(const YAML::Node& node, const std::string& key)>;

  Study study{};
  std::string scenario{};
  BisectSpec bisect{};
  Read set{};
  Read vary{};
  Read list{};
  Read outputs{};
};

template <typename Archive>
void Visit(Archive& a, StudyFile& file) {
  int schema = 1;
  a.Field({"schema", "", "version of this format"}, schema, Need::kRequired,
          Range{.min = 1, .max = 1});
  a.Identifier({"name", "", "names the study and its folder"}, file.study.name);
  a.Field({"scenario", "", "what is run: a scenario file, relative to this one"}, file.scenario,
          Need::kRequired);
  a.Custom({"set", "", "keys of the scenario, dotted, and their values in every run"}, "section",
           file.set);
  a.Custom({"vary", "",
            "keys of the scenario and lists of values, or grids: every combination is run, the "
            "last key changing fastest"},
           "section", file.vary);
  a.Custom({"list", "", "points that set several keys at once; with `vary`, all at each of its"},
           "list of sections", file.list);
  a.Field({"repeat", "", "runs of each point, with the scenario's seed, the next, ..."},
          file.study.repeat, Need::kOptional, Range{.min = 1, .max = 1e5});
  a.Section({"bisect", "", "looks at each point for the highest value of a key that passes"},
            file.bisect);
  a.Custom({"outputs", "", "results of a run, dotted, a column each"}, "list of names",
           file.outputs);
}

}  // namespace trackbed
