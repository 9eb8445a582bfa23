#include "src/report/names.h"

#include <fmt/format.h>

#include <array>
#include <charconv>

#include "trackbed/scenario/keys.h"

namespace trackbed {
namespace {

struct Entry {
  const char* path;
  const char* label;
  const char* unit;
  bool headline = false;
};

constexpr std::array kMetrics{
    Entry{"status", "Ended as", ""},
    Entry{"time", "Time", "s", true},
    Entry{"distance", "Distance driven", "m"},
    Entry{"cross_track.max", "Largest cross-track error", "m", true},
    Entry{"cross_track.max_s", "… at station", "m"},
    Entry{"cross_track.max_t", "… at", "s"},
    Entry{"cross_track.rms", "Cross-track error, rms", "m"},
    Entry{"cross_track.final", "Cross-track error at the end", "m"},
    Entry{"heading_error.max", "Largest heading error", "rad", true},
    Entry{"heading_error.max_s", "… at station", "m"},
    Entry{"heading_error.max_t", "… at", "s"},
    Entry{"heading_error.rms", "Heading error, rms", "rad"},
    Entry{"goal_distance", "Distance to the goal", "m", true},
    Entry{"goal_heading_error", "Heading error at the goal", "rad"},
    Entry{"clearance_min", "Smallest clearance", "m", true},
    Entry{"clearance_min_s", "… at station", "m"},
    Entry{"clearance_min_t", "… at", "s"},
    Entry{"collision", "Collision", ""},
    Entry{"obstacle_force_max", "Largest force with an obstacle", "N"},
    Entry{"recovery_time", "Recovered after", "s"},
    Entry{"plan_changes", "Plans taken up on the way", ""},
    Entry{"blocked", "Blocked", ""},
    Entry{"partial", "Part of the way only", ""},
    Entry{"lateral_acceleration_max", "Largest lateral acceleration over 0.1 s", "m/s²", true},
    Entry{"lateral_acceleration_max_s", "… at station", "m"},
    Entry{"lateral_acceleration_max_t", "… at", "s"},
    Entry{"steering_max", "Largest steering angle", "rad"},
    Entry{"steering_rate_max", "Largest steering rate over 0.1 s", "rad/s"},
    Entry{"steering_rate_max_s", "… at station", "m"},
    Entry{"steering_rate_max_t", "… at", "s"},
    Entry{"steering_rate_rms", "Steering rate, rms", "rad/s"},
    Entry{"steering_saturated_fraction", "Share of time at the steering rate's limit", ""},
    Entry{"yaw_rate_ratio", "Yaw rate over the kinematic car's", ""},
    Entry{"heading_deficit_predicted", "heading deficit, predicted", "rad"},
    Entry{"heading_deficit", "heading deficit", "rad"},
    Entry{"lateral_offset_predicted", "lateral offset, predicted", "m"},
    Entry{"lateral_offset", "lateral offset", "m"},
    Entry{"waypoint", "waypoint", ""},
};

constexpr std::array kComparisons{
    Entry{"position.max", "Largest distance", "m", true},
    Entry{"position.max_s", "… at station", "m"},
    Entry{"position.max_t", "… at", "s"},
    Entry{"position.rms", "Distance, rms", "m"},
    Entry{"heading.max", "Largest difference of heading", "rad"},
    Entry{"heading.max_s", "… at station", "m"},
    Entry{"heading.max_t", "… at", "s"},
    Entry{"heading.rms", "Difference of heading, rms", "rad"},
    Entry{"yaw_rate.max", "Largest difference of yaw rate", "rad/s"},
    Entry{"yaw_rate.max_s", "… at station", "m"},
    Entry{"yaw_rate.max_t", "… at", "s"},
    Entry{"yaw_rate.rms", "Difference of yaw rate, rms", "rad/s"},
    Entry{"steering.max", "Largest difference of steering", "rad"},
    Entry{"steering.max_s", "… at station", "m"},
    Entry{"steering.max_t", "… at", "s"},
    Entry{"steering.rms", "Difference of steering, rms", "rad"},
    Entry{"from_s", "Compared from station", "m"},
    Entry{"to_s", "… to station", "m"},
};

template <std::size_t size>
ShownName Find(const std::array<Entry, size>& entries, const std::string& path) {
  for (const Entry& entry : entries) {
    if (path == entry.path) {
      return {entry.label, entry.unit, entry.headline};
    }
  }
  return {path, ""};
}

/// Cuts off what stands before the first dot.
std::string TakeWord(std::string& path) {
  const std::size_t dot = path.find('.');
  std::string word = path.substr(0, dot);
  path.erase(0, dot == std::string::npos ? dot : dot + 1);
  return word;
}

}  // namespace

ShownName NameOfMetric(const std::string& path) {
  constexpr std::string_view kTurn = "turns[";
  const std::size_t close = path.find("].");
  if (path.starts_with(kTurn) && close != std::string::npos) {
    int turn = 0;
    std::from_chars(path.data() + kTurn.size(), path.data() + close, turn);
    ShownName name = Find(kMetrics, path.substr(close + 2));
    name.label = fmt::format("Turn {}: {}", turn + 1, name.label);
    return name;
  }
  return Find(kMetrics, path);
}

ShownName NameOfComparison(const std::string& path) {
  return Find(kComparisons, path);
}

ShownName NameOfOutput(const std::string& path) {
  std::string rest = path;
  const std::string kind = TakeWord(rest);
  if (kind == "metrics") {
    const std::string plant = TakeWord(rest);
    ShownName name = NameOfMetric(rest);
    // "… at station" needs the row above it.
    name.label = name.label.starts_with("…") ? rest : name.label;
    name.label += plant == "*" ? "" : fmt::format(" ({})", plant);
    return name;
  }
  if (kind == "between") {
    const std::string first = TakeWord(rest);
    const std::string second = TakeWord(rest);
    ShownName name = NameOfComparison(rest);
    name.label = name.label.starts_with("…") ? rest : name.label;
    name.label += fmt::format(" ({} – {})", first, second);
    return name;
  }
  return {path, path == "plan.length_m" ? "m" : ""};
}

ShownName NameOfKey(const std::string& key) {
  for (const KeySection& section : ScenarioKeys()) {
    for (const KeyInfo& info : section.keys) {
      if (key == (section.key.empty() ? info.name : section.key + "." + info.name)) {
        return {key, info.unit};
      }
    }
  }
  return {key, ""};
}

}  // namespace trackbed
