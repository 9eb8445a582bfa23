#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/geometry/random.h"
#include "tests/planning/poses.h"
#include "tests/planning/print_planner.h"
#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/common/planner.h"
#include "trackbed/planning/common/route.h"
#include "trackbed/planning/curves/curve_planners.h"
#include "trackbed/planning/grid/astar_planner.h"
#include "trackbed/planning/grid/hybrid_astar.h"
#include "trackbed/planning/registry/planners.h"
#include "trackbed/planning/sampling/rrt_planner.h"
#include "trackbed/planning/sampling/rrt_star_planner.h"
#include "trackbed/world/world.h"

// Tests the guarantees of every planner that avoids obstacles, in addition to those in
// planner_test.cpp.
namespace trackbed {
namespace {

constexpr double kSafe = 0.3;  // the default safe distance of all planners [m]

std::vector<PlannerEntry> Planning() {
  std::vector<PlannerEntry> entries;
  std::copy_if(Planners().begin(), Planners().end(), std::back_inserter(entries),
               [](const PlannerEntry& entry) { return entry.keeps_clear; });
  return entries;
}

PlanRequest Between(const Pose2& start, const Pose2& goal, std::vector<OrientedBox> obstacles) {
  PlanRequest request;
  request.vehicle = ReferenceCar();
  request.waypoints = {start.position(), goal.position()};
  request.headings = {start.yaw, goal.yaw};
  request.obstacles = std::move(obstacles);
  request.start = start;
  request.speed = {.speed = 3.0, .acceleration = 1.0, .deceleration = 1.5};
  return request;
}

/// Returns a request with boxes on both sides of the route.
PlanRequest Aisle() {
  return Between({0.0, 0.0, 0.0}, {40.0, 6.0, 0.3},
                 {{{20.0, 9.0, 0.2}, 4.0, 4.0}, {{22.0, -4.0, -0.4}, 5.0, 3.0}});
}

/// Returns the request of Aisle() with both boxes farther from the route, and with a third box in
/// the middle of the route, slightly to the right.
PlanRequest Blocked() {
  PlanRequest request = Aisle();
  request.obstacles.push_back({{19.0, 1.5, 0.7}, 2.0, 2.0});
  request.obstacles[0].center.y = 16.0;
  request.obstacles[1].center.y = -12.0;
  return request;
}

void SetBudget(PlannerOptions& options, int budget) {
  if (auto* astar = options.GetIf<AStarOptions>()) {
    astar->budget = budget;
  } else if (auto* hybrid = options.GetIf<HybridAStarOptions>()) {
    hybrid->budget = budget;
  } else if (auto* rrt = options.GetIf<RrtPlannerOptions>()) {
    rrt->iterations = budget;
  } else if (auto* rrt_star = options.GetIf<RrtStarPlannerOptions>()) {
    rrt_star->iterations = budget;
  }
}

class EveryRoutePlanner : public ::testing::TestWithParam<PlannerEntry> {
 protected:
  [[nodiscard]] static Plan Make(const PlanRequest& request) {
    return MakePlan(request, GetParam().defaults);
  }
};

/// Checks the exact distance between the footprint and the boxes every 2 cm. Within half a step,
/// the farthest corner moves by (1 + 3.7/5.1) x 1 cm = 1.7 cm.
void ExpectClear(const PlanRequest& request, const Plan& plan) {
  const Path& path = plan.reference.path;
  for (double s = 0.0; s <= path.length(); s += 0.02) {
    const OrientedBox footprint = FootprintAt(request.vehicle, path.At(s).pose);
    for (const OrientedBox& box : request.obstacles) {
      ASSERT_GE(Separation(footprint, box), kSafe - Tolerance(0.018)) << "at " << s;
    }
  }
}

TEST_P(EveryRoutePlanner, MeetsStartAndGoal) {
  const PlanRequest request = Aisle();
  const Plan plan = Make(request);
  ASSERT_TRUE(plan.ok()) << plan.reason;
  const Path& path = plan.reference.path;
  const Pose2 first = path.At(0.0).pose;
  const Pose2 last = path.At(path.length()).pose;
  const Pose2 goal{40.0, 6.0, 0.3};
  if (GetParam().has_headings) {
    EXPECT_EQ(first, request.start);
    EXPECT_LE(Apart(last, goal), Tolerance(1e-9));
  }
  EXPECT_LE((first.position() - request.start.position()).norm(), Tolerance(1e-9));
  EXPECT_LE((last.position() - goal.position()).norm(), Tolerance(1e-9));
  EXPECT_LE(Apart(plan.goal, last), Tolerance(1e-12));
}

TEST_P(EveryRoutePlanner, KeepsClear) {
  for (const PlanRequest& request : {Aisle(), Blocked()}) {
    const Plan plan = Make(request);
    if (GetParam().searches) {
      ASSERT_TRUE(plan.ok()) << plan.reason;
    }
    if (plan.ok()) {
      ExpectClear(request, plan);
    } else {
      EXPECT_EQ(plan.status, PlanStatus::kNoPath);
    }
  }
}

TEST_P(EveryRoutePlanner, KeepsTheCarsRadius) {
  const Plan plan = Make(Aisle());
  ASSERT_TRUE(plan.ok()) << plan.reason;
  const double most = 1.0 / ReferenceCar().min_turning_radius();
  for (const PathPoint& point : plan.reference.path.Sample(0.05)) {
    EXPECT_LE(std::abs(point.curvature), most + Tolerance(1e-12));
  }
}

TEST_P(EveryRoutePlanner, IsSlowerWhereTheWheelsCannotFollow) {
  const Plan plan = Make(Aisle());
  ASSERT_TRUE(plan.ok()) << plan.reason;
  for (const SpeedCap& cap : plan.caps) {
    const double middle = std::min(0.5 * (cap.from + cap.to), plan.reference.path.length());
    EXPECT_LE(plan.reference.speed.SpeedAt(middle), cap.speed + Tolerance(1e-9));
    EXPECT_GE(cap.speed, 0.3 - Tolerance(1e-12));
  }
}

TEST_P(EveryRoutePlanner, SaysWhenTheStartIsBlocked) {
  PlanRequest request = Aisle();
  request.obstacles.push_back({{1.0, 0.0, 0.0}, 1.0, 1.0});
  const Plan plan = Make(request);
  EXPECT_EQ(plan.status, PlanStatus::kStartBlocked);
  EXPECT_NE(plan.reason, "");
  EXPECT_EQ(plan.reference.path.length(), 0.0);
}

TEST_P(EveryRoutePlanner, SaysWhenTheGoalIsBlocked) {
  PlanRequest request = Aisle();
  request.obstacles.push_back({{40.5, 6.0, 0.0}, 1.0, 1.0});
  const Plan plan = Make(request);
  EXPECT_EQ(plan.status, PlanStatus::kGoalBlocked);
  EXPECT_NE(plan.reason, "");
  EXPECT_EQ(plan.reference.path.length(), 0.0);
}

TEST_P(EveryRoutePlanner, SaysWhenTheGoalCannotBeReached) {
  PlanRequest request = Aisle();
  for (const auto& [x, y, length, width] : {std::tuple{40.0, -4.0, 21.0, 1.0},
                                            {40.0, 16.0, 21.0, 1.0},
                                            {30.0, 6.0, 1.0, 21.0},
                                            {50.0, 6.0, 1.0, 21.0}}) {
    request.obstacles.push_back({{x, y, 0.0}, length, width});
  }
  const Plan plan = Make(request);
  // Planners with random samples cannot prove that no path exists, so they report that the budget
  // is used up.
  EXPECT_EQ(plan.status, GetParam().is_random ? PlanStatus::kBudgetUsedUp : PlanStatus::kNoPath);
  EXPECT_NE(plan.reason, "");
  EXPECT_EQ(plan.reference.path.length(), 0.0);
}

TEST_P(EveryRoutePlanner, SaysWhenItsBudgetIsUsedUp) {
  PlannerOptions options = GetParam().defaults;
  SetBudget(options, 0);
  const Plan plan = MakePlan(Aisle(), options);
  EXPECT_EQ(plan.status, GetParam().searches ? PlanStatus::kBudgetUsedUp : PlanStatus::kOk);
  EXPECT_EQ(plan.reason.empty(), plan.ok());
  if (GetParam().searches) {
    PlanRequest far = Aisle();
    far.waypoints.back() = {1e6, 1e6};
    options = GetParam().defaults;
    if (auto* rrt_star = options.GetIf<RrtStarPlannerOptions>()) {
      rrt_star->expand_distance = 2.0;  // by default it depends on the distance to the goal
    }
    EXPECT_EQ(MakePlan(far, options)->status, PlanStatus::kBudgetUsedUp);
  }
}

TEST_P(EveryRoutePlanner, IsTheSameEveryTime) {
  const Plan a = Make(Blocked());
  const Plan b = Make(Blocked());
  EXPECT_EQ(a.status, b.status);
  EXPECT_EQ(DiagnosticsJson(a).dump(), DiagnosticsJson(b).dump());
  EXPECT_EQ(a.reference.path.segments(), b.reference.path.segments());
}

TEST_P(EveryRoutePlanner, PlansWithEverySeed) {
  PlanRequest request = Blocked();
  const Plan first = Make(request);
  bool another = false;
  for (request.seed = 1; request.seed <= 5; ++request.seed) {
    const Plan plan = Make(request);
    ASSERT_EQ(plan.status, first.status) << plan.reason;
    if (plan.ok()) {
      ExpectClear(request, plan);
    }
    another = another || plan.reference.path.segments() != first.reference.path.segments();
  }
  EXPECT_EQ(another, GetParam().is_random);
}

TEST_P(EveryRoutePlanner, IsNotMovedByWindThatBlowsAlikeEverywhere) {
  // Uniform wind adds the same cost to all paths from the start to the goal.
  PlanRequest request = Blocked();
  const Plan calm = Make(request);
  request.wind.velocity = {4.0, -7.0};
  const Plan windy = Make(request);
  EXPECT_EQ(windy.status, calm.status);
  EXPECT_EQ(windy.reference.path.segments(), calm.reference.path.segments());
}

TEST_P(EveryRoutePlanner, LeadsThroughEveryWaypoint) {
  PlanRequest request = Aisle();
  request.waypoints = {{0.0, 0.0}, {20.0, 1.0}, {40.0, 6.0}, {55.0, 20.0}};
  request.headings = {0.0, 0.1, 0.4, 0.9};
  const Plan plan = Make(request);
  ASSERT_TRUE(plan.ok()) << plan.reason;
  const Path& path = plan.reference.path;
  for (const Vec2& waypoint : request.waypoints) {
    // A rounded corner passes its waypoint at a smaller distance than an arc with the same tangent
    // length T. The arc passes the waypoint at the distance T tan(h/4) = 0.68 m, with T = 5.3 m and
    // the turn h = 0.51 rad.
    const double away = std::abs(path.Project({waypoint.x(), waypoint.y(), 0.0}).cross_track);
    EXPECT_LE(away, GetParam().has_headings ? Tolerance(1e-6) : 0.68);
  }
}

/// Returns the request transformed by `by`.
PlanRequest Moved(const PlanRequest& request, const Pose2& by) {
  PlanRequest moved = request;
  for (std::size_t i = 0; i < moved.waypoints.size(); ++i) {
    moved.waypoints[i] = ToWorld(by, moved.waypoints[i]);
    moved.headings[i] += by.yaw;
  }
  for (OrientedBox& box : moved.obstacles) {
    box.center = Compose(by, box.center);
  }
  moved.start = Compose(by, moved.start);
  moved.wind.velocity = ToWorld({0.0, 0.0, by.yaw}, moved.wind.velocity);
  for (Gust& gust : moved.wind.gusts) {
    gust.velocity = ToWorld({0.0, 0.0, by.yaw}, gust.velocity);
    gust.area->center = Compose(by, gust.area->center);
  }
  return moved;
}

TEST_P(EveryRoutePlanner, MovesWithTheWorld) {
  const Pose2 by{123.0, -45.0, 0.9};
  PlanRequest windy = Blocked();
  windy.wind.gusts = {{.velocity = {9.0, 3.0},
                       .shape = GustShape::kStep,
                       .area = OrientedBox{{20.0, 8.0, 0.2}, 30.0, 9.0}}};
  for (const PlanRequest& request : {Aisle(), Blocked(), windy}) {
    const Plan here = Make(request);
    const Plan there = Make(Moved(request, by));
    ASSERT_EQ(here.status, there.status) << there.reason;
    const Path& path = here.reference.path;
    ASSERT_NEAR(there.reference.path.length(), path.length(), Tolerance(1e-6));
    for (double s = 0.0; s < path.length(); s += 1.0) {
      // The tolerance allows for rounding of coordinates of about 150 m, which the arcs of the
      // search amplify.
      EXPECT_LE(Apart(Compose(by, path.At(s).pose), there.reference.path.At(s).pose),
                Tolerance(1e-6));
    }
  }
}

TEST_P(EveryRoutePlanner, MirrorsWithTheWorld) {
  for (const PlanRequest& request : {Aisle(), Blocked()}) {
    PlanRequest mirrored = request;
    for (std::size_t i = 0; i < mirrored.waypoints.size(); ++i) {
      mirrored.waypoints[i].y() *= -1.0;
      mirrored.headings[i] *= -1.0;
    }
    for (OrientedBox& box : mirrored.obstacles) {
      box.center = Mirror(box.center);
    }
    const Plan left = Make(request);
    const Plan right = Make(mirrored);
    ASSERT_EQ(left.status, right.status);
    if (GetParam().is_random) {
      ExpectClear(mirrored, right);  // the random samples are not mirrored
      continue;
    }
    if (GetParam().has_ties) {
      ASSERT_TRUE(left.ok());
      EXPECT_NEAR(DiagnosticsJson(left)["legs"][0]["cost_m"].get<double>(),
                  DiagnosticsJson(right)["legs"][0]["cost_m"].get<double>(), Tolerance(1e-9));
      continue;
    }
    const Path& path = left.reference.path;
    ASSERT_NEAR(right.reference.path.length(), path.length(), Tolerance(1e-6));
    for (double s = 0.0; s < path.length(); s += 1.0) {
      EXPECT_LE(Apart(Mirror(path.At(s).pose), right.reference.path.At(s).pose), Tolerance(1e-6));
    }
  }
}

TEST_P(EveryRoutePlanner, BeginsForwardsWhenItRolls) {
  PlanRequest request = Between({0.0, 0.0, 0.0}, {-12.0, 2.0, 0.2}, {});
  if (!GetParam().goes_backwards) {
    GTEST_SKIP() << "it does not";
  }
  const Plan back = Make(request);
  ASSERT_TRUE(back.ok()) << back.reason;
  EXPECT_EQ(back.reference.path.segments().front().direction, -1);
  // A car that rolls forward cannot start in reverse.
  request.start_speed = 2.0;
  const Plan plan = Make(request);
  ASSERT_TRUE(plan.ok()) << plan.reason;
  EXPECT_EQ(plan.reference.path.segments().front().direction, 1);
}

TEST_P(EveryRoutePlanner, StopsWhereItChangesDirection) {
  if (!GetParam().goes_backwards) {
    GTEST_SKIP() << "it does not";
  }
  // A car that rolls forward stops before it drives back to the goal.
  PlanRequest request = Between({0.0, 0.0, 0.0}, {-12.0, 2.0, 0.2}, {});
  request.start_speed = 1.0;
  const Plan plan = Make(request);
  ASSERT_TRUE(plan.ok()) << plan.reason;
  const std::vector<Stations> legs = SplitIntoLegs(plan.reference.path);
  ASSERT_GT(legs.size(), 1U);
  EXPECT_EQ(DiagnosticsJson(plan)["changes_of_direction"], legs.size() - 1);
  for (const Stations& leg : legs) {
    EXPECT_EQ(plan.reference.speed.SpeedAt(leg.to), 0.0);
    EXPECT_GT(plan.reference.speed.SpeedAt(0.5 * (leg.from + leg.to)), 0.0);
  }
}

INSTANTIATE_TEST_SUITE_P(Table, EveryRoutePlanner, ::testing::ValuesIn(Planning()),
                         [](const auto& test) { return std::string(test.param.name); });

/// A request from the origin along x to a goal 60 m ahead and 8 m to the left, with one obstacle
/// near the start.
PlanRequest From(const OrientedBox& near) {
  PlanRequest request = Between({0.0, 0.0, 0.0}, {60.0, 8.0, 0.3}, {near});
  request.speed.speed = 4.0;
  return request;
}

/// Obstacles at a distance [m] from the car at the origin: a wall behind the car, obstacles as long
/// as the car and walls on its left and right, and an obstacle at a corner of the car.
std::vector<OrientedBox> BoxesNearTheOrigin(double distance) {
  const VehicleParams car = ReferenceCar();
  const double beside = 0.5 * car.width + distance;
  const double behind = car.rear_overhang + distance;
  return {{{-behind - 0.5, 0.0, 0.0}, 1.0, 3.0},  {{-behind - 0.1, 5.0, 0.0}, 0.2, 30.0},
          {{1.0, beside + 0.9, 0.0}, 4.5, 1.8},   {{1.0, -beside - 0.9, 0.0}, 4.5, 1.8},
          {{0.0, -beside - 0.1, 0.0}, 40.0, 0.2}, {{-behind - 0.5, beside + 0.5, 0.0}, 1.0, 1.0}};
}

TEST_P(EveryRoutePlanner, LeavesAnObstacleNearTheStart) {
  for (const double distance : {0.2, 0.15, 0.4, 0.5}) {
    for (const OrientedBox& near : BoxesNearTheOrigin(distance)) {
      // Planners of curves do not search: their curves begin with an arc, even if an obstacle is in
      // its way.
      const bool is_beside = std::abs(near.center.x) < 1.5;
      if (is_beside && !GetParam().searches) {
        continue;
      }
      const PlanRequest request = From(near);
      const double apart = Separation(FootprintAt(request.vehicle, request.start), near);
      const Plan plan = Make(request);
      ASSERT_TRUE(plan.ok()) << distance << " m, at " << near.center.x << ", " << near.center.y
                             << ": " << plan.reason;
      const Path& path = plan.reference.path;
      for (double s = 0.0; s < path.length(); s += 0.05) {
        // Between the checks of the planner, the farthest corner of the footprint may come 1.8 cm
        // closer to an obstacle.
        ASSERT_GE(Separation(FootprintAt(request.vehicle, path.At(s).pose), near),
                  (apart < kSafe ? 0.5 * apart : kSafe) - Tolerance(0.018))
            << "s = " << s;
      }
    }
  }
}

TEST_P(EveryRoutePlanner, ReachesAGoalBesideAnObstacle) {
  const VehicleParams car = ReferenceCar();
  for (const double distance : {0.35, 0.6, 1.5}) {
    for (const double side : {1.0, -1.0}) {
      // The route is straight, and the obstacle is as long as the car.
      const PlanRequest request =
          Between({0.0, 0.0, 0.0}, {50.0, 0.0, 0.0},
                  {{{51.0, side * (0.5 * car.width + distance + 0.9), 0.0}, 4.5, 1.8}});
      const Plan plan = Make(request);
      ASSERT_TRUE(plan.ok()) << distance << ": " << plan.reason;
      ExpectClear(request, plan);
    }
  }
}

TEST_P(EveryRoutePlanner, RefusesAStartOrAGoalInsideAnObstacle) {
  EXPECT_EQ(Make(From({{1.0, 0.5, 0.3}, 0.5, 0.5})).status, PlanStatus::kStartBlocked);
  EXPECT_EQ(Make(From({{60.0, 8.0, 0.3}, 0.5, 0.5})).status, PlanStatus::kGoalBlocked);
}

// --- Properties of single planners ---------------------------------------------------------------

TEST(CurvePlanners, TakeAnotherWordWhereTheShortestIsBlocked) {
  PlanRequest request = Between({0.0, 0.0, 0.0}, {0.0, 24.0, kPi}, {});
  const Plan open = MakePlan(request, DubinsOptions{.curvature = CurveCurvature::kSteps});
  ASSERT_TRUE(open.ok());
  const PathPoint middle = open.reference.path.At(0.5 * open.reference.path.length());
  request.obstacles = {{middle.pose, 1.0, 1.0}};
  const Plan other = MakePlan(request, DubinsOptions{.curvature = CurveCurvature::kSteps});
  ASSERT_TRUE(other.ok()) << other.reason;
  EXPECT_GT(DiagnosticsJson(other)["curves"][0]["shorter_ones_blocked"], 0);
  EXPECT_GT(other.reference.path.length(), open.reference.path.length());
  ExpectClear(request, other);
}

/// Planners that meet the headings at the waypoints.
std::vector<PlannerEntry> WithHeadings() {
  std::vector<PlannerEntry> entries = Planning();
  std::erase_if(entries, [](const PlannerEntry& entry) { return !entry.has_headings; });
  return entries;
}

TEST(PlannersWithHeadings, TurnInPlace) {
  for (const PlannerEntry& entry : WithHeadings()) {
    for (const double turn : {kPi, -kPi, 0.5 * kPi, -2.0, 1.0, 0.1, 1e-3, 1e-6}) {
      for (const double start_speed : {0.0, 1.0}) {
        // The car drives there and back. The route is far from the origin, where coordinates have
        // rounding errors of 1e-10 m.
        PlanRequest request = Between({4e5, -3e5, 0.7}, {4e5, -3e5, 0.7 + turn}, {});
        request.waypoints.push_back(request.waypoints[0]);
        request.headings.push_back(0.7);
        request.start_speed = start_speed;
        const Plan plan = MakePlan(request, entry.defaults);
        ASSERT_TRUE(plan.ok()) << entry.name << ", " << turn << ": " << plan.reason;
        const Path& path = plan.reference.path;
        // A turn by an angle needs at least this angle times the smallest turning radius.
        EXPECT_GT(path.length(), 2.0 * std::abs(turn) * ReferenceCar().min_turning_radius());
        const Pose2 end = path.At(path.length()).pose;
        // Far above the rounding errors of positions on a path of 100 m, 1e-14 m each.
        EXPECT_NEAR((end.position() - request.waypoints[0]).norm(), 0.0, Tolerance(1e-8));
        EXPECT_NEAR(AngleDifference(end.yaw, 0.7), 0.0, Tolerance(1e-8));
      }
    }
  }
}

TEST(CurvePlanners, TurnAroundInPlaceOnTheShortestCurve) {
  // Three circles of radius r that touch lead back to the start. A Dubins curve turns by 60 degrees
  // on the outer circles and by 300 degrees on the middle one. A Reeds-Shepp curve turns by 60
  // degrees on each circle.
  constexpr double kRadius = 7.0;
  const PlanRequest request = Between({0.0, 0.0, 0.0}, {0.0, 0.0, kPi}, {});
  const Plan loop =
      MakePlan(request, DubinsOptions{.radius = kRadius, .curvature = CurveCurvature::kSteps});
  ASSERT_TRUE(loop.ok()) << loop.reason;
  EXPECT_NEAR(loop.reference.path.length(), kRadius * 7.0 / 3.0 * kPi, Tolerance(1e-9));
  const Plan star =
      MakePlan(request, ReedsSheppOptions{.radius = kRadius, .curvature = CurveCurvature::kSteps});
  ASSERT_TRUE(star.ok()) << star.reason;
  EXPECT_NEAR(star.reference.path.length(), kRadius * kPi, Tolerance(1e-9));
}

TEST(PlannersWithHeadings, RefuseAPoseTwice) {
  for (const PlannerEntry& entry : WithHeadings()) {
    // A heading that is larger by a full turn is the same heading.
    PlanRequest request = Between({0.0, 0.0, 0.3}, {0.0, 0.0, 0.3 + 2.0 * kPi}, {});
    const Plan at_once = MakePlan(request, entry.defaults);
    EXPECT_EQ(at_once.status, PlanStatus::kDuplicateWaypoints) << entry.name;
    EXPECT_EQ(
        at_once.reason,
        "nothing to drive to waypoint 1: the car is there already, at (0, 0) with the heading "
        "6.58319 rad; remove the waypoint, or give it another heading");
    request.waypoints = {{0.0, 0.0}, {20.0, 0.0}, {20.0, 0.0}};
    request.headings = {0.3, 0.1, 0.1};
    EXPECT_EQ(MakePlan(request, entry.defaults)->status, PlanStatus::kDuplicateWaypoints);
    request.headings = {};
    EXPECT_EQ(MakePlan(request, entry.defaults)->status, PlanStatus::kDuplicateWaypoints);
  }
}

TEST(CurvePlanners, RefuseRadiiThatTheCarCannotTurnOn) {
  EXPECT_EQ(MakePlan(Aisle(), DubinsOptions{.radius = 5.0})->status, PlanStatus::kTurnTooTight);
  EXPECT_EQ(MakePlan(Aisle(), ReedsSheppOptions{.radius = 5.0})->status, PlanStatus::kTurnTooTight);
  EXPECT_EQ(MakePlan(Aisle(), HybridAStarOptions{.radius = 5.0})->status,
            PlanStatus::kTurnTooTight);
}

TEST(PlannedStops, TakesHeadingsFromTheLegsIfThereAreNone) {
  PlanRequest request = Between({0.0, 0.0, 0.1}, {10.0, 0.0, 0.0}, {});
  request.waypoints = {{0.0, 0.0}, {10.0, 0.0}, {10.0, 10.0}};
  request.headings = {};
  const std::vector<Pose2> stops = PlannedStops(request);
  ASSERT_EQ(stops.size(), 3U);
  EXPECT_EQ(stops[0], request.start);
  EXPECT_NEAR(stops[1].yaw, 0.25 * kPi, Tolerance(1e-12));  // direction from the start to the goal
  EXPECT_NEAR(stops[2].yaw, 0.5 * kPi, Tolerance(1e-12));
  request.headings = {7.0, 1.0, 2.0};
  EXPECT_EQ(PlannedStops(request)[0].yaw, 0.1);  // the car's own heading
  EXPECT_EQ(PlannedStops(request)[1].yaw, 1.0);
  request.headings.pop_back();
  EXPECT_THROW(MakePlan(request, DubinsOptions{}), InternalError);
}

TEST(PlannedStops, HeadAlongTheCircleThroughThreeStops) {
  // Random points on a circle about (3, -2), counterclockwise from the start.
  const Vec2 center(3.0, -2.0);
  const auto at = [&](double angle, double radius) {
    return Vec2(center + radius * Vec2(std::cos(angle), std::sin(angle)));
  };
  Random random(5);
  for (int i = 0; i < 100; ++i) {
    const double radius = random.Uniform(5.0, 100.0);
    const double first = random.Uniform(-kPi, kPi);
    const double second = first + random.Uniform(0.1, 3.0);
    const double third = second + random.Uniform(0.1, 3.0);
    PlanRequest request;
    request.waypoints = {at(first, radius), at(second, radius), at(third, radius)};
    request.start = {request.waypoints[0].x(), request.waypoints[0].y(), 0.0};
    // The angle of rounding is below 1e-15 x 100 m / (0.1 x 5 m).
    EXPECT_NEAR(AngleDifference(PlannedStops(request)[1].yaw, second + 0.5 * kPi), 0.0, 1e-12);
  }
}

TEST(PlannedStops, TurnOnTheLongerLeg) {
  PlanRequest request;
  const auto heading_between = [&](const Vec2& at, const Vec2& goal) {
    request.waypoints = {{0.0, 0.0}, at, goal};
    return PlannedStops(request)[1].yaw;
  };
  EXPECT_EQ(heading_between({60.0, 0.0}, {90.0, 0.0}), 0.0);
  EXPECT_NEAR(heading_between({60.0, 0.0}, {60.0, 10.0}), std::atan2(6.0, 1.0), 1e-15);
  // Turns by half a turn on the longer leg; by a quarter on each of two equal ones.
  EXPECT_EQ(heading_between({60.0, 0.0}, {30.0, 0.0}), kPi);
  EXPECT_EQ(heading_between({60.0, 0.0}, {-30.0, 0.0}), 0.0);
  EXPECT_EQ(heading_between({0.0, 40.0}, {0.0, 0.0}), kPi);
}

TEST(AStarPlanner, RefusesCornersWhenAsked) {
  const Plan plan = MakePlan(Blocked(), AStarOptions{.corners = Corners::kRefuse});
  EXPECT_EQ(plan.status, PlanStatus::kTurnTooTight);
  // The path on the grid turns in steps of 45 degrees.
  EXPECT_NE(plan.reason.find("jumps by"), std::string::npos) << plan.reason;
  EXPECT_NE(plan.reason.find("0.785"), std::string::npos) << plan.reason;
  const Plan straight =
      MakePlan(Between({}, {30.0, 0.0, 0.0}, {}), AStarOptions{.corners = Corners::kRefuse});
  EXPECT_TRUE(straight.ok()) << straight.reason;
}

// A grade of 0.2 pulls at 1.9 m/s^2, and the tyres hold at most 0.5 m/s^2.
TEST(AStarPlanner, NamesThePullOfGravityOnIce) {
  PlanRequest request = Between({}, {30.0, 0.0, 0.0}, {});
  request.vehicle.friction_lateral = request.vehicle.friction_longitudinal = 1.0;
  request.friction = 0.05;
  request.ground.grade = {0.2, 0.0};
  const Plan plan = MakePlan(request, AStarOptions{});
  EXPECT_EQ(plan.status, PlanStatus::kInfeasible);
  EXPECT_NE(plan.reason.find("pull of gravity"), std::string::npos) << plan.reason;
}

TEST(AStarPlanner, TellsItsCorners) {
  const Plan plan = MakePlan(Blocked(), AStarOptions{});
  ASSERT_TRUE(plan.ok()) << plan.reason;
  ASSERT_FALSE(DiagnosticsJson(plan)["corners"].empty());
  const nlohmann::json corners = DiagnosticsJson(plan)["corners"];
  for (const auto& corner : corners) {
    EXPECT_GT(corner["tangent_length_m"], 0.0);
    EXPECT_LE(corner["speed_mps"], 3.0);
  }
}

}  // namespace
}  // namespace trackbed
