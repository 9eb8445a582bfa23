#include "trackbed/control/preview_integral.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/control/loop.h"
#include "tests/tolerance.h"
#include "trackbed/control/controllers.h"

namespace trackbed {
namespace {

struct At {
  VehicleParams vehicle = ReferenceCar();
  Path path;
  VehicleState state;
};

double Steer(const PreviewIntegralOptions& options, const At& at) {
  const Reference reference{at.path, {}};
  return MakeSteeringController(options)->Steer({.vehicle = at.vehicle,
                                                 .reference = reference,
                                                 .schedule = {},
                                                 .state = at.state,
                                                 .station = 0.0,
                                                 .period = 0.02});
}

At Beside(const Path& path, const Pose2& pose, double speed = 3.0) {
  At at;
  at.path = path;
  at.state.pose = pose;
  at.state.speed = speed;
  return at;
}

TEST(PreviewIntegral, ConstantCurvatureGivesTheKinematicAngle) {
  // On a path of constant curvature kappa, the law commands delta = atan(L kappa).
  for (const PreviewWeight weight : {PreviewWeight::kUniform, PreviewWeight::kNear}) {
    for (const double curvature : {0.0, 0.01, -0.05, 0.15}) {
      SCOPED_TRACE(curvature);
      EXPECT_NEAR(Steer({.weight = weight}, Beside({{}, {{60.0, curvature, 1}}}, {})),
                  std::atan(2.7 * curvature), Tolerance(1e-11));
    }
  }
}

TEST(PreviewIntegral, BesideAStraightIsTheIntegralInClosedForm) {
  // At a small offset e from a straight, with heading psi, f = -e - x psi and A = x^2/(2 L). The
  // integral of (-e - x psi) x^2 over that of x^4/(2 L), from 0 to R, is -2 L (5/(3 R^2) e + 5/(4
  // R) psi). With the weight W = 1 - x/R, the result is -2 L (5/(2 R^2) e + 3/(2 R) psi). Measured
  // along the path, the chord to a point at the distance x is too long by the fraction (e/x)^2.
  // With e = 1e-5 m and psi = 1e-5 rad, this error is about 1e-9 where x is large compared with e.
  // Small distances x have little influence, because A is small at them.
  const double R = 5.0;
  const Path straight({}, {{100.0, 0.0, 1}});
  const double e = 1e-5;
  const auto angle = [&](PreviewWeight weight, const Pose2& pose) {
    return Steer({.distance = R, .time = 0.0, .weight = weight}, Beside(straight, pose));
  };
  EXPECT_NEAR(angle(PreviewWeight::kUniform, {0.0, e, 0.0}), -2.0 * 2.7 * 5.0 / (3.0 * R * R) * e,
              Tolerance(1e-9));
  EXPECT_NEAR(angle(PreviewWeight::kUniform, {0.0, 0.0, e}), -2.0 * 2.7 * 5.0 / (4.0 * R) * e,
              Tolerance(1e-9));
  EXPECT_NEAR(angle(PreviewWeight::kNear, {0.0, e, 0.0}), -2.0 * 2.7 * 5.0 / (2.0 * R * R) * e,
              Tolerance(1e-9));
  EXPECT_NEAR(angle(PreviewWeight::kNear, {0.0, 0.0, e}), -2.0 * 2.7 * 3.0 / (2.0 * R) * e,
              Tolerance(1e-9));
}

TEST(PreviewIntegral, KnowsWhereTheCarSlidesAnyway) {
  // The linear car in its steady turn on a circle of curvature kappa moves along y_0 + A
  // tan(delta_0). The law therefore commands delta_0, up to a relative error of (R kappa)^2 and the
  // slip angle of the rear axle.
  const VehicleParams car = ReferenceCarWithTyres();
  const double speed = 15.0;
  const double curvature = 0.005;
  const double understeer = car.mass *
                            (car.cg_to_rear / car.cornering_stiffness_front -
                             car.cg_to_front() / car.cornering_stiffness_rear) /
                            car.wheelbase;
  const double rear_slip = car.mass * speed * speed * curvature * car.cg_to_front() /
                           (car.wheelbase * car.cornering_stiffness_rear);
  At at = Beside({{}, {{100.0, curvature, 1}}}, {0.0, 0.0, rear_slip}, speed);
  at.vehicle = car;
  at.state.yaw_rate = speed * curvature;
  at.state.lateral_speed = car.cg_to_rear * at.state.yaw_rate - speed * rear_slip;
  const double wanted = curvature * (car.wheelbase + understeer * speed * speed);
  EXPECT_NEAR(Steer({}, at), std::atan(wanted), Tolerance(0.02 * wanted));
  // Without the tyre parameters, the law deviates from delta_0 by more than 5 %.
  at.vehicle.cornering_stiffness_front = 0.0;
  EXPECT_GT(std::abs(Steer({}, at) - std::atan(wanted)), 0.05 * wanted);
}

TEST(PreviewIntegral, DelayHoldsTheAngleBack) {
  const auto controller = MakeSteeringController(PreviewIntegralOptions{.delay = 0.05});
  const Path straight({}, {{100.0, 0.0, 1}});
  const Reference reference{straight, {}};
  const VehicleParams car = ReferenceCar();
  const SteeringSchedule schedule;
  std::vector<double> given;
  std::vector<double> wanted;
  for (int i = 0; i < 20; ++i) {
    VehicleState state;
    state.speed = 3.0;
    state.pose.y = 0.01 * i;
    const ControlInput input{.vehicle = car,
                             .reference = reference,
                             .schedule = schedule,
                             .state = state,
                             .station = 0.0,
                             .period = 0.02};
    given.push_back(controller->Steer(input));
    wanted.push_back(MakeSteeringController(PreviewIntegralOptions{})->Steer(input));
  }
  // The delay is 2.5 periods.
  EXPECT_EQ(given[0], 0.0);
  for (std::size_t i = 3; i < 20; ++i) {
    EXPECT_NEAR(given[i], 0.5 * (wanted[i - 2] + wanted[i - 3]), Tolerance(1e-12));
  }
}

TEST(PreviewIntegral, ADriverNeedsPreviewForHisDelay) {
  LoopSetup setup;
  setup.path = Path({}, {{600.0, 0.0, 1}});
  setup.start = {0.0, 0.3, 0.0};
  setup.vehicle = ReferenceCarWithTyres();
  setup.speed = 15.0;
  setup.duration = 30.0;
  const auto late = [&](double time, double delay) {
    const auto rows =
        Loop(PreviewIntegralOptions{.distance = 1.0, .time = time, .delay = delay}, setup);
    return LargestOffset(rows, rows.size() / 2);
  };
  EXPECT_LT(late(1.3, 0.2), 0.01);
  EXPECT_GT(late(0.4, 0.4), 0.3);
}

TEST(PreviewIntegral, SettlesOnTyresAfterAKick) {
  // With the preview distance of the kinematic car, the gain on an offset would be 2.5 times as
  // high at 15 m/s, and the limited steering rate would keep the car weaving by 3 m.
  for (const double speed : {5.0, 10.0, 12.0, 15.0, 20.0, 30.0}) {
    for (const double offset : {0.1, 0.3, 1.0, 3.0}) {
      SCOPED_TRACE(fmt::format("{} m/s, {} m", speed, offset));
      LoopSetup setup;
      setup.path = Path({}, {{2000.0, 0.0, 1}});
      setup.start = {0.0, offset, 0.0};
      setup.vehicle = ReferenceCarWithTyres();
      setup.speed = speed;
      setup.duration = 40.0;
      const std::vector<LoopRow> rows = Loop(PreviewIntegralOptions{}, setup);
      EXPECT_LT(LargestOffset(rows, rows.size() * 3 / 4), 0.01 * offset);
    }
  }
}

}  // namespace
}  // namespace trackbed
