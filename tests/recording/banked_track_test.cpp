#include "trackbed/recording/banked_track.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/support/temp_folder.h"
#include "tests/tolerance.h"
#include "tests/track/rings.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/path/frenet_frame.h"

// Tests the ground of banked tracks against the closed form of the surface, z(s) + d tan(beta(s)).
namespace trackbed {
namespace {

using testing::HasSubstr;

std::vector<double> Same(double value, std::size_t count) {
  return std::vector<double>(count, value);
}

TEST(BankedTrack, IsAConeOnARing) {
  // On a ring with a constant bank, the road is a cone about the vertical axis through the middle.
  constexpr double kRadius = 40.0;
  for (const double bank : {0.3, -0.2}) {
    const BankedTrack track{RingPoints(kRadius, 126, 5.0, 4.0), Same(bank, 126), Same(2.0, 126)};
    const auto terrain = MakeTerrain(track);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    for (int i = 0; i < 200; ++i) {
      // The ring is driven counterclockwise, so its left edge is 4 m nearer to the ring's middle.
      const double radius = kRadius - 4.0 + 9.0 * unit(random);
      const double angle = 2.0 * kPi * unit(random);
      const Vec2 outward = Direction(angle);
      const Terrain::Point at = terrain->At(radius * outward);
      // The spline of the center line, whose points are 2 m apart, attenuates the wave that is the
      // circle by (8/251)^6, so the center line is exact to nanometers. Cubic convolution of cells
      // of 0.5 m is exact for quadratic polynomials; its error on a cone is at most h^3/8 of the
      // third derivative, slope/r^2, twice that for the slope over h.
      const double cubic = std::tan(std::abs(bank)) / (36.0 * 36.0);
      EXPECT_NEAR(at.height, 2.0 + (kRadius - radius) * std::tan(bank),
                  Tolerance(0.125 / 8.0 * cubic + 1e-5));
      EXPECT_NEAR((at.slope + std::tan(bank) * outward).norm(), 0.0,
                  Tolerance(0.25 / 4.0 * cubic + 1e-4));
    }
  }
}

TEST(BankedTrack, FollowsBankAndHeightAlongTheTrack) {
  // Bank and height are waves over the lap.
  const std::vector<TrackPoint> points = EllipsePoints(90.0, 50.0, 220, 6.0, 6.0);
  const Track track(points);
  BankedTrack banked{points, {}, {}};
  const auto wave = [&](double s) { return 2.0 * kPi * s / track.length(); };
  for (std::size_t i = 0; i < points.size(); ++i) {
    banked.banks.push_back(0.25 * std::sin(wave(track.StationOf(i))));
    banked.heights.push_back(3.0 * std::cos(2.0 * wave(track.StationOf(i))));
  }
  const auto terrain = MakeTerrain(banked);
  for (double s = 0.0; s < track.length(); s += 3.1) {
    for (const double d : {-6.0, -2.0, 0.0, 3.0, 6.0}) {
      const PathPoint at = track.At(s);
      const Vec2 point = at.pose.position() + d * LeftNormal(Direction(at.pose.yaw));
      const double expected =
          3.0 * std::cos(2.0 * wave(s)) + d * std::tan(0.25 * std::sin(wave(s)));
      // The slope of the bank, not its angle, is interpolated between points 2 m apart, and the
      // smoothing attenuates waves of half a lap by (8/224)^6. Errors are below a millimeter.
      EXPECT_NEAR(terrain->At(point).height, expected, Tolerance(1e-3)) << s << ", " << d;
    }
  }
}

TEST(BankedTrack, IsContinuousBetweenItsParts) {
  // A narrow track, whose straights are 24 m apart, with opposite banks: the road is exact, and the
  // ground between is continuous.
  const std::vector<TrackPoint> points = EllipsePoints(120.0, 12.0, 400, 3.0, 3.0);
  BankedTrack banked{points, {}, Same(0.0, points.size())};
  for (const TrackPoint& point : points) {
    banked.banks.push_back(0.2 * std::tanh(point.position.y()));
  }
  const auto terrain = MakeTerrain(banked);
  for (double x = -60.0; x <= 60.0; x += 7.3) {
    double before = terrain->At({x, -25.0}).height;
    for (double y = -25.0; y <= 25.0; y += 0.05) {
      const double height = terrain->At({x, y}).height;
      // The road has a slope of 0.2. The transition from up to 2.5 m of height to the ground over
      // 8 m adds at most 15/8 2.5/8 = 0.59. Over 5 cm, this is 4 cm.
      EXPECT_LT(std::abs(height - before), 0.05) << x << ", " << y;
      before = height;
    }
  }
}

TEST(BankedTrack, IsNoLargerThanFourKilometers) {
  const BankedTrack track{RingPoints(2100.0, 60, 5.0, 4.0), Same(0.1, 60), Same(0.0, 60)};
  try {
    static_cast<void>(MakeTerrain(track));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("the track spreads over 4200 m; a track with bank may "
                                        "spread over at most 4000 m along x and y"));
  }
}

TEST(BankedTrack, IsReadAsItWasWritten) {
  const TempFolder folder;
  BankedTrack track{RingPoints(40.0, 60, 5.0, 4.0), {}, {}};
  for (int i = 0; i < 60; ++i) {
    track.banks.push_back(0.3 * std::sin(0.1 * i));
    track.heights.push_back(0.01 * i / 3.0);
  }
  const BankedTrack read = ReadBankedTrack(folder.Write("bank.csv", BankedTrackCsv(track)));
  EXPECT_EQ(read.points, track.points);
  EXPECT_EQ(read.banks, track.banks);
  EXPECT_EQ(read.heights, track.heights);
}

TEST(BankedTrack, NamesWhatIsWrongWithAFile) {
  const TempFolder folder;
  const auto error = [&](const char* name, const char* header, const char* bank) {
    std::string text = header;
    for (const TrackPoint& point : RingPoints(40.0, 20, 5.0, 4.0)) {
      text += "\n" + std::to_string(point.position.x()) + "," + std::to_string(point.position.y()) +
              ",5,4," + bank;
    }
    try {
      static_cast<void>(ReadBankedTrack(folder.Write(name, text + "\n")));
    } catch (const InputError& problem) {
      return std::string(problem.what());
    }
    return std::string();
  };
  constexpr const char* kHeader = "x_m,y_m,w_tr_right_m,w_tr_left_m,bank_rad";
  EXPECT_EQ(error("good.csv", kHeader, "0.1"), "");
  EXPECT_THAT(error("none.csv", "x_m,y_m,w_tr_right_m,w_tr_left_m,speed", "0.1"),
              HasSubstr("none.csv:1: no column 'bank_rad' and no column 'z_m'; add the bank"));
  EXPECT_THAT(error("degrees.csv", kHeader, "9"),
              HasSubstr("degrees.csv:2: bank_rad: '9'; must be a number between -0.7854 and"));
  EXPECT_THAT(error("text.csv", kHeader, "left"), HasSubstr("text.csv:2: bank_rad: 'left'; must"));
  EXPECT_THAT(error("nan.csv", kHeader, "nan"), HasSubstr("nan.csv:2: bank_rad: 'nan'; must"));
}

/// Returns the points of an arc with a radius of 60 m from 0 to 2 rad, about the origin.
std::vector<TrackPoint> ArcPoints(double radius, int count) {
  std::vector<TrackPoint> points;
  for (int i = 0; i < count; ++i) {
    points.push_back({radius * Direction(2.0 * i / (count - 1)), 5.0, 4.0});
  }
  return points;
}

TEST(OpenRoad, IsAConeOnAnArcThatEnds) {
  constexpr double kRadius = 60.0;
  constexpr double kBank = -0.2;
  constexpr double kGrade = 0.05;
  BankedTrack road{ArcPoints(kRadius, 81), Same(kBank, 81), {}};
  road.closed = IsClosedLine(road.points);
  ASSERT_FALSE(road.closed);
  for (std::size_t i = 0; i < road.points.size(); ++i) {
    road.heights.push_back(kGrade * kRadius * 2.0 * static_cast<double>(i) / 80.0);
  }
  const auto terrain = MakeTerrain(road);
  for (double angle = 0.0; angle <= 2.0; angle += 0.05) {
    for (const double radius : {57.0, 60.0, 64.0}) {
      // The spline has no curvature at its ends: it leaves the arc by the wavelength of its
      // smoothing, four times 1.5 m, squared over 8 times the radius, at most 0.08 m. On the bank,
      // this is 15 mm.
      const double expected = kGrade * kRadius * angle + (kRadius - radius) * std::tan(kBank);
      EXPECT_NEAR(terrain->At(radius * Direction(angle)).height, expected, Tolerance(0.015))
          << angle << ", " << radius;
    }
  }
  // A meter beyond its end, the road continues with the bank and the grade of the end.
  const Vec2 ahead = kRadius * Direction(2.0) + 1.0 * Direction(2.0 + 0.5 * kPi);
  EXPECT_NEAR(terrain->At(ahead).height, kGrade * (2.0 * kRadius + 1.0), Tolerance(0.015));
}

TEST(OpenRoad, IsTheLogOfADrive) {
  // Rows of a log at 100 Hz, with a stop: points are 0.5 m apart, and there are no widths.
  TempFolder folder;
  std::string log = "t,x,y,bank_rad,z_m\n";
  double x = 0.0;
  for (int i = 0; i < 3000; ++i) {
    x += i > 1000 && i < 1500 ? 0.0 : 0.04;
    log +=
        fmt::format("{},{},{},{},{}\n", 0.01 * i, x, 3.0 * std::sin(0.05 * x), 0.002 * x, 0.03 * x);
  }
  const BankedTrack road = ReadBankedTrack(folder.Write("drive.csv", log));
  EXPECT_FALSE(road.closed);
  ASSERT_GT(road.points.size(), 100U);
  for (std::size_t i = 0; i < road.points.size(); ++i) {
    const Vec2& at = road.points[i].position;
    EXPECT_NEAR(road.banks[i], 0.002 * at.x(), Tolerance(1e-9));
    EXPECT_NEAR(road.heights[i], 0.03 * at.x(), Tolerance(1e-9));
    EXPECT_EQ(road.points[i].width_left, 5.0);
    if (i > 0) {
      // Less than a row of 0.04 sqrt(1 + 0.15^2) m beyond the spacing.
      EXPECT_NEAR((at - road.points[i - 1].position).norm(), 0.52, Tolerance(0.0205));
    }
  }
  // The copy of a run folder is open, too, even if the ends of its line meet.
  BankedTrack ring{RingPoints(40.0, 60, 5.0, 4.0), Same(0.1, 60), Same(0.0, 60), false};
  EXPECT_TRUE(IsClosedLine(ring.points));
  EXPECT_FALSE(ReadBankedTrack(folder.Write("bank.csv", BankedTrackCsv(ring))).closed);
}

TEST(OpenRoad, IsNotClosedWithoutItsEnd) {
  // A ring is closed; without an eighth of its points, or with a corner at its end, it is not.
  std::vector<TrackPoint> ring = RingPoints(40.0, 80, 5.0, 4.0);
  EXPECT_TRUE(IsClosedLine(ring));
  ring.resize(70);
  EXPECT_FALSE(IsClosedLine(ring));
  std::vector<TrackPoint> corner;
  for (int i = 0; i < 40; ++i) {
    corner.push_back({Vec2(i, 0.0), 2.0, 2.0});
  }
  for (int i = 1; i < 40; ++i) {
    const double angle = kPi * i / 39.0;
    corner.push_back(
        {Vec2(39.0 - 19.5 * (1.0 - std::cos(angle)), 19.5 * std::sin(angle)), 2.0, 2.0});
  }
  // The gap is small and the last chord points down, at a right angle to the first one.
  corner.pop_back();
  EXPECT_FALSE(IsClosedLine(corner));
}

TEST(OpenRoad, NamesWhatIsWrong) {
  TempFolder folder;
  const auto error_of = [&](const std::string& text) {
    try {
      static_cast<void>(ReadBankedTrack(folder.Write("road.csv", text)));
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  std::string few = "x,y,bank_rad\n";
  for (int i = 0; i < 5; ++i) {
    few += fmt::format("{},0,0.1\n", 2 * i);
  }
  EXPECT_THAT(error_of(few), HasSubstr("the open line has 5 points; must have 8 to 20000"));
  std::string back = "x,y,bank_rad\n";
  for (int i = 0; i < 20; ++i) {
    back += fmt::format("{},0,0.1\n", i < 15 ? i : 28 - i);
  }
  EXPECT_THAT(error_of(back), HasSubstr("turns back at its point 15, 14, 0"));
  std::string unclear = "x,y,bank_rad,closed\n";
  for (int i = 0; i < 20; ++i) {
    unclear += fmt::format("{},0,0.1,{}\n", i, i == 7 ? "no" : "0");
  }
  EXPECT_THAT(error_of(unclear), HasSubstr("road.csv:9: closed: 'no'; must be 1 if the line is"));
}

}  // namespace
}  // namespace trackbed
