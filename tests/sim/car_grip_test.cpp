#include "trackbed/sim/car_grip.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <regex>
#include <string>

#include "tests/sim/cars.h"
#include "tests/tolerance.h"

/// Compares the g-g-v diagram of a car with the MuJoCo car.
namespace trackbed {
namespace car_grip_test {

constexpr double kSpeed = 25.0;  // [m/s]

/// The largest lateral acceleration by tyre forces [m/s^2], as the mean over half a second. The air
/// pushes a car that slides outwards toward the inside of its turn. This force, 1 % of the tyre
/// forces on half the friction, is not part of the g-g-v diagram. The steering angle
/// increases slowly enough for steady state until the car spins. The car holds its speed or coasts.
double MeasureLateral(const CarModel& car, double road, bool coasts) {
  World world;
  world.friction = road;
  const auto plant = MakePlant("mujoco:magic_formula", {.car = car,
                                                        .world = world,
                                                        .start = {.speed = kSpeed},
                                                        .tyre = TyreLaw::kAuto,
                                                        .steering = SteeringInput::kPrescribed});
  constexpr double kWindow = 0.5;    // [s]
  constexpr double kSpinning = 0.2;  // sideslip angle of a spinning car [rad]
  // Deceleration by air along y, per product of the speeds along x and y [1/m].
  const double air_drag =
      0.5 * kAirDensity * car.chassis().aerodynamics.side_area / car.params().mass;
  double largest = 0.0;
  double sum = 0.0;
  double until = kWindow;
  int count = 0;
  bool spins = false;
  Drive(
      car, *plant, 12.0,
      [&](double t, const VehicleState& state) {
        return Command{
            .steering = 0.02 * t, .acceleration = 2.0 * (kSpeed - state.speed), .coast = coasts};
      },
      [&](double t, const VehicleState& state) {
        spins = spins || std::abs(state.sideslip) > kSpinning;
        if (t >= until) {
          largest = spins ? largest : std::max(largest, sum / count);
          sum = 0.0;
          count = 0;
          until += kWindow;
        }
        sum += state.lateral_acceleration + air_drag * state.speed * state.lateral_speed;
        ++count;
      });
  return largest;
}

// The tolerance covers neglected effects: the cosine of the steering angle, at most 0.15 rad,
// reduces the force of the front axle by 1 %. Unsprung masses that do not roll, the toe angle, and
// remaining transients change the forces by less than 1 % each.
constexpr double kNeglected = 0.025;

TEST(CarGrip, LateralLimitIsThatOfAMujocoCarThatCoasts) {
  for (const std::string model : {"prius", "bmw320i"}) {
    const CarModel car = CarWith(model, {});
    for (const double road : {1.0, 0.5}) {
      const double predicted = ComputeGgv(car, TyreLaw::kMagicFormula, {road})
                                   .MaxLateral({.speed = kSpeed, .road = road});
      EXPECT_NEAR(MeasureLateral(car, road, true), predicted, Tolerance(kNeglected * predicted))
          << model << ", " << road;
    }
  }
}

TEST(CarGrip, LateralLimitIsThatOfAMujocoCarThatKeepsItsSpeed) {
  // The front wheels of the Prius must drive against air drag and the drag of slip angles, so the
  // inner front wheel slides. The car therefore reaches 8 % less than the diagram.
  const CarModel car = CarWith("prius", {});
  const GripModel grip = MakeGripModel(car, TyreLaw::kMagicFormula);
  const LongitudinalForces& forces = grip.forces;
  const double longitudinal =
      (forces.drag * kSpeed * kSpeed + forces.rolling_resistance) / forces.mass;
  for (const double road : {1.0, 0.5}) {
    const double predicted = MaxLateralForce(grip, road, longitudinal);
    EXPECT_NEAR(MeasureLateral(car, road, false), predicted, Tolerance(kNeglected * predicted))
        << road;
  }
}

/// The largest lateral force of a car that coasts into a tight turn, divided by the one that
/// `diagram` predicts at its speed, as the mean over half a second.
double MeasureUseInTightTurn(const CarModel& car, const GgvDiagram& diagram, double& radius) {
  const World world;
  const auto plant = MakePlant("mujoco:magic_formula", {.car = car,
                                                        .world = world,
                                                        .start = {.speed = 13.0},
                                                        .tyre = TyreLaw::kAuto,
                                                        .steering = SteeringInput::kPrescribed});
  constexpr double kWindow = 0.5;  // [s]
  double largest = 0.0;
  double sum = 0.0;
  double until = kWindow;
  int count = 0;
  Drive(
      car, *plant, 6.0,
      [](double t, const VehicleState&) {
        return Command{.steering = 0.06 * t, .acceleration = 0.0, .coast = true};
      },
      [&](double t, const VehicleState& state) {
        if (t >= until) {
          if (sum / count > largest) {
            largest = sum / count;
            radius = state.speed / state.yaw_rate;
          }
          sum = 0.0;
          count = 0;
          until += kWindow;
        }
        sum += state.lateral_acceleration / diagram.MaxLateral({.speed = state.speed});
        ++count;
      });
  return largest;
}

TEST(CarGrip, LateralLimitInTightTurnsIsThatOfAMujocoCar) {
  // At a radius below 20 m, the steered front wheels of the Prius give 7 % less lateral force than
  // straight ones.
  const CarModel car = CarWith("prius", {});
  double radius = 0.0;
  const double use =
      MeasureUseInTightTurn(car, ComputeGgv(car, TyreLaw::kMagicFormula, {1.0}), radius);
  EXPECT_NEAR(use, 1.0, Tolerance(kNeglected));
  EXPECT_LT(radius, 20.0);
  GripModel straight = MakeGripModel(car, TyreLaw::kMagicFormula);
  straight.steering_limit = 0.0;
  EXPECT_LT(MeasureUseInTightTurn(car, ComputeGgv(straight, {1.0}), radius), 1.0 - kNeglected);
}

TEST(CarGrip, RollStiffnessIsThatOfTheModelsSprings) {
  // The springs in models/prius/prius.xml have stiffnesses of 19 and 22 kN/m, the anti-roll bars of
  // 11480 and 5480 N/m.
  const CarModel car = CarWith("prius", {});
  const GripModel grip = MakeGripModel(car, TyreLaw::kMagicFormula);
  const double tyre = car.parts().tyres->vertical_stiffness;
  const std::array<double, 2> spring{19e3, 22e3};
  const std::array<double, 2> bar{11480.0, 5480.0};
  for (std::size_t i = 0; i < 2; ++i) {
    const double square = grip.axles[i].track * grip.axles[i].track;
    // With the wheel travel z and the track width t, the roll angle is 2 z/t, and the bar is
    // stretched by 2 z.
    const double springs = (0.5 * spring[i] + bar[i]) * square;
    const double tyres = 0.5 * tyre * square;
    EXPECT_NEAR(grip.axles[i].roll_stiffness, springs * tyres / (springs + tyres),
                Tolerance(1e-9 * springs));
    EXPECT_NEAR(grip.axles[i].suspension_share, tyres / (springs + tyres), Tolerance(1e-12));
  }
  // Bare contacts are rigid.
  EXPECT_EQ(MakeGripModel(car, TyreLaw::kContact).axles[0].suspension_share, 1.0);
}

// Without springs only the tyres give roll stiffness, k_z track^2/2 per axle.
TEST(CarGrip, AWheelWithoutASpringRestsOnTheStopOfItsJoint) {
  Scene scene = ComposeScene(FindModel("prius", ""), {.timestep = 0.002});
  const std::regex springs(R"re( (stiffness="[0-9.]+" damping="[0-9.]+" springref="[-0-9.]+"|)re"
                           R"re(stiffness="[0-9]+" springlength="0"))re");
  scene.xml = std::regex_replace(scene.xml, springs, "");
  const CarModel car(scene, "without springs");
  const GripModel grip = MakeGripModel(car, TyreLaw::kMagicFormula);
  for (std::size_t i = 0; i < 2; ++i) {
    const double track = i == 0 ? car.params().track_front : car.params().track_rear;
    const double tyres = 0.5 * car.parts().tyres->vertical_stiffness * track * track;
    EXPECT_NEAR(grip.axles[i].roll_stiffness, tyres, Tolerance(1e-12 * tyres));  // rounding
    EXPECT_EQ(grip.axles[i].suspension_share, 0.0);
  }
  EXPECT_NO_THROW(ComputeGgv(car, TyreLaw::kMagicFormula, {1.0}));
}

TEST(CarGrip, ForcesAreThoseOfTheParameters) {
  const CarModel car = CarWith("bmw320i", {});
  const LongitudinalForces forces = MakeGripModel(car, TyreLaw::kAuto).forces;
  const VehicleParams& params = car.params();
  EXPECT_EQ(forces.mass, params.mass);
  EXPECT_EQ(forces.drive_power, car.parts().drive_power);
  EXPECT_GT(forces.rolling_mass, params.mass);
  EXPECT_LT(forces.rolling_mass, 1.1 * params.mass);
  // At the top speed of the diagram, the force of the motor equals drag and rolling resistance.
  const GgvDiagram diagram = ComputeGgv(car, TyreLaw::kAuto, {1.0});
  EXPECT_NEAR(diagram.AccelerationsAt({.speed = params.top_speed}).largest, 0.0, Tolerance(1e-6));
  // The diagram is that of the Magic Formula alone, which has more grip than the bare contacts. At
  // rest, the diagram therefore has at least the acceleration of VehicleParams.
  EXPECT_GE(diagram.AccelerationsAt({}).largest, params.max_acceleration - 1e-3);
  // The braking limit of the diagram is that of the brakes: no command brakes harder.
  EXPECT_NEAR(diagram.TyresAt({}).braking, -params.max_deceleration, Tolerance(1e-3));
}

TEST(CarGrip, OfADifferentialDriveIsItsFriction) {
  const CarModel car = CarWith("diff_drive", {});
  const GgvDiagram diagram = ComputeGgv(car, TyreLaw::kAuto, {1.0});
  EXPECT_NEAR(diagram.MaxLateral({}), MaxLateralAcceleration(car.params(), 1.0), Tolerance(1e-12));
}

}  // namespace car_grip_test
}  // namespace trackbed
