#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render/car_box.h"
#include "render/isolines.h"
#include "render/lateral.h"
#include "render/mujoco_compat.h"
#include "render/relief.h"
#include "tests/render/pictures.h"
#include "tests/tolerance.h"
#include "trackbed/core/angle.h"
#include "trackbed/sim/car_model.h"
#include "trackbed/sim/scene.h"
#include "trackbed/sim/trailer_scene.h"

/// Tests contour lines, gates, plain ground, the flat view of the inset, and cameras.
namespace trackbed::render {
namespace {

TEST(Isolines, OfAPlaneAreStraightAndExact) {
  const IsolineGrid grid({0.0, 0.0}, {10.0, 4.0}, 0.5,
                         [](const Vec2& p) { return 0.3 * p.x() + 0.1 * p.y(); });
  EXPECT_DOUBLE_EQ(grid.lowest(), 0.0);
  EXPECT_NEAR(grid.highest(), 3.4, Tolerance(1e-12));
  const std::vector<std::vector<Vec2>> lines = grid.At(1.55);
  ASSERT_EQ(lines.size(), 1U);
  for (const Vec2& point : lines.front()) {
    EXPECT_NEAR(0.3 * point.x() + 0.1 * point.y(), 1.55, Tolerance(1e-12));
  }
  EXPECT_NEAR(std::abs(lines.front().front().y() - lines.front().back().y()), 4.0,
              Tolerance(1e-12));
  EXPECT_TRUE(grid.At(9.0).empty());
}

TEST(Isolines, AroundAHillClose) {
  const IsolineGrid grid({-3.0, -3.0}, {3.0, 3.0}, 0.1,
                         [](const Vec2& p) { return -p.squaredNorm(); });
  const std::vector<std::vector<Vec2>> lines = grid.At(-4.0);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines.front().front(), lines.front().back());
  double length = 0.0;
  for (std::size_t i = 1; i < lines.front().size(); ++i) {
    length += (lines.front()[i] - lines.front()[i - 1]).norm();
    // Along a cell side of 0.1 m, the height is a parabola that deviates from its chord by 0.1^2 /
    // 4 = 2.5e-3. On contour lines with a slope of 4 or 2.8, this moves the line by less than 1e-3
    // m.
    EXPECT_NEAR(lines.front()[i].norm(), 2.0, Tolerance(1e-3));
  }
  EXPECT_NEAR(length, 4.0 * kPi, Tolerance(0.02));
}

TEST(Isolines, OfASaddleKeepApart) {
  const IsolineGrid grid({0.0, 0.0}, {1.0, 1.0}, 1.0, [](const Vec2& p) {
    return p.x() == p.y() ? 1.0 : 0.0;  // above the level at two opposite corners
  });
  EXPECT_EQ(grid.At(0.5).size(), 2U);
}

TEST(ContourIntervals, AreRoundAndLeaveAtMost40Lines) {
  EXPECT_DOUBLE_EQ(ContourInterval(14.0), 0.5);
  EXPECT_DOUBLE_EQ(ContourInterval(3.0), 0.1);
  for (const double span : {0.05, 0.3, 7.7, 123.0}) {
    EXPECT_LE(span / ContourInterval(span), 40.0);
  }
}

TEST_F(FilmSceneTest, ContoursLieWhereTheGroundHasTheirHeight) {
  overlays_ = {"relief"};
  WriteFileAtomically(folder_.path() / "scenario.resolved.yaml",
                      "schema: 1\nname: run\nmission: {speed: 3, waypoints: [[0, 0], [20, 0]]}\n"
                      "world: {ground: {grade: {x: 0.05}}}\n");
  // From x = -30 to 36 m, the ground rises by 3.3 m. The 33 contour lines, one per 0.1 m of height,
  // are 2 m apart.
  Picture("top", 0.0);
  Recording recording = ReadRecording(folder_.path());
  const CameraPose camera = FindCamera("top").pose(CameraSubject(recording), 0.0, 16.0 / 9.0);
  const OverlayList overlays = Overlays(recording);
  const OverlayList none;
  FilmScene with(recording, overlays, false);
  FilmScene without(recording, none, false);
  const int bare = without.At(0.0, camera).ngeom;
  const mjvScene& scene = with.At(0.0, camera);
  EXPECT_EQ(scene.ngeom - bare, 33);
  for (int i = bare; i < scene.ngeom; ++i) {
    const double lines = scene.geoms[i].pos[0] / 2.0;
    EXPECT_NEAR(lines, std::round(lines), Tolerance(1e-3));
  }
  overlays_ = {"relief"};
  std::filesystem::remove(folder_.path() / "scenario.resolved.yaml");
  EXPECT_EQ(Overlays(ReadRecording(folder_.path())).front()->max_shapes(), 0U);
}

TEST_F(FilmSceneTest, GatesAreOutlinedBetweenTheirCones) {
  overlays_ = {"gates"};
  WriteStraightPlan(folder_.path(), 16.0);
  WriteFileAtomically(folder_.path() / "plan.json",
                      R"({"method": "fillet", "gates": [
                          {"cones_m": [[6, 1.5], [6, -1.5], [8, 1.5], [8, -1.5], [10, 1.5], [10, -1.5]]}]})");
  const Image image = Picture("top", 0.0);
  for (const double x : {7.0, 9.0}) {
    EXPECT_GT(At(image, x, 1.5)[0], 200) << x;
    EXPECT_GT(At(image, x, -1.5)[0], 200) << x;
    EXPECT_LT(At(image, x, 0.7)[0], 200) << x;
  }
  // Checks the lines at the exit and the entry. The camera shows 20 m in 180 rows, so a pixel is
  // 0.11 m, and the lines are 0.13 m wide.
  for (const double x : {6.0, 10.0}) {
    int most = 0;
    for (int i = -5; i <= 5; ++i) {
      most = std::max(most, At(image, x + 0.02 * i, 0.8)[0]);
    }
    EXPECT_GT(most, 200) << x;
  }
  EXPECT_EQ(ReadRecording(folder_.path()).cones.size(), 6U);
}

