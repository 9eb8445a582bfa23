#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render/events.h"
#include "render/painter.h"
#include "tests/render/pictures.h"
#include "tests/tolerance.h"
#include "trackbed/render/film.h"

namespace trackbed::render {
namespace {

using Kind = RunEvent::Kind;

/// A car that drives along the x axis at 3 m/s for 2 s; its log has a row every 20 ms.
class EventTest : public FilmSceneTest {
 protected:
  EventTest() {
    WriteFileAtomically(folder_.path() / "scenario.resolved.yaml", R"(schema: 1
name: run
mission: {speed: 3, waypoints: [[0, 0], [20, 0]]}
)");
    SetLogColumn(folder_.path(), "mujoco", "steering_actuator_rad", [](double) { return 0.1; });
  }

  std::vector<RunEvent> Events() const { return FindEvents(ReadRecording(folder_.path())); }

  Image Painted(double time) const {
    std::vector<Recording> recordings;
    recordings.push_back(ReadRecording(folder_.path()));
    FilmOptions options;
    options.width = kWidth;
    options.height = kHeight;
    options.camera = "top";
    options.overlays = {"events"};
    Image image;
    Painter(recordings, options).Paint(time, image);
    return image;
  }

  /// Rolls the car to its right by `roll(time)` [rad].
  void SetRoll(const std::function<double(double)>& roll) const {
    const std::filesystem::path file = folder_.path() / "mujoco.state.csv";
    const Table before = ReadCsv(file);
    Table after(before.columns());
    for (std::size_t row = 0; row < before.rows(); ++row) {
      std::vector<double> cells;
      for (std::size_t i = 0; i < before.columns().size(); ++i) {
        cells.push_back(before.at(row, i));
      }
      const double half = 0.5 * roll(cells[0]);
      cells[static_cast<std::size_t>(before.Find("qw"))] = std::cos(half);
      cells[static_cast<std::size_t>(before.Find("qx"))] = std::sin(half);
      after.AddRow(cells);
    }
    WriteFileAtomically(file, after.ToCsv());
  }
};

TEST_F(EventTest, AQuietRunHasNone) {
  EXPECT_TRUE(Events().empty());
}

TEST_F(EventTest, AnObstacleIsDetectedWhenTheFootprintIsInItsRange) {
  WriteFileAtomically(folder_.path() / "scenario.resolved.yaml", R"(schema: 1
name: run
mission: {speed: 3, waypoints: [[0, 0], [20, 0]]}
world:
  obstacles:
    - {box: {x: 13, y: 0, length: 2, width: 2, height: 1}, known_from: {range: 5}}
    - {box: {x: 30, y: 9, length: 2, width: 2, height: 1}, known_from: {time: 0.5}}
    - {box: {x: 30, y: 5, length: 2, width: 2, height: 1}}
    - {box: {x: 90, y: 0, length: 2, width: 2, height: 1}, known_from: {range: 5}}
)");
  const Recording recording = ReadRecording(folder_.path());
  const std::vector<double> known = KnownFrom(recording);
  // The front of the Prius is 3.625 m ahead of its rear axle, at 3 t + 3.625; the box begins at 12.
  // The distance is 5 m at 1.125 s, and the next row of the log is at 1.14 s.
  EXPECT_NEAR(known[0], 1.14, Tolerance(1e-9));
  EXPECT_NEAR(known[1], 0.5, Tolerance(1e-9));
  EXPECT_EQ(known[2], -std::numeric_limits<double>::infinity());
  EXPECT_EQ(known[3], std::numeric_limits<double>::infinity());
  const std::vector<RunEvent> events = FindEvents(recording);
  ASSERT_EQ(events.size(), 2U);
  EXPECT_EQ(events[0].kind, Kind::kObstacleKnown);
  EXPECT_EQ(events[0].obstacle, 1);
  EXPECT_EQ(events[1].obstacle, 0);
  EXPECT_NEAR(events[1].from, 1.14, Tolerance(1e-9));
  EXPECT_NEAR(events[1].place.x, 3.0 * 1.14, Tolerance(1e-9));
}

TEST_F(EventTest, NewPlansAreTakenWhenTheirFileSays) {
  WriteStraightPlan(folder_.path(), 16.0);
  WriteNewPlans(folder_.path(), "mujoco", {{0.5, 2.0, 16.0}, {1.5, 2.0, 16.0}});
  const std::vector<RunEvent> events = Events();
  ASSERT_EQ(events.size(), 2U);
  EXPECT_EQ(events[0].kind, Kind::kNewPlan);
  EXPECT_DOUBLE_EQ(events[0].from, 0.5);
  EXPECT_DOUBLE_EQ(events[1].from, 1.5);
  EXPECT_NEAR(events[0].place.x, 1.5, Tolerance(1e-9));
}

TEST_F(EventTest, TheRateLimitIsReachedWhereTheActuatorTurnsAsFastAsItCanAndIsBehind) {
  // The Prius steers at up to 2.65 / 17.6 rad/s. A step to 0.06 rad at 0.5 s takes 0.3985 s, so the
  // wheels reach the command in the period that ends at 0.9 s. The wheels turn back slowly.
  const double rate = 2.65 / 17.6;
  SetLogColumn(folder_.path(), "mujoco", "steering_command_rad", [](double time) {
    return time < 0.499 ? 0.0 : time < 1.499 ? 0.06 : 0.06 - 0.5 * 2.65 / 17.6 * (time - 1.48);
  });
  SetLogColumn(folder_.path(), "mujoco", "steering_actuator_rad", [=](double time) {
    return time < 1.499 ? std::clamp(rate * (time - 0.5), 0.0, 0.06)
                        : 0.06 - 0.5 * rate * (time - 1.5);
  });
  const std::vector<RunEvent> events = Events();
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events[0].kind, Kind::kRateLimit);
  EXPECT_NEAR(events[0].from, 0.5, Tolerance(1e-9));
  EXPECT_NEAR(events[0].to, 0.88, Tolerance(1e-9));
  EXPECT_NEAR(events[0].place.x, 1.5, Tolerance(1e-9));
}

TEST_F(EventTest, ACollisionIsWhereTheClearanceIsGoneOrWhereTheMetricsSay) {
  SetLogColumn(folder_.path(), "mujoco", "clearance_m",
               [](double time) { return std::max(0.0, 1.2 - time); });
  std::vector<RunEvent> events = Events();
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events[0].kind, Kind::kCollision);
  EXPECT_NEAR(events[0].from, 1.2, Tolerance(1e-9));
  EXPECT_THAT(events[0].text, testing::HasSubstr("1.20 s"));
  WriteFileAtomically(
      folder_.path() / "metrics.json",
      R"({"plants": {"mujoco": {"status": "collided", "collision": true, "clearance_min_t": 1.191}}})");
  events = Events();
  ASSERT_EQ(events.size(), 1U);
  EXPECT_DOUBLE_EQ(events[0].from, 1.191);
}

