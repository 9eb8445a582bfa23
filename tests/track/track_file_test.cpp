#include "trackbed/track/track_file.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <set>

#include "tests/support/temp_folder.h"
#include "tests/tolerance.h"
#include "tests/track/rings.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

const std::string kHeader = "# x_m,y_m,w_tr_right_m,w_tr_left_m\n";

/// Returns the text of a track file: a ring of radius 20 m. Replaces the row on line `line` by
/// `row`.
std::string RingFile(int line = 0, const std::string& row = "") {
  std::string text = TrackCsv(RingPoints(20.0, 24, 4.0, 3.0));
  std::size_t begin = 0;
  for (int i = 1; i < line; ++i) {
    begin = text.find('\n', begin) + 1;
  }
  return line == 0 ? text : text.replace(begin, text.find('\n', begin) - begin, row);
}

std::string ErrorMessages(const std::string& csv) {
  const TempFolder folder;
  try {
    static_cast<void>(ReadTrack(folder.Write("t.csv", csv)));
  } catch (const InputError& error) {
    std::string text = error.what();
    const std::string prefix = folder.path().string() + "/";
    for (auto at = text.find(prefix); at != std::string::npos; at = text.find(prefix)) {
      text.erase(at, prefix.size());
    }
    return text;
  }
  return "no problem";
}

TEST(ReadTrack, ReadsBackWhatTrackCsvWrites) {
  const TempFolder folder;
  std::vector<TrackPoint> points = RingPoints(20.0, 24, 4.0, 3.0);
  points[7].width_left = 2.0 / 3.0;
  const Track track = ReadTrack(folder.Write("t.csv", TrackCsv(points)));
  EXPECT_EQ(track.points(), points);
  EXPECT_EQ(TrackCsv(track.points()), TrackCsv(points));
}

TEST(ReadTrack, TakesTheHeaderWithAndWithoutItsMark) {
  const TempFolder folder;
  const std::string rows = RingFile().substr(kHeader.size());
  const std::vector<TrackPoint> points = RingPoints(20.0, 24, 4.0, 3.0);
  for (const char* header :
       {"# x_m,y_m,w_tr_right_m,w_tr_left_m\n", "#x_m, y_m, w_tr_right_m, w_tr_left_m\n",
        "x_m,y_m,w_tr_right_m,w_tr_left_m\r\n"}) {
    EXPECT_EQ(ReadTrack(folder.Write("t.csv", header + rows)).points(), points) << header;
  }
}

TEST(ReadTrack, TakesColumnsInAnyOrder) {
  std::string text = "w_tr_left_m,y_m,x_m,note,w_tr_right_m\n";
  for (const TrackPoint& point : RingPoints(20.0, 24, 4.0, 3.0)) {
    text += std::to_string(point.width_left) + "," + std::to_string(point.position.y()) + "," +
            std::to_string(point.position.x()) + ",kerb," + std::to_string(point.width_right) +
            "\n";
  }
  const TempFolder folder;
  const Track track = ReadTrack(folder.Write("t.csv", text));
  EXPECT_EQ(track.points()[3].width_left, 3.0);
  EXPECT_EQ(track.points()[3].width_right, 4.0);
  // The file has coordinates with six decimals.
  EXPECT_NEAR(track.points()[6].position.y(), 20.0, Tolerance(5e-7));
}

TEST(ReadTrack, NamesTheLineOfEachMistake) {
  EXPECT_EQ(ErrorMessages(RingFile(5, "1,x,4,3")), "t.csv:5: cell 2 (y_m): 'x' is not a number");
  EXPECT_EQ(ErrorMessages(RingFile(5, "1,nan,4,3")),
            "t.csv:5: cell 2 (y_m): 'nan' is not a finite number");
  EXPECT_EQ(ErrorMessages(RingFile(5, "1,inf,4,3")),
            "t.csv:5: cell 2 (y_m): 'inf' is not a finite number");
  EXPECT_EQ(ErrorMessages(RingFile(5, "1,2e7,4,3")),
            "t.csv:5: y_m: 20000000 is out of range; must be between -10000000 and 10000000");
  EXPECT_EQ(ErrorMessages(RingFile(5, "1,2,0,3")),
            "t.csv:5: w_tr_right_m: 0 is out of range; must be above 0 and at most 1000");
  EXPECT_EQ(ErrorMessages(RingFile(5, "1,2,4,-3")),
            "t.csv:5: w_tr_left_m: -3 is out of range; must be above 0 and at most 1000");
  EXPECT_EQ(ErrorMessages(RingFile(3, "20,0,4,3")), "t.csv:3: same point as in the row before");
  EXPECT_THAT(ErrorMessages(RingFile(5, "1,2,4")), StartsWith("t.csv:5: "));
}

