#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "render/camera.h"
#include "render/canvas.h"
#include "render/ribbon.h"
#include "tests/render/run_folder.h"
#include "tests/support/temp_folder.h"
#include "tests/tolerance.h"
#include "trackbed/sim/mujoco_error.h"

namespace trackbed::render {
namespace {

double Distance(const Point& p, const Point& a, const Point& b) {
  const double length = std::hypot(b.x - a.x, b.y - a.y);
  double along = ((p.x - a.x) * (b.x - a.x) + (p.y - a.y) * (b.y - a.y)) / (length * length);
  along = std::clamp(along, 0.0, 1.0);
  return std::hypot(p.x - a.x - along * (b.x - a.x), p.y - a.y - along * (b.y - a.y));
}

TEST(Thin, KeepsTheEndsOfAStraightLine) {
  std::vector<Point> line;
  for (int i = 0; i <= 300; ++i) {
    line.push_back({0.1 * i, -0.2 * i});
  }
  EXPECT_EQ(Thin(line, 0.005, 1000), (std::vector<std::size_t>{0, 300}));
}

TEST(Thin, LeavesNoPointFartherThanTheTolerance) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> bend(-0.2, 0.2);
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<Point> road{{0.0, 0.0}};
    double heading = 0.0;
    for (int i = 0; i < 2000; ++i) {
      heading += 0.1 * bend(random);
      road.push_back(
          {road.back().x + 0.1 * std::cos(heading), road.back().y + 0.1 * std::sin(heading)});
    }
    const std::vector<std::size_t> kept = Thin(road, 0.01, road.size());
    ASSERT_EQ(kept.front(), 0U);
    ASSERT_EQ(kept.back(), road.size() - 1);
    for (std::size_t piece = 1; piece < kept.size(); ++piece) {
      for (std::size_t i = kept[piece - 1]; i <= kept[piece]; ++i) {
        EXPECT_LE(Distance(road[i], road[kept[piece - 1]], road[kept[piece]]), Tolerance(0.01))
            << "trial " << trial << " point " << i;
      }
    }
  }
}

TEST(Thin, SpendsOnACircleWhatItsCurvatureAsksFor) {
  // A chord of length c deviates by c^2 / (8 R) from its arc. With R = 5 m, a deviation of 5 mm
  // allows c = 0.447 m. The points are 0.05 m apart, so a chord may be up to 0.05 m shorter. The
  // circumference of 31.4 m thus needs 71 to 79 pieces.
  std::vector<Point> circle;
  for (int i = 0; i <= 628; ++i) {
    circle.push_back({5.0 * std::cos(0.01 * i), 5.0 * std::sin(0.01 * i)});
  }
  const std::size_t pieces = Thin(circle, 0.005, 1000).size() - 1;
  EXPECT_GE(pieces, 70U);
  EXPECT_LE(pieces, 80U);
  EXPECT_LE(Thin(circle, 0.005, 20).size() - 1, 20U);
}

TEST(Thin, CopesWithACarThatStands) {
  EXPECT_TRUE(Thin({}, 0.01, 10).empty());
  EXPECT_EQ(Thin({{1, 1}}, 0.01, 10), (std::vector<std::size_t>{0}));
  EXPECT_EQ(Thin({{1, 1}, {1, 1}, {1, 1}}, 0.01, 10), (std::vector<std::size_t>{0, 2}));
}

Font BlockFont() {
  // A font in which every glyph is white in its left half and black in its right half.
  Image glyph;
  glyph.Resize(40, 80);
  for (int y = 0; y < glyph.height; ++y) {
    std::fill(glyph.Pixel(0, y), glyph.Pixel(20, y), std::uint8_t{255});
  }
  return Font(std::vector<Image>(Font::kLast - Font::kFirst + 1, glyph));
}

