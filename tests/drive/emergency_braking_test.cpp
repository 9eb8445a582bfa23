#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "tests/tolerance.h"
#include "trackbed/drive/drive.h"

// Tests braking for obstacles that become known too late for any other reaction.
namespace trackbed {
namespace {

struct Outcome {
  double clearance = 0.0;     ///< smallest [m]
  double deceleration = 0.0;  ///< largest commanded deceleration [m/s^2]
  double planned = 0.0;       ///< largest planned deceleration [m/s^2]
  DriveStatus status = DriveStatus::kArrived;
};

/// A run at `speed` toward a wall across the route that is detected `range` ahead.
Outcome Drive(const std::string& plant, double speed, double range, double place,
              const std::string& more = "") {
  const Scenario scenario = ParseScenario(
      fmt::format("schema: 1\nname: wall\n"
                  "mission: {{speed: {0}, waypoints: [[0, 0], [250, 0]], start: {{speed: {0}}}}}\n"
                  "world: {{{4}obstacles: [{{box: {{x: {3}, y: 0, length: 1, width: 30}}, "
                  "known_from: {{range: {2}}}}}]}}\n"
                  "plan: {{global: {{method: dubins}}, replan: {{safe_distance: 0.3, along: "
                  "{{method: frenet}}, road: {{left: 2, right: 2}}}}}}\n"
                  "drive: {{plants: [{1}]}}\n",
                  speed, "'" + plant + "'", range, place, more),
      "test.yaml", ".");
  const CarModel car = LoadCar(scenario);
  const RunLog log = SimulateScenario(scenario, car, PlanScenario(scenario, car.unladen()), plant);
  Outcome outcome{.clearance = 1e9, .status = log.status};
  for (const LogRow& row : log.rows) {
    outcome.clearance = std::min(outcome.clearance, row.clearance.value_or(1e9));
    outcome.deceleration = std::max(outcome.deceleration, -row.command.acceleration);
  }
  for (const PlanChange& change : log.changes) {
    const SpeedProfile& profile = change.plan.reference.speed;
    for (const SpeedProfile::Knot& knot : profile.knots()) {
      outcome.planned = std::max(outcome.planned, -profile.AccelerationAt(knot.s));
    }
  }
  return outcome;
}

constexpr double kSafe = 0.3 + 0.5;  ///< safe distance, and the gap kept before it [m]
constexpr double kPeriod = 0.02;     ///< control period [s]

TEST(EmergencyBraking, StopsWheneverTyresAndBrakesCan) {
  const double limit =
      CarModel(ComposeScene(FindModel("prius", ""), {}), "prius").params().max_deceleration;
  std::mt19937 random(18);
  std::uniform_real_distribution<double> speeds(2.0, 15.0);
  std::uniform_real_distribution<double> spares(0.0, 1.0);
  std::uniform_real_distribution<double> places(60.0, 90.0);
  for (int i = 0; i < 40; ++i) {
    const double speed = speeds(random);
    // The shortest range at which the car can stop: it brakes at the limit, up to two control
    // periods late.
    const double least = speed * speed / (2.0 * limit) + 2.0 * speed * kPeriod + kSafe;
    const double range = least * (1.0 + spares(random) * spares(random));
    const double place = places(random);
    for (const char* plant : {"kinematic", "mujoco:magic_formula"}) {
      const Outcome outcome = Drive(plant, speed, range, place);
      SCOPED_TRACE(fmt::format("{}: {:.3f} m/s, seen {:.3f} m ahead, wall at {:.3f} m", plant,
                               speed, range, place));
      EXPECT_NE(outcome.status, DriveStatus::kCollided);
      EXPECT_GT(outcome.clearance, 0.0);
      EXPECT_LE(outcome.deceleration, limit + Tolerance(1e-9));
    }
  }
}

TEST(EmergencyBraking, IsComfortableWhereThatSuffices) {
  // 1.5 m/s^2 is the default deceleration; the controller may use up to 3 to follow its profile.
  for (const double speed : {3.0, 6.0, 10.0}) {
    const double comfortable = 0.5 * speed * speed / 1.5 + 0.6 * speed + kSafe + 4.0;
    const Outcome outcome = Drive("kinematic", speed, comfortable, 120.0);
    EXPECT_EQ(outcome.status, DriveStatus::kBlocked) << speed;
    EXPECT_LE(outcome.deceleration, 1.5 * 1.05) << speed;
  }
}

TEST(EmergencyBraking, IsGentlerOnASlipperyRoad) {
  const double limit =
      MaxDeceleration(CarModel(ComposeScene(FindModel("prius", ""), {}), "prius").params(), 0.4);
  for (const char* plant : {"kinematic", "mujoco:magic_formula", "mujoco:contact"}) {
    const double speed = 10.0;
    const double range = 0.5 * speed * speed / limit + 2.0 * speed * kPeriod + kSafe;
    const Outcome outcome = Drive(plant, speed, range, 80.0, "friction: 0.4, ");
    EXPECT_NE(outcome.status, DriveStatus::kCollided) << plant;
    EXPECT_LE(outcome.deceleration, limit + Tolerance(1e-9)) << plant;
  }
  // The car hits a wall that is detected too late. Even in this case, the plan does not exceed the
  // grip of the road.
  const Outcome late = Drive("kinematic", 10.0, 9.0, 80.0, "friction: 0.4, ");
  EXPECT_EQ(late.status, DriveStatus::kCollided);
  EXPECT_NEAR(late.planned, limit, Tolerance(1e-6));
}

}  // namespace
}  // namespace trackbed
