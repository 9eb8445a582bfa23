#include "trackbed/planning/avoidance/avoidance.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <boost/geometry.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/geometries/polygon.hpp>
#include <cmath>
#include <limits>

#include "tests/geometry/random.h"
#include "tests/planning/routes.h"
#include "tests/support/obstacle_cases.h"
#include "tests/tolerance.h"
#include "tests/vehicle/seed_car.h"
#include "trackbed/core/angle.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/fillet/fillet.h"
#include "trackbed/planning/registry/planners.h"
#include "trackbed/world/world.h"

namespace trackbed {
namespace {

constexpr double kSpeed = 3.0;     // [m/s]
constexpr double kDistance = 1.5;  // SD [m]
const SpeedLimits kLimits{kSpeed, 1.0, 1.0};

/// Clearance by another library than the planner's: rings of corners, Boost.Geometry's distance.
double ByBoost(const OrientedBox& a, const OrientedBox& b) {
  using Point = boost::geometry::model::d2::point_xy<double>;
  using Polygon = boost::geometry::model::polygon<Point, false, true>;
  const auto polygon_of = [](const OrientedBox& box) {
    Polygon polygon;
    for (const Vec2& corner : box.Corners()) {
      polygon.outer().emplace_back(corner.x(), corner.y());
    }
    polygon.outer().push_back(polygon.outer().front());
    return polygon;
  };
  return boost::geometry::distance(polygon_of(a), polygon_of(b));
}

/// The car on the path at a station; its outline is laid out anew from the car's numbers.
OrientedBox OutlineOn(const Path& path, double s, const VehicleParams& car) {
  const Pose2 rear = path.At(s).pose;
  const double ahead = 0.5 * car.length - car.rear_overhang;
  return {{rear.x + ahead * std::cos(rear.yaw), rear.y + ahead * std::sin(rear.yaw), rear.yaw},
          car.length,
          car.width};
}

double ClearanceOf(const Path& path, const std::vector<OrientedBox>& obstacles,
                   const VehicleParams& car, Stations within) {
  double clearance = std::numeric_limits<double>::infinity();
  for (double s = std::max(within.from, 0.0); s <= std::min(within.to, path.length()); s += 0.02) {
    for (const OrientedBox& obstacle : obstacles) {
      clearance = std::min(clearance, ByBoost(OutlineOn(path, s, car), obstacle));
    }
  }
  return clearance;
}

/// Where the planner's own samples lie 0.05 m apart, the outline between them comes closer by at
/// most what a corner 3.7 m from the rear axle moves in half of that while the heading turns at
/// full lock, 0.025 m x 3.7/5.1, times the angle of its way to the obstacle's side; next to a
/// minimum that angle is zero, and the loss quadratic: 0.025^2 x (1/5.1 + 1/3.7)/2.
constexpr double kBetweenSamples = 2e-4;  // [m]
/// A plan's own stretches count as clear when they miss SD by half a millimeter.
constexpr double kTouch = 5e-4 + kBetweenSamples;

/// One turn of radius r between two straights, and what stands in it.
struct Course {
  double radius = 20.0;
  double before = 42.7;  ///< straight, from the start to the arc [m]
  double turn = 0.5 * kPi;
  double after = 42.7;

  [[nodiscard]] std::vector<Vec2> Waypoints() const {
    const double tangent = radius * std::tan(0.5 * std::abs(turn));
    const Vec2 corner{before + tangent, 0.0};
    return {{0.0, 0.0}, corner, corner + (after + tangent) * Direction(turn)};
  }

  [[nodiscard]] Plan Global() const {
    FilletOptions options;
    options.radius = radius;
    options.constraint = RadiusConstraint::kNone;
    return MakePlan({.vehicle = SeedCar(),
                     .waypoints = Waypoints(),
                     .start_speed = kSpeed,
                     .speed = kLimits,
                     .seed = 0},
                    options);
  }

