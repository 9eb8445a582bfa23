// Tests the guarantees of every registered path-following controller.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "tests/control/loop.h"
#include "tests/geometry/random.h"
#include "tests/support/allocations.h"
#include "tests/tolerance.h"
#include "trackbed/control/controllers.h"
#include "trackbed/control/mpc.h"
#include "trackbed/control/optimal_steering.h"
#include "trackbed/control/preview_integral.h"
#include "trackbed/control/steering_controller.h"
#include "trackbed/core/error.h"

namespace trackbed {

void PrintTo(const ControllerEntry& entry, std::ostream* out);

namespace {

/// The state of a car, and the reference that the car follows.
struct Case {
  VehicleParams vehicle = ReferenceCar();
  Reference reference;
  VehicleState state;
  double station = 0.0;
};

double Steer(const ControllerOptions& options, const Case& at) {
  return MakeSteeringController(options)->Steer({.vehicle = at.vehicle,
                                                 .reference = at.reference,
                                                 .schedule = {},
                                                 .state = at.state,
                                                 .station = at.station,
                                                 .period = 0.02});
}

/// A state near a path of random shape, for a random car.
Case RandomCase(Random& random, int direction = 1) {
  Case at;
  at.vehicle = random.Uniform(0.0, 1.0) < 0.5 ? ReferenceCar() : ReferenceCarWithTyres();
  std::vector<Segment> segments;
  for (int i = 0; i < 6; ++i) {
    segments.push_back({.length = random.Uniform(5.0, 30.0),
                        .curvature = random.Uniform(-0.1, 0.1),
                        .direction = direction,
                        .sharpness = random.Uniform(-0.003, 0.003)});
  }
  at.reference.path = Path({}, segments);
  at.station = random.Uniform(0.0, at.reference.path.length());
  const double heading = random.Uniform(-0.3, 0.3);
  at.state.pose =
      Compose(at.reference.path.At(at.station).pose, {0.0, random.Uniform(-1.5, 1.5), heading});
  at.state.speed = direction * random.Uniform(1.0, 20.0);
  at.state.steering_actuator = random.Uniform(-0.2, 0.2);
  at.state.steering = at.state.steering_actuator;
  at.state.yaw_rate = random.Uniform(-0.3, 0.3);
  at.state.lateral_speed = random.Uniform(-0.3, 0.3);
  return at;
}

std::vector<ControllerEntry> Followers() {
  std::vector<ControllerEntry> followers;
  for (const ControllerEntry& entry : Controllers()) {
    if (entry.station == StationSource::kProjection) {
      followers.push_back(WithFewSamples(entry));
    }
  }
  return followers;
}

std::string CaseName(const testing::TestParamInfo<ControllerEntry>& test) {
  return test.param.name;
}

class EveryFollower : public testing::TestWithParam<ControllerEntry> {};

INSTANTIATE_TEST_SUITE_P(Table, EveryFollower, testing::ValuesIn(Followers()), CaseName);

// Tolerance of steering angles [rad]. Sines and cosines of paths and poses within 200 m have
// rounding errors of 1e-14 per meter, and the control laws divide by at least 0.1 m. mpc solves its
// quadratic program to 1e-9 rad/s over 0.02 s.
constexpr double kRounding = 1e-9;

TEST_P(EveryFollower, MirroredWorldMirrorsTheSteering) {
  Random random(81);
  for (int i = 0; i < 200; ++i) {
    SCOPED_TRACE(fmt::format("case {}", i));
    const Case at = RandomCase(random, i % 4 == 0 ? -1 : 1);
    Case mirrored = at;
    std::vector<Segment> segments = at.reference.path.segments();
    for (Segment& segment : segments) {
      segment.curvature = -segment.curvature;
      segment.sharpness = -segment.sharpness;
    }
    mirrored.reference.path = Path({}, segments);
    VehicleState& state = mirrored.state;
    state.pose = {state.pose.x, -state.pose.y, -state.pose.yaw};
    for (double* number :
         {&state.lateral_speed, &state.yaw_rate, &state.steering_actuator, &state.steering}) {
      *number = -*number;
    }
    EXPECT_NEAR(Steer(GetParam().defaults, mirrored), -Steer(GetParam().defaults, at),
                Tolerance(kRounding));
  }
}

TEST_P(EveryFollower, DoesNotCareWhereTheWorldBegins) {
  Random random(82);
  for (int i = 0; i < 200; ++i) {
    SCOPED_TRACE(fmt::format("case {}", i));
    const Case at = RandomCase(random, i % 4 == 0 ? -1 : 1);
    const Pose2 X_WA{random.Uniform(-50.0, 50.0), random.Uniform(-50.0, 50.0),
                     random.Uniform(-7.0, 7.0)};
    Case moved = at;
    moved.reference.path = Path(X_WA, at.reference.path.segments());
    moved.state.pose = Compose(X_WA, at.state.pose);
    EXPECT_NEAR(Steer(GetParam().defaults, moved), Steer(GetParam().defaults, at),
                Tolerance(kRounding));
  }
}

TEST_P(EveryFollower, WantsAnAngleThatTheCarHas) {
  Random random(83);
  for (int i = 0; i < 500; ++i) {
    Case at = RandomCase(random, i % 4 == 0 ? -1 : 1);
    at.state.pose.x += random.Uniform(-20.0, 20.0);
    at.state.pose.y += random.Uniform(-20.0, 20.0);
    at.state.pose.yaw += random.Uniform(-4.0, 4.0);
    at.state.speed *= random.Uniform(-1.0, 1.0);
    EXPECT_LE(std::abs(Steer(GetParam().defaults, at)), at.vehicle.steering_limit);
  }
}

TEST_P(EveryFollower, KeepsTheKinematicCarOnItsCircle) {
  for (const double curvature : {0.0, 0.01, -0.05, 0.15}) {
    for (const int direction : {1, -1}) {
      SCOPED_TRACE(fmt::format("curvature {}, direction {}", curvature, direction));
      Case at;
      at.reference.path = Path({}, {{200.0, curvature, direction}});
      at.station = 20.0;
      at.state.pose = at.reference.path.At(at.station).pose;
      at.state.speed = direction * 3.0;
      at.state.steering = SteeringForCurvature(at.vehicle, curvature);
      at.state.steering_actuator = at.state.steering;
      EXPECT_NEAR(Steer(GetParam().defaults, at), at.state.steering, Tolerance(kRounding));
    }
  }
}

TEST_P(EveryFollower, StaysOnRampsThatTheWheelsCanFollow) {
  const std::set<std::string> exact{"preview", "lqr", "mpc", "stanley", "rear_axle_feedback"};
  if (!exact.contains(GetParam().name)) {
    GTEST_SKIP() << "does not command the path's own steering";
  }
  // On the ramps, the wheels turn at 0.9 of their rate. A law with the steering of the path has no
  // error on them; what is left comes from the control period, and from the steps of mpc of 0.16 s.
  // A law that steers for a circle to a point 3/4 L ahead would be 0.07 m beside the path.
  for (const double speed : {1.0, -1.0, 3.0}) {
    for (const VehicleParams& vehicle : {ReferenceCar(), ReferenceCarWithTyres()}) {
      const int direction = speed < 0.0 ? -1 : 1;
      const double most = 0.15;  // [1/m]
      const double sharpness =
          0.9 * vehicle.steering_rate / (vehicle.wheelbase * std::abs(speed));  // [1/m^2]
      const double ramp = most / sharpness;
      LoopSetup setup;
      setup.vehicle = vehicle;
      setup.path = Path({}, {{5.0, 0.0, direction},
                             {ramp, 0.0, direction, sharpness},
                             {2.0 * ramp, most, direction, -sharpness},
                             {ramp, -most, direction, sharpness},
                             {5.0, 0.0, direction}});
      setup.speed = speed;
      setup.duration = setup.path.length() / std::abs(speed);
      SCOPED_TRACE(fmt::format("{} m/s, {}", speed, vehicle.cornering_stiffness_front));
      EXPECT_LT(LargestOffset(Loop(GetParam().defaults, setup)), 0.03);
    }
  }
}

TEST_P(EveryFollower, ComesBackToItsPath) {
  // Simulates the kinematic car with its rate limit. After 40 m, at most a tenth of the offset is
  // left. The car overshoots the path by at most its initial offset.
  for (const double offset : {0.3, -0.3}) {
    for (const int direction : {1, -1}) {
      SCOPED_TRACE(fmt::format("offset {}, direction {}", offset, direction));
      LoopSetup setup;
      setup.path = Path({}, {{100.0, 0.0, direction}});
      setup.start = {0.0, offset, 0.0};
      setup.speed = 3.0 * direction;
      const std::vector<LoopRow> rows = Loop(GetParam().defaults, setup);
      EXPECT_LT(LargestOffset(rows), std::abs(offset) + 1e-9);
      EXPECT_LT(LargestOffset(rows, rows.size() * 2 / 3), 0.1 * std::abs(offset));
    }
  }
}

TEST_P(EveryFollower, ComesBackFromMetersAway) {
  // With the steering rate omega, the car needs a distance of about cbrt(e L v/omega) to correct an
  // offset e. This is 7 m here, much less than the 200 m of the run.
  std::vector<ControllerOptions> all{GetParam().defaults};
  if (GetParam().defaults.Is<PreviewIntegralOptions>()) {
    all.emplace_back(PreviewIntegralOptions{.weight = PreviewWeight::kNear});
  }
  for (const ControllerOptions& options : all) {
    for (const double offset : {1.5, -4.0}) {
      for (const VehicleParams& vehicle : {ReferenceCar(), ReferenceCarWithTyres()}) {
        SCOPED_TRACE(fmt::format("offset {}, {}", offset, vehicle.cornering_stiffness_front));
        LoopSetup setup;
        setup.vehicle = vehicle;
        setup.path = Path({}, {{200.0, 0.0, 1}});
        setup.start = {0.0, offset, 0.0};
        setup.duration = 66.0;
        const std::vector<LoopRow> rows = Loop(options, setup);
        // As the car turns in, the rear axle slips outward by some hundredths of a millimeter.
        EXPECT_LT(LargestOffset(rows), std::abs(offset) + 1e-4);
        EXPECT_LT(LargestOffset(rows, rows.size() * 2 / 3), 0.01 * std::abs(offset));
      }
    }
  }
}

TEST_P(EveryFollower, TurnsItsWheelsNoFasterThanTheyCan) {
  // The car starts beside a path with a curvature step. Commands of lqr and mpc respect the rate
  // limit.
  LoopSetup setup;
  setup.path = Path({}, {{20.0, 0.0, 1}, {40.0, 0.08, 1}});
  setup.start = {0.0, 0.7, 0.1};
  const std::vector<LoopRow> rows = Loop(GetParam().defaults, setup);
  const double most = setup.vehicle.steering_rate * setup.period + 1e-12;
  const std::string name = GetParam().name;
  double fastest = 0.0;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const double turned = rows[i].state.steering_actuator - rows[i - 1].state.steering_actuator;
    EXPECT_LE(std::abs(turned), most);
    fastest = std::max(fastest, std::abs(turned));
    if (name == "lqr" || name == "mpc") {
      EXPECT_LE(std::abs(rows[i].wanted - rows[i - 1].wanted), most);
    }
  }
  // The curvature of the bend changes faster than the wheels can turn.
  EXPECT_GT(fastest, 0.9 * most);
}

TEST_P(EveryFollower, GoesOnAlongTheEndTangent) {
  // The car starts beside a straight path that ends after 10 m, and drives 50 m past its end.
  LoopSetup setup;
  setup.path = Path({}, {{10.0, 0.0, 1}});
  setup.start = {0.0, 0.2, 0.0};
  const std::vector<LoopRow> rows = Loop(GetParam().defaults, setup);
  EXPECT_GT(rows.back().state.pose.x, 55.0);
  EXPECT_LT(LargestOffset(rows, rows.size() * 2 / 3), 0.02);
  for (const LoopRow& row : rows) {
    EXPECT_LT(std::abs(row.wanted), 0.4);
  }
}

TEST_P(EveryFollower, StandsAndCrawlsWithoutTurningItsWheelsAbout) {
  // The car is on the path, at rest or at speeds of up to 1 m/s.
  for (const VehicleParams& vehicle : {ReferenceCar(), ReferenceCarWithTyres()}) {
    for (const double speed : {0.0, 1e-6, 0.01, 0.3, 1.0}) {
      Case at;
      at.vehicle = vehicle;
      at.reference.path = Path({}, {{200.0, 0.0, 1}});
      at.station = 20.0;
      at.state.pose = {20.0, 0.0, 0.0};
      at.state.speed = speed;
      EXPECT_NEAR(Steer(GetParam().defaults, at), 0.0, Tolerance(kRounding)) << speed;
    }
  }
}

class AnyController : public testing::TestWithParam<ControllerEntry> {};

INSTANTIATE_TEST_SUITE_P(ClosedLoop, AnyController, testing::ValuesIn(ControllersWithFewSamples()),
                         CaseName);

TEST_P(AnyController, RefusesAStateThatIsNone) {
  if (std::string(GetParam().name) == "playback") {
    GTEST_SKIP() << "has no defaults that can be driven";
  }
  const std::vector<double VehicleState::*> numbers{
      &VehicleState::speed,    &VehicleState::lateral_speed,     &VehicleState::yaw_rate,
      &VehicleState::steering, &VehicleState::steering_actuator, &VehicleState::distance};
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    for (const auto number : numbers) {
      Case at;
      at.reference.path = Path({}, {{200.0, 0.0, 1}});
      at.state.speed = 3.0;
      EXPECT_NO_THROW(Steer(GetParam().defaults, at));
      at.station = bad;
      EXPECT_THROW(Steer(GetParam().defaults, at), InternalError);
      at.station = 0.0;
      at.state.*number = bad;
      EXPECT_THROW(Steer(GetParam().defaults, at), InternalError);
    }
    for (double Pose2::*number : {&Pose2::x, &Pose2::y, &Pose2::yaw}) {
      Case at;
      at.state.pose.*number = bad;
      try {
        Steer(GetParam().defaults, at);
        ADD_FAILURE() << "took it";
      } catch (const InternalError& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("the car's state at 0 s is not finite"));
      }
    }
  }
}

