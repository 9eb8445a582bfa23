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

// The accuracy of a path of 10 km [m], as stated by Path.
constexpr double kRounding = 1e-9;

TEST(Course, ArcsAndStraightsEndWhereGeometrySays) {
  // The course leads 10 m to the east, along a quarter circle of radius 20 m to the left, and 5 m
  // to the north. It ends at (30, 25).
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
  // The wheels can follow these ramps: at 3 m/s, the steering angle changes by 0.135 rad within 5
  // m, that is within 1.67 s, at 0.081 rad/s. Two errors remain. First, the schedule interpolates
  // atan(L kappa) linearly between knots, which causes a steering error below 1e-5 rad. The
  // resulting curvature error of 1e-5/L = 4e-6 1/m moves the end of the path by 27^2/2 x 4e-6 = 1.4
  // mm over 27 m. Second, the car reaches its steering angle up to 0.5 mm early within each step of
  // 1 mm. At a curvature of 0.05 1/m, this is a heading error of 0.05 x 0.5 mm, which moves the end
  // of the path by 0.6 mm.
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
  // The path is a spiral in pieces of 0.25 m, whose curvatures are rounded to 1e-15 1/m. A ramp for
  // a step of 1e-15 rad would have knots that are closer than two neighboring double values at 44
  // m.
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
    // The slope of the schedule is d atan(L kappa)/ds, which is at most L dkappa/ds.
    EXPECT_LE(std::abs(slope), ReferenceCar().wheelbase * kSharpness * (1.0 + Tolerance(1e-9)));
  }
}

TEST(CourseSchedule, RisesHoweverShortThePiecesAre) {
  const std::vector<Segment> segments =
      CourseSegments({.segments = {{.length = 0.1, .curvature = 0.1},
                                   {.length = 0.2, .curvature = -0.1},
                                   {.length = 0.1, .curvature = 0.1},
                                   {.length = 30.0, .curvature = 0.0}}});
  // SteeringSchedule::Through would reject knots that the wheels cannot follow.
  EXPECT_NEAR(CourseSchedule(ReferenceCar(), segments, 20.0).At(40.0), 0.0, Tolerance(1e-15));
}

}  // namespace
}  // namespace trackbed
