#include "trackbed/vehicle/params.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/geometry/random.h"
#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"
#include "tests/vehicle/wheel_pair.h"
#include "trackbed/core/angle.h"

namespace trackbed {
namespace params_test {

// Rounding: some ten operations on numbers of order one.
constexpr double kRounding = 1e-14;

double Cot(double angle) {
  return 1.0 / std::tan(angle);
}

TEST(SteeringForCurvature, HasThePrintedTable) {
  // The published table has delta = atan(L/r), rounded to 1e-6 rad and 1e-4 degrees.
  struct Row {
    double radius, steering, degrees;
  };
  for (const Row& row :
       {Row{5.1, 0.486899, 27.8973}, Row{10.0, 0.263712, 15.1096}, Row{20.0, 0.134189, 7.6884},
        Row{50.0, 0.053948, 3.0910}, Row{154.0, 0.017531, 1.0044}}) {
    SCOPED_TRACE(row.radius);
    const double steering = SteeringForCurvature(ReferenceCar(), 1.0 / row.radius);
    EXPECT_NEAR(steering, row.steering, Tolerance(0.5e-6));
    EXPECT_NEAR(steering * 180.0 / kPi, row.degrees, Tolerance(0.5e-4));
    EXPECT_NEAR(SteeringForCurvature(ReferenceCar(), -1.0 / row.radius), -steering,
                Tolerance(kRounding));
  }
}

TEST(CurvatureForSteering, InvertsSteeringForCurvature) {
  Random random(1);
  for (int i = 0; i < 200; ++i) {
    const double curvature = random.Uniform(-0.5, 0.5);
    EXPECT_NEAR(
        CurvatureForSteering(ReferenceCar(), SteeringForCurvature(ReferenceCar(), curvature)),
        curvature, Tolerance(kRounding));
  }
}

TEST(VehicleParams, DerivedLengthsFollow) {
  EXPECT_NEAR(ReferenceCar().min_turning_radius(), 5.1, Tolerance(kRounding * 5.1));
  EXPECT_NEAR(ReferenceCar().cg_to_front(), 1.3, Tolerance(kRounding));
}

TEST(AckermannAngles, InnerWheelTurnsFurther) {
  const FrontAngles left = AckermannAngles(ReferenceCar(), 0.3);
  EXPECT_GT(left.left, 0.3);
  EXPECT_LT(left.right, 0.3);
  EXPECT_GT(left.right, 0.0);
  const FrontAngles right = AckermannAngles(ReferenceCar(), -0.3);
  EXPECT_NEAR(right.right, -left.left, Tolerance(kRounding));
  EXPECT_NEAR(right.left, -left.right, Tolerance(kRounding));
}

TEST(AckermannAngles, KeepTheCotangentRelation) {
  // The cotangents of the wheel angles differ by track/wheelbase, and their mean is the cotangent
  // of the steering angle.
  const VehicleParams car = ReferenceCar();
  for (int i = 1; i <= 48; ++i) {
    const double steering = 0.01 * i;
    SCOPED_TRACE(steering);
    const FrontAngles front = AckermannAngles(car, steering);
    // The rounding error of an angle changes a cotangent of up to 100 by 1/sin^2 = 1e4 times as
    // much.
    const double tolerance = Tolerance(1e-16 / std::pow(std::sin(steering), 2) * 10.0);
    EXPECT_NEAR(Cot(front.right) - Cot(front.left), 1.505 / 2.7, tolerance);
    EXPECT_NEAR(0.5 * (Cot(front.right) + Cot(front.left)), Cot(steering), tolerance);
  }
}

TEST(AckermannAngles, WheelsPointAtOneCenter) {
  // Each wheel is perpendicular to the line from the turning center (0, L cot delta) to its hub.
  const VehicleParams car = ReferenceCar();
  for (const double steering : {-0.48, -0.1, 0.02, 0.25, 0.4868}) {
    SCOPED_TRACE(steering);
    const double center = car.wheelbase * Cot(steering);
    const FrontAngles front = AckermannAngles(car, steering);
    for (const auto& [angle, y] : {std::pair{front.left, 0.5 * car.track_front},
                                   std::pair{front.right, -0.5 * car.track_front}}) {
      // Rounding of meters times a unit vector; the center is up to 135 m away.
      EXPECT_NEAR(car.wheelbase * std::cos(angle) + (y - center) * std::sin(angle), 0.0,
                  Tolerance(135.0 * kRounding));
    }
  }
}

TEST(BicycleAngle, InvertsAckermannAngles) {
  const VehicleParams car = ReferenceCar();
  Random random(2);
  for (int i = 0; i < 500; ++i) {
    const double steering = random.Uniform(-car.steering_limit, car.steering_limit);
    EXPECT_NEAR(BicycleAngle(car, AckermannAngles(car, steering)), steering, Tolerance(kRounding));
  }
  for (const double tiny : {0.0, 1e-300, 1e-12, -1e-9}) {
    EXPECT_NEAR(BicycleAngle(car, AckermannAngles(car, tiny)), tiny, Tolerance(1e-24));
  }
}

TEST(BicycleAngle, ReadsToeAsNearlyNothing) {
  // With a toe angle of +-epsilon, the bicycle angle of each wheel is +-epsilon (1 -+ k epsilon).
  // The mean of both angles is at most k epsilon^2, with k = track/(2 L) = 0.279. The mean of the
  // cotangents would give an angle of 90 degrees.
  const VehicleParams car = ReferenceCar();
  for (const double toe : {1e-6, -1e-6, 1e-3, -1e-3, 0.02}) {
    SCOPED_TRACE(toe);
    EXPECT_LE(std::abs(BicycleAngle(car, {.left = toe, .right = -toe})),
              Tolerance(0.28 * toe * toe * 1.1));
  }
}

TEST(BicycleAngle, IsTheMeanOfSmallAngles) {
  const VehicleParams car = ReferenceCar();
  Random random(3);
  for (int i = 0; i < 200; ++i) {
    const double left = random.Uniform(-1e-4, 1e-4);
    const double right = random.Uniform(-1e-4, 1e-4);
    SCOPED_TRACE(fmt::format("left {}, right {}", left, right));
    // The mean is exact to first order in epsilon; the term of second order is k epsilon^2, with k
    // = 0.28.
    EXPECT_NEAR(BicycleAngle(car, {left, right}), 0.5 * (left + right), Tolerance(0.28e-8));
  }
}

TEST(AxleSpeedsFor, GivesTheRatioThatTheAngleStandsFor) {
  const VehicleParams pair = WheelPair();
  for (const double speed : {2.0, 0.3, -1.5}) {
    for (const double steering : {0.0, 0.2, -0.9}) {
      const AxleSpeeds wheels = AxleSpeedsFor(pair, speed, steering);
      EXPECT_NEAR(0.5 * (wheels.left + wheels.right), speed, Tolerance(kRounding));
      EXPECT_NEAR((wheels.right - wheels.left) / speed, std::tan(steering), Tolerance(kRounding));
    }
  }
}

TEST(AxleSpeedsFor, StopsTheInnerWheelOnHalfTheTrack) {
  const AxleSpeeds wheels = AxleSpeedsFor(WheelPair(), 2.0, std::atan(0.6 / 0.3));
  EXPECT_NEAR(wheels.left, 0.0, Tolerance(kRounding));
  EXPECT_NEAR(wheels.right, 4.0, Tolerance(kRounding));
}

}  // namespace params_test
}  // namespace trackbed
