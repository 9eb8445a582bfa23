#include "trackbed/fmu/export.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tinyxml2.h>

#include <array>
#include <cmath>
#include <limits>
#include <regex>
#include <set>
#include <thread>

#include "src/fmu/contents.h"
#include "src/fmu/model_description.h"
#include "src/fmu/resources.h"
#include "src/fmu/variables.h"
#include "tests/fmu/fmu_host.h"
#include "tests/support/error_text.h"
#include "tests/support/temp_folder.h"
#include "trackbed/core/error.h"
#include "trackbed/drive/drive.h"

// Exported FMUs, called as a host calls them. Comparisons with our own runs are bit for bit: both
// call the same loop with the same commands.
namespace trackbed::fmu_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

Scenario Shipped(const std::string& name, const std::vector<Override>& overrides = {}) {
  return ReadScenario(fs::path(TRACKBED_SOURCE_DIR) / "scenarios" / (name + ".yaml"), overrides);
}

RunLog OwnRun(const Scenario& scenario, const std::string& plant) {
  const CarModel car = LoadCar(scenario);
  return SimulateScenario(scenario, car, PlanScenario(scenario, car), plant);
}

/// The resources of an FMU in a folder, and the shared library of this build.
struct Exported {
  Exported(const Scenario& scenario, const std::string& plant)
      : period(scenario.drive.control_period), functions(fmu::FindLibrary()) {
    const Scenario own = fmu::ScenarioOfFmu(scenario, plant);
    resources = fmu::MakeResources(own);
    token = fmu::TokenOf(resources);
    variables = fmu::Variables(resources.at(fmu::kScenarioYaml), own);
    for (const auto& [name, content] : resources) {
      folder.Write("resources/" + name, content);
    }
  }

  [[nodiscard]] Host Instantiate() const { return {functions, folder.path(), token}; }

  [[nodiscard]] std::uint32_t Find(const std::string& name) const {
    for (std::uint32_t i = 0; i < variables.size(); ++i) {
      if (variables[i].name == name) {
        return i;
      }
    }
    ADD_FAILURE() << "no variable " << name;
    return 0;
  }

  /// Compares the columns of a row, except those that describe the command of the coming period.
  void ExpectRow(Host& host, const Table& log, std::size_t row) const {
    for (const std::string& column : log.columns()) {
      if (column != "steering_command_rad") {
        ASSERT_EQ(host.Get(Find(column)), log.at(row, static_cast<std::size_t>(log.Find(column))))
            << column << " in row " << row;
      }
    }
  }

  const TempFolder folder;
  double period;
  Functions functions;
  fmu::Resources resources;
  std::string token;
  std::vector<fmu::Variable> variables;
};

const std::vector<Override> kShort{"drive.time_limit=4"};

/// The kinematic car on a short piece of three_turns, exported once.

const Exported& Car() {
  static const Exported car(Shipped("three_turns", kShort), "kinematic");
  return car;
}

struct Case {
  const char* scenario;
  const char* plant;
};

class EveryFmu : public testing::TestWithParam<Case> {};

// Tyres, noise, replanning, and scenarios with files: a map, a path, a recording to replay, a road
// network, a track, and a recorded drive.
INSTANTIATE_TEST_SUITE_P(
    Scenarios, EveryFmu,
    testing::Values(Case{"three_turns", "mujoco"}, Case{"driven_turns", "mujoco:contact"},
                    Case{"disturbed", "single_track"}, Case{"obstacle_appears", "kinematic"},
                    Case{"depot", "kinematic"}, Case{"paths/from_a_file", "kinematic"},
                    Case{"playback_lane_change", "mujoco"}, Case{"roads/hill_pass", "mujoco"},
                    Case{"tracks/kidney_center", "kinematic"},
                    Case{"real/dart_ramp_02", "single_track"}),
    [](const auto& test) {
      const std::string name = test.param.scenario;
      return name.substr(name.rfind('/') + 1);
    });

