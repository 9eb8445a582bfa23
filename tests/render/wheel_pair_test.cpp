#include <gtest/gtest.h>

#include <cmath>

#include "render/painter.h"
#include "tests/render/pictures.h"
#include "trackbed/analysis/run.h"
#include "trackbed/scenario/scenario.h"

namespace trackbed::render {
namespace {

TEST(WheelPair, IsSeenWhereItWasDriven) {
  Scenario scenario =
      ReadScenario(std::filesystem::path(TRACKBED_SOURCE_DIR) / "scenarios" / "slalom.yaml");
  scenario.vehicle.model = "diff_drive";
  scenario.drive.time_limit = 1.0;
  const RunResult run = RunScenario(scenario);
  const TempFolder folder;
  WriteRunFolder(run, folder.path());
  const MujocoErrorScope errors;
  Recording recording = ReadRecording(folder.path());
  const double time = 0.5;
  const CameraPose pose = FindCamera("side").pose(CameraSubject(recording), time,
                                                  static_cast<double>(kWidth) / kHeight);
  Offscreen offscreen(*recording.model, kWidth, kHeight, 1);
  const OverlayList none;
  FilmScene scene(recording, none, false);
  Image image;
  offscreen.Render(scene.At(time, pose), image);
  // The checked point is the middle of the hood's right flank, 0.21 m to the right and 0.27 m high.
  // The hood has the orange of its plant.
  const Pose2 car = run.logs.back().rows[25].state.pose;
  const Vec2 flank = ToWorld(car, {0.25, -0.21});
  const Pixel pixel = Project(pose, flank.x(), flank.y(), 0.27);
  const std::uint8_t* rgb = image.Pixel(pixel.x, pixel.y);
  EXPECT_GT(rgb[0], rgb[1] + 20);
  EXPECT_GT(rgb[1], rgb[2] + 10);
}

}  // namespace
}  // namespace trackbed::render
