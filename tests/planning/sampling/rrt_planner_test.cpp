#include "trackbed/planning/sampling/rrt_planner.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "tests/geometry/random.h"
#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/common/planner.h"
#include "trackbed/planning/registry/planners.h"
#include "trackbed/world/world.h"

// Tests specific to the RRT planner; route_planners_test.cpp tests the guarantees of every planner.
namespace trackbed {
namespace {

using ::testing::HasSubstr;

PlanRequest Across(std::vector<OrientedBox> obstacles) {
  PlanRequest request;
  request.vehicle = ReferenceCar();
  request.waypoints = {{0.0, 0.0}, {50.0, 0.0}};
  request.obstacles = std::move(obstacles);
  request.speed = {.speed = 3.0, .acceleration = 1.0, .deceleration = 1.5};
  return request;
}

/// Returns a request with a box that is centered on the route.
PlanRequest BoxInTheMiddle() {
  return Across({{{25.0, 0.0, 0.0}, 6.0, 6.0}});
}

/// Returns wind of 9 m/s with a tailwind on one side of the route and a headwind on the other side.
/// At 3 m/s, the wind changes the cost of a path by three times its length.
Wind Layers(double left) {
  const auto layer = [](double y, double speed) {
    return Gust{.velocity = {speed, 0.0},
                .shape = GustShape::kStep,
                .area = OrientedBox{{25.0, y, 0.0}, 80.0, 20.0}};
  };
  return {.gusts = {layer(10.0, 9.0 * left), layer(-10.0, -9.0 * left)}};
}

double SideAt(const Plan& plan, double share) {
  return plan.reference.path.At(share * plan.reference.path.length()).pose.y;
}

TEST(RrtPlanner, GoesRoundOnTheSideOfTheTailwind) {
  PlanRequest request = BoxInTheMiddle();
  for (const double left : {1.0, -1.0}) {
    request.wind = Layers(left);
    const Plan plan = MakePlan(request, RrtPlannerOptions{});
    ASSERT_TRUE(plan.ok()) << plan.reason;
    EXPECT_GT(left * SideAt(plan, 0.5), 3.0);
    const auto chosen =
        DiagnosticsJson(plan)["trees"].at(DiagnosticsJson(plan)["chosen"].get<std::size_t>());
    EXPECT_GT(chosen["wind_m"], 0.0);
  }
}

TEST(RrtPlanner, DoesNotLookAtWindOfNoWeight) {
  PlanRequest request = BoxInTheMiddle();
  const Plan calm = MakePlan(request, RrtPlannerOptions{});
  request.wind = Layers(1.0);
  const Plan ignored = MakePlan(request, RrtPlannerOptions{.wind_weight = 0.0});
  EXPECT_EQ(ignored.reference.path.segments(), calm.reference.path.segments());
  EXPECT_NE(MakePlan(request, RrtPlannerOptions{})->reference.path.segments(),
            calm.reference.path.segments());
}

TEST(RrtPlanner, TakesTheBestOfItsTrees) {
  PlanRequest request = BoxInTheMiddle();
  request.wind = Layers(0.2);
  for (request.seed = 1; request.seed <= 5; ++request.seed) {
    const Plan plan = MakePlan(request, RrtPlannerOptions{.trees = 6});
    ASSERT_TRUE(plan.ok()) << plan.reason;
    const auto trees = DiagnosticsJson(plan)["trees"];
    ASSERT_EQ(trees.size(), 6U);
    const auto& chosen = trees.at(DiagnosticsJson(plan)["chosen"].get<std::size_t>());
    EXPECT_EQ(chosen["status"], "ok");
    for (const auto& tree : trees) {
      if (tree["status"] == "ok") {
        EXPECT_LE(chosen["total_m"], tree["total_m"]);
      }
      EXPECT_NEAR(tree["total_m"].get<double>(),
                  tree["length_m"].get<double>() - tree["wind_m"].get<double>(), Tolerance(1e-9));
    }
  }
}

TEST(RrtPlanner, BeginsStraightOn) {
  PlanRequest request = BoxInTheMiddle();
  request.start.yaw = 0.4;
  const Plan plan = MakePlan(request, RrtPlannerOptions{});
  ASSERT_TRUE(plan.ok()) << plan.reason;
  EXPECT_NEAR(AngleDifference(plan.reference.path.At(0.0).pose.yaw, 0.4), 0.0, Tolerance(1e-9));
  // Without a lead-in, the path begins along its first leg, regardless of the car's heading.
  const Plan without = MakePlan(request, RrtPlannerOptions{.lead_in = 0.0});
  EXPECT_FALSE(without.ok());
  EXPECT_NE(without.reason.find("initial heading error"), std::string::npos) << without.reason;
  // The lead-in is limited to half the distance to the goal.
  request.obstacles.clear();
  request.start.yaw = 0.0;
  request.waypoints.back() = {6.0, 0.0};
  const Plan near = MakePlan(request, RrtPlannerOptions{.lead_in = 20.0});
  ASSERT_TRUE(near.ok()) << near.reason;
  EXPECT_NEAR(near.reference.path.length(), 6.0, Tolerance(1e-9));
}

TEST(RrtPlanner, BeginsAsFarStraightOnAsThereIsRoomFor) {
  // With the default lead-in, the rolling car is too close to its first corner. A lead-in that is
  // long enough to stop ends 15.8 m ahead of the rear axle, 4.6 m before a box. A shorter lead-in
  // is sufficient.
  PlanRequest request = Across({{{22.39, 0.0, 0.0}, 4.0, 4.0}, {{40.0, 5.0, 0.0}, 4.0, 4.0}});
  request.speed.speed = request.start_speed = 4.48;
  RrtPlannerOptions options{.trees = 3};
  const Plan plan = MakePlan(request, options);
  EXPECT_TRUE(plan.ok()) << plan.reason;
  // A car at rest does not need a longer lead-in.
  request.start_speed = 0.0;
  EXPECT_TRUE(MakePlan(request, options).ok());
}

TEST(RrtPlanner, RefusesCornersWhenAsked) {
  const Plan plan = MakePlan(BoxInTheMiddle(), RrtPlannerOptions{.corners = Corners::kRefuse});
  EXPECT_EQ(plan.status, PlanStatus::kTurnTooTight);
  EXPECT_THAT(plan.reason, HasSubstr("jumps by"));
  EXPECT_TRUE(MakePlan(Across({}), RrtPlannerOptions{.corners = Corners::kRefuse}).ok());
}

TEST(RrtPlanner, GivesItsTree) {
  PlanRequest request = BoxInTheMiddle();
  request.start = {3.0, -2.0, 0.3};
  request.waypoints = {{3.0, -2.0}, {40.0, 14.0}, {70.0, 14.0}};
  const Plan plan = MakePlan(request, RrtPlannerOptions{});
  ASSERT_TRUE(plan.ok()) << plan.reason;
  const auto legs = DiagnosticsJson(plan)["legs"];
  ASSERT_EQ(legs.size(), 2U);
  ASSERT_EQ(plan.tree.size(),
            legs[0]["nodes"].get<std::size_t>() + legs[1]["nodes"].get<std::size_t>());
  const double inflation = 0.5 * ReferenceCar().width + 0.3 + 1.0;
  for (std::size_t i = 0; i < plan.tree.size(); ++i) {
    const TreeNode& node = plan.tree[i];
    const TreeNode& parent = plan.tree.at(node.parent);
    EXPECT_LE(node.parent, i);
    EXPECT_LE((node.position - parent.position).norm(), 2.0 + Tolerance(1e-9));
    EXPECT_NEAR(node.cost, parent.cost + (node.position - parent.position).norm(), Tolerance(1e-9));
    EXPECT_GE(Distance(parent.position, node.position, request.obstacles[0]),
              inflation - Tolerance(1e-9));
  }
  for (const auto& leg : legs) {
    EXPECT_EQ(leg["status"], "reached");
    EXPECT_GE(leg["path_m"].size(), 2U);
    EXPECT_EQ(leg["path_m"].size(), leg["smooth_m"].size());
    EXPECT_EQ(leg["path_m"].back(), leg["smooth_m"].back());
  }
}

TEST(RrtPlanner, TellsHowFarItCame) {
  // A wall across the whole sampled area.
  PlanRequest request = Across({{{30.0, 0.0, 0.0}, 1.0, 200.0}});
  const Plan plan = MakePlan(request, RrtPlannerOptions{.trees = 2, .iterations = 2000});
  EXPECT_EQ(plan.status, PlanStatus::kBudgetUsedUp);
  EXPECT_THAT(plan.reason, HasSubstr("2 trees of 2000 samples"));
  const auto leg = DiagnosticsJson(plan)["legs"].at(0);
  EXPECT_EQ(leg["status"], "iterations");
  EXPECT_EQ(leg["iterations"], 2000);
  // The near side of the wall is at 29.5 m, and the tree keeps 2.16 m from it.
  const double reached = leg["path_m"].back()[0];
  EXPECT_GT(reached, 25.0);
  EXPECT_LE(reached, 29.5 - 2.16);
  EXPECT_TRUE(plan.tree.empty());
}

TEST(RrtPlanner, TellsOfTheTreeThatCameNearest) {
  // A wall makes the goal unreachable. A run with more trees begins with the same trees as a run
  // with fewer trees.
  const PlanRequest request = Across({{{30.0, 0.0, 0.0}, 1.0, 200.0}});
  std::vector<double> left;
  for (int trees = 1; trees <= 8; ++trees) {
    const Plan plan = MakePlan(request, RrtPlannerOptions{.trees = trees, .iterations = 25});
    ASSERT_EQ(plan.status, PlanStatus::kBudgetUsedUp);
    const auto nearest = DiagnosticsJson(plan)["legs"].at(0)["path_m"].back();
    left.push_back((Vec2(nearest[0], nearest[1]) - Vec2(request.waypoints.back())).norm());
  }
  EXPECT_TRUE(std::is_sorted(left.rbegin(), left.rend()));
  EXPECT_LT(left.back(), left.front());
}

TEST(RrtPlanner, SaysWhenTheFirstMetersAreBlocked) {
  const Plan plan = MakePlan(Across({{{7.0, 0.0, 0.0}, 2.0, 1.0}}), RrtPlannerOptions{});
  EXPECT_EQ(plan.status, PlanStatus::kStartBlocked);
  EXPECT_THAT(plan.reason, HasSubstr("straight path"));
}

TEST(RrtPlanner, IsClearOrSaysWhyNotInRandomFields) {
  Random random(7);
  int planned = 0;
  for (int field = 0; field < 40; ++field) {
    PlanRequest request = Across({});
    for (int i = 0; i < 7; ++i) {
      request.obstacles.push_back(
          {{random.Uniform(10.0, 42.0), random.Uniform(-15.0, 15.0), random.Uniform(-kPi, kPi)},
           random.Uniform(1.0, 6.0),
           random.Uniform(1.0, 3.0)});
    }
    request.seed = static_cast<std::uint64_t>(field);
    const Plan plan = MakePlan(request, RrtPlannerOptions{});
    EXPECT_EQ(plan.reason.empty(), plan.ok());
    if (!plan.ok()) {
      EXPECT_EQ(plan.reference.path.length(), 0.0);
      continue;
    }
    ++planned;
    const Path& path = plan.reference.path;
    for (double s = 0.0; s <= path.length(); s += 0.05) {
      const PathPoint point = path.At(s);
      ASSERT_LE(std::abs(point.curvature), 1.0 / ReferenceCar().min_turning_radius() + 1e-12);
      for (const OrientedBox& box : request.obstacles) {
        // Between the checks of the planner, the farthest corner of the footprint may come 1.8 cm
        // closer.
        ASSERT_GE(Separation(FootprintAt(ReferenceCar(), point.pose), box), 0.3 - Tolerance(0.018));
      }
    }
  }
  EXPECT_GE(planned, 34);
}

TEST(RrtPlanner, RefusesOptionsThatMakeNoSense) {
  EXPECT_THROW(MakePlan(Across({}), RrtPlannerOptions{.trees = 0}), PreconditionError);
  EXPECT_THROW(
      MakePlan(Across({}), RrtPlannerOptions{.data_weight = 0.5, .smoothness_weight = 0.25}),
      InternalError);
}

TEST(RoutePlanners, RefuseARouteThatBeginsWhereTheCarStands) {
  PlanRequest request = Across({});
  request.waypoints = {{-5.0, 0.0}, {0.0, 0.0}, {20.0, 0.0}};
  for (const PlannerEntry& entry : Planners()) {
    if (entry.keeps_clear) {
      EXPECT_EQ(MakePlan(request, entry.defaults)->status, PlanStatus::kDuplicateWaypoints)
          << entry.name;
    }
  }
}

}  // namespace
}  // namespace trackbed
