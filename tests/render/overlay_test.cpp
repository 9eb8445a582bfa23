// Tests every overlay of films by the colors of pixels at projected positions.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "render/error_ribbon.h"
#include "render/overlays.h"
#include "render/painter.h"
#include "render/projection.h"
#include "render/round_up.h"
#include "render/strip.h"
#include "tests/render/pictures.h"
#include "tests/tolerance.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/render/film.h"

namespace trackbed::render {
namespace {

/// A run with data for every overlay.
class EveryOverlay : public FilmSceneTest, public testing::WithParamInterface<std::string> {
 protected:
  EveryOverlay() {
    WritePlant(folder_.path(), "kinematic", 2.0, [](double time) {
      return CarPlace{3.0 * time, 1.5 * time, 0.3};
    });
    WriteStraightPlan(folder_.path(), 16.0);
    WriteNewPlans(folder_.path(), "mujoco", {{0.5, 2.0, 16.0}});
    for (const char* wheel : {"fl", "fr", "rl", "rr"}) {
      for (const char* force : {"normal", "longitudinal", "lateral"}) {
        SetLogColumn(folder_.path(), "mujoco", fmt::format("{}_force_{}_N", force, wheel),
                     [](double) { return 2000.0; });
      }
    }
    WriteFileAtomically(folder_.path() / "plan.json",
                        R"({"method": "lane_change", "gates": [
                            {"cones_m": [[6, 1.5], [6, -1.5], [9, 1.5], [9, -1.5]]}]})");
    InsertIntoModel(folder_.path(),
                    "<geom name='obstacle_0' type='box' pos='9 2 0.9' size='1 1 0.5'/>");
    WriteFileAtomically(folder_.path() / "scenario.resolved.yaml", R"(schema: 1
name: run
mission: {speed: 3, waypoints: [[0, 0], [20, 0]]}
world:
  road: {width: 6, lanes: 3}
  obstacles: [{box: {x: 9, y: 2, length: 2, width: 2, height: 1}, known_from: {time: 1.5}}]
  ground: {grade: {x: 0.05}}
  wind: {y: 9, gusts: [{y: 3, shape: step, area: {x: 6, y: 0, length: 8, width: 4}}]}
)");
  }

  /// The picture of the run at 1 s with these overlays.
  Image Painted(const std::vector<std::string>& overlays) const {
    std::vector<Recording> recordings;
    recordings.push_back(ReadRecording(folder_.path()));
    FilmOptions options;
    options.width = kWidth;
    options.height = kHeight;
    options.overlays = overlays;
    Image image;
    Painter(recordings, options).Paint(1.0, image);
    return image;
  }
};

TEST_P(EveryOverlay, ShowsSomethingOfARunThatHasItAndIsExplained) {
  EXPECT_FALSE(Painted({GetParam()}).rgb == Painted({}).rgb);
  const std::filesystem::path page =
      std::filesystem::path(TRACKBED_SOURCE_DIR) / "docs" / "how-to" / "film.md";
  EXPECT_THAT(ReadFile(page), testing::HasSubstr("\n| `" + GetParam() + "` | "));
  const std::vector<FilmChoice> all = trackbed::Overlays();
  EXPECT_EQ(std::count_if(all.begin(), all.end(),
                          [](const FilmChoice& overlay) {
                            return overlay.name == GetParam() && !overlay.summary.empty();
                          }),
            1);
}

TEST_P(EveryOverlay, AddsNoMoreShapesThanItSays) {
  Recording recording = ReadRecording(folder_.path());
  const CameraSubject subject(recording);
  overlays_ = {GetParam()};
  const OverlayList overlays = Overlays(recording);
  const OverlayList none;
  FilmScene with(recording, overlays, false);
  FilmScene without(recording, none, false);
  for (const char* camera : {"chase", "side", "driver", "orbit", "top"}) {
    for (const double time : {0.0, 1.0, 2.0}) {
      const CameraPose pose = FindCamera(camera).pose(subject, time, 16.0 / 9.0);
      const int added = with.At(time, pose).ngeom - without.At(time, pose).ngeom;
      EXPECT_LE(added, static_cast<int>(overlays.front()->max_shapes())) << camera << " " << time;
    }
  }
}

