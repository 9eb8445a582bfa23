// Tests provoked faults of the physics. Each fault ends the run with a status, a cause and a log.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>
#include <string>

#include "tests/support/temp_folder.h"
#include "trackbed/core/file.h"
#include "trackbed/drive/drive.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/sim/car_model.h"
#include "trackbed/sim/scene.h"

namespace trackbed {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

/// A run of ten seconds straight ahead with a modified car file.
struct ChangedCar {
  std::string plant = "mujoco:contact";
  std::string find{};     ///< a regular expression in the car's file
  std::string replace{};  ///< replacement of the matches
  std::string keys{};     ///< additional keys of the scenario
  double speed = 5.0;     ///< [m/s]
  double start = 5.0;     ///< speed at the start [m/s]
};

RunLog LogOf(const ChangedCar& drive) {
  const TempFolder folder;
  const std::string car_xml = ReadFile(FindModel("prius", ""));
  const std::string changed =
      drive.find.empty() ? car_xml
                         : std::regex_replace(car_xml, std::regex(drive.find), drive.replace);
  EXPECT_EQ(changed == car_xml, drive.find.empty());
  folder.Write("car.xml", changed);
  const Scenario scenario = ParseScenario(
      fmt::format("schema: 1\nname: fault\nvehicle: {{model: ./car.xml}}\n"
                  "mission: {{start: {{x: 0, y: 0, yaw: 0, speed: {}}}, duration: 15}}\n"
                  "control: {{method: constant_steering, steering: 0, "
                  "speed: {{over_time: [[0, {}]]}}}}\n"
                  "drive: {{plants: ['{}']}}\n{}",
                  drive.start, drive.speed, drive.plant, drive.keys),
      "fault.yaml", folder.path());
  const CarModel car = LoadCar(scenario);
  RunLog log = SimulateScenario(scenario, car, PlanScenario(scenario, car.unladen()), drive.plant);
  EXPECT_FALSE(log.rows.empty());
  EXPECT_GT(log.configurations.rows(), 0U);
  return log;
}

TEST(PhysicsFaults, NoneEndsTheDriveThatOthersChange) {
  for (const char* plant : {"mujoco:contact", "mujoco:magic_formula"}) {
    const RunLog log = LogOf({.plant = plant});
    EXPECT_EQ(log.status, DriveStatus::kArrived) << plant;
    EXPECT_EQ(log.cause, "") << plant;
  }
}

TEST(PhysicsFaults, DivergesOnSpringsTooStiffForTheTimestep) {
  const RunLog log = LogOf({.plant = "mujoco:magic_formula",
                            .find = "stiffness=\"[0-9.]+\"",
                            .replace = "stiffness=\"9e8\""});
  EXPECT_EQ(log.status, DriveStatus::kDiverged);
  EXPECT_THAT(log.cause, StartsWith("MuJoCo: Nan, Inf or huge value in Q"));
}

TEST(PhysicsFaults, DivergesWhereContactsFindNoRoom) {
  const RunLog log = LogOf({.find = "<worldbody>", .replace = "<size njmax='1'/><worldbody>"});
  if (PhysicsVersion().starts_with("MuJoCo 2.")) {
    EXPECT_EQ(log.status, DriveStatus::kDiverged);
    EXPECT_THAT(log.cause, HasSubstr("njmax"));
  } else {  // newer versions ignore njmax and allocate the memory that they need
    EXPECT_EQ(log.status, DriveStatus::kArrived);
  }
}

TEST(PhysicsFaults, SinksThroughARoadThatCarriesNothing) {
  // The ground has a collision bit that no tyre has, so it collides with nothing.
  const RunLog log = LogOf({.find = "geom name=\"ground\"",
                            .replace = "geom name=\"ground\" contype=\"8\" conaffinity=\"8\""});
  EXPECT_EQ(log.status, DriveStatus::kSunk);
  EXPECT_THAT(log.cause, testing::MatchesRegex("a wheel reaches 0\\.3[0-9]+ m below the road"));
}

TEST(PhysicsFaults, IsAirborneFromASpringboard) {
  // At 50 m/s, a bump of 1.5 m height and 16 m length keeps the car in the air for more than a
  // second.
  const RunLog log = LogOf({.keys = "world: {ground: {bumps: [{x: 30, y: 0, length: 16, "
                                    "width: 20, edge: 8, height: 1.5}]}}\n",
                            .speed = 50.0,
                            .start = 50.0});
  EXPECT_EQ(log.status, DriveStatus::kAirborne) << ToString(log.status);
  EXPECT_THAT(log.cause, StartsWith("all wheels are "));
}

TEST(PhysicsFaults, RollsOverInATurnTooFast) {
  const RunLog log = LogOf({.plant = "mujoco:contact",
                            .find = "pos=\"1.3908783783783782 0 0.5768842905405406\"",
                            .replace = "pos=\"1.3908783783783782 0 2.5\"",
                            .keys = "disturb: {kicks: [{at: 2, impulse: 30000, duration: 1}]}\n"});
  EXPECT_EQ(log.status, DriveStatus::kRolledOver) << ToString(log.status);
  EXPECT_THAT(log.cause, testing::MatchesRegex("roll -?[0-9]+ deg, pitch -?[0-9]+ deg"));
  EXPECT_LT(log.rows.back().state.time, 14.0);
}

TEST(PhysicsFaults, IsStuckWithTooLittleTorque) {
  const RunLog log = LogOf({.plant = "mujoco:magic_formula",
                            .find = "(<[a-z]+ name=\"drive\"[^>]*ctrlrange=)\"[^\"]*\"",
                            .replace = "$1\"-1 1\"",
                            .start = 0.0});
  EXPECT_EQ(log.status, DriveStatus::kStuck) << ToString(log.status);
  EXPECT_THAT(log.cause, StartsWith("has not moved since 0."));
  EXPECT_LT(log.rows.back().state.time, 11.0);
}

}  // namespace
}  // namespace trackbed