/// Counts the allocations of a run that starts beside a path with an arc.
long CountAllocations(const ControllerOptions& options, const VehicleParams& vehicle, double offset,
                      double curvature) {
  const auto controller = MakeSteeringController(options);
  const Reference reference{Path({}, {{20.0, 0.0, 1}, {40.0, curvature, 1}, {100.0, 0.0, 1}}),
                            SpeedProfile({{0.0, 5.0}})};
  const SteeringSchedule schedule;
  VehicleState state;
  state.speed = 5.0;
  long before = 0;
  for (int i = 0; i < 200; ++i) {
    const double station = 0.5 * i;
    state.pose = Compose(reference.path.At(station).pose, {0.0, offset, 0.0});
    state.time = 0.1 * i;
    state.distance = station;
    if (i == 1) {
      before = allocations;
    }
    static_cast<void>(controller->Steer({.vehicle = vehicle,
                                         .reference = reference,
                                         .schedule = schedule,
                                         .state = state,
                                         .station = station,
                                         .period = 0.02}));
  }
  return allocations - before;
}

TEST_P(AnyController, TakesNoHeapMemoryAfterItsFirstStep) {
  if (std::string(GetParam().name) == "playback") {
    GTEST_SKIP() << "has no defaults that can be driven";
  }
  if (std::string(GetParam().name) == "optimal_steering") {
    GTEST_SKIP() << "searches, see TakeNLoptsMemoryAlone";
  }
  for (const VehicleParams& vehicle : {ReferenceCar(), ReferenceCarWithTyres()}) {
    EXPECT_EQ(CountAllocations(GetParam().defaults, vehicle, 0.0, 0.003), 0);
  }
}

// Limit of the allocations per call of NLopt. nlopt.hpp wraps options and vectors, which needs 20
// allocations per call (counted). The margin of one half is for other versions of nlopt.hpp.
constexpr long kOfOneCall = 30;

TEST(ControllersThatSearch, TakeNLoptsMemoryAlone) {
  // A program with active limits is solved once or twice in each of the 199 periods.
  const long of_mpc = CountAllocations(MpcOptions{}, ReferenceCar(), 1.0, 0.05);
  EXPECT_GT(of_mpc, 0);
  EXPECT_LT(of_mpc, 199 * 2 * kOfOneCall);
  // There is one search per period, and its allocations do not depend on the number of evaluations.
  // On a straight, there are no allocations.
  const OptimalSteeringOptions searching{.deviation_limit = 0.0};
  const long of_search = CountAllocations(searching, ReferenceCar(), 0.1, 0.05);
  EXPECT_GT(of_search, 0);
  EXPECT_LT(of_search, 199 * kOfOneCall);
  EXPECT_EQ(CountAllocations(OptimalSteeringOptions{}, ReferenceCar(), 0.0, 0.0), 0);
}

}  // namespace
}  // namespace trackbed
