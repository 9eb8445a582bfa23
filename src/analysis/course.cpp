#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "src/analysis/evaluations.h"
#include "src/analysis/log_reading.h"

namespace trackbed {
namespace {

/// Reference course: the circle or straight line along which the rear axle moves at a given log
/// row, extended beyond that row.
class ConstantCurvatureCourse {
 public:
  ConstantCurvatureCourse(const VehicleParams& vehicle, const VehicleState& state, double length)
      : start_yaw_(state.pose.yaw), curvature_(MeasuredCurvature(state)) {
    // The rear axle may slip sideways, so the reference course starts in the axle's direction of
    // motion, not in the car's heading.
    const double lateral = state.lateral_speed - state.yaw_rate * vehicle.cg_to_rear;
    const double course = state.pose.yaw + std::atan2(lateral, state.speed);
    path_ = Path({state.pose.x, state.pose.y, course}, {{length, curvature_}});
  }

  /// Projects the car's pose onto the reference course. The returned heading error is the change of
  /// the car's heading since the start of the reference course, minus the change of the course's
  /// heading.
  [[nodiscard]] Projection At(const VehicleState& state) {
    // Maximum distance that the car drives between two log rows [m].
    constexpr double kMaxRowDistance = 5.0;
    Projection at =
        path_.Project(state.pose, {station_ - kMaxRowDistance, station_ + kMaxRowDistance});
    station_ = at.s;
    at.heading_error = state.pose.yaw - start_yaw_ - curvature_ * at.s;
    return at;
  }

  /// Returns the yaw rate of a car that follows the reference course [rad/s].
  [[nodiscard]] double YawRate(const VehicleState& state) const { return curvature_ * state.speed; }

 private:
  static double MeasuredCurvature(const VehicleState& state) {
    constexpr double kMinSpeed = 0.1;  // [m/s]
    return std::abs(state.speed) < kMinSpeed ? 0.0 : state.yaw_rate / state.speed;
  }

  Path path_;
  double start_yaw_;
  double curvature_;
  double station_ = 0.0;
};

/// Largest lateral and heading deviations of the car from the reference course so far.
struct Departure {
  double lateral = 0.0;
  double heading = 0.0;