TEST_P(EveryOverlay, DoesWithoutWhatARunMayLack) {
  for (const char* file : {"plan.csv", "plan.json", "mujoco.plan.csv", "kinematic.csv",
                           "kinematic.state.csv", "scenario.resolved.yaml"}) {
    std::filesystem::remove(folder_.path() / file);
  }
  WriteFileAtomically(folder_.path() / "mujoco.csv",
                      "t_s,speed_mps,steering_command_rad,steering_rad\n0,3,0,0\n");
  EXPECT_EQ(Painted({GetParam()}).width, kWidth);
}

std::vector<std::string> OverlayNames() {
  std::vector<std::string> names;
  for (const OverlayEntry& overlay : OverlayTable()) {
    names.push_back(overlay.name);
  }
  return names;
}

INSTANTIATE_TEST_SUITE_P(Overlays, EveryOverlay, testing::ValuesIn(OverlayNames()),
                         [](const auto& each) { return each.param; });

TEST_F(FilmSceneTest, OnlyTheNamedOverlaysAreMade) {
  const Recording recording = ReadRecording(folder_.path());
  overlays_ = {"strip", "plan", "strip"};
  EXPECT_EQ(Overlays(recording).size(), 2U);
  overlays_ = {"plan", "gosts"};
  try {
    Overlays(recording);
    ADD_FAILURE() << "no InputError";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "overlays: unknown overlay 'gosts'; did you mean 'ghosts'?");
  }
}

TEST(RoundedUp, IsTheNextOfOneTwoAndFive) {
  EXPECT_DOUBLE_EQ(RoundedUp(0.05), 0.05);
  EXPECT_DOUBLE_EQ(RoundedUp(0.051), 0.1);
  EXPECT_DOUBLE_EQ(RoundedUp(0.13), 0.2);
  EXPECT_DOUBLE_EQ(RoundedUp(2.01), 5.0);
  EXPECT_DOUBLE_EQ(RoundedUp(700.0), 1000.0);
}

TEST_F(FilmSceneTest, PointsAreProjectedAsAPinholeCameraSeesThem) {
  Recording recording = ReadRecording(folder_.path());
  const CameraSubject subject(recording);
  for (const char* camera : {"chase", "side", "orbit", "top"}) {
    const CameraPose pose = FindCamera(camera).pose(subject, 1.0, 16.0 / 9.0);
    const Projection projection(pose, kWidth, kHeight);
    for (const Eigen::Vector3d& point :
         {Eigen::Vector3d(4.0, 0.5, 0.0), Eigen::Vector3d(5.0, -1.0, 1.2)}) {
      const Pixel expected = Project(pose, point.x(), point.y(), point.z());
      const auto seen = projection(point);
      ASSERT_TRUE(seen);
      // The reference projection truncates to whole pixels.
      EXPECT_NEAR(seen->x, expected.x + 0.5, 0.5001) << camera;
      EXPECT_NEAR(seen->y, expected.y + 0.5, 0.5001) << camera;
    }
  }
  const CameraPose pose = FindCamera("chase").pose(subject, 1.0, 16.0 / 9.0);
  EXPECT_FALSE(Projection(pose, kWidth, kHeight)({-40.0, 0.0, 0.0}));  // behind the camera
}

