#include "src/control/actuator_model.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <functional>

#include "src/control/error_model.h"
#include "tests/control/loop.h"
#include "tests/tolerance.h"
#include "trackbed/control/lqr.h"
#include "trackbed/control/mpc.h"
#include "trackbed/control/preview.h"
#include "trackbed/control/rear_axle_feedback.h"
#include "trackbed/vehicle/steady_turn.h"
#include "trackbed/vehicle/steering_response.h"

// Controllers in a loop with an actuator that has dead time, lag, backlash and a curve.
namespace trackbed {
namespace actuator_model_test {

constexpr double kPeriod = 0.02;
constexpr int kSteps = 10;  // plant steps in a control period

struct Row {
  VehicleState state;
  double cross_track = 0.0;
  double command = 0.0;
};

struct Drive {
  VehicleParams vehicle;
  Path path;
  Pose2 start;
  double speed = 2.0;
  int periods = 500;
};

/// Drives a car behind its SteeringFilter at constant speed: SingleTrackCar if the vehicle has
/// tyres, otherwise KinematicCar.
std::vector<Row> Simulate(SteeringController& controller, const Drive& drive) {
  const VehicleParams& vehicle = drive.vehicle;
  const KinematicState start{.pose = drive.start, .speed = drive.speed};
  KinematicCar kinematic(vehicle, ReferencePoint::kRearAxle, start);
  std::optional<SingleTrackCar> single_track;
  if (vehicle.cornering_stiffness_front > 0.0) {
    single_track.emplace(vehicle, RollingWithoutSlip(vehicle, start));
  }
  SteeringFilter filter(vehicle.steering_response, kPeriod / kSteps, 0.0);
  const Reference reference{drive.path, SpeedProfile({{0.0, drive.speed}})};
  std::vector<Row> rows;
  double station = 0.0;
  for (int k = 0; k < drive.periods; ++k) {
    Row row{.state = single_track ? single_track->FullState() : kinematic.FullState()};
    const Projection at = drive.path.Project(row.state.pose, {station - 2.0, station + 4.0});
    station = at.s;
    row.cross_track = at.cross_track;
    row.command = controller.Steer({.vehicle = vehicle,
                                    .reference = reference,
                                    .schedule = {},
                                    .state = row.state,
                                    .station = station,
                                    .period = kPeriod});
    for (int i = 0; i < kSteps; ++i) {
      const Command command{.steering = filter.Pass(row.command)};
      single_track ? single_track->Step(command, kPeriod / kSteps)
                   : kinematic.Step(command, kPeriod / kSteps);
    }
    rows.push_back(row);
  }
  return rows;
}

std::vector<Row> Simulate(const ControllerOptions& options, const Drive& drive) {
  return Simulate(*MakeSteeringController(options), drive);
}

/// A 1:10 car with the actuator of models/dart, but without tyres.
VehicleParams SmallCar() {
  VehicleParams car;
  car.wheelbase = 0.1735;
  car.steering_limit = 0.5;
  car.steering_rate = 10.0;
  car.steering_response.dead_time = 0.042;
  car.steering_response.time_constant = 0.046;
  car.steering_response.backlash = 0.0228;
  car.length = 0.27;
  car.width = 0.144;
  return car;
}

VehicleParams SmallCarWithTyres() {
  VehicleParams car = SmallCar();
  car.mass = 1.58;
  car.yaw_inertia = 0.0048;
  car.cg_to_rear = 0.093;
  car.cornering_stiffness_front = 53.0;
  car.cornering_stiffness_rear = 62.0;
  return car;
}

Path Straight(double length) {
  return {{}, {{length, 0.0, 1}}};
}

/// Steers by a function of time [s], and records the states that it receives.
class Recorder final : public SteeringController {
 public:
  Recorder(std::function<double(double)> law, std::vector<VehicleState>& seen)
      : law_(std::move(law)), seen_(seen) {}

  double Steer(const ControlInput& input) override {
    seen_.push_back(input.state);
    return law_(input.state.time);
  }

