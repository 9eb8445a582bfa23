#include "src/analysis/metric_expectations.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>

#include "src/analysis/json_leaves.h"
#include "trackbed/core/spelling.h"
#include "trackbed/core/text_table.h"
#include "trackbed/planning/registry/planners.h"

namespace trackbed {
namespace {

using Leaves = std::vector<std::pair<std::string, nlohmann::ordered_json>>;

const nlohmann::ordered_json* Find(const Leaves& leaves, const std::string& path) {
  const auto found = std::find_if(leaves.begin(), leaves.end(),
                                  [&](const auto& leaf) { return leaf.first == path; });
  return found == leaves.end() ? nullptr : &found->second;
}

/// The units of metrics, by their paths without `manoeuvre.` and `turns[N].`; the rest are ratios
/// and counts.
std::string_view UnitOf(std::string_view path) {
  struct Unit {
    std::string_view unit;
    std::vector<std::string_view> paths;
  };
  static const std::vector<Unit> kUnits{
      {"m",
       {"distance", "cross_track.rms", "cross_track.max", "cross_track.final", "goal_distance",
        "clearance_min", "lateral_offset", "lateral_offset_predicted", "lateral_displacement",
        "lateral_deviation_max", "margin", "margin_1", "margin_3", "margin_5"}},
      {"rad",
       {"steering_max", "heading_error.rms", "heading_error.max", "goal_heading_error",
        "heading_deficit", "heading_deficit_predicted", "heading_deviation_max", "sideslip_steady",
        "steering_at_0_3_g"}},
      {"s",
       {"time", "recovery_time", "yaw_rate_response_time", "yaw_rate_peak_time",
        "lateral_acceleration_response_time", "lateral_acceleration_peak_time", "begin", "end"}},
      {"m/s",
       {"speed", "entry_speed", "speed_loss", "initial_speed", "characteristic_speed",
        "critical_speed"}},
      {"rad/s",
       {"steering_rate_max", "steering_rate_rms", "yaw_rate_max", "yaw_rate_steady",
        "yaw_rate_peak", "yaw_rate_deviation_max"}},
      {"m/s^2",
       {"lateral_acceleration_max", "lateral_acceleration_steady",
        "mean_fully_developed_deceleration"}},
      {"rad s^2/m", {"understeer_gradient", "roll_gradient", "sideslip_gradient"}},
      {"1/s", {"yaw_rate_gain"}},
      {"s rad", {"tb"}},
      {"N", {"obstacle_force_max"}}};
  for (const std::string_view section : {"manoeuvre.", "turns["}) {
    if (path.starts_with(section)) {
      path.remove_prefix(path.find('.') + 1);
    }
  }
  for (const Unit& unit : kUnits) {
    if (std::find(unit.paths.begin(), unit.paths.end(), path) != unit.paths.end()) {
      return unit.unit;
    }
  }
  return path.ends_with("_s") ? "m" : path.ends_with("_t") ? "s" : "";
}

/// The number of "turns[3].lateral_offset".
std::optional<std::size_t> TurnOf(std::string_view path) {
  constexpr std::string_view kTurns = "turns[";
  std::size_t turn = 0;
  if (!path.starts_with(kTurns) ||
      std::from_chars(path.data() + kTurns.size(), path.data() + path.size(), turn).ec !=
          std::errc()) {
    return std::nullopt;
  }
  return turn;
}

std::string At(double s, double t) {
  return fmt::format(" at s = {:.4g} m, t = {:.4g} s", s, t);
}

/// Where and when a metric was what it is: a largest value stands beside its `…_s` and `…_t`.
std::string Whereabouts(const std::string& path, const Leaves& leaves,
                        const PlantMetrics& metrics) {
  const nlohmann::ordered_json* s = Find(leaves, path + "_s");
  const nlohmann::ordered_json* t = Find(leaves, path + "_t");
  if (s != nullptr && t != nullptr) {
    return At(s->get<double>(), t->get<double>());
  }
  if (const auto turn = TurnOf(path); turn && *turn < metrics.turns.size()) {
    return At(metrics.turns[*turn].s, metrics.turns[*turn].t);
  }
  if (path == "collision" && metrics.clearance) {
    return At(metrics.clearance->min_s, metrics.clearance->min_t);
  }
  if (path == "obstacle_force_max" && metrics.clearance) {
    return At(metrics.clearance->force_max_s, metrics.clearance->force_max_t);
  }
  if (path == "recovery_time" && metrics.recovery) {
    return fmt::format(" from t = {:.4g} s on", metrics.recovery->from);
  }
  if (path.starts_with("manoeuvre.") && metrics.manoeuvre) {
    return fmt::format(" between t = {:.4g} s and {:.4g} s", metrics.manoeuvre->begin,
                       metrics.manoeuvre->end);
  }
  if (path == "status" || path == "distance" || path == "time" || path == "cross_track.final" ||
      path.starts_with("goal_")) {
    return fmt::format(" at the end, s = {:.4g} m, t = {:.4g} s", metrics.end_s, metrics.time);
  }
  return OverTheDrive(metrics);
}

/// Why a metric that a run can have is not there.
std::string WhyMissing(const std::string& path, const Leaves& leaves, const PlantMetrics& metrics) {
  if (TurnOf(path)) {
    return fmt::format("{} expected, but the drive has {} turns that stand alone", path,
                       metrics.turns.size());
  }
  if (path.starts_with("manoeuvre.") && metrics.manoeuvre && !metrics.manoeuvre->missing.empty()) {
    return fmt::format("{} expected, but not measured: {}", path, metrics.manoeuvre->missing);
  }
  std::vector<std::string> paths;
  for (const auto& leaf : leaves) {
    // One turn shows what there is of all.
    if (TurnOf(leaf.first).value_or(0) == 0) {
      paths.push_back(leaf.first);
    }
  }
  return "no metric " + UnknownName(path, paths);
}

/// Whether a value is what a scenario wrote.
bool Equals(const nlohmann::ordered_json& value, const std::string& expected) {
  if (value.is_string()) {
    return value.get<std::string>() == expected;
  }
  const auto parsed = nlohmann::ordered_json::parse(expected, nullptr, false);
  return !parsed.is_discarded() && parsed == value;
}

}  // namespace

std::string OverTheDrive(const PlantMetrics& metrics) {
  return fmt::format(" over the drive to s = {:.4g} m, t = {:.4g} s", metrics.end_s, metrics.time);
}

PlantMetrics EveryMetricOf(const Scenario& scenario, const std::string& plant) {
  PlantMetrics metrics;
  metrics.plant = plant;
  metrics.yaw_rate_ratio = 1.0;
  if (scenario.plan) {
    metrics.tracking.emplace();
    constexpr double kAnyTime = std::numeric_limits<double>::infinity();
    if (DisturbedUntil(scenario.disturb, scenario.world.wind, kAnyTime)) {
      metrics.recovery.emplace();
    }
    metrics.blocked = scenario.plan->avoid ? "why" : "";
    metrics.partial = MayBePartial(scenario.plan->global) ? "why" : "";
    // At most one turn at every waypoint between the first and the last.
    metrics.turns.resize(std::max<std::size_t>(scenario.mission.waypoints.size(), 2) - 2);
  }
  if (!scenario.world.obstacles.empty()) {
    metrics.clearance.emplace();
  }
  if (scenario.manoeuvre) {
    metrics.manoeuvre = EveryMetricOf(*scenario.manoeuvre);
  }
  return metrics;
}

std::vector<std::string> PossibleMetrics(const Scenario& scenario) {
  std::vector<std::string> paths;
  for (const auto& leaf : LeavesOf(ToJson(EveryMetricOf(scenario, "")))) {
    paths.push_back(leaf.first);
  }
  return paths;
}

void JudgeMetrics(const std::vector<MetricExpectation>& expectations, const PlantMetrics& metrics,
                  Verdict& verdict) {
  if (expectations.empty()) {
    return;
  }
  const Leaves leaves = LeavesOf(ToJson(metrics));
  const auto fail = [&](std::string message) {
    verdict.failures.push_back(metrics.plant + ": " + std::move(message));
  };
  for (const MetricExpectation& expect : expectations) {
    const nlohmann::ordered_json* found = Find(leaves, expect.metric);
    if (found == nullptr) {
      fail(WhyMissing(expect.metric, leaves, metrics));
      continue;
    }
    const nlohmann::ordered_json& value = *found;
    const std::string where = Whereabouts(expect.metric, leaves, metrics);
    const std::string_view name = UnitOf(expect.metric);
    const std::string unit = name.empty() ? "" : fmt::format(" {}", name);
    if (expect.equals && !Equals(value, *expect.equals)) {
      fail(value.is_number()
               ? fmt::format("{} expected to be {}{}, was {}{}{}", expect.metric, *expect.equals,
                             unit, value.dump(), unit, where)
               : fmt::format("{} expected to be {}, was {}{}", expect.metric, *expect.equals,
                             value.is_string() ? value.get<std::string>() : value.dump(), where));
    }
    if (!expect.min && !expect.max) {
      continue;
    }
    if (expect.metric == "recovery_time" && value.is_null()) {
      fail(
          fmt::format("recovery_time expected to be a number, but the car had not recovered{} at "
                      "the end, s = {:.4g} m, t = {:.4g} s",
                      where, metrics.end_s, metrics.time));
      continue;
    }
    if (!value.is_number()) {
      fail(fmt::format("{} expected to be a number, was {}", expect.metric, value.dump()));
      continue;
    }
    const double actual = value.get<double>();
    const auto compare = [&](const char* bound, double limit) {
      const auto [expected, was] = TextsApart(limit, actual);
      fail(fmt::format("{} expected at {} {}{}, was {}{}{}", expect.metric, bound, expected, unit,
                       was, unit, where));
    };
    if (expect.min && !(actual >= *expect.min)) {
      compare("least", *expect.min);
    }
    if (expect.max && !(actual <= *expect.max)) {
      compare("most", *expect.max);
    }
  }
}

}  // namespace trackbed
