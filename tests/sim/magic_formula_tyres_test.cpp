#include "src/sim/magic_formula_tyres.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/sim/cars.h"
#include "tests/support/case_names.h"
#include "tests/tolerance.h"
#include "trackbed/core/error.h"

// Tests MuJoCo cars on Magic Formula tyres: understeer gradient, load transfer and stopping
// distance against closed forms, and damping, symmetry and energy of the motion.
namespace trackbed {
namespace {

constexpr double kGravity = 9.81;
constexpr auto kNoLook = [](double, const VehicleState&) {};

std::unique_ptr<Plant> On(const CarModel& car, const World& world, const StartState& start,
                          SteeringInput steering = SteeringInput::kPrescribed) {
  return MakePlant("mujoco:magic_formula",
                   {.car = car, .world = world, .start = start, .steering = steering});
}

Command HoldSpeed(double speed, double steering, const VehicleState& state) {
  return {.steering = steering, .acceleration = 4.0 * (speed - state.speed)};
}

/// Steering angle that rises over half a second and is then held.
double StepSteer(double t, double steering) {
  return steering * std::clamp((t - 0.5) / 0.5, 0.0, 1.0);
}

TEST(MagicFormulaTyres, NeedCoefficients) {
  Scene scene = ComposeScene(FindModel("prius", ""), {});
  scene.xml = std::regex_replace(scene.xml, std::regex("<numeric name=\"[pr]_[^>]*/>"), "");
  const CarModel bare(scene, "bare");
  const World world;
  EXPECT_NO_THROW(MakePlant("mujoco:contact", {.car = bare, .world = world}));
  try {
    On(bare, world, {});
    FAIL() << "a car without tyres was driven";
  } catch (const InputError& error) {
    EXPECT_THAT(error.problems().front().message,
                testing::HasSubstr("the model prius has no tyre coefficients"));
  }
}

TEST(MagicFormulaTyres, CoefficientsAreCheckedAllAtOnce) {
  try {
    CarWith("prius", {{"p_cx1", 0.0}, {"p_ky1_front", 12.0}, {"p_kz1", 1.0}, {"F_z0", 0.0}});
    FAIL() << "accepted";
  } catch (const InputError& error) {
    std::string all;
    for (const Problem& problem : error.problems()) {
      all += problem.key + ": " + problem.message + "\n";
    }
    EXPECT_THAT(all, testing::HasSubstr("p_kz1: unknown tyre coefficient 'p_kz1'; did you mean"));
    EXPECT_THAT(all, testing::HasSubstr("p_cx1 (front): must be above 0, found 0"));
    EXPECT_THAT(all, testing::HasSubstr("p_ky1 (front): must be below 0"));
    EXPECT_THAT(all, testing::HasSubstr("F_z0 (rear): must be above 0: p_ky2, p_dx2 and p_dy2"));
  }
}

/// Linear tyres with these stiffnesses per load, front and rear.
struct Axles {
  double front;
  double rear;
};

void PrintTo(const Axles& axles, std::ostream* out) {
  *out << "front " << axles.front << " rear " << axles.rear;
}

class Understeer : public testing::TestWithParam<Axles> {
 protected:
  /// Understeer gradient (delta - L/R)/a_y at 20 m/s and about 0.8 m/s^2 [rad/(m/s^2)].
  static double Gradient(const Axles& axles) {
    Numerics numerics = kStripped;
    numerics["p_ky1_front"] = -axles.front;
    numerics["p_ky1_rear"] = -axles.rear;
    const CarModel car = CarWith("bmw320i", numerics);
    const World world;
    const auto plant = On(car, world, {.speed = 20.0});
    const double steering = 0.005;
    const VehicleState state = Drive(
        car, *plant, 8.0,
        [&](double t, const VehicleState& s) { return HoldSpeed(20.0, StepSteer(t, steering), s); },
        kNoLook);
    const double acceleration = state.speed * state.yaw_rate;
    EXPECT_LT(std::abs(acceleration), 1.0);
    return (steering - car.params().wheelbase * state.yaw_rate / state.speed) / acceleration;
  }
};

INSTANTIATE_TEST_SUITE_P(Pairs, Understeer,
                         testing::Values(Axles{12.0, 20.0}, Axles{10.0, 14.0}, Axles{15.0, 25.0}),
                         kNamedByParameter);

TEST_P(Understeer, GradientIsThatOfTheAxles) {
  // The understeer gradient is K = (W_f/C_f - W_r/C_r)/g, with the loads W and the cornering
  // stiffnesses C of the axles. Here, each stiffness C is a factor c times the load.
  const double expected = (1.0 / GetParam().front - 1.0 / GetParam().rear) / kGravity;
  ASSERT_GE(expected, 0.001);
  EXPECT_NEAR(Gradient(GetParam()) / expected, 1.0, Tolerance(0.05));  // small-angle approximation
}

TEST(MagicFormulaTyres, EqualTyresMakeANeutralCar) {
  struct Access : Understeer {
    using Understeer::Gradient;
    void TestBody() override {}
  };
  EXPECT_LE(std::abs(Access::Gradient({18.0, 18.0})), Tolerance(5e-5));
}

TEST(MagicFormulaTyres, LoadTransferAndRollAreThoseOfStatics) {
  const CarModel car = CarWith("bmw320i", kStripped);
  const World world;
  const auto plant = On(car, world, {.speed = 15.0});
  const VehicleState state = Drive(
      car, *plant, 8.0,
      [](double t, const VehicleState& s) { return HoldSpeed(15.0, StepSteer(t, 0.03), s); },
      kNoLook);
  const VehicleParams& params = car.params();
  // The spinning wheels change their angular momentum in the turn, which also rolls the car
  // outward.
  double spin = 0.0;  // [kg m^2/s]
  for (const double inertia : car.parts().spin_inertia) {
    spin += inertia * state.speed / params.wheel_radius;
  }
  const double moment = params.mass * car.parts().cg_height *
                            (state.lateral_acceleration + kGravity * std::sin(state.roll)) +
                        spin * state.yaw_rate;  // about the ground
  double carried = 0.0;
  for (std::size_t w = 0; w < 4; ++w) {
    const double arm = 0.5 * (w < 2 ? params.track_front : params.track_rear);
    carried += (w % 2 == 0 ? -1.0 : 1.0) * arm * (*state.wheels)[w].normal_force;
  }
  EXPECT_NEAR(carried / moment, 1.0, Tolerance(0.05));
  // The roll stiffness of the springs and bars in the car's file is in series with that of the
  // tyres. The roll centers are on the ground.
  const double track_f = params.track_front * params.track_front;
  const double track_r = params.track_rear * params.track_rear;
  const double springs =
      (0.5 * 24453.1 + 3595.273) * track_f + (0.5 * 19635.5 + 1420.953) * track_r;
  const double tyres = 0.5 * 158294.0 * (track_f + track_r);
  const double roll = moment * (1.0 / springs + 1.0 / tyres);
  EXPECT_NEAR(state.roll / roll, 1.0, Tolerance(0.05));
}

TEST(MagicFormulaTyres, BrakingDistanceIsThatOfTheDeceleration) {
  for (const char* name : {"bmw320i", "prius"}) {
    const CarModel car = CarWith(name, {});
    const World world;
    const auto plant = On(car, world, {.speed = 20.0});
    const VehicleState state = Drive(
        car, *plant, 6.0, [](double, const VehicleState&) { return Command{.acceleration = -5.0}; },
        kNoLook);
    EXPECT_NEAR(state.speed, 0.0, 0.01) << name;
    EXPECT_NEAR(state.pose.x / (0.5 * 20.0 * 20.0 / 5.0), 1.0, Tolerance(0.05)) << name;
  }
}

TEST(MagicFormulaTyres, LockedWheelsSlideAsTheLawSays) {
  Numerics numerics = kStripped;
  numerics["brake_torque_front"] = 6000.0;
  numerics["brake_torque_rear"] = 6000.0;
  const CarModel car = CarWith("bmw320i", numerics);
  const World world;
  const auto plant = On(car, world, {.speed = 20.0});
  double slip = 0.0;
  const VehicleState state = Drive(
      car, *plant, 6.0, [](double, const VehicleState&) { return Command{.acceleration = -30.0}; },
      [&](double t, const VehicleState& s) {
        slip = t > 0.5 && t < 1.5 ? std::max(slip, (*s.wheels)[0].slip_ratio + 1.0) : slip;
      });
  EXPECT_LE(slip, 5e-3);  // locked, apart from the compliance of the brakes
  const double sliding =
      -EvaluateTyreForce(car.parts().tyres->axle[0], 1.0, 1.0, {.ratio = -1.0}).longitudinal;
  const double distance = 0.5 * 20.0 * 20.0 / (sliding * kGravity);
  EXPECT_NEAR(state.pose.x / distance, 1.0, Tolerance(0.05));
}

TEST(MagicFormulaTyres, ParkedCarsStayWhereTheyAre) {
  const auto park = [](Plant& plant, double duration) {
    for (int i = 0; i < 500.0 * duration; ++i) {
      plant.Step({});
    }
    return plant.Observe().pose.position();
  };
  for (const char* tyre : {"mujoco:contact", "mujoco:magic_formula"}) {
    for (const Vec2& grade : {Vec2(0.0, 0.0), Vec2(0.1, 0.0), Vec2(0.0, 0.1)}) {
      const bool level = grade.norm() == 0.0;
      const World world{.ground = {.grade = grade}};
      const CarModel car = CarWith(level ? "bmw320i" : "prius", {}, 0.002, world);
      const auto plant = MakePlant(tyre, {.car = car, .world = world});
      // On a slope, springs and tyres first settle under the load.
      const Vec2 settled = park(*plant, 3.0);
      EXPECT_LT(settled.norm(), level ? 0.001 : 0.05) << tyre << ", grade " << grade.transpose();
      const Vec2 end = park(*plant, 60.0);
      EXPECT_LT((end - settled).norm(), level ? 0.001 : 0.010)
          << tyre << ", grade " << grade.transpose();
    }
  }
}

TEST(MagicFormulaTyres, CoastingWheelsSettle) {
  // A wheel is released after 0.15 s of braking. Without damping, the wheel would oscillate at
  // about 120 rad/s. With an explicit slip law, the oscillation would never stop.
  for (const double timestep : {0.001, 0.002, 0.004, 0.005}) {
    const CarModel car = CarWith("bmw320i", {}, timestep);
    for (const double speed : {1.5, 5.0, 20.0, 40.0}) {
      const World world;
      const auto plant = On(car, world, {.speed = speed});
      std::vector<double> slips;
      Drive(
          car, *plant, 1.0,
          [](double t, const VehicleState&) {
            return Command{.acceleration = t < 0.15 - 1e-9 ? -5.0 : 0.0};
          },
          [&](double t, const VehicleState& s) {
            if (t >= 0.15 - 1e-9) {
              slips.push_back((*s.wheels)[0].slip_ratio);
            }
          });
      const double end = slips.back();
      const double start = slips.front() - end;
      double overshoot = 0.0;
      double tail = 0.0;
      for (std::size_t i = 0; i < slips.size(); ++i) {
        overshoot = std::max(overshoot, -(slips[i] - end) * (start > 0.0 ? 1.0 : -1.0));
        tail = i > slips.size() / 2 ? std::max(tail, std::abs(slips[i] - end)) : tail;
      }
      EXPECT_LT(overshoot, Tolerance(0.02) * std::abs(start)) << timestep << " " << speed;
      EXPECT_LT(tail, Tolerance(1e-4)) << timestep << " " << speed;
    }
  }
}

TEST(MagicFormulaTyres, TurnsTheSameAtEveryTimestep) {
  std::vector<VehicleState> ends;
  std::vector<double> peaks;
  for (const double timestep : {0.001, 0.002, 0.004}) {
    const CarModel car = CarWith("bmw320i", {}, timestep);
    const World world;
    const auto plant = On(car, world, {.speed = 20.0});
    double peak = 0.0;
    double lowest = 1.0;
    double highest = 0.0;
    ends.push_back(Drive(
        car, *plant, 4.0,
        [&](double t, const VehicleState& s) {
          // The commanded wheel angle is the angle at the end of the step.
          return HoldSpeed(20.0, StepSteer(t + timestep, 0.03), s);
        },
        [&](double t, const VehicleState& s) {
          peak = std::max(peak, s.yaw_rate);
          if (t > 3.0) {
            lowest = std::min(lowest, s.yaw_rate);
            highest = std::max(highest, s.yaw_rate);
          }
        }));
    peaks.push_back(peak);
    EXPECT_LT(highest - lowest, Tolerance(1e-3) * highest) << "a limit cycle at " << timestep;
  }
  for (std::size_t i = 1; i < ends.size(); ++i) {
    EXPECT_NEAR(ends[i].yaw_rate / ends[0].yaw_rate, 1.0, Tolerance(0.005));
    EXPECT_NEAR(peaks[i] / peaks[0], 1.0, Tolerance(0.005));
    EXPECT_LT((ends[i].pose.position() - ends[0].pose.position()).norm() / ends[0].distance,
              Tolerance(0.005));
  }
}

TEST(MagicFormulaTyres, LeftAndRightAreMirrorImages) {
  const CarModel car = CarWith("bmw320i", {});
  const World world;
  std::array<VehicleState, 2> ends;
  for (std::size_t i = 0; i < 2; ++i) {
    const double side = i == 0 ? 1.0 : -1.0;
    const auto plant = On(car, world, {.speed = 20.0});
    ends[i] = Drive(
        car, *plant, 3.0,
        [&](double t, const VehicleState& s) {  // braking in a turn at 0.6 g, with all slips active
          return t < 1.5 ? HoldSpeed(20.0, side * StepSteer(t, 0.038), s)
                         : Command{.steering = side * 0.038, .acceleration = -3.0};
        },
        kNoLook);
  }
  // Over some hundred steps of a stable motion, rounding grows to the solver's tolerance, 1e-10.
  EXPECT_NEAR(ends[0].pose.x, ends[1].pose.x, Tolerance(1e-6));
  EXPECT_NEAR(ends[0].pose.y, -ends[1].pose.y, Tolerance(1e-6));
  EXPECT_NEAR(ends[0].yaw_rate, -ends[1].yaw_rate, Tolerance(1e-6));
  EXPECT_NEAR((*ends[0].wheels)[0].normal_force, (*ends[1].wheels)[1].normal_force,
              Tolerance(0.01));
}

TEST(MagicFormulaTyres, SlidingNeverGainsEnergy) {
  // The car slides sideways at 12 m/s without drive or brakes. The kinetic energy of the car may
  // only decrease, except for the energy that springs and deflected tyres return in the first
  // bounce, which is below 2 %.
  const CarModel car = CarWith("prius", {});
  const World world;
  const auto plant = On(car, world, {.speed = 12.0});
  const auto energy = [&](const VehicleState& s) {
    return 0.5 * car.params().mass * (s.speed * s.speed + s.lateral_speed * s.lateral_speed) +
           0.5 * car.params().yaw_inertia * s.yaw_rate * s.yaw_rate;
  };
  double least = 1e9;
  double gained = 0.0;
  Drive(
      car, *plant, 6.0,
      [](double t, const VehicleState&) {
        return Command{.steering = t < 1.0 ? 0.35 * t : 0.35, .acceleration = -0.001};
      },
      [&](double, const VehicleState& s) {
        gained = std::max(gained, energy(s) - least);
        least = std::min(least, energy(s));
      });
  const double first = 0.5 * car.params().mass * 12.0 * 12.0;
  EXPECT_LT(gained / first, Tolerance(0.02));
  EXPECT_LT(least / first, 0.5);  // the car did slide
}

TEST(MagicFormulaTyres, TheRoadIsThatUnderEachWheel) {
  // The left wheels are on ice. When the car brakes hard, the left wheels transmit a tenth of the
  // right wheels' force, so the car turns to the right.
  World world;
  world.friction_patches = {{.area = {{50.0, 5.0, 0.0}, 200.0, 10.0}, .friction = 0.1}};
  for (const char* tyre : {"mujoco:magic_formula", "mujoco:contact"}) {
    const CarModel car = CarWith("prius", {});
    const auto plant = MakePlant(tyre, {.car = car, .world = world, .start = {.speed = 15.0}});
    // The test adds up forces, because bare contacts bounce under braking.
    std::array<double, 4> braking{};
    std::array<double, 4> load{};
    const VehicleState state = Drive(
        car, *plant, 0.4,
        [](double, const VehicleState&) { return Command{.acceleration = -20.0}; },
        [&](double t, const VehicleState& s) {
          for (std::size_t w = 0; w < 4 && t > 0.1; ++w) {
            braking[w] -= (*s.wheels)[w].longitudinal_force;
            load[w] += (*s.wheels)[w].normal_force;
          }
        });
    for (const std::size_t left : {0U, 2U}) {
      EXPECT_LE(braking[left], 0.12 * load[left]) << tyre;
      EXPECT_GT(braking[left + 1], 0.5 * load[left + 1]) << tyre;
    }
    EXPECT_LT(state.yaw_rate, -0.05) << tyre;
  }
}

constexpr double kLean = 1e-3;  // [rad], to the left

/// Camber stiffness dF_y/dgamma of an upright tyre without slip, at the load `load` [N/rad].
double CamberStiffness(const MagicFormula& tyre, double load) {
  return (EvaluateTyreForce(tyre, load, 1.0, {.camber = kLean}).lateral -
          EvaluateTyreForce(tyre, load, 1.0, {.camber = -kLean}).lateral) /
         (2.0 * kLean);
}

TEST(MagicFormulaTyres, CamberPushesTheWheelsOfThePriusToTheSideToWhichTheyLean) {
  // The set of the Prius is of PAC2002, whose gamma is positive if the wheel leans to the right:
  //   S_hy = p_hy3 gamma, S_vy = p_vy3 gamma F_z, and near zero slip F_y = K_y S_hy + S_vy.
  // A lean to the left is -gamma, so dF_y/dlean = -(K_y p_hy3 + p_vy3 F_z) with K_y < 0.
  // The central difference neglects (B S_hy)^2 < (20 * 5e-5)^2 = 1e-6.
  const CarModel car = CarWith("prius", {});
  for (const MagicFormula& tyre : car.parts().tyres->axle) {
    for (const double load : {1500.0, 3500.0, 6000.0}) {
      const double expected = CorneringStiffness(tyre, load) * 0.044112 + 0.092912 * load;
      EXPECT_NEAR(CamberStiffness(tyre, load) / expected, 1.0, Tolerance(1e-5)) << load;
      // Camber stiffnesses of car tyres are about as large as the load (Pacejka 2012, section 4.2).
      EXPECT_GT(CamberStiffness(tyre, load), 0.3 * load);
      EXPECT_LT(CamberStiffness(tyre, load), 2.0 * load);
    }
  }
}

TEST(MagicFormulaTyres, CamberOfTheBmwCountsAsInCommonRoad) {
  // CommonRoad's roll angle is negative in a left turn, so its wheels lean to the left by gamma >
  // 0. Its formula adds S_hy = p_hy3 gamma and S_vy = p_vy3 gamma F_z for this gamma. Ours smooths
  // the sign of gamma over 5e-4 rad.
  const double sign = kLean / std::hypot(kLean, 5e-4);
  const CarModel car = CarWith("bmw320i", {});
  for (const MagicFormula& tyre : car.parts().tyres->axle) {
    const double expected = sign * (-21.92 * 0.031415 - 0.32931) * 3000.0;
    EXPECT_NEAR(CamberStiffness(tyre, 3000.0) / expected, 1.0, Tolerance(1e-5));
  }
}

TEST(MagicFormulaTyres, PrescribedWheelsStandWhereTheyAreAsked) {
  const CarModel car = CarWith("prius", {});
  const World world;
  const auto plant = On(car, world, {.speed = 10.0});
  for (int i = 1; i <= 200; ++i) {
    const double steering = 0.1 * std::sin(0.05 * i);  // 2.5 rad/s, faster than any actuator
    plant->Step({.steering = steering});
    EXPECT_NEAR(plant->Observe().steering, steering, Tolerance(1e-9));
  }
}

}  // namespace
}  // namespace trackbed