/// Steps the scenario's controller, and compares each row with our own run.
void ExpectOwnRun(const Exported& exported, const Scenario& scenario, const std::string& plant) {
  const RunLog run = OwnRun(scenario, plant);
  const Table log = ToTable(run);
  Host host = exported.Instantiate();
  ASSERT_EQ(host.SetBoolean(fmu::kControllerSteers, true), fmi3OK) << host.TakeMessages();
  ASSERT_EQ(host.Initialize(), fmi3OK) << host.TakeMessages();
  const std::uint32_t command = exported.Find("steering_command_rad");
  const std::vector<double> commands = log.Column("steering_command_rad");
  for (std::size_t row = 0; row + 1 < log.rows(); ++row) {
    exported.ExpectRow(host, log, row);
    ASSERT_EQ(host.Step(static_cast<double>(row) * exported.period, exported.period), fmi3OK)
        << host.TakeMessages();
    // After a step, the FMU states the command of that step, which the log has in the row before.
    ASSERT_EQ(host.Get(command), commands[row]);
  }
  EXPECT_TRUE(host.ended);
  EXPECT_EQ(host.GetInteger(fmu::kStatus), 1 + static_cast<int>(run.status));
}

TEST_P(EveryFmu, DrivenByTheScenariosControllerIsTheRun) {
  const Scenario scenario = Shipped(GetParam().scenario, {"drive.time_limit=2"});
  const Exported exported(scenario, GetParam().plant);
  ExpectOwnRun(exported, scenario, GetParam().plant);
}

TEST(OwnModel, IsPartOfTheFmu) {
  const Scenario scenario =
      Shipped("three_turns", {"drive.time_limit=1", "vehicle.model=" TRACKBED_SOURCE_DIR
                                                    "/tests/data/models/small_car.xml"});
  const Exported exported(scenario, "mujoco");
  ExpectOwnRun(exported, scenario, "mujoco");
}

TEST(Fmu, SteeredByTheCommandsOfTheLogIsTheRun) {
  const Table log = ToTable(OwnRun(Shipped("three_turns", kShort), "kinematic"));
  Host host = Car().Instantiate();
  ASSERT_EQ(host.SetBoolean(fmu::kPlanSetsSpeed, true), fmi3OK);
  ASSERT_EQ(host.Initialize(), fmi3OK);
  const std::vector<double> commands = log.Column("steering_command_rad");
  for (std::size_t row = 0; row + 1 < log.rows(); ++row) {
    Car().ExpectRow(host, log, row);
    ASSERT_EQ(host.Set(fmu::kSteering, commands[row]), fmi3OK);
    ASSERT_EQ(host.Step(static_cast<double>(row) * Car().period, Car().period), fmi3OK);
  }
}

// A constant acceleration a on a straight line: v = v0 + a t.
TEST(Fmu, AcceleratesAsCommanded) {
  Host host = Car().Instantiate();
  ASSERT_EQ(host.Set(Car().Find("mission.speed"), 2.0), fmi3OK);
  ASSERT_EQ(host.Initialize(), fmi3OK);
  ASSERT_EQ(host.Set(fmu::kAcceleration, 0.5), fmi3OK);
  ASSERT_EQ(host.Step(0.0, 50 * Car().period), fmi3OK) << host.TakeMessages();
  // The sum of 1000 additions of 0.001 to a number below 4, each rounded by at most 2^-52.
  EXPECT_NEAR(host.Get(Car().Find("speed_mps")), 2.0 + 0.5 * 50 * Car().period, 1e-12);
  EXPECT_EQ(host.Get(fmu::kTime), 50 * Car().period);
}

TEST(Fmu, ParametersHaveTheEffectOfOverrides) {
  std::vector<Override> overrides = kShort;
  overrides.insert(overrides.end(), {"mission.speed=2", "mission.waypoints[1][0]=12.5"});
  const Table log = ToTable(OwnRun(Shipped("three_turns", overrides), "kinematic"));
  Host host = Car().Instantiate();
  ASSERT_EQ(host.Set(Car().Find("mission.speed"), 2.0), fmi3OK);
  ASSERT_EQ(host.Set(Car().Find("mission.waypoints[1][0]"), 12.5), fmi3OK);
  ASSERT_EQ(host.SetBoolean(fmu::kControllerSteers, true), fmi3OK);
  ASSERT_EQ(host.Initialize(), fmi3OK) << host.TakeMessages();
  Car().ExpectRow(host, log, 0);
  ASSERT_EQ(host.Step(0.0, 100 * Car().period), fmi3OK);
  Car().ExpectRow(host, log, 100);
}

