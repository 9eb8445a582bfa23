#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "tests/road_network/documents.h"
#include "trackbed/road_network/lane_route.h"
#include "trackbed/road_network/open_drive.h"

// Tests that a path along lanes returns to the lane centers after gaps between the records of a
// file, on random roads of lines and arcs whose records begin beside the end of the record before.
namespace trackbed {
namespace {

using ::testing::ContainsRegex;
using ::testing::IsEmpty;

/// A road of `lengths.size()` records, whose start is moved by `shifts` [m] from the end of the
/// record before.
struct ShiftedRoad {
  std::vector<double> lengths;
  std::vector<double> curvatures;
  std::vector<Vec2> shifts;

  [[nodiscard]] RoadNetwork Network() const {
    RoadText text;
    text.geometry.clear();
    Vec2 place(0.0, 0.0);
    double heading = 0.3;
    double s = 0.0;
    for (std::size_t i = 0; i < lengths.size(); ++i) {
      place += shifts[i];
      const double k = curvatures[i];
      text.geometry += fmt::format(
          "<geometry s='{:.17g}' x='{:.17g}' y='{:.17g}' hdg='{:.17g}' length='{:.17g}'>{}"
          "</geometry>",
          s, place.x(), place.y(), heading, lengths[i],
          k == 0.0 ? "<line/>" : fmt::format("<arc curvature='{:.17g}'/>", k));
      const double end = heading + k * lengths[i];
      place += k == 0.0 ? Vec2(lengths[i] * std::cos(heading), lengths[i] * std::sin(heading))
                        : Vec2((std::sin(end) - std::sin(heading)) / k,
                               (std::cos(heading) - std::cos(end)) / k);
      heading = end;
      s += lengths[i];
    }
    text.length = fmt::format("{:.17g}", s);
    return ParseNetwork(text.Xml());
  }
};

/// Returns the distance of the center of lane -1 from the path, at a station of the road.
double Off(const RoadNetwork& network, const Path& path, double s) {
  const RoadPosition center = LanePositionAt(network.roads.at("1"), -1, s);
  return std::abs(path.Project({center.x, center.y, 0.0}, {s - 20.0, s + 20.0}).cross_track);
}

TEST(LaneGaps, ThePathReturnsToTheCentersOfRandomRoads) {
  std::mt19937 random(20261126);
  const auto uniform = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  constexpr double kGap = 0.03;
  // A gap of 3 cm is closed over sqrt(10/sqrt(3) 0.03/1e-3) = 13.2 m.
  constexpr double kHalfLength = 6.6;
  for (int road = 0; road < 10; ++road) {
    ShiftedRoad shifted;
    for (int i = 0; i < 8; ++i) {
      shifted.lengths.push_back(uniform(20.0, 60.0));
      shifted.curvatures.push_back(i % 2 == 0 ? 0.0 : uniform(-0.02, 0.02));
      const double direction = uniform(-3.0, 3.0);
      shifted.shifts.push_back(kGap * uniform(0.0, 1.0) *
                               Vec2(std::cos(direction), std::sin(direction)));
    }
    const RoadNetwork network = shifted.Network();
    const double length = network.roads.at("1").length;
    const LaneRoute route = FindLaneRoute(network, {{"1", -1, 0.5}, {"1", -1, length - 0.5}});
    ASSERT_TRUE(route.ok()) << route.failure;
    // Up to 1 mm is kept from earlier gaps and closed with the next one, half before it and half
    // beyond it; another 1 mm may be kept there.
    EXPECT_LE(route.deviation, 0.5 * (kGap + 1e-3) + 1e-3);
    double joint = 0.0;
    for (std::size_t i = 0; i < shifted.lengths.size(); ++i) {
      const double end = joint + shifted.lengths[i];
      for (double s = joint + (i == 0 ? 0.5 : kHalfLength + 0.5);
           s < end - (i + 1 == shifted.lengths.size() ? 0.5 : kHalfLength + 0.5); s += 2.5) {
        EXPECT_LE(Off(network, route.path, s), 1e-3) << "road " << road << " at " << s;
      }
      joint = end;
    }
  }
}

TEST(LaneGaps, ClosingAddsLittleCurvature) {
  // The shift is to the left of the heading 0.3 rad.
  const ShiftedRoad shifted{
      {50.0, 50.0}, {0.0, 0.0}, {{0.0, 0.0}, {-0.04 * std::sin(0.3), 0.04 * std::cos(0.3)}}};
  const LaneRoute route = FindLaneRoute(shifted.Network(), {{"1", -1, 1.0}, {"1", -1, 99.0}});
  ASSERT_TRUE(route.ok()) << route.failure;
  double largest = 0.0;
  for (const PathPoint& point : route.path.Sample(0.05)) {
    largest = std::max(largest, std::abs(point.curvature));
  }
  // The rate of the move turns the path by less than 5 mrad, which changes the curvature of 1e-3
  // 1/m by less than 1 %.
  EXPECT_NEAR(largest, 1e-3, 1e-5);
}

TEST(LaneGaps, SmallGapsThatAddUpAreClosed) {
  // 40 gaps of 0.9 mm to the same side: each is kept, but their sum is not.
  ShiftedRoad shifted;
  for (int i = 0; i < 41; ++i) {
    shifted.lengths.push_back(10.0);
    shifted.curvatures.push_back(0.0);
    shifted.shifts.emplace_back(0.0, i == 0 ? 0.0 : 0.0009);
  }
  const RoadNetwork network = shifted.Network();
  const LaneRoute route = FindLaneRoute(network, {{"1", -1, 1.0}, {"1", -1, 409.0}});
  ASSERT_TRUE(route.ok()) << route.failure;
  EXPECT_LE(route.deviation, 2e-3);
  EXPECT_THAT(route.note, IsEmpty());
}

TEST(LaneGaps, ThePathFollowsManyKinksThatAreCloserThanTheirRounding) {
  // A circle of 20 m radius made of lines of 7 cm, which meet at kinks of 3.5 mrad. One segment
  // over more than 1.5 m would cut the circle.
  RoadText text;
  text.geometry.clear();
  constexpr double kRadius = 20.0;
  constexpr double kTurn = 0.0035;
  const double chord = 2.0 * kRadius * std::sin(0.5 * kTurn);
  const int count = 800;
  for (int i = 0; i < count; ++i) {
    text.geometry += fmt::format(
        "<geometry s='{:.12g}' x='{:.12g}' y='{:.12g}' hdg='{:.12g}' length='{:.12g}'><line/>"
        "</geometry>",
        i * chord, kRadius * std::sin(i * kTurn), kRadius * (1.0 - std::cos(i * kTurn)),
        (i + 0.5) * kTurn, chord);
  }
  text.length = fmt::format("{:.12g}", count * chord);
  const RoadNetwork network = ParseNetwork(text.Xml());
  const LaneRoute route = FindLaneRoute(network, {{"1", 1, 50.0}, {"1", 1, 2.0}});
  ASSERT_TRUE(route.ok()) << route.failure;
  // The center of the lane is a circle of 18.25 m radius, and the path keeps up to 1 mm from it. At
  // the ends of a segment of 1.5 m, the curvature is that of a line, 0, so the segment is up to
  // 1.5^2/18.25/32 m = 3.9 mm off an arc, and by 1.5 m (4/27) 2 kTurn/2 = 0.8 mm because the ends
  // have the headings of chords.
  constexpr double kOff = 1e-3 + 3.9e-3 + 0.8e-3;
  for (const PathPoint& point : route.path.Sample(0.5)) {
    const double radius = (point.pose.position() - Vec2(0.0, kRadius)).norm();
    EXPECT_NEAR(radius, kRadius - 1.75, kOff);
  }
  EXPECT_LE(route.deviation, kOff);
}

TEST(LaneGaps, TheNoteNamesSizeAndPlace) {
  ShiftedRoad shifted{{50.0, 50.0}, {0.0, 0.0}, {{0.0, 0.0}, {0.0, 0.02}}};
  const std::vector<LanePlace> places{{"1", -1, 1.0}, {"1", -1, 99.0}};
  // The center of the lane is 1.75 m to the right of the reference line: (50 cos 0.3 + 1.75 sin
  // 0.3, 50 sin 0.3 - 1.75 cos 0.3 + 0.02) = (48.28, 13.12).
  EXPECT_EQ(FindLaneRoute(shifted.Network(), places).note,
            "the lanes' centers have a gap of 0.02 m at x = 48.28 m, y = 13.12 m; the path closes "
            "it over 11 m");
  shifted.shifts[1] = Vec2(0.0, 0.0);
  EXPECT_THAT(FindLaneRoute(shifted.Network(), places).note, IsEmpty());
  shifted.shifts[1] = Vec2(0.0, 0.06);
  EXPECT_THAT(FindLaneRoute(shifted.Network(), places).failure,
              ContainsRegex("0\\.06 m apart \\(at most 0\\.05 m\\)"));
}

}  // namespace
}  // namespace trackbed
