#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "tests/geometry/random.h"
#include "tests/planning/poses.h"
#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/core/angle.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/common/planner.h"
#include "trackbed/planning/common/route.h"
#include "trackbed/planning/common/route_start.h"
#include "trackbed/planning/curves/curve_planners.h"
#include "trackbed/planning/grid/astar_planner.h"
#include "trackbed/planning/grid/hybrid_astar.h"
#include "trackbed/planning/registry/planners.h"
#include "trackbed/planning/sampling/rrt_planner.h"
#include "trackbed/planning/sampling/rrt_star_planner.h"

// Tests routes along a straight line whose waypoints and headings are rounded, as in files that
// people write.
namespace trackbed {
namespace {

constexpr double kDeceleration = 1.5;  // [m/s^2]

struct NamedPlanner {
  const char* name;
  PlannerOptions options;
};

std::vector<NamedPlanner> CurvePlanners() {
  HybridAStarOptions forwards;
  forwards.reverse = false;
  const CurveCurvature steps = CurveCurvature::kSteps;
  return {{"dubins", DubinsOptions{}},
          {"reeds_shepp", ReedsSheppOptions{}},
          {"dubins_steps", DubinsOptions{.curvature = steps}},
          {"reeds_shepp_steps", ReedsSheppOptions{.curvature = steps}},
          {"hybrid_astar_steps", HybridAStarOptions{.curvature = steps}},
          {"hybrid_astar", HybridAStarOptions{}},
          {"hybrid_astar_forwards", forwards}};
}

PlanRequest Route(std::vector<Vec2> waypoints, std::vector<double> headings, double speed,
                  double start_speed) {
  PlanRequest request;
  request.vehicle = ReferenceCar();
  request.start = StartOfRoute(waypoints);
  if (!headings.empty()) {
    request.start.yaw = headings[0];
  }
  request.waypoints = std::move(waypoints);
  request.headings = std::move(headings);
  request.start_speed = start_speed;
  request.speed = {.speed = speed, .acceleration = 1.0, .deceleration = kDeceleration};
  return request;
}

double Rounded(double value, double unit) {
  return unit * std::nearbyint(value / unit);
}

/// Returns a random route of two to five waypoints along a line, up to 40 m apart. The waypoints
/// are near the origin or 1000 km away, and rounded to between 1e-6 and 0.1 m. Headings, if any,
/// are rounded to between 1e-6 and 0.01 rad. The legs are at least `shortest` [m] long up to 4 m/s.
/// At higher speeds, the legs are longer by the square root of the speed, because the steering
/// ramps are, too.
PlanRequest NearlyStraight(Random& random, double shortest) {
  const double position = std::pow(10.0, random.Uniform(-6.0, -1.0));
  const double heading = std::pow(10.0, random.Uniform(-6.0, -2.0));
  const double yaw = random.Uniform(-kPi, kPi);
  const bool has_headings = random.Below(2) == 0;
  const double speed = random.Uniform(1.0, random.Below(2) == 0 ? 4.0 : 15.0);
  const double longest = 40.0 * std::max(1.0, std::sqrt(speed / 4.0));
  const double offset = random.Below(2) == 0 ? 0.0 : 1e6;
  Vec2 at{offset + random.Uniform(-50.0, 50.0), offset + random.Uniform(-50.0, 50.0)};
  std::vector<Vec2> waypoints;
  std::vector<double> headings;
  double length = 0.0;
  for (int left = 2 + random.Below(4); left > 0; --left) {
    waypoints.emplace_back(Rounded(at.x(), position), Rounded(at.y(), position));
    if (has_headings) {
      headings.push_back(Rounded(yaw, heading));
    }
    const double leg = longest * random.Uniform(shortest / 40.0, 1.0);
    at += leg * Direction(yaw);
    length += left > 1 ? leg : 0.0;
  }
  // The car can brake from this start speed before the goal.
  const double start_speed = std::min(speed, std::sqrt(2.0 * kDeceleration * 0.9 * length));
  return Route(std::move(waypoints), std::move(headings), speed,
               random.Below(2) == 0 ? start_speed : 0.0);
}

/// Expects that the path meets every stop: positions to 0.1 mm, and the heading at the goal up to
/// rounding in sums of a few dozen segments.
void ExpectStopsMet(const PlanRequest& request, const Plan& plan) {
  const Path& path = plan.reference.path;
  const std::vector<Pose2> stops = PlannedStops(request);
  const Pose2 end = path.At(path.length()).pose;
  EXPECT_LE((end.position() - stops.back().position()).norm(), Tolerance(1e-4));
  EXPECT_LE(std::abs(AngleDifference(end.yaw, stops.back().yaw)), Tolerance(1e-9));
  for (const Pose2& stop : stops) {
    EXPECT_LE(std::abs(path.Project(stop).cross_track), Tolerance(1e-4));
  }
}

void ExpectNoStop(const PlanRequest& request, const Plan& plan) {
  ASSERT_TRUE(plan.ok()) << plan.reason;
  EXPECT_TRUE(plan.stops.empty()) << plan.stops.front();
  EXPECT_EQ(SplitIntoLegs(plan.reference.path).size(), 1U);
  ExpectStopsMet(request, plan);
}

/// Expects that the plan takes no longer than a plan of the same length without turns. The
/// tolerance of 1e-6 is that of checks of the limits.
void ExpectFullSpeed(const PlanRequest& request, const Plan& plan) {
  const double length = plan.reference.path.length();
  const double least = StopAtEnd(length, request.start_speed, request.speed).TimeAt(length);
  EXPECT_LE(plan.reference.speed.TimeAt(length), least * (1.0 + Tolerance(1e-6)));
}

/// Returns the number of routes to test, which the environment variable TRACKBED_NEARLY_STRAIGHT
/// sets.
int Count() {
  const char* count = std::getenv("TRACKBED_NEARLY_STRAIGHT");
  return count == nullptr ? 300 : std::atoi(count);
}

std::string Described(const PlanRequest& request) {
  std::string text = fmt::format("{} m/s from {} m/s,", request.speed.speed, request.start_speed);
  for (std::size_t i = 0; i < request.waypoints.size(); ++i) {
    text += fmt::format(" [{}, {}]", request.waypoints[i].x(), request.waypoints[i].y());
    text += request.headings.empty() ? "" : fmt::format(" {}", request.headings[i]);
  }
  return text;
}

TEST(NearlyStraightRoutes, AreDrivenAtTheirSpeed) {
  // The waypoints are 10 m apart or more, and each turn is at most 0.03 rad. At 4 m/s, the wheels
  // have enough room for such a turn.
  Random random(47);
  for (int i = 0; i < Count() && !HasFailure(); ++i) {
    const PlanRequest request = NearlyStraight(random, 10.0);
    for (const NamedPlanner& planner : CurvePlanners()) {
      SCOPED_TRACE(fmt::format("{}, route {}: {}", planner.name, i, Described(request)));
      const Plan plan = MakePlan(request, planner.options);
      ExpectNoStop(request, plan);
      if (plan.ok()) {
        ExpectFullSpeed(request, plan);
      }
    }
  }
}

TEST(NearlyStraightRoutes, SlowDownWhereLegsAreShort) {
  Random random(48);
  for (int i = 0; i < Count() && !HasFailure(); ++i) {
    const PlanRequest request = NearlyStraight(random, 5.0);
    for (const NamedPlanner& planner : CurvePlanners()) {
      SCOPED_TRACE(fmt::format("{}, route {}: {}", planner.name, i, Described(request)));
      ExpectNoStop(request, MakePlan(request, planner.options));
    }
  }
}

// Routes of 3 to 30 m with waypoints at any distances, rounded to at most a millimeter. The
// planners that round corners leave out waypoints that are too close to each other, instead of
// turning behind them.
TEST(NearlyStraightRoutes, AreNotLongerBecauseWaypointsAreClose) {
  Random random(49);
  for (int i = 0; i < 60; ++i) {
    const double unit = std::pow(10.0, random.Uniform(-6.0, -3.0));
    const double length = random.Uniform(3.0, 30.0);
    const Vec2 along = length * Direction(random.Uniform(-kPi, kPi));
    std::vector<double> shares{0.0, 1.0};
    for (int left = random.Below(8); left > 0; --left) {
      shares.push_back(random.Uniform(0.01, 0.99));
    }
    std::sort(shares.begin(), shares.end());
    std::vector<Vec2> waypoints;
    for (const double share : shares) {
      const Vec2 at(Rounded(share * along.x(), unit), Rounded(share * along.y(), unit));
      if (waypoints.empty() || at != waypoints.back()) {
        waypoints.push_back(at);
      }
    }
    PlanRequest request = Route(waypoints, {}, 2.0, 0.0);
    request.max_waypoint_miss = request.vehicle.length;
    for (const NamedPlanner& planner :
         {NamedPlanner{"astar", AStarOptions{}}, NamedPlanner{"rrt", RrtPlannerOptions{}},
          NamedPlanner{"rrt_star", RrtStarPlannerOptions{}}}) {
      SCOPED_TRACE(fmt::format("{}, route {}: {}", planner.name, i, Described(request)));
      const Plan plan = MakePlan(request, planner.options);
      ASSERT_TRUE(plan.ok()) << plan.reason;
      // The first leg may be 0.01 x 3 m long, so it is off by up to 1e-3 x sqrt(2)/0.03 = 0.05 rad.
      // A path that begins so and ends at the goal is longer by 0.05^2 at most.
      EXPECT_LT(plan.reference.path.length(), length * (1.0 + 0.05 * 0.05) + 0.01);
    }
  }
}

TEST(NearlyStraightRoutes, TakeMillimetersForWaypoints) {
  const std::vector<PlanRequest> routes{
      Route({{0, 0}, {20.13, 13.74}, {40.27, 27.47}, {60.4, 41.21}}, {}, 3.0, 3.0),
      Route({{0, 0}, {20.131, 13.736}, {40.266, 27.472}, {60.4, 41.21}}, {}, 3.0, 3.0),
      Route({{0, 0}, {0, 40}}, {1.5708, 1.5708}, 3.0, 0.0),
      Route({{0, 0}, {40, 0}}, {0, 1e-5}, 3.0, 0.0),
      Route({{0, 0}, {40, 0}}, {0, 0.05}, 3.0, 0.0),
      Route({{0, 0}, {40, 0}}, {0.05, 0}, 3.0, 3.0)};
  for (const PlanRequest& request : routes) {
    for (const NamedPlanner& planner : CurvePlanners()) {
      SCOPED_TRACE(fmt::format("{}: {}", planner.name, Described(request)));
      const Plan plan = MakePlan(request, planner.options);
      ExpectNoStop(request, plan);
      if (plan.ok()) {
        ExpectFullSpeed(request, plan);
      }
    }
  }
}

}  // namespace
}  // namespace trackbed