TEST_F(FilmSceneTest, TheErrorRibbonHasTheColorOfTheDistanceFromThePath) {
  WriteStraightPlan(folder_.path(), 16.0);
  // From x = 3 m on, the car has a cross-track error of 0.18 m.
  SetLogColumn(folder_.path(), "mujoco", "cross_track_m",
               [](double time) { return time < 1.0 ? 0.0 : -0.18; });
  overlays_.emplace_back("error");
  const Recording recording = ReadRecording(folder_.path());
  EXPECT_DOUBLE_EQ(recording.scales.error, 0.2);
  const Image image = Picture("top", 2.0);
  const std::array<int, 3> on = At(image, 1.5, 0.0);
  const std::array<int, 3> off = At(image, 4.2, 0.0);
  // The color map viridis is dark violet, (68, 1, 84), for no error, and yellow, (253, 231, 37), at
  // the end of the scale.
  EXPECT_GT(on[2], on[1] + 40);
  EXPECT_LT(on[1], 60);
  EXPECT_GT(off[1], off[2] + 100);
  EXPECT_GT(off[0], off[2] + 60);
  overlays_.pop_back();
  EXPECT_GT(At(Picture("top", 2.0), 1.5, 0.0)[0], 200);  // the car's orange
}

TEST_F(FilmSceneTest, WithoutAPathThereIsNoErrorRibbon) {
  EXPECT_EQ(ReadRecording(folder_.path()).scales.error, 0.0);
}

TEST_F(FilmSceneTest, ErrorsThatSwayByLittleKeepOneColor) {
  WriteStraightPlan(folder_.path(), 16.0);
  // The color scale divides errors up to 0.05 m into 16 steps. The error oscillates around the
  // middle of the fourth step, with an amplitude of a tenth of a step.
  SetLogColumn(folder_.path(), "mujoco", "cross_track_m",
               [](double time) { return 0.05 / 16.0 * (3.5 + 0.1 * std::sin(40.0 * time)); });
  const std::vector<double> fractions = ErrorFractions(ReadRecording(folder_.path()));
  EXPECT_LE(std::set<double>(fractions.begin(), fractions.end()).size(), 2U);
  int changes = 0;
  for (std::size_t i = 1; i < fractions.size(); ++i) {
    changes += fractions[i] != fractions[i - 1] ? 1 : 0;
  }
  EXPECT_LE(changes, 1);
}

TEST_F(FilmSceneTest, TheWindIsDrawnOnTheGroundWhereItBlowsTo) {
  const Image calm = Picture("top", 0.0);
  WriteFileAtomically(folder_.path() / "scenario.resolved.yaml",
                      "schema: 1\nname: run\nmission: {speed: 3, waypoints: [[0, 0], [20, 0]]}\n"
                      "world: {wind: {y: 9}}\n");
  const Image windy = Picture("top", 0.0);
  overlays_.pop_back();
  EXPECT_TRUE(Picture("top", 0.0).rgb == calm.rgb);
  // The arrows are 3 m long, 5 m apart and along y. All lengths are multiplied by the paint scale.
  const double spacing = 5.0 * pose_->paint_scale;
  const double x = spacing * std::round(pose_->target_x / spacing) + spacing;
  const double y = spacing * std::round(pose_->target_y / spacing) + spacing;
  const auto brighter = [&](double at_x, double at_y) {
    return At(windy, at_x, at_y)[2] - At(calm, at_x, at_y)[2];
  };
  EXPECT_GT(brighter(x, y), 40);
  EXPECT_GT(brighter(x, y + 1.2 * pose_->paint_scale), 40);
  EXPECT_GT(brighter(x, y - 1.2 * pose_->paint_scale), 40);
  EXPECT_LE(brighter(x, y + 2.0 * pose_->paint_scale), 2);
  // The strokes of the arrow head end 0.42 m behind the tip, 0.29 m to each side.
  for (const double side : {-0.25, 0.25}) {
    EXPECT_GT(brighter(x + side * pose_->paint_scale, y + 1.14 * pose_->paint_scale), 40) << side;
    EXPECT_LE(brighter(x + side * pose_->paint_scale, y - 1.14 * pose_->paint_scale), 2) << side;
  }
}

