#include "trackbed/scenario/disturbances.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <string>

#include "tests/tolerance.h"
#include "trackbed/drive/drive.h"

// Tests runs with disturbances.
namespace trackbed {
namespace {

constexpr double kWheelbase = 2.7;  // of the Prius [m]

RunLog Drive(const std::string& yaml) {
  const Scenario scenario = ParseScenario("schema: 1\nname: disturbed\n" + yaml, "test.yaml", ".");
  const CarModel car = LoadCar(scenario);
  return SimulateScenario(scenario, car, PlanScenario(scenario, car.unladen()),
                          scenario.drive.plants.front());
}

/// An open-loop run of the kinematic car.
RunLog Open(const std::string& control, const std::string& rest,
            const std::string& drive = "plants: [kinematic]") {
  return Drive(fmt::format("mission: {{speed: 3, duration: 6}}\ncontrol: {}\ndrive: {{{}}}\n{}\n",
                           control, drive, rest));
}

/// A scenario along a path with a left turn, with the preview controller.
std::string Route(const std::string& plant) {
  return fmt::format(
      "mission: {{speed: 3, waypoints: [[0, 0], [25, 0], [25, 25]]}}\n"
      "plan: {{method: fillet}}\ndrive: {{plants: [{}]}}\n",
      plant);
}

/// A scenario with a straight path of 60 m.
std::string Straight(const std::string& plant, const std::string& start = "x: 0") {
  return fmt::format(
      "mission: {{speed: 3, waypoints: [[0, 0], [30, 0], [60, 0]], start: {{{}}}}}\n"
      "plan: {{method: fillet, infeasible: allow}}\ndrive: {{plants: [{}]}}\n",
      start, plant);
}

const LogRow& At(const RunLog& log, double time, double period = 0.02) {
  return log.rows.at(static_cast<std::size_t>(std::lround(time / period)));
}

std::vector<double> Configurations(const RunLog& log, const std::string& column) {
  const auto& columns = log.configurations.columns();
  const auto at = std::find(columns.begin(), columns.end(), column) - columns.begin();
  std::vector<double> values;
  for (std::size_t row = 0; row < log.configurations.rows(); ++row) {
    values.push_back(log.configurations.at(row, static_cast<std::size_t>(at)));
  }
  return values;
}

TEST(NoDisturbance, LeavesEveryByte) {
  const std::string neutral =
      "disturb: {wheelbase: 1, steering: {factor: 1, delay: 0, backlash: 0}, noise: {position: "
      "0, heading: 0}, kicks: [{at: 2, displacement: 0}, {at: 3, impulse: 0}], speed_loss: {speed: "
      "100}}\n";
  for (const char* plant : {"kinematic", "single_track", "mujoco", "mujoco:magic_formula"}) {
    const RunLog without = Drive(Route(plant));
    const RunLog with = Drive(Route(plant) + neutral);
    EXPECT_EQ(ToTable(with).ToCsv(), ToTable(without).ToCsv()) << plant;
    EXPECT_EQ(with.configurations.ToCsv(), without.configurations.ToCsv()) << plant;
    EXPECT_EQ(without.status, DriveStatus::kArrived) << plant;
  }
}

TEST(SteeringDelay, ShiftsTheWheelsByItWhateverTheControlPeriod) {
  const std::string sine = "{method: sine, amplitude: 0.05, frequency: 0.5, cycles: 2, at: 0.5}";
  for (const char* steering : {"actuator", "prescribed"}) {
    // 0.13 s are 65 timesteps, but not a whole number of these control periods.
    for (const char* period : {"0.02", "0.05", "0.1"}) {
      const std::string drive =
          fmt::format("plants: [kinematic], state_period: 0.002, control_period: {}, steering: {}",
                      period, steering);
      const auto own = Configurations(Open(sine, "", drive), "rack_rad");
      const auto late =
          Configurations(Open(sine, "disturb: {steering: {delay: 0.13}}", drive), "rack_rad");
      ASSERT_EQ(own.size(), 3001U);
      ASSERT_EQ(late.size(), own.size());
      for (std::size_t i = 0; i < own.size(); ++i) {
        // The values are exactly equal, because the delayed values are the same numbers in the same
        // order.
        ASSERT_EQ(late[i], i < 65 ? 0.0 : own[i - 65]) << steering << " " << period << " " << i;
      }
      EXPECT_GT(*std::max_element(own.begin(), own.end()), 0.04);
    }
  }
}

TEST(SteeringDelay, ByAnUnknownPeriodDoesNotMakeTheCommandSaw) {
  // The controllers model the dead time of dart, but not the added delay of one control period.
  // After a kick, the command stays within 6 times the backlash of 0.0228 rad, because the lead
  // across the backlash amplifies a step by up to 6. The curve adds an offset of 0.0034 rad.
  for (const char* control : {"preview", "preview_integral", "pure_pursuit"}) {
    const RunLog log = Drive(fmt::format(
        "vehicle: {{model: dart}}\nmission: {{speed: 2.1, waypoints: [[0, 0], [25, 0]]}}\n"
        "plan: {{method: fillet}}\ncontrol: {{method: {}}}\ndrive: {{plants: [kinematic]}}\n"
        "disturb: {{steering: {{delay: 0.02}}, kicks: [{{at: 3, displacement: 0.05}}]}}\n",
        control));
    for (double t = 8.0; t < 10.0; t += 0.02) {
      EXPECT_LE(std::abs(At(log, t).command.steering), 6 * 0.0228 + 0.0034) << control << " " << t;
    }
  }
}

TEST(SteeringFactor, ScalesTheCircle) {
  for (const double factor : {0.8, 1.25}) {
    const RunLog log = Open("{method: constant_steering, steering: 0.1}",
                            fmt::format("disturb: {{steering: {{factor: {}}}}}", factor),
                            "plants: [kinematic], steering: prescribed");
    const VehicleState& state = log.rows.back().state;
    EXPECT_NEAR(state.speed / state.yaw_rate, kWheelbase / std::tan(factor * 0.1),
                Tolerance(1e-12));
    EXPECT_EQ(log.rows[5].command.steering, 0.1);
    EXPECT_EQ(log.rows[5].state.steering_actuator, factor * 0.1);
  }
}

TEST(SteeringDeadBand, IsTakenOffWhatTheWheelsDo) {
  const RunLog log =
      Open("{method: sine, amplitude: 0.05, frequency: 0.25, cycles: 1}",
           "disturb: {steering: {backlash: 0.02}}", "plants: [kinematic], steering: prescribed");
  double play = 0.0;  // closed form of backlash, row by row
  for (std::size_t i = 1; i < log.rows.size(); ++i) {
    const double wanted = log.rows[i - 1].command.steering;
    play = std::clamp(play, wanted - 0.01, wanted + 0.01);
    EXPECT_NEAR(log.rows[i].state.steering, play, Tolerance(1e-15));
  }
  // The sine ends at 0 after a rise from below, so the wheels are half of the play behind the
  // command.
  EXPECT_NEAR(log.rows.back().state.steering, -0.01, Tolerance(1e-9));
}

TEST(Wheelbase, IsWhatTheControllerTakesItFor) {
  // The controller steers the circle through the point ahead: tan(delta) = L 2 sin(u)/R. In the
  // first period, the angle u does not depend on the wheelbase.
  const auto first = [](const std::string& disturb) {
    return Drive(Straight("kinematic", "yaw: 0.1") + "control: {method: preview, distance: 2.5}\n" +
                 disturb)
        .rows.front()
        .command.steering;
  };
  const double own = first("");
  const double wrong = first("disturb: {wheelbase: 1.2}\n");
  EXPECT_LT(own, -0.05);
  EXPECT_NEAR(std::tan(wrong) / std::tan(own), 1.2, Tolerance(1e-12));
}

TEST(SpeedLoss, HoldsTheCarBackAndThePlanGoesOn) {
  for (const char* plant : {"kinematic", "single_track", "mujoco"}) {
    const RunLog log = Drive(Straight(plant) + "disturb: {speed_loss: {from: 5, speed: 1}}\n");
    EXPECT_NEAR(At(log, 5.0).state.speed, 3.0, Tolerance(0.01)) << plant;
    // The car brakes at 3 m/s^2 until the speed error is 1.5 m/s. The error then decays as e^(-2
    // t), to a fraction of 1e-8 after 9 s. The controller compensates MuJoCo's bearings and air
    // drag to a millimeter per second.
    EXPECT_NEAR(At(log, 15.0).state.speed, 1.0, Tolerance(2e-3)) << plant;
    EXPECT_NEAR(At(log, 40.0).state.speed, 1.0, Tolerance(2e-3)) << plant;
    EXPECT_EQ(log.status, DriveStatus::kArrived) << plant;  // stops where the plan does
    // The car begins to brake below the planned speed. Braking from 1 m/s to rest takes 0.7 s and
    // 0.33 m. In 0.7 s, the gain of 2 1/s reduces the error only to a fraction of e^-1.4.
    EXPECT_NEAR(log.rows.back().state.pose.x, 60.0, Tolerance(0.33 * 0.25)) << plant;
  }
}

TEST(SpeedLoss, BeginsAtItsStation) {
  const RunLog log =
      Drive(Straight("kinematic") + "disturb: {speed_loss: {station: 20, speed: 2}}\n");
  for (const LogRow& row : log.rows) {
    if (row.tracking->s < 20.0) {
      EXPECT_EQ(row.state.speed, 3.0) << row.state.time;
    } else {
      EXPECT_LT(row.state.speed, 3.0 + 1e-12);
    }
  }
  EXPECT_NEAR(At(log, 15.0).state.speed, 2.0, Tolerance(1e-6));
}

struct Statistics {
  double mean = 0.0;
  double deviation = 0.0;
  double correlation = 0.0;  ///< between successive errors
};

Statistics Of(const std::vector<double>& values) {
  const auto count = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
  double squares = 0.0;
  double products = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    squares += (values[i] - mean) * (values[i] - mean);
    products += i == 0 ? 0.0 : (values[i] - mean) * (values[i - 1] - mean);
  }
  return {mean, std::sqrt(squares / count), products / squares};
}

constexpr const char* kNoise = "disturb: {noise: {position: 0.05, heading: 0.01}}\n";

TEST(Noise, HasItsStatistics) {
  const RunLog log = Drive(
      "mission: {speed: 3, duration: 100}\ncontrol: {method: constant_steering, steering: "
      "0.05}\ndrive: {plants: [kinematic]}\n" +
      std::string(kNoise));
  const std::vector<std::pair<double, std::function<double(const LogRow&)>>> measured{
      {0.05, [](const LogRow& row) { return row.measured->x - row.state.pose.x; }},
      {0.05, [](const LogRow& row) { return row.measured->y - row.state.pose.y; }},
      {0.01, [](const LogRow& row) { return row.measured->yaw - row.state.pose.yaw; }}};
  for (const auto& [sigma, error] : measured) {
    std::vector<double> errors;
    for (const LogRow& row : log.rows) {
      errors.push_back(error(row));
    }
    // Tolerances for 5001 draws are four standard deviations: sigma/sqrt(n) for the mean,
    // sigma/sqrt(2 n) for the deviation, and 1/sqrt(n) for the correlation.
    const double n = static_cast<double>(errors.size());
    const Statistics statistics = Of(errors);
    EXPECT_NEAR(statistics.mean, 0.0, Tolerance(4.0 * sigma / std::sqrt(n)));
    EXPECT_NEAR(statistics.deviation, sigma, Tolerance(4.0 * sigma / std::sqrt(2.0 * n)));
    EXPECT_NEAR(statistics.correlation, 0.0, Tolerance(4.0 / std::sqrt(n)));
    // 4.55 % of the values of a normal distribution are farther than two standard deviations from
    // the mean. The measured fraction has a standard deviation of sqrt(p q/n) = 0.3 %, with p =
    // 4.55 % and q = 1 - p.
    const auto beyond =
        std::count_if(errors.begin(), errors.end(),
                      [limit = 2.0 * sigma](double e) { return std::abs(e) > limit; });
    EXPECT_NEAR(static_cast<double>(beyond) / n, 0.0455, Tolerance(0.012));
  }
}

TEST(Noise, IsSeenByTheControllerAndIsNotTheTruth) {
  const RunLog log =
      Drive(Straight("kinematic") + "control: {method: preview, distance: 2.5}\n" + kNoise);
  EXPECT_EQ(log.status, DriveStatus::kArrived);
  std::vector<double> commands;
  for (const LogRow& row : log.rows) {
    commands.push_back(row.command.steering);
    EXPECT_NEAR(row.tracking->cross_track, row.state.pose.y, Tolerance(1e-12));
  }
  // The controller commands tan(delta) = 2 L sin(u)/R with R = 2.5 m. Noise of 0.01 rad in the
  // heading and 0.05 m in the position causes standard deviations of 0.022 rad in u and 0.05 rad in
  // the command. Wheels that turn at 0.15 rad/s cannot follow these commands.
  EXPECT_NEAR(Of(commands).deviation, 0.05, Tolerance(0.015));
  EXPECT_LT(std::abs(log.rows.back().state.pose.y), 0.1);
  // The first row's command belongs to the first row's measurement.
  const Pose2 seen = *log.rows.front().measured;
  const double u = std::atan2(-seen.y, std::sqrt(2.5 * 2.5 - seen.y * seen.y)) - seen.yaw;
  EXPECT_NEAR(commands.front(), std::atan(2.0 * kWheelbase / 2.5 * std::sin(u)), Tolerance(1e-9));
}

TEST(Noise, IsThatOfTheSeedOnEveryPlant) {
  const auto seeded = [](const char* plant, int seed) {
    return Drive(fmt::format("seed: {}\n{}{}", seed, Straight(plant), kNoise));
  };
  const RunLog one = seeded("kinematic", 1);
  EXPECT_EQ(ToTable(seeded("kinematic", 1)).ToCsv(), ToTable(one).ToCsv());
  EXPECT_NE(ToTable(seeded("kinematic", 2)).ToCsv(), ToTable(one).ToCsv());
  const RunLog other = seeded("single_track", 1);
  for (std::size_t i = 0; i < 500; ++i) {
    const double here = one.rows[i].measured->x - one.rows[i].state.pose.x;
    const double there = other.rows[i].measured->x - other.rows[i].state.pose.x;
    ASSERT_NEAR(here, there, Tolerance(1e-13));  // differences of numbers up to 60
  }
}

TEST(Kick, SetsTheCarAsideAndItComesBack) {
  for (const char* plant : {"kinematic", "single_track", "mujoco"}) {
    const RunLog log =
        Drive(Straight(plant) + "disturb: {kicks: [{at: 4.01, displacement: -0.5}]}\n");
    EXPECT_NEAR(At(log, 4.0).state.pose.y, 0.0, Tolerance(1e-3)) << plant;
    // At 4.02 s, the delayed measurements do not yet show the offset to the controller.
    EXPECT_NEAR(At(log, 4.02).state.pose.y, -0.5, Tolerance(1e-3)) << plant;
    EXPECT_GT(At(log, 4.02).command.steering, 0.05) << plant;
    EXPECT_NEAR(log.rows.back().state.pose.y, 0.0, Tolerance(0.02)) << plant;
    EXPECT_EQ(log.status, DriveStatus::kArrived) << plant;
  }
}

TEST(Kick, IsAnImpulseOverItsDuration) {
  // On ice, air drag is the only other lateral force. The air meets the car at 3 m/s from ahead
  // and, on average, at 0.19 m/s from the left. The force of 1/2 * 1.225 * 3 * 0.19 * 5.07 = 1.8 N
  // changes the lateral speed by 7e-4 m/s in 0.5 s.
  for (const char* duration : {"", ", duration: 0.5"}) {
    const RunLog log = Drive(fmt::format(
        "mission: {{speed: 3, duration: 3}}\ncontrol: {{method: constant_steering, steering: 0}}\n"
        "drive: {{plants: [mujoco]}}\nworld: {{friction: 1e-5}}\n"
        "disturb: {{kicks: [{{at: 1, impulse: 500{}}}]}}\n",
        duration));
    EXPECT_NEAR(At(log, 1.0).state.lateral_speed, 0.0, Tolerance(1e-4));
    const double lasts = std::string(duration).empty() ? 0.1 : 0.5;
    EXPECT_NEAR(At(log, 1.0 + lasts).state.lateral_speed, 500.0 / 1317.0, Tolerance(8e-4));
    EXPECT_NEAR(At(log, 1.06).state.lateral_speed, 0.06 / lasts * 500.0 / 1317.0, Tolerance(6e-4));
  }
}

TEST(PayloadOnTheWay, StaysInTheCarInAWorld) {
  const Scenario scenario = ParseScenario(
      "schema: 1\nname: laden\n" + Straight("mujoco") +
          "world: {obstacles: [{box: {x: 20, y: 8, length: 2, width: 2}}], ground: {grade: {x: "
          "0.05}}}\ndisturb: {payload: {mass: 200, x: 0.5}}\n",
      "test.yaml", ".");
  const CarModel car = LoadCar(scenario);
  EXPECT_NEAR(car.params().mass, 1517.0, Tolerance(1e-9));
  EXPECT_NEAR(car.unladen().mass, 1317.0, Tolerance(1e-9));
  const RunLog log =
      SimulateScenario(scenario, car, PlanScenario(scenario, car.unladen()), "mujoco");
  EXPECT_EQ(log.status, DriveStatus::kArrived);
  // The car does not bounce at the start. The tolerance is 1 % of its weight, which is twice the
  // load change of the unladen car's wheels in the first step.
  for (std::size_t i = 0; i < 50; ++i) {
    double sum = 0.0;
    for (const WheelState& wheel : *log.rows[i].state.wheels) {
      sum += wheel.normal_force;
    }
    EXPECT_NEAR(sum, 1517.0 * 9.81 * std::cos(std::atan(0.05)), Tolerance(150.0)) << i;
  }
}

}  // namespace
}  // namespace trackbed
