#include "trackbed/sim/car_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <array>
#include <cmath>

#include "tests/support/error_text.h"
#include "tests/support/temp_folder.h"
#include "tests/tolerance.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"

// Tests the compiled car model: parameters against published numbers, steering linkage and limits
// against closed forms written independently, and messages for unsuitable models.
namespace trackbed {
namespace {

CarModel Prius(double timestep = 0.002) {
  return {ComposeScene(FindModel("prius", ""), {.timestep = timestep}), "prius"};
}

double Custom(const CarModel& car, const char* name) {
  const mjModel* m = car.get();
  return m->numeric_data[m->numeric_adr[mj_name2id(m, mjOBJ_NUMERIC, name)]];
}

TEST(Prius, HasThePublishedParameters) {
  const CarModel car = Prius();
  const VehicleParams& params = car.params();
  EXPECT_EQ(params.name, "prius");
  EXPECT_EQ(params.wheelbase, 2.7);
  // The file states masses with 13 digits. A deviation of 0.1 mm has no physical significance.
  EXPECT_NEAR(params.cg_to_rear, 1.4, Tolerance(1e-4));
  EXPECT_NEAR(params.cg_to_front(), 1.3, Tolerance(1e-4));
  EXPECT_NEAR(params.mass, 1317.0, Tolerance(1e-9));
  EXPECT_NEAR(params.length, 4.45, Tolerance(1e-12));
  EXPECT_NEAR(params.width, 1.725, Tolerance(1e-12));
  EXPECT_NEAR(params.height, 1.49, Tolerance(1e-12));
  EXPECT_EQ(params.steering_limit, 0.48689923181126915);
  EXPECT_EQ(params.steering_rate, 0.15056818181818182);
  EXPECT_EQ(params.steering_ratio, 17.6);
}

TEST(Prius, ActuatorAgreesWithTheNumbersItIsMadeOf) {
  const CarModel car = Prius();
  // Both numbers are equal except for the rounding of one operation.
  EXPECT_NEAR(car.params().min_turning_radius(), Custom(car, "turning_radius"), Tolerance(1e-14));
  EXPECT_NEAR(car.params().steering_rate,
              Custom(car, "steering_wheel_rate") / Custom(car, "steering_ratio"), Tolerance(1e-16));
}

TEST(Prius, TakesTheRunsTimestep) {
  EXPECT_EQ(Prius(0.004).timestep(), 0.004);
}

TEST(Prius, AckermannCouplingFollowsTheClosedForm) {
  const CarModel car = Prius();
  const mjModel* m = car.get();
  for (const char* side : {"fl", "fr"}) {
    const std::string name = std::string("ackermann_") + side;
    const int equality = mj_name2id(m, mjOBJ_EQUALITY, name.c_str());
    ASSERT_GE(equality, 0);
    const mjtNum* c = m->eq_data + mjNEQDATA * equality;
    for (double steering = -0.486; steering <= 0.486; steering += 0.018) {
      const double coupled =
          c[0] + steering * (c[1] + steering * (c[2] + steering * (c[3] + steering * c[4])));
      const FrontAngles exact = AckermannAngles(car.params(), steering);
      // The model's polynomial of fourth degree is a minimax fit. The model states its residual as
      // 0.00024 rad.
      EXPECT_NEAR(coupled, side[1] == 'l' ? exact.left : exact.right, Tolerance(0.00025));
    }
  }
}

/// Steers, drives and rolls for 2 s; returns the final positions.
std::vector<mjtNum> Roll(const mjModel& model) {
  const MujocoData d = MakeMujocoData(model);
  for (int step = 0; step < 1000; ++step) {
    for (int i = 0; i < model.nu; ++i) {
      // Commands are fractions of the actuators' ranges and vary slowly.
      d->ctrl[i] = 0.5 * model.actuator_ctrlrange[2 * i + 1] * std::sin(0.01 * step);
    }
    mj_step(&model, d.get());
  }
  return {d->qpos, d->qpos + model.nq};
}

TEST(CarModel, IsSteppedWithoutItsLooks) {
  for (const char* name : {"prius", "bmw320i", "diff_drive"}) {
    SCOPED_TRACE(name);
    const Scene scene = ComposeScene(FindModel(name, ""), {});
    const CarModel car(scene, name);
    const TempFolder folder;
    WriteScene(scene, folder.path() / "model.xml");
    std::array<char, 500> message{};
    const MujocoModel whole(
        mj_loadXML((folder.path() / "model.xml").c_str(), nullptr, message.data(), message.size()));
    ASSERT_NE(whole, nullptr) << message.data();
    EXPECT_GT(whole->ngeom, car.get()->ngeom);
    for (int geom = 0; geom < car.get()->ngeom; ++geom) {
      EXPECT_NE(car.get()->geom_contype[geom] | car.get()->geom_conaffinity[geom], 0) << geom;
    }
    EXPECT_EQ(Roll(*whole), Roll(*car.get()));
  }
}

TEST(Prius, OpensAndSteersInMujocoAlone) {
  // Does the same as MuJoCo's viewer: loads the file and moves the actuators' sliders.
  std::array<char, 500> message{};
  const MujocoModel m(
      mj_loadXML(FindModel("prius", "").c_str(), nullptr, message.data(), message.size()));
  ASSERT_NE(m, nullptr) << message.data();
  const MujocoData d = MakeMujocoData(*m);
  d->ctrl[mj_name2id(m.get(), mjOBJ_ACTUATOR, "steer")] = 10.0;  // clamped to the rate limit
  d->ctrl[mj_name2id(m.get(), mjOBJ_ACTUATOR, "drive")] = 400.0;
  while (d->time < 2.0) {
    mj_step(m.get(), d.get());
  }
  const int rack = m->jnt_qposadr[mj_name2id(m.get(), mjOBJ_JOINT, "rack")];
  // The rack turns for 2 s at the limit of 0.1506 rad/s, with a servo lag of 10 ms.
  EXPECT_NEAR(d->qpos[rack], 2.0 * 0.15056818181818182, Tolerance(0.002));
  EXPECT_GT(d->qpos[0], 0.5);  // drives forward
  EXPECT_GT(d->qpos[1], 0.0);  // and to the left
  for (const mjWarningStat& warning : d->warning) {
    EXPECT_EQ(warning.number, 0);
  }
}

TEST(CarModel, PosesACarFlat) {
  const CarModel car = Prius();
  const auto columns = car.configuration_columns();
  const auto row = car.FlatConfiguration({1.0, 2.0, 0.5}, 0.2, {0.1, 0.2, 0.3, 0.4});
  ASSERT_EQ(row.size(), columns.size());
  const auto at = [&](const std::string& column) {
    const auto found = std::find(columns.begin(), columns.end(), column);
    EXPECT_NE(found, columns.end()) << column;
    return row[static_cast<std::size_t>(found - columns.begin())];
  };
  EXPECT_EQ(at("x_m"), 1.0);
  EXPECT_EQ(at("y_m"), 2.0);
  EXPECT_EQ(at("qw"), std::cos(0.25));
  EXPECT_EQ(at("qz"), std::sin(0.25));
  EXPECT_EQ(at("spin_rl_rad"), 0.3);
  EXPECT_EQ(at("rack_rad"), 0.2);
  EXPECT_EQ(at("suspension_fl_m"), 0.0);
  EXPECT_EQ(at("steer_fl_rad"), AckermannAngles(car.params(), 0.2).left);
}

TEST(CarModel, RollingSpeedsAreRigidBodyMotion) {
  const CarModel car = Prius();
  const VehicleParams& p = car.params();
  const double steering = 0.3;
  const double speed = 3.0;
  const double yaw_rate = speed * std::tan(steering) / p.wheelbase;
  const auto speeds = RollingSpeeds(p, speed, steering);
  // The velocity of each wheel is its distance from the common turning center times the yaw rate.
  const double radius = p.wheelbase / std::tan(steering);
  const double half = 0.5 * p.track_front;
  EXPECT_NEAR(speeds[0], yaw_rate * std::hypot(radius - half, p.wheelbase), Tolerance(1e-12));
  EXPECT_NEAR(speeds[1], yaw_rate * std::hypot(radius + half, p.wheelbase), Tolerance(1e-12));
  EXPECT_NEAR(speeds[2], yaw_rate * (radius - 0.5 * p.track_rear), Tolerance(1e-12));
  EXPECT_NEAR(speeds[3], yaw_rate * (radius + 0.5 * p.track_rear), Tolerance(1e-12));
}

std::string ErrorMessage(const std::string& xml) {
  return ErrorText([&] { const CarModel car({.xml = xml, .assets = {}}, "car.xml"); });
}

/// The Prius with one piece of text replaced.
std::string PriusWith(const std::string& from, const std::string& to) {
  std::string xml = ReadFile(FindModel("prius", ""));
  const std::size_t at = xml.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return xml.replace(at, from.size(), to);
}

TEST(CarModel, SaysWhatAModelLacks) {
  EXPECT_EQ(ErrorMessage(PriusWith("<site name=\"footprint\"", "<site name=\"shape\"")),
            "car.xml: footprint: the model has no box site of this name");
  const std::string bare = ErrorMessage("<mujoco/>");
  for (const char* name : {"chassis", "rack", "ground", "tyre_fl", "spin_rr", "steer_fr", "steer",
                           "drive", "brake_torque_front", "footprint", "steering_ratio"}) {
    EXPECT_THAT(bare, testing::HasSubstr(std::string("car.xml: ") + name + ": "));
  }
}

TEST(CarModel, TellsWhatDoesNotCompileInOneLine) {
  EXPECT_EQ(ErrorMessage("<mujoco><worldbody><body/><oops/></worldbody></mujoco>"),
            "car.xml: does not compile: unrecognized element (<oops>)");
  // MuJoCo 3.3 does not name the body.
  EXPECT_THAT(
      ErrorMessage("<mujoco><worldbody><body name='a'><joint/></body></worldbody></mujoco>"),
      testing::MatchesRegex("car.xml: does not compile: mass and inertia of moving bodies must be "
                            "larger than mjMINVAL( \\('a'\\))?"));
  const TempFolder folder;
  const auto file = folder.Write("car.xml",
                                 "<mujoco>\n\n<worldbody>\n<body>\n\n<joint axis='x'/></body>"
                                 "</worldbody></mujoco>");
  try {
    const CarModel car(ComposeScene(file, {}), "car.xml");
    FAIL();
  } catch (const InputError& error) {
    // The second message is that of newer versions of MuJoCo.
    EXPECT_THAT(error.what(),
                testing::AnyOf(
                    testing::StrEq(
                        "car.xml:6: does not compile: problem reading attribute 'axis' (<joint>)"),
                    testing::StrEq(
                        "car.xml:6: does not compile: bad format in attribute 'axis' (<joint>)")));
  }
}

TEST(CarModel, FindsTheSteeringAmongActuatorsInAnyOrder) {
  // MuJoCo 2.2.2 requires actuators without a state first. Each other actuator has one number in
  // `act`.
  const std::string motor = "<motor name=\"drive\"";
  const std::string xml = ReadFile(FindModel("prius", ""));
  const std::size_t begin = xml.find(motor);
  const std::size_t end = xml.find("/>", begin) + 2;
  std::string last = xml.substr(0, begin) + xml.substr(end);
  last.insert(last.find("</actuator>"), xml.substr(begin, end - begin));
#if mjVERSION_HEADER < 300
  EXPECT_THAT(ErrorMessage(last), testing::HasSubstr("stateless actuators must come before"));
#else
  const CarModel car(Scene{.xml = last}, "car.xml");
  EXPECT_EQ(car.parts().steer_state, 0);
  EXPECT_LT(car.parts().steer_actuator, car.parts().drive_actuator);
#endif
}

TEST(CarModel, RefusesSteeringWithoutLimits) {
  EXPECT_THAT(ErrorMessage(PriusWith("kp=\"200000\" ctrllimited=\"true\"",
                                     "kp=\"200000\" ctrllimited=\"false\"")),
              testing::HasSubstr("car.xml: steer: must be an <intvelocity>"));
}

TEST(CarModel, RefusesARackThatStopsBeforeTheSteering) {
  EXPECT_EQ(ErrorMessage(PriusWith("<joint name=\"rack\" type=\"hinge\"",
                                   "<joint name=\"rack\" type=\"hinge\" limited=\"true\" "
                                   "range=\"-0.4 0.4\"")),
            "car.xml: rack: range -0.4 to 0.4 rad does not cover the -0.4869 to 0.4869 rad of the "
            "steering; without <compiler angle=\"radian\"/> ranges are in degrees");
}

TEST(CarModel, RefusesAFootprintThatIsNotTheChassis) {
  std::string xml = PriusWith("<site name=\"footprint\"", "<site name=\"shape\"");
  const std::string rack = "<body name=\"rack\"";
  const std::size_t inside = xml.find('>', xml.find(rack)) + 1;
  xml.insert(inside, "<site name=\"footprint\" type=\"box\" size=\"2 1 1\"/>");
  EXPECT_EQ(ErrorMessage(xml),
            "car.xml: footprint: must be a site of the body 'chassis'; it is on 'rack'");
}

TEST(CarModel, RefusesAFrameThatIsNotUnderTheRearAxle) {
  std::string xml =
      PriusWith("<body name=\"knuckle_rl\" pos=\"0 ", "<body name=\"knuckle_rl\" pos=\"0.5 ");
  EXPECT_THAT(ErrorMessage(xml),
              testing::HasSubstr("car.xml: chassis: the body origin must be under the rear axle"));
}

// --- Limits on a flat road
// -------------------------------------------------------------------------

/// A car's numbers, written independently of its file, and quantities derived from them.
struct LimitsByHand {
  double mass, wheelbase, to_rear, cg_height, radius, spin_inertia;  // SI; inertia per wheel
  double brake_front, brake_rear;                                    // brake torque per wheel [N m]
  double friction;

