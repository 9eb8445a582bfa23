#include "trackbed/analysis/metrics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/tolerance.h"

namespace trackbed {
namespace {

/// A drive at `speed` that steers as cos(t); a car of understeer gradient K, always in steady
/// state.
RunLog Drive(double speed, double amplitude, double gradient, double wheelbase) {
  RunLog log{.plant = "made_up", .configurations = Table({"t_s"})};
  for (int i = 0; i <= 500; ++i) {
    LogRow row;
    row.state.time = 0.02 * i;
    row.state.speed = speed;
    row.state.distance = std::abs(speed) * row.state.time;
    row.state.steering = amplitude * std::cos(row.state.time);
    row.state.yaw_rate =
        speed * std::tan(row.state.steering) / (wheelbase + gradient * speed * speed);
    log.rows.push_back(row);
  }
  return log;
}

std::optional<double> Ratio(double speed, double amplitude, double gradient) {
  VehicleParams vehicle;
  vehicle.wheelbase = 2.5;
  return Measure(Drive(speed, amplitude, gradient, vehicle.wheelbase), Plan{}, vehicle, 0.02,
                 StationSource::kProjection)
      .yaw_rate_ratio;
}

TEST(YawRateRatio, IsThatOfTheUndersteerGradient) {
  // Of sums of some hundred products: rounding alone.
  EXPECT_NEAR(*Ratio(10.0, 0.1, 0.0), 1.0, Tolerance(1e-12));
  EXPECT_NEAR(*Ratio(10.0, 0.1, 0.0025), 1.0 / 1.1, Tolerance(1e-12));
  EXPECT_NEAR(*Ratio(20.0, -0.05, -0.001), 1.0 / (1.0 - 0.001 * 400.0 / 2.5), Tolerance(1e-12));
  EXPECT_NEAR(*Ratio(-5.0, 0.1, 0.0025), 1.0 / 1.025, Tolerance(1e-12));
}

TEST(YawRateRatio, IsNotSaidOfACarThatHardlyTurned) {
  // 10 m/s / 2.5 m tan(A) / sqrt 2 = 1 mrad/s for A = 0.35 mrad.
  EXPECT_TRUE(Ratio(10.0, 5e-4, 0.0).has_value());
  EXPECT_FALSE(Ratio(10.0, 2e-4, 0.0).has_value());
  EXPECT_FALSE(Ratio(0.0, 0.1, 0.0).has_value());
}

TEST(SteeringRateRms, IsThatOfARampAndARest) {
  // 0.1 rad/s for a quarter of the time: 0.1 sqrt(1/4).
  RunLog log{.plant = "made_up", .configurations = Table({"t_s"})};
  for (int i = 0; i <= 400; ++i) {
    LogRow row;
    row.state.time = 0.02 * i;
    row.state.steering = 0.002 * std::min(i, 100);
    log.rows.push_back(row);
  }
  VehicleParams vehicle;
  vehicle.wheelbase = 2.5;
  const PlantMetrics metrics = Measure(log, Plan{}, vehicle, 0.02, StationSource::kProjection);
  EXPECT_NEAR(metrics.steering_rate_rms, 0.05, Tolerance(1e-12));
  EXPECT_NEAR(ToJson(metrics)["steering_rate_rms"].get<double>(), 0.05, Tolerance(1e-12));
}

}  // namespace
}  // namespace trackbed
