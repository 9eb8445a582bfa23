#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/planning/common/collision_checker.h"
#include "trackbed/planning/grid/astar_planner.h"
#include "trackbed/planning/registry/planners.h"
#include "trackbed/planning/sampling/rrt_planner.h"
#include "trackbed/planning/sampling/rrt_star_planner.h"

// Gates between walls, which the planners with rounded corners drive through if the car fits.
namespace trackbed {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kGateDistance = 0.3;  // default safe_distance [m]

PlanRequest ThroughAGate(double width, double wall) {
  PlanRequest request;
  request.vehicle = ReferenceCar();
  request.waypoints = {{0.0, 0.0}, {40.0, 0.0}};
  const double center = 0.5 * (width + wall);
  request.obstacles = {{{20.0, center, 0.0}, 2.0, wall}, {{20.0, -center, 0.0}, 2.0, wall}};
  request.speed = {.speed = 3.0, .acceleration = 1.0, .deceleration = 1.5};
  return request;
}

std::vector<PlannerOptions> PlannersOfCorners() {
  return {AStarOptions{}, RrtPlannerOptions{}, RrtStarPlannerOptions{}};
}

TEST(CornerRoom, IsReducedWhereTheCarFitsThroughAGate) {
  // The straight path is the shortest one. It keeps the safe distance from both walls if the gate
  // is as wide as the car and twice this distance.
  const double fits = ReferenceCar().width + 2.0 * kGateDistance;
  for (const PlannerOptions& planner : PlannersOfCorners()) {
    for (const double more : {0.05, 0.5, 1.5}) {
      const PlanRequest request = ThroughAGate(fits + more, 10.0);
      const Plan plan = MakePlan(request, planner);
      ASSERT_TRUE(plan.ok()) << plan.reason;
      EXPECT_NEAR(plan.reference.path.length(), 40.0, Tolerance(1e-9));
      EXPECT_THAT(plan.notes, Contains(HasSubstr("corner_room is reduced from 1 m to ")));
      const CollisionChecker clear(request.vehicle, request.obstacles, kGateDistance);
      EXPECT_FALSE(clear.FirstBlocked(plan.reference.path));
    }
  }
}

TEST(CornerRoom, DetourOfARollingStartIsNamed) {
  // From 14 m/s, the car needs 65 m to stop at 1.5 m/s^2, so it drives past a goal 6 m ahead.
  PlanRequest request = ThroughAGate(1.0, 1.0);
  request.obstacles.clear();
  request.waypoints = {{0.0, 0.0}, {6.0, 1.0}};
  request.start_speed = 14.0;
  for (const PlannerOptions& planner : PlannersOfCorners()) {
    const Plan plan = MakePlan(request, planner);
    ASSERT_TRUE(plan.ok()) << plan.reason;
    EXPECT_GT(plan.reference.path.length(), 65.0);
    EXPECT_THAT(plan.notes, Contains(HasSubstr("because the car starts at 14 m/s; with "
                                               "mission.start.speed: 0, it is 6")));
  }
}

TEST(CornerRoom, IsKeptWhereItCostsNoDetour) {
  // The first gate is wide enough for the whole corner_room of 1 m; A* adds half a diagonal of a
  // cell of 0.5 m, 0.354 m. The second gate is too narrow for the car, so the path leads around it
  // with the whole corner_room.
  const double wide = ReferenceCar().width + 2.0 * (kGateDistance + 1.0 + 0.36);
  const double narrow = ReferenceCar().width + 2.0 * kGateDistance - 0.1;
  for (const PlannerOptions& planner : PlannersOfCorners()) {
    const Plan through = MakePlan(ThroughAGate(wide, 10.0), planner);
    ASSERT_TRUE(through.ok()) << through.reason;
    EXPECT_NEAR(through.reference.path.length(), 40.0, Tolerance(1e-9));
    EXPECT_THAT(through.notes, Not(Contains(HasSubstr("corner_room"))));
    const PlanRequest request = ThroughAGate(narrow, 10.0);
    const Plan around = MakePlan(request, planner);
    ASSERT_TRUE(around.ok()) << around.reason;
    EXPECT_GT(around.reference.path.length(), 40.0);
    const CollisionChecker clear(request.vehicle, request.obstacles, kGateDistance);
    EXPECT_FALSE(clear.FirstBlocked(around.reference.path));
    EXPECT_THAT(around.notes, Not(Contains(HasSubstr("corner_room"))));
  }
}

}  // namespace
}  // namespace trackbed