 private:
  std::function<double(double)> law_;
  std::vector<VehicleState>& seen_;
};

TEST(ActuatorModel, PredictsACircleInClosedForm) {
  // Long after the last change of the command, the car follows a circle with the curvature
  // tan(delta)/L. During the dead time T_d, the car moves by T_d v along this circle.
  VehicleParams car = SmallCar();
  car.steering_response.backlash = 0.0;
  std::vector<VehicleState> seen;
  const auto controller = WithActuatorModel(
      std::make_unique<Recorder>([](double) { return 0.2; }, seen), ActuatorKnowledge::kModel);
  const std::vector<Row> rows = Simulate(*controller, {car, Straight(100.0), {}, 2.0, 200});
  const double way = 2.0 * car.steering_response.dead_time;
  // After 3 s, the lag has decayed by exp(-3/0.046) < 1e-28.
  for (std::size_t k = 150; k < rows.size(); ++k) {
    const Pose2 expected = MoveOnArc(rows[k].state.pose, way, way * std::tan(0.2) / car.wheelbase);
    ASSERT_NEAR(seen[k].pose.x, expected.x, Tolerance(1e-9)) << k;
    ASSERT_NEAR(seen[k].pose.y, expected.y, Tolerance(1e-9)) << k;
    ASSERT_NEAR(seen[k].pose.yaw, expected.yaw, Tolerance(1e-9)) << k;
  }
}

TEST(ActuatorModel, PredictsWhereTheCarWillBe) {
  // At the end of the dead time of three periods, the simulated state must equal the state that the
  // controller predicted three periods earlier. The car weaves, through the lag and the backlash of
  // its steering. The predicted and the simulated car take the same steps of 2 ms, so only rounding
  // differs. Until the rear axle first slips, in period 4, the car in the prediction is kinematic.
  for (VehicleParams car : {SmallCar(), SmallCarWithTyres()}) {
    SCOPED_TRACE(car.mass);
    car.steering_response.dead_time = 3.0 * kPeriod;
    std::vector<VehicleState> seen;
    const auto controller = WithActuatorModel(
        std::make_unique<Recorder>([](double t) { return 0.3 * std::sin(5.0 * t); }, seen),
        ActuatorKnowledge::kModel);
    const std::vector<Row> rows = Simulate(*controller, {car, Straight(100.0), {}, 2.0, 300});
    for (std::size_t k = 6; k + 3 < rows.size(); ++k) {
      const VehicleState& later = rows[k + 3].state;
      ASSERT_NEAR(seen[k].pose.x, later.pose.x, Tolerance(1e-9)) << k;
      ASSERT_NEAR(seen[k].pose.y, later.pose.y, Tolerance(1e-9)) << k;
      ASSERT_NEAR(seen[k].pose.yaw, later.pose.yaw, Tolerance(1e-9)) << k;
      ASSERT_NEAR(seen[k].steering, later.steering, Tolerance(1e-9)) << k;
      ASSERT_NEAR(seen[k].yaw_rate, later.yaw_rate, Tolerance(1e-8)) << k;
    }
  }
}

class WithDeadTime : public ::testing::TestWithParam<ControllerEntry> {};

TEST_P(WithDeadTime, DrivesAsWithoutItButLater) {
  // With an exact model, a Smith predictor removes the dead time T_d from the loop. The delayed car
  // then follows a car without dead time, later by T_d. Rounding and the projections onto the path
  // cause differences below 1e-6 m and 1e-6 rad.
  const Path bend{{}, {{30.0, 0.0, 1}, {15.0, 0.05, 1}, {60.0, 0.0, 1}}};
  VehicleParams late = ReferenceCar();
  late.steering_response.dead_time = 3.0 * kPeriod;
  const Pose2 start{1.0, 0.4, 0.05};
  const Pose2 moved = MoveOnArc(start, 3.0 * kPeriod * 5.0, 0.0);
  const std::vector<Row> delayed = Simulate(GetParam().defaults, {late, bend, start, 5.0, 600});
  const std::vector<Row> ideal =
      Simulate(GetParam().defaults, {ReferenceCar(), bend, moved, 5.0, 597});
  for (std::size_t i = 0; i < ideal.size(); ++i) {
    ASSERT_NEAR(delayed[i + 3].state.pose.x, ideal[i].state.pose.x, Tolerance(1e-6)) << i;
    ASSERT_NEAR(delayed[i + 3].state.pose.y, ideal[i].state.pose.y, Tolerance(1e-6)) << i;
    ASSERT_NEAR(delayed[i + 3].state.pose.yaw, ideal[i].state.pose.yaw, Tolerance(1e-6)) << i;
  }
}

/// The controllers that compute the steering exactly, not by a search with a tolerance.
std::vector<ControllerEntry> ExactFollowers() {
  std::vector<ControllerEntry> all = FollowersWithFewSamples();
  std::erase_if(all, [](const ControllerEntry& entry) {
    return std::string(entry.name) == "optimal_steering";
  });
  return all;
}

const auto kName = [](const auto& test) { return std::string(test.param.name); };

INSTANTIATE_TEST_SUITE_P(ExactFollowers, WithDeadTime, ::testing::ValuesIn(ExactFollowers()),
                         kName);

class OnASmallCar : public ::testing::TestWithParam<ControllerEntry> {};

TEST_P(OnASmallCar, IsCalmOnAStraight) {
  // The steering may reverse at most once per second, and the car may be at most 10 mm beside its
  // path at 2 m/s, in both car models. optimal_steering accepts the initial offset, because this
  // offset is within its deviation_limit.
  const std::string name = GetParam().name;
  for (const VehicleParams& car : {SmallCar(), SmallCarWithTyres()}) {
    const std::vector<Row> rows =
        Simulate(GetParam().defaults, {car, Straight(40.0), {0.0, 0.05, 0.0}, 2.0, 750});
    int reversals = 0;
    double largest = 0.0;
    for (std::size_t i = 251; i < rows.size(); ++i) {  // 10 s after 5 s
      reversals += rows[i].command * rows[i - 1].command < 0.0 ? 1 : 0;
      largest = std::max(largest, std::abs(rows[i].cross_track));
    }
    EXPECT_LE(reversals, 10) << car.mass;
    EXPECT_LE(largest, name == "optimal_steering" ? 0.0501 : 0.01) << car.mass;
  }
}

TEST_P(OnASmallCar, CrossesItsPlayEverMoreRarely) {
  // Within the dead zone, the car drifts from one edge to the other, and a correction at the edge
  // turns it back. If the law corrects with the damping ratio 0.7, a correction reverses the
  // heading error and multiplies it by exp(-pi) = 0.04. Each drift then takes 23 times as long as
  // the drift before it, so at most two corrections fall into the last 20 s of 30 s. Each
  // correction crosses the play at most twice. The damping of stanley depends on the speed; for
  // stanley, the test only requires at most one reversal per second, as for a calm drive.
  for (const VehicleParams& car : {SmallCar(), SmallCarWithTyres()}) {
    for (const double speed : {1.0, 2.57, 3.02, 4.0}) {
      for (const double offset : {0.011, -0.02}) {
        SCOPED_TRACE(fmt::format("{} kg, {} m/s, {} m", car.mass, speed, offset));
        const std::vector<Row> rows =
            Simulate(GetParam().defaults, {car, Straight(200.0), {0.0, offset, 0.0}, speed, 1500});
        int crossings = 0;
        for (std::size_t i = 501; i < rows.size(); ++i) {
          crossings += rows[i].command * rows[i - 1].command < 0.0 ? 1 : 0;
        }
        EXPECT_LE(crossings, std::string(GetParam().name) == "stanley" ? 20 : 4);
      }
    }
  }
}

TEST_P(OnASmallCar, IsCopiedWithItsQueue) {
  const auto controller = MakeSteeringController(GetParam().defaults);
  const Drive drive{SmallCar(), Straight(40.0), {0.0, 0.05, 0.0}, 2.0, 50};
  Simulate(*controller, drive);
  const auto copy = controller->Clone();
  ASSERT_NE(copy, nullptr);
  const std::vector<Row> first = Simulate(*controller, drive);
  const std::vector<Row> second = Simulate(*copy, drive);
  for (std::size_t i = 0; i < first.size(); ++i) {
    ASSERT_EQ(first[i].command, second[i].command) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Followers, OnASmallCar, ::testing::ValuesIn(FollowersWithFewSamples()),
                         kName);

/// Number of control periods of the dead time in a loop with the controller lqr on a straight path.
constexpr int kDelay = 5;

struct SampledLoop {
  Eigen::MatrixXd compensated;  ///< State (e, psi, c).
  Eigen::MatrixXd ignorant;     ///< State (e, psi, c_1, ..., c_(n+1)), the newest command first.
};

double SpectralRadius(const Eigen::MatrixXd& matrix) {
  return matrix.eigenvalues().cwiseAbs().maxCoeff();
}

/// The linear sampled loop: the steering rate is w = -K (e, psi, delta, delta_w), and the command
/// of period k is c_k = c_(k-1) + w T. In period k, the car turns by the angle c_(k-n), the command
/// n periods earlier.
SampledLoop SampledLoopOf(const VehicleParams& car, const LqrOptions& options, double speed) {
  const Path path = Straight(100.0);
  const Reference reference{path, SpeedProfile({{0.0, speed}})};
  VehicleState state;
  state.speed = speed;
  const ControlInput input{.vehicle = car,
                           .reference = reference,
                           .schedule = {},
                           .state = state,
                           .station = 1.0,
                           .period = kPeriod};
  const ErrorModel model = MakeErrorModel(input, ProjectOntoPath(input), kPeriod);
  const Regulator regulator = SolveRegulator(model, WeightsFor(car, options));
  const auto& k = regulator.gain;
  const double way = speed * kPeriod;
  const double turn = way / car.wheelbase;

  SampledLoop loop;
  Eigen::Matrix3d m = Eigen::Matrix3d::Zero();
  m.row(2) << -kPeriod * k[0], -kPeriod * k[1], 1.0 - kPeriod * (k[2] + k[3]);
  m.row(1) = Eigen::RowVector3d(0.0, 1.0, 0.0) + turn * m.row(2);
  m.row(0) = Eigen::RowVector3d(1.0, way, 0.0) + 0.5 * way * turn * m.row(2);
  loop.compensated = m;

  constexpr int kStates = 2 + kDelay + 1;
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(kStates, kStates);
  a(0, 0) = 1.0;
  a(0, 1) = way;
  a(1, 1) = 1.0;
  a(0, kStates - 2) = 0.5 * way * turn;  // the command c_(k-n) acts in this period
  a(1, kStates - 2) = turn;
  a(2, 0) = -kPeriod * k[0];
  a(2, 1) = -kPeriod * k[1];
  a(2, 2) = 1.0;
  a(2, kStates - 1) =
      -kPeriod * (k[2] + k[3]);  // the measured steering angle is the command c_(k-1-n)
  for (int i = 3; i < kStates; ++i) {
    a(i, i - 1) = 1.0;
  }
  loop.ignorant = a;
  return loop;
}

TEST(ActuatorModel, StabilizesTheSampledLoop) {
  // Without compensation, the sampled loop with a dead time of 0.1 s has an eigenvalue outside of
  // the unit circle. With compensation, the loop has the eigenvalues of the loop without dead time,
  // and the simulated offset follows the powers of its matrix, delayed. The linear loop neglects
  // terms of third order. With angles of 1e-3 rad, these terms are less than 1e-6 of the offset of
  // 1 mm. A step of the wheels by 1e-3 rad at 1e6 rad/s takes 1e-9 s.
  VehicleParams car = SmallCar();
  car.steering_response = {};
  car.steering_rate = 1e6;
  const double speed = 2.0;
  const LqrOptions options{.cross_track = 240.0, .steering_rate = 2e-3};
  const SampledLoop loop = SampledLoopOf(car, options, speed);
  ASSERT_LT(SpectralRadius(loop.compensated), 1.0);
  ASSERT_GT(SpectralRadius(loop.ignorant), 1.0);

  VehicleParams late = car;
  late.steering_response.dead_time = kDelay * kPeriod;
  const double offset = 1e-4;
  const Drive drive{late, Straight(40.0), {0.0, offset, 0.0}, speed, 200};
  const std::vector<Row> rows = Simulate(options, drive);
  Eigen::Vector3d x(offset, 0.0, 0.0);
  for (std::size_t i = 0; i + kDelay < rows.size(); ++i) {
    ASSERT_NEAR(rows[i + kDelay].cross_track, x[0], Tolerance(1e-8)) << i;
    x = loop.compensated * x;
  }

  const auto ignorant =
      WithActuatorModel(ControllerFor(options).make(options), ActuatorKnowledge::kIgnore);
  // The offset grows from 1e-6 m by a factor of about 100 within 30 periods. The angles stay below
  // 1e-2 rad, so the terms of third order are less than 1e-4 of the offset.
  const double small = 1e-6;
  const std::vector<Row> growing =
      Simulate(*ignorant, {late, Straight(40.0), {0.0, small, 0.0}, speed, 30});
  Eigen::VectorXd y = Eigen::VectorXd::Zero(loop.ignorant.rows());
  y[0] = small;
  for (const Row& row : growing) {
    ASSERT_NEAR(row.cross_track, y[0], Tolerance(1e-8));
    y = loop.ignorant * y;
  }
  EXPECT_GT(std::abs(growing.back().cross_track), 10.0 * small);
}

TEST(ActuatorModel, CommandsWhatRestsAtTheWantedAngle) {
  // Beside a straight path and without delay, pure pursuit commands the steering angle that an
  // ideal actuator would need. The dead zone, which is a quarter of the backlash, moves this angle
  // toward the steering angle of the straight path.
  VehicleParams car = ReferenceCar();
  car.steering_response.curve = {{-0.5, -0.45}, {-0.2, -0.2}, {0.1, 0.05}, {0.5, 0.4}};
  car.steering_response.backlash = 0.02;
  for (const double offset : {-0.8, 0.7, 1.0}) {
    SCOPED_TRACE(offset);
    const PreviewOptions options{.distance = 8.0};
    Drive drive{ReferenceCar(), Straight(100.0), {5.0, offset, 0.0}, 3.0, 1};
    const double wanted = Simulate(options, drive)[0].command;
    drive.vehicle = car;
    const double command = Simulate(options, drive)[0].command;
    EXPECT_NEAR(RestingSteering(car, command), wanted - std::copysign(0.005, wanted),
                Tolerance(1e-9));
  }
}

TEST(ActuatorModel, PassesAnIdealActuator) {
  const VehicleParams car = ReferenceCar();
  const Drive drive{car, Straight(100.0), {5.0, 0.7, 0.1}, 3.0, 50};
  for (const ControllerEntry& entry : FollowersWithFewSamples()) {
    const auto bare = entry.make(entry.defaults);
    const std::vector<Row> expected = Simulate(*bare, drive);
    const std::vector<Row> wrapped = Simulate(entry.defaults, drive);
    for (std::size_t i = 0; i < expected.size(); ++i) {
      ASSERT_EQ(wrapped[i].command, expected[i].command) << entry.name << i;
    }
  }
}

TEST(ActuatorModel, KnowsThatACarWithoutSlipIsKinematic) {
  // On its circle, a kinematic car needs the angle atan(L kappa). Once the rear axle has moved
  // sideways, the car has tyres, and needs the steering of its steady turn.
  VehicleParams car = ReferenceCarWithTyres();
  const double speed = 15.0;
  const double curvature = 0.01;
  const Reference reference{Path({}, {{100.0, curvature, 1}}), SpeedProfile({{0.0, speed}})};
  const auto controller = MakeSteeringController(RearAxleFeedbackOptions{});
  VehicleState state;
  state.speed = speed;
  const auto steer = [&](double heading, double lateral_speed) {
    state.pose = reference.path.At(20.0).pose;
    state.pose.yaw += heading;
    state.yaw_rate = speed * curvature;
    state.lateral_speed = lateral_speed;
    return controller->Steer({.vehicle = car,
                              .reference = reference,
                              .schedule = {},
                              .state = state,
                              .station = 20.0,
                              .period = 0.02});
  };
  EXPECT_NEAR(steer(0.0, car.cg_to_rear * speed * curvature), std::atan(car.wheelbase * curvature),
              Tolerance(1e-12));
  const SteadyTurn turn = SteadyTurnOn(car, curvature, speed);
  ASSERT_GT(std::abs(turn.steering - std::atan(car.wheelbase * curvature)), 1e-3);
  EXPECT_NEAR(steer(turn.heading_error, turn.lateral_speed), turn.steering, Tolerance(1e-12));
  EXPECT_NEAR(steer(turn.heading_error, car.cg_to_rear * speed * curvature), turn.steering,
              Tolerance(1e-12));
}

TEST(ActuatorModel, IsLeftOutOnRequest) {
  // Without the model, the dead time of the small car makes the loop of lqr oscillate.
  const Drive drive{SmallCar(), Straight(40.0), {0.0, 0.05, 0.0}, 2.0, 750};
  const auto reversals = [&](ActuatorKnowledge actuator) {
    const auto controller = MakeSteeringController(LqrOptions{}, actuator);
    const std::vector<Row> rows = Simulate(*controller, drive);
    int count = 0;
    for (std::size_t i = 251; i < rows.size(); ++i) {
      count += rows[i].command * rows[i - 1].command < 0.0 ? 1 : 0;
    }
    return count;
  };
  EXPECT_LE(reversals(ActuatorKnowledge::kModel), 10);
  EXPECT_GT(reversals(ActuatorKnowledge::kIgnore), 20);
}

}  // namespace actuator_model_test
}  // namespace trackbed