TEST(ReadTrack, NamesTwoMistakesAtOnce) {
  const std::string text = ErrorMessages(RingFile(5, "1,2,0,-3"));
  EXPECT_THAT(text, HasSubstr("t.csv:5: w_tr_right_m"));
  EXPECT_THAT(text, HasSubstr("t.csv:5: w_tr_left_m"));
}

TEST(ReadTrack, RefusesFilesThatAreNoTracks) {
  EXPECT_THAT(ErrorMessages(""), HasSubstr("t.csv"));
  EXPECT_THAT(ErrorMessages("x_m,y_m\n1,2\n"), HasSubstr("w_tr_right_m"));
  EXPECT_THAT(ErrorMessages("y_m,w_tr_right_m,w_tr_left_m\n2,3,4\n"),
              HasSubstr("t.csv:1: no column 'x_m'"));
  EXPECT_EQ(ErrorMessages(kHeader), "t.csv: has 0 points; a track has 8 to 20000");
  EXPECT_EQ(ErrorMessages(kHeader + "1,2,3,4\n2,2,3,4\n"),
            "t.csv: has 2 points; a track has 8 to 20000");
  std::string long_file = kHeader;
  for (int i = 0; i < 20001; ++i) {
    long_file += std::to_string(i) + ",0,4,3\n";
  }
  EXPECT_EQ(ErrorMessages(long_file), "t.csv: has 20001 points; a track has 8 to 20000");
}

TEST(ReadTrack, RefusesLargeFilesBeforeItReadsThem) {
  const TempFolder folder;
  const std::filesystem::path file = folder.Write("t.csv", kHeader);
  std::filesystem::resize_file(file, (std::uintmax_t{16} << 20U) + 1);
  try {
    static_cast<void>(ReadTrack(file));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("has 16777217 bytes; a track has at most 16777216"));
  }
}

TEST(ReadTrack, DropsTheFirstPointAtTheEnd) {
  const TempFolder folder;
  for (const char* end : {"20,0,4,3\n", "20.0001,-0.0001,4,3\n"}) {
    const TrackFile read = ReadTrackFile(folder.Write("t.csv", RingFile() + end));
    EXPECT_EQ(read.track.points(), RingPoints(20.0, 24, 4.0, 3.0));
    EXPECT_THAT(read.notes, testing::ElementsAre("line 26: the first point again, dropped"));
  }
}

TEST(ReadTrack, TakesOtherDelimitersCommentsAndNames) {
  const TempFolder folder;
  const std::vector<TrackPoint> points = RingPoints(20.0, 24, 4.0, 3.0);
  const std::string rows = RingFile().substr(kHeader.size());
  for (const char delimiter : {',', ';', '\t'}) {
    std::string own = "# made by \"somebody\", by hand\n# x_m, y_m, w_tr_right_m, w_tr_left_m\n" +
                      rows + "# the end\n";
    std::replace(own.begin(), own.end(), ',', delimiter);
    EXPECT_EQ(ReadTrack(folder.Write("t.csv", own)).points(), points) << delimiter;
  }
  const TrackFile named =
      ReadTrackFile(folder.Write("t.csv", "X,Y,right_width,left_width\n" + rows));
  EXPECT_EQ(named.track.points(), points);
  EXPECT_THAT(named.notes.at(0), HasSubstr("X, Y, right_width, left_width"));
}

TEST(ReadTrack, TakesTheWidthOfFilesWithoutWidths) {
  const TempFolder folder;
  std::string text = "y,x\n";
  for (const TrackPoint& point : RingPoints(20.0, 24, 4.0, 3.0)) {
    text += fmt::format("{},{}\n", point.position.y(), point.position.x());
  }
  EXPECT_THAT(ErrorMessages(text), HasSubstr("give the width of the track by mission.track.width"));
  const std::filesystem::path file = folder.Write("t.csv", text);
  EXPECT_EQ(ReadTrackFile(file, {.width = 5.0}).track.points(), RingPoints(20.0, 24, 2.5, 2.5));
  const std::filesystem::path with_widths = folder.Write("w.csv", RingFile());
  EXPECT_THROW(ReadTrackFile(with_widths, {.width = 5.0}), InputError);
}

