#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "src/analysis/track_metrics.h"
#include "tests/tolerance.h"
#include "trackbed/drive/drive.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/replan/replan.h"
#include "trackbed/track/track_file.h"
#include "trackbed/world/world.h"

/// Tests laps on a track with obstacles.
namespace trackbed {
namespace {

constexpr double kDistance = 0.5;  // plan.replan.safe_distance [m]

/// A box on the center line, across the track by `width` [m].
std::string BoxOn(const Track& track, double s, double width) {
  const Pose2 pose = track.At(s).pose;
  return fmt::format(
      "{{box: {{x: {}, y: {}, yaw: {}, length: 3, width: {}, height: 1}}, known_from: {{range: "
      "70}}}}",
      pose.x, pose.y, pose.yaw, width);
}

struct TrackDrive {
  Scenario scenario;
  CarModel car;
  Plan plan;
  RunLog log;
};

TrackDrive DriveOnKidney(const std::string& mission, const std::string& plan,
                         const std::vector<std::string>& boxes,
                         const std::string& control = "{method: preview_integral}") {
  std::string obstacles;
  for (const std::string& box : boxes) {
    obstacles += "    - " + box + "\n";
  }
  const std::string text =
      "schema: 1\nname: blocked_lap\nvehicle: {model: prius}\nmission: {" + mission +
      ", track: {file: kidney.csv}}\nworld:\n  obstacles:\n" + obstacles +
      "plan:\n  global: " + plan +
      "\n  replan: {safe_distance: 0.5, along: {method: frenet, max_lateral_acceleration: 6}}\n"
      "control: " +
      control + "\ndrive: {plants: [kinematic]}\n";
  const Scenario scenario =
      ParseScenario(text, "blocked_lap.yaml",
                    std::filesystem::path(TRACKBED_SOURCE_DIR) / "scenarios" / "tracks");
  CarModel car = LoadCar(scenario);
  const FeasiblePlan planned = PlanScenario(scenario, car);
  RunLog log = SimulateScenario(scenario, car, planned, "kinematic");
  return {scenario, std::move(car), planned, std::move(log)};
}

Track Kidney() {
  return ReadTrack(std::filesystem::path(TRACKBED_SOURCE_DIR) / "scenarios/tracks/kidney.csv");
}

/// Expects that footprints keep their distance from edges and obstacles. `error` [m]: tracking
/// error of the car; the samples of a motion allow another 1 cm.
void ExpectKeepsClear(const TrackDrive& drive, double error) {
  const double least = kDistance - Tolerance(error + 0.01);
  for (const LogRow& row : drive.log.rows) {
    const OrientedBox footprint = FootprintAt(drive.car.params(), row.state.pose);
    const double near = drive.plan.laps.track->Locate(footprint.center.position()).s;
    EXPECT_GE(TrackMargin(*drive.plan.laps.track, footprint, near), least) << row.state.time;
    for (const Obstacle& obstacle : drive.scenario.world.obstacles) {
      EXPECT_GE(Separation(footprint, obstacle.footprint), least) << row.state.time;
    }
    if (::testing::Test::HasFailure()) {
      return;
    }
  }
}

const std::string& KindOf(const PlanChange& change) {
  return change.plan.diagnostics.replan.GetIf<ReplanDiagnostics>()->kind;
}

TEST(TrackReplanning, PassesWhatStandsBetweenTheEdges) {
  const Track track = Kidney();
  const std::vector<std::string> boxes{BoxOn(track, 220.0, 1.0), BoxOn(track, 480.0, 1.0)};
  for (const char* plan : {"{method: center_line}", "{method: minimum_curvature, margin: 1}"}) {
    SCOPED_TRACE(plan);
    const TrackDrive drive = DriveOnKidney("speed: 12", plan, boxes);
    EXPECT_EQ(drive.log.status, DriveStatus::kArrived);
    ASSERT_GE(drive.log.changes.size(), 2U);
    EXPECT_EQ(KindOf(drive.log.changes.back()), "back_on_route");
    // With this controller the kinematic car tracks paths of continuous curvature to 0.12 m.
    ExpectKeepsClear(drive, 0.12);
    const std::vector<LapMetrics> laps = MeasureLaps(drive.log, drive.plan);
    ASSERT_EQ(laps.size(), 1U);
    // The car makes two detours of 2 m to the side and back, each within about 60 m. These detours
    // lengthen the lap by about 2 * 2 * 2^2/60 = 0.3 m. The car is also up to 25 % slower for at
    // most 100 m.
    EXPECT_GT(laps[0].time, laps[0].time_planned - 0.2);
    EXPECT_LT(laps[0].time, laps[0].time_planned + 3.0);
  }
}

TEST(TrackReplanning, ComesBackToSpeedsAtTheLimit) {
  const TrackDrive drive =
      DriveOnKidney("speed: 40, speed_profile: {method: limits, share: 0.7}, start: {speed: 12}",
                    "{method: minimum_time, margin: 1}", {BoxOn(Kidney(), 480.0, 1.0)},
                    "{method: lqr, tyres: none, speed: {acceleration: 3, deceleration: 5}}");
  EXPECT_EQ(drive.log.status, DriveStatus::kArrived);
  ASSERT_GE(drive.log.changes.size(), 2U);
  ExpectKeepsClear(drive, 0.12);
  const PlanChange& back = drive.log.changes.back();
  EXPECT_EQ(KindOf(back), "back_on_route");
  // Once the replan has reached the speeds of the original plan, it keeps them.
  const SpeedProfile& own = back.plan.reference.speed;
  const SpeedProfile& planned = drive.plan.reference.speed;
  const double from = drive.plan.reference.path.length() - back.plan.reference.path.length();
  EXPECT_LE(own.SpeedAt(0.0), planned.SpeedAt(from) + 0.1);
  EXPECT_NEAR(own.SpeedAt(150.0), planned.SpeedAt(from + 150.0), Tolerance(1e-9));
}

TEST(TrackReplanning, GoesOnToTheNextLap) {
  const TrackDrive drive = DriveOnKidney("speed: 12", "{method: minimum_curvature, margin: 1}",
                                         {BoxOn(Kidney(), 300.0, 1.0)});
  Scenario twice = drive.scenario;
  twice.mission.track->laps = 2;
  const FeasiblePlan plan = PlanScenario(twice, drive.car);
  const RunLog log = SimulateScenario(twice, drive.car, plan, "kinematic");
  EXPECT_EQ(log.status, DriveStatus::kArrived);
  const std::vector<LapMetrics> laps = MeasureLaps(log, plan);
  ASSERT_EQ(laps.size(), 2U);
  EXPECT_NEAR(laps[1].time, laps[1].time_planned, Tolerance(3.0));
  EXPECT_EQ(KindOf(log.changes.back()), "back_on_route");
}

TEST(TrackReplanning, StopsWhereTheTrackIsBlocked) {
  const TrackDrive drive = DriveOnKidney("speed: 12", "{method: minimum_curvature, margin: 1}",
                                         {BoxOn(Kidney(), 300.0, 6.5)});
  EXPECT_EQ(drive.log.status, DriveStatus::kBlocked);
  ExpectKeepsClear(drive, 0.12);
  EXPECT_TRUE(MeasureLaps(drive.log, drive.plan).empty());
}

}  // namespace
}  // namespace trackbed
