#include "trackbed/vehicle/single_track_car.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <complex>
#include <vector>

#include "tests/geometry/random.h"
#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"

// Tests the linear single-track car: steady state and lateral mode against closed forms, random
// motions against a Runge-Kutta integration of the header's equations, and low speed against the
// kinematic car.
namespace trackbed {
namespace {

/// The reference car on tyres that make it understeer, as most cars do.
VehicleParams TyredCar(double front = 70e3, double rear = 110e3) {
  VehicleParams car = ReferenceCar();
  car.yaw_inertia = 2300.0;
  car.cornering_stiffness_front = front;
  car.cornering_stiffness_rear = rear;
  return car;
}

/// Understeer gradient K [s^2/m], as defined in the header.
double UndersteerGradient(const VehicleParams& car) {
  return car.mass / car.wheelbase *
         (car.cg_to_rear / car.cornering_stiffness_front -
          car.cg_to_front() / car.cornering_stiffness_rear);
}

SingleTrackCar Rolling(const KinematicState& start, const VehicleParams& car = TyredCar()) {
  return {car, RollingWithoutSlip(car, start)};
}

double Distance(const Pose2& a, const Pose2& b) {
  return (a.position() - b.position()).norm();
}

void ExpectSame(const SingleTrackState& actual, const SingleTrackState& expected,
                double tolerance) {
  EXPECT_NEAR(actual.pose.x, expected.pose.x, Tolerance(tolerance));
  EXPECT_NEAR(actual.pose.y, expected.pose.y, Tolerance(tolerance));
  EXPECT_NEAR(actual.pose.yaw, expected.pose.yaw, Tolerance(tolerance));
  EXPECT_NEAR(actual.lateral_speed, expected.lateral_speed, Tolerance(tolerance));
  EXPECT_NEAR(actual.yaw_rate, expected.yaw_rate, Tolerance(tolerance));
  EXPECT_NEAR(actual.speed, expected.speed, Tolerance(tolerance));
  EXPECT_NEAR(actual.distance, expected.distance, Tolerance(tolerance));
}

/// Integrates the header's equations for the lateral speed v and the yaw rate r with Runge-Kutta
/// steps of 20 us. At speeds |u| above 1 m/s, decay rates are at most about 150 1/s, so the
/// integration error is at the level of rounding. Within `duration`, the wheels must not reach the
/// commanded steering angle, and the car must not come to rest.
SingleTrackState BruteForce(const VehicleParams& car, const SingleTrackState& start,
                            double steering_rate, double acceleration, double duration) {
  using Vector = Eigen::Matrix<double, 5, 1>;  // x, y, yaw, v, r
  const double l_f = car.cg_to_front();
  const double l_r = car.cg_to_rear;
  const auto slope = [&](double time, const Vector& now) -> Vector {
    const double u = start.speed + acceleration * time;
    const double delta = start.steering + steering_rate * time;
    const double v = now[3];
    const double r = now[4];
    const double front =
        car.cornering_stiffness_front * (u * std::tan(delta) - v - l_f * r) / std::abs(u);
    const double rear = -car.cornering_stiffness_rear * (v - l_r * r) / std::abs(u);
    const double rear_v = v - l_r * r;
    return Vector(u * std::cos(now[2]) - rear_v * std::sin(now[2]),
                  u * std::sin(now[2]) + rear_v * std::cos(now[2]), r,
                  (front + rear) / car.mass - u * r, (l_f * front - l_r * rear) / car.yaw_inertia);
  };
  Vector at;
  at << start.pose.x, start.pose.y, start.pose.yaw, start.lateral_speed, start.yaw_rate;
  const int steps = static_cast<int>(std::lround(duration / 2e-5));
  const double h = duration / steps;
  for (int i = 0; i < steps; ++i) {
    const double time = i * h;
    const Vector k1 = slope(time, at);
    const Vector k2 = slope(time + 0.5 * h, at + 0.5 * h * k1);
    const Vector k3 = slope(time + 0.5 * h, at + 0.5 * h * k2);
    const Vector k4 = slope(time + h, at + h * k3);
    at += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
  }
  const double moved = (start.speed + 0.5 * acceleration * duration) * duration;
  return {.pose = {at[0], at[1], at[2]},
          .speed = start.speed + acceleration * duration,
          .lateral_speed = at[3],
          .yaw_rate = at[4],
          .steering = start.steering + steering_rate * duration,
          .distance = start.distance + std::abs(moved)};
}

// --- Closed forms --------------------------------------------------------------------------------

TEST(SingleTrackCar, SteadyStateIsTheClosedForm) {
  const std::vector<VehicleParams> cars{TyredCar(), TyredCar(110e3, 110e3), TyredCar(130e3, 100e3)};
  for (const VehicleParams& car : cars) {
    const double gradient = UndersteerGradient(car);
    for (const double speed : {0.3, 3.0, 10.0, 20.0, 40.0, -0.3, -3.0, -10.0}) {
      SCOPED_TRACE(fmt::format("K {}, speed {}", gradient, speed));
      const double stretched = car.wheelbase + gradient * speed * std::abs(speed);
      if (stretched < 0.3 * car.wheelbase) {
        continue;  // the car is unstable, or too near the stability limit to settle
      }
      const double steering = 0.1;
      SingleTrackCar rolling = Rolling({.speed = speed, .steering = steering}, car);
      rolling.Step({.steering = steering, .gear = speed > 0.0 ? 1 : -1}, 40.0);
      const double yaw_rate = speed * std::tan(steering) / stretched;
      // After 40 s the motion has settled: all decay rates are above 1 1/s, so a fraction of less
      // than e^-40 remains. The tolerance covers rounding.
      EXPECT_NEAR(rolling.state().yaw_rate, yaw_rate, Tolerance(1e-9 * std::abs(yaw_rate)));
      // The rear tyres carry l_f/L of the centripetal force.
      const VehicleState state = rolling.FullState();
      const double rear = car.mass * speed * yaw_rate * car.cg_to_front() / car.wheelbase;
      const double lateral =
          car.cg_to_rear * yaw_rate - rear * std::abs(speed) / car.cornering_stiffness_rear;
      EXPECT_NEAR(state.lateral_speed, lateral, Tolerance(1e-9));
      EXPECT_NEAR(state.lateral_acceleration, speed * yaw_rate, Tolerance(1e-9));
      EXPECT_NEAR(state.longitudinal_acceleration, -lateral * yaw_rate, Tolerance(1e-9));
      EXPECT_NEAR(state.sideslip, std::atan(lateral / speed), Tolerance(1e-9));
      EXPECT_NEAR(state.time, 40.0, Tolerance(1e-12));
    }
  }
}

TEST(SingleTrackCar, LateralModeHasItsClosedFormFrequencyAndDamping) {
  // On a straight, the yaw rate r decays as a second-order system with the frequency w and the
  // damping ratio zeta. Samples with the spacing T obey r_(n+1) = 2 e^(-zeta w T) cos(w sqrt(1 -
  // zeta^2) T) r_n - e^(-2 zeta w T) r_(n-1).
  const VehicleParams car = TyredCar();
  const double front = car.cornering_stiffness_front;
  const double rear = car.cornering_stiffness_rear;
  const double l_f = car.cg_to_front();
  const double l_r = car.cg_to_rear;
  for (const double speed : {8.0, 20.0, 40.0}) {
    SCOPED_TRACE(speed);
    SingleTrackCar rolling(car, {.speed = speed, .lateral_speed = 0.3, .yaw_rate = -0.1});
    constexpr double kPeriod = 0.02;
    std::vector<double> sample{rolling.state().yaw_rate};
    for (int i = 0; i < 3; ++i) {
      rolling.Step({}, kPeriod);
      sample.push_back(rolling.state().yaw_rate);
    }
    Eigen::Matrix2d matrix;
    matrix << sample[1], -sample[0], sample[2], -sample[1];
    const Vec2 coefficient = matrix.inverse() * Vec2(sample[2], sample[3]);
    const std::complex<double> half = 0.5 * coefficient[0];
    const std::complex<double> eigenvalue =
        std::log(half + std::sqrt(half * half - coefficient[1])) / kPeriod;

    const double frequency = std::sqrt(front * rear * car.wheelbase * car.wheelbase /
                                           (car.mass * car.yaw_inertia * speed * speed) +
                                       (l_r * rear - l_f * front) / car.yaw_inertia);
    const double damping =
        (car.mass * (l_f * l_f * front + l_r * l_r * rear) + car.yaw_inertia * (front + rear)) /
        (2.0 * car.mass * car.yaw_inertia * speed * frequency);
    // The mode decays at a rate of 10 to 20 1/s, so a step of 2 ms has a relative error of
    // 0.04^6/7200 = 6e-13. The condition number of the fit, 100, increases this error to 6e-11,
    // which is far below the tolerance.
    const double tolerance = Tolerance(1e-8 * frequency);
    if (damping < 1.0) {
      EXPECT_NEAR(std::abs(eigenvalue), frequency, tolerance);
      EXPECT_NEAR(-eigenvalue.real() / std::abs(eigenvalue), damping, tolerance);
    } else {
      EXPECT_NEAR(-eigenvalue.real(), frequency * (damping - std::sqrt(damping * damping - 1.0)),
                  tolerance);
    }
  }
}

// --- Comparison with the header's equations -----------------------------------------------------

TEST(SingleTrackCar, MovesAsTheEquationsSay) {
  Random random(31);
  for (int i = 0; i < 20; ++i) {
    const double direction = i % 2 == 0 ? 1.0 : -1.0;
    const VehicleParams car = TyredCar(random.Uniform(60e3, 120e3), random.Uniform(60e3, 120e3));
    SingleTrackState start = RollingWithoutSlip(
        car, {.pose = {1.0, 2.0, random.Uniform(-kPi, kPi)},
              .speed = direction * random.Uniform(4.0, direction > 0.0 ? 30.0 : 10.0),
              .steering = random.Uniform(-0.1, 0.1)});
    start.lateral_speed += random.Uniform(-0.5, 0.5);
    start.yaw_rate += random.Uniform(-0.2, 0.2);
    const double acceleration = random.Uniform(-1.4, 3.0) * direction;
    const double steering_rate =
        i % 3 == 0 ? 0.0 : (i % 4 < 2 ? car.steering_rate : -car.steering_rate);
    SCOPED_TRACE(fmt::format("case {}: speed {}, acceleration {}, steering rate {}", i, start.speed,
                             acceleration, steering_rate));
    constexpr double kDuration = 2.0;
    SingleTrackCar actual(car, start);
    for (int step = 0; step < 100; ++step) {
      actual.Step({.steering = start.steering + kDuration * steering_rate,
                   .acceleration = acceleration,
                   .gear = direction > 0.0 ? 1 : -1},
                  kDuration / 100.0);
    }
    ExpectSame(actual.state(), BruteForce(car, start, steering_rate, acceleration, kDuration),
               1e-9);
  }
}

TEST(SingleTrackCar, CutOfTimeDoesNotMatter) {
  // Simulates one command for 5 s. During this time the steering ramp ends, and the car may stop or
  // start from rest.
  Random random(32);
  for (int i = 0; i < 20; ++i) {
    const int gear = random.Below(2) == 0 ? 1 : -1;
    const KinematicState start{.speed = i % 5 == 0 ? 0.0 : gear * random.Uniform(0.0, 12.0),
                               .steering = random.Uniform(-0.3, 0.3)};
    const Command command{.steering = random.Uniform(-0.3, 0.3),
                          .acceleration = random.Uniform(-3.0, 3.0),
                          .gear = gear};
    SCOPED_TRACE(fmt::format("case {}: speed {}, steering {} to {}, acceleration {}, gear {}", i,
                             start.speed, start.steering, command.steering, command.acceleration,
                             gear));
    const auto driven = [&](double step) {
      SingleTrackCar car = Rolling(start);
      for (int n = 0; n < std::lround(5.0 / step); ++n) {
        car.Step(command, step);
      }
      return car.state();
    };
    const SingleTrackState fine = driven(0.0005);
    for (const double step : {0.001, 0.002, 0.004, 0.02, 5.0}) {
      ExpectSame(driven(step), fine, 1e-9);
    }
  }
}

// --- Low speed, rest and reverse -----------------------------------------------------------------

TEST(SingleTrackCar, SlowCarIsTheKinematicOne) {
  // The car drives 50 m on a circle. The radius of the circle is larger than the kinematic radius R
  // by dR = R K u^2/L, a fraction of 3.7e-4 at 0.5 m/s. The end of the arc, R (sin(s/R), 1 -
  // cos(s/R)), moves by dR times its derivative with respect to R. This is 20 mm at 0.5 m/s and a
  // quarter of 20 mm at half the speed. The slip of the rear tyres changes this distance by less
  // than 5 %.
  const VehicleParams car = TyredCar();
  const double steering = 0.3;
  const double radius = car.wheelbase / std::tan(steering);
  const double turn = 50.0 / radius;
  const double per_radius = std::hypot(std::sin(turn) - turn * std::cos(turn),
                                       1.0 - std::cos(turn) - turn * std::sin(turn));
  for (const double speed : {0.5, 0.25, -0.25, 0.125}) {
    SCOPED_TRACE(speed);
    const KinematicState start{.speed = speed, .steering = steering};
    const Command command{.steering = steering, .gear = speed > 0.0 ? 1 : -1};
    KinematicCar kinematic(car, ReferencePoint::kRearAxle, start);
    SingleTrackCar dynamic = Rolling(start);
    kinematic.Step(command, 50.0 / std::abs(speed));
    dynamic.Step(command, 50.0 / std::abs(speed));
    const double apart = Distance(dynamic.state().pose, kinematic.state().pose);
    const double stretch = radius * UndersteerGradient(car) * speed * speed / car.wheelbase;
    EXPECT_NEAR(apart, per_radius * stretch, Tolerance(0.05 * per_radius * stretch));
  }
}

TEST(SingleTrackCar, FollowsTheKinematicCarOnAGentleCourse) {
  // Both cars drive 50 m at 0.5 m/s while the steering angle oscillates by +-0.02 rad with a period
  // of 10 s. The heading is at most 0.04 rad; understeer reduces it by a fraction of 3e-4.
  const KinematicState start{.speed = 0.5};
  KinematicCar kinematic(TyredCar(), ReferencePoint::kRearAxle, start);
  SingleTrackCar dynamic = Rolling(start);
  for (int i = 0; i < 5000; ++i) {
    const Command command{.steering = 0.02 * std::sin(2.0 * kPi * i / 500.0)};
    kinematic.Step(command, 0.02);
    dynamic.Step(command, 0.02);
    ASSERT_LT(Distance(dynamic.state().pose, kinematic.state().pose), Tolerance(0.001)) << i;
  }
}

TEST(SingleTrackCar, StopsStandsAndBacksUp) {
  const VehicleParams params = TyredCar();
  const KinematicState start{.speed = 2.0, .steering = 0.2};
  KinematicCar kinematic(params, ReferencePoint::kRearAxle, start);
  SingleTrackCar car = Rolling(start);
  const auto both = [&](const Command& command, double duration) {
    for (int i = 0; i < std::lround(duration / 0.02); ++i) {
      kinematic.Step(command, 0.02);
      car.Step(command, 0.02);
      ASSERT_EQ(car.state().speed, kinematic.state().speed);
      ASSERT_EQ(car.state().steering, kinematic.state().steering);
      // The curvature and the sideslip of both cars differ by about K u^2/L = 0.5 %. The force that
      // accelerates the turning car adds a difference of |a| m/C = 1 %. A change of the steering
      // angle takes effect with a delay of m u/C = 30 ms.
      const double rate = kinematic.FullState().yaw_rate;
      ASSERT_NEAR(car.state().yaw_rate, rate, Tolerance(0.02 * std::abs(rate) + 0.004));
      // 1 % of this angle displaces the car by 0.0046 rad * 4 m = 18 mm on its way. The way back
      // displaces the car by another 18 mm.
      ASSERT_LT(Distance(car.state().pose, kinematic.state().pose), Tolerance(0.037));
    }
  };
  both({.steering = 0.2, .acceleration = -1.0}, 1.98);
  EXPECT_GT(car.state().speed, 0.0);
  both({.steering = 0.2, .acceleration = -1.0}, 0.1);
  EXPECT_EQ(car.state().speed, 0.0);
  EXPECT_EQ(car.state().lateral_speed, 0.0);
  EXPECT_EQ(car.state().yaw_rate, 0.0);
  const Pose2 stood = car.state().pose;
  both({.steering = -0.3, .acceleration = -1.0}, 5.0);
  EXPECT_EQ(car.state().pose, stood);
  EXPECT_EQ(car.state().steering, -0.3);
  EXPECT_EQ(car.FullState().sideslip, 0.0);
  EXPECT_EQ(car.FullState().lateral_acceleration, 0.0);
  both({.steering = -0.3, .acceleration = -0.5, .gear = -1}, 4.0);
  EXPECT_EQ(car.state().speed, kinematic.state().speed);
  EXPECT_GT(car.state().yaw_rate, 0.1);  // wheels to the right, in reverse: it turns left
  both({.steering = -0.3, .acceleration = 0.5, .gear = 1}, 8.0);  // reverses without stopping
  EXPECT_LT(car.state().yaw_rate, -0.1);
}

TEST(SingleTrackCar, SlidesAtNoSpeedAtAll) {
  // Just above rest, the lateral speed decays almost at once. The integration must not overflow.
  for (const double speed : {1e-3, 1e-6, 1e-9, -1e-6}) {
    SCOPED_TRACE(speed);
    SingleTrackCar car(TyredCar(), {.speed = speed, .lateral_speed = 0.1, .steering = 0.2});
    car.Step({.steering = 0.2, .gear = speed > 0.0 ? 1 : -1}, 0.02);
    // In 20 ms the car rolls by |u| * 20 ms. The car also slides sideways at 0.1 m/s, which decays
    // at a rate of about 100/|u| 1/s.
    EXPECT_LT(car.state().pose.position().norm(),
              Tolerance((0.02 + 0.1 / 100.0) * std::abs(speed)));
    // The initial lateral speed of 0.1 m/s has decayed: after ten steps of an integrator for stiff
    // equations, it changes the yaw rate by less than 1e-9 rad/s.
    EXPECT_NEAR(car.state().yaw_rate, speed * std::tan(0.2) / 2.7, Tolerance(1e-9));
  }
}

// --- Symmetries ----------------------------------------------------------------------------------

TEST(SingleTrackCar, MirrorsAndTurnsWithItsStart) {
  const auto driven = [](const Pose2& pose, double sign) {
    SingleTrackCar car = Rolling({.pose = pose, .speed = 12.0});
    for (int i = 0; i < 200; ++i) {
      car.Step({.steering = sign * (i < 100 ? 0.05 : -0.03), .acceleration = i < 150 ? 0.5 : -4.0},
               0.02);
    }
    return car.state();
  };
  const SingleTrackState left = driven({}, 1.0);
  SingleTrackState mirrored = driven({}, -1.0);
  mirrored.pose = {mirrored.pose.x, -mirrored.pose.y, -mirrored.pose.yaw};
  mirrored.lateral_speed *= -1.0;
  mirrored.yaw_rate *= -1.0;
  ExpectSame(mirrored, left, 1e-14);
  for (const double yaw : {0.7, 2.2, -1.3}) {
    const Pose2 start{3.0, -4.0, yaw};
    SingleTrackState expected = left;
    expected.pose = Compose(start, left.pose);
    // The tolerance covers two thousand roundings of positions up to 50 m.
    ExpectSame(driven(start, 1.0), expected, 1e-12);
  }
}

// --- The full state ------------------------------------------------------------------------------

TEST(SingleTrackCar, AccelerationsAreThoseOfTheCenterOfGravity) {
  // Compares accelerations with second differences of the center of gravity's position over h = 1
  // ms. The truncation error of a second difference is h^2/12 times the fourth derivative of the
  // position. 0.1 s after the start of a steering ramp, this derivative is C_f omega/m = 8 m/s^3
  // divided by the tyres' time constant of 10 ms, which is 800 m/s^4.
  constexpr double kH = 1e-3;
  Random random(33);
  for (int i = 0; i < 50; ++i) {
    const double direction = i % 2 == 0 ? 1.0 : -1.0;
    const double steering = std::copysign(random.Uniform(0.03, 0.05), random.Uniform(-1.0, 1.0));
    SingleTrackCar car = Rolling({.pose = {0.5, -0.3, random.Uniform(-kPi, kPi)},
                                  .speed = direction * random.Uniform(3.0, 10.0)});
    const Command command{.steering = steering,
                          .acceleration = random.Uniform(-2.0, 2.0),
                          .gear = direction > 0.0 ? 1 : -1};
    SCOPED_TRACE(fmt::format("case {}: speed {}, steering to {}", i, car.state().speed, steering));
    car.Step(command, 0.1);
    const auto cg = [&] { return ToWorld(car.FullState().pose, {1.4, 0.0}); };
    const Vec2 before = cg();
    car.Step(command, kH);
    const VehicleState state = car.FullState();
    const Vec2 now = cg();
    car.Step(command, kH);
    const Vec2 after = cg();
    const Vec2 acceleration = (after - 2.0 * now + before) / (kH * kH);
    const Vec2 velocity = (after - before) / (2.0 * kH);
    const double tolerance = Tolerance(kH * kH / 12.0 * 800.0);
    const Vec2 ahead = Direction(state.pose.yaw);
    EXPECT_NEAR(state.longitudinal_acceleration, acceleration.dot(ahead), tolerance);
    EXPECT_NEAR(state.lateral_acceleration, acceleration.dot(LeftNormal(ahead)), tolerance);
    EXPECT_NEAR(state.speed, velocity.dot(ahead), tolerance);
    EXPECT_NEAR(state.lateral_speed, velocity.dot(LeftNormal(ahead)), tolerance);
    EXPECT_NEAR(state.sideslip, std::atan(state.lateral_speed / state.speed), Tolerance(1e-14));
    EXPECT_EQ(state.steering, state.steering_actuator);
    EXPECT_FALSE(state.wheels.has_value());
  }
}

TEST(SingleTrackCar, NeedsTyres) {
  EXPECT_THROW(SingleTrackCar(ReferenceCar(), {}), InternalError);
}

}  // namespace
}  // namespace trackbed
