#include "trackbed/identify/identify.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>
#include <string>

#include "tests/support/temp_folder.h"
#include "tests/tolerance.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/core/file_name.h"
#include "trackbed/core/hash.h"
#include "trackbed/identify/identify_files.h"
#include "trackbed/scenario/record_scenario.h"
#include "trackbed/sim/car_parameters.h"
#include "trackbed/sim/plant.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr double kPeriod = 0.02;  // [s]

/// Noise of a record.
struct Noise {
  double yaw_rate = 0.0;  // standard deviation [rad/s]
  unsigned seed = 7;
};

/// Tests whether Identify finds the known parameters of a car from its recorded drives.
class IdentifiedCar : public testing::Test {
 protected:
  IdentifiedCar() {
    std::string xml = ReadFile(fs::path(TRACKBED_SOURCE_DIR) / "tests/data/models/small_car.xml");
    const std::string begin = "<custom>";
    xml.insert(xml.find(begin) + begin.size(),
               R"(<numeric name="steering_dead_time" data="0.03"/>)"
               R"(<numeric name="steering_time_constant" data="0.05"/>)");
    model_ = folder_.Write("car.xml", xml);
  }

  CarModel Base() const { return {ComposeScene(model_, {}), model_.string()}; }

  /// Records a drive of the car with the parameters `truth`. The car accelerates from 1 to 3 m/s
  /// and steers with two frequencies, within the steering rate.
  RecordedDrive Drive(const std::string& plant_name, const std::vector<CarParameter>& truth,
                      const Noise& noise = {}, double duration = 12.0) const {
    const CarModel base = Base();
    const CarModel car(WithCarParameters(base, truth), "truth");
    PlaybackOptions playback;
    for (int i = 0; i * kPeriod < duration + kPeriod; ++i) {
      const double t = i * kPeriod;
      playback.recording.steering.knots.emplace_back(
          t, 0.12 * std::sin(2.0 * t) + 0.06 * std::sin(4.7 * t));
      playback.recording.speed.knots.emplace_back(t, 1.0 + 2.0 * t / duration);
    }
    const World world;
    const auto plant = MakePlant(plant_name, {.car = car, .world = world, .start = {.speed = 1.0}});
    std::mt19937_64 generator(noise.seed);
    std::normal_distribution<double> normal;
    RecordedDrive drive{.name = "drive", .period = kPeriod, .has_steering_command = true};
    const double l = car.params().cg_to_rear;
    for (int i = 0; i * kPeriod <= duration; ++i) {
      const double t = i * kPeriod;
      const VehicleState state = plant->Observe();
      drive.samples.push_back(
          {.time = t,
           .pose = state.pose,
           .velocity_V = {state.speed, state.lateral_speed - l * state.yaw_rate},
           .yaw_rate = state.yaw_rate + noise.yaw_rate * normal(generator),
           .steering_command = playback.recording.steering.At(t)});
      const Command command{
          .steering = PlaybackSteering(playback, t, state.speed, kPeriod),
          .acceleration = *PlaybackAcceleration(playback, t, state.speed, 20.0, kPeriod)};
      for (int k = 0; k < std::lround(kPeriod / car.timestep()); ++k) {
        plant->Step(command);
      }
    }
    return drive;
  }

  Scenario Record(RecordedDrive drive, const std::string& plant) const {
    Scenario scenario =
        RecordScenario(std::make_shared<const RecordedDrive>(std::move(drive)), model_.string());
    scenario.drive.plants = {kRecordedPlant, plant};
    scenario.record->windows = {2.0};
    return scenario;
  }

  Identification Study(const std::string& plant, RecordedDrive drive,
                       std::vector<IdentifiedParameter> parameters) const {
    Identification study{.name = "study", .plant = plant};
    study.parameters = std::move(parameters);
    study.fit_scenarios = {Record(std::move(drive), plant)};
    study.steering_offset = false;
    study.starts = 1;
    study.loss = RobustLoss::kSquared;
    study.file = "study.yaml";
    return study;
  }

  TempFolder folder_;
  fs::path model_;
};

