// Tests the first meters of a rolling car's path.

#include "trackbed/planning/common/lead_in.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/vehicle/params.h"

namespace trackbed {
namespace {

PlanRequest RollingAt(double speed) {
  PlanRequest request;
  request.vehicle = ReferenceCar();
  request.vehicle.friction_lateral = request.vehicle.friction_longitudinal = 0.9;
  request.vehicle.max_deceleration = 0.9 * 9.81;
  request.start_speed = speed;
  request.speed = {.speed = speed, .acceleration = 1.0, .deceleration = 1.5};
  return request;
}

/// Share of the grip that plans through bends use for braking.
constexpr double kShare = 0.7;

TEST(ComputeLeadIn, LeavesRoomToBrakeOnIce) {
  PlanRequest request = RollingAt(3.0);
  // Dry, the car brakes from 3 to 1 m/s with 1.5 m/s^2.
  EXPECT_NEAR(ComputeLeadIn(request, 1.0, 2.0).length, (9.0 - 1.0) / 3.0 + 2.0, Tolerance(1e-12));
  request.friction = 0.05;
  const double ice = kShare * MaxDeceleration(request.vehicle, 0.05);
  EXPECT_LT(ice, 1.5);
  EXPECT_NEAR(ComputeLeadIn(request, 1.0, 2.0).length, (9.0 - 1.0) / (2.0 * ice) + 2.0,
              Tolerance(1e-12));
}

TEST(ComputeLeadIn, LeavesRoomToBrakeOnAPatchOfIce) {
  PlanRequest request = RollingAt(3.0);
  // The front axle reaches the ice after 1 m, at the speed sqrt(9 - 3) m/s.
  const double edge = 1.0 + request.vehicle.wheelbase;
  request.friction_patches = {{{{edge + 50.0, 0.0, 0.0}, 100.0, 20.0}, 0.05}};
  const double ice = kShare * MaxDeceleration(request.vehicle, 0.05);
  // The road is sampled every 0.1 m. On a piece of 0.1 m that touches the ice, the planner brakes
  // with the deceleration of ice instead of 1.5 m/s^2. This leaves up to 2 x 0.1 x 1.5 m^2/s^2 of
  // v^2 for braking on the ice.
  EXPECT_NEAR(ComputeLeadIn(request, 1.0, 0.0).length, 1.0 + (6.0 - 1.0) / (2.0 * ice),
              Tolerance(0.1 * 1.5 / ice));
}

// A patch elsewhere makes the planner sum up steps. On the dry road, v^2 falls by 2 a s. With the
// first numbers, rounding of the last step leaves a rest of v^2 that no further step makes smaller.
TEST(ComputeLeadIn, EndsForAnySpeedAndDeceleration) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> speeds(0.5, 15.0);
  std::uniform_real_distribution<double> decelerations(0.3, 3.0);
  for (int i = 0; i < 300; ++i) {
    PlanRequest request = RollingAt(i == 0 ? 6.2254695611450712 : speeds(random));
    request.friction_patches = {{{{0.0, 1000.0, 0.0}, 1.0, 1.0}, 0.05}};
    request.speed.deceleration = i == 0 ? 1.3779420264633053 : decelerations(random);
    const double length = request.start_speed * request.start_speed / request.speed.deceleration;
    // At most 3750 steps of 0.1 m, each with a relative rounding error of 1e-16.
    EXPECT_NEAR(ComputeLeadIn(request, 0.0, 0.0).length, 0.5 * length, Tolerance(1e-11 * length));
  }
}

TEST(DeparturePolylines, HaveRoomToStopOnTheirFirstLeg) {
  for (const double friction : {1.0, 0.05}) {
    PlanRequest request = RollingAt(5.0);
    request.friction = friction;
    const double braking = std::min(1.5, kShare * MaxDeceleration(request.vehicle, friction));
    for (const std::vector<Vec2>& points : DeparturePolylines(request)) {
      EXPECT_GE(points[1].x(), 25.0 / (2.0 * braking));
      EXPECT_NEAR(points[1].y(), 0.0, Tolerance(1e-12));
    }
  }
}

}  // namespace
}  // namespace trackbed
