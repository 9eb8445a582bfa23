#include "trackbed/planning/avoidance/avoidance.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "tests/geometry/random.h"
#include "tests/planning/obstacle_turns.h"
#include "tests/support/case_names.h"
#include "tests/support/obstacle_cases.h"
#include "tests/tolerance.h"
#include "trackbed/planning/common/plan.h"

// Tests how the planner avoids obstacles in turns with Bezier curves: clearance computed by
// Boost.Geometry, continuity, steering limits, mirror symmetry, and random turns with obstacles.
namespace trackbed {
namespace {

/// Returns the largest steering rate of a car that drives along the path without error [rad/s].
/// Computes mean rates over intervals of 0.1 m. A mean rate cannot exceed the largest rate within
/// the interval.
double MaxSteeringRate(const Plan& plan, const VehicleParams& car, Stations within) {
  const Path& path = plan.reference.path;
  double fastest = 0.0;
  for (double s = within.from; s + 0.1 <= within.to; s += 0.1) {
    const double turned = SteeringForCurvature(car, path.At(s + 0.1).curvature) -
                          SteeringForCurvature(car, path.At(s).curvature);
    fastest = std::max(fastest, std::abs(turned) / 0.1 * plan.reference.speed.SpeedAt(s));
  }
  return fastest;
}

/// Checks a rerouted plan against all its guarantees.
void ExpectSafe(const Plan& plan, const Plan& global, const std::vector<OrientedBox>& obstacles,
                const BezierAvoidanceOptions& options) {
  const VehicleParams car = ReferenceCar();
  const Path& path = plan.reference.path;
  EXPECT_GE(PathClearance(path, obstacles, car, {}),
            options.safe_distance - Tolerance(kClearanceTolerance));
  ASSERT_FALSE(plan.diagnostics.avoided.empty());
  const nlohmann::json stretches = DiagnosticsJson(plan)["avoid"];
  for (const nlohmann::json& stretch : stretches) {
    const Stations curve{stretch["leave_s_m"].get<double>(), stretch["return_s_m"].get<double>()};
    EXPECT_GE(PathClearance(path, obstacles, car, curve),
              options.safe_distance - Tolerance(kBetweenSamples));
    // The position, heading and curvature must be continuous where the curve joins the plan.
    for (const double s : {curve.from, curve.to}) {
      if (s > 0.0 && s < path.length()) {
        constexpr double kAside = 1e-7;  // The offset of a sample from the joint [m]. Over this
                                         // length, the curvature may change by 0.02 x 1e-7 1/m.
        const PathPoint left = path.At(s - kAside);
        const PathPoint right = path.At(s + kAside);
        EXPECT_NEAR(left.curvature, right.curvature, Tolerance(1e-7)) << "at s = " << s;
        EXPECT_NEAR(left.pose.yaw, right.pose.yaw, Tolerance(1e-7)) << "at s = " << s;
        EXPECT_NEAR((left.pose.position() - right.pose.position()).norm(), 2.0 * kAside,
                    Tolerance(1e-10))
            << "at s = " << s;
      }
    }
    for (double s = curve.from; s < curve.to; s += 0.05) {
      EXPECT_LE(std::abs(SteeringForCurvature(car, path.At(s).curvature)), car.steering_limit);
    }
    EXPECT_LE(MaxSteeringRate(plan, car, curve), car.steering_rate);
  }
  // Approximating the curve by path segments displaces the path after the curve; SegmentsThrough
  // states this error.
  const Vec2 end = path.At(path.length()).pose.position();
  const Vec2 goal = global.reference.path.At(global.reference.path.length()).pose.position();
  EXPECT_LE((end - goal).norm(), Tolerance(1e-6));
}

class ObstacleInTurn : public testing::TestWithParam<ObstacleCase> {};

INSTANTIATE_TEST_SUITE_P(Cases, ObstacleInTurn, testing::ValuesIn(AllObstacleCases()), CaseName);

TEST_P(ObstacleInTurn, IsPassedSafelyOnTheSideAskedFor) {
  const ObstacleCase& c = GetParam();
  const Course course{.turn = c.side * (0.5 * kPi - c.reduction)};
  const Plan global = course.Global();
  ASSERT_TRUE(global.ok()) << global.reason;
  const Pose2 at = course.OnArc(c.sixth / 6.0);
  const OrientedBox obstacle{{at.x, at.y, 0.0}, 2.0, 2.0};  // The obstacle is aligned with the
                                                            // axes, as in the listing.
  BezierAvoidanceOptions options;
  options.passing_side = c.passing_side;

  const Plan plan = Around(global, {obstacle}, options);
  ASSERT_EQ(plan.blocked, "");
  ExpectSafe(plan, global, {obstacle}, options);
  EXPECT_TRUE(plan.caps.empty()) << "there is room to pass at full speed";

  // On the inner side, the path must pass between the obstacle and the turn's center. On the outer
  // side, the path must pass farther from the center than the obstacle.
  const Vec2 center{course.before, c.side * course.radius};
  const Path& path = plan.reference.path;
  double beside = 0.0;
  double nearest = std::numeric_limits<double>::infinity();
  for (double s = 0.0; s < path.length(); s += 0.1) {
    const Vec2 p = path.At(s).pose.position() - center;
    const double along = std::abs(Cross((at.position() - center).normalized(), p));
    if (along < nearest && p.dot(at.position() - center) > 0.0) {
      nearest = along;
      beside = p.norm();
    }
  }
  EXPECT_EQ(c.passing_side == PassingSideChoice::kInner, beside < course.radius) << beside;
}

TEST(PlanAround, AMirroredRouteGetsTheMirroredPlan) {
  const Course left;
  const Course right{.turn = -0.5 * kPi};
  const Pose2 at = left.OnArc(0.4);
  const Plan plan = Around(left.Global(), {{{at.x, at.y, 0.3}, 3.0, 1.5}});
  const Plan mirrored = Around(right.Global(), {{{at.x, -at.y, -0.3}, 3.0, 1.5}});
  ASSERT_EQ(plan.blocked, "");
  // For a right turn, the planner computes the tree and the curve of the mirrored problem, so the
  // results are mirror images.
  ASSERT_NEAR(plan.reference.path.length(), mirrored.reference.path.length(), Tolerance(1e-9));
  for (double s = 0.0; s < plan.reference.path.length(); s += 1.0) {
    const Pose2 a = plan.reference.path.At(s).pose;
    const Pose2 b = mirrored.reference.path.At(s).pose;
    EXPECT_NEAR(a.x, b.x, Tolerance(1e-9));
    EXPECT_NEAR(a.y, -b.y, Tolerance(1e-9));
  }
}

/// Returns a row of boxes from the obstacle outward. The gaps between the boxes are 1 m wide, too
/// narrow for the car.
std::vector<OrientedBox> WithWall(const Course& course, double share, double toward_center) {
  const Pose2 at = course.OnArc(share);
  std::vector<OrientedBox> boxes;
  for (int i = 0; i < 30; ++i) {
    const Vec2 p = ToWorld(at, {0.0, toward_center * 3.0 * i});
    boxes.push_back({{p.x(), p.y(), at.yaw}, 2.0, 2.0});
  }
  return boxes;
}

TEST(PlanAround, TakesTheOnlyRingThatIsFree) {
  const Course course;
  const Plan global = course.Global();
  // The turn's center is on the left side of the path.
  const Plan outer = Around(global, WithWall(course, 0.5, 1.0));
  ASSERT_EQ(outer.blocked, "");
  EXPECT_EQ(DiagnosticsJson(outer)["avoid"][0]["passing_side"], "outer");
  const Plan inner = Around(global, WithWall(course, 0.5, -1.0));
  ASSERT_EQ(inner.blocked, "");
  EXPECT_EQ(DiagnosticsJson(inner)["avoid"][0]["passing_side"], "inner");
}

TEST(PlanAround, StopsBeforeWhatItFindsNoWayAround) {
  const Course course;
  const Plan global = course.Global();
  std::vector<OrientedBox> wall = WithWall(course, 0.5, 1.0);
  const std::vector<OrientedBox> other = WithWall(course, 0.5, -1.0);
  wall.insert(wall.end(), other.begin(), other.end());
  BezierAvoidanceOptions options;
  options.rrt_iterations = 300;
  options.min_speed = 2.0;
  const Plan plan = Around(global, wall, options);
  EXPECT_THAT(plan.blocked, testing::StartsWith("stops before the obstacle at ("));
  EXPECT_THAT(plan.blocked, testing::HasSubstr("no feasible curve on either side at 2 m/s"));
  EXPECT_EQ(DiagnosticsJson(plan)["blocked"], plan.blocked);
  EXPECT_TRUE(plan.ok()) << "the way there can be driven";
  const Path& path = plan.reference.path;
  EXPECT_GE(PathClearance(path, wall, ReferenceCar(), {}),
            kDistance - Tolerance(kClearanceTolerance));
  EXPECT_LE(PathClearance(path, wall, ReferenceCar(), {}), kDistance + 0.3);
  EXPECT_EQ(plan.reference.speed.SpeedAt(path.length()), 0.0);
  EXPECT_EQ(plan.goal, global.goal);
}

TEST(PlanAround, PassesSeveralObstaclesOneAfterTheOther) {
  const Plan global = Course{.before = 120.0}.Global();
  const std::vector<OrientedBox> obstacles{{{35.0, 0.5, 0.2}, 2.0, 2.0},
                                           {{90.0, -0.5, -0.4}, 1.0, 3.0}};
  const BezierAvoidanceOptions options;
  const Plan plan = Around(global, obstacles, options);
  ASSERT_EQ(plan.blocked, "");
  EXPECT_EQ(plan.diagnostics.avoided.size(), 2U);
  ExpectSafe(plan, global, obstacles, options);
}

TEST(PlanAround, StartsAtTheCarsPoseAndSteering) {
  const Course course;
  const Plan global = course.Global();
  const VehicleParams vehicle = ReferenceCar();
  const Pose2 at = course.OnArc(0.6);
  const std::vector<OrientedBox> obstacles{{{at.x, at.y, 0.0}, 2.0, 2.0}};
  // The car is on the straight 12.7 m before the arc. The car is 0.08 m beside the path, and its
  // wheels point slightly to the right.
  const AvoidanceRequest::Car car{{30.0, 0.08, 0.01}, -0.02};
  const Plan plan = PlanAround({.vehicle = vehicle,
                                .plan = global,
                                .speed = kLimits,
                                .obstacles = obstacles,
                                .station = 30.0,
                                .station_speed = 2.9,
                                .car = car,
                                .seed = 1},
                               BezierAvoidanceOptions{});
  ASSERT_EQ(plan.blocked, "");
  const PathPoint start = plan.reference.path.At(0.0);
  EXPECT_EQ(start.pose, car.pose);
  EXPECT_NEAR(SteeringForCurvature(vehicle, start.curvature), car.steering, Tolerance(1e-12));
  EXPECT_NEAR(plan.schedule.At(0.0), car.steering, Tolerance(1e-12));
  EXPECT_EQ(plan.reference.speed.SpeedAt(0.0), 2.9);
  ExpectSafe(plan, global, obstacles, {});
}

TEST(PlanAround, AnObstacleFarAheadOfTheCarLeavesItsPathUntilThen) {
  const Course course{.before = 150.0};
  const Plan global = course.Global();
  const Pose2 at = course.OnArc(0.5);
  const Plan plan = PlanAround({.vehicle = ReferenceCar(),
                                .plan = global,
                                .speed = kLimits,
                                .obstacles = {{{at.x, at.y, 0.0}, 2.0, 2.0}},
                                .station = 30.0,
                                .station_speed = kSpeed,
                                .car = AvoidanceRequest::Car{{30.0, 0.08, 0.01}, -0.02},
                                .seed = 1},
                               BezierAvoidanceOptions{});
  ASSERT_EQ(plan.blocked, "");
  EXPECT_GT(DiagnosticsJson(plan)["avoid"][0]["leave_s_m"].get<double>(), 90.0);
  EXPECT_EQ(plan.reference.path.At(0.0).pose, global.reference.path.At(30.0).pose);
}

TEST(PlanAround, SlowsDownWhereTheWheelsWouldTurnTooSlowly) {
  // The turn begins 8 m from the start. The obstacle is wide and 4 m behind the start of the turn.
  const Course course{.radius = 15.0, .before = 8.0, .turn = 1.2, .after = 40.0};
  const Plan global = course.Global();
  const Pose2 at = course.OnArc(4.0 / (15.0 * 1.2));
  const std::vector<OrientedBox> obstacles{{{at.x, at.y, at.yaw}, 2.0, 3.0}};
  const Plan plan = Around(global, obstacles);
  ASSERT_EQ(plan.blocked, "");
  ASSERT_EQ(plan.caps.size(), 1U);
  EXPECT_LT(plan.caps[0].speed, kSpeed);
  ExpectSafe(plan, global, obstacles, {});
  for (double s = plan.caps[0].from; s < plan.caps[0].to; s += 0.5) {
    EXPECT_LE(plan.reference.speed.SpeedAt(s),
              std::max(plan.caps[0].speed, std::sqrt(kSpeed * kSpeed - 2.0 * s)) + 1e-9);
  }
}

/// The tests plan 500 random turns in ten batches. Each plan must be safe or give a reason; a plan
/// that is not safe must not be reported as ok.
class RandomObstacles : public testing::TestWithParam<int> {};

INSTANTIATE_TEST_SUITE_P(Batches, RandomObstacles, testing::Range(0, 10), kNamedByParameter);

TEST_P(RandomObstacles, ArePassedSafelyOrStoppedBefore) {
  Random random(static_cast<std::uint64_t>(100 + GetParam()));
  int passed = 0;
  for (int i = 0; i < 50; ++i) {
    SCOPED_TRACE("case " + std::to_string(i));
    const Course course{.radius = random.Uniform(12.0, 60.0),
                        .before = random.Uniform(5.0, 60.0),
                        .turn = random.Uniform(0.5, 1.8) * (random.Below(2) == 0 ? 1.0 : -1.0),
                        .after = random.Uniform(5.0, 60.0)};
    const Plan global = course.Global();
    if (!global.ok()) {
      // With this obstacle, the wheels would have to turn before the car starts.
      ASSERT_EQ(global.status, PlanStatus::kSteersBeforeStart) << global.reason;
      continue;
    }
    const Pose2 arc = course.OnArc(random.Uniform(0.0, 1.0));
    const Vec2 center = ToWorld(arc, {0.0, random.Uniform(-2.0, 2.0)});
    const OrientedBox obstacle{{center.x(), center.y(), random.Uniform(-kPi, kPi)},
                               random.Uniform(0.5, 6.0),
                               random.Uniform(0.5, 6.0)};
    BezierAvoidanceOptions options;
    options.safe_distance = random.Uniform(0.5, 3.0);
    options.rrt_iterations = 300;
    options.min_speed = 2.5;
    options.search.evaluations = 500;
    const Plan plan = Around(global, {obstacle}, options);
    if (!plan.blocked.empty()) {
      EXPECT_THAT(plan.blocked,
                  testing::AnyOf(testing::HasSubstr("no feasible curve on "),
                                 testing::HasSubstr("the path ends beside the obstacle")));
      EXPECT_EQ(plan.reference.speed.SpeedAt(plan.reference.path.length()), 0.0);
      continue;
    }
    if (plan.diagnostics.avoided.empty()) {
      EXPECT_GE(PathClearance(plan.reference.path, {obstacle}, ReferenceCar(), {}),
                options.safe_distance - Tolerance(kClearanceTolerance));
      continue;
    }
    ++passed;
    ExpectSafe(plan, global, {obstacle}, options);
  }
  // Most turns have enough room. Only a few obstacles are too close to the start or the end.
  EXPECT_GE(passed, 40);
}

}  // namespace
}  // namespace trackbed