class StripTest : public FilmSceneTest {
 protected:
  StripTest() {
    // The plan lasts 2 s at 3 m/s, and turns to the left from x = 3 m on.
    Table plan({"s_m", "x_m", "y_m", "curvature_radpm"});
    for (int i = 0; i <= 60; ++i) {
      plan.AddRow({0.1 * i, 0.1 * i, 0.0, i < 30 ? 0.0 : 0.05});
    }
    WriteFileAtomically(folder_.path() / "plan.csv", plan.ToCsv());
    SetLogColumn(folder_.path(), "mujoco", "steering_command_rad", [](double) { return 0.1; });
    SetLogColumn(folder_.path(), "mujoco", "steering_rad", [](double) { return -0.1; });
  }
  Image DrawAt(double time) {
    const Strip strip(ReadRecording(folder_.path()), 640, 360, font_);
    top_ = strip.top();
    Image image;
    image.Resize(640, 360);
    strip.Draw(image, font_, time);
    return image;
  }
  /// Brightest red and blue of a picture column between two rows.
  static std::array<int, 3> Brightest(const Image& image, int x, int first, int last) {
    std::array<int, 3> most{};
    for (int y = first; y < last; ++y) {
      for (std::size_t i = 0; i < 3; ++i) {
        most[i] = std::max(most[i], static_cast<int>(image.Pixel(x, y)[i]));
      }
    }
    return most;
  }

  double top_ = 0.0;
};

TEST_F(StripTest, ShowsWhatIsPlannedAndWhatWasSteeredUntilNow) {
  const Image image = DrawAt(1.2);
  // The plot ends a margin of 10 px and half a padding (4 px) above the lower edge of the picture.
  // The plot begins 0.4 paddings (3.2 px) and the height of the letters (13.8 px) below the upper
  // edge of the panel.
  const int first = static_cast<int>(std::round(top_ + 3.2 + 0.86 * 16.0));
  const int last = 360 - 10 - 4;
  const int middle = (first + last) / 2;
  const int left = 18;
  const int right = 640 - 18;
  const auto column = [&](double time) {
    return left + static_cast<int>(std::lround(time / 2.0 * (right - left - 1)));
  };
  // The command to the left is white in the upper half; the measured angle to the right is orange
  // in the lower half.
  const std::array<int, 3> asked = Brightest(image, column(0.5), first, middle - 2);
  EXPECT_GT(std::min(asked[0], asked[2]), 200);
  const std::array<int, 3> done = Brightest(image, column(0.5), middle + 3, last);
  EXPECT_GT(done[0], done[2] + 100);
  // The measured angle has no color in the future.
  const std::array<int, 3> later = Brightest(image, column(1.7), middle + 3, last);
  EXPECT_LT(later[0], 30);
  // The planned steering is zero at first and then to the left. The color of the planned steering
  // is paler in the future.
  const int between = (first + middle) / 2 + 2;
  EXPECT_LT(image.Pixel(column(0.8), between)[0], 30);
  EXPECT_GT(image.Pixel(column(1.1), between)[0], 100);
  EXPECT_GT(image.Pixel(column(1.7), between)[0], 50);
  EXPECT_LT(image.Pixel(column(1.7), between)[0], image.Pixel(column(1.1), between)[0] - 30);
  // The cursor is bright.
  EXPECT_GT(image.Pixel(column(1.2), last - 3)[0], 150);
}

TEST_F(StripTest, FollowsThePlanThatHolds) {
  // At 1.5 s, after 4.5 m, the car adopts a new plan, which is straight for 0.9 m (0.3 s) and then
  // turns to the right.
  Table plans({"from_t_s", "s_m", "x_m", "y_m", "curvature_radpm"});
  for (int i = 0; i <= 60; ++i) {
    plans.AddRow({1.5, 0.1 * i, 4.5 + 0.1 * i, 0.0, i < 9 ? 0.0 : -0.05});
  }
  WriteFileAtomically(folder_.path() / "mujoco.plan.csv", plans.ToCsv());
  const Image image = DrawAt(2.0);
  const int first = static_cast<int>(std::round(top_ + 3.2 + 0.86 * 16.0));
  const int middle = (first + 346) / 2;
  const auto is_planned = [&](double time, int row) {
    return image.Pixel(18 + static_cast<int>(time / 2.0 * 603.0), row)[0] > 100;
  };
  EXPECT_TRUE(is_planned(1.3, middle - 6));
  EXPECT_FALSE(is_planned(1.3, middle + 6));
  EXPECT_FALSE(is_planned(1.7, middle + 6));
  EXPECT_FALSE(is_planned(1.7, middle - 6));
  EXPECT_TRUE(is_planned(1.9, middle + 6));
  EXPECT_FALSE(is_planned(1.9, middle - 6));
}

