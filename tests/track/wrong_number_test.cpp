#include "tests/support/wrong_number.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "tests/support/processor_time.h"
#include "tests/support/temp_folder.h"
#include "tests/track/rings.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/track/track_file.h"

namespace trackbed {
namespace {

/// Reads a track file. Expects at most two seconds of processor time, and either a track or
/// problems that name their line.
void ExpectBounded(const std::filesystem::path& file) {
  const double begun = ProcessorTime();
  try {
    static_cast<void>(ReadTrack(file));
  } catch (const InputError& error) {
    for (const Problem& problem : error.problems()) {
      EXPECT_GT(problem.line, 0) << error.what();
    }
  }
  EXPECT_LE(ProcessorTime() - begun, 2.0);
}

void TrySlips(const std::string& csv, int count, std::uint64_t seed) {
  const TempFolder folder;
  std::mt19937_64 random(seed);
  for (int i = 0; i < count; ++i) {
    const std::string wrong = WithWrongNumber(csv, csv.find('\n'), random);
    SCOPED_TRACE("seed " + std::to_string(seed) + ", slip " + std::to_string(i));
    ExpectBounded(folder.Write("t.csv", wrong));
  }
}

TEST(TrackWithAWrongNumber, OfFewPoints) {
  TrySlips(TrackCsv(RingPoints(20.0, 24, 4.0, 3.0)), 300, 1);
  TrySlips(TrackCsv(EllipsePoints(500.0, 300.0, 24, 6.0, 7.0)), 300, 2);
  TrySlips(TrackCsv(EllipsePoints(120.0, 60.0, 9, 5.0, 5.0)), 300, 3);
}

TEST(TrackWithAWrongNumber, OfTum) {
  const std::filesystem::path tracks =
      std::filesystem::path(TRACKBED_SOURCE_DIR) / "tests/data/tracks";
  std::uint64_t seed = 10;
  for (const char* name : {"Norisring", "Hockenheim", "Spielberg", "Silverstone"}) {
    TrySlips(ReadFile(tracks / (std::string(name) + ".csv")), 25, ++seed);
  }
}

/// A ring of 24 points in which one coordinate lost a digit. At this point, the line bends with a
/// radius of 0.4 mm.
TEST(TrackWithAWrongNumber, IsRefusedBeforeTheTrackIsMade) {
  std::vector<TrackPoint> points = RingPoints(20.0, 24, 4.0, 3.0);
  points[18].position.y() = -2.0;
  const auto fold = FindFold(points, std::nullopt);
  ASSERT_TRUE(fold);
  EXPECT_LT(fold->radius, fold->width);
  const TempFolder folder;
  ExpectBounded(folder.Write("t.csv", TrackCsv(points)));
}

/// Returns the processor time [s] of reading a ring of `count` points.
double ReadingTime(int count) {
  const TempFolder folder;
  const auto file = folder.Write("t.csv", TrackCsv(RingPoints(120.0, count, 4.0, 3.0)));
  const double begun = ProcessorTime();
  static_cast<void>(ReadTrack(file));
  return ProcessorTime() - begun;
}

/// The points are 16 and 4 cm apart. Reading must search for each point only near its own station.
TEST(DenseTrack, IsReadInTimeInProportionToItsPoints) {
  // Four times as many points take four times as long, or sixteen times if reading searches for
  // each point among all points. The bound is the geometric mean.
  EXPECT_LE(ReadingTime(20'000), 8.0 * ReadingTime(5'000));
}

/// ReadTrack searches for each point only close to the point's station. A search within 30 m of the
/// station must find the same place.
TEST(TrackOfTum, HasItsEdgesWhereAFartherLookFindsThem) {
  for (const char* name : {"Norisring", "Hockenheim", "Spielberg", "Silverstone"}) {
    const Track track = ReadTrack(std::filesystem::path(TRACKBED_SOURCE_DIR) / "tests/data/tracks" /
                                  (std::string(name) + ".csv"));
    for (std::size_t i = 0; i < track.points().size(); ++i) {
      const TrackPoint& point = track.points()[i];
      const double own = track.Locate(point.position, track.StationOf(i)).offset;
      EXPECT_EQ(track.EdgesAt(track.StationOf(i)).left, own + point.width_left) << name << i;
    }
  }
}

/// The distance between neighboring points exceeds the length by which the internal path continues
/// past the start line.
TEST(SparseTrack, IsMade) {
  // The cutoff wavelength is half of the distance between the points, so smoothing keeps a wave
  // over all 16 points.
  constexpr double kSmoothing = 4e3;
  const Track track(EllipsePoints(20e3, 20e3, 16, 4.0, 3.0), kSmoothing);
  EXPECT_NEAR(track.length(), 2.0 * kPi * 20e3, 0.01 * track.length());
  EXPECT_FALSE(FindFold(track.points(), kSmoothing));
}

}  // namespace
}  // namespace trackbed
