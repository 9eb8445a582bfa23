#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "render/ground_texture.h"
#include "render/offscreen.h"
#include "render/overlays.h"
#include "render/scene.h"
#include "render/shadow.h"
#include "tests/render/run_folder.h"
#include "tests/support/temp_folder.h"
#include "trackbed/sim/mujoco_error.h"

/// Pictures of artificial runs, and positions of objects in them.
namespace trackbed::render {

inline constexpr int kWidth = 320;
inline constexpr int kHeight = 180;

struct Pixel {
  int x = 0;
  int y = 0;
};

/// Projects a point with a pinhole camera, using only the definition of CameraPose.
inline Pixel Project(const CameraPose& pose, double x, double y, double z) {
  const double ca = std::cos(pose.azimuth);
  const double sa = std::sin(pose.azimuth);
  const double ce = std::cos(pose.elevation);
  const double se = std::sin(pose.elevation);
  const std::array<double, 3> forward{ce * ca, ce * sa, se};
  const std::array<double, 3> right{sa, -ca, 0.0};
  const std::array<double, 3> up{-se * ca, -se * sa, ce};
  const std::array<double, 3> from{x - pose.target_x + pose.distance * forward[0],
                                   y - pose.target_y + pose.distance * forward[1],
                                   z - pose.target_z + pose.distance * forward[2]};
  const auto dot = [&](const std::array<double, 3>& axis) {
    return axis[0] * from[0] + axis[1] * from[1] + axis[2] * from[2];
  };
  const double pixels = 0.5 * kHeight / std::tan(0.5 * pose.view_angle) / dot(forward);
  return {static_cast<int>(0.5 * kWidth + pixels * dot(right)),
          static_cast<int>(0.5 * kHeight - pixels * dot(up))};
}

/// A blank font whose letters are half as wide as high.
inline Font BlankFont() {
  Image glyph;
  glyph.Resize(4, 8);
  return Font(std::vector<Image>(Font::kLast - Font::kFirst + 1, glyph));
}

class FilmSceneTest : public testing::Test {
 protected:
  FilmSceneTest() {
    CopyPrius(folder_.path());
    WritePlant(folder_.path(), "mujoco", 2.0, [](double time) {
      return CarPlace{3.0 * time, 0.0, 0.0};
    });
  }

  Image Picture(const std::string& camera, double time, bool shadows = false,
                int supersampling = 1) {
    Recording recording = ReadRecording(folder_.path());
    MakeGroundPlain(*recording.model, !recording.has_road());
    const CameraSubject subject(recording);
    pose_ = FindCamera(camera).pose(subject, time, static_cast<double>(kWidth) / kHeight);
    if (shadows) {
      FitShadowMap(*recording.model, *pose_);
    }
    Offscreen offscreen(*recording.model, kWidth, kHeight, supersampling);
    const OverlayList overlays = Overlays(recording);
    FilmScene scene(recording, overlays, shadows);
    Image image;
    offscreen.Render(scene.At(time, *pose_), image);
    return image;
  }

  /// RGB values at the pixel of a point of the world.
  std::array<int, 3> At(const Image& image, double x, double y, double z = 0.0) const {
    const Pixel pixel = Project(*pose_, x, y, z);
    EXPECT_TRUE(pixel.x >= 0 && pixel.x < kWidth && pixel.y >= 0 && pixel.y < kHeight)
        << x << ", " << y << " is out of the picture";
    const std::uint8_t* rgb = image.Pixel(pixel.x, pixel.y);
    return {rgb[0], rgb[1], rgb[2]};
  }

  /// The overlays named in `overlays_`.
  OverlayList Overlays(const Recording& recording) {
    return MakeOverlays({.recording = recording,
                         .shown = overlays_,
                         .title = "run",
                         .width = kWidth,
                         .height = kHeight,
                         .font = font_});
  }

  const MujocoErrorScope errors_;
  std::vector<std::string> overlays_{"plan", "trail", "ghosts", "wind"};
  Font font_ = BlankFont();
  TempFolder folder_;
  std::optional<CameraPose> pose_;
};

// Threshold for the brightness of white paint on flat ground. In sunlight, white paint has at least
// 0.96 of its color. Asphalt between painted lines has at most 0.69 of white. The threshold of 225
// / 255 = 0.88 lies well between.
inline constexpr int kWhite = 225;

}  // namespace trackbed::render