const std::vector<CarParameter> kTruth{{.name = "p_ky1_front", .value = -6.0},
                                       {.name = "p_ky1_rear", .value = -9.0},
                                       {.name = "steering_dead_time", .value = 0.047},
                                       {.name = "steering_time_constant", .value = 0.08},
                                       {.name = "yaw_inertia", .value = 0.06}};

std::vector<IdentifiedParameter> FiveParameters() {
  return {{.name = "p_ky1_front", .from = -15.0, .to = -3.0},
          {.name = "p_ky1_rear", .from = -20.0, .to = -3.0},
          {.name = "steering_dead_time", .from = 0.0, .to = 0.1},
          {.name = "steering_time_constant", .from = 0.01, .to = 0.2},
          {.name = "yaw_inertia", .from = 0.02, .to = 0.1}};
}

TEST_F(IdentifiedCar, FindsTheCarThatWasDriven) {
  const IdentificationResult result =
      Identify(Study("single_track", Drive("single_track", kTruth), FiveParameters()));
  ASSERT_EQ(result.parameters.size(), kTruth.size());
  // The windows restart at the exact states of the car. The search ends when its steps are below
  // 1e-4 of the bounds' widths. With residuals that vanish, Gauss-Newton steps converge
  // quadratically.
  for (std::size_t i = 0; i < kTruth.size(); ++i) {
    const ParameterEstimate& estimate = result.parameters[i];
    const double width = estimate.parameter.to - estimate.parameter.from;
    EXPECT_NEAR(estimate.value, kTruth[i].value, Tolerance(2e-4) * width) << kTruth[i].name;
    EXPECT_EQ(estimate.status, ParameterStatus::kIdentified) << kTruth[i].name;
  }
  EXPECT_LT(result.cost, 1e-6 * result.start_cost);
}

TEST_F(IdentifiedCar, KnowsHowFarNoiseLeadsIt) {
  const std::vector<IdentifiedParameter> parameters{
      {.name = "p_ky1_front", .from = -15.0, .to = -3.0},
      {.name = "steering_time_constant", .from = 0.01, .to = 0.2}};
  const std::vector<CarParameter> truth{kTruth[0], kTruth[3]};
  constexpr int kDrives = 12;
  double squares = 0.0;
  for (int i = 0; i < kDrives; ++i) {
    const Noise noise{.yaw_rate = 0.05, .seed = 10U + static_cast<unsigned>(i)};
    const IdentificationResult result =
        Identify(Study("single_track", Drive("single_track", truth, noise, 30.0), parameters));
    for (std::size_t k = 0; k < truth.size(); ++k) {
      const ParameterEstimate& estimate = result.parameters[k];
      ASSERT_TRUE(estimate.standard_error) << truth[k].name << ": " << estimate.remark;
      const double off = (estimate.value - truth[k].value) / *estimate.standard_error;
      squares += off * off;
    }
  }
  // The sum of 24 squared normal variables is between 7.4 and 52 in 99.9 % of all cases. The
  // standard errors are estimated from 15 windows, so they are accurate to about 20 %.
  EXPECT_GT(squares, 7.4 / 1.44);
  EXPECT_LT(squares, 52.0 * 1.44);
}

TEST_F(IdentifiedCar, SaysWhatTheRecordsDoNotTell) {
  // Tyre forces are proportional to the load, so the motion depends on the mass and the yaw inertia
  // only through their ratio. Linear tyres have no peak.
  std::vector<IdentifiedParameter> parameters = FiveParameters();
  parameters.push_back({.name = "mass", .from = 2.0, .to = 5.0});
  parameters.push_back({.name = "p_dy1_front", .from = 0.5, .to = 1.5});
  const IdentificationResult result =
      Identify(Study("single_track", Drive("single_track", kTruth), parameters));
  const ParameterEstimate& peak = *result.Find("p_dy1_front");
  EXPECT_EQ(peak.status, ParameterStatus::kNotIdentified);
  EXPECT_EQ(peak.value, 0.9);  // the value of the model
  EXPECT_THAT(peak.remark, HasSubstr("no effect on the plant single_track"));
  const bool mass = result.Find("mass")->status == ParameterStatus::kNotIdentified;
  const bool inertia = result.Find("yaw_inertia")->status == ParameterStatus::kNotIdentified;
  EXPECT_TRUE(mass != inertia) << "one of the two is held, the other makes up for it";
  const auto json = ToJson(result);
  EXPECT_TRUE(json["parameters"].back()["value"].is_null());
  EXPECT_EQ(json["parameters"].back()["status"], "not_identified");
}