  /// Of the arc, at a share of it.
  [[nodiscard]] Pose2 OnArc(double share) const {
    return Global().reference.path.At(before + share * radius * std::abs(turn)).pose;
  }
};

Plan Around(const Plan& plan, const std::vector<OrientedBox>& obstacles,
            const BezierAvoidanceOptions& options = {}) {
  return PlanAround({.vehicle = SeedCar(),
                     .plan = plan,
                     .speed = kLimits,
                     .obstacles = obstacles,
                     .station = 0.0,
                     .station_speed = kSpeed,
                     .car = {},
                     .seed = 1},
                    options);
}

/// The rate at which an ideal drive of the path turns its wheels, from differences of the angle
/// over stretches of 0.1 m, in the mean over each of which the rate cannot be larger than within.
double SteeringRateOf(const Plan& plan, const VehicleParams& car, Stations within) {
  const Path& path = plan.reference.path;
  double fastest = 0.0;
  for (double s = within.from; s + 0.1 <= within.to; s += 0.1) {
    const double turned = SteeringForCurvature(car, path.At(s + 0.1).curvature) -
                          SteeringForCurvature(car, path.At(s).curvature);
    fastest = std::max(fastest, std::abs(turned) / 0.1 * plan.reference.speed.SpeedAt(s));
  }
  return fastest;
}

/// Holds a plan that has been led around obstacles against everything that it claims.
void ExpectSafe(const Plan& plan, const Plan& global, const std::vector<OrientedBox>& obstacles,
                const BezierAvoidanceOptions& options) {
  const VehicleParams car = SeedCar();
  const Path& path = plan.reference.path;
  EXPECT_GE(ClearanceOf(path, obstacles, car, {}), options.safe_distance - Tolerance(kTouch));
  ASSERT_TRUE(plan.diagnostics.contains("avoid"));
  for (const nlohmann::json& stretch : plan.diagnostics["avoid"]) {
    const Stations curve{stretch["leave_s_m"].get<double>(), stretch["return_s_m"].get<double>()};
    EXPECT_GE(ClearanceOf(path, obstacles, car, curve),
              options.safe_distance - Tolerance(kBetweenSamples));
    // The curvature between two pieces of the path is that of the curve: joined without a jump.
    for (const double s : {curve.from, curve.to}) {
      if (s > 0.0 && s < path.length()) {
        constexpr double kAside = 1e-7;  // [m]; within it the curvature may change by 0.02 x 1e-7
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
    EXPECT_LE(SteeringRateOf(plan, car, curve), car.steering_rate);
  }
  // The rest of the way moves by what the curve's pieces of path miss: see SegmentsThrough.
  const Vec2 end = path.At(path.length()).pose.position();
  const Vec2 goal = global.reference.path.At(global.reference.path.length()).pose.position();
  EXPECT_LE((end - goal).norm(), Tolerance(1e-6));
}

class ObstacleInTurn : public testing::TestWithParam<ObstacleCase> {};

INSTANTIATE_TEST_SUITE_P(Cases, ObstacleInTurn, testing::ValuesIn(AllObstacleCases()), NameOf);

TEST_P(ObstacleInTurn, IsPassedSafelyOnTheSideAskedFor) {
  const ObstacleCase& c = GetParam();
  const Course course{.turn = c.side * (0.5 * kPi - c.reduction)};
  const Plan global = course.Global();
  ASSERT_TRUE(global.ok()) << global.reason;
  const Pose2 at = course.OnArc(c.sixth / 6.0);
  const OrientedBox obstacle{{at.x, at.y, 0.0}, 2.0, 2.0};  // along the axes, as in the listing
  BezierAvoidanceOptions options;
  options.ring = c.ring;

  const Plan plan = Around(global, {obstacle}, options);
  ASSERT_EQ(plan.blocked, "");
  ExpectSafe(plan, global, {obstacle}, options);
  EXPECT_TRUE(plan.caps.empty()) << "there is room to pass at full speed";

  // Beside the obstacle the path runs nearer to the turn's center, or farther from it, than the
  // obstacle does.
  const Vec2 centre{course.before, c.side * course.radius};
  const Path& path = plan.reference.path;
  double beside = 0.0;
  double nearest = std::numeric_limits<double>::infinity();
  for (double s = 0.0; s < path.length(); s += 0.1) {
    const Vec2 p = path.At(s).pose.position() - centre;
    const double along = std::abs(Cross((at.position() - centre).normalized(), p));
    if (along < nearest && p.dot(at.position() - centre) > 0.0) {
      nearest = along;
      beside = p.norm();
    }
  }
  EXPECT_EQ(c.ring == RingChoice::kInner, beside < course.radius) << beside;
}

TEST(PlanAround, LeavesAPlanThatNothingStandsInTheWayOf) {
  const Plan global = Course{}.Global();
  // The car is 1.725 m wide: its side is 1.5 m from a box whose side is 2.3625 m off the path.
  const OrientedBox beside{{20.0, 3.3626, 0.0}, 2.0, 2.0};
  const Plan plan = Around(global, {beside});
  EXPECT_EQ(plan.reference.path.segments(), global.reference.path.segments());
  EXPECT_FALSE(plan.diagnostics.contains("avoid"));
  const OrientedBox nearer{{20.0, 3.36, 0.0}, 2.0, 2.0};
  EXPECT_TRUE(Around(global, {nearer}).diagnostics.contains("avoid"));
}

TEST(PlanAround, LeavesTheWayToTheCurveAsItWas) {
  const Course course;
  const Plan global = course.Global();
  const Pose2 at = course.OnArc(0.5);
  const Plan plan = Around(global, {{{at.x, at.y, 0.0}, 2.0, 2.0}});
  const double leave = plan.diagnostics["avoid"][0]["leave_s_m"].get<double>();
  // S = r + v t_d before the arc, from 42.7 m on.
  EXPECT_NEAR(leave, 42.7 - 22.7, Tolerance(0.1));
  for (double s = 0.0; s < leave; s += 0.5) {
    EXPECT_EQ(plan.reference.path.At(s).pose, global.reference.path.At(s).pose);
    EXPECT_EQ(plan.schedule.At(s), global.schedule.At(s));
  }
}

TEST(PlanAround, AMirroredRouteGetsTheMirroredPlan) {
  const Course left;
  const Course right{.turn = -0.5 * kPi};
  const Pose2 at = left.OnArc(0.4);
  const Plan plan = Around(left.Global(), {{{at.x, at.y, 0.3}, 3.0, 1.5}});
  const Plan mirrored = Around(right.Global(), {{{at.x, -at.y, -0.3}, 3.0, 1.5}});
  ASSERT_EQ(plan.blocked, "");
  // Tree and curve are looked for in a mirror: the same numbers, laid out on the other side.
  ASSERT_NEAR(plan.reference.path.length(), mirrored.reference.path.length(), Tolerance(1e-9));
  for (double s = 0.0; s < plan.reference.path.length(); s += 1.0) {
    const Pose2 a = plan.reference.path.At(s).pose;
    const Pose2 b = mirrored.reference.path.At(s).pose;
    EXPECT_NEAR(a.x, b.x, Tolerance(1e-9));
    EXPECT_NEAR(a.y, -b.y, Tolerance(1e-9));
  }
}

/// A wall of boxes from the obstacle outward, 1 m apart: nothing fits through.
std::vector<OrientedBox> WithWall(const Course& course, double share, double toward_centre) {
  const Pose2 at = course.OnArc(share);
  std::vector<OrientedBox> boxes;
  for (int i = 0; i < 30; ++i) {
    const Vec2 p = ToWorld(at, {0.0, toward_centre * 3.0 * i});
    boxes.push_back({{p.x(), p.y(), at.yaw}, 2.0, 2.0});
  }
  return boxes;
}

TEST(PlanAround, TakesTheOnlyRingThatIsFree) {
  const Course course;
  const Plan global = course.Global();
  // To the left is the turn's center.
  const Plan outer = Around(global, WithWall(course, 0.5, 1.0));
  ASSERT_EQ(outer.blocked, "");
  EXPECT_EQ(outer.diagnostics["avoid"][0]["ring"], "outer");
  const Plan inner = Around(global, WithWall(course, 0.5, -1.0));
  ASSERT_EQ(inner.blocked, "");
  EXPECT_EQ(inner.diagnostics["avoid"][0]["ring"], "inner");
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
  EXPECT_THAT(plan.blocked, testing::HasSubstr("no curve passes it on either side at 2 m/s"));
  EXPECT_EQ(plan.diagnostics["blocked"], plan.blocked);
  EXPECT_TRUE(plan.ok()) << "the way there can be driven";
  const Path& path = plan.reference.path;
  EXPECT_GE(ClearanceOf(path, wall, SeedCar(), {}), kDistance - Tolerance(kTouch));
  EXPECT_LE(ClearanceOf(path, wall, SeedCar(), {}), kDistance + 0.3);
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
  EXPECT_EQ(plan.diagnostics["avoid"].size(), 2U);
  ExpectSafe(plan, global, obstacles, options);
}

TEST(PlanAround, StartsAtTheCarsPoseAndSteering) {
  const Course course;
  const Plan global = course.Global();
  const VehicleParams vehicle = SeedCar();
  const Pose2 at = course.OnArc(0.6);
  const std::vector<OrientedBox> obstacles{{{at.x, at.y, 0.0}, 2.0, 2.0}};
  // 10 m into the arc's lead, a little beside the path, the wheels a little to the right.
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
  const Plan plan = PlanAround({.vehicle = SeedCar(),
                                .plan = global,
                                .speed = kLimits,
                                .obstacles = {{{at.x, at.y, 0.0}, 2.0, 2.0}},
                                .station = 30.0,
                                .station_speed = kSpeed,
                                .car = AvoidanceRequest::Car{{30.0, 0.08, 0.01}, -0.02},
                                .seed = 1},
                               BezierAvoidanceOptions{});
  ASSERT_EQ(plan.blocked, "");
  EXPECT_GT(plan.diagnostics["avoid"][0]["leave_s_m"].get<double>(), 90.0);
  EXPECT_EQ(plan.reference.path.At(0.0).pose, global.reference.path.At(30.0).pose);
}

TEST(PlanAround, SlowsDownWhereTheWheelsWouldTurnTooSlowly) {
  // The turn begins 8 m from the start, and a wide obstacle stands 4 m into it.
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

TEST(PlanAround, TheScheduleDrivesTheCurveOpenLoop) {
  const Course course;
  const Plan global = course.Global();
  const Pose2 at = course.OnArc(0.5);
  const Plan plan = Around(global, {{{at.x, at.y, 0.0}, 2.0, 2.0}});
  const Path& path = plan.reference.path;
  const nlohmann::json& stretch = plan.diagnostics["avoid"][0];
  const double leave = stretch["leave_s_m"].get<double>();
  const double back = stretch["return_s_m"].get<double>();
  // The schedule has the curve's own angle every 0.1 m or less, and is straight in between.
  for (double s = leave; s < back; s += 0.37) {
    EXPECT_NEAR(plan.schedule.At(s), SteeringForCurvature(SeedCar(), path.At(s).curvature),
                Tolerance(1e-4));
  }
  const KinematicState end =
      RollOut(SeedCar(), {.pose = path.At(0.0).pose, .speed = kSpeed}, plan.schedule, back, 0.05);
  // Between two knots the wheels turn at their full rate and then rest: they lead the schedule by
  // at most a knot, 0.1 m, which moves the path by no more than (0.1 m x heading changed) = 0.16 m;
  // what is lost going one way comes back going the other.
  EXPECT_NEAR((end.pose.position() - path.At(back).pose.position()).norm(), 0.0, Tolerance(0.05));
  EXPECT_LE(stretch["open_loop"]["end_distance_m"].get<double>(), 0.05);
}

/// 500 random turns in ten batches: a safe plan or a reason, never an unsafe one called good.
class RandomObstacles : public testing::TestWithParam<int> {};

INSTANTIATE_TEST_SUITE_P(Batches, RandomObstacles, testing::Range(0, 10));

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
      // The wheels would have to start turning before the car does.
      ASSERT_EQ(global.status, PlanStatus::kSteersBeforeStart) << global.reason;
      continue;
    }
    const Pose2 arc = course.OnArc(random.Uniform(0.0, 1.0));
    const Vec2 centre = ToWorld(arc, {0.0, random.Uniform(-2.0, 2.0)});
    const OrientedBox obstacle{{centre.x(), centre.y(), random.Uniform(-kPi, kPi)},
                               random.Uniform(0.5, 6.0),
                               random.Uniform(0.5, 6.0)};
    BezierAvoidanceOptions options;
    options.safe_distance = random.Uniform(0.5, 3.0);
    options.rrt_iterations = 300;
    options.min_speed = 2.5;
    options.search.evaluations = 500;
    const Plan plan = Around(global, {obstacle}, options);
    if (!plan.blocked.empty()) {
      EXPECT_THAT(plan.blocked, testing::AnyOf(testing::HasSubstr("no curve passes it"),
                                               testing::HasSubstr("the path ends beside it")));
      EXPECT_EQ(plan.reference.speed.SpeedAt(plan.reference.path.length()), 0.0);
      continue;
    }
    if (!plan.diagnostics.contains("avoid")) {
      EXPECT_GE(ClearanceOf(plan.reference.path, {obstacle}, SeedCar(), {}),
                options.safe_distance - Tolerance(kTouch));
      continue;
    }
    ++passed;
    ExpectSafe(plan, global, {obstacle}, options);
  }
  // Most turns leave room: what is too close to the start or the end is the exception.
  EXPECT_GE(passed, 40);
}

TEST(Avoiders, AreNamedOnceAndHaveOptionsOfTheirOwn) {
  ASSERT_EQ(Avoiders().size(), std::variant_size_v<AvoiderOptions>);
  EXPECT_STREQ(Avoiders()[0].name, "bezier");
  EXPECT_EQ(Avoiders()[0].defaults.index(), 0U);
}

}  // namespace
}  // namespace trackbed
