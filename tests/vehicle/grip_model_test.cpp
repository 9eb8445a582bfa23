#include "trackbed/vehicle/grip_model.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/tolerance.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace grip_model_test {

constexpr double kGrip = 0.9;
// Resolution of the largest accelerations [m/s^2]: bisection halves 40 m/s^2 sixteen times.
constexpr double kHalved = 40.0 / 65536.0;

/// A car on friction circles with brakes balanced according to the static loads.
GripModel Car(double cg_height = 0.5) {
  GripModel car{.forces = {.mass = 1500.0, .rolling_mass = 1500.0},
                .wheelbase = 2.7,
                .cg_height = cg_height,
                .drag_height = cg_height,
                .axles = {}};
  for (std::size_t i = 0; i < car.axles.size(); ++i) {
    GripAxle& axle = car.axles[i];
    axle.weight = i == 0 ? 0.6 : 0.4;
    axle.track = 1.5;
    axle.braking = axle.weight;
    axle.driving = i == 0 ? 1.0 : 0.0;
    axle.roll_stiffness = 50e3;
    axle.friction = kGrip;
  }
  return car;
}

TEST(GripModel, OfAPointMassIsTheFrictionCircle) {
  GripModel car = Car(1e-6);
  car.axles[0].driving = 0.6;
  car.axles[1].driving = 0.4;
  const double grip = kGrip * kGravity;
  const GgvDiagram diagram = ComputeGgv(car, {1.0, 0.5});
  for (const double road : {1.0, 0.5}) {
    // Between the angles q of the table, GgvDiagram interpolates f_x linearly in sin(q), which is
    // exact for a circle.
    for (const double lateral : {0.0, 0.3, 0.7, 0.95}) {
      const double left = grip * road * std::sqrt(1.0 - lateral * lateral);
      const TyreRange range = diagram.TyresAt({.road = road, .lateral = lateral * grip * road});
      // Near its maximum, the lateral acceleration f_y hardly depends on the longitudinal
      // acceleration f_x. Bisection of f_y to kHalved therefore leaves an error of f_x of up to
      // sqrt(2 kHalved mu g) = 0.1 m/s^2.
      EXPECT_NEAR(range.driving, left, Tolerance(0.02 * left + kHalved)) << lateral;
      EXPECT_NEAR(range.braking, -left, Tolerance(0.02 * left + kHalved)) << lateral;
    }
    EXPECT_NEAR(diagram.MaxLateral({.road = road}), grip * road, Tolerance(2.0 * kHalved));
  }
}

TEST(GripModel, LoadTransferDoesNotMatterToFrictionThatIsProportional) {
  // Each axle transmits mu times its load, for any distribution of the load between its wheels.
  EXPECT_NEAR(MaxLateralForce(Car(), 1.0, 0.0), kGrip * kGravity, Tolerance(kHalved));
  EXPECT_NEAR(MaxLateralForce(Car(), 0.4, 0.0), 0.4 * kGrip * kGravity, Tolerance(kHalved));
}

TEST(GripModel, BrakesAndDrivesStraightAsTheAxleThatSlidesFirstAllows) {
  const GripModel car = Car();
  const GgvDiagram diagram = ComputeGgv(car, {1.0});
  const double transfer = car.cg_height / car.wheelbase;
  const AccelerationLimit braking{100.0, {{0.6, 0.6, transfer}, {0.4, 0.4, -transfer}}};
  const AccelerationLimit driving{100.0, {{0.6, 1.0, -transfer}}};
  const TyreRange straight = diagram.TyresAt({});
  EXPECT_NEAR(straight.braking, -braking.At(kGrip), Tolerance(2.0 * kHalved));
  EXPECT_NEAR(straight.driving, driving.At(kGrip), Tolerance(2.0 * kHalved));
}

TEST(GripModel, RollsOverWhereTheInnerWheelsLift) {
  // The inner wheels lift where the roll moment m f_y h K/(K - m g h) equals m g t/2. K is the roll
  // stiffness of both axles, t the track width and h the height of the center of gravity.
  GripModel car = Car(0.95);
  const double lean = 1500.0 * kGravity * 0.95 / 100e3;
  const double expected = kGravity * 0.5 * 1.5 / 0.95 * (1.0 - lean);
  ASSERT_LT(expected, kGrip * kGravity);
  EXPECT_NEAR(MaxLateralForce(car, 1.0, 0.0), expected, Tolerance(kHalved));
}

TEST(GripModel, LoadSensitiveTyresLoseGripByLoadTransfer) {
  // The friction coefficient of a wheel with the load F is mu = 1 + p (F - F0)/F0, with p = -0.1
  // and the load F0 at rest. An axle with the wheel loads F0 - d and F0 + d transmits 2 F0 - 0.2
  // d^2/F0 if both wheels reach their largest force at the same slip angle. This holds for a
  // cornering stiffness proportional to mu F. In this model, the stiffness is proportional to F, so
  // the slip angles of the largest forces differ by a fraction of 0.2 d/F0. This difference reduces
  // the force by less than 1 %.
  GripModel car = Car();
  MagicFormula tyre;
  tyre.p_cx1 = 1.6;
  tyre.p_dx1 = 1.0;
  tyre.p_kx1 = 20.0;
  tyre.p_cy1 = 1.4;
  tyre.p_dy1 = 1.0;
  tyre.p_dy2 = -0.1;
  tyre.p_ky1 = -20.0;
  tyre.f_z0 = 0.25 * 1500.0 * kGravity;
  for (GripAxle& axle : car.axles) {
    axle.weight = 0.5;
    axle.tyre = tyre;
  }
  // The car coasts, so no drive force compensates the drag of the slip angles. The wheelbase is so
  // long that the deceleration transfers no load.
  car.wheelbase = 1e3;
  const double found = ComputeGgv(car, {1.0}).MaxLateral({});
  const double lean = 1500.0 * kGravity * car.cg_height / 100e3;
  const double shift = 1500.0 * found * car.cg_height / (1.0 - lean) / (2.0 * 1.5);
  const double expected = kGravity * (1.0 - 0.1 * std::pow(shift / tyre.f_z0, 2));
  EXPECT_LT(expected, 0.98 * kGravity);  // load sensitivity has a visible effect
  EXPECT_NEAR(found, expected, Tolerance(0.01 * expected));
}