TEST_F(IdentifiedCar, TellsNothingFromACarThatGoesStraight) {
  RecordedDrive drive = Drive("single_track", kTruth);
  for (RecordedSample& sample : drive.samples) {
    sample.pose = {sample.time * 2.0, 0.0, 0.0};
    sample.velocity_V = {2.0, 0.0};
    sample.yaw_rate = 0.0;
    sample.steering_command = 0.0;
  }
  const IdentificationResult result =
      Identify(Study("single_track", std::move(drive), FiveParameters()));
  for (const ParameterEstimate& estimate : result.parameters) {
    EXPECT_EQ(estimate.status, ParameterStatus::kNotIdentified) << estimate.parameter.name;
    EXPECT_FALSE(estimate.standard_error) << estimate.parameter.name;
  }
}

TEST_F(IdentifiedCar, FindsATyrePeakOnMujoco) {
  const std::vector<CarParameter> truth{{.name = "p_dy1", .value = 0.7},
                                        {.name = "p_ky1", .value = -10.0}};
  RecordedDrive drive = Drive("mujoco", truth, {}, 10.0);
  Identification study = Study(
      "mujoco", std::move(drive),
      {{.name = "p_dy1", .from = 0.4, .to = 1.2}, {.name = "p_ky1", .from = -16.0, .to = -4.0}});
  study.horizon = 5.0;
  const IdentificationResult result = Identify(study, {.threads = 2});
  // After each restart, the body rolls for 0.1 s of 5 s. The tolerance is therefore 2 % of the
  // bounds' widths.
  EXPECT_NEAR(result.Find("p_dy1")->value, 0.7, Tolerance(0.02) * 0.8);
  EXPECT_NEAR(result.Find("p_ky1")->value, -10.0, Tolerance(0.02) * 12.0);
}

TEST_F(IdentifiedCar, IsTheSameWithAnyNumberOfThreads) {
  const Identification study =
      Study("single_track", Drive("single_track", kTruth, {.yaw_rate = 0.05}), FiveParameters());
  const auto one = ToJson(Identify(study, {.threads = 1}));
  EXPECT_EQ(ToJson(Identify(study, {.threads = 3})), one);
}

TEST_F(IdentifiedCar, KeepsTheBestWhenInterrupted) {
  const Identification study =
      Study("single_track", Drive("single_track", kTruth), FiveParameters());
  std::atomic<int> asked = 0;
  const IdentificationResult result =
      Identify(study, {.interrupted = [&] { return ++asked > 400; }});
  EXPECT_TRUE(result.interrupted);
  EXPECT_LT(result.cost, result.start_cost);
  EXPECT_TRUE(result.records.empty());
  EXPECT_EQ(ToJson(result)["complete"], false);
  EXPECT_EQ(result.parameters.front().status, ParameterStatus::kUnfinished);
}

TEST_F(IdentifiedCar, WeighsPriorsAgainstWindows) {
  // The study has one parameter with a prior so narrow that the windows have little influence.
  const double prior = 0.1;
  std::vector<IdentifiedParameter> parameters{
      {.name = "steering_time_constant",
       .from = 0.01,
       .to = 0.2,
       .prior = ParameterPrior{.mean = prior, .deviation = 1e-5}}};
  const IdentificationResult result =
      Identify(Study("single_track", Drive("single_track", kTruth), parameters));
  EXPECT_NEAR(result.parameters.front().value, prior, 1e-3);
  // Without the prior, the windows yield 0.08.
  parameters.front().prior.reset();
  EXPECT_NEAR(
      Identify(Study("single_track",
                     Drive("single_track", {{.name = "steering_time_constant", .value = 0.08}}),
                     parameters))
          .parameters.front()
          .value,
      0.08, 1e-4);
}