TEST_F(FilmSceneTest, PlainGroundKeepsItsColorAndHasLinesOnRequest) {
  Recording recording = ReadRecording(folder_.path());
  mjModel& model = *recording.model;
  const int material = model.geom_matid[mj_name2id(&model, mjOBJ_GEOM, "ground")];
  const int texture = mj::ColorTexture(model, material);
  const int side = model.tex_width[texture];
  ASSERT_EQ(model.tex_height[texture], side);
  const mjtByte* pixels = mj::Pixels(model, texture).first;
  ASSERT_EQ(mj::Pixels(model, texture).channels, 3);
  const auto mean = [&] {
    double sum = 0.0;
    for (int i = 0; i < 3 * side * side; ++i) {
      sum += pixels[i];
    }
    return sum / (3.0 * side * side);
  };
  const double before = mean();
  MakeGroundPlain(model, false);
  // The mean of noise with the amplitude 0.03 in at least 7 x 7 cells has a standard deviation of
  // 0.03 / sqrt(3) / 7 = 0.25 %.
  EXPECT_NEAR(mean(), before, Tolerance(3.0 * 0.0025 * before + 0.5));
  EXPECT_FLOAT_EQ(model.mat_texrepeat[2 * material], 0.1F);
  const auto least_of_row = [&](int row) {
    int least = 255;
    for (int i = 0; i < side; ++i) {
      least = std::min<int>(least, pixels[3 * (row * side + i)]);
    }
    return least;
  };
  // The texture of 10 m has a line in its middle, along its whole length. The line is brighter
  // than the mean by the factor 1.12, the grain of the texture by at most 1.10. Red is slightly
  // darker than the mean of all channels.
  EXPECT_LT(least_of_row(side / 2), before);
  MakeGroundPlain(model, true);
  EXPECT_GT(least_of_row(side / 2), 1.05 * before);
  EXPECT_LT(least_of_row(side / 4), before);
}

TEST_F(FilmSceneTest, TheCarsPaintIsItsPlantsAndItsGlassIsNot) {
  const Recording recording = ReadRecording(folder_.path());
  const mjModel& model = *recording.model;
  const std::vector<CarPart> parts = FindCarParts(model);
  const auto of_mesh = [&](const char* name) {
    const int mesh = mj_name2id(&model, mjOBJ_MESH, name);
    for (int i = 0; i < model.ngeom; ++i) {
      if (model.geom_dataid[i] == mesh && model.geom_type[i] == mjGEOM_MESH) {
        return parts[static_cast<std::size_t>(i)];
      }
    }
    return CarPart{};
  };
  EXPECT_TRUE(of_mesh("hood").painted);
  EXPECT_FALSE(of_mesh("cabin").painted);
  EXPECT_FALSE(parts[static_cast<std::size_t>(mj_name2id(&model, mjOBJ_GEOM, "ground"))].of_car);
}

class LateralTest : public FilmSceneTest {
 protected:
  LateralTest() {
    WritePlant(folder_.path(), "kinematic", 2.0, [](double time) {
      return CarPlace{3.0 * time, 0.0, 0.0};
    });
    WriteStraightPlan(folder_.path(), 16.0);
    SetLogColumn(folder_.path(), "mujoco", "cross_track_m", [](double) { return 0.4; });
    SetLogColumn(folder_.path(), "kinematic", "cross_track_m", [](double) { return -0.2; });
    SetLogColumn(folder_.path(), "kinematic", "s_m", [](double time) { return 3.0 * time + 2.0; });
  }
};

