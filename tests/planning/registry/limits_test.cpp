#include <gtest/gtest.h>

#include <string>

#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/registry/planners.h"

/// Tests that every planner supports speeds at the limit.
namespace trackbed {
namespace {

TEST(Limits, AreKeptOnThePathOfEveryPlanner) {
  PlanRequest request;
  request.vehicle = ReferenceCar();
  request.waypoints = {{0.0, 0.0}, {60.0, 0.0}, {60.0, 60.0}};
  request.speed = {.speed = 20.0, .acceleration = 1.0, .deceleration = 1.5};
  request.seed = 1;
  int planned = 0;
  for (const PlannerEntry& entry : Planners()) {
    // These planners need segments, a file, roads or a track as additional input.
    const std::string name = entry.name;
    if (name == "course" || name == "path_file" || entry.follows_lanes || entry.follows_track) {
      continue;
    }
    PlanRequest own = request;
    if (entry.min_waypoints == 0) {
      own.waypoints.clear();
    }
    const Plan usual = MakePlan(own, entry.defaults);
    ASSERT_TRUE(usual.ok()) << entry.name << ": " << usual.reason;
    own.limits = SpeedAtLimit{
        GgvDiagram({.mass = 1000.0, .rolling_mass = 1000.0}, {EllipticSection(4.0, 6.0, 6.0)}),
        {.share = 0.8, .jerk = 30.0}};
    const Plan fast = MakePlan(own, entry.defaults);
    ASSERT_TRUE(fast.ok()) << entry.name << ": " << fast.reason;
    ASSERT_TRUE(fast.diagnostics.speed_profile) << entry.name;
    const double length = fast.reference.path.length();
    EXPECT_EQ(fast.reference.speed.SpeedAt(length), 0.0) << entry.name;
    EXPECT_LT(fast.reference.speed.TimeAt(length), usual.reference.speed.TimeAt(length))
        << entry.name;
    EXPECT_LE(fast.diagnostics.speed_profile->lateral_max, 4.8 + Tolerance(1e-3)) << entry.name;
    EXPECT_LE(fast.diagnostics.speed_profile->driving_max, 3.2 + Tolerance(0.1)) << entry.name;
    EXPECT_LE(fast.diagnostics.speed_profile->braking_max, 4.8 + Tolerance(0.1)) << entry.name;
    ++planned;
  }
  EXPECT_GE(planned, 8);
}

}  // namespace
}  // namespace trackbed