TEST_F(IdentifiedCar, FindsASteeringOffsetByDefault) {
  for (const double offset : {-0.017, 0.0, 0.012}) {
    Identification study =
        Study("single_track", Drive("single_track", {{.name = kSteeringOffset, .value = offset}}),
              {FiveParameters()[0]});
    study.steering_offset = true;
    const ParameterEstimate& estimate = *Identify(study).Find(kSteeringOffset);
    // The residuals vanish at the truth, and the search ends when its steps are below 1e-4 of the
    // width of the bounds, 0.2 rad.
    EXPECT_NEAR(estimate.value, offset, Tolerance(2e-4) * 0.2) << offset;
    ASSERT_TRUE(estimate.standard_error) << estimate.remark;
    EXPECT_EQ(estimate.status, ParameterStatus::kIdentified);
  }
}

TEST_F(IdentifiedCar, LeavesTheSteeringOffsetToTheStudy) {
  Identification study =
      Study("single_track", Drive("single_track", kTruth), {FiveParameters()[0]});
  study.evaluations = 1;
  EXPECT_EQ(Identify(study).Find(kSteeringOffset), nullptr);  // steering_offset: false
  study.steering_offset = true;
  study.parameters.push_back({.name = kSteeringOffset, .from = -0.01, .to = 0.01});
  EXPECT_EQ(Identify(study).parameters.size(), 2U);
  study.parameters.pop_back();
  study.fit_scenarios.front().drive.steering = SteeringInput::kPrescribed;
  EXPECT_EQ(Identify(study).Find(kSteeringOffset), nullptr);
}

TEST_F(IdentifiedCar, FixesTheOffsetBeforeACurveThatExplainsIt) {
  // All angles of the curve together have the effect of the offset.
  std::string xml = ReadFile(model_);
  xml.insert(xml.find("<custom>") + 8,
             R"(<numeric name="steering_curve" data="-0.4 -0.4 -0.1 -0.1 0.1 0.1 0.4 0.4"/>)");
  model_ = folder_.Write("curve.xml", xml);
  std::vector<IdentifiedParameter> parameters;
  for (const char* name :
       {"steering_curve[1]", "steering_curve[3]", "steering_curve[5]", "steering_curve[7]"}) {
    const double own = CarParameterValue(Base(), name);
    parameters.push_back({.name = name, .from = own - 0.05, .to = own + 0.05});
  }
  Identification study = Study("single_track", Drive("single_track", {}), parameters);
  study.steering_offset = true;
  const IdentificationResult result = Identify(study);
  EXPECT_EQ(result.Find(kSteeringOffset)->status, ParameterStatus::kNotIdentified);
  EXPECT_EQ(result.Find("steering_curve[3]")->status, ParameterStatus::kIdentified);
}

TEST_F(IdentifiedCar, NotesASignalThatLagsThePose) {
  RecordedDrive drive = Drive("single_track", kTruth, {}, 30.0);
  EXPECT_THAT(Identify(Study("single_track", drive, {FiveParameters()[2]})).notes,
              testing::IsEmpty());
  const RecordedDrive on_time = drive;
  for (RecordedSample& sample : drive.samples) {
    sample.yaw_rate = on_time.At(sample.time - 0.36).yaw_rate;
  }
  const IdentificationResult result = Identify(Study("single_track", drive, {FiveParameters()[2]}));
  EXPECT_THAT(result.notes, testing::ElementsAre(
                                HasSubstr("drive: yaw_rate lags the motion of the pose by 0.36")));
  EXPECT_EQ(ToJson(result)["notes"][0], result.notes[0]);
}

