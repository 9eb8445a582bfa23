#include "trackbed/analysis/metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/analysis/metric_expectations.h"
#include "src/analysis/peaks.h"
#include "trackbed/control/steering_controller.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/core/text_table.h"
#include "trackbed/planning/common/plan.h"

namespace trackbed {
namespace {

/// Over which accelerations and rates are averaged [s].
constexpr double kWindow = 0.1;

TrackingMetrics MeasureTracking(const RunLog& log, const Pose2& goal, double corridor) {
  TrackingMetrics metrics{.corridor = corridor};
  double cross_track_squares = 0.0;
  double heading_squares = 0.0;
  double rows = 0.0;
  for (const LogRow& row : log.rows) {
    if (log.contact_time && row.state.time > *log.contact_time && rows > 0.0) {
      break;  // where an obstacle pushes it says nothing of how it was steered
    }
    rows += 1.0;
    const Projection& at = *row.tracking;
    cross_track_squares += at.cross_track * at.cross_track;
    heading_squares += at.heading_error * at.heading_error;
    if (std::abs(at.cross_track) > metrics.cross_track_max) {
      metrics.cross_track_max = std::abs(at.cross_track);
      metrics.cross_track_max_s = at.s;
      metrics.cross_track_max_t = row.state.time;
    }
    if (std::abs(at.heading_error) > metrics.heading_error_max) {
      metrics.heading_error_max = std::abs(at.heading_error);
      metrics.heading_error_max_s = at.s;
      metrics.heading_error_max_t = row.state.time;
    }
  }
  metrics.cross_track_rms = std::sqrt(cross_track_squares / rows);
  metrics.heading_error_rms = std::sqrt(heading_squares / rows);
  const LogRow& last = log.rows.back();
  metrics.cross_track_final = last.tracking->cross_track;
  metrics.goal_distance = (last.state.pose.position() - goal.position()).norm();
  metrics.goal_heading_error = AngleDifference(last.state.pose.yaw, goal.yaw);
  return metrics;
}

ClearanceMetrics MeasureClearance(const RunLog& log) {
  ClearanceMetrics metrics;
  metrics.min = std::numeric_limits<double>::infinity();
  for (const LogRow& row : log.rows) {
    if (*row.clearance < metrics.min) {
      metrics.min = *row.clearance;
      metrics.min_s = StationOf(row);
      metrics.min_t = row.state.time;
    }
    if (row.state.obstacle_force > metrics.force_max) {
      metrics.force_max = row.state.obstacle_force;
      metrics.force_max_s = StationOf(row);
      metrics.force_max_t = row.state.time;
    }
  }
  metrics.collision = log.contact_time.has_value();
  if (log.contact_time) {
    metrics.min_t = *log.contact_time;  // between two rows
  }
  return metrics;
}

/// Root mean square of the measured steering's mean rate in each control period.
double SteeringRateRms(const RunLog& log, double control_period) {
  double squares = 0.0;
  for (std::size_t i = 1; i < log.rows.size(); ++i) {
    const double change = log.rows[i].state.steering - log.rows[i - 1].state.steering;
    squares += change * change;
  }
  const auto periods = static_cast<double>(std::max<std::size_t>(log.rows.size(), 2) - 1);
  return std::sqrt(squares / periods) / control_period;
}

/// Share of the control periods at whose end the actuator had not reached what was asked.
double SaturatedFraction(const RunLog& log) {
  // A microradian: less than any command matters, more than rounding in the actuator.
  constexpr double kReached = 1e-6;
  std::size_t saturated = 0;
  for (std::size_t i = 0; i + 1 < log.rows.size(); ++i) {
    const double asked = log.rows[i].command.steering;
    saturated += std::abs(asked - log.rows[i + 1].state.steering_actuator) > kReached ? 1U : 0U;
  }
  return log.rows.size() < 2
             ? 0.0
             : static_cast<double>(saturated) / static_cast<double>(log.rows.size() - 1);
}

std::optional<double> YawRateRatio(const RunLog& log, double wheelbase) {
  double products = 0.0;
  double squares = 0.0;
  for (const LogRow& row : log.rows) {
    const double kinematic = row.state.speed * std::tan(row.state.steering) / wheelbase;
    products += row.state.yaw_rate * kinematic;
    squares += kinematic * kinematic;
  }
  const bool turned = squares > 1e-6 * static_cast<double>(log.rows.size());
  return turned ? std::optional(products / squares) : std::nullopt;
}

std::vector<TurnMetrics> MeasureTurns(const RunLog& log, const Plan& plan,
                                      const VehicleParams& vehicle, StationSource source) {
  std::vector<TurnMetrics> turns;
  const Trace trace = TraceOf(log, source);
  // Wheels that are moved by forces follow their actuator late; prescribed ones do not.
  const double lag = log.rows.front().state.wheels ? vehicle.steering_lag : 0.0;
  // Beyond a change of plan, stations are those of another path.
  const double until =
      log.changes.empty() ? std::numeric_limits<double>::infinity() : log.changes.front().station;
  for (const LoneTurn& turn : plan.turns) {
    if (trace.station.size() > 2 && turn.middle <= until && trace.station.front() <= turn.from &&
        turn.middle <= trace.station.back()) {
      const Path& path = plan.reference.path;
      turns.push_back({turn.waypoint, PredictTurn(vehicle, path, turn, lag),
                       ErrorInTurn(path, turn, trace.PoseAt(turn.from), trace.PoseAt(turn.middle)),
                       turn.middle, trace.TimeAt(turn.middle)});
    }
  }
  return turns;
}

void JudgeClearance(const PlantExpectation& expect, const PlantMetrics& metrics, Verdict& verdict) {
  const ClearanceMetrics& clearance = *metrics.clearance;
  const std::string where =
      fmt::format(" at s = {:.4g} m, t = {:.4g} s", clearance.min_s, clearance.min_t);
  if (expect.min_clearance && !(clearance.min >= *expect.min_clearance)) {
    const auto [expected, actual] = TextsApart(*expect.min_clearance, clearance.min);
    verdict.failures.push_back(fmt::format("{}: clearance expected at least {} m, was {} m{}",
                                           metrics.plant, expected, actual, where));
  }
  if (expect.collision && *expect.collision != clearance.collision) {
    verdict.failures.push_back(
        clearance.collision
            ? fmt::format("{}: expected no collision, but hit an obstacle{}", metrics.plant, where)
            : fmt::format("{}: expected a collision, but stayed {:.4g} m clear{}", metrics.plant,
                          clearance.min, where));
  }
}

bool HasExpectationOf(std::string_view metric, const PlantExpectation& expect) {
  return std::any_of(expect.metrics.begin(), expect.metrics.end(),
                     [&](const MetricExpectation& own) { return own.metric == metric; });
}

/// Whether the scenario says how the plant's drive is to end; then its expectations judge that.
bool ExpectsItsEnd(const Expectations& expect, const PlantMetrics& metrics) {
  bool collision = expect.all.collision.value_or(false);
  bool status = HasExpectationOf("status", expect.all);
  for (const auto& [name, own] : expect.plants) {
    if (name == metrics.plant) {
      collision = own.collision.value_or(collision);
      status = status || HasExpectationOf("status", own);
    }
  }
  return status || (collision && metrics.status == DriveStatus::kCollided);
}

/// Why a plan ended before the goal, as an addition to what is said of its drive.
std::string WhyNotAtGoal(const PlantMetrics& metrics) {
  return !metrics.blocked.empty()   ? fmt::format(" (it {})", metrics.blocked)
         : !metrics.partial.empty() ? fmt::format(" (the plan {})", metrics.partial)
                                    : "";
}

/// The measured wheels may swing past their actuator by this share of its rate.
constexpr double kWheelCompliance = 0.03;

/// Wheels whose angle is prescribed turn beyond what the car can, which is to be known.
void NotePrescribedSteering(const PlantMetrics& metrics, Verdict& verdict) {
  const auto note = [&](const char* what, double was, double limit, const char* unit) {
    if (limit > 0.0 && was > (1.0 + kWheelCompliance) * limit) {
      verdict.notes.push_back(fmt::format(
          "{}: the prescribed steering {} {:.4g} {}, beyond the car's limit of {:.4g} {}",
          metrics.plant, what, was, unit, limit, unit));
    }
  };
  note("reached an angle of", metrics.steering_max, metrics.steering_limit, "rad");
  note("turned at", metrics.steering_rate_max, metrics.steering_rate_limit, "rad/s");
}

void JudgeSteeringRate(const PlantMetrics& metrics, Verdict& verdict) {
  const double limit = metrics.steering_rate_limit;
  if (metrics.steering_is_prescribed) {
    NotePrescribedSteering(metrics, verdict);
  } else if (limit > 0.0 && metrics.steering_rate_max > (1.0 + kWheelCompliance) * limit) {
    verdict.failures.push_back(fmt::format(
        "{}: the wheels turned at {:.4g} rad/s, and the car's actuator at {:.4g} rad/s at most, at "
        "s = {:.4g} m, t = {:.4g} s; drive.timestep is too long for this car",
        metrics.plant, metrics.steering_rate_max, limit, metrics.steering_rate_max_s,
        metrics.steering_rate_max_t));
  }
}

/// Whether the scenario itself says how far from its path the plant may be.
bool AsksCrossTrack(const Expectations& expect, const std::string& plant) {
  return expect.all.max_cross_track ||
         std::any_of(expect.plants.begin(), expect.plants.end(), [&](const auto& own) {
           return own.first == plant && own.second.max_cross_track;
         });
}

void JudgeCorridor(const PlantMetrics& metrics, Verdict& verdict) {
  const TrackingMetrics& tracking = *metrics.tracking;
  if (tracking.corridor > 0.0 && !(tracking.cross_track_max <= tracking.corridor)) {
    const auto [expected, was] = TextsApart(tracking.corridor, tracking.cross_track_max);
    verdict.failures.push_back(fmt::format(
        "{}: left its path: cross-track maximum {} m, more than the car's width of {} m, at s = "
        "{:.4g} m, t = {:.4g} s (expect.max_cross_track sets another bound)",
        metrics.plant, was, expected, tracking.cross_track_max_s, tracking.cross_track_max_t));
  }
}

bool AsksAnything(const PlantExpectation& expect) {
  return expect.reach_goal || expect.max_cross_track || expect.rms_cross_track ||
         expect.max_heading_error || expect.min_clearance || expect.collision ||
         !expect.metrics.empty();
}

bool AsksAnything(const Expectations& expect) {
  return AsksAnything(expect.all) || !expect.between.empty() ||
         std::any_of(expect.plants.begin(), expect.plants.end(),
                     [](const auto& own) { return AsksAnything(own.second); });
}

void NoteLimitedSteering(const PlantMetrics& metrics, Verdict& verdict) {
  constexpr double kNoticed = 0.02;
  if (metrics.manoeuvre && metrics.manoeuvre->steering_saturated_fraction > kNoticed) {
    verdict.notes.push_back(fmt::format("{}: steering limited ({:.0f} % of the time)",
                                        metrics.plant,
                                        100.0 * metrics.manoeuvre->steering_saturated_fraction));
  }
}

void JudgePlant(const PlantExpectation& expect, const PlantMetrics& metrics, Verdict& verdict) {
  if (metrics.clearance) {
    JudgeClearance(expect, metrics, verdict);
  }
  JudgeMetrics(expect.metrics, metrics, verdict);
  if (!metrics.tracking) {
    return;
  }
  const TrackingMetrics& tracking = *metrics.tracking;
  const auto bound = [&](const std::optional<double>& limit, double actual, const char* key,
                         const char* unit, const std::string& where) {
    if (limit && !(actual <= *limit)) {
      const auto [expected, was] = TextsApart(*limit, actual);
      verdict.failures.push_back(fmt::format("{}: {} expected at most {} {}, was {} {}{}",
                                             metrics.plant, key, expected, unit, was, unit, where));
    }
  };
  const auto at = [](double s, double t) {
    return fmt::format(" at s = {:.4g} m, t = {:.4g} s", s, t);
  };
  bound(expect.reach_goal, tracking.goal_distance, "distance to the goal", "m",
        fmt::format(" at the end, s = {:.4g} m, t = {:.4g} s", metrics.end_s, metrics.time));
  bound(expect.max_cross_track, tracking.cross_track_max, "cross-track maximum", "m",
        at(tracking.cross_track_max_s, tracking.cross_track_max_t));
  bound(expect.rms_cross_track, tracking.cross_track_rms, "cross-track rms", "m",
        OverTheDrive(metrics));
  bound(expect.max_heading_error, tracking.heading_error_max, "heading error maximum", "rad",
        at(tracking.heading_error_max_s, tracking.heading_error_max_t));
}

void JudgeBetween(const BetweenExpectation& between,
                  const std::vector<PlantComparison>& comparisons, Verdict& verdict) {
  const std::string& first = between.plants[0];
  const std::string& second = between.plants[1];
  const auto found =
      std::find_if(comparisons.begin(), comparisons.end(), [&](const PlantComparison& c) {
        return (c.first == first && c.second == second) || (c.first == second && c.second == first);
      });
  const std::vector<std::string> failures =
      found != comparisons.end()
          ? Exceeded(between.bounds, *found)
          : std::vector{fmt::format("{} and {}: expected to be compared, but were not both driven",
                                    first, second)};
  verdict.failures.insert(verdict.failures.end(), failures.begin(), failures.end());
}

}  // namespace

PlantMetrics Measure(const RunLog& log, const Plan& plan, const VehicleParams& vehicle,
                     double control_period, StationSource source) {
  TRACKBED_CHECK(!log.rows.empty(), "the log of {} is empty", log.plant);
  PlantMetrics metrics;
  metrics.plant = log.plant;
  metrics.status = log.status;
  metrics.distance = log.rows.back().state.distance;
  metrics.time = log.rows.back().state.time;
  metrics.end_s = StationOf(log.rows.back());
  const auto window = static_cast<std::size_t>(std::max(1.0, std::round(kWindow / control_period)));
  MeasureLateralAcceleration(log, window, metrics);
  MeasureSteering(log, window, metrics);
  metrics.steering_rate_limit = vehicle.steering_rate;
  metrics.steering_limit = vehicle.steering_limit;
  metrics.steering_rate_rms = SteeringRateRms(log, control_period);
  metrics.steering_saturated_fraction = SaturatedFraction(log);
  metrics.yaw_rate_ratio = YawRateRatio(log, vehicle.wheelbase);
  if (log.rows.front().tracking) {
    metrics.tracking = MeasureTracking(log, plan.goal, vehicle.width);
  }
  if (log.rows.front().clearance) {
    metrics.clearance = MeasureClearance(log);
  }
  metrics.plan_changes = static_cast<int>(log.changes.size());
  metrics.blocked = (log.changes.empty() ? plan : log.changes.back().plan).blocked;
  metrics.partial = plan.partial;
  metrics.turns = MeasureTurns(log, plan, vehicle, source);
  return metrics;
}

Verdict Judge(const Expectations& expect, const std::vector<PlantMetrics>& plants,
              const std::vector<PlantComparison>& comparisons) {
  Verdict verdict;
  verdict.judged = AsksAnything(expect);
  for (const PlantMetrics& metrics : plants) {
    verdict.judged = verdict.judged || metrics.tracking || metrics.clearance;
    if (metrics.status != DriveStatus::kArrived && !ExpectsItsEnd(expect, metrics)) {
      verdict.failures.push_back(fmt::format(
          "{}: expected to arrive, ended as {} at s = {:.4g} m, t = {:.4g} s{}", metrics.plant,
          ToString(metrics.status), metrics.end_s, metrics.time, WhyNotAtGoal(metrics)));
    } else if (!metrics.partial.empty()) {
      verdict.notes.push_back(fmt::format("{}: the plan {}", metrics.plant, metrics.partial));
    }
    JudgeSteeringRate(metrics, verdict);
    if (metrics.tracking && !AsksCrossTrack(expect, metrics.plant)) {
      JudgeCorridor(metrics, verdict);
    }
    NoteLimitedSteering(metrics, verdict);
    JudgePlant(expect.all, metrics, verdict);
    for (const auto& [plant, own] : expect.plants) {
      if (plant == metrics.plant) {
        JudgePlant(own, metrics, verdict);
      }
    }
  }
  for (const BetweenExpectation& between : expect.between) {
    JudgeBetween(between, comparisons, verdict);
  }
  verdict.judged = verdict.judged || !verdict.failures.empty();
  verdict.passed = verdict.judged && verdict.failures.empty();
  return verdict;
}

nlohmann::ordered_json ToJson(const PlantMetrics& metrics) {
  nlohmann::ordered_json json{
      {"status", ToString(metrics.status)}, {"distance", metrics.distance}, {"time", metrics.time}};
  if (metrics.tracking) {
    const TrackingMetrics& tracking = *metrics.tracking;
    json["cross_track"] = {{"rms", tracking.cross_track_rms},
                           {"max", tracking.cross_track_max},
                           {"max_s", tracking.cross_track_max_s},
                           {"max_t", tracking.cross_track_max_t},
                           {"final", tracking.cross_track_final}};
    json["heading_error"] = {{"rms", tracking.heading_error_rms},
                             {"max", tracking.heading_error_max},
                             {"max_s", tracking.heading_error_max_s},
                             {"max_t", tracking.heading_error_max_t}};
    json["goal_distance"] = tracking.goal_distance;
    json["goal_heading_error"] = tracking.goal_heading_error;
  }
  if (metrics.clearance) {
    json["clearance_min"] = metrics.clearance->min;
    json["clearance_min_s"] = metrics.clearance->min_s;
    json["clearance_min_t"] = metrics.clearance->min_t;
    json["collision"] = metrics.clearance->collision;
    json["obstacle_force_max"] = metrics.clearance->force_max;
  }
  if (metrics.recovery) {
    json["recovery_time"] = metrics.recovery->time ? nlohmann::ordered_json(*metrics.recovery->time)
                                                   : nlohmann::ordered_json(nullptr);
  }
  json["plan_changes"] = metrics.plan_changes;
  if (!metrics.blocked.empty()) {
    json["blocked"] = metrics.blocked;
  }
  if (!metrics.partial.empty()) {
    json["partial"] = metrics.partial;
  }
  json["lateral_acceleration_max"] = metrics.lateral_acceleration_max;
  json["lateral_acceleration_max_s"] = metrics.lateral_acceleration_max_s;
  json["lateral_acceleration_max_t"] = metrics.lateral_acceleration_max_t;
  json["steering_max"] = metrics.steering_max;
  json["steering_rate_max"] = metrics.steering_rate_max;
  json["steering_rate_max_s"] = metrics.steering_rate_max_s;
  json["steering_rate_max_t"] = metrics.steering_rate_max_t;
  json["steering_rate_rms"] = metrics.steering_rate_rms;
  json["steering_saturated_fraction"] = metrics.steering_saturated_fraction;
  if (metrics.yaw_rate_ratio) {
    json["yaw_rate_ratio"] = *metrics.yaw_rate_ratio;
  }
  if (metrics.manoeuvre) {
    json["manoeuvre"] = ToJson(*metrics.manoeuvre);
  }
  for (const TurnMetrics& turn : metrics.turns) {
    json["turns"].push_back({{"waypoint", turn.waypoint},
                             {"heading_deficit_predicted", turn.predicted.heading_deficit},
                             {"heading_deficit", turn.measured.heading_deficit},
                             {"lateral_offset_predicted", turn.predicted.lateral_offset},
                             {"lateral_offset", turn.measured.lateral_offset}});
  }
  return json;
}

nlohmann::ordered_json ToJson(const Verdict& verdict) {
  return {{"passed", verdict.judged ? nlohmann::ordered_json(verdict.passed)
                                    : nlohmann::ordered_json(nullptr)},
          {"failures", verdict.failures},
          {"notes", verdict.notes}};
}

}  // namespace trackbed
