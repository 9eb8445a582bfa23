#include "trackbed/drive/stepped_loop.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <string>

#include "tests/drive/unicycle.h"
#include "tests/support/case_names.h"
#include "trackbed/control/controllers.h"
#include "trackbed/core/error.h"
#include "trackbed/drive/drive.h"

// Loops that are stepped from outside. All comparisons are bit for bit: tables write each number in
// the shortest form from which the same double can be read.
namespace trackbed {
namespace stepped_loop_test {

using testing::HasSubstr;

/// A shipped scenario with its car and plan.
struct Planned {
  explicit Planned(const std::string& name, const std::vector<Override>& overrides = {})
      : scenario(std::make_shared<Scenario>(ReadScenario(
            std::string(TRACKBED_SOURCE_DIR) + "/scenarios/" + name + ".yaml", overrides))),
        car(std::make_shared<CarModel>(LoadCar(*scenario))),
        plan(PlanScenario(*scenario, *car)) {}

  [[nodiscard]] SteppedLoop Loop(const std::string& plant) const {
    return MakeSteppedLoop(scenario, car, plan, plant);
  }

  std::shared_ptr<const Scenario> scenario;
  std::shared_ptr<const CarModel> car;
  FeasiblePlan plan;
};

void ExpectEqual(const RunLog& first, const RunLog& second) {
  EXPECT_EQ(first.status, second.status);
  EXPECT_EQ(first.cause, second.cause);
  EXPECT_EQ(first.contact_time, second.contact_time);
  EXPECT_EQ(first.changes.size(), second.changes.size());
  EXPECT_EQ(ToTable(first).ToCsv(), ToTable(second).ToCsv());
  EXPECT_EQ(first.configurations.ToCsv(), second.configurations.ToCsv());
}

void StepToEnd(SteppedLoop& loop) {
  while (!loop.status()) {
    loop.Step();
  }
}

class EveryLoop : public testing::TestWithParam<std::pair<const char*, const char*>> {};

// Disturbances, noise, replanning, cusps, an open-loop schedule, states of controllers, tyres.
INSTANTIATE_TEST_SUITE_P(
    Loops, EveryLoop,
    testing::Values(std::pair("three_turns", "mujoco"), std::pair("disturbed", "kinematic"),
                    std::pair("disturbed", "mujoco"), std::pair("obstacle_appears", "kinematic"),
                    std::pair("parking_lot", "kinematic"), std::pair("driven_turns", "mujoco"),
                    std::pair("courses/s_course", "single_track"), std::pair("overtake", "mujoco"),
                    std::pair("maneuvers/gust", "mujoco")),
    kNamedByParameter);

TEST_P(EveryLoop, SteppedByItsControllerIsTheRun) {
  const Planned planned(GetParam().first);
  const RunLog run =
      SimulateScenario(*planned.scenario, *planned.car, planned.plan, GetParam().second);
  SteppedLoop loop = planned.Loop(GetParam().second);
  StepToEnd(loop);
  ExpectEqual(loop.log(), run);
}

TEST_P(EveryLoop, ContinuesFromACopyAsIfNothingHadHappened) {
  const Planned planned(GetParam().first);
  SteppedLoop undisturbed = planned.Loop(GetParam().second);
  StepToEnd(undisturbed);
  const auto periods = static_cast<int>(undisturbed.log().rows.size());
  SteppedLoop loop = planned.Loop(GetParam().second);
  for (int i = 0; i < periods / 2; ++i) {
    loop.Step();
  }
  const SteppedLoop state = loop.Copy();
  // Commands of a future that differs from the copied one; they must not change the copy.
  for (int i = 0; i < 20 && !loop.status(); ++i) {
    loop.Step(0.3, 1.0);
  }
  loop = state.Copy();
  StepToEnd(loop);
  ExpectEqual(loop.log(), undisturbed.log());
  SteppedLoop again = state.Copy();
  StepToEnd(again);
  ExpectEqual(again.log(), undisturbed.log());
}

std::unique_ptr<Plant> At3Mps() {
  return std::make_unique<Unicycle>(StartState{.speed = 3.0});
}

SteppedLoop UnicycleLoop(bool keeps_log = true) {
  return {At3Mps(),
          std::make_unique<ConstantController>(0.0),
          Drivable(PlanAtSpeed(3.0)),
          {.vehicle = UnicycleParams(), .duration = 4.0},
          {},
          keeps_log};
}

TEST(SteppedLoop, FollowsTheCommandsThatItIsGiven) {
  SteppedLoop loop = UnicycleLoop();
  for (int period = 0; period < 50; ++period) {
    EXPECT_EQ(loop.input().state.time, loop.row().state.time);
    loop.Step(0.1, 0.5);
  }
  // The tolerance covers 500 additions of 0.001 to numbers below 4, each with an error of half an
  // ulp, 4.4e-16.
  EXPECT_NEAR(loop.input().state.speed, 3.5, 500 * 2.2e-16);
  const RunLog log = loop.log();
  EXPECT_EQ(log.status, DriveStatus::kInterrupted);
  ASSERT_EQ(log.rows.size(), 50U);
  EXPECT_EQ(log.rows.back().command.steering, 0.1);
  EXPECT_EQ(log.rows.back().command.acceleration, 0.5);
}

TEST(SteppedLoop, LeavesTheSpeedToThePlanWithoutAnAcceleration) {
  const Planned planned("three_turns", {"mission.start.speed=0"});
  SteppedLoop loop = planned.Loop("kinematic");
  SteppedLoop own = planned.Loop("kinematic");
  loop.Step(0.0, std::nullopt);
  own.Step();
  EXPECT_EQ(loop.row().command.acceleration, own.row().command.acceleration);
  EXPECT_GT(loop.row().command.acceleration, 0.0);
}

// The schedule of an open-loop run steers the car only if the loop's own controller steers.
TEST(SteppedLoop, GivenCommandsReplaceTheScheduleOfAnOpenLoopRun) {
  const Planned planned("three_turns", {"control.method=schedule"});
  SteppedLoop loop = planned.Loop("kinematic");
  for (int period = 0; period < 100; ++period) {
    loop.Step(-0.2, 1.0);
  }
  EXPECT_EQ(loop.row().state.steering_actuator, -0.2);
}

TEST(SteppedLoop, CanKeepTheLastRowOnly) {
  SteppedLoop loop = UnicycleLoop(false);
  StepToEnd(loop);
  const RunLog log = loop.log();
  EXPECT_EQ(log.status, DriveStatus::kArrived);
  ASSERT_EQ(log.rows.size(), 1U);
  EXPECT_EQ(log.rows[0].state.time, 4.0);
}

TEST(SteppedLoop, RefusesCommandsThatAreNotFinite) {
  SteppedLoop loop = UnicycleLoop();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(loop.Step(nan, std::nullopt), PreconditionError);
  EXPECT_THROW(loop.Step(0.0, nan), PreconditionError);
  EXPECT_EQ(loop.row().state.time, 0.0);
}

TEST(SteppedLoop, RefusesAStepAfterTheEnd) {
  SteppedLoop loop = UnicycleLoop();
  StepToEnd(loop);
  EXPECT_THROW(loop.Step(), PreconditionError);
  EXPECT_THROW(loop.Step(0.0, 0.0), PreconditionError);
}

TEST(SteppedLoop, NamesTheFunctionThatAPlantOfYourOwnLacksForACopy) {
  const SteppedLoop loop = UnicycleLoop();
  try {
    static_cast<void>(loop.Copy());
    FAIL() << "a Unicycle has no Clone";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("Plant::Clone"));
  }
}

TEST(SteppedLoop, RefusesTheRecordedDrive) {
  EXPECT_THROW(static_cast<void>(Planned("three_turns").Loop(kRecordedPlant)), InputError);
}

class EveryControllerOfTheRegistry : public testing::TestWithParam<ControllerEntry> {};

INSTANTIATE_TEST_SUITE_P(Controllers, EveryControllerOfTheRegistry,
                         testing::ValuesIn(Controllers()),
                         [](const auto& each) { return std::string(each.param.name); });

TEST_P(EveryControllerOfTheRegistry, CanBeCopied) {
  EXPECT_NE(GetParam().make(GetParam().defaults)->Clone(), nullptr);
}

}  // namespace stepped_loop_test
}  // namespace trackbed
