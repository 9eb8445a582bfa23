// Tests the 3D scene of films by the colors of pixels at projected positions: paint, shadows,
// replans, trail and ghost.

#include "render/scene.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "render/painter.h"
#include "render/shadow.h"
#include "tests/render/pictures.h"

namespace trackbed::render {
namespace {

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

TEST_F(FilmSceneTest, PaintCastsNoShadowOnItself) {
  WriteStraightPlan(folder_.path(), 16.0);
  Recording recording = ReadRecording(folder_.path());
  // Use a shadow map of 0.8 m per texel, which is much coarser than in films. With this map, paint
  // that casts a shadow (thin boxes, for example) is dark at 102 of the 123 points. With the map of
  // a film, no dark speckle would be at a checked point.
  recording.model->vis.map.shadowclip = static_cast<float>(200.0 / recording.model->stat.extent);
  recording.model->vis.quality.shadowsize = 512;
  Offscreen offscreen(*recording.model, kWidth, kHeight, 1);
  const OverlayList overlays = Overlays(recording);
  FilmScene scene(recording, overlays, true);
  pose_ =
      FindCamera("top").pose(CameraSubject(recording), 0.0, static_cast<double>(kWidth) / kHeight);
  Image image;
  offscreen.Render(scene.At(0.0, *pose_), image);
  // The checked points of the ribbon are in sunlight: the front of the car is at x = 3.6 m. The car
  // is 1.5 m high and the sun is in the direction (-0.3, 0.4, 0.8), so the shadow of the car ends
  // 0.56 m ahead of its front. All points must be bright, because a ribbon that casts a shadow on
  // itself would have dark dots.
  for (int i = 0; i <= 40; ++i) {
    const double x = 4.5 + 0.05 * i;
    for (const double y : {-0.12, 0.0, 0.12}) {
      EXPECT_GT(At(image, x, y)[0], kWhite) << x << ", " << y;
    }
  }
}

TEST_F(FilmSceneTest, TheSunCastsTheCarsShadowToItsRight) {
  const Image lit = Picture("top", 0.0);
  const Image shaded = Picture("top", 0.0, true);
  // The edge of the roof is 1.5 m high and 0.55 m from the center line. The shadow of this edge is
  // 1.5 * 0.4 / 0.8 = 0.75 m farther to the right, so y = -1.15 m is in the shade and y = -2.2 m
  // and 1.5 m are not. The sun provides almost half of the light on flat ground, so the shade is
  // darker by much more than a quarter.
  EXPECT_LT(At(shaded, 1.4, -1.15)[1], 0.75 * At(lit, 1.4, -2.2)[1]);
  // In the sun, the brightness of all lamps adds up to 0.37 + 0.22 + 0.60 * 0.8 / 0.943 = 1.10.
  // Rendering in one pass clips the brightness to 1. Rendering in two passes, one of them for the
  // sun, does not clip it. The tolerance of 2 covers rounding.
  for (const double y : {-2.2, 1.5}) {
    EXPECT_GE(At(shaded, 1.4, y)[1], At(lit, 1.4, y)[1] - 2) << y;
    EXPECT_LE(At(shaded, 1.4, y)[1], 1.10 * At(lit, 1.4, y)[1] + 2) << y;
  }
}

TEST_F(FilmSceneTest, ThingsFarFromTheCarCastShadowsToo) {
  // The test places a cube of 2 m first 20 m ahead of the car, then 11 m to its left, in both cases
  // far outside of the car's shadow.
  struct Place {
    const char* camera;
    double x;
    double y;
  };
  const std::filesystem::path model = folder_.path() / "model.xml";
  const std::string car = ReadFile(model);
  for (const auto& [camera, x, y] : {Place{"chase", 23.0, 0.0}, Place{"side", 8.0, 12.0}}) {
    std::string with_box = car;
    with_box.insert(car.rfind("</worldbody>"),
                    fmt::format("<geom type='box' pos='{} {} 1' size='1 1 1'/>", x, y));
    WriteFileAtomically(model, with_box);
    const Image lit = Picture(camera, 0.0);
    const Image shaded = Picture(camera, 0.0, true);
    // The upper edges of the cube, 2 m high, cast shadows 2 * 0.3 / 0.8 = 0.75 m ahead and 1 m to
    // the right.
    EXPECT_LT(At(shaded, x, y - 1.5)[1], 0.75 * At(lit, x, y - 1.5)[1]) << camera;
    EXPECT_GE(At(shaded, x, y - 2.5)[1], At(lit, x, y - 2.5)[1] - 2) << camera;
  }
}

TEST_F(FilmSceneTest, TheShadowMapCoversWhatACameraFromAboveSees) {
  Recording recording = ReadRecording(folder_.path());
  const CameraSubject subject(recording);
  const CameraPose pose = FindCamera("top").pose(subject, 0.0, 16.0 / 9.0);
  const double half_height = pose.distance * std::tan(0.5 * pose.view_angle);
  EXPECT_GT(ShadowReach(pose), half_height * std::hypot(1.0, 16.0 / 9.0));
}

TEST_F(FilmSceneTest, SupersamplingSmoothsAndShiftsNothing) {
  WriteStraightPlan(folder_.path(), 16.0);
  const Image coarse = Picture("top", 0.0);
  const Image fine = Picture("top", 0.0, false, 2);
  ASSERT_EQ(fine.rgb.size(), coarse.rgb.size());
  const auto difference = [&](int shift_x, int shift_y) {
    long sum = 0;
    for (int y = 1; y + 1 < kHeight; ++y) {
      for (int x = 1; x + 1 < kWidth; ++x) {
        sum += std::abs(*fine.Pixel(x, y) - *coarse.Pixel(x + shift_x, y + shift_y));
      }
    }
    return sum;
  };
  EXPECT_GT(difference(0, 0), 0);
  for (const int shift : {-1, 1}) {
    EXPECT_LT(difference(0, 0), difference(shift, 0)) << shift;
    EXPECT_LT(difference(0, 0), difference(0, shift)) << shift;
  }
}

TEST_F(FilmSceneTest, TheSideCameraHasTheCarInTheMiddle) {
  const Image image = Picture("side", 1.0);
  // At 1 s the Prius covers x = 2.175 to 6.625, up to z = 1.49. The whole car is in the picture, on
  // both sides of the center, with its front to the right.
  const Pixel tail = Project(*pose_, 2.175, -0.86, 0.7);
  const Pixel nose = Project(*pose_, 6.625, -0.86, 0.7);
  EXPECT_GT(tail.x, kWidth / 10);
  EXPECT_LT(nose.x, kWidth - kWidth / 10);
  EXPECT_GT(nose.x - tail.x, kWidth / 3);
  EXPECT_NEAR(0.5 * (tail.x + nose.x), 0.5 * kWidth, 0.05 * kWidth);
  EXPECT_GT(Project(*pose_, 4.4, 0.0, 1.49).y, kHeight / 10);
  EXPECT_LT(Project(*pose_, 4.4, -0.86, 0.0).y, kHeight - kHeight / 10);
  // The doors have 0.86 of the plant's orange, (1.00, 0.55, 0.05), while the ground has as much red
  // as blue. In the shade, with an ambient light of 0.36, red exceeds blue by 0.36 * 0.82 * 255 =
  // 75.
  const std::array<int, 3> door = At(image, 4.6, -0.8625, 0.6);
  EXPECT_GT(door[0], door[2] + 60);
}

/// Classifies the paint at a point of the road by its color.
///
/// Colors are from 0 to 255. Asphalt is gray, up to 0.62 * 1.10 * 255 = 174, with no more red than
/// green. A discarded plan is drawn with an opacity of 0.35 over asphalt of 0.60, so a white plan
/// has a brightness of at least 0.96 * (0.60 + 0.35 * 0.40) * 255 = 181. The red of pink, (1.00,
/// 0.58, 0.80), exceeds its green by 0.96 * 0.42 * 255 = 103, and by 33 for a discarded plan. The
/// thresholds of this difference are halfway between 33 and 103 and between 0 and 33.
std::string PaintAt(const std::array<int, 3>& rgb) {
  if (rgb[0] - rgb[1] > 68) {
    return "pink";
  }
  if (rgb[0] - rgb[1] > 16) {
    return "pale pink";
  }
  if (rgb[0] > kWhite) {
    return "white";
  }
  return rgb[0] > 177 ? "pale" : "none";
}

TEST_F(FilmSceneTest, ANewPlanTakesThePlaceOfTheOldOneWhenItHolds) {
  // The car is so slow that it is never between the camera and the checked points.
  WritePlant(folder_.path(), "mujoco", 2.0, [](double time) { return CarPlace{time, 0.0, 0.0}; });
  WriteStraightPlan(folder_.path(), 16.0);
  WriteNewPlans(folder_.path(), "mujoco", {{1.0, 2.0, 16.0}, {2.0, -2.0, 16.0}});
  for (const char* camera : {"chase", "top"}) {
    const auto shown = [&](double time) {
      const Image image = Picture(camera, time);
      std::array<std::string, 3> paint;
      const std::array<double, 3> lines{0.0, 2.0, -2.0};
      for (std::size_t i = 0; i < lines.size(); ++i) {
        paint[i] = PaintAt(At(image, 12.0, lines[i]));
      }
      return paint;
    };
    using Paints = std::array<std::string, 3>;
    EXPECT_EQ(shown(0.99), (Paints{"white", "none", "none"})) << camera;
    EXPECT_EQ(shown(1.0), (Paints{"pale", "pink", "none"})) << camera;
    EXPECT_EQ(shown(1.99), (Paints{"pale", "pink", "none"})) << camera;
    EXPECT_EQ(shown(2.0), (Paints{"pale", "pale pink", "pink"})) << camera;
  }
}

TEST_F(FilmSceneTest, APlanThatHeldForLessThanASecondLeavesNothing) {
  WriteStraightPlan(folder_.path(), 16.0);
  WriteNewPlans(folder_.path(), "mujoco", {{1.0, 2.0, 16.0}, {1.9, -2.0, 16.0}});
  const Image image = Picture("top", 2.0);
  EXPECT_EQ(PaintAt(At(image, 12.0, 0.0)), "pale");
  EXPECT_EQ(PaintAt(At(image, 12.0, 2.0)), "none");
  EXPECT_EQ(PaintAt(At(image, 12.0, -2.0)), "pink");
}

TEST_F(FilmSceneTest, APlanThatWasGivenUpIsNarrowerAndBelowTheOneInForce) {
  WriteStraightPlan(folder_.path(), 16.0);
  const auto at = [this](const Image& image, double y) { return PaintAt(At(image, 12.0, y)); };
  // The camera sees 20 m per picture height, so paint has 20/22 of its full width. A ribbon with a
  // full width of 0.48 m ends 0.218 m from its center line, and a ribbon of 0.24 m ends at 0.109 m.
  // A row of pixels is 20 / 180 = 0.111 m, so a pixel shows the point to within 0.056 m.
  EXPECT_EQ(at(Picture("top", 0.0), 0.15), "white");
  WriteNewPlans(folder_.path(), "mujoco", {{1.0, 2.0, 16.0}});
  EXPECT_EQ(at(Picture("top", 1.0), 0.0), "pale");
  EXPECT_EQ(at(Picture("top", 1.0), 0.18), "none");
  WriteNewPlans(folder_.path(), "mujoco", {{1.0, 0.0, 16.0}});
  EXPECT_EQ(at(Picture("top", 1.0), 0.0), "pink");
}

TEST_F(FilmSceneTest, NewPlansAreWithinTheSceneHoweverMany) {
  // There are 400 plans of 17 points each. The points zigzag, so that thinning cannot remove a
  // point.
  std::string rows = "from_t_s,x_m,y_m\n";
  for (int plan = 0; plan < 400; ++plan) {
    for (int i = 0; i <= 16; ++i) {
      rows += fmt::format("{},{},{}\n", plan, i, i % 2);
    }
  }
  WriteFileAtomically(folder_.path() / "mujoco.plan.csv", rows);
  Recording recording = ReadRecording(folder_.path());
  const OverlayList overlays = Overlays(recording);
  FilmScene scene(recording, overlays, false);
  const CameraPose pose = FindCamera("top").pose(CameraSubject(recording), 400.0, 16.0 / 9.0);
  const mjvScene& posed = scene.At(400.0, pose);
  EXPECT_LT(posed.ngeom, posed.maxgeom);
  EXPECT_GT(posed.ngeom, 400 * 16);
}

TEST_F(FilmSceneTest, TheLegendNamesWhatThereIs) {
  const auto legend = [this] {
    std::vector<std::string> texts;
    const Recording recording = ReadRecording(folder_.path());
    for (const LegendEntry& entry : MakeLegend(recording, Overlays(recording))) {
      texts.push_back(entry.text);
    }
    return texts;
  };
  using Texts = std::vector<std::string>;
  EXPECT_EQ(legend(), (Texts{"mujoco"}));
  WriteStraightPlan(folder_.path(), 16.0);
  EXPECT_EQ(legend(), (Texts{"mujoco", "planned path"}));
  WriteNewPlans(folder_.path(), "mujoco", {{0.5, 2.0, 16.0}, {1.0, -2.0, 16.0}});
  EXPECT_EQ(legend(), (Texts{"mujoco", "planned path", "replanned path"}));
  // A ghost's own replans are not shown, so the legend does not name them.
  WritePlant(folder_.path(), "kinematic", 2.0, [](double) { return CarPlace{}; });
  WriteNewPlans(folder_.path(), "kinematic", {{0.5, 2.0, 16.0}});
  std::filesystem::remove(folder_.path() / "mujoco.plan.csv");
  EXPECT_EQ(legend(), (Texts{"mujoco", "planned path", "kinematic (ghost)"}));
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
  // The checked point is the center of the ghost's left side, at half the height of the door. The
  // ground behind it is gray. With the tint (0.10, 0.75, 0.95) and an opacity of 0.39, blue exceeds
  // red by at least 0.39 * 0.85 * 0.7 = 0.23, which is 59 of 255. The test requires half of this
  // difference.
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
  // The checked point is the middle of the tailgate, 0.8 m behind the rear axle at x = 3 m.
  EXPECT_EQ(At(with_ghost, 2.2, 0.0, 0.8), At(alone, 2.2, 0.0, 0.8));
}

TEST_F(FilmSceneTest, AGhostAFewCentimetersOffLeavesTheCarsDoorsAsTheyAre) {
  const Image alone = Picture("side", 1.0);
  WritePlant(folder_.path(), "kinematic", 2.0, [](double time) {
    return CarPlace{3.0 * time, -0.05, 0.0};
  });
  const Image with_ghost = Picture("side", 1.0);
  for (const double x : {3.6, 4.6, 5.2}) {
    EXPECT_EQ(At(with_ghost, x, -0.8625, 0.6), At(alone, x, -0.8625, 0.6)) << x;
  }
}

TEST_F(FilmSceneTest, PicturesRepeat) {
  EXPECT_TRUE(Picture("chase", 0.7).rgb == Picture("chase", 0.7).rgb);
}

TEST_F(FilmSceneTest, ALongRouteStaysWithinTheScene) {
  // A slalom of 600 m, with a state every 1/60 s: 36 000 rows.
  const auto slalom = [](double time) {
    return CarPlace{1.0 * time, 4.0 * std::sin(0.5 * time), 0.0};
  };
  WritePlant(folder_.path(), "mujoco", 600.0, slalom);
  WritePlant(folder_.path(), "kinematic", 600.0, slalom);
  Recording recording = ReadRecording(folder_.path());
  const OverlayList overlays = Overlays(recording);
  FilmScene scene(recording, overlays, false);
  const CameraSubject subject(recording);
  const double end = recording.end();
  mjvScene& posed = scene.At(end, FindCamera("top").pose(subject, end, 16.0 / 9.0));
  EXPECT_LT(posed.ngeom, posed.maxgeom);
  EXPECT_GT(posed.ngeom, 300);
}

}  // namespace
}  // namespace trackbed::render
