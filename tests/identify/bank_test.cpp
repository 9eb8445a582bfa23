#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/temp_folder.h"
#include "tests/tolerance.h"
#include "trackbed/analysis/run.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/identify/identify.h"
#include "trackbed/identify/identify_files.h"
#include "trackbed/recording/banked_track.h"
#include "trackbed/scenario/record_scenario.h"
#include "trackbed/sim/plant.h"
#include "trackbed/sim/world_scene.h"

// Identifies the bank of an oval from drives that were simulated on the true ground.
namespace trackbed {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr double kControlPeriod = 0.02;  // [s]

/// Returns the points of an oval: two straights of 14 m and two half circles of 6 m, 0.5 m apart.
std::vector<TrackPoint> OvalPoints() {
  constexpr double kStraight = 14.0;
  constexpr double kRadius = 6.0;
  const double lap = 2.0 * (kStraight + kPi * kRadius);
  const auto count = static_cast<int>(std::lround(lap / 0.5));
  std::vector<TrackPoint> points;
  for (int i = 0; i < count; ++i) {
    const double s = lap * i / count;
    const bool back = s >= 0.5 * lap;
    const double along = back ? s - 0.5 * lap : s;
    Vec2 at{along - 0.5 * kStraight, -kRadius};
    if (along > kStraight) {
      const double angle = (along - kStraight) / kRadius;
      at = {0.5 * kStraight + kRadius * std::sin(angle), -kRadius * std::cos(angle)};
    }
    points.push_back({back ? Vec2(-at) : at, 2.0, 2.0});
  }
  return points;
}

/// Returns the bank of the oval: 0 in the middle of the straights, and `most` in the middle of the
/// bends, where the outside, on the right, is higher.
double TrueBank(const Track& track, double s, double most) {
  const double middle = 0.5 * 14.0;
  return -most * 0.5 * (1.0 - std::cos(4.0 * kPi * (s - middle) / track.length()));
}

/// Drives of an understeering car. A bank does not turn a neutral car.
class IdentifiedBank : public testing::Test {
 protected:
  IdentifiedBank() {
    std::string xml = ReadFile(fs::path(TRACKBED_SOURCE_DIR) / "tests/data/models/small_car.xml");
    const std::string begin = "<custom>";
    xml.insert(xml.find(begin) + begin.size(),
               R"(<numeric name="p_ky1_front" data="-6"/><numeric name="p_ky1_rear" data="-9"/>)");
    model_ = folder_.Write("car.xml", xml);
  }

  [[nodiscard]] Ground GroundWith(double most) const {
    BankedTrack banked{track_.points(), {}, std::vector<double>(track_.points().size(), 0.0)};
    for (std::size_t i = 0; i < banked.points.size(); ++i) {
      banked.banks.push_back(TrueBank(track_, track_.StationOf(i), most));
    }
    return {.terrain = MakeTerrain(banked)};
  }

  /// Simulates a drive along the oval at constant speed on the given ground, `beside` the middle.
  [[nodiscard]] RecordedDrive Drive(const Ground& ground, double speed, double duration,
                                    double beside) const {
    const CarModel car(WithGround(ComposeScene(model_, {}), ground), model_.string());
    World world;
    world.ground = ground;
    PathPoint at = track_.At(0.0);
    at.pose.y += beside;
    const auto plant = MakePlant(
        "mujoco", {.car = car, .world = world, .start = {.pose = at.pose, .speed = speed}});
    RecordedDrive drive{.name = "drive", .period = kControlPeriod, .has_steering_command = true};
    const VehicleParams& params = car.params();
    double command = 0.0;
    double s = 0.0;
    for (int i = 0; i * kControlPeriod <= duration; ++i) {
      const VehicleState state = plant->Observe();
      drive.samples.push_back(
          {.time = i * kControlPeriod,
           .pose = state.pose,
           .velocity_V = {state.speed, state.lateral_speed - params.cg_to_rear * state.yaw_rate},
           .yaw_rate = state.yaw_rate,
           .steering_command = command});
      const TrackPlace place = track_.Locate(state.pose.position(), s);
      s = place.s;
      const PathPoint reference = track_.At(s + 0.3 * speed);
      const double heading = AngleDifference(state.pose.yaw, track_.At(s).pose.yaw);
      // A replay applies in each period the command that is recorded at its end.
      command = SteeringForCurvature(params, reference.curvature) - 0.1 * (place.offset - beside) -
                0.4 * heading;
      const Command input{.steering = command, .acceleration = 20.0 * (speed - state.speed)};
      for (int k = 0; k < std::lround(kControlPeriod / car.timestep()); ++k) {
        plant->Step(input);
      }
    }
    return drive;
  }

  [[nodiscard]] Scenario Record(RecordedDrive drive, const std::string& name) const {
    drive.name = name;
    Scenario scenario =
        RecordScenario(std::make_shared<const RecordedDrive>(std::move(drive)), model_.string());
    scenario.drive.plants = {kRecordedPlant, "mujoco"};
    scenario.record->windows = {2.0};
    return scenario;
  }

