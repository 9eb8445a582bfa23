// Tests that plans from rest are slowed down until the road holds them, for every position of the
// ice.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/vehicle/reference_car.h"
#include "trackbed/core/angle.h"
#include "trackbed/planning/common/feasibility.h"
#include "trackbed/planning/course/course.h"
#include "trackbed/planning/registry/planners.h"

namespace trackbed {
namespace {

TEST(Feasibility, SlowsDownForIceAnywhereInABend) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const auto between = [&](double low, double high) { return low + (high - low) * unit(random); };
  for (int i = 0; i < 100; ++i) {
    PlanRequest request;
    request.vehicle = ReferenceCar();
    request.vehicle.friction_lateral = request.vehicle.friction_longitudinal = 0.9;
    request.vehicle.max_deceleration = 0.9 * 9.81;
    request.vehicle.max_acceleration = 4.0;
    request.waypoints = {{0.0, 0.0}};
    request.speed = {.speed = between(2.0, 12.0), .acceleration = 1.0, .deceleration = 1.5};
    double slipperiest = 1.0;
    for (int k = 0; k < 3; ++k) {
      // Narrow patches have edges that cross the path at any angle between two checked points.
      const double length = std::exp(between(std::log(0.05), std::log(30.0)));
      const double friction = between(0.05, 0.4);
      request.friction_patches.push_back(
          {{{between(0.0, 60.0), between(-2.0, 15.0), between(-kPi, kPi)}, length, 10.0},
           friction});
      slipperiest = std::min(slipperiest, friction);
    }
    // The car climbs a grade of 4.0 / 9.81 = 0.41 times the friction factor of the ice.
    const double grade = 0.3 * slipperiest * unit(random);
    const double downhill = between(-kPi, kPi);
    request.ground.grade = {grade * std::cos(downhill), grade * std::sin(downhill)};
    const double curvature = between(0.01, 0.1);
    const Plan plan = MakePlan(
        request, CourseOptions{.segments = {{.length = between(5.0, 30.0), .curvature = 0.0},
                                            {.length = 20.0, .curvature_to = curvature},
                                            {.length = between(1.0, 20.0), .curvature = curvature},
                                            {.length = 20.0, .curvature_to = 0.0},
                                            {.length = between(5.0, 30.0), .curvature = 0.0}}});
    EXPECT_TRUE(plan.ok()) << i << ": " << plan.reason;
    EXPECT_TRUE(FindExcesses(plan, request).empty()) << i;
  }
}

}  // namespace
}  // namespace trackbed
