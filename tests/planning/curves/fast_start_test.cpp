// Tests plans for cars that start faster than the speed of the mission.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/vehicle/reference_car.h"
#include "trackbed/core/angle.h"
#include "trackbed/planning/curves/curve_planners.h"
#include "trackbed/planning/registry/planners.h"

namespace trackbed {
namespace {

TEST(DubinsPlanner, LetsAFastStartPassTheFirstArcs) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int i = 0; i < 100; ++i) {
    PlanRequest request;
    request.vehicle = ReferenceCar();
    request.speed = {.speed = 0.5 + 10.0 * unit(random), .acceleration = 1.0, .deceleration = 1.5};
    request.start_speed = (1.05 + 0.45 * unit(random)) * request.speed.speed;
    // The legs are long enough to stop on: stopping needs at most 15.75^2/3 m = 83 m.
    const Vec2 first(150.0 + 300.0 * unit(random), 0.0);
    const double turn = 3.0 * (unit(random) - 0.5);
    request.waypoints = {{0.0, 0.0}, first, first + 200.0 * Direction(turn)};
    const Plan plan = MakePlan(request, DubinsOptions{});
    EXPECT_TRUE(plan.ok()) << i << ": " << plan.reason;
  }
}

}  // namespace
}  // namespace trackbed