TEST_F(EventTest, ARollOverBeginsWhereTheCarLeansBy30DegreesForTheLastTime) {
  // With a roll rate of 1 rad/s from 0.5 s on, the roll angle is 30 degrees (its cosine is 0.87)
  // after 0.5156 s and 60 degrees after 1.0472 s. States are 1/60 s apart.
  SetRoll([](double time) { return std::max(0.0, time - 0.5); });
  std::vector<RunEvent> events = Events();
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events[0].kind, Kind::kRollOver);
  EXPECT_NEAR(events[0].from, 0.5 + std::acos(0.87), Tolerance(1.0 / 60.0));
  EXPECT_THAT(events[0].text, testing::HasSubstr("roll-over at 1.5"));
  // A car that only leans has not rolled over.
  SetRoll([](double) { return 0.6; });
  EXPECT_TRUE(Events().empty());
  // The metrics report a roll-over even if the last recorded state is just below 60 degrees.
  WriteFileAtomically(folder_.path() / "metrics.json",
                      R"({"plants": {"mujoco": {"status": "rolled_over", "status_t": 2.01}}})");
  events = Events();
  ASSERT_EQ(events.size(), 1U);
  EXPECT_THAT(events[0].text, testing::HasSubstr("2.01 s"));
}

TEST_F(EventTest, MarksLieWhereTheCarWasFromThenOn) {
  WriteStraightPlan(folder_.path(), 16.0);
  WriteNewPlans(folder_.path(), "mujoco", {{0.2, 2.0, 16.0}});
  Recording recording = ReadRecording(folder_.path());
  pose_ =
      FindCamera("top").pose(CameraSubject(recording), 2.0, static_cast<double>(kWidth) / kHeight);
  // At 1 s the car has passed x = 0.6 m and covers the road only from x = 2.2 m on. The trail is
  // pink, with more red than green.
  EXPECT_GT(At(Painted(1.0), 0.6, 0.0)[0], At(Painted(1.0), 0.6, 0.0)[1] + 60);
  const std::array<int, 3> before = At(Painted(0.19), -0.9, 0.0);
  EXPECT_LT(std::abs(before[0] - before[1]), 20);
}

TEST_F(EventTest, ACollisionFlashesAroundThePicture) {
  SetLogColumn(folder_.path(), "mujoco", "clearance_m",
               [](double time) { return std::max(0.0, 1.2 - time); });
  const auto edge = [this](double time) {
    const Image image = Painted(time);
    const std::uint8_t* rgb = image.Pixel(kWidth - 2, kHeight / 2);
    return rgb[0] - rgb[1];
  };
  EXPECT_LT(edge(1.19), 20);
  EXPECT_GT(edge(1.22), 100);
  EXPECT_LT(edge(1.85), 20);
}

}  // namespace
}  // namespace trackbed::render