TEST_F(LateralTest, ShowsDistancesTenTimesAsLargeAsStations) {
  const Recording recording = ReadRecording(folder_.path());
  const LateralView view(recording);
  // The view shows 40 m of the path in 400 px, with the car at three quarters of the width. This is
  // 10 px per meter along the path and 100 px per meter across.
  const CanvasPoint here = view.Place(400, 220, 6.0, 6.0, 0.0);
  EXPECT_DOUBLE_EQ(here.x, 300.0);
  EXPECT_DOUBLE_EQ(here.y, 110.0);
  const CanvasPoint there = view.Place(400, 220, 6.0, 2.0, 0.4);
  EXPECT_NEAR(there.x, 260.0, Tolerance(1e-9));
  EXPECT_NEAR(there.y, 70.0, Tolerance(1e-9));
  Image image;
  image.Resize(400, 220);
  view.Draw(image, font_, 2.0);
  // Behind the car is its orange trace, 0.4 m to the left. The blue trace of the other plant is 0.2
  // m to the right and reaches 2 m farther along the path. Nothing is drawn ahead of both plants.
  const auto rgb = [&](int x, int y) {
    const std::uint8_t* pixel = image.Pixel(x, y);
    return std::array<int, 3>{pixel[0], pixel[1], pixel[2]};
  };
  EXPECT_GT(rgb(270, 70)[0], rgb(270, 70)[2] + 150);
  EXPECT_GT(rgb(310, 130)[2], rgb(310, 130)[0] + 100);
  EXPECT_LT(rgb(330, 70)[0], 120);
  EXPECT_LT(rgb(345, 130)[2], 120);
  EXPECT_GT(rgb(50, 110)[0], 200);  // the path
}

TEST_F(LateralTest, GoesOutWhereTheErrorHasNoRoom) {
  SetLogColumn(folder_.path(), "mujoco", "cross_track_m", [](double) { return 3.0; });
  const Recording recording = ReadRecording(folder_.path());
  // The error scale of 5 m fills 0.85 of the 110 px on each side, without tenfold magnification.
  const CanvasPoint place = LateralView(recording).Place(400, 220, 6.0, 6.0, 5.0);
  EXPECT_NEAR(place.y, 110.0 - 0.85 * 110.0, Tolerance(1e-9));
}

class CameraTest : public FilmSceneTest {
 protected:
  CameraPose Pose(const char* camera, double time, double aspect = 16.0 / 9.0) const {
    const Recording recording = ReadRecording(folder_.path());
    return FindCamera(camera).pose(CameraSubject(recording), time, aspect);
  }
  static Eigen::Vector3d Eye(const CameraPose& pose) {
    return {pose.target_x - pose.distance * std::cos(pose.elevation) * std::cos(pose.azimuth),
            pose.target_y - pose.distance * std::cos(pose.elevation) * std::sin(pose.azimuth),
            pose.target_z - pose.distance * std::sin(pose.elevation)};
  }
};

TEST_F(CameraTest, ChaseSwingsRoundInReverse) {
  // The car drives forward for 3 s, stands until 4 s and then drives in reverse.
  WritePlant(folder_.path(), "mujoco", 8.0, [](double time) {
    return CarPlace{time < 3.0   ? 3.0 * time
                    : time < 4.0 ? 9.0
                                 : 9.0 - 3.0 * (time - 4.0),
                    0.0, 0.0};
  });
  SetLogColumn(folder_.path(), "mujoco", "speed_mps", [](double time) {
    return time < 3.0 ? 3.0 : time < 4.0 ? 0.0 : -3.0;
  });
  const double aside = 14.0 * kPi / 180.0;
  EXPECT_NEAR(Pose("chase", 1.5).azimuth, aside, Tolerance(1e-9));
  // A standing car keeps its last gear up to 0.8 s before it moves.
  EXPECT_NEAR(Pose("chase", 3.1).azimuth, aside, Tolerance(1e-9));
  EXPECT_NEAR(Pose("chase", 6.0).azimuth, kPi + aside, Tolerance(1e-9));
  // At the change of gear, the camera has turned halfway. Samples 0.05 s apart and rows 0.02 s
  // apart each cause an error of the camera's azimuth of up to pi/16.
  EXPECT_NEAR(Pose("chase", 4.0).azimuth, 0.5 * kPi + aside, Tolerance(kPi / 16.0));
  // Looking backward, the camera is ahead of the car.
  EXPECT_GT(Eye(Pose("chase", 6.0)).x(), 3.0 + 3.6);
}