TEST(Canvas, DrawsTextOfTheWidthItSays) {
  Font font = BlockFont();
  EXPECT_DOUBLE_EQ(font.Width("abc", 20.0), 30.0);
  Image image;
  image.Resize(64, 32);
  Canvas canvas(image, font);
  EXPECT_DOUBLE_EQ(canvas.Text(10, 5, "ab", 20.0, {1, 0, 0}), 30.0);
  // The text has two cells of 10 px from x = 10 on. Each cell is white for 5 px, in the rows 5 to
  // 24.
  for (const int x : {10, 14, 20, 24}) {
    EXPECT_EQ(image.Pixel(x, 5)[0], 255) << x;
    EXPECT_EQ(image.Pixel(x, 24)[0], 255) << x;
    EXPECT_EQ(image.Pixel(x, 10)[1], 0) << x;
  }
  for (const int x : {9, 15, 19, 25}) {
    EXPECT_EQ(image.Pixel(x, 10)[0], 0) << x;
  }
  EXPECT_EQ(image.Pixel(10, 4)[0], 0);
  EXPECT_EQ(image.Pixel(10, 25)[0], 0);
}

TEST(Canvas, BlendsARectangleAndRoundsItsCorners) {
  Font font = BlockFont();
  Image image;
  image.Resize(40, 40);
  Canvas canvas(image, font);
  canvas.Fill({10, 10, 20, 20}, 6, {1, 1, 1}, 0.5);
  EXPECT_EQ(image.Pixel(20, 20)[0], 128);  // half of 255, rounded up
  EXPECT_EQ(image.Pixel(10, 20)[0], 128);
  EXPECT_EQ(image.Pixel(9, 20)[0], 0);
  EXPECT_EQ(image.Pixel(10, 10)[0], 0);  // 2.1 px outside the corner's circle
  EXPECT_EQ(image.Pixel(13, 13)[0], 128);
}

TEST(Canvas, FillsEveryPixelOfARectangleOnce) {
  Font font = BlockFont();
  // Pixels inside the rectangle are fully covered at half opacity, for any position of the edges
  // between pixels.
  for (const double shift : {0.0, 0.3, 0.5, 0.9}) {
    Image image;
    image.Resize(60, 30);
    std::fill(image.rgb.begin(), image.rgb.end(), std::uint8_t{200});
    Canvas(image, font).Fill({5.0 + shift, 4.0 + shift, 40.0, 20.0}, 3.0, {0, 0, 0}, 0.5);
    for (int y = 6; y < 23; ++y) {
      for (int x = 7; x < 44; ++x) {
        const bool corner = (x < 10 || x > 41) && (y < 9 || y > 20);
        if (!corner) {
          ASSERT_EQ(image.Pixel(x, y)[1], 100) << x << ", " << y << ", " << shift;
        }
      }
    }
    EXPECT_EQ(image.Pixel(3, 12)[1], 200);
    EXPECT_EQ(image.Pixel(47, 12)[1], 200);
  }
}

TEST(Canvas, CutsOffWhatLiesOutside) {
  Font font = BlockFont();
  Image image;
  image.Resize(8, 8);
  Canvas canvas(image, font);
  canvas.Fill({-5, -5, 30, 30}, 3, {1, 1, 1}, 1.0);
  EXPECT_EQ(image.Pixel(0, 0)[0], 255);
  EXPECT_EQ(image.Pixel(7, 7)[0], 255);
  // The first cell covers x = -7 to 2, and its white half ends at x = -3. The white half of the
  // second cell is x = 3 to 7.
  canvas.Text(-7, -7, "ab", 20.0, {0, 0, 0});
  EXPECT_EQ(image.Pixel(2, 0)[0], 255);
  EXPECT_EQ(image.Pixel(3, 0)[0], 0);
  EXPECT_EQ(image.Pixel(7, 7)[0], 0);
}

TEST(Camera, ChaseLooksTheWayTheCarGoes) {
  const TempFolder folder;
  CopyPrius(folder.path());
  WritePlant(folder.path(), "mujoco", 4.0, [](double time) {
    return CarPlace{10.0 * std::sin(0.3 * time), 10.0 - 10.0 * std::cos(0.3 * time), 0.3 * time};
  });
  const MujocoErrorScope errors;
  const Recording recording = ReadRecording(folder.path());
  const CameraSubject subject(recording);
  // The mean of a linear heading over a symmetric window is its value in the middle.
  EXPECT_NEAR(subject.SmoothHeading(2.0), 0.6, Tolerance(1e-9));
  const CameraPose pose = FindCamera("chase").pose(subject, 2.0, 1.8);
  EXPECT_NEAR(pose.azimuth, 0.6, 0.35);
  EXPECT_LT(pose.elevation, 0.0);
  // The camera is behind the rear axle.
  const double ground = pose.distance * std::cos(pose.elevation);
  const double behind =
      (pose.target_x - ground * std::cos(pose.azimuth) - subject.Position(2.0).x) * std::cos(0.6) +
      (pose.target_y - ground * std::sin(pose.azimuth) - subject.Position(2.0).y) * std::sin(0.6);
  EXPECT_LT(behind, -5.0);
}

