// Tests pictures of uneven ground, friction patches, gusts and the wind arrow. Expected positions
// come from GroundHeight() and the pinhole projection of pictures.h, expected colors from the light
// on the material.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render/caption.h"
#include "render/ground_paint.h"
#include "render/painter.h"
#include "tests/geometry/random.h"
#include "tests/render/pictures.h"
#include "tests/tolerance.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/sim/scene.h"
#include "trackbed/sim/world_scene.h"

namespace trackbed::render {
namespace {

constexpr const char* kHilly = R"(world:
  ground:
    grade: {x: 0.08, y: -0.05}
    bumps: [{x: 9, y: 0, length: 4, width: 6, height: 0.2}]
)";

/// Films of a car that drives along the x axis.
class GroundFilm : public FilmSceneTest {
 protected:
  /// Sets the section `world` of the run's scenario.
  World SetWorld(const std::string& yaml) {
    WriteFileAtomically(folder_.path() / "scenario.resolved.yaml", yaml);
    const World world = ReadRecording(folder_.path()).world;
    WriteScene(WithGround(ComposeScene(FindModel("prius", ""), {}), world.ground),
               folder_.path() / "model.xml");
    return world;
  }

  std::array<int, 3> AtGround(const Image& image, const World& world, double x, double y) const {
    return At(image, x, y, GroundHeight(world, {x, y}));
  }
};

TEST_F(GroundFilm, WithoutAScenarioTheWorldIsFlatAndCalm) {
  const Recording recording = ReadRecording(folder_.path());
  EXPECT_TRUE(IsFlat(recording.world.ground));
  EXPECT_TRUE(IsCalm(recording.world.wind));
  EXPECT_FALSE(recording.ReadingsAt(1.0).wind.has_value());
}

TEST_F(GroundFilm, ABrokenWorldIsSaid) {
  WriteFileAtomically(folder_.path() / "scenario.resolved.yaml", "world: {ground: 3}\n");
  EXPECT_THROW(ReadRecording(folder_.path()), InputError);
}

TEST_F(GroundFilm, ThePlanLiesOnSlopesAndBumps) {
  const World world = SetWorld(kHilly);
  WriteStraightPlan(folder_.path(), 16.0);
  for (const char* camera : {"chase", "top"}) {
    const Image image = Picture(camera, 0.0);
    // The points are before, on and behind the bump, without the part of its far side that the
    // camera behind the car cannot see.
    for (const double x : {6.5, 7.7, 8.3, 9.0, 9.6, 13.0}) {
      // The sun is in the east and provides half of the light. Ground that is tilted by 0.18 to the
      // west receives a fifth less sunlight, so paint has at least 0.96 * 0.89 = 0.85 of white.
      // Asphalt has 0.67.
      EXPECT_GT(AtGround(image, world, x, 0.0)[0], 200) << camera << " at " << x;
      for (const double beside : {-1.2, 1.2}) {
        EXPECT_LT(AtGround(image, world, x, beside)[0], 200) << camera << " at " << x;
      }
    }
  }
}

TEST_F(GroundFilm, TheTrailLiesOnSlopesAndBumps) {
  const World world = SetWorld(kHilly);
  WritePlant(folder_.path(), "mujoco", 5.0, [](double time) {
    return CarPlace{3.0 * time, 0.0, 0.0};
  });
  const Image image = Picture("top", 5.0);
  for (const double x : {2.0, 7.5, 8.2, 9.0, 10.1, 11.5}) {
    const std::array<int, 3> trail = AtGround(image, world, x, 0.0);
    EXPECT_GT(trail[0], trail[2] + 80) << x;  // orange
  }
}

TEST_F(GroundFilm, CamerasGoUpAndDownWithTheGround) {
  SetWorld("world: {ground: {grade: {x: 0.1, y: 0}}}\n");
  WritePlant(folder_.path(), "mujoco", 20.0, [](double time) {
    return CarPlace{3.0 * time, 0.0, 0.0};
  });
  const Recording recording = ReadRecording(folder_.path());
  const CameraSubject subject(recording);
  for (const auto& [camera, above] : {std::pair{"chase", 1.0}, {"side", 0.7}, {"top", 0.0}}) {
    const CameraPose pose = FindCamera(camera).pose(subject, 10.0, 1.8);
    // The height is linear, so its mean over a symmetric window is its value in the middle.
    EXPECT_NEAR(pose.ground_z, 0.1 * pose.target_x, Tolerance(1e-9)) << camera;
    EXPECT_NEAR(pose.target_z, pose.ground_z + above, Tolerance(1e-9)) << camera;
  }
  const CameraPose chase = FindCamera("chase").pose(subject, 10.0, 1.8);
  // The camera looks 18 degrees down relative to the slope of the hill along the camera's azimuth.
  EXPECT_NEAR(chase.elevation, -18.0 * kPi / 180.0 + std::atan(0.1 * std::cos(chase.azimuth)),
              Tolerance(1e-12));
}

TEST_F(GroundFilm, DownASteepHillTheSkyIsDrawn) {
  SetWorld("world: {ground: {grade: {x: -0.5, y: 0}}}\n");
  const Image image = Picture("chase", 0.0);
  // The hill's horizon is 26.6 degrees down, and the picture's upper edge is 18 + 26.6 - 20 = 24.6
  // degrees down. Therefore the upper 2 of the 40 degrees of the picture show sky. Sky is blue, and
  // asphalt is gray.
  const std::uint8_t* rgb = image.Pixel(kWidth / 2, 1);
  EXPECT_GT(rgb[2], rgb[0] + 8);
}

TEST_F(GroundFilm, PatchesAreWhereTheyAreAndIceIsBlue) {
  const World world = SetWorld(R"(world:
  friction_patches:
    - {x: 10, y: 1.5, length: 6, width: 2, friction: 0.1}
    - {x: 10, y: -1.5, length: 6, width: 2, friction: 0.5}
)");
  const Image image = Picture("top", 0.0);
  WriteFileAtomically(folder_.path() / "scenario.resolved.yaml", "schema: 1\n");
  const Image bare = Picture("top", 0.0);
  for (const double x : {8.0, 10.0, 12.0}) {
    const std::array<int, 3> ice = At(image, x, 1.5);
    const std::array<int, 3> wet = At(image, x, -1.5);
    // Ice is (0.66, 0.87, 1.00) with an opacity of 0.70 over gray, so blue exceeds red by 0.24,
    // which is 61 of 255. Wet asphalt has less red than dry asphalt by at least 0.58 * (0.62 -
    // 0.27) = 0.20, which is 51 of 255.
    EXPECT_GT(ice[2], ice[0] + 40) << x;
    EXPECT_LT(wet[0], At(bare, x, -1.5)[0] - 35) << x;
    EXPECT_EQ(At(image, x, 0.0), At(bare, x, 0.0)) << x;
    EXPECT_EQ(At(image, x, 3.0), At(bare, x, 3.0)) << x;
  }
  EXPECT_EQ(At(image, 6.5, 1.5), At(bare, 6.5, 1.5));
}

TEST(PatchTiles, OnAPlaneAreOnePerPatchLaterOnesAbove) {
  World world;
  world.ground.grade = {0.05, 0.1};
  world.friction_patches = {{{{3.0, 4.0, 0.6}, 30.0, 3.0}, 0.1},
                            {{{3.0, 4.0, 0.0}, 5.0, 9.0}, 0.5}};
  const std::vector<Tile> tiles = PatchTiles(world);
  ASSERT_EQ(tiles.size(), 2U);
  const Eigen::Vector3d normal = GroundNormal(world, {});
  double below = 0.0;
  for (const Tile& tile : tiles) {
    EXPECT_NEAR((tile.rotation.col(2) - normal).norm(), 0.0, Tolerance(1e-12));
    const double above = normal.dot(tile.center);
    EXPECT_GT(above, below + 2e-4);
    EXPECT_LT(above, 0.002);  // height at which ribbons begin
    below = above;
  }
}

TEST(PatchTiles, FollowTheGroundAndCoverThePatch) {
  World world;
  world.ground.grade = {0.05, 0.0};
  world.ground.bumps = {{.area = {{10.0, 0.0, 0.3}, 4.0, 6.0}, .height = 0.1}};
  world.ground.side_slopes = {
      {.area = {{40.0, 0.0, 0.0}, 30.0, 8.0}, .slope = 0.08, .transition_length = 10.0}};
  world.friction_patches = {{{{30.0, 0.0, 0.1}, 60.0, 3.0}, 0.1}};
  const OrientedBox& area = world.friction_patches[0].area;
  const std::vector<Tile> tiles = PatchTiles(world);
  EXPECT_LT(tiles.size(), 500U);
  double covered = 0.0;
  double lowest = 1.0;
  double highest = -1.0;
  Random random(4);
  for (const Tile& tile : tiles) {
    // Area projected on the horizontal plane.
    covered += 4.0 * tile.half_length * tile.half_width * tile.rotation(2, 2);
    for (int i = 0; i < 10; ++i) {
      const Eigen::Vector3d p =
          tile.center +
          tile.rotation * Eigen::Vector3d(random.Uniform(-1.0, 1.0) * tile.half_length,
                                          random.Uniform(-1.0, 1.0) * tile.half_width, 0.0);
      const double above = p.z() - GroundHeight(world, p.head<2>());
      lowest = std::min(lowest, above);
      highest = std::max(highest, above);
    }
  }
  // The tiles are rectangles, so they overlap slightly on curved ground.
  EXPECT_NEAR(covered, area.length * area.width, Tolerance(0.01 * area.length * area.width));
  // Tiles lie 1 mm above the ground. The curvature of the ground along the grid lines changes this
  // height by up to 1.5 mm, and the twist between the lines by another 1.5 mm. At the sides of the
  // bump, where tiles have their minimum size, 1 mm is added.
  EXPECT_GT(lowest, Tolerance(-3e-3));
  EXPECT_LT(highest, Tolerance(5e-3));
}

TEST_F(GroundFilm, AGustIsOutlinedWhileItBlows) {
  const World world = SetWorld(R"(world:
  ground: {grade: {x: 0.05}}
  wind: {gusts: [{y: 10, from: 0.5, duration: 1, area: {x: 10, y: 0, length: 8, width: 4}}]}
)");
  const auto is_violet = [&](double time, double x, double y) {
    const Image image = Picture("top", time);
    const std::array<int, 3> rgb = AtGround(image, world, x, y);
    return rgb[2] > rgb[1] + 40;
  };
  EXPECT_FALSE(is_violet(0.3, 10.0, 2.0));
  EXPECT_TRUE(is_violet(1.0, 10.0, 2.0));
  EXPECT_TRUE(is_violet(1.0, 14.0, 0.5));
  EXPECT_FALSE(is_violet(1.0, 10.0, 1.0));
  EXPECT_FALSE(is_violet(1.7, 10.0, 2.0));
}

TEST_F(GroundFilm, TheLegendNamesFrictionAndGusts) {
  SetWorld(R"(world:
  friction_patches:
    - {x: 10, y: 1.5, length: 6, width: 2, friction: 0.5}
    - {x: 10, y: -1.5, length: 6, width: 2, friction: 0.1}
    - {x: 20, y: -1.5, length: 6, width: 2, friction: 0.5}
  wind: {gusts: [{y: 10, shape: step, area: {x: 10, y: 0, length: 8, width: 4}}]}
)");
  std::vector<std::string> texts;
  const Recording recording = ReadRecording(folder_.path());
  for (const LegendEntry& entry : MakeLegend(recording, Overlays(recording))) {
    texts.push_back(entry.text);
  }
  EXPECT_EQ(texts,
            (std::vector<std::string>{"mujoco", "wind", "gust", "friction x0.1", "friction x0.5"}));
}

TEST_F(GroundFilm, TheCaptionTellsTheWindAtTheCar) {
  SetWorld(R"(world:
  wind: {x: 1, gusts: [{y: 10, shape: step, area: {x: 6, y: 0, length: 2, width: 4}}]}
)");
  const Recording recording = ReadRecording(folder_.path());
  EXPECT_EQ(recording.ReadingsAt(1.0).wind, Vec2(1.0, 0.0));  // at x = 3
  EXPECT_EQ(recording.ReadingsAt(1.9).wind, Vec2(1.0, 10.0));
}

/// A font with blank glyphs, so that no visible pixel is text.
Font BlankFont() {
  Image glyph;
  glyph.Resize(40, 80);
  return Font(std::vector<Image>(Font::kLast - Font::kFirst + 1, glyph));
}

/// Centroid of the light that `image` has in addition to `without`, y up.
Vec2 MiddleOfLight(const Image& image, const Image& without) {
  Vec2 sum = Vec2::Zero();
  double light = 0.0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const double here = image.Pixel(x, y)[0] - without.Pixel(x, y)[0];
      sum += here * Vec2(x + 0.5, -y - 0.5);
      light += here;
    }
  }
  EXPECT_GT(light, 0.0);
  return sum / light;
}

