#include "trackbed/analysis/metric_registry.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "src/analysis/metric_table.h"
#include "trackbed/analysis/requirement_metrics.h"
#include "trackbed/core/error.h"
#include "trackbed/core/text_table.h"
#include "trackbed/planning/registry/planners.h"

// Registry of metrics. Each built-in metric (metric_table.cpp) and each registered metric has one
// entry. ListMetrics lists the metrics of a run with their paths in metrics.json. ListMetrics
// returns first the metrics that have an entry, then the metrics of the sections maneuver,
// turns[N], laps[N], windows[N] and requirements. DescribeMetric returns the label and the unit of
// the metric at a path. AllMetrics sets every metric that a run of a scenario can have to a dummy
// value, so that the paths of metrics can be checked before the run.
namespace trackbed {
namespace {

using nlohmann::ordered_json;

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
  bool begins = true;  // whether a new word of the path must begin at this character
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
        refuse(fmt::format("conflicts with the metric '{}'", other));
      }
    }
  }
}

/// Returns the part of a metric path after a list index, such as "lateral_offset" for
/// "turns[1].lateral_offset". InList also stores the list index of the path in `index`.
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

ordered_json ToJson(const MetricValue& value) {
  return std::visit(
      [](const auto& own) -> ordered_json {
        if constexpr (std::is_same_v<std::decay_t<decltype(own)>, std::monostate>) {
          return nullptr;
        } else {
          return own;
        }
      },
      value);
}

std::string ToText(const MetricValue& value) {
  if (const auto* number = std::get_if<double>(&value)) {
    return ShortestText(*number);
  }
  const auto* text = std::get_if<std::string>(&value);
  return text != nullptr ? *text : ToJson(value).dump();
}

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

void PutMetric(const Metric& metric, ordered_json& json) {
  std::string pointer = "/";
  for (const char c : metric.path) {
    if (c != ']') {
      pointer += c == '.' || c == '[' ? '/' : c;
    }
  }
  json[ordered_json::json_pointer(pointer)] = ToJson(metric.value);
}

ordered_json ToJson(const PlantMetrics& metrics) {
  ordered_json json;
  for (const Metric& metric : ListMetrics(metrics)) {
    PutMetric(metric, json);
  }
  return json;
}

PlantMetrics AllMetrics(const Scenario& scenario, const std::string& plant) {
  PlantMetrics metrics;
  metrics.plant = plant;
  metrics.yaw_rate_ratio = 1.0;
  metrics.steering_activity = 0.0;
  if (scenario.plan) {
    metrics.oscillation.emplace();
    metrics.tracking.emplace().overspeed_max = 0.0;
    constexpr double kAnyTime = std::numeric_limits<double>::infinity();
    if (DisturbedUntil(scenario.disturb, scenario.world.wind, kAnyTime)) {
      metrics.recovery.emplace();
    }
    metrics.blocked = scenario.plan->avoid ? "why" : "";
    metrics.partial = MayBePartial(scenario.plan->global) ? "why" : "";
    if (scenario.mission.waypoints.size() > 1) {
      metrics.waypoint_miss.emplace();
    }
    // The path turns at most once at each waypoint between the first and the last waypoint.
    metrics.turns.resize(std::max<std::size_t>(scenario.mission.waypoints.size(), 2) - 2);
  }
  if (HasObstacles(scenario.world)) {
    metrics.clearance.emplace();
  }
  if (scenario.maneuver) {
    metrics.maneuver = AllMetrics(*scenario.maneuver);
  }
  if (scenario.record) {
    metrics.recorded.emplace();
    metrics.windows.resize(scenario.record->windows.size());
  }
  std::set<std::string> requirements;
  const auto require = [&](const PlantExpectation& expect) {
    for (const RequirementExpectation& own : expect.requirements) {
      if (requirements.insert(own.name).second) {
        metrics.requirements.push_back({.name = own.name, .robustness = 0.0});
      }
    }
  };
  require(scenario.expect.all);
  for (const auto& [name, own] : scenario.expect.plants) {
    if (plant.empty() || name == plant) {
      require(own);
    }
  }
  if (scenario.mission.track) {
    metrics.laps.resize(static_cast<std::size_t>(scenario.mission.track->laps));
  }
  const AidOptions aids = scenario.vehicle.aids.value_or(AidOptions{});
  for (const MetricEntry& entry : Metrics()) {
    // Metrics of track limits exist only for runs on a track, metrics of road limits only for
    // routes over lanes, metrics of driver aids only for cars with these aids, and metrics of
    // trailers only for cars with a trailer.
    const bool of_track = entry.path.starts_with("track_limits.");
    const bool of_road = entry.path.starts_with("road_limits.");
    const bool of_abs = entry.path.starts_with("aids.abs_");
    const bool of_esc = entry.path.starts_with("aids.esc_");
    const bool of_trailer =
        entry.path.starts_with("hitch_") || entry.path.starts_with("off_tracking.");
    if (entry.measure && (!of_track || scenario.mission.track) &&
        (!of_road || !scenario.mission.route.empty()) && (!of_abs || aids.abs) &&
        (!of_esc || aids.esc) && (!of_trailer || scenario.vehicle.trailer)) {
      metrics.measured.emplace_back(entry.path, MetricReading{0.0, {}});
    }
  }
  return metrics;
}

std::vector<std::string> PossibleMetrics(const Scenario& scenario) {
  std::vector<std::string> paths;
  for (const Metric& metric : ListMetrics(AllMetrics(scenario, ""))) {
    paths.push_back(metric.path);
  }
  return paths;
}

}  // namespace trackbed