TEST(ReadTrack, NarrowsTheEdgeWhereItWouldFold) {
  // The ellipse's radius of curvature is 30 m at its start and at the opposite end.
  const TempFolder folder;
  const std::string text = TrackCsv(EllipsePoints(120.0, 60.0, 114, 5.0, 31.0));
  const TrackFile read = ReadTrackFile(folder.Write("t.csv", text));
  ASSERT_EQ(read.notes.size(), 3U);  // the place at the start line is at both ends of the file
  EXPECT_THAT(read.notes[0], testing::AllOf(StartsWith("lines 2 to "),
                                            HasSubstr("the left edge is narrowed from 31 m to 28."),
                                            HasSubstr("bends on a radius of 30.")));
  for (double s = 0.0; s < read.track.length(); s += 0.4) {
    EXPECT_LT(read.track.EdgesAt(s).left * read.track.At(s).curvature, 0.96);
  }
  // Points at which the ellipse is straighter keep their width.
  EXPECT_EQ(read.track.points()[28].width_left, 31.0);
  EXPECT_EQ(read.track.points()[3].width_right, 5.0);
  const std::string again = TrackCsv(read.track.points());
  const TrackFile second = ReadTrackFile(folder.Write("again.csv", again));
  EXPECT_EQ(second.track.points(), read.track.points());
  EXPECT_TRUE(second.notes.empty());
}

TEST(ReadTrack, RefusesToNarrowAnEdgeToLessThanHalf) {
  EXPECT_THAT(
      ErrorMessages(TrackCsv(EllipsePoints(120.0, 60.0, 114, 5.0, 62.0))),
      testing::AllOf(StartsWith("t.csv:"), HasSubstr("the center line bends on a radius of"),
                     HasSubstr("the inner edge is 62 m from it"), HasSubstr("less than half")));
}

// Without this error message, the smoothed center line would have cusps.
TEST(ReadTrack, NamesThePointsAtWhichTheLineTurnsBack) {
  std::vector<TrackPoint> points = EllipsePoints(120.0, 60.0, 114, 5.0, 5.0);
  std::swap(points[50], points[52]);
  const std::string text = ErrorMessages(TrackCsv(points));
  // The swapped points 50 and 52 are on lines 52 and 54, after the header line. The ellipse itself
  // turns by only a few degrees from point to point.
  EXPECT_THAT(text, StartsWith("t.csv:52: the center line turns back here, by 17"));
  EXPECT_THAT(text, HasSubstr(" degrees; must be at most 150 from point to point"));
  EXPECT_THAT(text, HasSubstr("t.csv:54: the center line turns back here"));
}

TEST(ReadTrack, RefusesLapsThatAreTooLong) {
  std::vector<TrackPoint> points = EllipsePoints(4e4, 4e4, 100, 5.0, 5.0);
  points.erase(points.begin() + 2);
  // The points on lines 3 and 4 of the file are 3.6 and 10.8 degrees around the circle from the
  // start.
  EXPECT_EQ(ErrorMessages(TrackCsv(points)),
            "t.csv:4: a lap is 251.3 km long; must be at most 200: the gap between rows 3 and 4 is "
            "5023.242 m");
}

TEST(ReadTrack, ReadsTracksOfTum) {
  const std::filesystem::path folder =
      std::filesystem::path(TRACKBED_SOURCE_DIR) / "tests/data/tracks";
  struct Known {
    const char* name;
    std::size_t points;
    double length;  // published length [m]
  };
  for (const Known& known : {Known{"Norisring", 460, 2300.0}, Known{"Hockenheim", 914, 4574.0},
                             Known{"Spielberg", 864, 4318.0}, Known{"Silverstone", 1178, 5891.0}}) {
    const Track track = ReadTrack(folder / (std::string(known.name) + ".csv"));
    EXPECT_EQ(track.points().size(), known.points) << known.name;
    // The tolerance is 0.5 % of the length, because track operators measure along different lines.
    EXPECT_NEAR(track.length(), known.length, Tolerance(0.005 * known.length)) << known.name;
    EXPECT_LT(track.deviation_max(), 0.5) << known.name;
    EXPECT_LT(track.deviation_rms(), 0.05) << known.name;
  }
}

TEST(ReadTrack, TakesColumnsWithoutNamesInTheOrderOfTum) {
  const TempFolder folder;
  const std::vector<TrackPoint> points = RingPoints(20.0, 24, 4.0, 3.0);
  const std::string rows = RingFile().substr(kHeader.size());
  const TrackFile read = ReadTrackFile(folder.Write("t.csv", rows));
  EXPECT_EQ(read.track.points(), points);
  EXPECT_THAT(read.notes, testing::Contains(HasSubstr("no column names")));
  std::string places;
  for (const TrackPoint& point : points) {
    places += fmt::format("{} {}\n", point.position.x(), point.position.y());
  }
  EXPECT_EQ(ReadTrackFile(folder.Write("p.csv", places), {.width = 6.0}).track.points()[5].position,
            points[5].position);
  EXPECT_THAT(ErrorMessages(places), HasSubstr("no column names before the first row of 2 cells"));
  EXPECT_THAT(ErrorMessages("1,2,3\n4,5,6\n"), HasSubstr("first row of 3 cells"));
}

