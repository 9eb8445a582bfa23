#include "src/control/error_model.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "tests/control/loop.h"
#include "tests/geometry/random.h"
#include "tests/tolerance.h"

// Tests the linear error model of lqr and mpc: against the single-track car near a path, the
// Riccati equation's cost, curvature preview, and stiffness under load transfer with brush tyres.
namespace trackbed {
namespace {

/// A car on a path, by default in a steady turn.
class Situation {
 public:
  Situation(const VehicleParams& vehicle, double speed, double curvature)
      : vehicle_(vehicle), reference_{Path({}, {{500.0, curvature, speed < 0.0 ? -1 : 1}}), {}} {
    const SteadyTurn turn = SteadyTurnOn(vehicle, curvature, speed);
    const double station = 10.0;
    state.pose = reference_.path.At(station).pose;
    state.pose.yaw += turn.heading_error;
    state.speed = speed;
    state.lateral_speed = turn.lateral_speed;
    state.yaw_rate = turn.yaw_rate;
    state.steering = turn.steering;
    state.steering_actuator = turn.steering;
  }

  [[nodiscard]] ControlInput input() const {
    return {.vehicle = vehicle_,
            .reference = reference_,
            .schedule = schedule_,
            .state = state,
            .station = 10.0,
            .period = 0.02};
  }

  VehicleState state;

