#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "render/obstacles.h"
#include "render/occlusion.h"
#include "tests/render/pictures.h"
#include "tests/tolerance.h"

namespace trackbed::render {
namespace {

TEST(ObstacleLook, FollowsFromTheSize) {
  EXPECT_EQ(ChooseLook(4.4, 1.8, 1.5), ObstacleLook::kCar);
  EXPECT_EQ(ChooseLook(1.8, 4.4, 1.5), ObstacleLook::kCar);
  EXPECT_EQ(ChooseLook(4.4, 1.8, 0.6), ObstacleLook::kCrate);
  EXPECT_EQ(ChooseLook(34.0, 0.6, 2.0), ObstacleLook::kWall);
  EXPECT_EQ(ChooseLook(0.4, 0.4, 0.7), ObstacleLook::kCone);
  EXPECT_EQ(ChooseLook(0.4, 0.4, 2.0), ObstacleLook::kPost);
  EXPECT_EQ(ChooseLook(2.0, 2.0, 1.0), ObstacleLook::kCrate);
}

/// A car that drives along the x axis, and one obstacle.
class ObstacleTest : public FilmSceneTest {
 protected:
  ObstacleTest() { overlays_ = {"obstacles"}; }

  void SetObstacle(double x, double y, double length, double width, double height,
                   const std::string& more = "") {
    InsertIntoModel(folder_.path(),
                    fmt::format("<geom name='obstacle_0' type='box' pos='{} {} {}' size='{} {} {}' "
                                "rgba='0.78 0.15 0.2 1'/>",
                                x, y, 0.5 * height, 0.5 * length, 0.5 * width, 0.5 * height));
    WriteFileAtomically(
        folder_.path() / "scenario.resolved.yaml",
        fmt::format("schema: 1\nname: run\nmission: {{speed: 3, waypoints: [[0, 0], [20, 0]]}}\n"
                    "world:\n  obstacles:\n    - {{box: {{x: {}, y: {}, length: {}, width: {}, "
                    "height: {}}}{}}}\n",
                    x, y, length, width, height, more));
  }
  /// Brightest red across the left upper edge of the crate; the edge is thinner than two pixels.
  int BrightestOfEdge(const Image& image) const {
    int most = 0;
    for (int i = -6; i <= 6; ++i) {
      most = std::max(most, At(image, 10.0, 4.02 + 0.02 * i, 1.0)[0]);
    }
    return most;
  }
  /// Passes the scene at a time to `look`, with the centers and sides of the drawn obstacle.
  template <typename Look>
  void AtScene(double time, const char* camera, const Look& look) {
    Recording recording = ReadRecording(folder_.path());
    const CameraSubject subject(recording);
    const OverlayList overlays = Overlays(recording);
    FilmScene scene(recording, overlays, false);
    look(recording, scene.At(time, FindCamera(camera).pose(subject, time, 16.0 / 9.0)));
  }
};

TEST_F(ObstacleTest, OneThatIsNotKnownIsAnOutlineAndThenACrate) {
  SetObstacle(10.0, 3.0, 2.0, 2.0, 1.0, ", known_from: {time: 0.2}");
  const Image before = Picture("top", 0.1);
  const std::array<int, 3> ground = At(before, 7.0, 3.0);
  // The middle of its top is transparent, its upper edge is white.
  const std::array<int, 3> through = At(before, 10.0, 3.0, 1.0);
  EXPECT_NEAR(through[0], ground[0], 30);
  EXPECT_LT(std::abs(through[0] - through[2]), 20);
  EXPECT_GT(BrightestOfEdge(before), 230);
  // Wood, (0.72, 0.61, 0.44), has much more red than blue.
  const Image after = Picture("top", 0.2);
  EXPECT_GT(At(after, 10.0, 3.0, 1.0)[0], At(after, 10.0, 3.0, 1.0)[2] + 40);
  // The outline has twelve white edges and remains for 1.5 s.
  const auto white_edges = [this](double time) {
    int count = 0;
    AtScene(time, "top", [&](const Recording&, const mjvScene& scene) {
      for (int i = 0; i < scene.ngeom; ++i) {
        count += scene.geoms[i].objtype == mjOBJ_UNKNOWN && scene.geoms[i].rgba[2] > 0.97F ? 1 : 0;
      }
    });
    return count;
  };
  EXPECT_EQ(white_edges(0.1), 12);
  EXPECT_EQ(white_edges(0.3), 12);
  EXPECT_EQ(white_edges(1.69), 12);
  EXPECT_EQ(white_edges(1.71), 0);
}

TEST_F(ObstacleTest, OneOfTheSizeOfACarIsACarThatFillsItsBox) {
  SetObstacle(14.0, 4.0, 4.0, 1.9, 1.4);
  AtScene(0.0, "side", [](const Recording& recording, const mjvScene& scene) {
    const int box = ObstacleGeoms(recording).front();
    double low = 1e9;
    double high = -1e9;
    for (int i = 0; i < scene.ngeom; ++i) {
      const mjvGeom& geom = scene.geoms[i];
      EXPECT_FALSE(geom.objtype == mjOBJ_GEOM && geom.objid == box);  // the vehicle replaces it
      // Wheels are cylinders as wide as the Prius's tyres, whose hubs are 2.7 m apart.
      if (geom.type == mjGEOM_CYLINDER && geom.objtype != mjOBJ_GEOM && geom.size[0] > 0.30F) {
        low = std::min<double>(low, geom.pos[0]);
        high = std::max<double>(high, geom.pos[0]);
      }
    }
    // The vehicle is scaled from 4.45 to 4.0 m about its center, which is 1.4 m ahead of its rear
    // axle.
    EXPECT_NEAR(high - low, 2.7 * 4.0 / 4.45, Tolerance(1e-4));
    EXPECT_NEAR(low, 14.0 - 1.4 * 4.0 / 4.45, Tolerance(1e-4));
  });
}

TEST_F(ObstacleTest, WhatStandsBetweenTheCameraAndTheCarFades) {
  // The camera `side` is 12.7 m to the right of the car: a wall 4 m to the right is between them, a
  // wall on the left is not.
  for (const auto& [y, hides] : {std::pair(-4.0, true), std::pair(4.0, false)}) {
    std::filesystem::remove(folder_.path() / "model.xml");
    CopyPrius(folder_.path());
    SetObstacle(1.4, y, 12.0, 0.6, 2.0);
    AtScene(0.0, "side", [hidden = hides](const Recording& recording, const mjvScene& scene) {
      const int wall = ObstacleGeoms(recording).front();
      mjvGeom* const end = scene.geoms + scene.ngeom;
      const mjvGeom* const geom = std::find_if(scene.geoms, end, [&](const mjvGeom& each) {
        return each.objtype == mjOBJ_GEOM && each.objid == wall;
      });
      ASSERT_NE(geom, end);
      EXPECT_NEAR(geom->rgba[3], hidden ? 0.25 : 1.0, Tolerance(1e-6));
    });
  }
}

TEST(Occlusion, IsTheShareOfLinesOfSightThatTheBoxCrosses) {
  // The camera looks along x from (-20, 0, 1) at the origin, where the car's box is.
  CameraPose camera;
  camera.distance = 20.0;
  camera.target_z = 1.0;
  const CarBox car{.middle = 0.0, .half_length = 2.0, .half_width = 1.0, .height = 1.5};
  const auto share = [&](double y, double width, double top) {
    return HiddenShare({{{-10.0, y, 0.0}, 1.0, width}, 0.0, top}, camera, car, {0.0, 0.0, 0.0},
                       0.0);
  };
  EXPECT_EQ(share(0.0, 20.0, 5.0), 1.0);
  EXPECT_EQ(share(8.0, 2.0, 5.0), 0.0);
  // With its margin of 0.5 m, the wall begins at y = 0.2 m. The camera has lines of sight to the
  // points at y = -0.8, 0 and 0.8 m. Only the last line crosses the wall, at y = 0.33 to 0.48 m.
  EXPECT_NEAR(share(3.2, 5.0, 5.0), 1.0 / 3.0, Tolerance(1e-9));
  EXPECT_EQ(FadedAlpha(0.0), 1.0);
  EXPECT_DOUBLE_EQ(FadedAlpha(1.0), 0.25);
  EXPECT_GT(FadedAlpha(0.1), FadedAlpha(0.2));
}

}  // namespace
}  // namespace trackbed::render
