// The BMW 320i against CommonRoad's multi-body model of it: the same steering and speed, the wheels
// prescribed. tests/data/commonroad/README.md tells where the reference is from.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "tests/sim/cars.h"
#include "tests/tolerance.h"
#include "trackbed/core/table.h"

namespace trackbed {
namespace {

std::filesystem::path Reference(const std::string& name) {
  return std::filesystem::path(TRACKBED_SOURCE_DIR) / "tests/data/commonroad" / (name + ".csv");
}

/// A column over time, linear between rows.
class Signal {
 public:
  Signal(const Table& table, const char* column)
      : times_(table.Column("t_s")), values_(table.Column(column)) {}

  double operator()(double time) const {
    const auto after = std::upper_bound(times_.begin(), times_.end(), time);
    if (after == times_.begin() || after == times_.end()) {
      return after == times_.begin() ? values_.front() : values_.back();
    }
    const auto i = static_cast<std::size_t>(after - times_.begin());
    const double share = (time - times_[i - 1]) / (times_[i] - times_[i - 1]);
    return std::lerp(values_[i - 1], values_[i], share);
  }
  [[nodiscard]] double peak() const {
    double peak = 0.0;
    for (const double value : values_) {
      peak = std::max(peak, std::abs(value));
    }
    return peak;
  }
  [[nodiscard]] double end() const { return times_.back(); }

 private:
  std::vector<double> times_;
  std::vector<double> values_;
};

/// How far a drive was from the reference.
struct Deviation {
  double yaw_rate = 0.0;              ///< rms over the reference's peak
  double lateral_acceleration = 0.0;  ///< likewise
  double path = 0.0;                  ///< largest distance over the distance driven
  double speed = 0.0;                 ///< rms over the speed at the start
  double distance = 0.0;              ///< driven, relative
  double yaw = 0.0;                   ///< largest heading [rad]
};

Deviation Compare(const std::string& name, double timestep) {
  const Table table = ReadCsv(Reference(name));
  const Signal steering(table, "delta_rad");
  const Signal speed(table, "vx_mps");
  const Signal yaw_rate(table, "yaw_rate_radps");
  const Signal acceleration(table, "ay_mps2");
  const Signal x(table, "x_m");
  const Signal y(table, "y_m");
  const CarModel car = CarWith("bmw320i", {}, timestep);
  const double to_cg = car.params().cg_to_rear;
  const World world;
  const auto plant =
      MakePlant("mujoco:magic_formula", {.car = car,
                                         .world = world,
                                         .start = {.pose = {-to_cg, 0.0, 0.0}, .speed = speed(0.0)},
                                         .steering = SteeringInput::kPrescribed});
  Deviation sums;
  double count = 0.0;
  double driven = 0.0;
  Vec2 last(0.0, 0.0);
  const VehicleState end = Drive(
      car, *plant, speed.end(),
      [&](double t, const VehicleState& s) {
        const double wanted = (speed(t + timestep) - speed(t)) / timestep;
        return Command{.steering = steering(t + timestep),
                       .acceleration = wanted + 5.0 * (speed(t) - s.speed)};
      },
      [&](double t, const VehicleState& s) {
        const Vec2 there(x(t), y(t));
        driven += (there - last).norm();
        last = there;
        const Vec2 here = ToWorld(s.pose, {to_cg, 0.0});
        sums.yaw_rate += std::pow(s.yaw_rate - yaw_rate(t), 2);
        sums.lateral_acceleration += std::pow(s.lateral_acceleration - acceleration(t), 2);
        sums.speed += std::pow(s.speed - speed(t), 2);
        sums.path = std::max(sums.path, (here - there).norm());
        sums.yaw = std::max(sums.yaw, std::abs(s.pose.yaw));
        count += 1.0;
      });
  return {
      .yaw_rate = std::sqrt(sums.yaw_rate / count) / yaw_rate.peak(),
      .lateral_acceleration = std::sqrt(sums.lateral_acceleration / count) / acceleration.peak(),
      .path = sums.path / driven,
      .speed = std::sqrt(sums.speed / count) / speed(0.0),
      .distance = std::abs(end.distance - driven) / driven,
      .yaw = sums.yaw};
}

TEST(CommonRoad, SteeringManoeuvres) {
  for (const char* name : {"step_steer_bmw320i_20mps", "lane_change_bmw320i_15mps"}) {
    const Deviation found = Compare(name, 0.002);
    EXPECT_LE(found.yaw_rate, Tolerance(0.03)) << name;
    EXPECT_LE(found.lateral_acceleration, Tolerance(0.05)) << name;
    EXPECT_LE(found.path, Tolerance(0.02)) << name;
  }
}

TEST(CommonRoad, StraightBraking) {
  const Deviation found = Compare("brake_straight_bmw320i_20mps", 0.002);
  EXPECT_LE(found.speed, Tolerance(0.01));
  EXPECT_LE(found.distance, Tolerance(0.01));
  EXPECT_LE(found.yaw, Tolerance(0.002));
}

TEST(CommonRoad, TheSameAtEveryTimestep) {
  const Deviation fine = Compare("step_steer_bmw320i_20mps", 0.001);
  const Deviation coarse = Compare("step_steer_bmw320i_20mps", 0.004);
  EXPECT_NEAR(fine.yaw_rate, coarse.yaw_rate, Tolerance(0.005));
  EXPECT_NEAR(fine.lateral_acceleration, coarse.lateral_acceleration, Tolerance(0.005));
  EXPECT_NEAR(fine.path, coarse.path, Tolerance(0.005));
}

TEST(CommonRoad, SteadyTurns) {
  const Table table = ReadCsv(Reference("steady_state_bmw320i"));
  const auto speeds = table.Column("v_mps");
  const auto angles = table.Column("delta_rad");
  const auto yaw_rates = table.Column("yaw_rate_radps");
  const auto accelerations = table.Column("ay_mps2");
  const auto lateral_speeds = table.Column("vy_mps");
  const CarModel car = CarWith("bmw320i", {});
  const World world;
  for (std::size_t i = 0; i < table.rows(); ++i) {
    const auto plant = MakePlant("mujoco:magic_formula", {.car = car,
                                                          .world = world,
                                                          .start = {.speed = speeds[i]},
                                                          .steering = SteeringInput::kPrescribed});
    double error_sum = 0.0;
    const VehicleState state = Drive(
        car, *plant, 8.0,
        [&](double t, const VehicleState& s) {
          const double error = speeds[i] - s.speed;
          error_sum += error * car.timestep();
          return Command{.steering = angles[i] * std::min(1.0, 2.0 * t),
                         .acceleration = 3.0 * error + 2.0 * error_sum};
        },
        [](double, const VehicleState&) {});
    ASSERT_NEAR(state.speed, speeds[i], 1e-3 * speeds[i]);
    EXPECT_NEAR(state.yaw_rate / yaw_rates[i], 1.0,
                Tolerance(accelerations[i] <= 4.0 ? 0.03 : 0.06))
        << speeds[i] << " m/s, " << angles[i] << " rad";
    // The sign of the camber decides on this: with the other one 15 m/s and 0.08 rad are off by
    // half. 0.01 m/s is 7 % of what the reference has there.
    EXPECT_NEAR(state.lateral_speed, lateral_speeds[i], Tolerance(0.01));
  }
}

}  // namespace
}  // namespace trackbed
