#include "trackbed/analysis/manoeuvre.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "src/analysis/evaluations.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/planning/common/plan.h"

namespace trackbed {
namespace {

double SaturatedFraction(const RunLog& log, double begin, double end) {
  constexpr double kReached = 1e-6;  // [rad]; as in PlantMetrics
  double saturated = 0.0;
  double periods = 0.0;
  for (std::size_t i = 0; i + 1 < log.rows.size(); ++i) {
    const LogRow& row = log.rows[i];
    if (row.state.time >= begin && log.rows[i + 1].state.time <= end) {
      const double short_by = row.command.steering - log.rows[i + 1].state.steering_actuator;
      saturated += std::abs(short_by) > kReached ? 1.0 : 0.0;
      periods += 1.0;
    }
  }
  return periods > 0.0 ? saturated / periods : 0.0;
}

const std::vector<std::string>& Names(const SteadyStateCircleOptions&) {
  static const std::vector<std::string> names{
      "lateral_acceleration_max", "understeer_gradient", "characteristic_speed",
      "critical_speed",           "yaw_rate_gain",       "roll_gradient",
      "sideslip_gradient"};
  return names;
}
const std::vector<std::string>& Names(const SlowlyIncreasingSteerOptions&) {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all = Names(SteadyStateCircleOptions{});
    all.emplace_back("steering_at_0_3_g");
    return all;
  }();
  return names;
}
const std::vector<std::string>& Names(const StepSteerOptions&) {
  static const std::vector<std::string> names{"speed",
                                              "yaw_rate_steady",
                                              "yaw_rate_response_time",
                                              "yaw_rate_peak_time",
                                              "yaw_rate_overshoot",
                                              "yaw_rate_gain",
                                              "lateral_acceleration_steady",
                                              "lateral_acceleration_response_time",
                                              "lateral_acceleration_peak_time",
                                              "lateral_acceleration_overshoot",
                                              "sideslip_steady",
                                              "tb"};
  return names;
}
const std::vector<std::string>& Names(const SineWithDwellTestOptions&) {
  static const std::vector<std::string> names{"speed", "lateral_displacement", "yaw_rate_peak",
                                              "yaw_rate_ratio_1_00", "yaw_rate_ratio_1_75"};
  return names;
}
const std::vector<std::string>& Names(const LaneChangeOptions&) {
  static const std::vector<std::string> names{"margin",   "margin_gate", "margin_1",  "margin_3",
                                              "margin_5", "entry_speed", "speed_loss"};
  return names;
}
const std::vector<std::string>& Names(const BrakingTestOptions&) {
  static const std::vector<std::string> names{"initial_speed",
                                              "distance",
                                              "mean_fully_developed_deceleration",
                                              "yaw_rate_max",
                                              "heading_deviation_max",
                                              "lateral_deviation_max"};
  return names;
}
const std::vector<std::string>& Names(const DisturbanceOptions&) {
  static const std::vector<std::string> names{"lateral_deviation_max", "heading_deviation_max",
                                              "yaw_rate_deviation_max", "recovery_time"};
  return names;
}

/// Whatever else was measured, a car on its side has failed.
void CheckRoll(const RunLog& log, ManoeuvreMetrics& metrics) {
  constexpr double kTippedOver = 0.25 * kPi;  // far beyond where a car comes back by itself [rad]
  for (const LogRow& row : log.rows) {
    if (std::abs(row.state.roll) > kTippedOver) {
      metrics.passed = false;
      metrics.missing += metrics.missing.empty() ? "" : "; ";
      metrics.missing += fmt::format("the car turns over at {:.2f} s", row.state.time);
      return;
    }
  }
}

}  // namespace

std::optional<double> ManoeuvreMetrics::Find(std::string_view name) const {
  for (const auto& [own, value] : values) {
    if (own == name) {
      return value;
    }
  }
  return std::nullopt;
}

ManoeuvreMetrics EvaluateManoeuvre(const ManoeuvreOptions& options, const RunLog& log,
                                   const Plan& plan, const VehicleParams& vehicle) {
  TRACKBED_CHECK(!log.rows.empty(), "the log of {} is empty", log.plant);
  ManoeuvreMetrics metrics;
  metrics.method = ManoeuvreName(options);
  metrics.begin = log.rows.front().state.time;
  metrics.end = log.rows.back().state.time;
  const ManoeuvreInput input{log, plan, vehicle};
  std::visit([&](const auto& own) { Evaluate(own, input, metrics); }, options);
  for (const auto& [name, value] : metrics.values) {
    TRACKBED_CHECK(EveryMetricOf(options).Find(name), "a value that is not in the list: {}", name);
  }
  CheckRoll(log, metrics);
  metrics.steering_saturated_fraction = SaturatedFraction(log, metrics.begin, metrics.end);
  return metrics;
}

ManoeuvreMetrics EveryMetricOf(const ManoeuvreOptions& options) {
  ManoeuvreMetrics metrics;
  metrics.method = ManoeuvreName(options);
  metrics.passed = false;
  metrics.missing = "why";
  for (const std::string& name : std::visit([](const auto& own) { return Names(own); }, options)) {
    metrics.values.emplace_back(name, 0.0);
  }
  return metrics;
}

nlohmann::ordered_json ToJson(const ManoeuvreMetrics& metrics) {
  nlohmann::ordered_json json{{"method", metrics.method}};
  if (metrics.passed) {
    json["passed"] = *metrics.passed;
  }
  for (const auto& [name, value] : metrics.values) {
    json[name] = value;
  }
  json["begin"] = metrics.begin;
  json["end"] = metrics.end;
  json["steering_saturated_fraction"] = metrics.steering_saturated_fraction;
  if (!metrics.missing.empty()) {
    json["missing"] = metrics.missing;
  }
  return json;
}

}  // namespace trackbed
