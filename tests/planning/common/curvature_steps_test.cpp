#include "trackbed/planning/common/curvature_steps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/planning/common/course_schedule.h"
#include "trackbed/planning/course/course.h"
#include "trackbed/vehicle/steering_schedule.h"

namespace trackbed {
namespace {

TEST(StepSpeed, LeadsOffByTheDeviation) {
  // The test measures the offset at the end of the steering ramp, S/2 = 2.45 m after the step. The
  // formula for kStepDeviation assumes that the curvature is linear on the ramp. Because tan(delta)
  // is convex, the ramp turns the car by (-ln cos delta)/(delta tan delta) = 0.494 of kappa S, not
  // by half of it. The difference of the heading is 0.003 rad, which is an offset of 0.007 m over
  // S/2. The cosines of angles up to 0.12 rad change the offset by less than 1 %.
  const double curvature = 0.1;
  const double speed = StepSpeed(ReferenceCar(), 0.0, curvature);
  const std::vector<Segment> segments{{.length = 20.0}, {.length = 10.0, .curvature = curvature}};
  const Path path({}, segments);
  const KinematicState end = RollOut(ReferenceCar(), {.pose = {}, .speed = speed},
                                     CourseSchedule(ReferenceCar(), segments, speed), 22.5, 1e-3);
  const double off = std::abs(path.Project(end.pose).cross_track);
  EXPECT_NEAR(off, kStepDeviation, 0.1 * kStepDeviation);
}

TEST(StepSpeed, IsInfiniteWithoutAStep) {
  EXPECT_EQ(StepSpeed(ReferenceCar(), 0.1, 0.1), std::numeric_limits<double>::infinity());
  EXPECT_EQ(StepSpeed(ReferenceCar(), 0.0, 0.15), StepSpeed(ReferenceCar(), 0.0, -0.15));
}

TEST(PlanSteps, CapsLieAboutTheStepsAndNotAtCusps) {
  const std::vector<Segment> segments{{.length = 20.0},
                                      {.length = 10.0, .curvature = 0.1},
                                      {.length = 5.0, .curvature = -0.1, .direction = -1},
                                      {.length = 20.0, .curvature = 0.0, .direction = -1}};
  const StepSpeeds steps = PlanSteps(ReferenceCar(), segments, 0.5);
  const std::vector<SpeedCap>& caps = steps.caps;
  ASSERT_EQ(caps.size(), 2U);
  EXPECT_TRUE(steps.stops.empty());
  EXPECT_NEAR(0.5 * (caps[0].from + caps[0].to), 20.0, Tolerance(1e-12));
  EXPECT_NEAR(0.5 * (caps[1].from + caps[1].to), 35.0, Tolerance(1e-12));
  EXPECT_EQ(caps[0].speed, StepSpeed(ReferenceCar(), 0.0, 0.1));
  EXPECT_NEAR(caps[0].to - caps[0].from,
              caps[0].speed * std::atan(0.27) / ReferenceCar().steering_rate, Tolerance(1e-12));
  EXPECT_EQ(PlanSteps(ReferenceCar(), segments, 2.9).caps[0].speed, 2.9);
}

TEST(PlanSteps, KeepRampsApartAndStopWhereTheyWouldOverlap) {
  // The two steps are 0.5 m apart. The wheels must complete the first step before the second step
  // begins, which is possible up to the speed 0.5 m x omega/atan(0.27) = 0.285 m/s, where omega is
  // the steering rate.
  const std::vector<Segment> segments{
      {.length = 20.0}, {.length = 0.5, .curvature = 0.1}, {.length = 20.0}};
  const double room = 0.5 * ReferenceCar().steering_rate / std::atan(0.27);
  const StepSpeeds slow = PlanSteps(ReferenceCar(), segments, 0.1);
  ASSERT_EQ(slow.caps.size(), 2U);
  EXPECT_NEAR(slow.caps[0].speed, room, Tolerance(1e-12));
  EXPECT_NEAR(slow.caps[0].to, slow.caps[1].from, Tolerance(1e-12));
  const StepSpeeds stops = PlanSteps(ReferenceCar(), segments, 1.01 * room);
  EXPECT_TRUE(stops.caps.empty());
  EXPECT_EQ(stops.stops, (std::vector<double>{20.0, 20.5}));
}

TEST(RampsOfSteps, AskForTheSteeringRateAndNoMore) {
  // The segments are random arcs and straights. On every ramp, the wheels must turn at their full
  // rate at the reported speed. The ramps must be ordered, disjoint, and within half of the
  // adjacent segments.
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int i = 0; i < 200; ++i) {
    std::vector<Segment> segments;
    std::vector<double> joints{0.0};
    for (int k = 0; k < 6; ++k) {
      segments.push_back(
          {.length = 0.2 + 8.0 * unit(random), .curvature = 0.36 * (unit(random) - 0.5)});
      joints.push_back(joints.back() + segments.back().length);
    }
    double end = 0.0;
    for (const SteeringRamp& ramp : RampsOfSteps(ReferenceCar(), segments, 3.0)) {
      EXPECT_NEAR(ramp.speed * ramp.steering / (ramp.to - ramp.from), ReferenceCar().steering_rate,
                  Tolerance(1e-9));
      EXPECT_LE(ramp.speed, 3.0);
      EXPECT_GE(ramp.from, end - Tolerance(1e-12));
      end = ramp.to;
      const auto joint = std::lower_bound(joints.begin(), joints.end(), ramp.joint - 1e-9);
      EXPECT_GE(ramp.from, 0.5 * (*(joint - 1) + *joint) - Tolerance(1e-9));
      EXPECT_LE(ramp.to, 0.5 * (*joint + *(joint + 1)) + Tolerance(1e-9));
    }
  }
}

}  // namespace
}  // namespace trackbed