TEST(Fmu, InstancesAreIndependent) {
  std::array<double, 3> ends{};
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    threads.emplace_back([&ends, i] {
      Host host = Car().Instantiate();
      host.Initialize();
      host.Set(fmu::kSteering, i == 1 ? 0.3 : 0.1);
      for (int step = 0; step < 50; ++step) {
        host.Step(step * Car().period, Car().period);
      }
      ends[i] = host.Get(Car().Find("yaw_rad"));
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  EXPECT_EQ(ends[0], ends[2]);
  EXPECT_GT(ends[1], ends[0]);
  EXPECT_GT(ends[0], 0.0);
}

/// Steps with changing commands, and returns the outputs after each step.
std::vector<double> Drive(Host& host, int from, int to) {
  std::vector<double> outputs;
  for (int step = from; step < to; ++step) {
    EXPECT_EQ(host.Set(fmu::kSteering, 0.2 * std::sin(0.1 * step)), fmi3OK);
    EXPECT_EQ(host.Set(fmu::kAcceleration, 0.3), fmi3OK);
    EXPECT_EQ(host.Step(step * Car().period, Car().period), fmi3OK) << host.TakeMessages();
    for (const char* name : {"x_m", "y_m", "yaw_rad", "speed_mps", "s_m"}) {
      outputs.push_back(host.Get(Car().Find(name)));
    }
  }
  return outputs;
}

TEST(Fmu, ContinuesFromASavedState) {
  Host host = Car().Instantiate();
  ASSERT_EQ(host.Set(Car().Find("mission.speed"), 2.5), fmi3OK);
  ASSERT_EQ(host.Initialize(), fmi3OK);
  Drive(host, 0, 30);
  fmi3FMUState state = host.Save();
  ASSERT_NE(state, nullptr) << host.TakeMessages();
  const Bytes bytes = host.Serialize(state);
  const std::vector<double> first = Drive(host, 30, 60);
  ASSERT_EQ(host.Restore(state), fmi3OK);
  EXPECT_EQ(host.Get(fmu::kTime), 30 * Car().period);
  EXPECT_EQ(Drive(host, 30, 60), first);
  host.Free(state);
  // Another instance, with other parameters.
  Host other = Car().Instantiate();
  fmi3FMUState read = other.Deserialize(bytes);
  ASSERT_NE(read, nullptr) << other.TakeMessages();
  ASSERT_EQ(other.Restore(read), fmi3OK);
  EXPECT_EQ(other.Get(Car().Find("mission.speed")), 2.5);
  EXPECT_EQ(Drive(other, 30, 60), first);
  EXPECT_EQ(other.Serialize(read), bytes);
  other.Free(read);
}

TEST(Fmu, RefusesDamagedStates) {
  Host host = Car().Instantiate();
  ASSERT_EQ(host.Initialize(), fmi3OK);
  Drive(host, 0, 3);
  fmi3FMUState state = host.Save();
  const Bytes bytes = host.Serialize(state);
  host.Free(state);
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    const Bytes prefix(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length));
    ASSERT_EQ(host.Deserialize(prefix), nullptr) << length;
    ASSERT_EQ(host.status, fmi3Error);
    ASSERT_FALSE(host.TakeMessages().empty());
  }
  Bytes longer = bytes;
  longer.push_back(0);
  EXPECT_EQ(host.Deserialize(longer), nullptr);
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    Bytes changed = bytes;
    changed[at] ^= 0x40U;
    ASSERT_EQ(host.Deserialize(changed), nullptr) << "byte " << at;
    ASSERT_EQ(host.status, fmi3Error);
  }
}