  [[nodiscard]] Identification Study(std::vector<Scenario> fit) const {
    Identification study{.name = "study", .plant = "mujoco"};
    study.parameters = {{.name = "p_ky1_front", .from = -12.0, .to = -4.0, .start = -7.0}};
    study.fit_scenarios = std::move(fit);
    study.steering_offset = false;
    study.starts = 1;
    study.loss = RobustLoss::kSquared;
    study.residuals.yaw_rate = 0.02;
    study.residuals.position = 0.02;
    study.bank = BankEstimation{};
    study.file = "study.yaml";
    return study;
  }

  static double YawRateError(const RunResult& run) {
    for (const PlantMetrics& metrics : run.metrics) {
      if (metrics.plant == "mujoco") {
        return metrics.windows.front().yaw_rate_relative_rms;
      }
    }
    return -1.0;
  }

  TempFolder folder_;
  fs::path model_;
  Track track_{OvalPoints()};
};

TEST_F(IdentifiedBank, IsThatOfTheOval) {
  constexpr double kMost = 0.25;
  const Ground ground = GroundWith(kMost);
  Identification study = Study({Record(Drive(ground, 4.0, 18.0, 0.0), "slow")});
  study.held_out_scenarios = {Record(Drive(ground, 4.6, 14.0, 0.4), "fast")};
  const IdentificationResult result = Identify(study, {.threads = 2});
  ASSERT_NE(result.bank, nullptr);
  // The plant restarts every 2 s without roll, and the bank is that of a track 0.5 to 2 m apart, so
  // the estimate is not exact: require a tenth of the bank.
  const Track found(result.bank->points);
  for (std::size_t i = 0; i < result.bank->points.size(); ++i) {
    const double s = track_.Locate(result.bank->points[i].position).s;
    EXPECT_NEAR(result.bank->banks[i], TrueBank(track_, s, kMost), Tolerance(0.1 * kMost)) << s;
  }
  EXPECT_NEAR(result.Find("p_ky1_front")->value, -6.0, Tolerance(0.1 * 6.0));
  EXPECT_NE(result.Find("bank[0]"), nullptr);
  // On the drive that was held out, faster and elsewhere on the track, most of the error is gone.
  ASSERT_EQ(result.records.size(), 2U);
  EXPECT_TRUE(result.records[1].held_out);
  EXPECT_LT(YawRateError(result.records[1].fitted), 0.25 * YawRateError(result.records[1].start));
  // The run folder of a record replays on the same ground.
  const fs::path out = folder_.path() / "out";
  WriteIdentification(result, out);
  const Scenario again = ReadScenario(out / "records/fast/scenario.resolved.yaml");
  ASSERT_NE(again.world.ground.terrain, nullptr);
  const BankedTrack read = ReadBankedTrack(out / kBankCsv);
  EXPECT_EQ(read.banks, result.bank->banks);
  EXPECT_EQ(again.record->ground_data->banks, result.bank->banks);
}

TEST_F(IdentifiedBank, IsThatOfAnOpenRoad) {
  // A drive along five eighths of the oval ends there: no lap.
  constexpr double kMost = 0.25;
  const Ground ground = GroundWith(kMost);
  Identification study = Study({Record(Drive(ground, 4.0, 10.0, 0.0), "once"),
                                Record(Drive(ground, 4.4, 9.0, -0.2), "again")});
  study.bank->spacing = 8.0;  // [m], as on the closed oval
  study.held_out_scenarios = {Record(Drive(ground, 4.5, 8.0, 0.3), "faster")};
  const IdentificationResult result = Identify(study, {.threads = 2});
  ASSERT_NE(result.bank, nullptr);
  EXPECT_FALSE(result.bank->closed);
  for (std::size_t i = 0; i < result.bank->points.size(); ++i) {
    const double s = track_.Locate(result.bank->points[i].position).s;
    // As on the closed oval; in the first and last meters, no window determines the bank.
    if (s > 4.0 && s < 36.0) {
      EXPECT_NEAR(result.bank->banks[i], TrueBank(track_, s, kMost), Tolerance(0.1 * kMost)) << s;
    }
  }
  ASSERT_EQ(result.records.size(), 3U);
  EXPECT_TRUE(result.records[2].held_out);
  EXPECT_LT(YawRateError(result.records[2].fitted), 0.25 * YawRateError(result.records[2].start));
  const fs::path out = folder_.path() / "out";
  WriteIdentification(result, out);
  EXPECT_FALSE(ReadBankedTrack(out / kBankCsv).closed);
}

TEST_F(IdentifiedBank, NeedsRecordsOfOneRoad) {
  Identification study = Study({Record(Drive({}, 4.0, 3.0, 0.0), "straight")});
  study.held_out_scenarios = {Record(Drive({}, 4.0, 18.0, 0.0), "lap")};
  try {
    CheckIdentification(study);
    study.bank->spacing = 0.1;
    CheckIdentification(study);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("bank.spacing: the track of "));
  }
  RecordedDrive far = Drive({}, 4.0, 6.0, 0.0);
  for (RecordedSample& sample : far.samples) {
    sample.pose.y += 100.0;
  }
  study.bank->spacing.reset();
  study.held_out_scenarios = {Record(std::move(far), "elsewhere")};
  try {
    CheckIdentification(study);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("bank.track: missing, and elsewhere drives "));
  }
  study.bank->center.points = track_.points();
  study.bank->spacing = 0.1;
  try {
    CheckIdentification(study);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("bank.spacing: the track of 65.7 m has 657 knots"));
  }
}

}  // namespace
}  // namespace trackbed
