#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "src/path_files/lanelet2_map.h"
#include "tests/support/error_text.h"
#include "tests/support/temp_folder.h"
#include "tests/tolerance.h"
#include "trackbed/core/error.h"
#include "trackbed/path_files/path_file.h"

namespace trackbed {
namespace lanelet2_test {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;

std::string Node(int id, double x, double y) {
  return fmt::format(
      "<node id='{}' lat='' lon=''><tag k='local_x' v='{}'/><tag k='local_y' v='{}'/></node>\n", id,
      x, y);
}

std::string Tag(const std::string& key, const std::string& value) {
  return fmt::format("<tag k='{}' v='{}'/>", key, value);
}

std::string Way(int id, const std::vector<int>& nodes, const std::string& tags = "") {
  std::string text = fmt::format("<way id='{}'>", id);
  for (const int node : nodes) {
    text += fmt::format("<nd ref='{}'/>", node);
  }
  return text + tags + "</way>\n";
}

std::string Relation(int id, int left, int right, const std::string& tags = "") {
  return fmt::format(
      "<relation id='{}'><member type='way' role='left' ref='{}'/><member type='way' role='right' "
      "ref='{}'/>{}{}</relation>\n",
      id, left, right, Tag("type", "lanelet"), tags);
}

/// Two lanes side by side toward +x, each of two lanelets of 60 m: 10 and 11 between y = -2 and 2,
/// 20 and 21 between y = 2 and 6. The ways of a bit set in `reversed` run against the traffic.
struct MapText {
  unsigned reversed = 0;
  std::string line = Tag("subtype", "dashed");
  std::string tags = Tag("subtype", "road");
  std::string rest{};

  [[nodiscard]] std::string Xml() const {
    std::string nodes;
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) {
        nodes += Node(100 + 10 * row + column, 60.0 * column, 4.0 * row - 2.0);
      }
    }
    std::string ways;
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 2; ++column) {
        std::vector<int> two{100 + 10 * row + column, 101 + 10 * row + column};
        const int number = 2 * row + column;
        if ((reversed >> static_cast<unsigned>(number) & 1U) != 0U) {
          std::swap(two[0], two[1]);
        }
        ways += Way(200 + 10 * row + column, two, row == 1 ? line : "");
      }
    }
    return "<?xml version='1.0'?>\n<osm version='0.6'>\n" + nodes + ways +
           Relation(10, 210, 200, tags) + Relation(11, 211, 201, tags) +
           Relation(20, 220, 210, tags) + Relation(21, 221, 211, tags) + rest + "</osm>\n";
  }
};

PathFile Read(const std::string& text, const std::vector<std::string>& lanelets) {
  const TempFolder folder;
  PathMap map;
  map.lanelets = lanelets;
  return ReadPathFile(folder.Write("map.osm", text), map);
}

std::string WhyNot(const std::string& text, const std::vector<std::string>& lanelets) {
  return ErrorText([&] { Read(text, lanelets); });
}

TEST(Lanelet2, FollowsTheCentersOfLaneletsHoweverTheirWaysRun) {
  for (unsigned reversed = 0; reversed < 64; ++reversed) {
    const PathFile file = Read(MapText{.reversed = reversed}.Xml(), {"10", "11"});
    ASSERT_EQ(file.points.points.size(), 3U) << reversed;
    for (std::size_t i = 0; i < 3; ++i) {
      // The middle between y = -2 and y = 2 has no rounding error.
      EXPECT_EQ(file.points.points[i], Vec2(60.0 * static_cast<double>(i), 0.0)) << reversed;
    }
    EXPECT_TRUE(file.points.speed.empty());
  }
}

