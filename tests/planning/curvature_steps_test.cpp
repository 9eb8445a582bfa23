#include "trackbed/planning/curvature_steps.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/tolerance.h"
#include "tests/vehicle/seed_car.h"
#include "trackbed/planning/course.h"
#include "trackbed/vehicle/steering_schedule.h"

namespace trackbed {
namespace {

TEST(StepSpeed, LeadsOffByTheDeviation) {
  // Where the ramp ends, half of S = 4.9 m after the step. The formula takes the curvature of the
  // ramp for linear; but tan(delta) is convex, so that the ramp turns (-ln cos delta)/(delta tan
  // delta) = 0.494 of kappa S instead of a half: 0.003 rad short, 0.007 m over S/2. The rest is
  // cosines of 0.12 rad, below 1 %.
  const double curvature = 0.1;
  const double speed = StepSpeed(SeedCar(), 0.0, curvature);
  const std::vector<Segment> segments{{.length = 20.0}, {.length = 10.0, .curvature = curvature}};
  const Path path({}, segments);
  const KinematicState end = RollOut(SeedCar(), {.pose = {}, .speed = speed},
                                     CourseSchedule(SeedCar(), segments, speed), 22.5, 1e-3);
  const double off = std::abs(path.Project(end.pose).cross_track);
  EXPECT_NEAR(off, kStepDeviation, 0.1 * kStepDeviation);
}

TEST(StepSpeed, IsInfiniteWithoutAStep) {
  EXPECT_EQ(StepSpeed(SeedCar(), 0.1, 0.1), std::numeric_limits<double>::infinity());
  EXPECT_EQ(StepSpeed(SeedCar(), 0.0, 0.15), StepSpeed(SeedCar(), 0.0, -0.15));
}

TEST(CapsOfSteps, LieAboutTheStepsAndNotAtCusps) {
  const std::vector<Segment> segments{{.length = 20.0},
                                      {.length = 10.0, .curvature = 0.1},
                                      {.length = 5.0, .curvature = -0.1, .direction = -1},
                                      {.length = 20.0, .curvature = 0.0, .direction = -1}};
  const std::vector<SpeedCap> caps = CapsOfSteps(SeedCar(), segments, 0.5);
  ASSERT_EQ(caps.size(), 2U);
  EXPECT_NEAR(0.5 * (caps[0].from + caps[0].to), 20.0, Tolerance(1e-12));
  EXPECT_NEAR(0.5 * (caps[1].from + caps[1].to), 35.0, Tolerance(1e-12));
  EXPECT_EQ(caps[0].speed, StepSpeed(SeedCar(), 0.0, 0.1));
  EXPECT_NEAR(caps[0].to - caps[0].from, caps[0].speed * std::atan(0.27) / SeedCar().steering_rate,
              Tolerance(1e-12));
  EXPECT_EQ(CapsOfSteps(SeedCar(), segments, 2.9)[0].speed, 2.9);
}

TEST(CapsOfSteps, KeepRampsApart) {
  // Half a metre between two steps: the wheels turn by the first before the second is due.
  const std::vector<Segment> segments{
      {.length = 20.0}, {.length = 0.5, .curvature = 0.1}, {.length = 20.0}};
  const std::vector<SpeedCap> caps = CapsOfSteps(SeedCar(), segments, 0.1);
  ASSERT_EQ(caps.size(), 2U);
  EXPECT_NEAR(caps[0].speed, 0.5 * SeedCar().steering_rate / std::atan(0.27), Tolerance(1e-12));
  EXPECT_NEAR(caps[0].to, caps[1].from, Tolerance(1e-12));
}

TEST(CapsOfSteps, CountAStartOnAnArcAsAStep) {
  const std::vector<SpeedCap> caps =
      CapsOfSteps(SeedCar(), {{.length = 20.0, .curvature = 0.15}}, 0.5);
  ASSERT_EQ(caps.size(), 1U);
  EXPECT_EQ(caps[0].from, 0.0);
}

}  // namespace
}  // namespace trackbed
