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
  a.Field({"steps", "", "number of values, both ends included"}, range.steps, Need::kRequired,
          Range{.min = 2, .max = 10000});
  static const EnumNames<GridScale> scales{{GridScale::kLinear, "linear"},
                                           {GridScale::kLog, "log"}};
  a.Field({"scale", "", "spacing: linear, or geometric (needs positive ends)"}, range.scale,
          Need::kOptional, scales);
}

inline void Visit(KeyVisitor& a, BisectSpec& bisect) {
  a.Field({"key", "", "of a number, dotted"}, bisect.key, Need::kRequired);
  a.Field({"from", "", "a value that passes"}, bisect.from, Need::kRequired);
  a.Field({"to", "", "a value that fails, above `from`"}, bisect.to, Need::kRequired);
  a.Field({"tolerance", "", "distance between the value found and one that fails"},
          bisect.tolerance, Need::kRequired, kPositive);
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
  a.Identifier({"name", "", "name of the study and its output folder"}, file.study.name);
  a.Field({"scenario", "", "scenario file, relative to this file"}, file.scenario, Need::kRequired);
  a.Custom({"set", "", "dotted scenario keys and their values in every run"}, "section", file.set);
  a.Custom({"vary", "",
            "dotted scenario keys with lists or grids of values; runs all combinations, the last "
            "key fastest"},
           "section", file.vary);
  a.Custom({"list", "", "points that set several keys at once; combined with each point of `vary`"},
           "list of sections", file.list);
  a.Field({"repeat", "", "runs per point, with consecutive seeds starting at the scenario's"},
          file.study.repeat, Need::kOptional, Range{.min = 1, .max = 1e5});
  a.Section({"bisect", "", "at each point, bisects for the highest passing value of a key"},
            file.bisect);
  a.Custom({"outputs", "", "dotted results of a run, one column each"}, "list of names",
           file.outputs);
}

}  // namespace trackbed