TEST_F(StripTest, EndsWithItsOwnDriveOnTheAxisOfAll) {
  WritePlant(folder_.path(), "kinematic", 4.0, [](double) { return CarPlace{}; });
  const Image image = DrawAt(4.0);
  const int first = static_cast<int>(std::round(top_ + 3.2 + 0.86 * 16.0));
  const int middle = (first + 346) / 2;
  // The plot covers 4 s, but the log of the car only 2 s. In these 2 s, the command is to the left
  // and the measured angle to the right. After the end of the log, the plot shows no steering.
  const auto column = [](double time) { return 18 + static_cast<int>(time / 4.0 * 603.0); };
  EXPECT_GT(Brightest(image, column(1.9), first, middle - 2)[2], 100);
  EXPECT_LT(Brightest(image, column(2.1), first, middle - 2)[2], 60);
  EXPECT_GT(Brightest(image, column(1.9), middle + 3, 346)[0], 150);
  EXPECT_LT(Brightest(image, column(2.1), middle + 3, 346)[0], 60);
}

TEST_F(FilmSceneTest, GhostAndCarAreApartInThePictureAsInTheLogs) {
  // The plants coincide until 1 s, then one drifts away.
  WritePlant(folder_.path(), "kinematic", 2.0, [](double time) {
    return CarPlace{3.0 * time, std::max(0.0, time - 1.0), 0.0};
  });
  overlays_ = {"ghosts"};
  Recording recording = ReadRecording(folder_.path());
  const CameraSubject subject(recording);
  const OverlayList overlays = Overlays(recording);
  FilmScene scene(recording, overlays, false);
  for (const double time : {0.0, 0.5, 1.0, 1.5, 2.0}) {
    const CameraPose pose = FindCamera("chase").pose(subject, time, 16.0 / 9.0);
    const mjvScene& posed = scene.At(time, pose);
    const Projection projection(pose, kWidth, kHeight);
    const Point car = recording.plants[0].Position(time);
    const Point ghost = recording.plants[1].Position(time);
    int compared = 0;
    for (int i = 0; i < posed.ngeom; ++i) {
      const mjvGeom& of_car = posed.geoms[i];
      for (int j = i + 1; j < posed.ngeom; ++j) {
        const mjvGeom& of_ghost = posed.geoms[j];
        // A ghost consists of the geoms of the car's model, drawn translucently.
        if (of_car.objtype != mjOBJ_GEOM || of_car.objid != of_ghost.objid ||
            of_ghost.objtype != mjOBJ_GEOM || of_ghost.rgba[3] > 0.3F || of_car.rgba[3] < 1.0F) {
          continue;
        }
        const auto seen_car = projection(
            {of_car.pos[0] + ghost.x - car.x, of_car.pos[1] + ghost.y - car.y, of_car.pos[2]});
        const auto seen_ghost = projection({of_ghost.pos[0], of_ghost.pos[1], of_ghost.pos[2]});
        ASSERT_TRUE(seen_car && seen_ghost);
        // A ghost is drawn 0.1 m farther along the line of sight, which does not move it in the
        // picture. Single precision at 10 m is 1e-6 m, less than 1e-4 px. MuJoCo draws with the
        // left and the right camera of a stereo pair, each 0.034 m from the middle. At a distance
        // of 15 m, a ghost that is drawn 0.1 m farther away therefore moves by 2e-4 m, which is
        // 0.004 px.
        EXPECT_NEAR(seen_ghost->x, seen_car->x, 0.01) << time;
        EXPECT_NEAR(seen_ghost->y, seen_car->y, 0.01) << time;
        ++compared;
      }
    }
    EXPECT_GT(compared, 5) << time;
  }
}

}  // namespace
}  // namespace trackbed::render
