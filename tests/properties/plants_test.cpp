// Properties that every registered plant must have for every start and every command.

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "tests/properties/property.h"
#include "tests/support/plant_names.h"
#include "tests/tolerance.h"
#include "trackbed/core/angle.h"
#include "trackbed/sim/plant.h"

namespace properties {
namespace {

using namespace trackbed;

const CarModel& Prius() {
  static const CarModel car(ComposeScene(FindModel("prius", ""), {}), "prius");
  return car;
}

std::unique_ptr<Plant> PlantAt(const std::string& name, const StartState& start) {
  static const World road;
  return MakePlant(name, {.car = Prius(), .world = road, .start = start});
}

class EveryPlant : public testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(Registry, EveryPlant, testing::ValuesIn(PlantNames()),
                         [](const auto& test) {
                           std::string name = test.param;
                           std::replace(name.begin(), name.end(), ':', '_');
                           return name;
                         });

bool IsFinite(const VehicleState& state) {
  const std::vector<double> numbers{state.pose.x,
                                    state.pose.y,
                                    state.pose.yaw,
                                    state.speed,
                                    state.distance,
                                    state.lateral_speed,
                                    state.yaw_rate,
                                    state.roll,
                                    state.pitch,
                                    state.longitudinal_acceleration,
                                    state.lateral_acceleration,
                                    state.sideslip,
                                    state.steering_actuator,
                                    state.steering};
  return std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); });
}

/// A command that applies for a number of steps.
struct Phase {
  Command command;
  double push = 0.0;  // Lateral force on the car [N].
  int steps = 0;
};

struct Drive {
  StartState start;
  std::vector<Phase> phases;
};

/// Returns a random run with the commands of a careful driver.
Drive UsualDrive() {
  Drive drive{.start = {.pose = {}, .speed = *Between(0.0, 15.0), .steering = *Within(0.3)}};
  const int count = Pick(1, 3);
  for (int i = 0; i < count; ++i) {
    Phase phase{.steps = Pick(1, 60)};
    phase.command.steering = *Within(0.4);
    phase.command.acceleration = *Within(3.0);
    phase.push = OnceIn(4) ? *Within(2000.0) : 0.0;
    drive.phases.push_back(phase);
  }
  return drive;
}

double AnyMagnitude() {
  return *Within(1.0) * *PowerOfTen(-300, 300);
}

/// Returns a random run with arbitrary commands from an arbitrary state.
Drive WildDrive() {
  Drive drive{.start = {.pose = {*Within(1.0) * *PowerOfTen(0, 6), *Within(1e3), *Within(1e3)},
                        .speed = *Within(1.0) * *PowerOfTen(-3, 2),
                        .steering = *Within(0.48)}};
  const int count = Pick(1, 3);
  for (int i = 0; i < count; ++i) {
    Phase phase{.steps = Pick(1, 30)};
    phase.command = {.steering = OnceIn(2) ? AnyMagnitude() : *Within(2.0),
                     .acceleration = OnceIn(2) ? AnyMagnitude() : *Within(100.0),
                     .gear = OnceIn(2) ? -1 : 1,
                     .coast = OnceIn(8)};
    phase.push = OnceIn(4) ? AnyMagnitude() : 0.0;
    drive.phases.push_back(phase);
  }
  return drive;
}

Drive MirrorOf(Drive drive) {
  drive.start.pose = {drive.start.pose.x, -drive.start.pose.y, -drive.start.pose.yaw};
  drive.start.steering = -drive.start.steering;
  for (Phase& phase : drive.phases) {
    phase.command.steering = -phase.command.steering;
    phase.push = -phase.push;
  }
  return drive;
}

