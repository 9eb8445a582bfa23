#include "trackbed/analysis/metric_registry.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "src/analysis/metric_table.h"
#include "trackbed/analysis/requirement_metrics.h"
#include "trackbed/core/error.h"

// Registry of metrics. Each built-in metric (metric_table.cpp) and each registered metric has one
// entry. ListMetrics lists the metrics of a run with their paths in metrics.json. ListMetrics
// returns first the metrics that have an entry, then the metrics of the sections maneuver,
// turns[N], laps[N], windows[N] and requirements. DescribeMetric returns the label and the unit of
// the metric with a given path in metrics.json.
namespace trackbed {
namespace {

constexpr const char* kManeuver = "maneuver";
constexpr const char* kTurns = "turns";
constexpr const char* kLaps = "laps";
constexpr const char* kWindows = "windows";
constexpr const char* kRequirements = "requirements";
constexpr const char* kRobustness = ".robustness";

/// Returns the list of all metric entries, to which RegisterMetric appends.
std::vector<MetricEntry>& Registry() {
  static std::vector<MetricEntry> entries = BuiltInMetrics();
  return entries;
}

std::optional<MetricReading> ReadMetric(const MetricEntry& entry, const PlantMetrics& metrics) {
  if (entry.read) {
    return entry.read(metrics);
  }
  const auto found = std::find_if(metrics.measured.begin(), metrics.measured.end(),
                                  [&](const auto& own) { return own.first == entry.path; });
  return found == metrics.measured.end() ? std::nullopt : std::optional(found->second);
}

/// Returns the paths in metrics.json at which the values of a metric entry are written.
std::vector<std::string> EntryPaths(const MetricEntry& entry) {
  return entry.located ? std::vector{entry.path, entry.path + "_s", entry.path + "_t"}
                       : std::vector{entry.path};
}

bool IsPath(std::string_view path) {
  bool begins = true;  // whether a new word of the metric path must begin at this character
  for (const char c : path) {
    const bool letter = c >= 'a' && c <= 'z';
    const bool inside = (c >= '0' && c <= '9') || c == '_' || c == '.';
    if (!letter && (begins || !inside)) {
      return false;
    }
    begins = c == '.';
  }
  return !begins;
}

/// Returns whether two metric paths cannot exist in the same file, because the paths are equal or
/// one path is a section that contains the other path.
bool Conflict(const std::string& a, const std::string& b) {
  return a == b || a.starts_with(b + ".") || b.starts_with(a + ".");
}

/// Explains why a new metric cannot have the path `path` if another metric has the path `other`.
std::string TakenReason(const std::string& path, const std::string& other) {
  if (path == other) {
    return fmt::format("metrics.json already has '{}'; choose another name", path);
  }
  if (other.starts_with(path + ".")) {
    return fmt::format("'{}' is a section of metrics.json, with '{}'; choose another name", path,
                       other);
  }
  return fmt::format("'{0}' is a value in metrics.json, so no name may begin with '{0}.'", other);
}

void CheckEntry(const MetricEntry& entry) {
  const auto refuse = [&](const std::string& why) {
    throw InputError(Problem{.message = fmt::format("metric '{}': {}", entry.path, why)});
  };
  if (!IsPath(entry.path)) {
    refuse("must be words of a-z, 0-9 and '_' that start with a letter, joined by '.'");
  }
  if (entry.label.empty()) {
    refuse("the label is missing");
  }
  if (static_cast<bool>(entry.read) == static_cast<bool>(entry.measure)) {
    refuse("exactly one of `measure` and `read` must be given");
  }
  std::vector<std::string> taken{kManeuver, kTurns, kLaps, kWindows, kRequirements};
  for (const MetricEntry& other : Metrics()) {
    const std::vector<std::string> paths = EntryPaths(other);
    taken.insert(taken.end(), paths.begin(), paths.end());
  }
  for (const std::string& path : EntryPaths(entry)) {
    for (const std::string& other : taken) {
      if (Conflict(path, other)) {
        refuse(TakenReason(path, other));
      }
    }
  }
}

/// Returns the part of a metric path after a list index, such as "lateral_offset" for
/// "turns[1].lateral_offset". InList stores the index in brackets, such as 1 for
/// "turns[1].lateral_offset", in `index`.
std::optional<std::string_view> InList(const char* list, std::string_view path, int& index) {
  const std::string begin = fmt::format("{}[", list);
  const std::size_t close = path.find("].");
  if (!path.starts_with(begin) || close == std::string_view::npos ||
      std::from_chars(path.data() + begin.size(), path.data() + close, index).ec != std::errc{}) {
    return std::nullopt;
  }
  return path.substr(close + 2);
}

std::optional<MetricInfo> DescribeTurnMetric(std::string_view key, int index) {
  for (const TurnMetricEntry& entry : TurnMetricTable()) {
    if (key == entry.key) {
      return MetricInfo{fmt::format("Turn {}: {}", index + 1, entry.label), entry.unit};
    }
  }
  return std::nullopt;
}

std::optional<MetricInfo> DescribeLapMetric(std::string_view key, int index) {
  for (const LapMetricEntry& entry : LapMetricTable()) {
    if (key == entry.key) {
      return MetricInfo{fmt::format("Lap {}: {}", index + 1, entry.label), entry.unit,
                        key == "time"};
    }
  }
  return std::nullopt;
}

std::optional<MetricInfo> DescribeWindowMetric(std::string_view key, int index) {
  for (const WindowMetricEntry& entry : WindowMetricTable()) {
    if (key == entry.key) {
      return MetricInfo{fmt::format("Prediction {}: {}", index + 1, entry.label), entry.unit};
    }
  }
  return std::nullopt;
}

std::optional<MetricInfo> DescribeRequirementMetric(std::string_view path) {
  const std::string section = fmt::format("{}.", kRequirements);
  const std::size_t end = path.rfind(kRobustness);
  if (!path.starts_with(section) || end == std::string_view::npos || end < section.size()) {
    return std::nullopt;
  }
  const std::string_view name = path.substr(section.size(), end - section.size());
  const std::string_view rest = path.substr(end + std::string_view(kRobustness).size());
  return rest.empty()   ? std::optional(MetricInfo{fmt::format("Robustness of {}", name), "", true})
         : rest == "_s" ? std::optional(MetricInfo{"… at station", "m"})
         : rest == "_t" ? std::optional(MetricInfo{"… at", "s"})
                        : std::nullopt;
}

}  // namespace

const std::vector<MetricEntry>& Metrics() {
  return Registry();
}

void RegisterMetric(MetricEntry entry) {
  CheckEntry(entry);
  Registry().push_back(std::move(entry));
}

std::vector<Metric> ListMetrics(const PlantMetrics& metrics) {
  std::vector<Metric> all;
  const auto add = [&](std::string path, MetricValue value, MetricPlace at) {
    if (at.span != MetricSpan::kMoment && at.span != MetricSpan::kInterval) {
      at.s = metrics.end_s;
      at.t = metrics.time;
    }
    all.push_back({std::move(path), std::move(value), at});
  };
  for (const MetricEntry& entry : Metrics()) {
    const std::optional<MetricReading> reading = ReadMetric(entry, metrics);
    if (!reading) {
      continue;
    }
    add(entry.path, reading->value, reading->at);
    if (entry.located) {
      add(entry.path + "_s", reading->at.s, {});
      add(entry.path + "_t", reading->at.t, {});
    }
  }
  if (metrics.maneuver) {
    for (const Metric& own : ListMetrics(*metrics.maneuver)) {
      add(fmt::format("{}.{}", kManeuver, own.path), own.value, own.at);
    }
  }
  for (std::size_t i = 0; i < metrics.turns.size(); ++i) {
    const TurnMetrics& turn = metrics.turns[i];
    for (const TurnMetricEntry& entry : TurnMetricTable()) {
      add(fmt::format("{}[{}].{}", kTurns, i, entry.key), entry.read(turn),
          {.span = MetricSpan::kMoment, .s = turn.s, .t = turn.t});
    }
  }
  for (std::size_t i = 0; i < metrics.laps.size(); ++i) {
    const LapMetrics& lap = metrics.laps[i];
    for (const LapMetricEntry& entry : LapMetricTable()) {
      add(fmt::format("{}[{}].{}", kLaps, i, entry.key), entry.read(lap),
          {.span = MetricSpan::kInterval, .s = lap.s, .t = lap.t, .from_t = lap.t - lap.time});
    }
  }
  for (std::size_t i = 0; i < metrics.windows.size(); ++i) {
    for (const WindowMetricEntry& entry : WindowMetricTable()) {
      add(fmt::format("{}[{}].{}", kWindows, i, entry.key), entry.read(metrics.windows[i]), {});
    }
  }
  for (const RequirementMetrics& requirement : metrics.requirements) {
    if (requirement.robustness) {
      const std::string path = RequirementPath(requirement.name);
      add(path, *requirement.robustness,
          {.span = MetricSpan::kMoment, .s = requirement.s, .t = requirement.t});
      add(path + "_s", requirement.s, {});
      add(path + "_t", requirement.t, {});
    }
  }
  return all;
}

std::optional<MetricInfo> DescribeMetric(std::string_view path) {
  int index = 0;
  if (const auto key = InList(kTurns, path, index)) {
    return DescribeTurnMetric(*key, index);
  }
  if (const auto key = InList(kLaps, path, index)) {
    return DescribeLapMetric(*key, index);
  }
  if (const auto key = InList(kWindows, path, index)) {
    return DescribeWindowMetric(*key, index);
  }
  if (const std::string section = fmt::format("{}.", kManeuver); path.starts_with(section)) {
    std::optional<MetricInfo> info = DescribeManeuverMetric(path.substr(section.size()));
    if (info) {
      info->label = "Maneuver: " + info->label;
    }
    return info;
  }
  if (const std::optional<MetricInfo> info = DescribeRequirementMetric(path)) {
    return info;
  }
  for (const MetricEntry& entry : Metrics()) {
    if (path == entry.path) {
      return MetricInfo{entry.label, entry.unit, entry.headline};
    }
    if (entry.located && path == entry.path + "_s") {
      return MetricInfo{"… at station", "m"};
    }
    if (entry.located && path == entry.path + "_t") {
      return MetricInfo{"… at", "s"};
    }
  }
  return std::nullopt;
}

std::optional<MetricInfo> DescribeComparisonMetric(std::string_view path) {
  const std::size_t dot = path.find('.');
  const std::string_view what = dot == std::string_view::npos ? "" : path.substr(dot + 1);
  for (const ComparedQuantity& quantity : ComparedQuantities()) {
    if (path.substr(0, dot) != quantity.key) {
      continue;
    }
    const bool headline = quantity.difference == &PlantComparison::position;
    return what == "max"   ? std::optional(MetricInfo{quantity.max_label, quantity.unit, headline})
           : what == "rms" ? std::optional(MetricInfo{quantity.rms_label, quantity.unit})
           : what == "max_s" ? std::optional(MetricInfo{"… at station", "m"})
           : what == "max_t" ? std::optional(MetricInfo{"… at", "s"})
                             : std::nullopt;
  }
  return path == "from_s"     ? std::optional(MetricInfo{"Compared from station", "m"})
         : path == "to_s"     ? std::optional(MetricInfo{"… to station", "m"})
         : path == "compared" ? std::optional(MetricInfo{"Compared", ""})
                              : std::nullopt;
}

}  // namespace trackbed
