#include "trackbed/control/steering_controller.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <ostream>
#include <set>
#include <string>
#include <vector>

#include "tests/control/loop.h"
#include "tests/geometry/random.h"
#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"
#include "tests/vehicle/wheel_pair.h"
#include "trackbed/control/controllers.h"
#include "trackbed/control/preview.h"
#include "trackbed/control/schedule.h"
#include "trackbed/control/steering_profile.h"
#include "trackbed/core/angle.h"

// Tests the preview angle against closed forms and brute force, the preview and schedule
// controllers, and guarantees of every registered controller.
namespace trackbed {

void PrintTo(const ControllerEntry& entry, std::ostream* out) {
  *out << entry.name;
}

namespace {

// The search finds the station of the intersection to 2^-48 of a station below 200 m, which is
// 7e-13 m. Seen from a distance of at least 2 m, this is an angle below 4e-13 rad.
constexpr double kFound = 1e-11;

double Steer(const ControllerOptions& options, const Path& path, const Pose2& pose, double station,
             const SteeringSchedule& schedule = {}, double speed = 3.0, double period = 0.02,
             double time = 0.0) {
  const VehicleParams car = ReferenceCar();
  const Reference reference{path, StopAtEnd(path.length(), 3.0, {3.0, 1.0, 1.5})};
  VehicleState state;
  state.time = time;
  state.pose = pose;
  state.speed = speed;
  return MakeSteeringController(options)->Steer({.vehicle = car,
                                                 .reference = reference,
                                                 .schedule = schedule,
                                                 .state = state,
                                                 .station = station,
                                                 .period = period});
}

Path Straight() {
  return {{}, {{100.0, 0.0, 1}}};
}
Path Circle(double radius) {
  return {{}, {{60.0, 1.0 / radius, 1}}};
}

// --- Preview angle -------------------------------------------------------------------------------

TEST(PreviewAngle, PointToTheLeftIsPositive) {
  EXPECT_GT(PreviewAngle(Straight(), {10.0, -0.5, 0.0}, 10.0, 3.0), 0.0);
  EXPECT_GT(PreviewAngle(Straight(), {10.0, 0.0, -0.1}, 10.0, 3.0), 0.0);
  EXPECT_GT(PreviewAngle(Circle(20.0), {}, 0.0, 3.0), 0.0);
}

TEST(PreviewAngle, OnAStraightIsZero) {
  for (const double s : {0.0, 17.3, 99.0, 150.0}) {
    EXPECT_NEAR(PreviewAngle(Straight(), {s, 0.0, 0.0}, s, 4.0), 0.0, Tolerance(kFound));
  }
}

TEST(PreviewAngle, BesideAStraightIsTheArcSine) {
  for (const double e : {-2.5, -0.3, 0.7, 2.9}) {
    EXPECT_NEAR(PreviewAngle(Straight(), {10.0, e, 0.2}, 10.0, 3.0), -std::asin(e / 3.0) - 0.2,
                Tolerance(kFound));
  }
}

TEST(PreviewAngle, OnACircleIsTheArcSine) {
  // A chord of length R in a circle of radius Rc makes the angle u = asin(R/(2 Rc)) with the
  // tangent at its start.
  EXPECT_NEAR(PreviewAngle(Circle(20.0), {}, 0.0, 4.0), 0.100167, Tolerance(0.5e-6));
  for (const double radius : {5.1, 10.0, 20.0, -20.0, 154.0}) {
    for (const double distance : {2.0, 4.0, 8.0}) {
      for (const double s : {0.0, 3.0, 20.0}) {
        SCOPED_TRACE(fmt::format("radius {}, distance {}, s {}", radius, distance, s));
        EXPECT_NEAR(PreviewAngle(Circle(radius), Circle(radius).At(s).pose, s, distance),
                    std::asin(distance / (2.0 * radius)), Tolerance(kFound));
      }
    }
  }
}

TEST(PreviewAngle, GoesOnAlongTheEndTangent) {
  // A quarter circle of 10 m ends at (10, 10) heading north. From 1 m before its end, P is on the
  // straight extension along the tangent.
  const Path path{{}, {{5.0 * kPi, 0.1, 1}}};
  EXPECT_NEAR(PreviewAngle(path, {10.0, 10.0, kPi / 2.0}, path.length(), 4.0), 0.0,
              Tolerance(kFound));
  EXPECT_NEAR(PreviewAngle(path, {11.0, 14.0, kPi / 2.0}, path.length() + 4.0, 4.0),
              std::asin(0.25), Tolerance(kFound));
  // Near the end the angle stays bounded, unlike the angle to a fixed end point.
  for (double s = path.length() - 4.0; s < path.length() + 10.0; s += 0.1) {
    EXPECT_LE(std::abs(PreviewAngle(path, path.At(s).pose, s, 4.0)),
              std::asin(0.2) + Tolerance(kFound));
  }
}

TEST(PreviewAngle, FurtherAwayThanItLooksHeadsForThePointAheadOfTheNearest) {
  // The car is 5 m to the left of a straight, which is more than the preview distance R = 3 m. The
  // controller then aims at the point P on the path 3 m ahead of the nearest point.
  EXPECT_NEAR(PreviewAngle(Straight(), {10.0, 5.0, 0.0}, 10.0, 3.0), std::atan2(-5.0, 3.0),
              Tolerance(kFound));
}

TEST(PreviewAngle, TurnsWithTheCarAndTheWorld) {
  Random random(61);
  for (int i = 0; i < 200; ++i) {
    const Path path({}, {{random.Uniform(5.0, 20.0), random.Uniform(-0.15, 0.15), 1},
                         {random.Uniform(5.0, 20.0), random.Uniform(-0.15, 0.15), 1}});
    const double s = random.Uniform(0.0, path.length());
    const Pose2 pose = Compose(path.At(s).pose, {0.0, random.Uniform(-1.0, 1.0), 0.0});
    const Pose2 X_WA{random.Uniform(-50.0, 50.0), random.Uniform(-50.0, 50.0),
                     random.Uniform(-4.0, 4.0)};
    const double turn = random.Uniform(-0.3, 0.3);
    SCOPED_TRACE(fmt::format("case {}: s {}", i, s));
    const double u = PreviewAngle(path, pose, s, 3.0);
    const Path moved(X_WA, path.segments());
    EXPECT_NEAR(PreviewAngle(moved, Compose(X_WA, pose), s, 3.0), u, Tolerance(kFound));
    EXPECT_NEAR(PreviewAngle(path, {pose.x, pose.y, pose.yaw + turn}, s, 3.0), u - turn,
                Tolerance(kFound));
    std::vector<Segment> mirrored = path.segments();
    for (Segment& segment : mirrored) {
      segment.curvature = -segment.curvature;
    }
    EXPECT_NEAR(PreviewAngle({{}, mirrored}, {pose.x, -pose.y, -pose.yaw}, s, 3.0), -u,
                Tolerance(kFound));
  }
}

TEST(PreviewAngle, AimsAtTheFirstCrossing) {
  // Finds the first crossing by brute force in steps of 0.1 mm along the path. With the preview
  // distance R, one step is an angle of 0.1 mm/R.
  Random random(62);
  for (int i = 0; i < 100; ++i) {
    std::vector<Segment> segments;
    for (int k = 0; k < 8; ++k) {
      segments.push_back({random.Uniform(0.5, 4.0), random.Uniform(-0.8, 0.8), 1});
    }
    const Path path({}, segments);
    const double s = random.Uniform(0.0, 10.0);
    const Pose2 pose = Compose(path.At(s).pose, {0.0, random.Uniform(-0.3, 0.3), 0.0});
    SCOPED_TRACE(fmt::format("case {}: s {}", i, s));
    double ahead = s;
    while ((path.At(ahead).pose.position() - pose.position()).norm() < 3.0) {
      ahead += 1e-4;
    }
    const Vec2 p = ToLocal(pose, path.At(ahead).pose.position());
    EXPECT_NEAR(AngleDifference(PreviewAngle(path, pose, s, 3.0), std::atan2(p.y(), p.x())), 0.0,
                Tolerance(1e-4));
  }
}

// --- Preview controller --------------------------------------------------------------------------

TEST(PreviewController, ExactArcSteersTheCircle) {
  // On a circle of radius Rc = 20 m with the preview distance R = 4 m, the exact arc commands
  // atan(L/Rc) = 0.134189 rad, and the linear law 0.135226 rad.
  const PreviewOptions exact{.distance = 4.0, .law = PreviewLaw::kExactArc};
  const PreviewOptions linear{.distance = 4.0, .law = PreviewLaw::kLinear};
  EXPECT_NEAR(Steer(exact, Circle(20.0), {}, 0.0), 0.134189, Tolerance(0.5e-6));
  EXPECT_NEAR(Steer(linear, Circle(20.0), {}, 0.0), 0.135226, Tolerance(0.5e-6));
  for (const double radius : {6.0, -8.0, 20.0, 154.0}) {
    SCOPED_TRACE(radius);
    EXPECT_NEAR(Steer(exact, Circle(radius), {}, 0.0), std::atan(2.7 / radius), Tolerance(kFound));
    EXPECT_NEAR(Steer(linear, Circle(radius), {}, 0.0), 2.0 * 2.7 / 4.0 * std::asin(2.0 / radius),
                Tolerance(kFound));
  }
}

TEST(PreviewController, ReversePathsSteerTheSameCircle) {
  // u is measured from the direction of motion, which points backward in reverse. The circle
  // through P and tangent to the car is the same, and so is the steering.
  for (const PreviewLaw law : {PreviewLaw::kExactArc, PreviewLaw::kLinear}) {
    SCOPED_TRACE(law == PreviewLaw::kLinear ? "linear" : "exact arc");
    const PreviewOptions options{.distance = 4.0, .law = law};
    const Path straight{{}, {{50.0, 0.0, -1}}};
    EXPECT_NEAR(Steer(options, straight, {}, 0.0, {}, -1.0), 0.0, Tolerance(kFound));
    const Path circle{{}, {{50.0, 0.05, -1}}};
    EXPECT_NEAR(Steer(options, circle, {}, 0.0, {}, -1.0),
                law == PreviewLaw::kLinear ? 0.135226 : 0.134189, Tolerance(0.5e-6));
  }
}

TEST(PreviewController, WithSlipSteersTheSteadyTurn) {
  // The angle u is measured from the velocity. For a car with tyres on its circle, the rear axle
  // moves along the circle and the car heads inward by its slip angle. The steering is that of the
  // understeering car, tan(delta) = kappa (L + K v^2).
  const VehicleParams car = ReferenceCarWithTyres();
  const double speed = 15.0;
  const double curvature = 0.01;
  const double force = car.mass * speed * speed * curvature / car.wheelbase;
  const double rear_slip = force * car.cg_to_front() / car.cornering_stiffness_rear;
  const double front_slip = force * car.cg_to_rear / car.cornering_stiffness_front;
  const Reference reference{Path({}, {{100.0, curvature, 1}}), {}};
  VehicleState state;
  state.pose.yaw = std::atan(rear_slip);
  state.speed = speed;
  state.yaw_rate = speed * curvature;
  state.lateral_speed = car.cg_to_rear * state.yaw_rate - speed * rear_slip;
  const auto steer = [&](const PreviewOptions& options) {
    return MakeSteeringController(options)->Steer({.vehicle = car,
                                                   .reference = reference,
                                                   .schedule = {},
                                                   .state = state,
                                                   .station = 0.0,
                                                   .period = 0.02});
  };
  const double wanted = std::atan(car.wheelbase * curvature + front_slip - rear_slip);
  EXPECT_NEAR(steer({.distance = 8.0}), wanted, Tolerance(kFound));
  EXPECT_GT(std::abs(steer({.distance = 8.0, .slip = false}) - wanted), 0.001);
}

TEST(PreviewController, LooksFurtherAheadTheFasterItGoes) {
  const PreviewOptions options{.distance = 4.0, .time = 1.0};
  const PreviewOptions far{.distance = 9.0};
  EXPECT_EQ(Steer(options, Circle(20.0), {0.0, 0.1, 0.0}, 0.0, {}, 9.0),
            Steer(far, Circle(20.0), {0.0, 0.1, 0.0}, 0.0, {}, 9.0));
  EXPECT_EQ(Steer(options, Circle(20.0), {0.0, 0.1, 0.0}, 0.0, {}, 3.0),
            Steer({PreviewOptions{.distance = 4.0}}, Circle(20.0), {0.0, 0.1, 0.0}, 0.0, {}, 3.0));
}

// --- Schedule controller -------------------------------------------------------------------------

TEST(ScheduleController, GivesTheValueAtTheEndOfThePeriod) {
  const SteeringSchedule schedule({{10.0, 30.0, 0.2}}, 0.05);
  const ScheduleOptions options;
  // At 3 m/s, the car is 1.5 m ahead at the end of the period of 0.5 s.
  EXPECT_NEAR(Steer(options, Straight(), {}, 9.0, schedule, 3.0, 0.5), 0.05 * 0.5,
              Tolerance(1e-15));
  EXPECT_NEAR(Steer(options, Straight(), {}, 12.0, schedule, 3.0, 0.5), 0.05 * 3.5,
              Tolerance(1e-15));
  EXPECT_EQ(Steer(options, Straight(), {}, 12.0, schedule, 0.0, 0.5), schedule.At(12.0));
}

TEST(ConstantSteeringController, HoldsItsAngle) {
  EXPECT_EQ(Steer(ConstantSteeringOptions{.steering = -0.3}, {}, {1.0, 2.0, 3.0}, 7.0), -0.3);
}

TEST(ProfileControllers, GiveTheAngleAtTheEndOfThePeriod) {
  const auto steer = [](const ControllerOptions& options, double time) {
    return Steer(options, {}, {1.0, 2.0, 3.0}, 7.0, {}, 3.0, 0.1, time);
  };
  const RampSteeringOptions ramp{.end = 0.3, .rate = 0.1, .at = 1.0};
  EXPECT_NEAR(steer(ramp, 0.95), 0.005, Tolerance(1e-15));
  EXPECT_NEAR(steer(ramp, 2.0), 0.11, Tolerance(1e-15));
  EXPECT_EQ(steer(StepSteeringOptions{.amplitude = 0.2, .at = 1.0, .rate = {}}, 0.95), 0.2);
  const SineSteeringOptions sine{.amplitude = 0.2};
  EXPECT_EQ(steer(sine, 1.4), SteeringAt(sine, 1.5));
  const SineWithDwellOptions dwell{.amplitude = 0.2};
  EXPECT_EQ(steer(dwell, 1.4), SteeringAt(dwell, 1.5));
  const SweptSineOptions swept{.amplitude = 0.2};
  EXPECT_EQ(steer(swept, 1.4), SteeringAt(swept, 1.5));
}

// --- Guarantees of every registered controller ---------------------------------------------------

class EveryController : public ::testing::TestWithParam<ControllerEntry> {};

TEST_P(EveryController, IsFoundByItsOptions) {
  EXPECT_STREQ(ControllerFor(GetParam().defaults).name, GetParam().name);
  EXPECT_FALSE(std::string(GetParam().summary).empty());
}

TEST_P(EveryController, GoesStraightOnAStraight) {
  EXPECT_NEAR(Steer(GetParam().defaults, Straight(), {20.0, 0.0, 0.0}, 20.0), 0.0,
              Tolerance(kFound));
}

TEST_P(EveryController, AnswersWithAFiniteAngleWhereverTheCarIs) {
  Random random(63);
  const Path path{{}, {{20.0, 0.0, 1}, {8.0, 0.15, 1}, {20.0, -0.1, 1}}};
  const SteeringSchedule schedule({{18.0, 26.0, 0.3}, {26.0, 40.0, -0.2}}, 0.05);
  for (int i = 0; i < 500; ++i) {
    const double s = random.Uniform(-5.0, path.length() + 20.0);
    Pose2 pose = path.At(s).pose;
    pose.x += random.Uniform(-10.0, 10.0);
    pose.y += random.Uniform(-10.0, 10.0);
    pose.yaw += random.Uniform(-4.0, 4.0);
    EXPECT_TRUE(std::isfinite(Steer(GetParam().defaults, path, pose, s, schedule)));
  }
}

TEST_P(EveryController, GivesTheSameEachTime) {
  const Path path{{}, {{20.0, 0.05, 1}}};
  const Pose2 pose = path.At(5.0).pose;
  EXPECT_EQ(Steer(GetParam().defaults, path, pose, 5.0),
            Steer(GetParam().defaults, path, pose, 5.0));
}

INSTANTIATE_TEST_SUITE_P(Table, EveryController, ::testing::ValuesIn(ControllersWithFewSamples()),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(Controllers, HaveNamesAndOptionsOfTheirOwn) {
  const std::vector<ControllerEntry>& all = Controllers();
  ASSERT_GE(all.size(), 15U);
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_STRNE(all[i].name, all[j].name);
      EXPECT_FALSE(AreOfOneMethod(all[i].defaults, all[j].defaults)) << all[i].name;
    }
  }
}

TEST(Controllers, OpenLoopsReadTheOdometer) {
  EXPECT_EQ(ControllerFor(ScheduleOptions{}).station, StationSource::kOdometer);
  EXPECT_EQ(ControllerFor(PreviewOptions{}).station, StationSource::kProjection);
  EXPECT_TRUE(ControllerFor(ScheduleOptions{}).needs_plan);
  EXPECT_TRUE(ControllerFor(PreviewOptions{}).needs_plan);
  EXPECT_FALSE(ControllerFor(ConstantSteeringOptions{}).needs_plan);
}

// --- Differential drive --------------------------------------------------------------------------

TEST(Preview, WithDifferentialDriveCommandsADifferenceOfWheelSpeedsInProportionToTheAngle) {
  // The difference of the wheel speeds is omega_R - omega_L = (2 b v/(R r_w)) sin(u), with the
  // track width b, the preview distance R and the wheel radius r_w. For small angles u, the
  // difference is proportional to u.
  const VehicleParams pair = WheelPair();
  const Path path = Straight();
  const Reference reference{path, StopAtEnd(path.length(), 3.0, {3.0, 1.0, 1.5})};
  for (const double heading : {-0.4, -0.02, 0.0, 0.1, 0.7}) {
    VehicleState state;
    state.pose = {10.0, 0.0, heading};
    state.speed = 1.5;
    const double steering = MakeSteeringController(PreviewOptions{.distance = 2.0})
                                ->Steer({.vehicle = pair,
                                         .reference = reference,
                                         .schedule = {},
                                         .state = state,
                                         .station = 10.0,
                                         .period = 0.02});
    const AxleSpeeds wheels = AxleSpeedsFor(pair, state.speed, steering);
    const double u = -heading;
    EXPECT_NEAR((wheels.right - wheels.left) / pair.wheel_radius,
                2.0 * 0.6 * 1.5 / (2.0 * 0.165) * std::sin(u), Tolerance(100.0 * kFound));
  }
}

}  // namespace
}  // namespace trackbed
