#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "src/analysis/evaluations.h"

namespace trackbed {
namespace {

// Speed below which the ratio of yaw rate to speed is too inaccurate to use [m/s].
constexpr double kMinSteadySpeed = 1.0;
constexpr double kYawAcceleration = 0.05;  // Largest yaw acceleration of a quasi-steady state
                                           // [rad/s^2].
constexpr double kWindow = 0.5;  // Duration over which the yaw acceleration is averaged [s].

/// Sample of a quasi-steady state; samples of right turns are mirrored to left turns.
struct Sample {
  double steering = 0.0;
  double curvature = 0.0;
  double lateral_acceleration = 0.0;
  double yaw_rate = 0.0;
  double roll = 0.0;
  double sideslip = 0.0;
};

std::vector<Sample> QuasiSteady(const RunLog& log, double settle) {
  const auto& rows = log.rows;
  std::vector<Sample> samples;
  std::size_t before = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const VehicleState& state = rows[i].state;
    while (rows[before].state.time < state.time - kWindow - 1e-9) {
      ++before;
    }
    const VehicleState& earlier = rows[before].state;
    const double elapsed = state.time - earlier.time;
    if (elapsed < 0.9 * kWindow || earlier.time < rows.front().state.time + settle ||
        std::abs(state.speed) < kMinSteadySpeed ||
        std::abs(state.yaw_rate - earlier.yaw_rate) > kYawAcceleration * elapsed) {
      continue;
    }
    const double side = std::copysign(1.0, state.lateral_acceleration);
    const double speed = std::hypot(state.speed, state.lateral_speed);
    samples.push_back({side * state.steering, side * state.yaw_rate / speed,
                       side * state.lateral_acceleration, side * state.yaw_rate, side * state.roll,
                       side * state.sideslip});
  }
  return samples;
}

struct Line {
  double slope = 0.0;
  double offset = 0.0;
};

/// Fits the line y = offset + slope x by least squares.
template <typename Y>
Line Fit(const std::vector<Sample>& samples, const Y& y) {
  const auto n = static_cast<double>(samples.size());
  double mean_x = 0.0;
  double mean_y = 0.0;
  for (const Sample& sample : samples) {
    mean_x += sample.lateral_acceleration / n;
    mean_y += y(sample) / n;
  }
  double xx = 0.0;
  double xy = 0.0;
  for (const Sample& sample : samples) {
    const double x = sample.lateral_acceleration - mean_x;
    xx += x * x;
    xy += x * (y(sample) - mean_y);
  }
  return {xy / xx, mean_y - xy / xx * mean_x};
}

std::vector<Sample> Between(const std::vector<Sample>& samples, double from, double to) {
  std::vector<Sample> between;
  for (const Sample& sample : samples) {
    if (sample.lateral_acceleration >= from && sample.lateral_acceleration <= to) {
      between.push_back(sample);
    }
  }
  return between;
}

/// Returns the range of the samples' lateral accelerations: maximum minus minimum [m/s^2].
double Spread(const std::vector<Sample>& samples) {
  double low = samples.empty() ? 0.0 : samples.front().lateral_acceleration;
  double high = low;
  for (const Sample& sample : samples) {
    low = std::min(low, sample.lateral_acceleration);
    high = std::max(high, sample.lateral_acceleration);
  }
  return high - low;
}

void EvaluateGradients(const std::vector<Sample>& samples, double from, double to, double wheelbase,
                       ManeuverMetrics& metrics) {
  // Minimum range of the samples' lateral accelerations; with a smaller range, no gradient is
  // computed [m/s^2].
  constexpr double kMinSpread = 0.5;
  double highest = 0.0;
  for (const Sample& sample : samples) {
    highest = std::max(highest, sample.lateral_acceleration);
  }
  metrics.values.emplace_back("lateral_acceleration_max", highest);
  const std::vector<Sample> used = Between(samples, from, to);
  if (Spread(used) < kMinSpread) {
    metrics.missing =
        fmt::format("quasi-steady samples between {} and {} m/s^2 span less than {} m/s^2", from,
                    to, kMinSpread);
    return;
  }
  const double understeer =
      Fit(used, [=](const Sample& s) { return s.steering - wheelbase * s.curvature; }).slope;
  metrics.values.emplace_back("understeer_gradient", understeer);
  if (understeer > 0.0) {
    metrics.values.emplace_back("characteristic_speed", std::sqrt(wheelbase / understeer));
  } else if (understeer < 0.0) {
    metrics.values.emplace_back("critical_speed", std::sqrt(-wheelbase / understeer));
  }
  double squares = 0.0;
  double products = 0.0;
  for (const Sample& sample : used) {
    squares += sample.steering * sample.steering;
    products += sample.steering * sample.yaw_rate;
  }
  if (squares > 0.0) {
    metrics.values.emplace_back("yaw_rate_gain", products / squares);
  }
  metrics.values.emplace_back("roll_gradient",
                              Fit(used, [](const Sample& s) { return s.roll; }).slope);
  metrics.values.emplace_back("sideslip_gradient",
                              Fit(used, [](const Sample& s) { return s.sideslip; }).slope);
}

}  // namespace

std::vector<ManeuverMetric> MethodMetrics(const SteadyStateCircleOptions& /*options*/) {
  return {{"lateral_acceleration_max", "maximum quasi-steady lateral acceleration", "m/s^2"},
          {"understeer_gradient", "understeer gradient", "rad s^2/m", true},
          {"characteristic_speed", "characteristic speed", "m/s"},
          {"critical_speed", "critical speed", "m/s"},
          {"yaw_rate_gain", "yaw rate gain", "1/s"},
          {"roll_gradient", "roll gradient", "rad s^2/m"},
          {"sideslip_gradient", "sideslip gradient", "rad s^2/m"}};
}

std::vector<ManeuverMetric> MethodMetrics(const SlowlyIncreasingSteerOptions& /*options*/) {
  std::vector<ManeuverMetric> all = MethodMetrics(SteadyStateCircleOptions{});
  all.push_back({"steering_at_0_3_g", "steering angle at 0.3 g", "rad"});
  return all;
}

void Evaluate(const SteadyStateCircleOptions& options, const ManeuverInput& input,
              ManeuverMetrics& metrics) {
  EvaluateGradients(QuasiSteady(input.log, options.settle), options.fit_from, options.fit_to,
                    input.vehicle.wheelbase, metrics);
}

void Evaluate(const SlowlyIncreasingSteerOptions& options, const ManeuverInput& input,
              ManeuverMetrics& metrics) {
  const std::vector<Sample> samples = QuasiSteady(input.log, options.settle);
  EvaluateGradients(samples, options.fit_from, options.fit_to, input.vehicle.wheelbase, metrics);
  const std::vector<Sample> used = Between(samples, 0.1 * kGravity, 0.375 * kGravity);
  if (Spread(used) < 0.2 * kGravity) {
    metrics.missing += metrics.missing.empty() ? "" : "; ";
    metrics.missing += "0.3 g is not reached";
    return;
  }
  const Line line = Fit(used, [](const Sample& s) { return s.steering; });
  metrics.values.emplace_back("steering_at_0_3_g", line.offset + line.slope * 0.3 * kGravity);
}

}  // namespace trackbed