TEST(Camera, SideGoesAlongWithoutAJerk) {
  const TempFolder folder;
  CopyPrius(folder.path());
  // The car drives at 3 m/s; at 2 s the yaw rate steps to 0.5 rad/s.
  WritePlant(folder.path(), "mujoco", 4.0, [](double time) {
    return CarPlace{3.0 * time, 0.0, 0.5 * std::max(time - 2.0, 0.0)};
  });
  const MujocoErrorScope errors;
  const Recording recording = ReadRecording(folder.path());
  const CameraSubject subject(recording);
  const Camera side = FindCamera("side");
  EXPECT_GT(std::sin(side.pose(subject, 0.9, 1.8).azimuth), 0.99);  // from the right, looking left
  double before = side.pose(subject, 1.0, 1.8).azimuth;
  double rate_before = 0.0;
  for (int frame = 1; frame <= 60; ++frame) {
    const CameraPose pose = side.pose(subject, 1.0 + frame / 30.0, 1.8);
    const double rate = 30.0 * (pose.azimuth - before);
    // The heading of the camera is a mean weighted by a triangle of +-0.8 s. The rate of the
    // camera's heading changes by at most 0.5/0.8 rad/s per second, the step of 0.5 rad/s times the
    // peak of the triangle. The bound is doubled, because the mean uses 31 samples 0.05 s apart,
    // while the frames are 0.033 s apart.
    EXPECT_LT(std::abs(rate - rate_before), 2.0 * 0.5 / 0.8 / 30.0) << frame;
    before = pose.azimuth;
    rate_before = rate;
  }
  // A narrow picture still shows a car of 4.45 m.
  const CameraPose narrow = side.pose(subject, 1.0, 0.5);
  EXPECT_GT(0.5 * 2.0 * narrow.distance * std::tan(0.5 * narrow.view_angle), 4.45);
}

TEST(Camera, TopShowsAllOfASmallRouteAndFollowsInALargeOne) {
  const MujocoErrorScope errors;
  const auto poses = [](double length) {
    const TempFolder folder;
    CopyPrius(folder.path());
    WritePlant(folder.path(), "mujoco", 10.0, [&](double time) {
      return CarPlace{0.1 * length * time, 0.0, 0.0};
    });
    const Recording recording = ReadRecording(folder.path());
    const CameraSubject subject(recording);
    const Camera top = FindCamera("top");
    return std::pair{top.pose(subject, 0.0, 1.5), top.pose(subject, 10.0, 1.5)};
  };
  const auto [small_first, small_last] = poses(40.0);
  EXPECT_DOUBLE_EQ(small_first.target_x, 20.0);
  EXPECT_DOUBLE_EQ(small_last.target_x, 20.0);
  const double width = 1.5 * 2.0 * small_first.distance * std::tan(0.5 * small_first.view_angle);
  EXPECT_GE(width, 40.0);

  {
    // The view includes replans, even parts that were not driven.
    const TempFolder folder;
    CopyPrius(folder.path());
    WritePlant(folder.path(), "mujoco", 1.0, [](double) { return CarPlace{}; });
    WriteNewPlans(folder.path(), "mujoco", {{0.5, 8.0, 30.0}});
    const Recording recording = ReadRecording(folder.path());
    const CameraPose pose = FindCamera("top").pose(CameraSubject(recording), 0.0, 1.5);
    EXPECT_DOUBLE_EQ(pose.target_x, 15.0);
    EXPECT_DOUBLE_EQ(pose.target_y, 4.0);
  }

  const auto [large_first, large_last] = poses(400.0);
  EXPECT_NEAR(large_first.target_x, 0.0, 25.0);
  EXPECT_NEAR(large_last.target_x, 400.0, 25.0);
}

}  // namespace
}  // namespace trackbed::render
