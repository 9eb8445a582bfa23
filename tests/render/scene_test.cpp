#include "render/scene.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <optional>

#include "render/offscreen.h"
#include "tests/render/run_folder.h"
#include "tests/support/temp_folder.h"

namespace trackbed::render {
namespace {

constexpr int kWidth = 320;
constexpr int kHeight = 180;

struct Pixel {
  int x = 0;
  int y = 0;
};

/// Where a pinhole camera sees a point: written from the definition of CameraPose alone.
Pixel Project(const CameraPose& pose, double x, double y, double z) {
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

class FilmSceneTest : public testing::Test {
 protected:
  FilmSceneTest() {
    CopyPrius(folder_.path());
    WritePlant(folder_.path(), "mujoco", 2.0, [](double time) {
      return CarPlace{3.0 * time, 0.0, 0.0};
    });
  }

  Image Picture(const std::string& camera, double time) {
    Recording recording = ReadRecording(folder_.path());
    Offscreen offscreen(*recording.model, kWidth, kHeight, 0);
    FilmScene scene(recording, false);
    const CameraSubject subject(recording);
    pose_ = FindCamera(camera).pose(subject, time, static_cast<double>(kWidth) / kHeight);
    Image image;
    offscreen.Render(scene.At(time, *pose_), image);
    return image;
  }

  /// Channel values of the picture where a point of the ground is.
  std::array<int, 3> At(const Image& image, double x, double y, double z = 0.0) const {
    const Pixel pixel = Project(*pose_, x, y, z);
    EXPECT_TRUE(pixel.x >= 0 && pixel.x < kWidth && pixel.y >= 0 && pixel.y < kHeight)
        << x << ", " << y << " is out of the picture";
    const std::uint8_t* rgb = image.Pixel(pixel.x, pixel.y);
    return {rgb[0], rgb[1], rgb[2]};
  }

  const MuJoCoErrorsAsExceptions guard_;
  TempFolder folder_;
  std::optional<CameraPose> pose_;
};

// Light on flat paint: the lamps of the Prius add up to 0.96 of its colour or more; the asphalt
// between its lines is at most 0.67. A threshold of 225 / 255 = 0.88 lies well between.
constexpr int kWhite = 225;

TEST_F(FilmSceneTest, ThePlannedPathIsWhereItsProjectionSays) {
  WriteStraightPlan(folder_.path(), 16.0);
  for (const char* camera : {"chase", "top"}) {
    const Image image = Picture(camera, 0.0);
    for (const double x : {7.0, 9.0, 11.5, 14.0}) {
      const std::array<int, 3> path = At(image, x, 0.0);
      EXPECT_GT(path[0], kWhite) << camera << " at " << x;
      EXPECT_GT(path[2], kWhite) << camera << " at " << x;
      for (const double beside : {-1.2, 1.2}) {
        EXPECT_LT(At(image, x, beside)[0], kWhite) << camera << " at " << x << ", " << beside;
      }
    }
  }
}

TEST_F(FilmSceneTest, WithoutAPlanTheGroundIsBare) {
  const Image image = Picture("top", 0.0);
  EXPECT_LT(At(image, 6.0, 0.0)[0], kWhite);
}

TEST_F(FilmSceneTest, TheTrailReachesFromTheStartToTheCarAndNoFarther) {
  const Image image = Picture("top", 1.0);
  const auto is_orange = [](const std::array<int, 3>& rgb) { return rgb[0] > rgb[2] + 100; };
  // At 1 s the rear axle is at x = 3 and the car covers 2.2 to 6.6.
  for (const double x : {0.1, 0.7, 1.3}) {
    EXPECT_TRUE(is_orange(At(image, x, 0.0))) << x;
  }
  for (const double x : {-0.6, 7.2, 8.0}) {
    EXPECT_FALSE(is_orange(At(image, x, 0.0))) << x;
  }
}

TEST_F(FilmSceneTest, TheGhostTintsTheGroundUnderItAndNothingElse) {
  const Image alone = Picture("chase", 0.0);
  WritePlant(folder_.path(), "kinematic", 2.0, [](double time) {
    return CarPlace{3.0 * time, 2.5, 0.0};
  });
  const Image with_ghost = Picture("chase", 0.0);
  // The middle of the ghost's left side, half up the door. What shines through is grey; the tint
  // (0.10, 0.75, 0.95) at an opacity of 0.39 takes 0.39 * (0.6 - 0.1) = 0.19 of the red away and
  // leaves blue over red by at least 0.39 * 0.85 * 0.7 = 0.23: 59 of 255. Half of that will do.
  const std::array<int, 3> ghost = At(with_ghost, 1.4, 2.5, 0.6);
  const std::array<int, 3> ground = At(alone, 1.4, 2.5, 0.6);
  EXPECT_GT(ghost[2] - ghost[0], ground[2] - ground[0] + 30);
  EXPECT_NE(ghost[0], 0);  // translucent: not the pure tint
  EXPECT_EQ(At(with_ghost, 1.4, -2.5), At(alone, 1.4, -2.5));
}

TEST_F(FilmSceneTest, AGhostThatAgreesWithTheCarLeavesTheCarAsItIs) {
  const Image alone = Picture("chase", 1.0);
  WritePlant(folder_.path(), "kinematic", 2.0, [](double time) {
    return CarPlace{3.0 * time, 0.0, 0.0};
  });
  const Image with_ghost = Picture("chase", 1.0);
  // The middle of the tailgate: 0.8 m behind the rear axle, which is at x = 3.
  EXPECT_EQ(At(with_ghost, 2.2, 0.0, 0.8), At(alone, 2.2, 0.0, 0.8));
}

TEST_F(FilmSceneTest, PicturesRepeat) {
  EXPECT_TRUE(Picture("chase", 0.7).rgb == Picture("chase", 0.7).rgb);
}

TEST_F(FilmSceneTest, ALongRouteStaysWithinTheScene) {
  // A slalom of 600 m, with a state each 1/60 s: 36 000 rows.
  const auto slalom = [](double time) {
    return CarPlace{1.0 * time, 4.0 * std::sin(0.5 * time), 0.0};
  };
  WritePlant(folder_.path(), "mujoco", 600.0, slalom);
  WritePlant(folder_.path(), "kinematic", 600.0, slalom);
  Recording recording = ReadRecording(folder_.path());
  FilmScene scene(recording, false);
  const CameraSubject subject(recording);
  const double end = recording.end();
  mjvScene& posed = scene.At(end, FindCamera("top").pose(subject, end, 16.0 / 9.0));
  EXPECT_LT(posed.ngeom, posed.maxgeom);
  EXPECT_GT(posed.ngeom, 300);
}

}  // namespace
}  // namespace trackbed::render