TEST_F(CameraTest, DriverSitsInTheCarAndLooksAhead) {
  WritePlant(folder_.path(), "mujoco", 2.0, [](double time) {
    return CarPlace{5.0 * std::sin(time), 5.0 - 5.0 * std::cos(time), time};
  });
  const CameraPose pose = Pose("driver", 1.0);
  EXPECT_TRUE(pose.inside);
  EXPECT_NEAR(pose.azimuth, 1.0, Tolerance(1e-3));
  // The seat is at the center of the Prius, 1.4 m ahead of its rear axle, and 0.45 of half its
  // width to the left.
  const Vec2 seat =
      ToWorld({5.0 * std::sin(1.0), 5.0 - 5.0 * std::cos(1.0), 1.0}, {1.4, 0.45 * 0.8625});
  const Eigen::Vector3d eye = Eye(pose);
  EXPECT_NEAR(eye.x(), seat.x(), Tolerance(2e-3));  // interpolation between states 1/60 s apart
                                                    // errs by 5 / 8 / 60^2
  EXPECT_NEAR(eye.y(), seat.y(), Tolerance(2e-3));
  EXPECT_NEAR(eye.z(), 0.82 * 1.49, Tolerance(1e-9));
  // The car is not drawn: no paint where its hood would be.
  overlays_.clear();
  Recording recording = ReadRecording(folder_.path());
  const OverlayList none;
  FilmScene scene(recording, none, false);
  const mjvScene& posed = scene.At(1.0, pose);
  const std::vector<CarPart> parts = FindCarParts(*recording.model);
  for (int i = 0; i < posed.ngeom; ++i) {
    EXPECT_FALSE(posed.geoms[i].objtype == mjOBJ_GEOM &&
                 parts[static_cast<std::size_t>(posed.geoms[i].objid)].of_car);
  }
}

TEST_F(CameraTest, StandsNearerToSmallCars) {
  WritePlant(folder_.path(), "mujoco", 2.0, [](double time) { return CarPlace{time, 0.0, 0.0}; });
  const double full_size = Pose("chase", 1.0).distance;
  const std::filesystem::path model = folder_.path() / "model.xml";
  std::string xml = ReadFile(model);
  const std::string size = "2.225 0.8625 0.745";
  ASSERT_NE(xml.find(size), std::string::npos);
  xml.replace(xml.find(size), size.size(), "0.2 0.08 0.07");
  WriteFileAtomically(model, xml);
  // The car is 0.4 m long, a tenth of the length of 4 m from which cars count as full-size.
  for (const char* camera : {"chase", "side", "orbit", "top"}) {
    EXPECT_LT(Pose(camera, 1.0).paint_scale, 0.2) << camera;
  }
  EXPECT_NEAR(Pose("chase", 1.0).distance, 0.1 * full_size, Tolerance(1e-9));
}

TEST(CarBox, EndsAtTheRearOfTheTrailer) {
  const CarModel bare(ComposeScene(FindModel("prius", ""), {}), "prius");
  EXPECT_EQ(FindCarBox(*bare.get()).towed, 0.0);
  const TrailerParams trailer =
      MakeTrailer({.tongue = 3.3, .length = 2.0, .body_ahead = 0.2}, bare.params());
  const CarModel towing(WithTrailer(bare, trailer), "prius");
  // The body reaches from the hitch back by tongue - body_ahead + length/2 = 4.1 m.
  EXPECT_NEAR(FindCarBox(*towing.get()).towed, trailer.hitch - bare.params().rear_overhang + 4.1,
              Tolerance(1e-9));
}

TEST_F(CameraTest, OrbitGoesRoundTheCarIn24Seconds) {
  WritePlant(folder_.path(), "mujoco", 24.0, [](double) { return CarPlace{2.0, 1.0, 0.5}; });
  const CameraPose begin = Pose("orbit", 0.0);
  const CameraPose quarter = Pose("orbit", 6.0);
  const CameraPose end = Pose("orbit", 24.0);
  EXPECT_NEAR(begin.azimuth, 0.5, Tolerance(1e-9));
  EXPECT_NEAR(quarter.azimuth, 0.5 + 0.5 * kPi, Tolerance(1e-9));
  EXPECT_NEAR(end.azimuth, 0.5 + 2.0 * kPi, Tolerance(1e-9));
  EXPECT_NEAR(begin.target_x, 2.0 + 1.4 * std::cos(0.5), Tolerance(1e-9));
  EXPECT_NEAR(begin.target_y, 1.0 + 1.4 * std::sin(0.5), Tolerance(1e-9));
  EXPECT_NEAR((Eye(quarter) - Eye(begin)).head<2>().norm(),
              std::sqrt(2.0) * 11.0 * std::cos(20.0 * kPi / 180.0), Tolerance(1e-9));
}

}  // namespace
}  // namespace trackbed::render
