#include "trackbed/sim/car_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <array>
#include <cmath>
#include <memory>

#include "tests/support/temp_folder.h"
#include "tests/tolerance.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"

namespace trackbed {
namespace {

CarModel Prius(double timestep = 0.002) {
  return {ComposeScene(FindModel("prius", ""), {.timestep = timestep}), "prius"};
}

double Custom(const CarModel& car, const char* name) {
  const mjModel* m = car.get();
  return m->numeric_data[m->numeric_adr[mj_name2id(m, mjOBJ_NUMERIC, name)]];
}

TEST(Prius, HasTheSeedsParameters) {
  const CarModel car = Prius();
  const VehicleParams& params = car.params();
  EXPECT_EQ(params.name, "prius");
  EXPECT_EQ(params.wheelbase, 2.7);
  // Masses are chosen by hand to 13 digits; a tenth of a millimetre is far below what they mean.
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
  // Both sides are the same real number in double precision, up to the rounding of one operation.
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
      // The quartic is a minimax fit whose residual the model states as 0.00024 rad.
      EXPECT_NEAR(coupled, side[1] == 'l' ? exact.left : exact.right, Tolerance(0.00025));
    }
  }
}

TEST(Prius, OpensAndSteersInMujocoAlone) {
  // What MuJoCo's viewer does: load the file, and move the actuators' sliders.
  std::array<char, 500> message{};
  const std::unique_ptr<mjModel, void (*)(mjModel*)> m(
      mj_loadXML(FindModel("prius", "").c_str(), nullptr, message.data(), message.size()),
      mj_deleteModel);
  ASSERT_NE(m, nullptr) << message.data();
  const std::unique_ptr<mjData, void (*)(mjData*)> d(mj_makeData(m.get()), mj_deleteData);
  d->ctrl[mj_name2id(m.get(), mjOBJ_ACTUATOR, "steer")] = 10.0;  // the model cuts it to its rate
  d->ctrl[mj_name2id(m.get(), mjOBJ_ACTUATOR, "drive")] = 400.0;
  while (d->time < 2.0) {
    mj_step(m.get(), d.get());
  }
  const int rack = m->jnt_qposadr[mj_name2id(m.get(), mjOBJ_JOINT, "rack")];
  // 2 s at the limit of 0.1506 rad/s, less the servo's lag of 10 ms.
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
  // Every wheel moves about the same centre at its distance from it.
  const double radius = p.wheelbase / std::tan(steering);
  const double half = 0.5 * p.track_front;
  EXPECT_NEAR(speeds[0], yaw_rate * std::hypot(radius - half, p.wheelbase), Tolerance(1e-12));
  EXPECT_NEAR(speeds[1], yaw_rate * std::hypot(radius + half, p.wheelbase), Tolerance(1e-12));
  EXPECT_NEAR(speeds[2], yaw_rate * (radius - 0.5 * p.track_rear), Tolerance(1e-12));
  EXPECT_NEAR(speeds[3], yaw_rate * (radius + 0.5 * p.track_rear), Tolerance(1e-12));
}

std::string MessageOf(const std::string& xml) {
  try {
    const CarModel car({.xml = xml, .assets = {}}, "car.xml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

/// The Prius with one piece of text replaced.
std::string PriusWith(const std::string& from, const std::string& to) {
  std::string xml = ReadFile(FindModel("prius", ""));
  const std::size_t at = xml.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return xml.replace(at, from.size(), to);
}

TEST(CarModel, SaysWhatAModelLacks) {
  EXPECT_EQ(MessageOf(PriusWith("<site name=\"outline\"", "<site name=\"shape\"")),
            "car.xml: outline: the model has no box site of this name");
  const std::string bare = MessageOf("<mujoco/>");
  for (const char* name : {"chassis", "rack", "ground", "tyre_fl", "spin_rr", "steer_fr", "steer",
                           "drive", "brake_torque_front", "outline", "steering_ratio"}) {
    EXPECT_THAT(bare, testing::HasSubstr(std::string("car.xml: ") + name + ": "));
  }
}

TEST(CarModel, TellsWhatDoesNotCompileInOneLine) {
  EXPECT_EQ(MessageOf("<mujoco><worldbody><body/><oops/></worldbody></mujoco>"),
            "car.xml: does not compile: unrecognized element (<oops>)");
  EXPECT_EQ(MessageOf("<mujoco><worldbody><body name='a'><joint/></body></worldbody></mujoco>"),
            "car.xml: does not compile: mass and inertia of moving bodies must be larger than "
            "mjMINVAL ('a')");
  const TempFolder folder;
  const auto file = folder.Write("car.xml",
                                 "<mujoco>\n\n<worldbody>\n<body>\n\n<joint axis='x'/></body>"
                                 "</worldbody></mujoco>");
  try {
    const CarModel car(ComposeScene(file, {}), "car.xml");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "car.xml:6: does not compile: problem reading attribute 'axis' (<joint>)");
  }
}

TEST(CarModel, RefusesSteeringWithoutLimits) {
  EXPECT_THAT(MessageOf(PriusWith("kp=\"200000\" ctrllimited=\"true\"",
                                  "kp=\"200000\" ctrllimited=\"false\"")),
              testing::HasSubstr("car.xml: steer: must be an <intvelocity>"));
}

TEST(CarModel, RefusesARackThatStopsBeforeTheSteering) {
  EXPECT_EQ(
      MessageOf(PriusWith("<joint name=\"rack\" type=\"hinge\"",
                          "<joint name=\"rack\" type=\"hinge\" limited=\"true\" "
                          "range=\"-0.4 0.4\"")),
      "car.xml: rack: its range, -0.4 to 0.4 rad, stops before the -0.4869 to 0.4869 rad that "
      "steering needs; without <compiler angle=\"radian\"/> a range is in degrees");
}

TEST(CarModel, RefusesAnOutlineThatIsNotTheChassis) {
  std::string xml = PriusWith("<site name=\"outline\"", "<site name=\"shape\"");
  const std::string rack = "<body name=\"rack\"";
  const std::size_t inside = xml.find('>', xml.find(rack)) + 1;
  xml.insert(inside, "<site name=\"outline\" type=\"box\" size=\"2 1 1\"/>");
  EXPECT_EQ(MessageOf(xml),
            "car.xml: outline: must be a site of the body 'chassis'; it is on 'rack'");
}

TEST(CarModel, RefusesAFrameThatIsNotUnderTheRearAxle) {
  std::string xml =
      PriusWith("<body name=\"knuckle_rl\" pos=\"0 ", "<body name=\"knuckle_rl\" pos=\"0.5 ");
  EXPECT_THAT(MessageOf(xml), testing::HasSubstr("car.xml: chassis: the body's origin must lie"));
}

}  // namespace
}  // namespace trackbed