TEST_F(IdentifiedCar, PlacesUnknownParameters) {
  Identification study = Study("single_track", Drive("single_track", {}),
                               {{.name = "stering_dead_time", .from = 0.0, .to = 0.1}});
  study.parameters.front().line = 9;
  study.parameters.front().column = 13;
  try {
    static_cast<void>(Identify(study));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("study.yaml:9:13: parameters: stering_dead_time: no such "
                                        "number in the model: 'stering_dead_time'; did you mean "
                                        "'steering_dead_time'?"));
  }
}

TEST_F(IdentifiedCar, WritesTheModelAndItsOrigins) {
  const IdentificationResult result =
      Identify(Study("single_track", Drive("single_track", kTruth), FiveParameters()));
  const fs::path out = folder_.path() / "out";
  WriteIdentification(result, out);
  const CarModel fitted(ComposeScene(out / "small_car.xml", {}), "fitted");
  for (const ParameterEstimate& estimate : result.parameters) {
    EXPECT_NEAR(CarParameterValue(fitted, estimate.parameter.name), estimate.value, 1e-12)
        << estimate.parameter.name;
  }
  EXPECT_THAT(ReadFile(out / "small_car.xml"),
              HasSubstr("<!-- p_ky1_front: estimated by study, standard error"));
  auto json = ToJson(result);
  json["records"][0]["result"] = Sha256(ReadFile(out / "records/drive/manifest.json"));
  EXPECT_EQ(nlohmann::ordered_json::parse(ReadFile(out / run_folder::kIdentifyJson)), json);
  EXPECT_TRUE(fs::exists(out / "records/drive/metrics.json"));
  EXPECT_THAT(ReadFile(out / run_folder::ResidualsCsv("drive")),
              HasSubstr("yaw_rate_fitted_radps"));
}

// The fitted model is named after the model, whose name may come from an untrusted source.
TEST_F(IdentifiedCar, NeverWritesOutsideItsFolder) {
  Identification study =
      Study("single_track", Drive("single_track", kTruth), {FiveParameters()[0]});
  study.evaluations = 1;
  IdentificationResult result = Identify(study);
  const fs::path victim = folder_.Write("victim/rel.xml", "mine");
  int number = 0;
  for (const std::string& name :
       {std::string("../../../victim/rel"), (folder_.path() / "victim/rel").string(),
        std::string("../victim/rel"), std::string("a/b"), std::string("."), std::string(".."),
        std::string(), std::string("a\nb\x1b[31m"), std::string("\xff\xfe"), std::string(5000, 'x'),
        std::string("a\0b", 3), std::string("records"), std::string("identify.json/x")}) {
    const fs::path parent = folder_.path() / std::to_string(++number);
    const fs::path out = parent / "deep/out";
    result.records.front().fitted.vehicle.name = name;
    WriteIdentification(result, out);
    const fs::path model = out / (FileNameOf(name) + ".xml");
    EXPECT_EQ(ReadFile(model), result.model.xml) << name;
    std::vector<std::string> beside;
    for (const auto& entry : fs::recursive_directory_iterator(parent)) {
      if (!entry.path().string().starts_with(out.string())) {
        beside.push_back(entry.path().lexically_relative(parent));
      }
    }
    EXPECT_THAT(beside, testing::ElementsAre("deep")) << name;
  }
  EXPECT_EQ(ReadFile(victim), "mine");
  std::vector<std::string> all;
  for (const auto& entry : fs::directory_iterator(folder_.path() / "victim")) {
    all.push_back(entry.path().filename());
  }
  EXPECT_THAT(all, testing::ElementsAre("rel.xml"));
}

TEST_F(IdentifiedCar, NamesItsFilesBeforeTheSearch) {
  Identification study =
      Study("single_track", Drive("single_track", kTruth), {FiveParameters()[0]});
  study.evaluations = 1;
  const std::vector<std::string> names = IdentificationFiles(study);
  const fs::path out = folder_.path() / "out";
  WriteIdentification(Identify(study), out);
  for (const auto& entry : fs::directory_iterator(out)) {
    const std::string name = entry.path().filename();
    if (name != run_folder::kManifest && name != run_folder::kRecords) {
      EXPECT_THAT(names, testing::Contains(name));
    }
  }
}

}  // namespace
}  // namespace trackbed