  void Take(const Projection& at) {
    lateral = std::max(lateral, std::abs(at.cross_track));
    heading = std::max(heading, std::abs(at.heading_error));
  }
};

/// Returns the speed of the center of gravity, whatever its direction [m/s].
double TotalSpeed(const LogRow& row) {
  return std::hypot(row.state.speed, row.state.lateral_speed);
}

/// Returns the length of the path of the center of gravity up to each row [m]. The path of the
/// center of gravity is assumed to be straight between log rows.
std::vector<double> DrivenOf(const RunLog& log, const VehicleParams& vehicle) {
  const auto center = [&](const LogRow& row) {
    return ToWorld(row.state.pose, {vehicle.cg_to_rear, 0.0});
  };
  std::vector<double> driven(log.rows.size());
  for (std::size_t i = 1; i < driven.size(); ++i) {
    driven[i] = driven[i - 1] + (center(log.rows[i]) - center(log.rows[i - 1])).norm();
  }
  return driven;
}

}  // namespace

std::vector<ManeuverMetric> MethodMetrics(const BrakingTestOptions& /*options*/) {
  return {{"initial_speed", "initial speed", "m/s"},
          {"distance", "braking distance", "m", true},
          {"mean_fully_developed_deceleration", "mean fully developed deceleration", "m/s^2"},
          {"yaw_rate_max", "maximum yaw rate", "rad/s"},
          {"heading_deviation_max", "maximum heading deviation", "rad"},
          {"lateral_deviation_max", "maximum lateral deviation", "m"}};
}

void Evaluate(const BrakingTestOptions& options, const ManeuverInput& input,
              ManeuverMetrics& metrics) {
  // Commanded deceleration from which the car counts as braking; a car that holds its speed brakes
  // less [m/s^2].
  constexpr double kBraking = 0.5;
  // Speed below which the car is treated as standing [m/s]; from this speed, the car stops within a
  // millimeter.
  constexpr double kStandstill = 0.05;
  const auto& rows = input.log.rows;
  std::size_t onset = 0;
  while (onset < rows.size() && rows[onset].command.acceleration > -kBraking) {
    ++onset;
  }
  if (onset == rows.size()) {
    metrics.missing = "the car does not brake";
    return;
  }
  const VehicleState& start = rows[onset].state;
  metrics.begin = start.time;
  const double initial_speed = TotalSpeed(rows[onset]);
  metrics.values.emplace_back("initial_speed", initial_speed);
  // The minimum search uses the total speed, because the forward speed of a spinning car is zero
  // while the car slides sideways.
  const auto slowness = [](const LogRow& row) { return -TotalSpeed(row); };
  const std::vector<double> driven = DrivenOf(input.log, input.vehicle);
  const auto driven_at = [&](const LogRow& row) {
    return driven[static_cast<std::size_t>(&row - rows.data())];
  };
  const auto distance_at = [&](double speed) -> std::optional<double> {
    const auto time = TimeOfReaching(input.log, onset, -speed, slowness);
    return time ? std::optional(ValueAt(input.log, *time, driven_at) - driven[onset])
                : std::nullopt;
  };
  const double end_speed = std::max(options.to_speed, kStandstill);
  const std::optional<double> end = TimeOfReaching(input.log, onset, -end_speed, slowness);
  if (end) {
    metrics.end = *end;
    metrics.values.emplace_back("distance", *distance_at(end_speed));
  } else {
    metrics.missing = fmt::format("the speed does not drop to {:.3g} m/s", options.to_speed);
  }
  const double v_b = 0.8 * initial_speed;
  const double v_e = 0.1 * initial_speed;
  if (const auto s_e = distance_at(v_e)) {
    metrics.values.emplace_back("mean_fully_developed_deceleration",
                                (v_b * v_b - v_e * v_e) / (2.0 * (*s_e - *distance_at(v_b))));
  }
  ConstantCurvatureCourse course(input.vehicle, start,
                                 rows.back().state.distance - start.distance + 1.0);
  Departure departure;
  double yaw_rate = 0.0;
  for (std::size_t i = onset; i < rows.size() && rows[i].state.time <= metrics.end; ++i) {
    departure.Take(course.At(rows[i].state));
    yaw_rate = std::max(yaw_rate, std::abs(rows[i].state.yaw_rate));
  }
  metrics.values.emplace_back("yaw_rate_max", yaw_rate);
  metrics.values.emplace_back("heading_deviation_max", departure.heading);
  metrics.values.emplace_back("lateral_deviation_max", departure.lateral);
}

std::vector<ManeuverMetric> MethodMetrics(const DisturbanceOptions& /*options*/) {
  return {{"lateral_deviation_max", "maximum lateral deviation", "m"},
          {"heading_deviation_max", "maximum heading deviation", "rad"},
          {"yaw_rate_deviation_max", "maximum yaw rate deviation", "rad/s"},
          {"recovery_time", "yaw rate recovery time", "s", true}};
}

void Evaluate(const DisturbanceOptions& options, const ManeuverInput& input,
              ManeuverMetrics& metrics) {
  const auto& rows = input.log.rows;
  std::size_t from = 0;
  while (from < rows.size() && rows[from].state.time < options.at - 1e-9) {
    ++from;
  }
  if (from == rows.size()) {
    metrics.missing = fmt::format("the run ends before {} s", options.at);
    return;
  }
  metrics.begin = rows[from].state.time;
  ConstantCurvatureCourse course(input.vehicle, rows[from].state,
                                 rows.back().state.distance - rows[from].state.distance + 1.0);
  const bool straight = !rows.front().tracking;
  Departure departure;
  double yaw_rate = 0.0;
  // Time at which the deviation of the yaw rate exceeds its bound for the first time [s].
  std::optional<double> left;
  // Time at which the yaw rate deviation falls below its bound for the last time [s].
  double back = 0.0;
  for (std::size_t i = from; i < rows.size(); ++i) {
    const VehicleState& state = rows[i].state;
    departure.Take(straight ? course.At(state) : *rows[i].tracking);
    const double expected =
        straight ? course.YawRate(state)
                 : input.plan.reference.path.At(rows[i].tracking->s).curvature * state.speed;
    const double deviation = std::abs(state.yaw_rate - expected);
    yaw_rate = std::max(yaw_rate, deviation);
    if (deviation > options.yaw_rate_bound) {
      left = left.value_or(state.time);
      back = i + 1 < rows.size() ? rows[i + 1].state.time : std::numeric_limits<double>::infinity();
    }
  }
  metrics.values.emplace_back("lateral_deviation_max", departure.lateral);
  metrics.values.emplace_back("heading_deviation_max", departure.heading);
  metrics.values.emplace_back("yaw_rate_deviation_max", yaw_rate);
  if (left && !std::isfinite(back)) {
    metrics.missing = "the yaw rate does not return below its bound";
  } else {
    metrics.values.emplace_back("recovery_time", left ? back - *left : 0.0);
  }
}

}  // namespace trackbed
