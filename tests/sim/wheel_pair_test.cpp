#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <cmath>

#include "tests/sim/cars.h"
#include "tests/support/error_text.h"
#include "tests/tolerance.h"
#include "trackbed/core/file.h"
#include "trackbed/sim/payload.h"
#include "trackbed/sim/world_scene.h"

/// Tests a differential-drive vehicle.
namespace trackbed {
namespace wheel_pair_test {

const CarModel& DiffDrive() {
  static const CarModel diff_drive(ComposeScene(FindModel("diff_drive", ""), {}), "diff_drive");
  return diff_drive;
}

const World& Calm() {
  static const World world;
  return world;
}

/// Holds speed and steering for `duration` [s].
VehicleState Hold(Plant& plant, double steering, double speed, double duration,
                  const CarModel& car = DiffDrive()) {
  return Drive(
      car, plant, duration,
      [&](double, const VehicleState& state) {
        return Command{.steering = steering, .acceleration = 2.0 * (speed - state.speed)};
      },
      [](double, const VehicleState&) {});
}

std::unique_ptr<Plant> Mujoco(const StartState& start, const World& world = Calm(),
                              const CarModel& car = DiffDrive()) {
  return MakePlant("mujoco", {.car = car, .world = world, .start = start});
}

// --- The model -----------------------------------------------------------------------------------

TEST(DiffDrive, IsReadFromItsFile) {
  const VehicleParams& params = DiffDrive().params();
  EXPECT_EQ(params.name, "diff_drive");
  EXPECT_EQ(params.kind, VehicleKind::kDifferential);
  const double rounding = Tolerance(1e-12);
  EXPECT_NEAR(params.wheelbase, 0.6, rounding);
  EXPECT_NEAR(params.track_rear, 0.6, rounding);
  EXPECT_NEAR(params.cg_to_rear, 0.18, rounding);
  EXPECT_NEAR(DiffDrive().chassis().cg_height, 0.26, rounding);
  EXPECT_NEAR(params.mass, 80.0, rounding);
  EXPECT_NEAR(params.min_turning_radius(), 0.4, rounding);
  EXPECT_EQ(params.steering_rate, 1.0);
  EXPECT_EQ(params.wheel_radius, 0.165);
  EXPECT_NEAR(params.rear_overhang, 0.28, rounding);
  EXPECT_EQ(DiffDrive().wheel_pair().wheel_speed, 22.0);
  EXPECT_EQ(DiffDrive().wheel_pair().servo_slack, 30.0 / 60.0);
}

TEST(DiffDrive, TakesTheRunsSteeringRate) {
  const CarModel slower(ComposeScene(FindModel("diff_drive", ""), {.steering_rate = 0.3}),
                        "diff_drive");
  EXPECT_EQ(slower.params().steering_rate, 0.3);
}

TEST(DiffDrive, OpensAndDrivesInMujocoAlone) {
  std::array<char, 500> message{};
  const MujocoModel m(
      mj_loadXML(FindModel("diff_drive", "").c_str(), nullptr, message.data(), message.size()));
  ASSERT_NE(m, nullptr) << message.data();
  const MujocoData d = MakeMujocoData(*m);
  d->ctrl[mj_name2id(m.get(), mjOBJ_ACTUATOR, "drive_left")] = 4.0;
  d->ctrl[mj_name2id(m.get(), mjOBJ_ACTUATOR, "drive_right")] = 6.0;
  while (d->time < 2.0) {
    mj_step(m.get(), d.get());
  }
  EXPECT_GT(d->qpos[0], 0.5);  // drives forward
  EXPECT_GT(d->qpos[1], 0.0);  // and to the left
}

TEST(DiffDrive, PosesOnTheScenesGround) {
  const auto columns = DiffDrive().configuration_columns();
  EXPECT_THAT(columns, testing::ElementsAre("x_m", "y_m", "z_m", "qw", "qx", "qy", "qz",
                                            "spin_left_rad", "spin_right_rad"));
  EXPECT_THAT(
      DiffDrive().FlatConfiguration({1.0, 2.0, 0.5}, 0.2, {0.1, 0.3}),
      testing::ElementsAre(1.0, 2.0, 0.0, std::cos(0.25), 0.0, 0.0, std::sin(0.25), 0.1, 0.3));
}

std::string WheelPairError(const std::string& xml) {
  return ErrorText([&] { const CarModel car({.xml = xml, .assets = {}}, "diff_drive.xml"); });
}

/// The model file with one piece of text replaced.
std::string With(const std::string& from, const std::string& to) {
  std::string xml = ReadFile(FindModel("diff_drive", ""));
  const std::size_t at = xml.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return xml.replace(at, from.size(), to);
}

TEST(WheelPair, SaysAllThatAModelLacks) {
  const std::string one_drive = WheelPairError(
      "<mujoco><worldbody><body name='chassis'><freejoint name='chassis'/><geom size='1'/>"
      "<body><joint name='spin_left' axis='0 1 0'/><geom size='1'/></body></body></worldbody>"
      "<actuator><velocity name='drive_left' joint='spin_left'/></actuator></mujoco>");
  for (const char* name :
       {"ground", "tyre_left", "tyre_right", "spin_right", "drive_right", "footprint",
        "turning_radius", "steering_rate", "integral_time", "brake_torque"}) {
    EXPECT_THAT(one_drive, testing::HasSubstr(std::string("diff_drive.xml: ") + name + ": "));
  }
  for (const char* name : {"rack", "spin_left: ", "tyre_fl", "steering_ratio"}) {
    EXPECT_THAT(one_drive, testing::Not(testing::HasSubstr(name)));
  }
}

TEST(WheelPair, RefusesARadiusOnWhichTheInnerWheelTurnsBackwards) {
  EXPECT_EQ(
      WheelPairError(
          With("name=\"turning_radius\" data=\"0.4\"", "name=\"turning_radius\" data=\"0.2\"")),
      "diff_drive.xml: turning_radius: must be at least half the track, 0.3 m, so that the inner "
      "wheel does not reverse; found 0.2");
}

TEST(WheelPair, RefusesWhatIsNotASpeedServo) {
  EXPECT_EQ(WheelPairError(With("<velocity name=\"drive_left\" joint=\"spin_left\" kv=\"60\"",
                                "<motor name=\"drive_left\" joint=\"spin_left\"")),
            "diff_drive.xml: drive_left: must be a <velocity> of gear 1 with ctrllimited and "
            "forcelimited: ctrlrange is the maximum wheel speed, forcerange the maximum torque");
  EXPECT_EQ(
      WheelPairError(With("<velocity name=\"drive_left\" joint=\"spin_left\" kv=\"60\"",
                          "<velocity name=\"drive_left\" joint=\"spin_left\" kv=\"50\"")),
      "diff_drive.xml: drive_right: kv, ctrlrange and forcerange must equal those of drive_left");
  EXPECT_THAT(WheelPairError(With("<velocity name=\"drive_left\" joint=\"spin_left\"",
                                  "<velocity name=\"drive_left\" joint=\"spin_right\"")),
              testing::HasSubstr("diff_drive.xml: drive_left: must act on the joint 'spin_left'"));
}

TEST(WheelPair, RefusesAServoThatIsTooSoft) {
  EXPECT_THAT(
      WheelPairError(With("joint=\"spin_left\" kv=\"60\"", "joint=\"spin_left\" kv=\"1\"")),
      testing::HasSubstr(
          "diff_drive.xml: drive_left: kv 1 is too small: forcerange/kv, the speed error at "
          "maximum torque, is 30 rad/s; must be below the ctrlrange of 22 rad/s"));
}

TEST(WheelPair, RefusesWheelsThatAreNotAboutTheOrigin) {
  EXPECT_EQ(
      WheelPairError(With("name=\"wheel_left\" pos=\"0 0.3 ", "name=\"wheel_left\" pos=\"0 0.4 ")),
      "diff_drive.xml: chassis: the driven wheels must be at equal distances left and right of y = "
      "0; found y = 0.4 and -0.3 m");
  EXPECT_THAT(WheelPairError(
                  With("name=\"wheel_left\" pos=\"0 0.3 ", "name=\"wheel_left\" pos=\"0.2 0.3 ")),
              testing::HasSubstr(
                  "diff_drive.xml: chassis: the body origin must be under the axle of the driven "
                  "wheels; they are 0.1 m ahead of it"));
}

TEST(WheelPair, SaysWhatItLacksForWhatIsACars) {
  const std::string needs = " needs steered front wheels";
  const std::string diff_drive = "diff_drive: diff_drive has differential drive; ";
  EXPECT_EQ(ErrorText([] {
              MakePlant("single_track", {.car = DiffDrive(), .world = Calm(), .start = {}});
            }),
            diff_drive + "the plant single_track" + needs);
  EXPECT_EQ(ErrorText([] {
              MakePlant("mujoco:magic_formula", {.car = DiffDrive(), .world = Calm(), .start = {}});
            }),
            diff_drive + "tyre: magic_formula" + needs);
  EXPECT_EQ(ErrorText([] {
              MakePlant("mujoco", {.car = DiffDrive(),
                                   .world = Calm(),
                                   .start = {},
                                   .steering = SteeringInput::kPrescribed});
            }),
            diff_drive + "drive.steering: prescribed on the plant mujoco" + needs);
  EXPECT_EQ(ErrorText([] { WithPayload(DiffDrive(), {.mass = 10.0}); }),
            diff_drive + "disturb.payload" + needs);
}

// --- Runs ----------------------------------------------------------------------------------------

TEST(WheelPair, StartsAsAsked) {
  for (const char* name : {"kinematic", "mujoco"}) {
    const auto plant = MakePlant(
        name, {.car = DiffDrive(), .world = Calm(), .start = {{3.0, -2.0, 1.0}, 2.0, 0.3}});
    const VehicleState state = plant->Observe();
    EXPECT_NEAR(state.pose.x, 3.0, Tolerance(1e-12)) << name;
    EXPECT_NEAR(state.pose.yaw, 1.0, Tolerance(1e-12)) << name;
    EXPECT_NEAR(state.speed, 2.0, Tolerance(1e-12)) << name;
    EXPECT_NEAR(state.steering_actuator, 0.3, Tolerance(1e-12)) << name;
    EXPECT_NEAR(state.steering, 0.3, Tolerance(1e-12)) << name;
    EXPECT_NEAR(state.yaw_rate, 2.0 * std::tan(0.3) / 0.6, Tolerance(1e-12)) << name;
    EXPECT_EQ(state.wheels.has_value(), false) << name;
  }
}

TEST(WheelPair, DrivesTheCircleOfItsWheelSpeeds) {
  for (const double steering : {0.3, -0.3, 0.8}) {
    for (const double speed : {0.5, 1.0}) {
      SCOPED_TRACE(fmt::format("steering {}, speed {}", steering, speed));
      const auto plant = Mujoco({.speed = speed});
      // The wheels reach their speed ratio after 0.8 s. The servos' integrals settle within five
      // more time constants of 0.15 s.
      const VehicleState before = Hold(*plant, steering, speed, 2.0);
      EXPECT_NEAR(before.steering, steering, Tolerance(1e-3));
      EXPECT_NEAR(before.speed, speed, Tolerance(1e-3 * speed));
      const VehicleState after = Hold(*plant, steering, speed, 2.0);
      const double radius = (after.distance - before.distance) / (after.pose.yaw - before.pose.yaw);
      // Rolling contacts hold the wheels below the friction limit, and the servos' integrals remove
      // the speed difference. After 1.2 s the remaining error is e^(-1.2/0.15) of a change below
      // one half.
      EXPECT_NEAR(radius, 0.6 / std::tan(steering), Tolerance(2e-4 * std::abs(radius)));
    }
  }
}

TEST(WheelPair, DoesNotRunAwayWhereItsInnerWheelSlips) {
  // The lateral acceleration is 0.39 g. The moment m l_g a_y reduces the load of the inner wheel by
  // 92 N, to the weight of 14 kg.
  const auto plant = Mujoco({.speed = 1.5});
  const VehicleState state = Hold(*plant, 0.8, 1.5, 6.0);
  EXPECT_FALSE(plant->diverged());
  EXPECT_LT(std::abs(state.speed), 1.7);
}

TEST(WheelPair, DrivesStraight) {
  const auto plant = Mujoco({.pose = {0.0, 0.0, 0.5}, .speed = 2.0});
  const VehicleState state = Hold(*plant, 0.0, 2.0, 3.0);
  // The vehicle is mirror symmetric up to the convergence of the contact solver.
  const Vec2 at = ToLocal({0.0, 0.0, 0.5}, state.pose.position());
  EXPECT_NEAR(at.y(), 0.0, Tolerance(1e-5));
  // In the first steps, the vehicle loses speed, and within half a second the speed control makes
  // up this distance.
  EXPECT_NEAR(at.x(), 6.0, Tolerance(0.02));
}

TEST(WheelPair, MirrorsWithTheSteering) {
  const auto left = Mujoco({.speed = 1.2});
  const auto right = Mujoco({.speed = 1.2});
  const VehicleState a = Hold(*left, 0.6, 1.2, 3.0);
  const VehicleState b = Hold(*right, -0.6, 1.2, 3.0);
  EXPECT_NEAR(a.pose.x, b.pose.x, Tolerance(1e-5));
  EXPECT_NEAR(a.pose.y, -b.pose.y, Tolerance(1e-5));
  EXPECT_NEAR(a.steering, -b.steering, Tolerance(1e-5));
}

TEST(WheelPair, ChangesItsRatioWithinRateAndLimit) {
  const auto plant = Mujoco({.speed = 0.5});
  EXPECT_NEAR(Hold(*plant, 9.0, 0.5, 0.5).steering_actuator, 0.5, Tolerance(1e-12));
  EXPECT_EQ(Hold(*plant, 9.0, 0.5, 1.0).steering_actuator, DiffDrive().params().steering_limit);
  // The inner wheel still rolls forward, at 1 - 0.3/0.4 of the speed of the vehicle.
  EXPECT_NEAR(plant->Observe().steering, DiffDrive().params().steering_limit, Tolerance(2e-3));
}

TEST(WheelPair, AtTheMotorsLargestSpeedSlowsDownAndKeepsItsCurve) {
  const auto plant = Mujoco({.speed = 3.0});
  const VehicleState state = Hold(*plant, 0.05, 9.0, 6.0);
  // The outer wheel turns at 22 rad/s, less the 30/60 rad/s reserved for its servo.
  const double fastest = 21.5 * 0.165 / (1.0 + 0.5 * std::tan(0.05));
  EXPECT_NEAR(state.speed, fastest, Tolerance(0.01 * fastest));
  EXPECT_NEAR(state.steering, 0.05, Tolerance(1e-3));
}

TEST(WheelPair, SpeedsUpAndSlowsDownAsAsked) {
  const auto plant = Mujoco({.speed = 1.0});
  const auto drive = [&](double acceleration, double duration) {
    return Drive(
        DiffDrive(), *plant, duration,
        [&](double, const VehicleState&) { return Command{.acceleration = acceleration}; },
        [](double, const VehicleState&) {});
  };
  // A servo with an integral part follows a ramp without lag. The tolerance of 1 % covers drag and
  // rolling resistance.
  EXPECT_NEAR(drive(1.0, 1.0).speed, 2.0, Tolerance(0.01));
  EXPECT_NEAR(drive(-1.0, 1.5).speed, 0.5, Tolerance(0.01));
  // The vehicle stops without reversing.
  const VehicleState rest = drive(-1.0, 1.5);
  EXPECT_NEAR(rest.speed, 0.0, Tolerance(1e-3));
}

TEST(WheelPair, DrivesBackwards) {
  const auto plant = Mujoco({});
  const VehicleState state = Drive(
      DiffDrive(), *plant, 3.0,
      [](double, const VehicleState& now) {
        return Command{.steering = 0.3, .acceleration = 2.0 * (-1.0 - now.speed), .gear = -1};
      },
      [](double, const VehicleState&) {});
  EXPECT_NEAR(state.speed, -1.0, Tolerance(0.01));
  EXPECT_NEAR(state.yaw_rate, -std::tan(0.3) / 0.6, Tolerance(0.01));
  EXPECT_NEAR(state.steering, 0.3, Tolerance(2e-3));
}

TEST(WheelPair, HoldsStillOnASlope) {
  World world;
  world.ground.grade = {0.1, 0.0};
  const CarModel car(WithWorld(DiffDrive().scene(), DiffDrive().params(), world), "diff_drive");
  for (const double yaw : {0.0, 1.5707963, 3.1415927, 0.8}) {
    const auto plant = Mujoco({.pose = {0.0, 0.0, yaw}}, world, car);
    const VehicleState state = Drive(
        car, *plant, 20.0, [](double, const VehicleState&) { return Command{}; },
        [](double, const VehicleState&) {});
    // Under a steady force, a contact creeps at (g * 0.1 * dmax * timeconst/2)/impratio = 25 um/s.
    EXPECT_NEAR(state.pose.position().norm(), 0.0, Tolerance(20.0 * 25e-6)) << yaw;
  }
}

TEST(WheelPair, ClimbsAtItsSpeed) {
  World world;
  world.ground.grade = {0.1, 0.0};
  const CarModel car(WithWorld(DiffDrive().scene(), DiffDrive().params(), world), "diff_drive");
  const auto plant = Mujoco({.speed = 1.0}, world, car);
  // The servos' integrals compensate the slope; the remaining error is slip, some mm/s.
  EXPECT_NEAR(Hold(*plant, 0.0, 1.0, 4.0, car).speed, 1.0, Tolerance(0.01));
}

TEST(WheelPair, SteersAtACrawlAsWanted) {
  const auto plant = Mujoco({});
  Drive(
      DiffDrive(), *plant, 4.0,
      [](double, const VehicleState& now) {
        return Command{.steering = 0.4, .acceleration = 2.0 * (0.02 - now.speed)};
      },
      [](double, const VehicleState& now) {
        // The deviation corresponds to an error of the wheel speeds of at most a tenth of 0.1 m/s.
        EXPECT_NEAR(now.steering, now.steering_actuator, Tolerance(0.1)) << now.time;
      });
}

TEST(WheelPair, SlidesOnIce) {
  const World ice{.friction = 0.02};
  const auto plant = Mujoco({.speed = 2.0}, ice);
  const VehicleState state = Drive(
      DiffDrive(), *plant, 1.0,
      [](double, const VehicleState&) { return Command{.acceleration = -3.0}; },
      [](double, const VehicleState&) {});
  // The two tyres have a friction of 0.8 * 0.02 and carry 71 % of the weight, so the deceleration
  // is 0.0114 g.
  EXPECT_NEAR(state.speed, 2.0 - 0.0114 * 9.81, Tolerance(0.02));
}

TEST(WheelPair, FeelsAPush) {
  const World ice{.friction = 1e-5};
  const auto plant = Mujoco({.speed = 2.0}, ice);
  for (int i = 0; i < 50; ++i) {
    plant->ApplyLateralForce(200.0);
    plant->Step({});
  }
  // An impulse of 20 N s acts on 80 kg. The friction of the road, 1e-5, and the impulse of the air,
  // 0.01 N s, are negligible.
  EXPECT_NEAR(plant->Observe().lateral_speed, 0.25, Tolerance(1e-3));
}

TEST(WheelPair, RollsOverABump) {
  World world;
  world.ground.bumps = {{.area = {{3.0, 0.0, 0.0}, 2.0, 3.0}, .height = 0.1}};
  const CarModel car(WithWorld(DiffDrive().scene(), DiffDrive().params(), world), "diff_drive");
  const auto plant = Mujoco({.speed = 1.0}, world, car);
  double highest = 0.0;
  const VehicleState state = Drive(
      car, *plant, 6.0,
      [](double, const VehicleState& now) {
        return Command{.acceleration = 2.0 * (1.0 - now.speed)};
      },
      [&](double, const VehicleState&) { highest = std::max(highest, plant->Configuration()[2]); });
  EXPECT_FALSE(plant->diverged());
  EXPECT_NEAR(highest, 0.1, Tolerance(5e-3));  // the origin, between the wheels, is on the crest
  EXPECT_NEAR(state.pose.x, 6.0, Tolerance(0.1));
  EXPECT_NEAR(state.pose.y, 0.0, Tolerance(1e-2));
}

}  // namespace wheel_pair_test
}  // namespace trackbed
