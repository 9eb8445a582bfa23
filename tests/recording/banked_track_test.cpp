#include "trackbed/recording/banked_track.h"

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
      // Counterclockwise, the left edge is 4 m nearer to the middle.
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

}  // namespace
}  // namespace trackbed