TEST(Lanelet2, FollowsAUTurnWhoseInnerBoundIsAKnot) {
  // As in a public map: the inner bound is half a meter long and turns back on itself.
  const std::vector<Vec2> inner{{0.4, 0.0}, {0.8, 0.4}, {0.5, 0.1}, {0.0, -0.2}};
  const std::vector<Vec2> outer{{4.8, -1.8}, {8.0, 1.0}, {2.5, 6.5}, {-3.0, 3.0}};
  std::string nodes;
  for (int i = 0; i < 4; ++i) {
    const auto& [a, b] =
        std::pair(inner[static_cast<std::size_t>(i)], outer[static_cast<std::size_t>(i)]);
    nodes += Node(1 + i, a.x(), a.y()) + Node(11 + i, b.x(), b.y());
  }
  for (unsigned reversed = 0; reversed < 4; ++reversed) {
    std::vector<int> left{1, 2, 3, 4};
    std::vector<int> right{11, 12, 13, 14};
    if ((reversed & 1U) != 0U) {
      std::reverse(left.begin(), left.end());
    }
    if ((reversed & 2U) != 0U) {
      std::reverse(right.begin(), right.end());
    }
    const PathFile file =
        Read("<osm>" + nodes + Way(1, left) + Way(2, right) + Relation(7, 1, 2) + "</osm>", {"7"});
    ASSERT_EQ(file.points.points.size(), 4U) << reversed;
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_EQ(file.points.points[i], 0.5 * (inner[i] + outer[i])) << reversed;
    }
  }
}

// As in a public map: a lane turns around the narrow end of an island. The ends of the turn's
// bounds are nearly a rectangle, which fits both orientations of a bound. Only the lanelets before
// and after give the direction. The second island is so thin that the bounds of the turn cross.
TEST(Lanelet2, FollowsAUTurnAroundANarrowIsland) {
  const std::vector<Vec2> outer{{2.3, -3.1}, {5.4, -2.9}, {5.3, -0.9}, {5.0, 3.2}, {2.3, 3.1}};
  for (const std::vector<Vec2>& inner :
       {std::vector<Vec2>{{0.0, 0.0}, {0.6, 0.0}, {1.4, 0.0}, {2.0, 0.1}, {0.1, -0.02}},
        std::vector<Vec2>{{2.0, 0.0}, {2.5, 0.1}, {2.8, 0.15}, {2.9, 0.1}, {1.6, -0.1}}}) {
    std::string nodes =
        Node(21, -20.0, 0.0) + Node(22, -20.0, -3.0) + Node(23, -20.0, 0.1) + Node(24, -20.0, 3.1);
    for (int i = 0; i < 5; ++i) {
      const auto at = static_cast<std::size_t>(i);
      nodes += Node(1 + i, inner[at].x(), inner[at].y());
      nodes += Node(11 + i, outer[at].x(), outer[at].y());
    }
    for (unsigned reversed = 0; reversed < 4; ++reversed) {
      std::vector<int> left{1, 2, 3, 4, 5};
      std::vector<int> right{11, 12, 13, 14, 15};
      if ((reversed & 1U) != 0U) {
        std::reverse(left.begin(), left.end());
      }
      if ((reversed & 2U) != 0U) {
        std::reverse(right.begin(), right.end());
      }
      const std::string ways = Way(1, left) + Way(2, right) + Way(3, {21, 1}) + Way(4, {22, 11}) +
                               Way(5, {5, 23}) + Way(6, {15, 24});
      const PathFile file = Read("<osm>" + nodes + ways + Relation(7, 1, 2) + Relation(8, 3, 4) +
                                     Relation(9, 5, 6) + "</osm>",
                                 {"8", "7", "9"});
      EXPECT_THAT(file.points.points, Contains(Vec2(0.5 * (inner.back() + outer.back()))))
          << reversed;
      EXPECT_THAT(file.points.points, Contains(Vec2(0.5 * (inner[2] + outer[2])))) << reversed;
    }
  }
}

TEST(Lanelet2, DrivesBothWaysAlongALaneThatIsNotOneWay) {
  MapText text;
  EXPECT_THAT(WhyNot(text.Xml(), {"11", "10"}),
              HasSubstr("no lanelets that follow each other and no dashed lines lead from lanelet "
                        "11 to lanelet 10"));
  text.tags += Tag("one_way", "no");
  const PathFile file = Read(text.Xml(), {"11", "10"});
  ASSERT_EQ(file.points.points.size(), 3U);
  EXPECT_EQ(file.points.points.front(), Vec2(120.0, 0.0));
  EXPECT_EQ(file.points.points.back(), Vec2(0.0, 0.0));
}