TEST(Canvas, AnArrowsHeadIsWhereItPoints) {
  Font font = BlankFont();
  for (const double direction : {0.0, 0.7, 0.5 * kPi, kPi, -0.5 * kPi}) {
    Image image;
    image.Resize(60, 60);
    const Image black = image;
    Canvas canvas(image, font);
    canvas.Arrow(30.0, 30.0, 40.0, direction, {1.0F, 1.0F, 1.0F});
    // In units of its length, the arrow has a shaft of 0.6 x 0.16 with its centroid at -0.2, and a
    // triangular head of the area 0.4 x 0.52 / 2 with its centroid at 0.1 + 0.4 / 3.
    const double lean = 40.0 * (0.096 * -0.2 + 0.104 * (0.1 + 0.4 / 3.0)) / 0.2;  // 1.01
    const Vec2 off = MiddleOfLight(image, black) - Vec2(30.0, -30.0);
    // The tolerance covers the sampling with 16 samples per pixel.
    EXPECT_NEAR((off - lean * Direction(direction)).norm(), 0.0, Tolerance(0.15)) << direction;
  }
}

TEST(DrawCaption, TheWindsArrowPointsUpWhereTheCameraLooks) {
  Font font = BlankFont();
  const auto picture = [&](const Vec2& wind, double azimuth) {
    Readings readings;
    readings.wind = wind;
    Image image;
    image.Resize(1920, 1080);
    DrawCaption(image, font, {.title = "run"}, readings, azimuth, 1000.0);
    return image;
  };
  const Image calm = picture({0.0, 0.01}, 0.0);  // has no arrow
  const auto lean = [&](const Vec2& wind, double azimuth) {
    // Arrows of opposite winds have the same center and lean in opposite directions.
    return Vec2(MiddleOfLight(picture(wind, azimuth), calm) -
                MiddleOfLight(picture(-wind, azimuth), calm))
        .normalized();
  };
  // The tolerance of 0.1 covers the size of pixels.
  EXPECT_NEAR((lean({0.0, 5.0}, 0.5 * kPi) - Vec2(0.0, 1.0)).norm(), 0.0, Tolerance(0.1));
  EXPECT_NEAR((lean({5.0, 0.0}, 0.5 * kPi) - Vec2(1.0, 0.0)).norm(), 0.0, Tolerance(0.1));
  EXPECT_NEAR((lean({5.0, 0.0}, 0.0) - Vec2(0.0, 1.0)).norm(), 0.0, Tolerance(0.1));
  EXPECT_NEAR((lean({0.0, 5.0}, 0.0) - Vec2(-1.0, 0.0)).norm(), 0.0, Tolerance(0.1));
}

}  // namespace
}  // namespace trackbed::render