  [[nodiscard]] double Wheels() const { return 2.0 * spin_inertia / (radius * radius); }
  [[nodiscard]] double Rolling() const { return mass + 2.0 * Wheels(); }
  [[nodiscard]] double BrakeForce() const { return 2.0 * (brake_front + brake_rear) / radius; }
  [[nodiscard]] double FrontPart() const { return brake_front / (brake_front + brake_rear); }
  /// Returns the required friction of the front and the rear axle at a deceleration: the road force
  /// divided by the load.
  [[nodiscard]] std::array<double, 2> Demand(double a) const {
    const double front = FrontPart() * Rolling() * a - Wheels() * a;
    const double rear = (1.0 - FrontPart()) * Rolling() * a - Wheels() * a;
    const double shift = mass * a * cg_height / wheelbase;
    const double weight = mass * 9.81;
    return {front / (weight * to_rear / wheelbase + shift),
            rear / (weight * (wheelbase - to_rear) / wheelbase - shift)};
  }
};

const LimitsByHand kPriusByHand{1317.0, 2.7, 1.4, 0.55, 0.31075, 0.8, 1500.0, 550.0, 0.9};
const LimitsByHand kBmwByHand{1093.2954, 2.57892, 1.42272, 0.574869, 0.344,
                              1.7,       1427.27, 735.27,  1.0489};
const LimitsByHand kSmallByHand{3.0, 0.26, 0.125, 0.04, 0.033, 5e-5, 0.31, 0.18, 0.9};

CarModel Load(const std::string& model) {
  return {ComposeScene(FindModel(model, TRACKBED_SOURCE_DIR), {}), model};
}

/// Relative tolerance for the masses and positions that this test states, which agree with the
/// files to at least 5 digits.
constexpr double kByHand = 1e-4;

TEST(VehicleLimits, BrakingEndsWhereTheFirstAxleWouldLock) {
  struct Case {
    const char* model;
    const LimitsByHand& hand;
    std::size_t first;  // the axle that locks first, 0 in front
  };
  for (const auto& [model, hand, first] :
       {Case{"prius", kPriusByHand, 0}, Case{"bmw320i", kBmwByHand, 1},
        Case{"tests/data/models/small_car.xml", kSmallByHand, 0}}) {
    SCOPED_TRACE(model);
    const VehicleParams params = Load(model).params();
    const auto demand = hand.Demand(params.max_deceleration);
    EXPECT_NEAR(demand[first], hand.friction, Tolerance(kByHand));
    EXPECT_LT(demand[1 - first], hand.friction);
    EXPECT_LT(params.max_deceleration, hand.BrakeForce() / hand.Rolling());
    EXPECT_NEAR(params.friction_longitudinal, hand.friction, Tolerance(1e-12));
  }
}

TEST(VehicleLimits, OnASlipperyRoadTheAxleThatTheSmallerTransferLeavesLightLocksFirst) {
  // The BMW's brakes are balanced for about half its grip. On a road with the friction factor 0.3,
  // the front axle locks first; at full grip, the rear axle locks first.
  const VehicleParams bmw = Load("bmw320i").params();
  const auto demand = kBmwByHand.Demand(MaxDeceleration(bmw, 0.3));
  EXPECT_NEAR(demand[0], 0.3 * 1.0489, Tolerance(kByHand));
  EXPECT_LT(demand[1], 0.3 * 1.0489);
  EXPECT_EQ(MaxDeceleration(bmw, 1.0), bmw.max_deceleration);
  // Parameters filled by hand have no axles.
  const VehicleParams by_hand{.max_deceleration = 6.0, .max_acceleration = 4.0};
  EXPECT_EQ(MaxDeceleration(by_hand, 0.5), 3.0);
  EXPECT_EQ(MaxAcceleration(by_hand, 0.5), 2.0);
  EXPECT_EQ(MaxDeceleration(by_hand, 2.0), 6.0);
  EXPECT_EQ(MaxDeceleration({}, 0.5), 0.0);
}

TEST(VehicleLimits, BrakingIsLimitedByWeakBrakesToo) {
  const CarModel car({.xml = PriusWith("name=\"brake_torque_front\" data=\"1500\"",
                                       "name=\"brake_torque_front\" data=\"500\""),
                      .assets = {}},
                     "car.xml");
  LimitsByHand weak = kPriusByHand;
  weak.brake_front = 500.0;
  EXPECT_NEAR(car.params().max_deceleration, weak.BrakeForce() / weak.Rolling(),
              Tolerance(kByHand * 5.0));
}

TEST(VehicleLimits, TheDriveIsLimitedByItsTorqueOrItsAxlesGrip) {
  // The torque of the motor limits the acceleration of the Prius. The rolling resistance, 1 % of
  // the weight, and the friction of four bearings, 1 N m each, are subtracted. The front wheels
  // would slip only at 3.828 m/s^2.
  const double rolling = 0.01 * 1317.0 * 9.81 + 4.0 / 0.31075;
  const VehicleParams prius = Load("prius").params();
  EXPECT_NEAR(prius.max_acceleration, (1645.0 / 0.31075 - rolling) / kPriusByHand.Rolling(),
              Tolerance(kByHand * 4.0));
  // The grip of the rear axle limits the BMW, because its torque of 4325 N m would give 10.9 m/s^2.
  // The rear axle also accelerates the front wheels, so its force is X = (M - J) a. M is the mass
  // including the inertia of all wheels and J the inertia of the rear wheels, as a mass. The load
  // of the axle is m (g l_f + a h)/L.
  const VehicleParams bmw = Load("bmw320i").params();
  const LimitsByHand& b = kBmwByHand;
  const double a = bmw.max_acceleration;
  EXPECT_NEAR(
      (b.Rolling() - b.Wheels()) * a,
      b.friction * b.mass * (9.81 * (b.wheelbase - b.to_rear) + a * b.cg_height) / b.wheelbase,
      Tolerance(b.mass * a * kByHand));
  // The small car has 0.5 N m on the rear axle and four bearings with a friction of 1e-3 N m.
  const VehicleParams small = Load("tests/data/models/small_car.xml").params();
  EXPECT_NEAR(small.max_acceleration, (0.5 - 4e-3) / 0.033 / kSmallByHand.Rolling(),
              Tolerance(kByHand * 5.0));
}

TEST(VehicleLimits, AreTheFrictionOfTheWorseTyreLaw) {
  // The contacts of the Prius have the friction coefficient 0.9. At a load of 3350 N, the lateral
  // friction coefficient of its front tyres is smaller, and the longitudinal one is larger.
  const double load = 0.5 * 1317.0 * 9.81 * 1.4 / 2.7;
  const VehicleParams params = Load("prius").params();
  EXPECT_NEAR(params.friction_lateral, 0.8784 - 0.06445 * (load - 4000.0) / 4000.0,
              Tolerance(1e-5));
  EXPECT_NEAR(params.friction_longitudinal, 0.9, Tolerance(1e-12));
  EXPECT_NEAR(Load("bmw320i").params().friction_lateral, 1.0489, Tolerance(1e-12));
  // With a contact friction of 2, the friction coefficients of the Magic Formula are the limits.
  // The smaller longitudinal one belongs to the front tyres.
  const CarModel sticky({.xml = PriusWith("friction=\"0.9 ", "friction=\"2 "), .assets = {}},
                        "car.xml");
  EXPECT_NEAR(sticky.params().friction_longitudinal, 1.0422 - 0.0827 * (load - 4000.0) / 4000.0,
              Tolerance(1e-5));
}

TEST(VehicleLimits, TopSpeedIsWhereDragTakesAll) {
  const VehicleParams prius = Load("prius").params();
  const double rolling = 0.01 * 1317.0 * 9.81 + 4.0 / 0.31075;
  EXPECT_NEAR(prius.top_speed, std::sqrt((1645.0 / 0.31075 - rolling) / (0.5 * 1.225 * 0.561)),
              Tolerance(0.001));
  // The power P limits the top speed of the BMW. Cardano's formula solves k v^3 + R v - P = 0, with
  // the drag k v^2 and the rolling resistance R.
  const double k = 0.5 * 1.225 * 0.688;
  const double p = 4.0 * 0.5 / 0.344 / k;
  const double q = -92021.0 / k;
  const double root = std::sqrt(q * q / 4.0 + p * p * p / 27.0);
  EXPECT_NEAR(Load("bmw320i").params().top_speed,
              std::cbrt(-q / 2.0 + root) + std::cbrt(-q / 2.0 - root), Tolerance(1e-9));
  // The small car has no known resistance, so its top speed is unknown.
  EXPECT_EQ(Load("tests/data/models/small_car.xml").params().top_speed, 0.0);
}

TEST(VehicleLimits, OfDifferentialDriveAreThoseOfItsMotorsAndOfTheDrivenAxle) {
  const VehicleParams params = Load("diff_drive").params();
  // The vehicle has 80 kg, two wheels with an inertia of 0.26 kg m^2, two motors with 30 N m, and
  // bearings with a friction of 0.3 N m.
  const double rolling_mass = 80.0 + 2.0 * 0.26 / (0.165 * 0.165);
  const double force = 60.0 / 0.165;
  EXPECT_NEAR(params.max_deceleration, force / rolling_mass, Tolerance(1e-9));
  EXPECT_NEAR(params.max_acceleration, (force - 0.6 / 0.165) / rolling_mass, Tolerance(1e-9));
  EXPECT_NEAR(params.top_speed, (22.0 - 30.0 / 60.0) * 0.165, Tolerance(1e-12));
  EXPECT_EQ(params.friction_longitudinal, 0.8);
  EXPECT_EQ(params.friction_lateral, 0.8);
  // With half the friction, the tyres slide before the motors reach their limit: m a = mu m (g 0.44
  // - a 0.26)/0.62. Braking transfers load to the caster, 0.62 m ahead of the axle.
  std::string xml = ReadFile(FindModel("diff_drive", ""));
  const std::string friction = "friction=\"0.8 ";
  xml.replace(xml.find(friction), friction.size(), "friction=\"0.4 ");
  const CarModel slippery({.xml = xml, .assets = {}}, "car.xml");
  EXPECT_NEAR(slippery.params().max_deceleration, 0.4 * 9.81 * 0.44 / (0.62 + 0.4 * 0.26),
              Tolerance(1e-9));
}

}  // namespace
}  // namespace trackbed
