#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

#include "tests/sim/cars.h"
#include "tests/tolerance.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/sim/car_parameters.h"
#include "trackbed/sim/trailer_scene.h"
#include "trackbed/sim/world_scene.h"

// Tests trailers in the plants: statics, rolling at low speed against the kinematic trailer, and
// snaking against the eigenvalues of the linear car-trailer model.
namespace trackbed {
namespace trailer_plant_test {

constexpr double kGravity = 9.81;  // [m/s^2]

CarModel Towing(const TrailerOptions& options, const std::string& name = "prius",
                const Numerics& numerics = {}, const World& world = {}) {
  const CarModel bare = CarWith(name, numerics);
  CarModel towing(WithTrailer(bare, MakeTrailer(options, bare.params())), name);
  return IsFlat(world.ground) && !HasObstacles(world)
             ? std::move(towing)
             : CarModel(WithWorld(towing.scene(), towing.params(), world), name);
}

/// Runs a plant with a constant command for `duration` [s].
void DriveFor(const CarModel& car, Plant& plant, double duration, const Command& command) {
  Drive(
      car, plant, duration, [&](double, const VehicleState&) { return command; },
      [](double, const VehicleState&) {});
}

TEST(TrailerModel, LeavesTheParametersOfTheCar) {
  const CarModel bare = CarWith("prius", {});
  const CarModel towing = Towing({});
  // The sums over the bodies round differently from MuJoCo's.
  EXPECT_NEAR(towing.params().mass, bare.params().mass, Tolerance(1e-9));
  EXPECT_NEAR(towing.params().cg_to_rear, bare.params().cg_to_rear, Tolerance(1e-12));
  EXPECT_NEAR(towing.params().yaw_inertia, bare.params().yaw_inertia, Tolerance(1e-8));
  EXPECT_NEAR(towing.chassis().cg_height, bare.chassis().cg_height, Tolerance(1e-12));
  EXPECT_EQ(towing.params().length, bare.params().length);
  EXPECT_FALSE(bare.trailer().has_value());
}

// The bodies of the trailer have together the given mass, center of gravity and yaw inertia.
TEST(TrailerModel, HasTheGivenMassProperties) {
  const CarModel car = Towing({.mass = 700.0, .yaw_inertia = 900.0, .cg_ahead = 0.2});
  const TrailerParams& params = car.trailer()->params;
  const mjModel& model = *car.get();
  const MujocoData data = MakeMujocoData(model);
  mj_forward(&model, data.get());
  const int body = car.trailer()->body;
  EXPECT_NEAR(model.body_subtreemass[body], 700.0, Tolerance(1e-9));
  const mjtNum* cg = data->subtree_com + 3 * body;
  EXPECT_NEAR(cg[0], -params.hitch - params.tongue + 0.2, Tolerance(1e-9));
  EXPECT_NEAR(cg[2], params.cg_height, Tolerance(1e-9));
  double yaw = 0.0;
  for (int i = body; i < model.nbody; ++i) {
    int root = i;
    while (root > 0 && root != body) {
      root = model.body_parentid[root];
    }
    if (root == body) {
      const mjtNum* at = data->xipos + 3 * i;
      double own = 0.0;
      for (int axis = 0; axis < 3; ++axis) {
        const double along = data->ximat[9 * i + 6 + axis];
        own += along * along * model.body_inertia[3 * i + axis];
      }
      yaw += own + model.body_mass[i] * (std::pow(at[0] - cg[0], 2) + std::pow(at[1] - cg[1], 2));
    }
  }
  EXPECT_NEAR(yaw, 900.0, Tolerance(1e-8));
}

TEST(TrailerModel, IsReadBackFromItsScene) {
  const CarModel car = Towing({.tongue = 3.3, .mass = 412.5});
  EXPECT_EQ(car.trailer()->params.tongue, 3.3);
  EXPECT_EQ(car.trailer()->params.mass, 412.5);
  EXPECT_THAT(car.configuration_columns(),
              testing::IsSupersetOf({"hitch_yaw_rad", "hitch_pitch_rad", "hitch_roll_rad"}));
}

TEST(TrailerModel, RefusesASecondTrailerAndVehiclesWithoutSteering) {
  const CarModel car = Towing({});
  EXPECT_THROW(WithTrailer(car, car.trailer()->params), InputError);
  const CarModel robot(ComposeScene(FindModel("diff_drive", ""), {}), "diff_drive");
  EXPECT_THROW(WithTrailer(robot, car.trailer()->params), InputError);
  EXPECT_THROW(Towing({.yaw_inertia = 20.0}), InputError);
}

TEST(TrailerPlant, IsRefusedInSingleTrack) {
  const CarModel car = Towing({});
  const World world;
  EXPECT_THROW(MakePlant("single_track", {.car = car, .world = world}), InputError);
}

class TrailerTyres : public testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(Laws, TrailerTyres,
                         testing::Values("mujoco:contact", "mujoco:magic_formula"),
                         [](const auto& law) {
                           return std::string(law.param).ends_with("contact") ? "contact"
                                                                              : "magic_formula";
                         });

// At rest, the nose load F = m_t g c/l at the hitch adds F (L + b)/L to the rear axle and takes
// F b/L off the front axle.
TEST_P(TrailerTyres, LoadTheCarWithTheNose) {
  const CarModel car = Towing({.mass = 600.0, .cg_ahead = 0.3});
  const World world;
  const auto plant = MakePlant(GetParam(), {.car = car, .world = world});
  DriveFor(car, *plant, 1.0, {});
  const TrailerParams& trailer = car.trailer()->params;
  const VehicleParams& params = car.params();
  const double nose = 600.0 * kGravity * 0.3 / trailer.tongue;
  const VehicleState state = plant->Observe();
  const auto axle = [&](std::size_t left) {
    return (*state.wheels)[left].normal_force + (*state.wheels)[left + 1].normal_force;
  };
  const double weight = params.mass * kGravity;
  // The car does not sag, so only the rest of its settling moves the load, below 1 N of 7 kN.
  EXPECT_NEAR(
      axle(0),
      weight * params.cg_to_rear / params.wheelbase - nose * trailer.hitch / params.wheelbase,
      Tolerance(2.0));
  EXPECT_NEAR(axle(2),
              weight * params.cg_to_front() / params.wheelbase +
                  nose * (1.0 + trailer.hitch / params.wheelbase),
              Tolerance(2.0));
  EXPECT_NEAR(state.pose.x, 0.0, Tolerance(1e-3));
  EXPECT_NEAR(plant->trailer()->angle, 0.0, Tolerance(1e-6));
  EXPECT_NEAR(state.pitch, 0.0, Tolerance(1e-4));
}

// The commanded acceleration is that of car and trailer together.
TEST_P(TrailerTyres, FollowTheCommandedAcceleration) {
  const CarModel car = Towing({.mass = 600.0});
  const World world;
  for (const double acceleration : {1.0, -2.0}) {
    const auto plant =
        MakePlant(GetParam(), {.car = car, .world = world, .start = {.speed = 10.0}});
    DriveFor(car, *plant, 1.0, {.acceleration = acceleration});
    const double before = plant->Observe().speed;
    DriveFor(car, *plant, 1.0, {.acceleration = acceleration});
    // as for a car without a trailer, the grip of the tyres and the motion of the body leave 2 %
    EXPECT_NEAR(plant->Observe().speed - before, acceleration, Tolerance(0.02)) << acceleration;
  }
}

// At walking pace the tyres hardly slip: at 0.3 m/s^2 their slip angles are below 2 mrad, which
// turn the trailer by as much.
TEST_P(TrailerTyres, RollLikeTheKinematicTrailerAtLowSpeed) {
  const CarModel car = Towing({});
  const World world;
  const StartState start{.speed = 2.0, .steering = 0.2};
  const auto plant = MakePlant(GetParam(), {.car = car, .world = world, .start = start});
  const auto kinematic = MakePlant("kinematic", {.car = car, .world = world, .start = start});
  for (int i = 0; i < 5; ++i) {
    DriveFor(car, *plant, 1.0, {.steering = 0.2});
    DriveFor(car, *kinematic, 1.0, {.steering = 0.2});
    EXPECT_NEAR(plant->trailer()->angle, kinematic->trailer()->angle, Tolerance(0.006)) << i;
    EXPECT_LT(plant->trailer()->angle, 0.0);
  }
  EXPECT_NEAR(plant->trailer()->rate, 0.0, Tolerance(0.01));
}

// In reverse, the angle of the kinematic trailer grows by exp(s/l) (trailer_test.cpp). Slip of the
// tyres changes the growth by a few percent.
TEST_P(TrailerTyres, FoldUpInReverse) {
  const CarModel car = Towing({});
  const World world;
  const auto plant = MakePlant(
      GetParam(), {.car = car, .world = world, .start = {.speed = -1.0, .hitch_angle = 0.05}});
  const auto kinematic = MakePlant(
      "kinematic", {.car = car, .world = world, .start = {.speed = -1.0, .hitch_angle = 0.05}});
  DriveFor(car, *plant, 5.0, {.gear = -1});
  DriveFor(car, *kinematic, 5.0, {.gear = -1});
  EXPECT_GT(kinematic->trailer()->angle, 0.3);
  EXPECT_NEAR(plant->trailer()->angle / kinematic->trailer()->angle, 1.0, Tolerance(0.06));
}

TEST_P(TrailerTyres, ClimbBumpsAndGrades) {
  World world;
  world.ground.grade = {0.08, 0.0};
  world.ground.bumps.push_back({.area = {{15.0, 0.0, 0.0}, 4.0, 6.0}, .height = 0.15});
  const CarModel car = Towing({}, "prius", {}, world);
  const auto plant = MakePlant(GetParam(), {.car = car, .world = world, .start = {.speed = 5.0}});
  double highest = 0.0;
  Drive(
      car, *plant, 5.0, [](double, const VehicleState&) { return Command{}; },
      [&](double, const VehicleState&) {
        highest = std::max(highest, std::abs(plant->trailer()->lean));
      });
  EXPECT_FALSE(plant->diverged());
  // The brakes and the motor hold the speed against the weight of car and trailer on the grade.
  EXPECT_NEAR(plant->Observe().speed, 5.0, Tolerance(0.3));
  EXPECT_LT(highest, 0.4);
  EXPECT_GT(highest, std::atan(0.08));
}

/// The linear single-track model of a car with a trailer at constant speed. States: lateral speed
/// of the car's center of gravity, yaw rate, hitch angle, its rate, and the forces of front, rear
/// and trailer axle, which follow their slip over the relaxation length.
Eigen::MatrixXd LinearModel(const CarModel& car, double v) {
  const VehicleParams& p = car.params();
  const TrailerParams& t = car.trailer()->params;
  const CarTyres& tyres = *car.parts().tyres;
  const double wheelbase = p.wheelbase;
  const double nose = t.mass * kGravity * t.nose_share();
  const double weight = p.mass * kGravity;
  const auto stiffness = [](const MagicFormula& tyre, double axle) {
    return 2.0 * CorneringStiffness(tyre, 0.5 * axle);
  };
  const double front =
      stiffness(tyres.axle[0], weight * p.cg_to_rear / wheelbase - nose * t.hitch / wheelbase);
  const double rear = stiffness(
      tyres.axle[1], weight * p.cg_to_front() / wheelbase + nose * (1.0 + t.hitch / wheelbase));
  const double towed = stiffness(tyres.axle[1], t.mass * kGravity - nose);
  const double a = p.cg_to_front();
  const double b = p.cg_to_rear;
  const double d = b + t.hitch;            // hitch behind the car's center of gravity
  const double e = t.tongue - t.cg_ahead;  // trailer's center of gravity behind the hitch
  const double sigma_f = tyres.axle[0].relaxation_length;
  const double sigma_r = tyres.axle[1].relaxation_length;
  // Unknown accelerations (v_y', r', theta''), and the hitch force F on the car:
  //   m (v_y' + v r) = F_f + F_r + F
  //   I r' = a F_f - b F_r - d F
  //   m_t (v_y' + v r - d r' - e (r' + theta'')) = F_t - F
  //   I_t (r' + theta'') = -e F - c F_t,  with c the distance from the center of gravity to the
  //   axle
  Eigen::Matrix4d mass = Eigen::Matrix4d::Zero();
  mass << p.mass, 0.0, 0.0, -1.0,                   //
      0.0, p.yaw_inertia, 0.0, d,                   //
      t.mass, -t.mass * (d + e), -t.mass * e, 1.0,  //
      0.0, t.yaw_inertia, t.yaw_inertia, e;
  // columns: v_y, r, theta, theta', F_f, F_r, F_t
  Eigen::Matrix<double, 4, 7> right = Eigen::Matrix<double, 4, 7>::Zero();
  right(0, 1) = -p.mass * v;
  right(0, 4) = right(0, 5) = 1.0;
  right(1, 4) = a;
  right(1, 5) = -b;
  right(2, 1) = -t.mass * v;
  right(2, 6) = 1.0;
  right(3, 6) = -t.cg_ahead;
  const Eigen::Matrix<double, 4, 7> solved = mass.inverse() * right;
  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(7, 7);
  system.row(0) = solved.row(0);
  system.row(1) = solved.row(1);
  system(2, 3) = 1.0;
  system.row(3) = solved.row(2);
  // sigma F'/v + F = -C alpha
  const auto tyre = [&](int row, double c, double sigma, const std::array<double, 4>& slip) {
    for (int i = 0; i < 4; ++i) {
      system(row, i) = -c / sigma * slip[static_cast<std::size_t>(i)];
    }
    system(row, row) = -v / sigma;
  };
  tyre(4, front, sigma_f, {1.0, a, 0.0, 0.0});
  tyre(5, rear, sigma_r, {1.0, -b, 0.0, 0.0});
  tyre(6, towed, sigma_r, {1.0, -d - t.tongue, -v, -t.tongue});
  return system;
}

/// The least damped oscillation of the linear model: real part [1/s] and angular frequency [rad/s].
std::complex<double> Snaking(const CarModel& car, double v) {
  const Eigen::VectorXcd values = LinearModel(car, v).eigenvalues();
  std::complex<double> least(-1e9, 0.0);
  for (const std::complex<double>& value : values) {
    if (value.imag() > 0.5 && value.real() > least.real()) {
      least = value;
    }
  }
  return least;
}

/// The measured decay [1/s] and angular frequency [rad/s] of the hitch angle after a disturbance.
std::complex<double> Measured(const CarModel& car, double v) {
  const World world;
  const auto plant =
      MakePlant("mujoco:magic_formula", {.car = car, .world = world, .start = {.speed = v}});
  // A push to the left for 0.1 s excites the combination; the wheels stay straight.
  std::vector<double> times;   // of the extremes of the hitch angle
  std::vector<double> angles;  // the extremes [rad]
  double last_rate = 0.0;
  for (int i = 0; i < 4000; ++i) {
    if (i < 50) {
      plant->ApplyLateralForce(500.0);
    }
    plant->Step({});
    const TrailerState now = *plant->trailer();
    if (i > 700 && now.rate * last_rate < 0.0) {  // after the fast modes have decayed
      times.push_back(i * car.timestep());
      angles.push_back(now.angle);
    }
    last_rate = now.rate;
  }
  // Differences of neighboring extremes do not contain a constant deviation.
  const std::size_t n = angles.size();
  if (n < 4) {
    return {-1e9, 0.0};
  }
  const std::size_t last = std::min<std::size_t>(n - 1, 5);
  const double first_swing = std::abs(angles[1] - angles[0]);
  const double last_swing = std::abs(angles[last] - angles[last - 1]);
  const double duration = times[last] - times[1];
  return {std::log(last_swing / first_swing) / duration,
          kPi * static_cast<double>(last - 1) / duration};
}

/// A car and a trailer whose centers of gravity and hitch are near the ground, where they do not
/// roll. Camber, conicity and the air have no effect.
CarModel Planar(const TrailerOptions& options) {
  const CarModel tall = CarWith("prius", kStripped);
  const CarModel bare(WithCarParameters(tall, {{.name = "cg_height", .value = 0.05}}), "prius");
  TrailerOptions flat = options;
  flat.cg_height = 0.05;
  flat.hitch_height = 0.05;
  return CarModel(WithTrailer(bare, MakeTrailer(flat, bare.params())), "prius");
}

// The finite amplitude of 0.5 degrees, the small roll, and the timing of the extremes to one step
// of 2 ms change the frequency by 0.2 % and the damping ratio by 0.003.
TEST(Snaking, AgreesWithTheEigenvaluesOfTheLinearModel) {
  const CarModel car = Planar({.mass = 900.0, .cg_ahead = 0.0});
  double before = -1e9;
  for (const double v : {18.0, 24.0, 30.0}) {
    const std::complex<double> linear = Snaking(car, v);
    const std::complex<double> measured = Measured(car, v);
    EXPECT_NEAR(measured.imag() / linear.imag(), 1.0, Tolerance(0.005)) << v;
    EXPECT_NEAR(-measured.real() / std::abs(measured), -linear.real() / std::abs(linear),
                Tolerance(0.005))
        << v;
    EXPECT_GT(measured.real(), before);  // less damping at higher speed
    before = measured.real();
  }
}

// Near the critical speed, the damping ratio of the linear model changes by 0.0007 per 1 % of the
// speed (the tolerance of the test above is 0.005), so that 10 % decide.
TEST(Snaking, GrowsAboveTheCriticalSpeedOfTheLinearModel) {
  const CarModel car = Planar({.mass = 900.0, .cg_ahead = -0.15});
  double low = 5.0;
  double high = 60.0;
  ASSERT_LT(Snaking(car, low).real(), 0.0);
  ASSERT_GT(Snaking(car, high).real(), 0.0);
  while (high - low > 1e-3) {
    const double middle = 0.5 * (low + high);
    (Snaking(car, middle).real() < 0.0 ? low : high) = middle;
  }
  EXPECT_LT(Measured(car, 0.9 * low).real(), 0.0);
  EXPECT_GT(Measured(car, 1.1 * low).real(), 0.0);
}

// Car and trailer with high centers of gravity roll on their springs while they snake, which takes
// damping away. The linear model neglects roll.
TEST(Snaking, IsDampedLessIfTheBodiesRoll) {
  const CarModel car = Towing({.mass = 900.0, .cg_ahead = 0.0}, "prius", kStripped);
  EXPECT_GT(Measured(car, 24.0).real(), 0.6 * Snaking(car, 24.0).real());
}

}  // namespace trailer_plant_test
}  // namespace trackbed
