#include <algorithm>
#include <cmath>
#include <string>

#include "src/analysis/evaluations.h"
#include "src/analysis/log_reading.h"
#include "trackbed/core/angle.h"

namespace trackbed {
namespace {

// Limits of the standards ISO 19365 and FMVSS 126 for the maneuver sine with dwell: two yaw rate
// ratios, and the lateral displacement in meters.
constexpr StandardLimit kEarlyRatio{StandardLimit::Relation::kAtMost, 0.35};
constexpr StandardLimit kLateRatio{StandardLimit::Relation::kAtMost, 0.20};
constexpr StandardLimit kDisplacement{StandardLimit::Relation::kAtLeast, 1.83};

/// Road wheel angle below which the wheels count as pointing straight ahead [rad].
constexpr double kNoSteering = 1e-4;

double YawRate(const LogRow& row) {
  return row.state.yaw_rate;
}
double LateralAcceleration(const LogRow& row) {
  return row.state.lateral_acceleration;
}

/// Returns the mean of a quantity over the last `duration` seconds of the run.
template <typename Of>
double MeanAtEnd(const RunLog& log, double duration, const Of& of) {
  const double from = log.rows.back().state.time - duration - 1e-9;
  double sum = 0.0;
  double count = 0.0;
  for (const LogRow& row : log.rows) {
    if (row.state.time >= from) {
      sum += of(row);
      count += 1.0;
    }
  }
  return sum / count;
}

/// Time and size of a steering step.
struct Step {
  std::size_t row = 0;  ///< First log row in which the actuator moves.
  /// Time at which the steering angle has changed by half of the step [s].
  double half_time = 0.0;
  /// Difference between the steady road wheel angle after the step and the angle before the step
  /// [rad].
  double steering = 0.0;
};

std::optional<Step> FindStep(const RunLog& log, double steady) {
  const double start = log.rows.front().state.steering_actuator;
  const double change =
      MeanAtEnd(log, steady, [](const LogRow& row) { return row.state.steering_actuator; }) - start;
  if (std::abs(change) < kNoSteering) {
    return std::nullopt;
  }
  const double side = std::copysign(1.0, change);
  const auto moved = [=](const LogRow& row) {
    return side * (row.state.steering_actuator - start);
  };
  Step step;
  while (moved(log.rows[step.row + 1]) < 1e-9) {
    ++step.row;
  }
  step.half_time = *TimeOfReaching(log, 0, 0.5 * std::abs(change), moved);
  const auto steering = [](const LogRow& row) { return row.state.steering; };
  step.steering = MeanAtEnd(log, steady, steering) - steering(log.rows[step.row]);
  return step;
}

/// Adds the response time, peak time, overshoot and steady value of a quantity to the metrics. The
/// keys of the added metrics begin with `name`.
template <typename Of>
double EvaluateResponse(const RunLog& log, const Step& step, double steady_time,
                        const std::string& name, const Of& of, ManeuverMetrics& metrics) {
  const double start = of(log.rows[step.row]);
  const double steady = MeanAtEnd(log, steady_time, of) - start;
  const double side = std::copysign(1.0, steady);
  const auto response = [&](const LogRow& row) { return side * (of(row) - start); };
  std::size_t peak = step.row;
  for (std::size_t i = step.row; i < log.rows.size(); ++i) {
    peak = response(log.rows[i]) > response(log.rows[peak]) ? i : peak;
  }
  metrics.values.emplace_back(name + "_steady", steady);
  const auto reached = TimeOfReaching(log, step.row, 0.9 * std::abs(steady), response);
  if (reached) {
    metrics.values.emplace_back(name + "_response_time", *reached - step.half_time);
  }
  metrics.values.emplace_back(name + "_peak_time", log.rows[peak].state.time - step.half_time);
  if (steady != 0.0) {
    metrics.values.emplace_back(name + "_overshoot",
                                response(log.rows[peak]) / std::abs(steady) - 1.0);
  }
  return steady;
}

}  // namespace

std::vector<ManeuverMetric> MethodMetrics(const StepSteerOptions& /*options*/) {
  return {{"speed", "initial speed", "m/s"},
          {"yaw_rate_steady", "steady yaw rate", "rad/s"},
          {"yaw_rate_response_time", "yaw rate response time", "s", true},
          {"yaw_rate_peak_time", "yaw rate peak time", "s"},
          {"yaw_rate_overshoot", "yaw rate overshoot", ""},
          {"yaw_rate_gain", "yaw rate gain", "1/s"},
          {"lateral_acceleration_steady", "steady lateral acceleration", "m/s^2"},
          {"lateral_acceleration_response_time", "lateral acceleration response time", "s"},
          {"lateral_acceleration_peak_time", "lateral acceleration peak time", "s"},
          {"lateral_acceleration_overshoot", "lateral acceleration overshoot", ""},
          {"sideslip_steady", "steady sideslip angle", "rad"},
          {"tb", "TB value", "s rad"}};
}

void Evaluate(const StepSteerOptions& options, const ManeuverInput& input,
              ManeuverMetrics& metrics) {
  const RunLog& log = input.log;
  const std::optional<Step> step = FindStep(log, options.steady);
  if (!step) {
    metrics.missing = "the steering angle does not change";
    return;
  }
  metrics.begin = log.rows[step->row].state.time;
  metrics.values.emplace_back("speed", log.rows[step->row].state.speed);
  const double yaw_rate =
      EvaluateResponse(log, *step, options.steady, "yaw_rate", YawRate, metrics);
  metrics.values.emplace_back("yaw_rate_gain", yaw_rate / step->steering);
  EvaluateResponse(log, *step, options.steady, "lateral_acceleration", LateralAcceleration,
                   metrics);
  const auto sideslip_of = [](const LogRow& row) { return row.state.sideslip; };
  const double sideslip =
      MeanAtEnd(log, options.steady, sideslip_of) - sideslip_of(log.rows[step->row]);
  metrics.values.emplace_back("sideslip_steady", sideslip);
  metrics.values.emplace_back("tb", *metrics.Find("yaw_rate_peak_time") * std::abs(sideslip));
}

std::vector<ManeuverMetric> MethodMetrics(const SineWithDwellTestOptions& /*options*/) {
  return {{"speed", "initial speed", "m/s"},
          {"lateral_displacement", "lateral displacement", "m", true, kDisplacement},
          {"yaw_rate_peak", "peak yaw rate", "rad/s"},
          {"yaw_rate_ratio_1_00", "yaw rate ratio after 1.00 s", "", true, kEarlyRatio},
          {"yaw_rate_ratio_1_75", "yaw rate ratio after 1.75 s", "", true, kLateRatio}};
}

void Evaluate(const SineWithDwellTestOptions&, const ManeuverInput& input,
              ManeuverMetrics& metrics) {
  const auto& rows = input.log.rows;
  // The maneuver begins when the steering wheel angle exceeds 5 degrees. If the steering ratio of
  // the car is unknown, assume a ratio of 20.
  const double ratio = input.vehicle.steering_ratio > 0.0 ? input.vehicle.steering_ratio : 20.0;
  const double begins = 5.0 * kPi / 180.0 / ratio;
  const auto steering = [&](std::size_t i) { return rows[i].state.steering_actuator; };
  std::size_t first = 0;
  while (first < rows.size() && std::abs(steering(first)) < begins) {
    ++first;
  }
  if (first == rows.size()) {
    metrics.missing = "the steering input does not start";
    return;
  }
  const double side = std::copysign(1.0, steering(first));
  const double begin = *TimeOfReaching(
      input.log, 0, begins, [=](const LogRow& row) { return side * row.state.steering_actuator; });
  metrics.begin = begin;
  std::size_t reversal = first;
  while (reversal < rows.size() && side * steering(reversal) > 0.0) {
    ++reversal;
  }
  // Index of the log row in which the steering angle returns to zero for the last time.
  std::size_t complete = rows.size();
  while (complete > reversal && std::abs(steering(complete - 1)) < kNoSteering) {
    --complete;
  }
  if (reversal == rows.size() || complete == rows.size()) {
    metrics.missing = "the steering input is not reversed and returned to zero";
    return;
  }
  const double completion = rows[complete].state.time;

  // Compute the lateral displacement relative to the initial heading, positive in the direction of
  // the first half of the sine.
  const Pose2& start = rows[first].state.pose;
  const double to_cg = input.vehicle.cg_to_rear;
  const auto across = [&](const LogRow& row) {
    const Pose2& pose = row.state.pose;
    const Vec2 cg = pose.position() + to_cg * Vec2(std::cos(pose.yaw), std::sin(pose.yaw));
    return side * (-std::sin(start.yaw) * cg.x() + std::cos(start.yaw) * cg.y());
  };
  const double displacement =
      ValueAt(input.log, begin + 1.07, across) - ValueAt(input.log, begin, across);
  double peak = 0.0;
  for (std::size_t i = reversal; i < rows.size(); ++i) {
    peak = std::max(peak, -side * rows[i].state.yaw_rate);
  }
  metrics.values.emplace_back("speed", rows[first].state.speed);
  metrics.values.emplace_back("lateral_displacement", displacement);
  metrics.values.emplace_back("yaw_rate_peak", peak);
  if (rows.back().state.time < completion + 1.75 - 1e-9 || peak <= 0.0) {
    metrics.missing = "the run ends less than 1.75 s after the completion of steering";
    metrics.passed = false;
    return;
  }
  const auto ratio_after = [&](double time) {
    return -side * ValueAt(input.log, completion + time, YawRate) / peak;
  };
  const double early = ratio_after(1.00);
  const double late = ratio_after(1.75);
  metrics.values.emplace_back("yaw_rate_ratio_1_00", early);
  metrics.values.emplace_back("yaw_rate_ratio_1_75", late);
  metrics.end = completion;
  metrics.passed =
      kEarlyRatio.Met(early) && kLateRatio.Met(late) && kDisplacement.Met(displacement);
}

}  // namespace trackbed