TEST(Lanelet2, ChangesLanesAcrossDashedLinesOnly) {
  const auto ends_at = [](const std::string& line, unsigned reversed,
                          const std::vector<std::string>& ids) {
    MapText text{.reversed = reversed};
    text.line = line;
    try {
      return Read(text.Xml(), ids).points.points.back().y();
    } catch (const InputError&) {
      return -1.0;
    }
  };
  const std::vector<std::string> to_left{"10", "21"};
  const std::vector<std::string> to_right{"20", "11"};
  EXPECT_NEAR(ends_at(Tag("subtype", "dashed"), 0, to_left), 4.0, Tolerance(1e-9));
  EXPECT_NEAR(ends_at(Tag("subtype", "dashed"), 0, to_right), 0.0, Tolerance(1e-9));
  EXPECT_EQ(ends_at(Tag("subtype", "solid"), 0, to_left), -1.0);
  EXPECT_NEAR(ends_at(Tag("lane_change", "yes"), 0, to_left), 4.0, Tolerance(1e-9));
  EXPECT_EQ(ends_at(Tag("subtype", "dashed") + Tag("lane_change", "no"), 0, to_left), -1.0);
  // dashed_solid: from the left of the way, seen along the way, to its right. The ways between the
  // lanes are the bits 2 and 3.
  for (const auto& [subtype, reversed] :
       {std::pair("dashed_solid", 0U), std::pair("solid_dashed", 12U)}) {
    EXPECT_EQ(ends_at(Tag("subtype", subtype), reversed, to_left), -1.0) << subtype;
    EXPECT_NEAR(ends_at(Tag("subtype", subtype), reversed, to_right), 0.0, Tolerance(1e-9));
  }
}

TEST(Lanelet2, KeepsWithinItsLanesWhileItChanges) {
  const PathFile file = Read(MapText{}.Xml(), {"10", "21"});
  const auto& points = file.points.points;
  EXPECT_EQ(points.front(), Vec2(0.0, 0.0));
  EXPECT_EQ(points.back(), Vec2(120.0, 4.0));
  for (std::size_t i = 1; i < points.size(); ++i) {
    EXPECT_GT(points[i].x(), points[i - 1].x());
    EXPECT_GE(points[i].y(), points[i - 1].y() - 1e-9);
  }
}

// A straight of 60 m between the ends of bends with points 1 m apart: the spline keeps to it. The
// bends have the middles of the bounds as their points, on circles of 12 m around (0, 12) and
// (60, 12).
TEST(Lanelet2, KeepsToStraightsWithoutPoints) {
  std::string nodes;
  std::vector<int> left;
  std::vector<int> right;
  const auto add = [&](double x, double y, double angle) {
    const int id = 1000 + 2 * static_cast<int>(left.size());
    nodes += Node(id, x - 10.0 * std::sin(angle), y - 10.0 * std::cos(angle));
    nodes += Node(id + 1, x - 14.0 * std::sin(angle), y - 14.0 * std::cos(angle));
    left.push_back(id);
    right.push_back(id + 1);
  };
  for (int i = 18; i >= 0; --i) {
    add(0.0, 12.0, i / 12.0);
  }
  for (int i = 0; i <= 18; ++i) {
    add(60.0, 12.0, -i / 12.0);
  }
  const std::string xml = "<osm>" + nodes + Way(1, left) + Way(2, right) +
                          Relation(3, 1, 2, Tag("subtype", "road")) + "</osm>";
  const FittedPath fitted = FitPath(Read(xml, {"3"}).points, {});
  double farthest = 0.0;
  for (double s = 0.0; s <= fitted.path.length(); s += 0.1) {
    const Vec2 at = fitted.path.At(s).pose.position();
    const double beside = std::max({at.x() - 60.0, -at.x(), 0.0});
    farthest = std::max(farthest, beside > 0.0 ? std::abs(std::hypot(beside, at.y() - 12.0) - 12.0)
                                               : std::abs(at.y()));
  }
  // The spline is within 0.05 m of the points; it may swing as far again between them.
  EXPECT_LT(farthest, 0.1);
}

TEST(Lanelet2, DrawsItsLanes) {
  const PathFile read = Read(MapText().Xml(), {"10", "11"});
  ASSERT_EQ(read.lanes.size(), 4U);
  EXPECT_EQ(read.lanes[0].right, (std::vector<Vec2>{{0.0, -2.0}, {60.0, -2.0}}));
  EXPECT_EQ(read.lanes[3].left, (std::vector<Vec2>{{60.0, 6.0}, {120.0, 6.0}}));
}