TEST(GripModel, DragPressesOnTheRearAxle) {
  GripModel car = Car();
  car.forces.drag = 0.5;
  car.drag_height = 1.5;
  const GgvDiagram diagram = ComputeGgv(car, {1.0});
  // Only the front axle drives. The drag D at the height z_D and the acceleration f_x reduce its
  // load by (D (z_D - h) + m f_x h)/L.
  const double speed = 40.0;
  const double drag = 0.5 * speed * speed;
  const double weight = 1500.0 * kGravity;
  const double expected =
      kGrip * (0.6 * weight - drag * 1.0 / 2.7) / (1500.0 * (1.0 + kGrip * 0.5 / 2.7));
  EXPECT_NEAR(diagram.TyresAt({.speed = speed}).driving, expected, Tolerance(3.0 * kHalved));
}

TEST(GripModel, SteeredWheelsPullSideways) {
  // A point mass on friction circles turns without slip angles at the radius v^2/f_y, with front
  // wheels at delta = atan(L f_y/v^2). Across the car, the front axle has the part 0.6 of the
  // weight and of the drive force f_x, so it slides if (f_y - f_x sin(delta))/cos(delta) =
  // sqrt((mu g)^2 - f_x^2).
  GripModel car = Car(1e-6);
  car.axles[0].driving = 0.6;
  car.axles[1].driving = 0.4;
  car.steering_limit = 0.6;
  const double grip = kGrip * kGravity;
  const GgvDiagram steered = ComputeGgv(car, {1.0});
  ASSERT_GE(steered.sections().size(), 3U);
  for (const GgvSection& section : steered.sections()) {
    SCOPED_TRACE(section.speed);
    const double along = section.driving.front();
    const double circle = std::sqrt(grip * grip - along * along);
    double low = 0.0;
    double high = grip;
    for (int i = 0; i < 50; ++i) {
      const double lateral = 0.5 * (low + high);
      const double delta = std::min(
          std::atan(car.wheelbase * lateral / (section.speed * section.speed)), car.steering_limit);
      const bool holds = lateral - along * std::sin(delta) < circle * std::cos(delta);
      (holds ? low : high) = lateral;
    }
    // The iteration ends if the force on the front axle, which carries 0.6 of the lateral force,
    // changes by less than 0.005 m/s^2 per mass of the car.
    EXPECT_NEAR(section.lateral, low, Tolerance(0.005 / 0.6 + 2.0 * kHalved));
  }
  // At the least speed the wheels are at full lock, at which the loss is that of the cosine.
  EXPECT_LT(steered.sections().front().lateral, 0.95 * grip);
  EXPECT_NEAR(steered.MaxLateral({.speed = 60.0}), grip, Tolerance(0.01 * grip));
  car.steering_limit = 0.0;
  EXPECT_NEAR(ComputeGgv(car, {1.0}).MaxLateral({.speed = 1.0}), grip, Tolerance(2.0 * kHalved));
}

TEST(GripModel, FrictionOfParametersIsAnEllipse) {
  VehicleParams vehicle;
  vehicle.mass = 3.0;
  vehicle.friction_longitudinal = 0.8;
  vehicle.friction_lateral = 0.7;
  vehicle.max_acceleration = 3.0;
  vehicle.max_deceleration = 6.0;
  const GgvDiagram diagram = FrictionGgv(vehicle, {0.5, 1.0});
  EXPECT_NEAR(diagram.MaxLateral({}), 0.7 * kGravity, Tolerance(1e-12));
  EXPECT_NEAR(diagram.MaxLateral({.road = 0.5}), 0.35 * kGravity, Tolerance(1e-12));
  EXPECT_NEAR(diagram.TyresAt({}).driving, 3.0, Tolerance(1e-12));
  EXPECT_NEAR(diagram.TyresAt({.road = 0.5}).braking, -3.0, Tolerance(1e-12));
  EXPECT_THROW(FrictionGgv({}, {1.0}), PreconditionError);
}

TEST(GripModel, RejectsCarsThatDoNotStand) {
  GripModel car = Car();
  EXPECT_THROW(ComputeGgv(car, {}), PreconditionError);
  car.axles[0].roll_stiffness = 100.0;
  car.axles[1].roll_stiffness = 100.0;
  EXPECT_THROW(ComputeGgv(car, {1.0}), PreconditionError);
  car = Car();
  car.axles[1].friction = 0.0;
  EXPECT_THROW(MaxLateralForce(car, 1.0, 0.0), PreconditionError);
}

}  // namespace grip_model_test
}  // namespace trackbed