/// Returns the state after a run. Sets `diverged` if the plant diverged.
VehicleState After(const std::string& name, const Drive& drive, bool& diverged) {
  const auto plant = PlantAt(name, drive.start);
  for (const Phase& phase : drive.phases) {
    for (int i = 0; i < phase.steps && !plant->diverged(); ++i) {
      plant->ApplyLateralForce(phase.push);
      plant->Step(phase.command);
    }
  }
  diverged = plant->diverged();
  return plant->Observe();
}

// Tolerance of symmetry [m, rad]. The model is symmetric up to rounding. In each step, the contact
// solver stops at 1e-10 of the energy scale m g; see MirrorsWithTheSteering in
// tests/sim/plant_test.cpp.
constexpr double kSolver = 1e-5;

void CheckSame(const Pose2& a, const Pose2& b) {
  RC_LOG() << a.x << " " << a.y << " " << a.yaw << "\n" << b.x << " " << b.y << " " << b.yaw;
  const double tolerance = Tolerance(kSolver);
  RC_ASSERT((a.position() - b.position()).norm() <= tolerance);
  RC_ASSERT(std::abs(AngleDifference(a.yaw, b.yaw)) <= tolerance);
}

TEST_P(EveryPlant, DrivesAMirroredDriveAsAMirroredDrive) {
  Check(0.5, [&] {
    const Drive drive = UsualDrive();
    bool diverged = false;
    const VehicleState a = After(GetParam(), drive, diverged);
    const VehicleState b = After(GetParam(), MirrorOf(drive), diverged);
    RC_ASSERT(!diverged);
    CheckSame({a.pose.x, -a.pose.y, -a.pose.yaw}, b.pose);
    RC_ASSERT(std::abs(a.speed - b.speed) <= Tolerance(10.0 * kSolver));
  });
}

TEST_P(EveryPlant, DrivesTheSameFromEveryPlaceInEveryDirection) {
  Check(0.5, [&] {
    Drive drive = UsualDrive();
    const Pose2 by{*Within(1000.0), *Within(1000.0), *Within(kPi)};
    bool diverged = false;
    const VehicleState a = After(GetParam(), drive, diverged);
    drive.start.pose = by;
    const VehicleState b = After(GetParam(), drive, diverged);
    RC_ASSERT(!diverged);
    CheckSame(Compose(by, a.pose), b.pose);
  });
}

TEST_P(EveryPlant, StaysFiniteOrSaysThatItDiverged) {
  Check(1.0, [&] {
    const Drive drive = WildDrive();
    bool diverged = false;
    VehicleState state;
    const bool refused = Refuses([&] { state = After(GetParam(), drive, diverged); });
    RC_TAG(std::string(refused ? "error" : diverged ? "diverged" : "finite"));
    RC_ASSERT(refused || diverged || IsFinite(state));
  });
}

TEST_P(EveryPlant, RefusesWhatIsNoNumber) {
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    SCOPED_TRACE(bad);
    for (double StartState::*number : {&StartState::speed, &StartState::steering}) {
      StartState start;
      start.*number = bad;
      EXPECT_THROW(PlantAt(GetParam(), start), PreconditionError);
    }
    for (double Pose2::*number : {&Pose2::x, &Pose2::y, &Pose2::yaw}) {
      StartState start;
      start.pose.*number = bad;
      EXPECT_THROW(PlantAt(GetParam(), start), PreconditionError);
    }
    const auto plant = PlantAt(GetParam(), {.pose = {}, .speed = 3.0, .steering = 0.0});
    EXPECT_THROW(plant->Step({.steering = bad}), PreconditionError);
    EXPECT_THROW(plant->Step({.acceleration = bad}), PreconditionError);
    EXPECT_THROW(plant->ApplyLateralOffset(bad), PreconditionError);
    EXPECT_THROW(plant->ApplyLateralForce(bad), PreconditionError);
    // After an exception, the plant must keep its valid state.
    plant->Step({});
    EXPECT_TRUE(IsFinite(plant->Observe()));
    EXPECT_FALSE(plant->diverged());
  }
}

}  // namespace
}  // namespace properties
