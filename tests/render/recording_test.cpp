// Tests how a run folder is read for films: poses between rows, selection of plants, scales and
// replans.

#include "render/recording.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/render/run_folder.h"
#include "tests/support/temp_folder.h"
#include "tests/tolerance.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/sim/mujoco_error.h"

namespace trackbed::render {
namespace {

class RecordingTest : public testing::Test {
 protected:
  RecordingTest() { CopyPrius(folder_.path()); }

  const MujocoErrorScope errors_;
  TempFolder folder_;
};

TEST_F(RecordingTest, PosesTheCarBetweenRows) {
  WritePlant(folder_.path(), "mujoco", 1.0, [](double time) {
    return CarPlace{3.0 * time, -2.0 * time, 0.6 * time};
  });
  const Recording recording = ReadRecording(folder_.path());
  const MujocoData data = MakeMujocoData(*recording.model);
  const double time = 0.5 + 1.0 / 120.0;  // half way between two rows
  recording.plants[0].Pose(time, *recording.model, *data);
  const int chassis = mj_name2id(recording.model.get(), mjOBJ_BODY, "chassis");
  const mjtNum* place = data->xpos + 3 * chassis;
  const mjtNum* axes = data->xmat + 9 * chassis;
  // Positions are linear in time, so only rounding remains. The normalized mean of two rotations
  // about one axis is exactly the rotation halfway between.
  EXPECT_NEAR(place[0], 3.0 * time, Tolerance(1e-12));
  EXPECT_NEAR(place[1], -2.0 * time, Tolerance(1e-12));
  EXPECT_NEAR(std::atan2(axes[3], axes[0]), 0.6 * time, Tolerance(1e-12));
  EXPECT_NEAR(recording.plants[0].Heading(time), 0.6 * time, Tolerance(1e-12));
}

TEST_F(RecordingTest, ReadsTheDriverAidsThatIntervene) {
  WritePlant(folder_.path(), "mujoco", 1.0, [](double) { return CarPlace{}; });
  EXPECT_FALSE(ReadRecording(folder_.path()).ReadingsAt(0.5).aids.has_value());
  for (const std::string wheel : {"fl", "fr", "rl", "rr"}) {
    SetLogColumn(folder_.path(), "mujoco", "abs_active_" + wheel, [&](double time) {
      return wheel == "fr" && time > 0.39 && time < 0.81 ? 1.0 : 0.0;
    });
    SetLogColumn(folder_.path(), "mujoco", "esc_brake_torque_" + wheel + "_Nm",
                 [&](double time) { return wheel == "rl" && time > 0.59 ? 30.0 : 0.0; });
  }
  const Recording recording = ReadRecording(folder_.path());
  EXPECT_EQ(recording.ReadingsAt(0.3).aids, "-");
  EXPECT_EQ(recording.ReadingsAt(0.5).aids, "ABS");
  EXPECT_EQ(recording.ReadingsAt(0.7).aids, "ABS ESC");
  EXPECT_EQ(recording.ReadingsAt(0.9).aids, "ESC");
}

TEST_F(RecordingTest, TurnsTheShortWayWhenTheQuaternionChangesSign) {
  // The half angle of the rotation passes the angle pi between 0.5 s and 1 s. The cosine and the
  // sine of the half angle are continuous, so the quaternion q does not jump. Negating the second
  // row makes q jump without changing the rotation.
  std::string header = "t_s,x_m,y_m,z_m,qw,qx,qy,qz";
  std::string zeros;
  for (const std::string& column : PriusJointColumns()) {
    header += "," + column;
    zeros += ",0";
  }
  WritePlant(folder_.path(), "mujoco", 1.0, [](double) { return CarPlace{}; });
  WriteFileAtomically(
      folder_.path() / "mujoco.state.csv",
      header + "\n0,0,0,0,0.8,0,0,0.6" + zeros + "\n1,0,0,0,-0.6,0,0,-0.8" + zeros + "\n");
  const Recording recording = ReadRecording(folder_.path());
  const MujocoData data = MakeMujocoData(*recording.model);
  recording.plants[0].Pose(0.5, *recording.model, *data);
  // Half angles atan2(0.6, 0.8) and atan2(0.8, 0.6) average to pi / 4: the car faces north.
  const int chassis = mj_name2id(recording.model.get(), mjOBJ_BODY, "chassis");
  EXPECT_NEAR(data->xmat[9 * chassis + 3], 1.0, Tolerance(1e-12));
}

TEST_F(RecordingTest, HoldsTheFirstAndTheLastState) {
  WritePlant(folder_.path(), "mujoco", 1.0, [](double time) { return CarPlace{time, 0.0, 0.0}; });
  const Recording recording = ReadRecording(folder_.path());
  EXPECT_DOUBLE_EQ(recording.plants[0].Position(-5.0).x, 0.0);
  EXPECT_DOUBLE_EQ(recording.plants[0].Position(7.0).x, 1.0);
}

TEST_F(RecordingTest, FollowsTheHeadingThroughWholeTurns) {
  WritePlant(folder_.path(), "mujoco", 20.0, [](double time) {
    return CarPlace{0.0, 0.0, -0.5 * time};
  });
  const Recording recording = ReadRecording(folder_.path());
  EXPECT_NEAR(recording.plants[0].Heading(20.0), -10.0, Tolerance(1e-9));
}

TEST_F(RecordingTest, ShowsTheMujocoPlantAsTheCar) {
  for (const char* plant :
       {"kinematic", "mujoco-magic_formula", "mujoco-contact", "single_track"}) {
    WritePlant(folder_.path(), plant, 0.1, [](double) { return CarPlace{}; });
  }
  const Recording recording = ReadRecording(folder_.path());
  std::vector<std::string> names;
  for (const PlantRecording& plant : recording.plants) {
    names.push_back(plant.plant());
  }
  EXPECT_EQ(names, (std::vector<std::string>{"mujoco:contact", "mujoco:magic_formula", "kinematic",
                                             "single_track"}));
}

TEST_F(RecordingTest, TakesThePlantsThatAreAskedForByTheirNames) {
  for (const char* plant : {"kinematic", "mujoco-contact"}) {
    WritePlant(folder_.path(), plant, 0.1, [](double) { return CarPlace{}; });
  }
  const auto message = [this](const std::vector<std::string>& plants) -> std::string {
    try {
      ReadRecording(folder_.path(), plants);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no InputError";
  };
  EXPECT_EQ(ReadRecording(folder_.path(), {"mujoco:contact"}).plants.front().plant(),
            "mujoco:contact");
  const std::string where = folder_.path().string() + ": plants: ";
  EXPECT_EQ(message({"mujoco:contract"}),
            where + "unknown plant 'mujoco:contract'; did you mean 'mujoco:contact'?");
  EXPECT_EQ(message({"kinematic", "kinematic"}), where + "'kinematic' is listed twice");
}

TEST_F(RecordingTest, NamesMissingFilesOfTheRun) {
  WritePlant(folder_.path(), "mujoco", 0.1, [](double) { return CarPlace{}; });
  const auto message = [this]() -> std::string {
    try {
      ReadRecording(folder_.path());
    } catch (const InputError& error) {
      return error.what();
    }
    return "no InputError";
  };
  const auto in_folder = [this](const char* name) { return (folder_.path() / name).string(); };
  WriteFileAtomically(in_folder("metrics.json"),
                      R"({"plants": {"mujoco": {}, "mujoco:magic_formula": {}}})");
  EXPECT_EQ(message(), in_folder("mujoco-magic_formula.state.csv") +
                           ": missing from the run folder, whose metrics.json lists a run on "
                           "mujoco:magic_formula");
  WriteFileAtomically(in_folder("metrics.json"), "{}");
  EXPECT_THAT(message(), testing::StartsWith(in_folder("metrics.json") + ": plants: "));
  WriteFileAtomically(in_folder("metrics.json"), R"({"plants": {"mujoco": {}}})");
  EXPECT_EQ(message(), "no InputError");
  WriteFileAtomically(in_folder("plan.json"), "{}");
  EXPECT_EQ(message(),
            in_folder("plan.csv") + ": missing from the run folder, which has plan.json");
}

TEST_F(RecordingTest, ScalesAreTheLargestOfAllThatAreShownTogether) {
  for (const char* plant : {"kinematic", "mujoco"}) {
    WritePlant(folder_.path(), plant, 1.0, [](double) { return CarPlace{}; });
  }
  WritePlant(folder_.path(), "kinematic", 3.0, [](double) { return CarPlace{}; });
  WriteStraightPlan(folder_.path(), 5.0);
  SetLogColumn(folder_.path(), "mujoco", "cross_track_m", [](double time) { return -0.7 * time; });
  SetLogColumn(folder_.path(), "kinematic", "steering_rad", [](double) { return -0.3; });
  std::vector<Recording> recordings;
  for (const char* plant : {"kinematic", "mujoco"}) {
    recordings.push_back(ReadRecording(folder_.path(), {plant}));
  }
  EXPECT_DOUBLE_EQ(recordings[0].scales.error, 0.05);
  EXPECT_DOUBLE_EQ(recordings[0].scales.steering, 0.3);
  EXPECT_DOUBLE_EQ(recordings[1].scales.error, 1.0);
  EXPECT_DOUBLE_EQ(recordings[1].scales.steering, 0.1);  // set by the option
  EXPECT_DOUBLE_EQ(recordings[1].scales.end, 1.0);
  ShareScales(recordings);
  for (const Recording& recording : recordings) {
    EXPECT_DOUBLE_EQ(recording.scales.end, 3.0);
    EXPECT_DOUBLE_EQ(recording.scales.error, 1.0);
    EXPECT_DOUBLE_EQ(recording.scales.steering, 0.3);
  }
}

TEST_F(RecordingTest, ReadsTheLogBetweenRows) {
  WritePlant(folder_.path(), "mujoco", 1.0, [](double) { return CarPlace{}; });
  WriteFileAtomically(
      folder_.path() / "mujoco.csv",
      "t_s,speed_mps,steering_command_rad,steering_rad,cross_track_m\n0,1,0.5,0.3,-1\n1,3,0,0,1\n");
  const Recording recording = ReadRecording(folder_.path());
  const Readings readings = recording.plants[0].ReadingsAt(0.25);
  EXPECT_DOUBLE_EQ(readings.speed, 1.5);
  EXPECT_DOUBLE_EQ(readings.steering_command, 0.375);
  EXPECT_DOUBLE_EQ(readings.steering, 0.3 - 0.25 * 0.3);
  ASSERT_TRUE(readings.cross_track.has_value());
  EXPECT_DOUBLE_EQ(*readings.cross_track, -0.5);
}

TEST_F(RecordingTest, ReadsThePlansThatTheCarTookUpAndNoGhosts) {
  for (const char* plant : {"mujoco", "kinematic"}) {
    WritePlant(folder_.path(), plant, 1.0, [](double) { return CarPlace{}; });
  }
  WriteStraightPlan(folder_.path(), 5.0);
  WriteNewPlans(folder_.path(), "kinematic", {{0.1, 7.0, 1.0}});
  EXPECT_TRUE(ReadRecording(folder_.path()).new_plans.empty());

  WriteNewPlans(folder_.path(), "mujoco", {{0.25, 2.0, 4.0}, {0.5, -3.0, 6.0}});
  const Recording recording = ReadRecording(folder_.path());
  ASSERT_EQ(recording.new_plans.size(), 2U);
  EXPECT_EQ(recording.new_plans[0].from, 0.25);
  EXPECT_EQ(recording.new_plans[0].path.size(), 41U);  // a point each 0.1 m
  EXPECT_EQ(recording.new_plans[0].path.back().x, 4.0);
  EXPECT_EQ(recording.new_plans[0].path.back().y, 2.0);
  EXPECT_EQ(recording.new_plans[1].from, 0.5);
  EXPECT_EQ(recording.new_plans[1].path.size(), 61U);
  EXPECT_EQ(recording.new_plans[1].path.front().x, 0.0);
  EXPECT_EQ(recording.new_plans[1].path.front().y, -3.0);
  EXPECT_EQ(recording.plan.size(), 51U);
}

TEST_F(RecordingTest, HasConesAndNotesOfTheRun) {
  WritePlant(folder_.path(), "mujoco", 1.0, [](double) { return CarPlace{}; });
  EXPECT_TRUE(ReadRecording(folder_.path()).cones.empty());
  EXPECT_EQ(ReadRecording(folder_.path()).note, "");
  WriteStraightPlan(folder_.path(), 5.0);
  WriteFileAtomically(folder_.path() / "plan.json",
                      R"({"gates": [{"cones_m": [[1, 2], [3, 4]]}, {"cones_m": [[5, 6]]}]})");
  WriteFileAtomically(folder_.path() / "scenario.resolved.yaml",
                      "schema: 1\nvehicle: {model: gone, steering_rate: 0.8}\n");
  const Recording recording = ReadRecording(folder_.path());
  ASSERT_EQ(recording.cones.size(), 3U);
  EXPECT_EQ(recording.cones[2].x, 5.0);
  EXPECT_EQ(recording.cones[2].y, 6.0);
  EXPECT_EQ(recording.note, "steering rate set to 0.80 rad/s");
  WriteFileAtomically(folder_.path() / "plan.json", R"({"gates": [{}]})");
  EXPECT_THROW(ReadRecording(folder_.path()), InputError);
}

TEST_F(RecordingTest, RefusesBrokenPlans) {
  WritePlant(folder_.path(), "mujoco", 1.0, [](double) { return CarPlace{}; });
  const auto message = [this](const std::string& name, const std::string& text) {
    WriteFileAtomically(folder_.path() / name, text);
    std::string what = "no exception";
    try {
      ReadRecording(folder_.path());
    } catch (const InputError& error) {
      what = error.what();
    }
    std::filesystem::remove(folder_.path() / name);
    return what;
  };
  const std::string plan = (folder_.path() / "plan.csv").string();
  EXPECT_EQ(message("plan.csv", "s_m,x_m,y_m\n0,0,0\n1,1,inf\n"),
            plan + ": y_m: row 2: not finite");

  const char* name = "mujoco.plan.csv";
  const std::string file = (folder_.path() / name).string();
  EXPECT_EQ(message(name, "x_m,y_m\n0,0\n"), file + ": from_t_s: no such column");
  EXPECT_EQ(message(name, "from_t_s,y_m\n0,0\n"), file + ": x_m: no such column");
  EXPECT_EQ(message(name, "from_t_s,x_m\n0,0\n"), file + ": y_m: no such column");
  EXPECT_EQ(message(name, "from_t_s,x_m,y_m\n0,0,0\n0,1,x\n"),
            file + ":3: cell 3 (y_m): 'x' is not a number");
  EXPECT_EQ(message(name, "from_t_s,x_m,y_m\n0,0,0\nnan,1,0\n"),
            file + ": from_t_s: row 2: not finite");
  EXPECT_EQ(message(name, "from_t_s,x_m,y_m\n0,nan,0\n"), file + ": x_m: row 1: not finite");
  EXPECT_EQ(message(name, "from_t_s,x_m,y_m\n2,0,0\n2,1,0\n1.5,0,0\n"),
            file + ": from_t_s: row 3: 1.5 comes before 2");
  std::filesystem::create_directory(file);
  EXPECT_THROW(ReadRecording(folder_.path()), InputError);
}

}  // namespace
}  // namespace trackbed::render