/// Returns the distance of a point from a stadium: two half circles of a radius around
/// (-length / 2, 0) and (length / 2, 0), and two straights.
double FromStadium(const Vec2& point, double radius, double length) {
  const double beside = std::max(std::abs(point.x()) - 0.5 * length, 0.0);
  return std::abs(std::hypot(beside, point.y()) - radius);
}

/// Points on a stadium at distances `step` in the bends and `straight` on the straights.
std::vector<TrackPoint> StadiumPoints(double radius, double length, double step, double straight,
                                      double width) {
  std::vector<TrackPoint> points;
  for (const double side : {1.0, -1.0}) {
    const int bends = static_cast<int>(std::ceil(kPi * radius / step));
    for (int i = 0; i <= bends; ++i) {
      const double angle = kPi * (i / static_cast<double>(bends) - 0.5);
      points.push_back(
          {side * Vec2(0.5 * length + radius * std::cos(angle), radius * std::sin(angle)), width,
           width});
    }
    const int pieces = static_cast<int>(std::ceil(length / straight));
    for (int i = 1; i < pieces; ++i) {
      points.push_back({side * Vec2(0.5 * length - length * i / pieces, radius), width, width});
    }
  }
  return points;
}

double FarthestFromStadium(const Track& track, double radius, double length) {
  double farthest = 0.0;
  for (double s = 0.0; s < track.length(); s += 0.25) {
    farthest = std::max(farthest, FromStadium(track.At(s).pose.position(), radius, length));
  }
  return farthest;
}

// A straight between two bends of the same side, of points that are dense in the bends: the smooth
// curve through them alone moves no point, but swings aside between the bends. The bound is a tenth
// of the width of 8 m.
TEST(ReadTrack, KeepsToALongStraightIfNoPointWouldMove) {
  const std::vector<TrackPoint> points = StadiumPoints(90.0, 900.0, 3.0, 900.0, 4.0);
  const Track smooth(points);
  ASSERT_LT(smooth.deviation_max(), 0.8);
  ASSERT_GT(FarthestFromStadium(smooth, 90.0, 900.0), 0.8);
  const TempFolder folder;
  const TrackFile read = ReadTrackFile(folder.Write("t.csv", TrackCsv(points)));
  EXPECT_LT(FarthestFromStadium(read.track, 90.0, 900.0), 0.8);
  EXPECT_THAT(read.notes, testing::Contains(HasSubstr("points are added on the straight lines")));
  // A wavelength of the user adds no points: a note names the steps. The points with those
  // that the reader adds need no note.
  const TrackFile given =
      ReadTrackFile(folder.Write("t.csv", TrackCsv(points)), {.smoothing = smooth.smoothing()});
  EXPECT_GT(FarthestFromStadium(given.track, 90.0, 900.0), 0.8);
  EXPECT_THAT(given.notes, testing::Contains(HasSubstr("swings aside of the straight lines")));
  const TrackFile again = ReadTrackFile(folder.Write("a.csv", TrackCsv(read.track.points())),
                                        {.smoothing = read.track.smoothing()});
  EXPECT_THAT(again.notes, testing::Not(testing::Contains(HasSubstr("swings aside"))));
}

// Some files have points in bends only. Four times the mean distance of these points is longer than
// a bend, and would move points by more than 1 m; and a smooth curve through them alone swings
// aside on the straights. The bound is the greatest shift that the reader allows, a tenth of the
// width of 10 m.
TEST(ReadTrack, KeepsToLongStraightsWithoutPoints) {
  for (const double straight : {150.0, 600.0}) {
    SCOPED_TRACE(straight);
    const std::vector<TrackPoint> points = StadiumPoints(25.0, 600.0, 6.0, straight, 5.0);
    const TempFolder folder;
    const TrackFile read = ReadTrackFile(folder.Write("t.csv", TrackCsv(points)));
    EXPECT_GT(Track(points).deviation_max(), 1.0);
    EXPECT_LE(read.track.deviation_max(), 1.0);
    EXPECT_LT(FarthestFromStadium(read.track, 25.0, 600.0), 1.0);
    EXPECT_THAT(read.notes, testing::Contains(HasSubstr("points are added on the straight lines")));
    // A run keeps the track with these points; the same track is read from it.
    const TrackFile again = ReadTrackFile(folder.Write("a.csv", TrackCsv(read.track.points())),
                                          {.smoothing = read.chosen_smoothing});
    EXPECT_EQ(again.track.points(), read.track.points());
    EXPECT_EQ(again.track.length(), read.track.length());
  }
}

