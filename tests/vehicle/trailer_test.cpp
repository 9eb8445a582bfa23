#include "trackbed/vehicle/trailer.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/geometry/random.h"
#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/vehicle/towing_car.h"

// Tests the kinematic trailer against closed forms (steady circle, tractrix, growth in reverse) and
// against numerical integration, and the jackknife angle against a search over the outlines.
namespace trackbed {
namespace {

TrailerParams RandomTrailer(Random& random) {
  return MakeTrailer({.hitch = random.Uniform(0.83, 2.0),
                      .tongue = random.Uniform(2.6, 6.0),
                      .length = random.Uniform(1.0, 4.0),
                      .width = random.Uniform(0.8, 2.5),
                      .body_ahead = random.Uniform(-0.5, 0.5)},
                     ReferenceCar());
}

TEST(Trailer, TurnsLeftWithAPositiveAngle) {
  const TrailerParams trailer = MakeTrailer({.hitch = 1.0, .tongue = 3.0}, ReferenceCar());
  const Pose2 straight = TrailerPose(trailer, {5.0, 1.0, kPi / 2.0}, 0.0);
  EXPECT_NEAR(straight.x, 5.0, Tolerance(1e-15));
  EXPECT_NEAR(straight.y, -3.0, Tolerance(1e-15));
  EXPECT_EQ(straight.yaw, kPi / 2.0);
  const Pose2 left = TrailerPose(trailer, {}, kPi / 2.0);
  EXPECT_NEAR(left.x, -1.0, Tolerance(1e-15));  // its axle is on the car's right
  EXPECT_NEAR(left.y, -3.0, Tolerance(1e-15));
}

// In a steady turn, the trailer's axle points to the center of the circle: with the radius R of
// the rear axle, the hitch is at the distance sqrt(R^2 + b^2), and the radius of the trailer's axle
// is sqrt(R^2 + b^2 - l^2).
TEST(Trailer, FollowsTheSteadyCircle) {
  Random random(3);
  for (int i = 0; i < 50; ++i) {
    const TrailerParams trailer = RandomTrailer(random);
    const double radius = (i % 2 == 0 ? 1.0 : -1.0) * random.Uniform(7.0, 60.0);
    // 60 times the tongue: what remains of the start is exp(-60 sqrt(1 - l^2/R^2)), below 1e-13
    const double angle = RolledHitchAngle(trailer, 0.0, 1.0 / radius, 60.0 * trailer.tongue);
    const Vec2 axle = TrailerPose(trailer, {}, angle).position();
    const double expected = std::sqrt(radius * radius + trailer.hitch * trailer.hitch -
                                      trailer.tongue * trailer.tongue);
    EXPECT_NEAR((axle - Vec2(0.0, radius)).norm(), expected, Tolerance(1e-11)) << i;
    EXPECT_LT(angle * radius, 0.0);
    EXPECT_NEAR(RollingHitchRate(trailer, angle, 2.0, 2.0 / radius), 0.0, Tolerance(1e-12)) << i;
  }
}

// Straight ahead, tan(theta/2) decays as exp(-s/l) (tractrix); in reverse it grows as much.
TEST(Trailer, DecaysOnAStraightAndGrowsInReverse) {
  const TrailerParams trailer = MakeTrailer({.tongue = 2.5}, ReferenceCar());
  for (const double start : {0.001, 0.3, -1.2, 2.5}) {
    for (const double distance : {0.5, 3.0, 12.0, -0.5, -3.0}) {
      const double expected = 2.0 * std::atan(std::tan(0.5 * start) * std::exp(-distance / 2.5));
      EXPECT_NEAR(RolledHitchAngle(trailer, start, 0.0, distance), expected, Tolerance(1e-14))
          << start << " after " << distance;
    }
  }
}

TEST(Trailer, ReversingUndoesDrivingAhead) {
  Random random(11);
  for (int i = 0; i < 200; ++i) {
    const TrailerParams trailer = RandomTrailer(random);
    const double curvature = random.Uniform(-0.2, 0.2);
    const double start = random.Uniform(-1.0, 1.0);
    const double there = RolledHitchAngle(trailer, start, curvature, 2.0);
    // Rounding errors grow in reverse by less than exp(2 m/l) < 3.
    EXPECT_NEAR(RolledHitchAngle(trailer, there, curvature, -2.0), start, Tolerance(1e-14)) << i;
    EXPECT_NEAR(RolledHitchAngle(trailer, -start, -curvature, 2.0), -there, Tolerance(1e-15)) << i;
    const double half = RolledHitchAngle(trailer, start, curvature, 1.0);
    EXPECT_NEAR(RolledHitchAngle(trailer, half, curvature, 1.0), there, Tolerance(1e-14)) << i;
  }
}

// A fourth-order method with steps of 2 mm has an error of 1e-13 or less.
TEST(Trailer, AgreesWithNumericalIntegration) {
  Random random(5);
  for (int i = 0; i < 20; ++i) {
    const TrailerParams trailer = RandomTrailer(random);
    const double curvature = random.Uniform(-0.5, 0.5);
    const double distance = random.Uniform(-4.0, 6.0);
    double angle = random.Uniform(-1.5, 1.5);
    const double exact = RolledHitchAngle(trailer, angle, curvature, distance);
    const auto rate = [&](double at) { return RollingHitchRate(trailer, at, 1.0, curvature); };
    const int steps = 3000;
    const double h = distance / steps;
    double largest = 0.0;
    const double start = angle;
    for (int k = 0; k < steps; ++k) {
      const double k1 = rate(angle);
      const double k2 = rate(angle + 0.5 * h * k1);
      const double k3 = rate(angle + 0.5 * h * k2);
      const double k4 = rate(angle + h * k3);
      angle += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
      largest = std::max(largest, std::abs(angle - start));
    }
    if (largest < 3.0) {
      EXPECT_NEAR(exact, angle, Tolerance(1e-11)) << i;
    } else {
      EXPECT_NEAR(WrapAngle(exact - angle), 0.0, Tolerance(1e-11)) << i;
    }
  }
}

// The wheels do not slip: the axle moves along the trailer's heading. The central difference over
// 2 h has an error of h^2/6 times the third derivative of the path, at 3 m/s and a yaw acceleration
// below 1 rad/s^2 less than 10 h^2 = 1e-7 m/s.
TEST(TowingCar, MovesItsAxleAlongTheTrailer) {
  constexpr double kStep = 1e-4;
  for (const ReferencePoint reference :
       {ReferencePoint::kRearAxle, ReferencePoint::kCenterOfGravity}) {
    const TrailerParams trailer = MakeTrailer({}, ReferenceCar());
    TowingCar car(ReferenceCar(), reference, {.speed = 3.0, .steering = -0.1}, trailer, 0.2);
    for (int i = 0; i < 400; ++i) {
      const Command command{.steering = i < 200 ? 0.3 : -0.4, .acceleration = i < 100 ? 1.0 : -0.5};
      car.Step(command, 0.01);
      TowingCar later = car;
      later.Step(command, kStep);
      const Pose2 now = TrailerPose(trailer, later.FullState().pose, later.trailer().angle);
      TowingCar last = later;
      last.Step(command, kStep);
      const Pose2 before = TrailerPose(trailer, car.FullState().pose, car.trailer().angle);
      const Pose2 after = TrailerPose(trailer, last.FullState().pose, last.trailer().angle);
      const Vec2 velocity = (after.position() - before.position()) / (2.0 * kStep);
      EXPECT_NEAR(LeftNormal(Direction(now.yaw)).dot(velocity), 0.0, Tolerance(1e-7)) << i;
      EXPECT_NEAR((last.trailer().angle - car.trailer().angle) / (2.0 * kStep),
                  later.trailer().rate, Tolerance(1e-7))
          << i;
    }
  }
}

TEST(TowingCar, DoesNotDependOnTheStepAtConstantSteering) {
  const TrailerParams trailer = MakeTrailer({}, ReferenceCar());
  const auto after = [&](int steps) {
    TowingCar car(ReferenceCar(), ReferencePoint::kRearAxle, {.speed = 4.0, .steering = 0.2},
                  trailer, 0.1);
    for (int i = 0; i < steps; ++i) {
      car.Step({.steering = 0.2, .acceleration = -1.0}, 6.0 / steps);  // comes to rest after 4 s
    }
    return car.trailer().angle;
  };
  EXPECT_NEAR(after(1), after(600), Tolerance(1e-13));
}

/// Whether body or drawbar of the trailer touch the car at a hitch angle.
bool Touches(const TrailerParams& trailer, const VehicleParams& car, double angle) {
  const OrientedBox own{{0.5 * car.length - car.rear_overhang, 0.0, 0.0}, car.length, car.width};
  const Pose2 axle = TrailerPose(trailer, {}, angle);
  const Vec2 hitch(-trailer.hitch, 0.0);
  const Vec2 front = hitch - trailer.body_front() * Direction(angle);
  return Distance(own, TrailerFootprint(trailer, axle)) == 0.0 ||
         Distance(hitch, front, own) == 0.0;
}

// The search looks at every 0.001 rad up to the angle and at the 0.001 rad beyond it.
TEST(Trailer, JackknivesWhereTheOutlinesTouchFirst) {
  Random random(17);
  const VehicleParams car = ReferenceCar();
  for (int i = 0; i < 60; ++i) {
    TrailerParams trailer = RandomTrailer(random);
    if (i % 4 == 0) {  // a narrow body behind a long drawbar
      trailer.width = 0.3;
      trailer.tongue += 3.0;
    }
    const double angle = JackknifeAngle(trailer, car);
    for (double below = 0.0; below < angle - 1e-9; below += 1e-3) {
      ASSERT_FALSE(Touches(trailer, car, below)) << i << ": " << below << " of " << angle;
      ASSERT_FALSE(Touches(trailer, car, -below)) << i;
    }
    EXPECT_TRUE(Touches(trailer, car, angle + 1e-9)) << i << ": " << angle;
    EXPECT_TRUE(Touches(trailer, car, -angle - 1e-9)) << i;
  }
}

// A body whose front is f behind the hitch, with the hitch d behind the car, turns about the hitch
// until its front corner meets the rear of the car: w/2 sin(theta) - f cos(theta) = d. The distance
// of this corner from the hitch, sqrt(f^2 + w^2/4) = 0.860 m, is below half the car's width.
TEST(Trailer, JackknivesAtTheCornerOfAWideBody) {
  const VehicleParams car = ReferenceCar();
  const TrailerParams trailer =
      MakeTrailer({.hitch = 1.025, .tongue = 2.0, .length = 3.0, .width = 1.4}, car);
  const double angle = JackknifeAngle(trailer, car);
  EXPECT_NEAR(0.7 * std::sin(angle) - 0.5 * std::cos(angle), 0.2, Tolerance(1e-12));
  EXPECT_GT(angle, 0.5);
  EXPECT_LT(angle, kPi / 2.0);
}

TEST(Trailer, ScalesItsDefaultsWithTheCar) {
  const VehicleParams car = ReferenceCar();
  VehicleParams small = car;
  for (double VehicleParams::*length :
       {&VehicleParams::wheelbase, &VehicleParams::track_rear, &VehicleParams::wheel_radius,
        &VehicleParams::length, &VehicleParams::width, &VehicleParams::height,
        &VehicleParams::rear_overhang}) {
    small.*length *= 0.1;
  }
  small.mass *= 1e-3;
  const auto full = TrailerNumbers(MakeTrailer({}, car));
  const auto tenth = TrailerNumbers(MakeTrailer({}, small));
  for (std::size_t i = 0; i < full.size(); ++i) {
    const double scale = i == 8 ? 1e-3 : i == 9 ? 1e-5 : 0.1;  // mass, yaw inertia, lengths
    EXPECT_NEAR(tenth[i], scale * full[i], Tolerance(1e-15 * scale + 1e-15 * full[i])) << i;
  }
}

TEST(Trailer, KeepsAllNumbers) {
  std::array<double, 13> numbers{};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    numbers[i] = 0.1 * static_cast<double>(i + 1);
  }
  EXPECT_EQ(TrailerNumbers(TrailerFromNumbers(numbers)), numbers);
}

TEST(Trailer, RefusesWhatReachesIntoTheCar) {
  const auto refusal = [](const TrailerOptions& options) -> std::string {
    try {
      MakeTrailer(options, ReferenceCar());
    } catch (const InputError& error) {
      return fmt::format("{}: {}", error.problems().front().key, error.problems().front().message);
    }
    return "";
  };
  EXPECT_EQ(refusal({.hitch = 0.5}),
            "vehicle.trailer.hitch: 0.5 m behind the rear axle is under the car; must be above "
            "0.825 m, its rear overhang");
  EXPECT_EQ(refusal({.tongue = 2.0, .length = 5.0}),
            "vehicle.trailer.tongue: 2 m: the body begins 0.5 m ahead of the hitch; must be above "
            "2.5 m, or the body shorter or farther back (length, body_ahead)");
  EXPECT_EQ(refusal({.tongue = 2.0, .cg_ahead = -2.5}),
            "vehicle.trailer.cg_ahead: -2.5 m; must be between -2 and 2 m, the tongue");
}

}  // namespace
}  // namespace trackbed
