#include "trackbed/analysis/path_properties.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

namespace trackbed {
namespace {

constexpr double kRounding = 1e-12;

/// A car of 4 m by 2 m, its rear axle 1 m ahead of the rear end.
VehicleParams Car() {
  VehicleParams car;
  car.length = 4.0;
  car.width = 2.0;
  car.rear_overhang = 1.0;
  return car;
}

Plan PlanOf(std::vector<Segment> segments) {
  Plan plan;
  plan.reference.path = Path(Pose2{}, std::move(segments));
  const double length = plan.reference.path.length();
  plan.reference.speed = SpeedProfile({{0.0, 2.0}, {length, 2.0}});
  return plan;
}

std::optional<double> Property(const std::string& name, const Plan& plan, const World& world = {}) {
  const VehicleParams car = Car();
  for (const PathProperty& property : PathProperties()) {
    if (property.name == name) {
      return property.measure({plan, world, car});
    }
  }
  ADD_FAILURE() << "no property " << name;
  return std::nullopt;
}

TEST(PathProperties, OfALineAndAnArc) {
  const double quarter = 10.0 * std::numbers::pi / 2.0;
  const Plan plan = PlanOf({{.length = 5.0}, {.length = quarter, .curvature = -0.1}});
  const double length = 5.0 + quarter;
  EXPECT_NEAR(*Property("length_m", plan), length, kRounding);
  EXPECT_NEAR(*Property("duration_s", plan), length / 2.0, kRounding);
  EXPECT_NEAR(*Property("curvature_max_radpm", plan), 0.1, kRounding);
  EXPECT_NEAR(*Property("curvature_rms_radpm", plan), 0.1 * std::sqrt(quarter / length), kRounding);
  EXPECT_NEAR(*Property("turning_rad", plan), std::numbers::pi / 2.0, kRounding);
  EXPECT_NEAR(*Property("curvature_rate_max_radpm2", plan), 0.0, kRounding);
  EXPECT_NEAR(*Property("curvature_jump_max_radpm", plan), 0.1, kRounding);
  EXPECT_EQ(Property("clearance_min_m", plan), std::nullopt);
}

// The curvature kappa(d) = 0.1 - 0.02 d over 10 m turns to the left on the first half and to the
// right on the second half. The integral of kappa^2 is 2 (0.1^2 5/3), and the integral of |kappa|
// is 2 (0.1 5/2).
TEST(PathProperties, OfAClothoidThatTurnsBothWays) {
  const Plan plan = PlanOf({{.length = 10.0, .curvature = 0.1, .sharpness = -0.02}});
  EXPECT_NEAR(*Property("curvature_max_radpm", plan), 0.1, kRounding);
  EXPECT_NEAR(*Property("curvature_rms_radpm", plan), std::sqrt(0.1 * 0.1 / 3.0), kRounding);
  EXPECT_NEAR(*Property("turning_rad", plan), 0.5, kRounding);
  EXPECT_NEAR(*Property("curvature_rate_max_radpm2", plan), 0.02, kRounding);
  EXPECT_NEAR(*Property("curvature_jump_max_radpm", plan), 0.0, kRounding);
}

// The curvature is kappa(d) = 0.01 (d - 2) (d - 6) over 8 m, with the minimum -0.04 in the middle.
// The path turns by 32/300 rad three times, to alternating sides: the integral of (d - 2) (d - 6)
// is 32/3 from 0 to 2, -32/3 from 2 to 6 and 32/3 from 6 to 8.
TEST(PathProperties, OfAQuadraticCurvatureThatCrossesZeroTwice) {
  const Plan plan =
      PlanOf({{.length = 8.0, .curvature = 0.12, .sharpness = -0.08, .sharpness_rate = 0.02}});
  EXPECT_NEAR(*Property("curvature_max_radpm", plan), 0.12, kRounding);
  EXPECT_NEAR(*Property("turning_rad", plan), 3.0 * 0.32 / 3.0, kRounding);
  EXPECT_NEAR(*Property("curvature_rate_max_radpm2", plan), 0.08, kRounding);
  const Plan middle =
      PlanOf({{.length = 8.0, .curvature = 0.0, .sharpness = -0.08, .sharpness_rate = 0.02}});
  // The curvature -0.08 d + 0.01 d^2 is least at d = 4 m, where it is -0.16.
  EXPECT_NEAR(*Property("curvature_max_radpm", middle), 0.16, kRounding);
}

// At cusps and stops the wheels turn while the car stands.
TEST(PathProperties, LeaveOutJumpsAtCuspsAndStops) {
  const std::vector<Segment> cusp{{.length = 5.0, .curvature = 0.1},
                                  {.length = 5.0, .curvature = -0.1, .direction = -1}};
  EXPECT_NEAR(*Property("curvature_jump_max_radpm", PlanOf(cusp)), 0.0, kRounding);
  Plan stop = PlanOf({{.length = 5.0, .curvature = 0.1}, {.length = 5.0, .curvature = -0.1}});
  EXPECT_NEAR(*Property("curvature_jump_max_radpm", stop), 0.2, kRounding);
  stop.stops = {5.0};
  EXPECT_NEAR(*Property("curvature_jump_max_radpm", stop), 0.0, kRounding);
}

// Segments that agree except in the last digit have no jump, so that such paths rank equally in a
// study.
TEST(PathProperties, CountARoundedJumpAsNone) {
  const double next = std::nextafter(0.1, 1.0);
  const Plan plan = PlanOf({{.length = 5.0, .curvature = 0.1}, {.length = 5.0, .curvature = next}});
  EXPECT_EQ(*Property("curvature_jump_max_radpm", plan), 0.0);
}

// The footprint's side is at y = 1, the box begins at y = 1.7. Moving obstacles and obstacles that
// are not yet known do not count: the planner did not consider them.
TEST(PathProperties, MeasureTheClearanceOfWhatThePlannerKnew) {
  const Plan plan = PlanOf({{.length = 30.0}});
  World world;
  world.obstacles.push_back({.footprint = {{15.0, 2.2, 0.0}, 0.2, 1.0}});
  constexpr double kTolerance = 0.01;  // as stated in the header
  const double clearance = *Property("clearance_min_m", plan, world);
  EXPECT_GE(clearance, 0.7 - kRounding);
  EXPECT_LE(clearance, 0.7 + kTolerance);
  world.obstacles.push_back({.footprint = {{5.0, 1.5, 0.0}, 1.0, 1.0}, .velocity = Vec2(1.0, 0.0)});
  world.obstacles.push_back({.footprint = {{5.0, 1.5, 0.0}, 1.0, 1.0}, .known_from_time = 1.0});
  EXPECT_EQ(*Property("clearance_min_m", plan, world), clearance);
  world.obstacles.push_back({.footprint = {{5.0, 1.5, 0.0}, 1.0, 1.2}});
  EXPECT_EQ(*Property("clearance_min_m", plan, world), 0.0);
}

TEST(PathProperties, MeasureTheDistanceFromWaypoints) {
  Plan plan = PlanOf({{.length = 10.0}});
  EXPECT_EQ(Property("waypoint_miss_max_m", plan), std::nullopt);
  plan.waypoints = {{0.0, 9.0}, {4.0, -2.0}, {10.0, 0.0}};
  EXPECT_NEAR(*Property("waypoint_miss_max_m", plan), 2.0, kRounding);
}

TEST(PathProperties, OfNoLength) {
  Plan plan;
  plan.reference.speed = SpeedProfile({{0.0, 0.0}});
  for (const PathProperty& property : PathProperties()) {
    EXPECT_EQ(property.measure({plan, World{}, Car()}).value_or(0.0), 0.0) << property.name;
  }
}

}  // namespace
}  // namespace trackbed
