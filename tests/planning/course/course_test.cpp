#include "trackbed/planning/course/course.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/geometry/random.h"
#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/planning/common/course_schedule.h"
#include "trackbed/vehicle/kinematic_car.h"
#include "trackbed/vehicle/steering_schedule.h"

namespace trackbed {
namespace {

// A path is accurate to 1e-9 m over 10 km.
constexpr double kRounding = 1e-9;

TEST(Course, ArcsAndStraightsEndWhereGeometrySays) {
  // 10 m east, a quarter turn to the left with radius 20 m, 5 m north: (30, 25).
  const Path path({}, CourseSegments({.segments = {{.length = 10.0, .curvature = 0.0},
                                                   {.length = 10.0 * kPi, .curvature = 0.05},
                                                   {.length = 5.0, .curvature = 0.0}}}));
  const Pose2 end = path.At(path.length()).pose;
  EXPECT_NEAR(end.x, 30.0, Tolerance(kRounding));
  EXPECT_NEAR(end.y, 25.0, Tolerance(kRounding));
  EXPECT_NEAR(end.yaw, kPi / 2.0, Tolerance(kRounding));
}

TEST(Course, RampsTurnByTheMeanCurvature) {
  const Path path(
      {}, CourseSegments(
              {.segments = {{.length = 8.0, .curvature_from = 0.02, .curvature_to = 0.06}}}));
  EXPECT_NEAR(path.At(8.0).pose.yaw, 8.0 * 0.04, Tolerance(kRounding));
  EXPECT_NEAR(path.At(2.0).curvature, 0.03, Tolerance(1e-15));
}

TEST(Course, RampsGoOnWhereThePieceBeforeEnded) {
  const std::vector<Segment> segments =
      CourseSegments({.segments = {{.length = 4.0, .curvature_to = 0.1},
                                   {.length = 2.0, .curvature = 0.1},
                                   {.length = 4.0, .curvature_to = -0.1}}});
  EXPECT_EQ(segments[0].curvature, 0.0);
  EXPECT_EQ(segments[2].curvature, 0.1);
  EXPECT_NEAR(segments[2].CurvatureAt(4.0), -0.1, Tolerance(1e-15));
  EXPECT_EQ(SharpestCurvature(segments[0]), segments[0].CurvatureAt(4.0));
}

TEST(Course, PiecesAreEitherConstantOrRamps) {
  const auto make = [](const CoursePiece& piece) { return CourseSegments({.segments = {piece}}); };
  EXPECT_THROW(make({.length = 5.0}), InternalError);
  EXPECT_THROW(make({.length = 5.0, .curvature_from = 0.1}), InternalError);
  EXPECT_THROW(make({.length = 5.0, .curvature = 0.0, .curvature_to = 0.1}), InternalError);
  EXPECT_THROW(make({.length = 0.0, .curvature = 0.1}), InternalError);
  EXPECT_THROW(CourseSegments({}), InternalError);
}

TEST(CourseSchedule, LeadsTheKinematicCarAlong) {
  // The wheels can follow these ramps: 0.05 1/m is 0.135 rad in 5 m, 1.67 s at 3 m/s, 0.081 rad/s.
  // The remaining error: atan(L kappa) is taken as linear between knots, wrong by less than 1e-5
  // rad. That is 1e-5/L of curvature, and over the 27 m 27^2/2 * 4e-6 = 1.4 mm at the end. Within
  // each step of 1 mm the car reaches its angle early: 0.05 1/m times 0.5 mm of heading, 0.6 mm at
  // the end.
  const std::vector<Segment> segments =
      CourseSegments({.segments = {{.length = 5.0, .curvature = 0.0},
                                   {.length = 5.0, .curvature_to = 0.05},
                                   {.length = 12.0, .curvature = 0.05},
                                   {.length = 5.0, .curvature_to = 0.0}}});
  const Path path({}, segments);
  const KinematicState end =
      RollOut(ReferenceCar(), {.pose = {}, .speed = 3.0},
              CourseSchedule(ReferenceCar(), segments, 3.0), path.length(), 1e-3);
  EXPECT_NEAR((end.pose.position() - path.At(path.length()).pose.position()).norm(), 0.0,
              Tolerance(2e-3));
}

TEST(CourseSchedule, DrivesAStepAsARampAboutIt) {
  const std::vector<Segment> segments = CourseSegments(
      {.segments = {{.length = 20.0, .curvature = 0.0}, {.length = 20.0, .curvature = 0.05}}});
  const SteeringSchedule schedule = CourseSchedule(ReferenceCar(), segments, 3.0);
  const double steering = std::atan(2.7 * 0.05);
  const double half_ramp = 0.5 * 3.0 * steering / ReferenceCar().steering_rate;
  ASSERT_EQ(schedule.knots().size(), 4U);
  EXPECT_NEAR(schedule.At(20.0), 0.5 * steering, Tolerance(1e-12));
  EXPECT_NEAR(schedule.knots()[1].distance, 20.0 - half_ramp, Tolerance(1e-12));
  EXPECT_NEAR(schedule.knots()[2].distance, 20.0 + half_ramp, Tolerance(1e-12));
  EXPECT_NEAR(schedule.At(40.0), steering, Tolerance(1e-15));
}

TEST(CourseSchedule, TakesRoundingOfTheCurvatureForNoRamp) {
  // A spiral in pieces of 0.25 m, whose curvatures are rounded to 1e-15 1/m. The knots of a ramp
  // for a step of 1e-15 rad would be closer than two doubles at 44 m.
  constexpr double kSharpness = 0.005;
  std::vector<Segment> segments{{.length = 40.0}};
  Random random(3);
  for (int i = 0; i < 100; ++i) {
    segments.push_back({.length = 0.25,
                        .curvature = 0.25 * kSharpness * i + random.Uniform(-1e-15, 1e-15),
                        .sharpness = kSharpness});
  }
  const SteeringSchedule schedule = CourseSchedule(ReferenceCar(), segments, 3.0);
  const std::vector<SteeringSchedule::Knot>& knots = schedule.knots();
  for (std::size_t i = 1; i < knots.size(); ++i) {
    const double slope =
        (knots[i].steering - knots[i - 1].steering) / (knots[i].distance - knots[i - 1].distance);
    // d atan(L kappa)/ds <= L dkappa/ds
    EXPECT_LE(std::abs(slope), ReferenceCar().wheelbase * kSharpness * (1.0 + Tolerance(1e-9)));
  }
}

TEST(CourseSchedule, RisesHoweverShortThePiecesAre) {
  const std::vector<Segment> segments =
      CourseSegments({.segments = {{.length = 0.1, .curvature = 0.1},
                                   {.length = 0.2, .curvature = -0.1},
                                   {.length = 0.1, .curvature = 0.1},
                                   {.length = 30.0, .curvature = 0.0}}});
  // Through() would reject knots that the wheels cannot follow.
  EXPECT_NEAR(CourseSchedule(ReferenceCar(), segments, 20.0).At(40.0), 0.0, Tolerance(1e-15));
}

}  // namespace
}  // namespace trackbed