TEST(Lanelet2, TakesSpeedLimits) {
  MapText text;
  text.tags += Tag("speed_limit", "36");
  text.rest = Node(300, 180, -2) + Node(301, 180, 2) + Way(300, {102, 300}) + Way(301, {112, 301}) +
              Relation(12, 301, 300, Tag("subtype", "road") + Tag("speed_limit", "5 m/s"));
  const PathFile file = Read(text.Xml(), {"10", "12"});
  ASSERT_EQ(file.points.points.size(), 4U);
  // Where the limit falls, the lower one applies from the joint on.
  EXPECT_THAT(file.points.speed, ::testing::ElementsAre(10.0, 10.0, 5.0, 5.0));
  EXPECT_THAT(file.notes, Contains(HasSubstr("speed limits of the lanelets")));
}

TEST(Lanelet2, ReadsUnitsOfSpeedLimits) {
  EXPECT_DOUBLE_EQ(*SpeedOfTag("90"), 25.0);
  EXPECT_DOUBLE_EQ(*SpeedOfTag("90 km/h"), 25.0);
  EXPECT_DOUBLE_EQ(*SpeedOfTag("90kmh"), 25.0);
  EXPECT_DOUBLE_EQ(*SpeedOfTag("10 mph"), 4.4704);
  EXPECT_DOUBLE_EQ(*SpeedOfTag("13.9 m/s"), 13.9);
  for (const char* text : {"", "none", "0", "-30", "1e9", "50 furlongs", "nan"}) {
    EXPECT_FALSE(SpeedOfTag(text)) << text;
  }
}

TEST(Lanelet2, ProjectsLatitudesAndLongitudes) {
  // A lane along the meridian of 10 degrees from the equator to 0.001 degrees north.
  const auto node = [](int id, double latitude, double longitude) {
    return fmt::format("<node id='{}' lat='{}' lon='{}'/>", id, latitude, longitude);
  };
  const std::string text = "<osm>" + node(1, 0, 9.99998) + node(2, 0.001, 9.99998) +
                           node(3, 0, 10.00002) + node(4, 0.001, 10.00002) + Way(1, {1, 2}) +
                           Way(2, {3, 4}) + Relation(7, 1, 2) + "</osm>";
  const PathFile file = Read(text, {"7"});
  ASSERT_EQ(file.points.points.size(), 2U);
  const double e2 = 0.00669437999014;  // WGS 84
  const double expected = 6378137.0 * (1.0 - e2) * 0.001 * std::numbers::pi / 180.0;
  // Terms of the latitude squared are below 1e-9 of the length; the lane is 2.2 m from the meridian
  // of the projection.
  EXPECT_NEAR((file.points.points[1] - file.points.points[0]).norm(), expected, Tolerance(1e-6));
  EXPECT_THAT(file.notes, Contains(HasSubstr("transverse Mercator")));
}

TEST(Lanelet2, SaysWhatIsMissing) {
  MapText text;
  text.rest = Relation(30, 200, 210, Tag("subtype", "crosswalk")) + Relation(31, 999, 210) +
              Way(302, {100, 555}) + Relation(32, 302, 210);
  const std::string xml = text.Xml();
  EXPECT_THAT(WhyNot(xml, {}), AllOf(HasSubstr("lanelets: missing; name the first and the last"),
                                     HasSubstr("4 lanelets are for cars, such as 10, 11, 20, 21")));
  EXPECT_THAT(WhyNot(xml, {"10", "99"}), HasSubstr("no lanelet 99 in the file"));
  EXPECT_THAT(WhyNot(xml, {"30"}), HasSubstr("lanelet 30 is a crosswalk, which is not for cars"));
  EXPECT_THAT(WhyNot(xml, {"31"}), HasSubstr("has the left way 999, which is not in the file"));
  EXPECT_THAT(WhyNot(xml, {"32"}), HasSubstr("whose node 555 is not in the file"));
  EXPECT_THAT(WhyNot("<osm/>", {"10"}), HasSubstr("no lanelet for cars in the file"));
  EXPECT_THAT(WhyNot("<map/>", {"10"}), HasSubstr("the root element must be osm"));
  EXPECT_THAT(WhyNot("<osm>", {"10"}), HasSubstr("not XML"));
  EXPECT_THAT(WhyNot(MapText{.rest = Relation(10, 210, 200)}.Xml(), {"10"}),
              HasSubstr("two lanelets have the id 10"));
  std::string bad = xml;
  bad.replace(bad.find("v='60'"), 6, "v='1e9'");
  EXPECT_THAT(WhyNot(bad, {"10"}), HasSubstr("'1e9' is not a number between"));
}

}  // namespace lanelet2_test
}  // namespace trackbed