 private:
  VehicleParams vehicle_;
  Reference reference_;
  SteeringSchedule schedule_;
};

std::vector<VehicleParams> Cars() {
  return {ReferenceCar(), ReferenceCarWithTyres()};
}

TEST(SteadyTurn, IsWhereTheSingleTrackCarSettles) {
  const VehicleParams car = ReferenceCarWithTyres();
  for (const double curvature : {0.02, -0.05, 0.15}) {
    for (const double speed : {2.0, 8.0, -3.0}) {
      SCOPED_TRACE(fmt::format("curvature {}, speed {}", curvature, speed));
      const SteadyTurn turn = SteadyTurnOn(car, curvature, speed);
      SingleTrackCar driven(car, {.pose = {},
                                  .speed = speed,
                                  .lateral_speed = turn.lateral_speed,
                                  .yaw_rate = turn.yaw_rate,
                                  .steering = turn.steering});
      driven.Step({.steering = turn.steering, .acceleration = 0.0, .gear = speed < 0.0 ? -1 : 1},
                  2.0);
      // SingleTrackCar is accurate to 1e-9.
      EXPECT_NEAR(driven.state().lateral_speed, turn.lateral_speed, Tolerance(1e-9));
      EXPECT_NEAR(driven.state().yaw_rate, turn.yaw_rate, Tolerance(1e-9));
      // The rear axle moves along the path when the car's heading error is psi_0.
      const double rear = turn.lateral_speed - car.cg_to_rear * turn.yaw_rate;
      EXPECT_NEAR(std::atan(rear / speed), -turn.heading_error,
                  Tolerance(std::pow(std::abs(turn.heading_error), 3)) + 1e-12);
    }
  }
}

TEST(ErrorModel, StaysInASteadyTurn) {
  for (const VehicleParams& car : Cars()) {
    for (const double speed : {1.0, 3.0, 20.0, -2.0}) {
      for (const double curvature : {0.0, 0.01, -0.12}) {
        SCOPED_TRACE(fmt::format("{} m/s, {} 1/m", speed, curvature));
        const Situation situation(car, speed, curvature);
        const ControlInput input = situation.input();
        const Tracking tracking = ProjectOntoPath(input);
        const ErrorModel model = MakeErrorModel(input, tracking, 0.1);
        Ahead ahead(input, tracking, model);
        // Headings on a path of 500 m are rounded by about 1e-13 rad. Divided by a stride of at
        // least 0.1 m, this causes an error of 1e-12 1/m in the curvature.
        EXPECT_LT((ErrorState(input, tracking) - ahead.steady()).norm(), Tolerance(1e-12));
        for (int k = 0; k < 5; ++k) {
          EXPECT_LT(ahead.Next().norm(), Tolerance(1e-11));
        }
      }
    }
  }
}

TEST(ErrorModel, RunsAsTheCarDoesNearItsPath) {
  // Compares the linear model with SingleTrackCar after 0.1 s at a steering rate of 0.1 rad/s,
  // starting with an offset of 1e-3 in every state but the steering. The linear model neglects the
  // squares of the states, about 1e-6, and the cube of the steering angle.
  for (const double speed : {2.0, 10.0, 20.0, -2.0}) {
    SCOPED_TRACE(speed);
    VehicleParams car = ReferenceCarWithTyres();
    car.steering_lag = 0.0;
    Situation situation(car, speed, 0.0);
    VehicleState& state = situation.state;
    state.pose.y += 1e-3;
    state.pose.yaw += 1e-3;
    state.lateral_speed += 1e-3;
    state.yaw_rate += 1e-3;
    const ControlInput input = situation.input();
    const Tracking tracking = ProjectOntoPath(input);
    const ErrorModel model = MakeErrorModel(input, tracking, 0.1);
    const ErrorModel::Vector x = model.a * ErrorState(input, tracking) + model.b * 0.1;

    car.steering_rate = 0.1;
    SingleTrackCar driven(car, {.pose = state.pose,
                                .speed = speed,
                                .lateral_speed = state.lateral_speed,
                                .yaw_rate = state.yaw_rate});
    driven.Step({.steering = 1.0, .acceleration = 0.0, .gear = speed < 0.0 ? -1 : 1}, 0.1);
    // The error model assumes a steering lag of at least 1 ms, which delays wheels that turn at 0.1
    // rad/s by 1e-4 rad.
    const double wheels = 1e-4;
    EXPECT_NEAR(x[0], driven.state().pose.y, Tolerance(1e-5 + 0.01 * wheels * std::abs(speed)));
    EXPECT_NEAR(x[1], driven.state().pose.yaw, Tolerance(1e-5 + 0.2 * wheels));
    EXPECT_NEAR(x[2], driven.state().steering, Tolerance(1e-12));
    EXPECT_NEAR(x[4], driven.state().lateral_speed, Tolerance(1e-5 + 10.0 * wheels));
    EXPECT_NEAR(x[5], driven.state().yaw_rate, Tolerance(1e-5 + 5.0 * wheels));
  }
}

TEST(Regulator, SolvesTheRiccatiEquationAndIsStable) {
  for (const VehicleParams& car : Cars()) {
    for (const double speed : {0.0, 1.0, 3.0, 10.0, 20.0, 40.0, -3.0, -10.0}) {
      for (const double period : {0.005, 0.02, 0.1, 0.5}) {
        SCOPED_TRACE(fmt::format("{} m/s, {} s", speed, period));
        const Situation situation(car, speed, 0.0);
        const ControlInput input = situation.input();
        const ErrorModel model = MakeErrorModel(input, ProjectOntoPath(input), period);
        const ErrorWeights weights{.cross_track = 2.0, .heading = 0.5, .steering_rate = 3.0};
        const Regulator regulator = SolveRegulator(model, weights);
        const Eigen::MatrixXd a = model.a;
        const Eigen::VectorXd b = model.b;
        const Eigen::MatrixXd p = regulator.cost;
        const Eigen::MatrixXd q = Eigen::VectorXd(StateCost(model, weights)).asDiagonal();
        const Eigen::MatrixXd residual =
            a.transpose() * p * a -
            a.transpose() * p * b * b.transpose() * p * a / (3.0 + b.dot(p * b)) + q - p;
        EXPECT_LT(residual.norm(), Tolerance(1e-9) * p.norm());
        const Eigen::MatrixXd closed = a - b * Eigen::RowVectorXd(regulator.gain);
        EXPECT_LT(closed.eigenvalues().cwiseAbs().maxCoeff(), 1.0);
      }
    }
  }
}

TEST(Regulator, CostsWhatItSays) {
  // The sum of the costs over the whole run equals x^T P x.
  const Situation situation(ReferenceCarWithTyres(), 10.0, 0.0);
  const ControlInput input = situation.input();
  const ErrorModel model = MakeErrorModel(input, ProjectOntoPath(input), 0.05);
  const ErrorWeights weights;
  const Regulator regulator = SolveRegulator(model, weights);
  ErrorModel::Vector x = ErrorModel::Vector::Constant(6, 0.1);
  const double promised = x.dot(regulator.cost * x);
  double sum = 0.0;
  for (int k = 0; k < 2000; ++k) {
    const double w = -regulator.gain.dot(x);
    sum += x.dot(StateCost(model, weights).cwiseProduct(x)) + weights.steering_rate * w * w;
    x = (model.a * x + model.b * w).eval();
  }
  EXPECT_NEAR(sum, promised, Tolerance(1e-9) * promised);
}

TEST(Ahead, MovesTheSteadyTurnToTheCurvatureAhead) {
  const VehicleParams car = ReferenceCarWithTyres();
  const Reference reference{Path({}, {{10.0, 0.0, 1}, {50.0, 0.02, 1}}), {}};
  const SteeringSchedule schedule;
  VehicleState state;
  state.speed = 10.0;
  const ControlInput input{.vehicle = car,
                           .reference = reference,
                           .schedule = schedule,
                           .state = state,
                           .station = 0.0,
                           .period = 0.1};
  const Tracking tracking = ProjectOntoPath(input);
  const ErrorModel model = MakeErrorModel(input, tracking, 0.1);
  Ahead ahead(input, tracking, model);
  // At 1 m per step, the tenth step ends on the arc.
  for (int k = 0; k < 9; ++k) {
    EXPECT_EQ(ahead.Next().norm(), 0.0);
  }
  const ErrorModel::Vector jump = ahead.Next();
  EXPECT_NEAR(jump[2], -SteadyTurnOn(car, 0.02, 10.0).steering, Tolerance(1e-12));
  EXPECT_LT(ahead.Next().norm(), Tolerance(1e-11));
}

/// The reference car with axles and friction: center of gravity 0.5 m high, brake balance 70 to 30,
/// front-wheel drive.
VehicleParams CarWithAxles() {
  VehicleParams car = ReferenceCarWithTyres();
  car.friction_lateral = 0.9;
  const double front = car.cg_to_rear / car.wheelbase;
  const double transfer = 0.5 / car.wheelbase;
  car.braking.axles = {{.weight = front, .force = 0.7, .transfer = transfer},
                       {.weight = 1.0 - front, .force = 0.3, .transfer = -transfer}};
  car.driving.axles = {{.weight = front, .force = 1.0, .transfer = -transfer},
                       {.weight = 1.0 - front, .force = 0.0, .transfer = transfer}};
  return car;
}

/// Largest real part of the eigenvalues of the lateral dynamics (lateral speed and yaw rate) at a
/// speed [1/s]; above 0 the car spins.
double FastestGrowth(const VehicleParams& car, const AxleStiffness& stiffness, double speed) {
  // A dynamic matrix shares its compiled eigenvalues with the other tests.
  const Eigen::MatrixXd rates = LateralRates(car, stiffness, speed).leftCols<2>();
  return rates.eigenvalues().real().maxCoeff();
}

TEST(OperateOn, IsTheLinearCarWhereTyresCarryLittle) {
  const VehicleParams car = CarWithAxles();
  const Motion straight{.speed = 20.0};
  const TurnOperation brush = OperateOn(car, TyreForces::kBrush, straight);
  EXPECT_NEAR(brush.stiffness.front, car.cornering_stiffness_front, Tolerance(1e-9));
  EXPECT_NEAR(brush.stiffness.rear, car.cornering_stiffness_rear, Tolerance(1e-9));
  EXPECT_EQ(brush.turn.steering, 0.0);
  // To first order, the slip angle of a brush tyre exceeds that of a linear tyre by the fraction q
  // = C alpha/(3 mu F_z). The lateral acceleration is 0.04 m/s^2 and the friction limit 8.8 m/s^2,
  // so q = 0.04/(3 * 8.8) < 0.002.
  const Motion gentle{.curvature = 1e-4, .speed = 20.0};
  const SteadyTurn expected = SteadyTurnOn(car, gentle.curvature, gentle.speed);
  const SteadyTurn turn = OperateOn(car, TyreForces::kBrush, gentle).turn;
  EXPECT_NEAR(turn.heading_error, expected.heading_error,
              Tolerance(0.002) * std::abs(expected.heading_error));
  EXPECT_EQ(turn.yaw_rate, expected.yaw_rate);
}

TEST(OperateOn, MovesTheLoadWhenTheCarBrakes) {
  const VehicleParams car = CarWithAxles();
  const Motion braking{.speed = 45.0, .acceleration = -6.5};
  const AxleStiffness stiffness = OperateOn(car, TyreForces::kBrush, braking).stiffness;
  // Braking with a = 6.5 m/s^2 multiplies the load of the rear axle by 1 - h a/(g l_f). `use` is
  // the axle's braking force divided by its friction force. The cornering stiffness is C times the
  // load factor times 1 - q + q^2/3.
  const double load = 1.0 - 0.5 * 6.5 / (kGravity * car.cg_to_front());
  const double weight = car.mass * kGravity * car.cg_to_front() / car.wheelbase;
  const double use = 0.3 * car.mass * 6.5 / (0.9 * load * weight);
  const double q = 1.0 - std::cbrt(1.0 - use);
  const double rear = car.cornering_stiffness_rear * load * (1.0 - q + q * q / 3.0);
  EXPECT_NEAR(stiffness.rear, rear, Tolerance(1e-9) * rear);
  // An understeering car becomes unstable if it brakes while turning.
  const Motion turning{.curvature = -0.0016, .speed = 45.0, .acceleration = -6.5};
  const AxleStiffness both = OperateOn(car, TyreForces::kBrush, turning).stiffness;
  const AxleStiffness coasting{car.cornering_stiffness_front, car.cornering_stiffness_rear};
  EXPECT_LT(FastestGrowth(car, coasting, 45.0), 0.0);
  EXPECT_GT(FastestGrowth(car, both, 45.0), 0.5);
  // When a reversing car brakes, the load moves to its rear axle, which leads.
  const Motion backward{.speed = -5.0, .acceleration = -6.5};
  EXPECT_GT(OperateOn(car, TyreForces::kBrush, backward).stiffness.rear, rear);
}

TEST(Ahead, TurnsAtThePlannedSpeed) {
  const VehicleParams car = CarWithAxles();
  // The speed falls from 30 m/s to 10 m/s at the beginning of the arc.
  const Reference reference{Path({}, {{100.0, 0.0, 1}, {100.0, 0.05, 1}}),
                            SpeedProfile({{0.0, 30.0}, {100.0, 10.0}, {200.0, 10.0}})};
  const SteeringSchedule schedule;
  VehicleState state;
  state.speed = 30.0;
  const ControlInput input{.vehicle = car,
                           .reference = reference,
                           .schedule = schedule,
                           .state = state,
                           .station = 0.0,
                           .period = 0.1};
  const Tracking tracking = ProjectOntoPath(input);
  for (const TyreForces tyres : {TyreForces::kNone, TyreForces::kLinear, TyreForces::kBrush}) {
    const ErrorModel model = MakeErrorModel(input, tracking, 0.1, tyres);
    Ahead ahead(input, tracking, model);
    // At a mean speed of 20 m/s, the car reaches the arc after 5 s. The straight adds no input to
    // earlier steps.
    for (int k = 0; k < 49; ++k) {
      EXPECT_EQ(ahead.Next().norm(), 0.0) << k;
    }
    // The step that ends at the joint, up to rounding, or the next one reaches the arc.
    const double before = ahead.Next().norm();
    EXPECT_GT(std::max(before, ahead.Next().norm()), 0.0);
    const SteadyTurn turn = OperateOn(car, tyres, {.curvature = 0.05, .speed = 10.0}).turn;
    EXPECT_NEAR(ahead.steady()[2], turn.steering, Tolerance(1e-12));
    // With constant curvature and speed the input is zero.
    EXPECT_LT(ahead.Next().norm(), Tolerance(1e-11));
    EXPECT_NEAR(DistanceAhead(input, 0.1, 50), 100.0, Tolerance(1e-9));
  }
}

TEST(Ahead, StartsFromRestAndStopsAtACusp) {
  // The curvature of the path is c s, so the steady steering tells the station. The car drives off
  // with 1 m/s^2, and brakes before the cusp at 8 m with 1 m/s^2. The wheels turn at the cusp.
  const VehicleParams car = ReferenceCar();
  const double c = 0.01;
  const Reference reference{Path({}, {{8.0, 0.0, 1, c}, {8.0, -0.1, -1}}),
                            SpeedProfile({{0.0, 0.0}, {4.0, std::sqrt(8.0)}, {8.0, 0.0}})};
  const SteeringSchedule schedule;
  const VehicleState state;
  const double period = 0.1;
  const ControlInput input{.vehicle = car,
                           .reference = reference,
                           .schedule = schedule,
                           .state = state,
                           .station = 0.0,
                           .period = period};
  const Tracking tracking = ProjectOntoPath(input);
  const ErrorModel model = MakeErrorModel(input, tracking, period);
  Ahead ahead(input, tracking, model);
  for (int k = 1; k <= 28; ++k) {
    ahead.Next();
    // The least speed of the model does not matter for the steering of a car without slip.
    const double station = 0.5 * k * k * period * period;
    EXPECT_NEAR(std::tan(ahead.steady()[2]), car.wheelbase * c * station, Tolerance(1e-12));
  }
  for (int k = 0; k < 100; ++k) {
    ahead.Next();
  }
  // A step ends at most one period's way of the slowest speed before the cusp: less than 1 mm.
  EXPECT_NEAR(std::tan(ahead.steady()[2]), car.wheelbase * c * 8.0, Tolerance(1e-3));
  EXPECT_EQ(ahead.Next().norm(), 0.0);
}

TEST(ErrorModel, TheModelOfEachStepStaysInTheTurnAtAChangingSpeed) {
  // On a circle, the steady turn of each step is a fixed point of the model of its speed:
  // x_0 = a x_0 + d kappa + c (tan(delta_0) - delta_0). The model of the present speed has other
  // fixed points.
  const VehicleParams car = ReferenceCarWithTyres();
  const Reference reference{Path({}, {{200.0, 0.02, 1}}),
                            SpeedProfile({{0.0, 15.0}, {100.0, 5.0}, {200.0, 5.0}})};
  const SteeringSchedule schedule;
  VehicleState state;
  state.speed = 15.0;
  const ControlInput input{.vehicle = car,
                           .reference = reference,
                           .schedule = schedule,
                           .state = state,
                           .station = 0.0,
                           .period = 0.1};
  const Tracking tracking = ProjectOntoPath(input);
  const ErrorModel present = MakeErrorModel(input, tracking, 0.1);
  Ahead ahead(input, tracking, present);
  for (int k = 0; k < 40; ++k) {
    SCOPED_TRACE(k);
    const ErrorModel model = MakeErrorModelFor(car, ahead.Now(), 0.1, TyreForces::kLinear);
    EXPECT_EQ(model.speed, ahead.Now().speed);
    const ErrorModel::Vector turn = ahead.steady();
    const ErrorModel::Vector after =
        model.a * turn + model.d * 0.02 + model.c * (std::tan(turn[2]) - turn[2]);
    // As in StaysInASteadyTurn.
    EXPECT_LT((after - turn).norm(), Tolerance(1e-11));
    ahead.Next(model);
  }
  // The car has braked by 1 m/s^2 for 4 s.
  EXPECT_NEAR(ahead.Now().speed, 11.0, Tolerance(1e-9));
}

}  // namespace
}  // namespace trackbed