/// Keeps the points from `from` to `to` that a polyline within `tolerance` [m] needs (Ramer 1972,
/// Douglas and Peucker 1973).
void Thin(const std::vector<TrackPoint>& points, std::size_t from, std::size_t to, double tolerance,
          std::set<std::size_t>& kept) {
  const Vec2& begin = points[from].position;
  const Vec2 along = points[to].position - begin;
  double farthest = tolerance;
  std::size_t at = from;
  for (std::size_t i = from + 1; i < to; ++i) {
    const Vec2 own = points[i].position - begin;
    const double share = std::clamp(own.dot(along) / along.squaredNorm(), 0.0, 1.0);
    const double distance = (own - share * along).norm();
    if (distance > farthest) {
      farthest = distance;
      at = i;
    }
  }
  if (at != from) {
    kept.insert(at);
    Thin(points, from, at, tolerance, kept);
    Thin(points, at, to, tolerance, kept);
  }
}

// Thinned points have long steps beside short ones, on which a smooth curve alone swings up to 19 m
// aside. The line of the thinned points must stay in the middle half of the surveyed track. The
// surveyed points are within the tolerance of the lines between the thinned points.
TEST(ReadTrack, KeepsToTheTrackOfThinnedPoints) {
  const std::filesystem::path tracks =
      std::filesystem::path(TRACKBED_SOURCE_DIR) / "tests/data/tracks";
  for (const char* name : {"Hockenheim", "Norisring", "Silverstone", "Spielberg"}) {
    const Track surveyed = ReadTrack(tracks / (std::string(name) + ".csv"));
    for (const double tolerance : {0.3, 1.0}) {
      SCOPED_TRACE(name + (" within " + std::to_string(tolerance)));
      const std::size_t last = surveyed.points().size() - 1;
      std::set<std::size_t> kept{0, last / 2, last};
      Thin(surveyed.points(), 0, last / 2, tolerance, kept);
      Thin(surveyed.points(), last / 2, last, tolerance, kept);
      std::vector<TrackPoint> points;
      for (const std::size_t i : kept) {
        points.push_back(surveyed.points()[i]);
      }
      const TempFolder folder;
      const TrackFile read = ReadTrackFile(folder.Write("t.csv", TrackCsv(points)));
      for (double s = 0.0; s < read.track.length(); s += 5.0) {
        const Vec2 at = read.track.At(s).pose.position();
        const auto nearest = std::min_element(
            surveyed.points().begin(), surveyed.points().end(), [&](const auto& a, const auto& b) {
              return (a.position - at).norm() < (b.position - at).norm();
            });
        const auto i = static_cast<std::size_t>(nearest - surveyed.points().begin());
        const TrackPlace place = surveyed.Locate(at, surveyed.StationOf(i));
        const TrackEdges edges = surveyed.EdgesAt(place.s);
        EXPECT_LT(place.offset, 0.5 * edges.left) << s;
        EXPECT_GT(place.offset, 0.5 * edges.right) << s;
      }
    }
  }
}

// Center lines that are found in pictures of maps have points on the grid of the picture. Their
// steps of half a cell are off the line by up to 0.71 cells, and so is the reader's line at most
// by this and the shift that it allows, a tenth of the width of 2 m.
TEST(ReadTrack, SmoothsPointsOnAGridMore) {
  constexpr double kCell = 0.05;
  std::vector<TrackPoint> points;
  for (const TrackPoint& point : StadiumPoints(3.0, 8.0, kCell, kCell, 1.0)) {
    const Vec2 cell = (point.position / kCell).array().round() * kCell;
    if (points.empty() || points.back().position != cell) {
      points.push_back({cell, 1.0, 1.0});
    }
  }
  if (points.back().position == points.front().position) {
    points.pop_back();
  }
  const TempFolder folder;
  const std::filesystem::path file = folder.Write("t.csv", TrackCsv(points));
  EXPECT_THROW(ReadTrack(file, 4.0 * kCell), InputError);
  const TrackFile read = ReadTrackFile(file);
  EXPECT_LT(FarthestFromStadium(read.track, 3.0, 8.0), 0.71 * kCell + 0.2);
  EXPECT_EQ(read.track.points().size(), points.size());
  EXPECT_THAT(read.notes, testing::Contains(HasSubstr("an edge would fold over")));
}

}  // namespace
}  // namespace trackbed