TEST(Fmu, SaysWhatIsWrong) {
  Host host = Car().Instantiate();
  const std::uint32_t speed = Car().Find("mission.speed");
  EXPECT_EQ(host.Step(0.0, 0.02), fmi3Error);
  EXPECT_THAT(host.TakeMessages(), HasSubstr("only allowed after the initialization"));
  host.Get(Car().Find("x_m"));
  EXPECT_THAT(host.TakeMessages(), HasSubstr("x_m is an output, which is known from the init"));
  EXPECT_EQ(host.Set(9999, 1.0), fmi3Error);
  EXPECT_THAT(host.TakeMessages(), HasSubstr("no variable with the value reference 9999"));
  EXPECT_EQ(host.Set(Car().Find("x_m"), 1.0), fmi3Error);
  EXPECT_THAT(host.TakeMessages(), HasSubstr("x_m is an output, which cannot be set"));
  EXPECT_EQ(host.Set(fmu::kSteering, std::numeric_limits<double>::quiet_NaN()), fmi3Error);
  EXPECT_THAT(host.TakeMessages(), HasSubstr("commanded_steering_rad is nan; must be finite"));
  EXPECT_EQ(host.SetBoolean(speed, true), fmi3Error);
  EXPECT_THAT(host.TakeMessages(), HasSubstr("mission.speed is of the type real, not Boolean"));
  // A value that the scenario refuses.
  EXPECT_EQ(host.Set(speed, -1.0), fmi3OK);
  EXPECT_EQ(host.Initialize(), fmi3Error);
  EXPECT_THAT(host.TakeMessages(),
              testing::StartsWith("mission.speed: -1 is out of range; must be at least 0.1"));
  EXPECT_EQ(host.Set(speed, 3.0), fmi3OK);
  EXPECT_EQ(host.ExitInitialization(), fmi3OK) << host.TakeMessages();
  EXPECT_EQ(host.Set(speed, 2.0), fmi3Error);
  EXPECT_THAT(host.TakeMessages(), HasSubstr("mission.speed is a fixed parameter"));
  EXPECT_EQ(host.Step(0.0, 0.03), fmi3Error);
  EXPECT_THAT(
      host.TakeMessages(),
      HasSubstr("the step size is 0.03 s; must be a multiple of the control period, 0.02 s"));
  EXPECT_EQ(host.Step(1.0, 0.02), fmi3Error);
  EXPECT_THAT(host.TakeMessages(), HasSubstr("the step begins at 1 s, but the FMU is at 0 s"));
  for (const double step : {0.0, -0.02, 0.01, 1e300, std::numeric_limits<double>::infinity(),
                            std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_EQ(host.Step(0.0, step), fmi3Error) << step;
    EXPECT_THAT(host.TakeMessages(), HasSubstr("must be a multiple of the control period"));
  }
  EXPECT_EQ(host.Call("fmi3EnterEventMode"), fmi3Error);
  EXPECT_THAT(host.TakeMessages(), HasSubstr("fmi3EnterEventMode is not supported"));
  // The run ends within the step, after 4 s.
  EXPECT_EQ(host.Step(0.0, 10.0), fmi3OK) << host.TakeMessages();
  EXPECT_TRUE(host.ended);
  EXPECT_EQ(host.time_reached, 4.0);
  EXPECT_EQ(host.Step(4.0, 0.02), fmi3Error);
  EXPECT_THAT(host.TakeMessages(), HasSubstr("the run ended at 4 s (time_limit)"));
  // A reset makes the FMU usable again.
  EXPECT_EQ(host.Call("fmi3Reset"), fmi3OK);
  EXPECT_EQ(host.Initialize(), fmi3OK);
  EXPECT_EQ(host.Step(0.0, 0.02), fmi3OK);
}

// A host that adds step sizes reaches times that are off by the rounding of each addition.
TEST(Fmu, ToleratesTheRoundingOfTheHostsTimes) {
  Host host = Car().Instantiate();
  ASSERT_EQ(host.EnterInitialization(1e6), fmi3OK);
  ASSERT_EQ(host.ExitInitialization(), fmi3OK);
  double time = 1e6;
  for (int i = 0; i < 150; ++i) {
    ASSERT_EQ(host.Step(time, Car().period), fmi3OK) << host.TakeMessages();
    time += Car().period;
  }
}

TEST(Fmu, NeedsItsOwnResources) {
  const Host wrong_token(Car().functions, Car().folder.path(), "{another}");
  EXPECT_FALSE(wrong_token.exists());
  const Host nowhere(Car().functions, Car().folder.path() / "none", Car().token);
  EXPECT_FALSE(nowhere.exists());
}

TEST(Fmu, DescribesEachVariableOnce) {
  tinyxml2::XMLDocument document;
  const std::string text =
      fmu::ModelDescription({.name = "car", .token = Car().token, .control_period = Car().period},
                            Car().variables, FmiVersion::k3);
  ASSERT_EQ(document.Parse(text.c_str()), tinyxml2::XML_SUCCESS);
  const tinyxml2::XMLElement* root = document.RootElement();
  EXPECT_EQ(root->Attribute("instantiationToken"), Car().token);
  std::set<std::string> units;
  for (const auto* unit = root->FirstChildElement("UnitDefinitions")->FirstChildElement();
       unit != nullptr; unit = unit->NextSiblingElement()) {
    units.insert(unit->Attribute("name"));
  }
  std::set<std::string> names;
  std::size_t count = 0;
  for (const auto* variable = root->FirstChildElement("ModelVariables")->FirstChildElement();
       variable != nullptr; variable = variable->NextSiblingElement()) {
    EXPECT_TRUE(names.insert(variable->Attribute("name")).second);
    EXPECT_EQ(variable->UnsignedAttribute("valueReference"), count++);
    if (const char* unit = variable->Attribute("unit")) {
      EXPECT_TRUE(units.contains(unit)) << unit;
    }
  }
  EXPECT_EQ(count, Car().variables.size());
  for (const char* name : {"world.friction", "control.speed.gain", "mission.waypoints[4][1]",
                           "drive.timestep", "seed", "cross_track_m"}) {
    EXPECT_TRUE(names.contains(name)) << name;
  }
  for (const char* name : {"drive.control_period", "render.fps", "expect.reach_goal"}) {
    EXPECT_FALSE(names.contains(name)) << name;
  }
}

TEST(ExportFmu, WritesAnArchiveThatRunsByItself) {
  const TempFolder folder;
  const fs::path file = folder.path() / "car.fmu";
  const Scenario scenario = Shipped("three_turns", kShort);
  ExportFmu(scenario, "mujoco", file);
  EXPECT_EQ(folder.Names(), std::vector<std::string>{"car.fmu"});
  EXPECT_TRUE(ReadFile(file).ends_with(kFmuMark));
  const std::map<std::string, std::string> entries = Unzipped(file);
  for (const auto& [name, content] : entries) {
    if (!name.starts_with("binaries/")) {
      EXPECT_THAT(content, testing::Not(HasSubstr(TRACKBED_SOURCE_DIR))) << name;
      EXPECT_THAT(content, testing::Not(HasSubstr(fs::temp_directory_path().string()))) << name;
    }
  }
  EXPECT_EQ(entries.count("resources/scenario.yaml"), 1U);
  EXPECT_EQ(entries.count("resources/vehicle.xml"), 1U);
  for (const auto& [name, content] : entries) {
    if (name.starts_with("binaries/") && !name.ends_with("/trackbed.so")) {
      const std::string line = "\n" + fs::path(name).filename().string() + ": ";
      EXPECT_THAT(entries.at("documentation/licenses/license.txt"), HasSubstr(line));
    }
  }
  Extract(entries, folder.path());
  tinyxml2::XMLDocument document;
  ASSERT_EQ(document.Parse(entries.at("modelDescription.xml").c_str()), tinyxml2::XML_SUCCESS);
  const Functions functions(folder.path() / "binaries/x86_64-linux/trackbed.so");
  Host host(functions, folder.path(), document.RootElement()->Attribute("instantiationToken"));
  ASSERT_TRUE(host.exists()) << host.TakeMessages();
  ASSERT_EQ(host.Initialize(), fmi3OK) << host.TakeMessages();
  EXPECT_EQ(host.Step(0.0, 1.0), fmi3OK) << host.TakeMessages();
  EXPECT_GT(host.Get(fmu::kTime), 0.9);
}

TEST(ExportFmu, RefusesWhatCannotBeStepped) {
  const TempFolder folder;
  const Scenario scenario = Shipped("three_turns");
  EXPECT_THAT(ErrorText([&] { ExportFmu(scenario, "recorded", folder.path() / "car.fmu"); }),
              HasSubstr("a recorded drive, which does not react to commands"));
  // No plan: the goal is behind a wall.
  const Scenario blocked = Shipped("three_turns", {"mission.waypoints=[[0, 0], [1, 0], [0, 0]]"});
  EXPECT_THAT(ErrorText([&] { ExportFmu(blocked, "kinematic", folder.path() / "car.fmu"); }),
              HasSubstr("the FMU would not start: no plan"));
  EXPECT_TRUE(folder.Names().empty());
}

}  // namespace
}  // namespace trackbed::fmu_test
