#include "trackbed/vehicle/ggv_diagram.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/tolerance.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace ggv_diagram_test {

// Rounding: a few operations on numbers below 100.
constexpr double kRounding = 1e-13;
constexpr LongitudinalForces kCar{.mass = 1000.0, .rolling_mass = 1050.0};

GgvSection At(GgvSection section, double speed, double road) {
  section.speed = speed;
  section.road = road;
  return section;
}

TEST(GgvDiagram, OfAnEllipseIsExact) {
  const GgvDiagram diagram(kCar, {EllipticSection(6.0, 9.0, 8.0)});
  for (const double lateral : {0.0, 2.0, -5.0, 7.9, 8.0}) {
    const TyreRange range = diagram.TyresAt({.speed = 10.0, .lateral = lateral});
    const double left = std::sqrt(1.0 - lateral * lateral / 64.0);
    EXPECT_NEAR(range.driving, 6.0 * left, Tolerance(kRounding));
    EXPECT_NEAR(range.braking, -9.0 * left, Tolerance(kRounding));
  }
  EXPECT_EQ(diagram.MaxLateral({}), 8.0);
  EXPECT_EQ(diagram.TyresAt({.lateral = 20.0}).driving, 0.0);  // clamped to the table
}

TEST(GgvDiagram, ScalesWithLoadAndIsLinearInSquaredSpeedAndRoad) {
  const GgvSection base = EllipticSection(6.0, 6.0, 8.0);
  const GgvSection fast = EllipticSection(9.0, 9.0, 12.0);
  const GgvDiagram diagram(
      kCar, {At(fast, 40.0, 1.0), At(base, 0.0, 1.0), At(base, 0.0, 0.5), At(base, 40.0, 0.5)});
  EXPECT_EQ(diagram.MaxLateral({.speed = 0.0}), 8.0);
  EXPECT_EQ(diagram.MaxLateral({.speed = 90.0}), 12.0);
  EXPECT_NEAR(diagram.MaxLateral({.speed = 20.0}), 9.0, Tolerance(kRounding));  // 400 of 1600
  EXPECT_NEAR(diagram.MaxLateral({.speed = 20.0, .road = 0.75}), 8.5, Tolerance(kRounding));
  EXPECT_NEAR(diagram.MaxLateral({.speed = 20.0, .road = 0.25}), 4.0, Tolerance(kRounding));
  EXPECT_NEAR(diagram.MaxLateral({.speed = 40.0, .road = 2.0}), 24.0, Tolerance(kRounding));
  EXPECT_NEAR(diagram.MaxLateral({.load = 0.5}), 4.0, Tolerance(kRounding));
  EXPECT_NEAR(diagram.TyresAt({.speed = 20.0, .load = 0.5}).driving, 0.5 * 6.75,
              Tolerance(kRounding));
}

TEST(GgvDiagram, MotorGivesForceUpToItsPower) {
  LongitudinalForces car = kCar;
  const GgvSection section = EllipticSection(6.0, 6.0, 8.0);
  EXPECT_EQ(GgvDiagram(car, {section}).DriveForce(10.0), std::numeric_limits<double>::infinity());
  car.drive_power = 50e3;
  EXPECT_EQ(GgvDiagram(car, {section}).DriveForce(10.0), 5000.0);
  car.drive_force = 4000.0;
  EXPECT_EQ(GgvDiagram(car, {section}).DriveForce(10.0), 4000.0);
  EXPECT_EQ(GgvDiagram(car, {section}).DriveForce(20.0), 2500.0);
}

TEST(GgvDiagram, RejectsWhatIsNoDiagram) {
  const GgvSection section = EllipticSection(6.0, 6.0, 8.0);
  EXPECT_THROW(GgvDiagram(kCar, {}), InternalError);
  EXPECT_THROW(GgvDiagram({}, {section}), InternalError);
  EXPECT_THROW(GgvDiagram(kCar, {EllipticSection(6.0, -9.0, 8.0)}), InternalError);
  EXPECT_THROW(GgvDiagram(kCar, {EllipticSection(6.0, 6.0, 0.0)}), InternalError);
  // Two speeds and two roads need four different sections.
  EXPECT_THROW(GgvDiagram(kCar, {section, At(section, 10.0, 0.5)}), InternalError);
  EXPECT_THROW(GgvDiagram(kCar, {section, section}), InternalError);
}

}  // namespace ggv_diagram_test
}  // namespace trackbed
