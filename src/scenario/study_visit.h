#pragma once

#include <array>
#include <functional>
#include <limits>
#include <optional>

#include "src/scenario/key_lister.h"
#include "src/scenario/visit.h"
#include "src/scenario/yaml_reader.h"
#include "trackbed/scenario/study.h"

/// Declares the keys of a study file, for reading and for listing the keys.
namespace trackbed {

enum class GridScale { kLinear, kLog };

/// Evenly spaced values of a key, which a study may specify instead of a list of values.
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

/// Visits the parameters of a random distribution in a study file, depending on its kind.
inline void Visit(KeyVisitor& a, Distribution& distribution) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  switch (distribution.kind) {
    case DistributionKind::kUniform:
    case DistributionKind::kLogUniform:
    case DistributionKind::kInteger:
      a.Field({"from", "", "the smallest value"}, distribution.from, Need::kRequired);
      a.Field({"to", "", "the largest value"}, distribution.to, Need::kRequired);
      if (distribution.kind == DistributionKind::kUniform) {
        std::optional<double> step;
        a.Field({"step", "", "values are `from` plus multiples of it; default: any value"}, step,
                kPositive);
        distribution.step = step.value_or(0.0);
      }
      break;
    case DistributionKind::kNormal: {
      a.Field({"mean", "", "without truncation"}, distribution.mean, Need::kRequired);
      a.Field({"deviation", "", "standard deviation, without truncation"}, distribution.deviation,
              Need::kRequired, kPositive);
      std::optional<double> min;
      std::optional<double> max;
      a.Field({"min", "", "truncates the distribution"}, min);
      a.Field({"max", "", "truncates the distribution"}, max);
      distribution.min = min.value_or(-kInfinity);
      distribution.max = max.value_or(kInfinity);
      break;
    }
    case DistributionKind::kChoice:
      a.Field({"weights", "", "of the values; default: all alike"}, distribution.weights,
              Need::kOptional, Range{.min = 0.0});
      break;
  }
}

/// Names of the distributions in study files. With the distribution `file`, a study draws random
/// rows of a CSV table.
inline constexpr const char* kFileDistribution = "file";
template <typename Enum, std::size_t count>
EnumNames<Enum> NamesOf(const std::array<Enum, count>& values) {
  EnumNames<Enum> names;
  for (const Enum value : values) {
    names.emplace_back(value, ToString(value));
  }
  return names;
}

inline const EnumNames<DistributionKind>& DistributionNames() {
  static const EnumNames<DistributionKind> names = NamesOf(
      std::array{DistributionKind::kUniform, DistributionKind::kLogUniform,
                 DistributionKind::kInteger, DistributionKind::kNormal, DistributionKind::kChoice});
  return names;
}

/// A column of a CSV file; the values of a varied key are cells of this column.
struct TableColumn {
  std::string file;
  std::string column;
};

inline void Visit(KeyVisitor& a, TableColumn& table) {
  a.Field({"file", "", "CSV file with a header, relative to this file"}, table.file,
          Need::kRequired);
  a.Field({"column", "", "of the values; keys of one file take them of one row"}, table.column,
          Need::kRequired);
}

inline void Visit(KeyVisitor& a, SampleSpec& sample) {
  a.Field({"count", "", "points, at each of the grid"}, sample.count, Need::kRequired,
          Range{.min = 1, .max = 1e6});
  static const EnumNames<SampleMethod> methods = NamesOf(
      std::array{SampleMethod::kRandom, SampleMethod::kLatinHypercube, SampleMethod::kSobol});
  a.Field({"method", "", "how the points fill the space"}, sample.method, Need::kOptional, methods);
  a.Field({"seed", "", "of the sample, not of the runs"}, sample.seed, Need::kOptional);
}

inline void Visit(KeyVisitor& a, SearchSpec& search) {
  a.Field({"method", "", "how it searches"}, search.method, Need::kOptional, StudySearches());
  a.Field({"runs", "", "of the search, at most"}, search.runs, Need::kOptional,
          Range{.min = 1, .max = 1e6});
  a.Field({"restarts", "",
           "searches of NLopt side by side, each with its share of the runs; 0: 2, of direct 1"},
          search.restarts, Need::kOptional, Range{.min = 0, .max = 64});
  a.Field({"population", "", "of crs2, esch and isres; 0: 4 n + 4 for n keys"}, search.population,
          Need::kOptional, Range{.min = 0, .max = 1e5});
  a.Field({"finish", "",
           "search that goes on from the best point of each restart, for the last quarter of the "
           "runs"},
          search.finish, Need::kOptional, {"none", "nelder_mead", "cobyla"});
  a.Field({"seed", "", "of the search, not of the runs"}, search.seed, Need::kOptional);
  a.Field({"stop", "", "whether the first violation ends the search"}, search.stop,
          Need::kOptional);
  a.Field({"shrink_runs", "", "to make the counterexample smaller, at most; 0: it stays as found"},
          search.shrink_runs, Need::kOptional, Range{.min = 0, .max = 1e5});
  a.Field({"tolerance", "", "of the smaller counterexample, as a share of each key's range"},
          search.tolerance, Need::kOptional, Range{.min = 1e-4, .max = 0.5});
}

inline void Visit(KeyVisitor& a, BisectSpec& bisect) {
  a.Field({"key", "", "of a number, dotted"}, bisect.key, Need::kRequired);
  a.Field({"from", "", "a value that passes"}, bisect.from, Need::kRequired);
  a.Field({"to", "", "a value that fails, above `from`"}, bisect.to, Need::kRequired);
  a.Field({"tolerance", "", "distance between the value found and one that fails"},
          bisect.tolerance, Need::kRequired, kPositive);
}

/// Content of a study file, and the functions that read its sections with keys of a scenario.
struct StudyFile {
  using Read = std::function<void(const YAML::Node& node, const std::string& key)>;

  Study study{};
  std::string scenario{};
  BisectSpec bisect{};
  SampleSpec sample{};
  SearchSpec search{};
  Read set{};
  Read vary{};
  Read list{};
  Read derive{};
  Read outputs{};
  Read nominal{};
  std::string keep = "none";
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
            "dotted scenario keys with lists, grids or distributions of values; runs all "
            "combinations of lists and grids, the last key fastest"},
           "section", file.vary);
  a.Section({"sample", "", "how the keys with distributions are sampled"}, file.sample);
  a.Section({"search", "", "how `trackbed falsify` searches the keys with distributions"},
            file.search);
  a.Custom({"nominal", "",
            "dotted keys of `vary` and the values toward which `trackbed falsify` makes a "
            "counterexample smaller; default: those of the scenario"},
           "section", file.nominal);
  a.Custom({"list", "", "points that set several keys at once; combined with each point of `vary`"},
           "list of sections", file.list);
  a.Custom(
      {"derive", "",
       "dotted scenario keys with formulas of keys that the study sets; operators and functions "
       "of muParser"},
      "section", file.derive);
  a.Field({"repeat", "", "runs per point, with consecutive seeds starting at the scenario's"},
          file.study.repeat, Need::kOptional, Range{.min = 1, .max = 1e5});
  a.Section({"bisect", "", "at each point, bisects for the highest passing value of a key"},
            file.bisect);
  a.Custom({"outputs", "", "dotted results of a run, one column each"}, "list of names",
           file.outputs);
  a.Field({"keep", "",
           "rows whose run folders are kept, in `rows`: none, failed, all, worst N by OUTPUT (the "
           "highest values), lowest N by OUTPUT"},
          file.keep, Need::kOptional);
}

}  // namespace trackbed
