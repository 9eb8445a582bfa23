#include "trackbed/path_files/path_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/algorithm/string/predicate.hpp>
#include <cmath>
#include <filesystem>
#include <string>

#include "src/path_files/formats.h"
#include "tests/support/error_text.h"
#include "tests/support/temp_folder.h"
#include "tests/tolerance.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"

// Tests the readers of path files (CSV, nav_msgs/Path, CommonRoad, GeoJSON): units, columns, error
// messages with line numbers, limits, and files of arbitrary bytes.
namespace trackbed {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

PathPoints Read(const std::string& name, const std::string& text, const PathMap& map = {}) {
  const TempFolder folder;
  return ReadPathFile(folder.Write(name, text), map).points;
}

std::string Error(const std::string& name, const std::string& text, const PathMap& map = {}) {
  return ErrorText([&] { Read(name, text, map); });
}

/// Returns the only problem with the speeds in a CSV file whose path is valid, as "line: key:
/// message".
std::string SpeedProblem(const std::string& csv) {
  const TempFolder folder;
  const PathFile found = ReadPathFile(folder.Write("p.csv", csv));
  EXPECT_TRUE(found.points.speed.empty());
  if (found.speed_problems.size() != 1) {
    return fmt::format("{} problems", found.speed_problems.size());
  }
  const Problem& problem = found.speed_problems.front();
  return fmt::format("{}: {}: {}", problem.line, problem.key, problem.message);
}

PathMap Of(PathFormat format) {
  PathMap map;
  map.format = format;
  return map;
}

// --- CSV -----------------------------------------------------------------------------------------

TEST(PathCsv, FindsUsualColumns) {
  for (const std::string header : {"x_m,y_m,yaw_rad,speed_mps", "X,Y,theta,v",
                                   "pos_x,pos_y,heading,velocity", "x [m],y [m],psi,vx_mps"}) {
    SCOPED_TRACE(header);
    const PathPoints points = Read("p.csv", header + "\n1,2,0.1,3\n4,5,0.2,6\n");
    ASSERT_EQ(points.points.size(), 2U);
    EXPECT_EQ(points.points[1], Vec2(4.0, 5.0));
    EXPECT_EQ(points.yaw, (std::vector<double>{0.1, 0.2}));
    EXPECT_EQ(points.speed, (std::vector<double>{3.0, 6.0}));
    EXPECT_TRUE(points.curvature.empty());
  }
}

// Lines of three dimensions have psi for the heading, theta for the slope and phi for the bank.
TEST(PathCsv, TakesPsiBesideTheta) {
  for (const std::string header : {"x_m,y_m,theta_rad,psi_rad", "x,y,theta,psi"}) {
    EXPECT_EQ(Read("p.csv", header + "\n1,2,0.4,0.1\n4,2.3,0.5,0.1\n").yaw,
              (std::vector<double>{0.1, 0.1}));
  }
}

TEST(PathCsv, NamesXmlAndWebPages) {
  EXPECT_THAT(Error("t.tcx", "<?xml version=\"1.0\"?>\n<!-- a > b -->\n<TrainingCenterDatabase>"),
              HasSubstr("gpsbabel -i gtrnctr"));
  EXPECT_THAT(Error("p.txt", "\xEF\xBB\xBF <gpx version=\"1.1\"><trk/></gpx>"),
              HasSubstr("p.txt:1: XML with the root element gpx instead of a table; GPX, KML"));
  EXPECT_THAT(Error("p.csv", "<!DOCTYPE html>\n<HTML lang=\"en\"></HTML>"),
              HasSubstr("a web page instead of a table"));
}

TEST(PathCsv, TakesUnitsOfNamesAndOfTheMap) {
  const PathPoints own = Read("p.csv", "x_cm,y_mm,yaw_deg,speed_kmh\n100,2000,90,36\n0,0,0,0\n");
  EXPECT_NEAR(own.points[0].x(), 1.0, Tolerance(1e-15));
  EXPECT_NEAR(own.points[0].y(), 2.0, Tolerance(1e-15));
  EXPECT_NEAR(own.yaw[0], 0.5 * kPi, Tolerance(1e-15));
  EXPECT_NEAR(own.speed[0], 10.0, Tolerance(1e-14));
  PathMap map;
  map.columns.x = "east";
  map.columns.y = "north";
  map.columns.yaw = "course";
  map.columns.position_unit = "km";
  map.columns.yaw_unit = "deg";
  const PathPoints named = Read("p.csv", "course,east,north\n180,1,2\n0,3,4\n", map);
  EXPECT_EQ(named.points[1], Vec2(3000.0, 4000.0));
  EXPECT_NEAR(named.yaw[0], kPi, Tolerance(1e-15));
}

TEST(PathCsv, ReadsRacingLinesOfTum) {
  const std::string text =
      "# 4a7c2f\n# another comment, with a comma\n"
      "# s_m; x_m; y_m; psi_rad; kappa_radpm; vx_mps; ax_mps2\n"
      "0.0; 1.0; 2.0; 0.0; 0.01; 20.0; 1.0\n5.0; 1.0; 7.0; 0.0; 0.02; 21.0; 1.0\n";
  const TempFolder folder;
  const PathFile file = ReadPathFile(folder.Write("line.csv", text));
  EXPECT_EQ(file.points.points[1], Vec2(1.0, 7.0));
  EXPECT_EQ(file.points.curvature, (std::vector<double>{0.01, 0.02}));
  EXPECT_EQ(file.points.speed, (std::vector<double>{20.0, 21.0}));
  // The file gives headings from north, and the path points north.
  EXPECT_NEAR(file.points.yaw[0], 0.5 * kPi, Tolerance(1e-15));
  EXPECT_THAT(file.notes.back(), HasSubstr("from north"));
  EXPECT_EQ(Read("track.csv", "# x_m,y_m,w_tr_right_m,w_tr_left_m\n0,0,5,5\n5,0,5,5\n").points[1],
            Vec2(5.0, 0.0));
}

TEST(PathCsv, MakesSpeedsOfTimes) {
  const PathPoints points = Read("p.csv", "t_s,x,y\n10,0,0\n11,3,0\n13,3,8\n");
  EXPECT_EQ(points.speed, (std::vector<double>{3.0, 4.0, 4.0}));
  EXPECT_THAT(SpeedProblem("t_s,x,y\n1,0,0\n1,3,0\n"), HasSubstr("must be above"));
  EXPECT_THAT(SpeedProblem("t_s,x,y\n1,0,0\n1.001,3,0\n"), HasSubstr("at most 100 m/s"));
}

TEST(PathCsv, WritesWhatItReads) {
  PathPoints points;
  points.points = {{0.1, -2.0 / 3.0}, {1e6, 3.0}};
  points.yaw = {0.3, 2.0};
  points.speed = {1.0, 0.0};
  const PathPoints again = Read(kPathCsv, PathCsv(points));
  EXPECT_EQ(again.points, points.points);
  EXPECT_EQ(again.yaw, points.yaw);
  EXPECT_EQ(again.speed, points.speed);
  EXPECT_TRUE(again.curvature.empty());
}

TEST(PathCsv, FindsColumnsBesideWordsForAPose) {
  for (const std::string header :
       {"pose_x,pose_y,pose_theta", "time.x,odom.pose.position.x,odom.pose.position.y",
        "wp_x [m];wp_y [m];wp_yaw", "positionX\tpositionY\tname", "X (m),Y (m),Yaw(deg)",
        "field.pose.pose.position.x,field.pose.pose.position.y,field.v", "x_pos,y_pos,v",
        "xPos,yPos,name", "px,py,v", "East,North,v", "center_x,center_y,v", "x_world,y_world,v"}) {
    SCOPED_TRACE(header);
    const bool has_time = boost::starts_with(header, "time");
    const std::string separator = header.find(';') != std::string::npos    ? ";"
                                  : header.find('\t') != std::string::npos ? "\t"
                                                                           : ",";
    std::string text = header + "\n";
    for (const std::vector<const char*>& row :
         {std::vector{"1", "2", "0.5"}, std::vector{"4", "5", "0.6"}}) {
      text += has_time ? fmt::format("9,{},{}\n", row[0], row[1])
                       : fmt::format("{}\n", fmt::join(row, separator));
    }
    const PathPoints points = Read("p.csv", text);
    ASSERT_EQ(points.points.size(), 2U);
    EXPECT_EQ(points.points[1], Vec2(4.0, 5.0));
  }
  const PathPoints turned = Read("p.csv", "pose_x,pose_y,pose_theta\n1,2,0.5\n4,5,0.6\n");
  EXPECT_EQ(turned.yaw, (std::vector<double>{0.5, 0.6}));
  EXPECT_EQ(Read("p.csv", "utm_x_cm,utm_y_cm\n100,200\n400,500\n").points[1], Vec2(4.0, 5.0));
}

// Columns of another pose, of a direction or of a velocity are no positions.
TEST(PathCsv, TakesNoOtherColumnsForAPose) {
  EXPECT_THAT(Error("p.csv", "map_x,map_y,odom_x,odom_y\n1,2,3,4\n5,6,7,8\n"),
              AllOf(HasSubstr("several columns for x: map_x, odom_x"), HasSubstr("columns.x")));
  for (const char* header :
       {"goal_x,goal_y", "velocity_x,velocity_y", "orientation_x,orientation_y", "pose_x,goal_y",
        "x_pos,y_goal", "px,velocity_y", "linear_acceleration.x,linear_acceleration.y"}) {
    EXPECT_THAT(Error("p.csv", std::string(header) + "\n1,2\n3,4\n"), HasSubstr("no column for x"))
        << header;
  }
  PathMap map;
  map.columns.x = "odom_x";
  map.columns.y = "odom_y";
  EXPECT_EQ(Read("p.csv", "map_x,map_y,odom_x,odom_y\n1,2,3,4\n5,6,7,8\n", map).points[0],
            Vec2(3.0, 4.0));
}

TEST(PathCsv, TakesColumnsWithoutNamesByTheirNumbers) {
  EXPECT_EQ(Read("p.csv", "1,2\n3,4\n").points[1], Vec2(3.0, 4.0));
  EXPECT_EQ(Read("p.txt", "1.5  2\n 3   4\n").points[1], Vec2(3.0, 4.0));
  EXPECT_THAT(Error("p.csv", "0,1,2\n9,3,4\n"),
              AllOf(HasSubstr("p.csv:1: no column names"), HasSubstr("columns.x = 1"),
                    HasSubstr("1: 0, 2: 1, 3: 2")));
  PathMap map;
  map.columns.x = "2";
  map.columns.y = "3";
  map.columns.speed = "1";
  const PathPoints points = Read("p.csv", "0,1,2\n9,3,4\n", map);
  EXPECT_EQ(points.points[1], Vec2(3.0, 4.0));
  EXPECT_EQ(points.speed, (std::vector<double>{0.0, 9.0}));
  map.columns.x = "7";
  EXPECT_THAT(Error("p.csv", "0,1,2\n9,3,4\n", map), HasSubstr("no such column"));
}

TEST(PathCsv, SaysWhatIsWrong) {
  EXPECT_THAT(Error("p.csv", "a,b\n1,2\n3,4\n"),
              AllOf(HasSubstr("p.csv:1"), HasSubstr("no column for x"), HasSubstr("columns.x"),
                    HasSubstr("a, b")));
  PathMap misspelt;
  misspelt.columns.x = "estaing";
  EXPECT_THAT(Error("p.csv", "easting,northing\n1,2\n3,4\n", misspelt),
              HasSubstr("did you mean 'easting'"));
  EXPECT_THAT(Error("p.csv", "x,y\n1,2\n3,four\n"),
              AllOf(HasSubstr("p.csv:3"), HasSubstr("'four' is not a finite number")));
  EXPECT_THAT(Error("p.csv", "x,y\n1,2\n3,nan\n"), HasSubstr("not a finite number"));
  EXPECT_THAT(Error("p.csv", "x,y\n1,2\n3,inf\n"), HasSubstr("not a finite number"));
  EXPECT_THAT(Error("p.csv", "x,y\n1,2\n3,1e300\n"), HasSubstr("out of range"));
  EXPECT_THAT(SpeedProblem("x,y,v\n1,2,-101\n3,4,1\n"), HasSubstr("out of range"));
  EXPECT_THAT(Error("p.csv", "x,y\n1,2\n3\n"), HasSubstr("1 cells, the header has 2"));
  EXPECT_THAT(Error("p.csv", "x,y\n1,2\n"), HasSubstr("1 point; a path has at least 2"));
  EXPECT_THAT(Error("p.csv", "x,x,y\n1,2,3\n"), HasSubstr("repeated column"));
  EXPECT_THAT(Error("p.csv", ""), HasSubstr("empty file"));
  EXPECT_THAT(Error("p.csv", "# x,y\n"), HasSubstr("no rows"));
  PathMap unit;
  unit.columns.yaw_unit = "grad";
  EXPECT_THAT(Error("p.csv", "x,y\n1,2\n3,4\n", unit), HasSubstr("unknown unit 'grad'"));
}

TEST(PathCsv, ReadsThePathBesideInvalidSpeeds) {
  std::string rows;
  for (int i = 0; i < 100; ++i) {
    rows += fmt::format("{},0,-300\n", i);
  }
  EXPECT_EQ(SpeedProblem("x,y,v\n" + rows),
            "2: v: -300 is out of range; must be between -100 and 100 in SI units, and 99 more "
            "invalid cells in this column");
  const TempFolder folder;
  const PathFile found =
      ReadPathFile(folder.Write("p.csv", "x,y,kappa,t\n0,0,none,0\n1,0,0,1\n2,0,nan,2\n"));
  EXPECT_EQ(found.points.speed, (std::vector<double>{1.0, 1.0, 1.0}));
  EXPECT_TRUE(found.points.curvature.empty());
  EXPECT_THAT(found.notes, ::testing::Contains(HasSubstr("column kappa is ignored: line 2")));
}

// The recorded car stands at some points: without a column of speeds, its speed there is 0.
TEST(PathCsv, KeepsTheTimesOfACarThatStands) {
  const PathPoints waits =
      Read("p.csv", "t,x,y,v\n10,0,0,3\n11,3,0,0\n12,3,0,0\n14,3,0,0\n15,6,0,3\n");
  EXPECT_EQ(waits.speed, (std::vector<double>{3.0, 0.0, 0.0, 0.0, 3.0}));
  EXPECT_EQ(waits.time, (std::vector<double>{0.0, 1.0, 2.0, 4.0, 5.0}));
  const PathPoints ends = Read("p.csv", "t,x,y\n0,0,0\n2,0,0\n3,3,0\n4,6,0\n9,6,0\n");
  EXPECT_EQ(ends.speed, (std::vector<double>{0.0, 3.0, 3.0, 0.0, 0.0}));
  EXPECT_EQ(ends.time, (std::vector<double>{0.0, 2.0, 3.0, 4.0, 9.0}));
  EXPECT_EQ(Read("p.csv", "x,y,v\n0,0,1\n3,0,1\n").time, std::vector<double>());
  // The times are kept in the run folder.
  const PathPoints again = Read("path.csv", PathCsv(waits));
  EXPECT_EQ(again.time, waits.time);
  EXPECT_EQ(again.speed, waits.speed);
  EXPECT_THAT(SpeedProblem("t,x,y,v\n0,0,0,3\n1,3,0,3\n0.5,4,0,3\n"),
              HasSubstr("4: time: 0.5 s of point 3 must be above the previous point's 1 s"));
}

// A clock of whole seconds repeats the times of a car at 3 m/s, recorded at unequal distances: the
// times that are exact in binary come back as 1/3 s per meter.
TEST(PathCsv, SeparatesTimesOfACoarseClock) {
  const std::string rows = "0,0,0\n0,0.75,0\n0,2.25,0\n1,3,0\n1,4.5,0\n2,6,0\n2,6,0\n2,7.5,0\n";
  const PathPoints found = Read("p.csv", "t,x,y\n" + rows);
  ASSERT_EQ(found.points.size(), 8U);
  for (std::size_t i = 0; i < found.points.size(); ++i) {
    // One rounding per sum of the times of a second.
    EXPECT_NEAR(found.time[i], found.points[i].x() / 3.0, 1e-15 * 8.0) << i;
    EXPECT_NEAR(found.speed[i], 3.0, 1e-15 * 8.0) << i;
  }
  EXPECT_THAT(SpeedProblem("t,x,y\n1,0,0\n1,3,0\n1,4,0\n"),
              HasSubstr("3: time: 1 s of point 2 must be above the previous point's 1 s"));
}

/// A nav_msgs/Path of poses 1 m apart with the given stamps.
std::string StampedPath(const std::vector<std::string>& stamps) {
  std::string text = "poses:\n";
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    text += fmt::format("- header: {}\n  pose: {{position: {{x: {}, y: 0}}}}\n", stamps[i], i);
  }
  return text;
}

TEST(NavPath, HasTheTimesOfItsStamps) {
  const PathPoints stamped =
      Read("p.yaml", StampedPath({"{stamp: {sec: 1700000000, nanosec: 500000000}}",
                                  "{stamp: {sec: 1700000001, nanosec: 0}}",
                                  "{stamp: {sec: 1700000003, nanosec: 0}}"}));
  EXPECT_EQ(stamped.time, (std::vector<double>{0.0, 0.5, 2.5}));
  EXPECT_EQ(stamped.speed, (std::vector<double>{2.0, 0.5, 0.5}));
  const PathPoints ros1 =
      Read("p.yaml", StampedPath({"{stamp: {secs: 1, nsecs: 0}}", "{stamp: {secs: 2, nsecs: 0}}"}));
  EXPECT_EQ(ros1.time, (std::vector<double>{0.0, 1.0}));
  // Planners that do not set the stamps write equal ones, or none.
  for (const std::string header :
       {"{stamp: {sec: 0, nanosec: 0}}", "{frame_id: map}", "{stamp: soon}", "3"}) {
    const PathPoints bare = Read("p.yaml", StampedPath({header, header, header}));
    EXPECT_TRUE(bare.time.empty()) << header;
    EXPECT_TRUE(bare.speed.empty()) << header;
  }
}

// A solution does not contain the duration of a time step: here 0.04 s, at 5 m/s 0.2 m.
TEST(CommonRoad, FindsTheDurationOfItsTimeSteps) {
  std::string text = "<CommonRoadSolution><ksTrajectory>";
  const double x[] = {0.0, 0.2, 0.4, 0.5, 0.5, 0.6, 0.8};
  const double v[] = {5.0, 5.0, 5.0, 0.0, 0.0, 5.0, 5.0};
  const int step[] = {0, 1, 2, 3, 103, 104, 105};
  for (int i = 0; i < 7; ++i) {
    text +=
        fmt::format("<ksState><x>{}</x><y>0</y><velocity>{}</velocity><time>{}</time></ksState>",
                    x[i], v[i], step[i]);
  }
  const PathPoints found = Read("s.xml", text + "</ksTrajectory></CommonRoadSolution>");
  ASSERT_EQ(found.time.size(), 7U);
  for (std::size_t i = 0; i < 7; ++i) {
    EXPECT_NEAR(found.time[i], 0.04 * step[i], Tolerance(1e-12)) << i;
  }
}

/// Returns the text of a CSV file with an arc of radius 40 m. The function `number` converts the
/// heading to the file's unit and direction.
std::string ArcWithHeadings(double (*number)(double yaw)) {
  std::string text = "x,y,yaw\n";
  for (int i = 0; i < 60; ++i) {
    const double yaw = 0.7 + 0.03 * i;
    text += fmt::format("{},{},{}\n", 40.0 * std::sin(yaw), -40.0 * std::cos(yaw), number(yaw));
  }
  return text;
}

TEST(PathCsv, RecognizesHeadingsInOtherUnits) {
  EXPECT_EQ(Error("p.csv", ArcWithHeadings([](double yaw) { return yaw; })), "");
  EXPECT_EQ(Error("p.csv", ArcWithHeadings([](double yaw) { return yaw + kPi; })), "");
  const std::string degrees = ArcWithHeadings([](double yaw) { return yaw * 180.0 / kPi; });
  EXPECT_THAT(Error("p.csv", degrees), HasSubstr("degrees; set columns.yaw_unit: deg"));
  PathMap map;
  map.columns.yaw_unit = "deg";
  EXPECT_EQ(Error("p.csv", degrees, map), "");
  // The name of the column may be wrong, too.
  for (const char* name : {"x_m,y_m,yaw_rad", "x_m,y_m,psi_rad", "x,y,heading_rad"}) {
    const std::string named = name + degrees.substr(degrees.find('\n'));
    EXPECT_THAT(Error("p.csv", named), HasSubstr("degrees; set columns.yaw_unit: deg")) << name;
    EXPECT_EQ(Error("p.csv", named, map), "") << name;
  }
  EXPECT_THAT(Error("p.csv", ArcWithHeadings([](double yaw) { return 90.0 - yaw * 180.0 / kPi; })),
              HasSubstr("degrees, clockwise from north; convert them"));
  EXPECT_THAT(Error("p.csv", ArcWithHeadings([](double yaw) { return 0.5 * kPi - yaw; })),
              HasSubstr("radians, clockwise from north; convert them"));
}

// --- Directions of motion ------------------------------------------------------------------------

constexpr const char* kBackAndForth = "0,0,{}\n2,0,{}\n1,0,{}\n3,0,{}\n";

/// Reads four points with a column `name` of the given cells, and returns the directions of the
/// points.
std::vector<int> Directions(const std::string& column, const std::vector<std::string>& cells) {
  return Read("p.csv",
              "x,y," + column + "\n" +
                  fmt::format(fmt::runtime(kBackAndForth), cells[0], cells[1], cells[2], cells[3]))
      .direction;
}

TEST(PathDirections, AreReadFromColumns) {
  const std::vector<int> expected{1, 1, -1, 1};
  EXPECT_EQ(Directions("direction", {"1", "1", "-1", "1"}), expected);
  EXPECT_EQ(Directions("Direction", {"1.0", "1.0", "0.0", "1.0"}), expected);
  EXPECT_EQ(Directions("direction", {"True", "True", "False", "True"}), expected);
  EXPECT_EQ(Directions("gear", {"D", "D", "R", "D"}), expected);
  EXPECT_EQ(Directions("gear", {"1", "2", "-1", "1"}), expected);
  EXPECT_EQ(Directions("gear", {"GEAR_DRIVE", "GEAR_DRIVE", "GEAR_REVERSE", "GEAR_DRIVE"}),
            expected);
  EXPECT_EQ(Directions("dir", {"forward", "Forwards", "reverse", " f "}), expected);
  EXPECT_EQ(Directions("reverse", {"0", "0", "1", "0"}), expected);
  EXPECT_EQ(Directions("is_reverse", {"false", "false", "true", "false"}), expected);
  EXPECT_EQ(Directions("forward", {"1", "1", "0", "1"}), expected);
  EXPECT_EQ(Directions("gear", {"D", "N", "R", "P"}), (std::vector<int>{1, 0, -1, 0}));
  EXPECT_EQ(Directions("direction", {"1", "0", "-1", "0"}), (std::vector<int>{1, 0, -1, 0}));
  // A gear of 0 is neutral. If the car never reverses, all points count as forward.
  EXPECT_EQ(Directions("gear", {"0", "1", "2", "0"}), (std::vector<int>{1, 1, 1, 1}));
  PathMap map;
  map.columns.direction = "way";
  EXPECT_EQ(Read("p.csv", "way,x,y\nR,0,0\nR,1,0\n", map).direction, (std::vector<int>{-1, -1}));
}

TEST(PathDirections, IgnoreColumnsOfOtherMeaning) {
  const TempFolder folder;
  const PathFile found = ReadPathFile(folder.Write("p.csv", "x,y,direction\n0,0,45.3\n1,1,45.1\n"));
  EXPECT_TRUE(found.points.direction.empty());
  EXPECT_THAT(found.notes, ::testing::Contains(HasSubstr(
                               "column direction is ignored: line 2: '45.3' is no direction")));
  PathMap map;
  map.columns.direction = "direction";
  EXPECT_THAT(Error("p.csv", "x,y,direction\n0,0,45.3\n1,1,45.1\n", map),
              AllOf(HasSubstr("p.csv:2: direction: '45.3' is no direction of motion"),
                    HasSubstr("D or R")));
}

TEST(PathDirections, AreTheSignsOfSpeeds) {
  const PathPoints points = Read("p.csv", "x,y,v\n0,0,2\n2,0,0.01\n1,0,-1\n0.5,0,-0.02\n3,0,1.5\n");
  EXPECT_EQ(points.direction, (std::vector<int>{1, 0, -1, 0, 1}));
  EXPECT_EQ(points.speed, (std::vector<double>{2.0, 0.01, 1.0, 0.02, 1.5}));
  // Noise of a standing car does not make a reverse piece.
  EXPECT_TRUE(Read("p.csv", "x,y,v\n0,0,-0.01\n2,0,1\n").direction.empty());
  // If a file has a column of directions, the signs of the speeds are ignored.
  EXPECT_EQ(Read("p.csv", "x,y,v,gear\n0,0,-1,D\n2,0,-1,N\n1,0,1,R\n").direction,
            (std::vector<int>{1, -1, -1}));
}

TEST(PathDirections, ContradictHeadingsOfHalfATurn) {
  const std::string rows = "0,0,3.14,{0}\n1,0,3.14,{0}\n2,0,3.13,{0}\n";
  const auto error = [&](double speed) {
    return Error("p.csv", "x,y,yaw,v\n" + fmt::format(fmt::runtime(rows), speed));
  };
  EXPECT_THAT(error(1.0), AllOf(HasSubstr("yaw: the headings are opposite to the direction of "
                                          "travel all along the path, but no speed is negative"),
                                HasSubstr("half a turn")));
  EXPECT_EQ(error(-1.0), "");
}

TEST(PathDirections, AreWrittenAndReadAgain) {
  PathPoints points;
  points.points = {{0.0, 0.0}, {2.0, 0.25}, {1.0, 0.125}};
  points.speed = {1.0, 0.0, 0.5};
  for (const std::vector<int>& direction :
       {std::vector<int>{1, 0, -1}, {-1, -1, -1}, {1, 1, 1}, {0, -1, -1}}) {
    points.direction = direction;
    const PathPoints again = Read(kPathCsv, PathCsv(points));
    EXPECT_EQ(again.direction, points.direction);
    EXPECT_EQ(again.speed, points.speed);
  }
}

TEST(PathDirections, DoNotHideDegrees) {
  std::string degrees = "x,y,yaw,gear\n";
  std::string radians = "x,y,yaw,gear\n";
  for (int i = 0; i <= 80; ++i) {
    const bool is_reverse = i > 40;
    const double x = is_reverse ? 40.0 - (i - 40) : i;
    const double yaw = 0.7 + 0.02 * x;
    const Vec2 at(50.0 * std::sin(yaw), -50.0 * std::cos(yaw));
    const std::string gear = is_reverse ? "R" : "D";
    degrees += fmt::format("{},{},{},{}\n", at.x(), at.y(), yaw * 180.0 / kPi, gear);
    radians += fmt::format("{},{},{},{}\n", at.x(), at.y(), yaw, gear);
  }
  EXPECT_THAT(Error("p.csv", degrees), HasSubstr("degrees; set columns.yaw_unit: deg"));
  EXPECT_EQ(Error("p.csv", radians), "");
}

TEST(CommonRoad, HasSignedVelocities) {
  const auto state = [](double x, double velocity) {
    return fmt::format(
        "<ksState><x>{}</x><y>0</y><velocity>{}</velocity><orientation>0</orientation></ksState>",
        x, velocity);
  };
  const auto read = [&](double last) {
    return Read("s.xml", "<CommonRoadSolution><ksTrajectory>" + state(0.0, 2.0) + state(2.0, 0.0) +
                             state(1.0, last) + "</ksTrajectory></CommonRoadSolution>");
  };
  EXPECT_EQ(read(-1.0).direction, (std::vector<int>{1, 0, -1}));
  EXPECT_EQ(read(-1.0).speed, (std::vector<double>{2.0, 0.0, 1.0}));
  EXPECT_EQ(read(1.0).direction, (std::vector<int>{1, 1, 1}));
}

// --- Headings ------------------------------------------------------------------------------------

/// A racing line around an ellipse, with headings that are measured from the x axis plus `offset`.
std::string RacingLine(double offset, const std::string& name = "psi_rad") {
  std::string text = "# s_m; x_m; y_m; " + name + "; kappa_radpm; vx_mps; ax_mps2\n";
  for (int i = 0; i < 90; ++i) {
    const double t = 2.0 * kPi * i / 90.0;
    const double yaw = std::atan2(20.0 * std::cos(t), -40.0 * std::sin(t));
    text += fmt::format("{};{};{};{};0.01;8;0\n", i, 40.0 * std::cos(t), 20.0 * std::sin(t),
                        yaw + offset);
  }
  return text;
}

// The racing lines of TUM measure headings from north, those of F1TENTH from the x axis.
TEST(PathCsv, DecidesFromTheTangentsWhereHeadingsAreMeasuredFrom) {
  const TempFolder folder;
  for (const std::string name : {"psi_rad", "yaw"}) {
    const PathFile from_x = ReadPathFile(folder.Write("x.csv", RacingLine(0.0, name)));
    const PathFile from_north =
        ReadPathFile(folder.Write("north.csv", RacingLine(-0.5 * kPi, name)));
    for (std::size_t i = 0; i < from_x.points.yaw.size(); ++i) {
      // The angle of the tangent to the ellipse must equal the headings of the file, up to rounding
      // in sums of angles below 8 rad.
      EXPECT_NEAR(from_x.points.yaw[i], from_north.points.yaw[i], Tolerance(4e-15));
    }
    EXPECT_NEAR(from_x.points.yaw[0], 0.5 * kPi, Tolerance(1e-15));
    EXPECT_THAT(from_north.notes.back(), HasSubstr(name + " is taken from north"));
  }
  EXPECT_THAT(ReadPathFile(folder.Write("x.csv", RacingLine(0.0))).notes.back(),
              HasSubstr("psi_rad is taken from the x axis"));
  // The heading of a car in reverse is opposite to the direction of travel, but then its speeds are
  // negative.
  EXPECT_THAT(Error("reverse.csv", RacingLine(kPi)), HasSubstr("no speed is negative"));
  EXPECT_THAT(Error("p.csv", RacingLine(0.25 * kPi)),
              AllOf(HasSubstr("psi_rad"), HasSubstr("do not fit the path"),
                    HasSubstr("0.785 rad if they are measured from north")));
}

// A straight line at 45 degrees has the same heading from the x axis and clockwise from north.
TEST(PathCsv, TakesHeadingsOfAStraightLineFromTheXAxis) {
  EXPECT_NEAR(Read("p.csv", "x,y,yaw\n0,0,0.7\n1,1,0.8\n2,2,0.7\n").yaw[1], 0.8, Tolerance(1e-15));
  EXPECT_THAT(Error("p.csv", "x,y,yaw\n0,0,45\n1,1,45\n2,2,45\n"), HasSubstr("degrees"));
}

TEST(PathCsv, IsBoundedInPoints) {
  std::string text = "x,y\n";
  for (std::size_t i = 0; i <= kMaxPathPoints; ++i) {
    text += i % 2 == 0 ? "0,0\n" : "1,0\n";
  }
  EXPECT_THAT(Error("p.csv", text), HasSubstr("more than 1000000 points"));
  text.resize(text.size() - 4);
  EXPECT_EQ(Read("p.csv", text).points.size(), kMaxPathPoints);
}

// --- nav_msgs/Path -------------------------------------------------------------------------------

std::string Pose(double x, double y, double yaw) {
  return fmt::format(
      R"({{"header": {{"frame_id": "map"}}, "pose": {{"position": {{"x": {}, "y": {}, "z": 0.0}}, )"
      R"("orientation": {{"x": 0.0, "y": 0.0, "z": {}, "w": {}}}}}}})",
      x, y, std::sin(0.5 * yaw), std::cos(0.5 * yaw));
}

TEST(NavPath, IsReadAsJsonAndYaml) {
  const std::string json = fmt::format(R"({{"header": {{"frame_id": "map"}}, "poses": [{}, {}]}})",
                                       Pose(1.0, 2.0, 0.5), Pose(3.0, 4.0, -2.0));
  // JSON is valid YAML; ros2 topic echo writes block style and ends a message with "---".
  const std::string yaml =
      "header:\n  stamp: {sec: 12, nanosec: 5}\n  frame_id: map\nposes:\n"
      "- header: {frame_id: map}\n  pose:\n    position: {x: 1.0, y: 2.0, z: 0.0}\n"
      "    orientation: {x: 0.0, y: 0.0, z: 0.24740395925452294, w: 0.9689124217106447}\n"
      "- pose:\n    position:\n      x: 3.0\n      y: 4.0\n"
      "    orientation: {x: 0.0, y: 0.0, z: -0.8414709848078965, w: 0.5403023058681398}\n---\n";
  for (const auto& [name, text] : {std::pair(std::string("p.json"), json),
                                   {"p.yaml", json},
                                   {"p.yaml", yaml},
                                   {"p.yml", yaml}}) {
    SCOPED_TRACE(name);
    const PathPoints points = Read(name, text);
    ASSERT_EQ(points.points.size(), 2U);
    EXPECT_EQ(points.points[1], Vec2(3.0, 4.0));
    EXPECT_NEAR(points.yaw[0], 0.5, Tolerance(1e-12));
    EXPECT_NEAR(points.yaw[1], -2.0, Tolerance(1e-12));
  }
}

TEST(NavPath, IgnoresOrientationsThatWereNotSet) {
  const TempFolder folder;
  const PathFile file = ReadPathFile(folder.Write(
      "p.json", fmt::format(R"({{"poses": [{}, {}]}})", Pose(0.0, 0.0, 0.0), Pose(0.0, 5.0, 0.0))));
  EXPECT_TRUE(file.points.yaw.empty());
  EXPECT_THAT(file.notes, ::testing::Contains(HasSubstr("not set")));
}

TEST(NavPath, SaysWhatIsWrong) {
  EXPECT_THAT(Error("p.json", R"({"poses": [{"pose": {"position": {"x": 1}}}]})"),
              AllOf(HasSubstr("poses[0].pose.position"), HasSubstr("no member y")));
  EXPECT_THAT(Error("p.json", R"({"poses": [{"pose": {"position": {"x": "1", "y": 2}}}]})"),
              HasSubstr("poses[0].pose.position.x"));
  EXPECT_THAT(Error("p.json", R"({"poses": 7})"), HasSubstr("list of poses"));
  EXPECT_THAT(Error("p.json", R"({"points": []})"), HasSubstr("no member poses"));
  EXPECT_THAT(Error("p.json", "[1, 2]"), HasSubstr("no member poses"));
  EXPECT_THAT(Error("p.json", R"({"poses": []})"), HasSubstr("0 points"));
  EXPECT_THAT(Error("p.json", "{\n\"poses\": [1,,2]}"),
              AllOf(HasSubstr("p.json:2"), HasSubstr("not JSON")));
  EXPECT_THAT(Error("p.json", R"({"poses": [{"pose": {"position": {"x": 1e999, "y": 2}}}]})"),
              HasSubstr("p.json"));
  EXPECT_THAT(Error("p.yaml", "poses: [a: b: c]\n"), HasSubstr("not YAML"));
  EXPECT_THAT(Error("p.yaml", "poses: [{pose: {position: {x: .nan, y: 1}}}]\n"),
              HasSubstr("not a finite number"));
}

TEST(NavPath, RefusesDeepAndEndlessText) {
  const std::string deep = std::string(100000, '[') + std::string(100000, ']');
  EXPECT_THAT(Error("p.json", deep), HasSubstr("nested deeper than 64 levels"));
  EXPECT_THAT(Error("p.json", "{\"poses\": " + deep + "}"), HasSubstr("nested deeper"));
  EXPECT_NE(Error("p.yaml", deep), "");
  EXPECT_THAT(Error("p.yaml", "poses: " + std::string(80, '[') + std::string(80, ']')),
              HasSubstr("nested deeper than 64 levels"));
  EXPECT_THAT(Error("p.yaml", "a: &a [x, x]\nb: &b [*a, *a]\nposes: [*b, *b]\n"),
              HasSubstr("aliases"));
  EXPECT_THAT(Error("p.json", "{\"poses\": [" + std::string(200, '{')), HasSubstr("p.json"));
}

// --- CommonRoad ----------------------------------------------------------------------------------

TEST(CommonRoad, ReadsTrajectories) {
  const std::string ks =
      "<?xml version='1.0' ?>\n<CommonRoadSolution benchmark_id=\"KS1:JB1:USA_Lanker-1_1_T-1\">\n"
      "<ksTrajectory "
      "planningProblem=\"500\">\n<ksState><x>1.5</x><y>-2</y><steeringAngle>0</steeringAngle>"
      "<velocity>10</velocity><orientation>0.2</orientation><time>0</time></ksState>\n"
      "<ksState><x> 2.5 </x><y>-2.5</y><velocity>9</velocity><orientation>0.3</orientation>"
      "<time>1</time></ksState></ksTrajectory></CommonRoadSolution>";
  const PathPoints points = Read("s.xml", ks);
  ASSERT_EQ(points.points.size(), 2U);
  EXPECT_EQ(points.points[1], Vec2(2.5, -2.5));
  EXPECT_EQ(points.yaw, (std::vector<double>{0.2, 0.3}));
  EXPECT_EQ(points.speed, (std::vector<double>{10.0, 9.0}));
  const PathPoints mass =
      Read("s.xml",
           "<CommonRoadSolution><pmTrajectory><pmState><x>0</x><y>0</y><xVelocity>3</xVelocity>"
           "<yVelocity>4</yVelocity></pmState><pmState><x>1</x><y>0</y><xVelocity>0</xVelocity>"
           "<yVelocity>0</yVelocity></pmState></pmTrajectory></CommonRoadSolution>");
  EXPECT_EQ(mass.speed, (std::vector<double>{5.0, 0.0}));
  EXPECT_TRUE(mass.yaw.empty());
}

TEST(PathFile, SaysThatAFileIsOfAnotherKind) {
  for (const std::string name :
       {"p.csv", "p.gpx", "p.kml", "p.osm", "p.xml", "p.json", "p.geojson"}) {
    SCOPED_TRACE(name);
    EXPECT_THAT(Error(name, "\x1F\x8B\x08...."), HasSubstr("gunzip"));
    EXPECT_THAT(Error(name, "<!DOCTYPE html>\n<html><p>Sign in"), HasSubstr("web page"));
    EXPECT_THAT(Error(name, "\xFF\xFE<"), HasSubstr("UTF-16"));
    EXPECT_THAT(Error(name, ""), HasSubstr("empty"));
  }
}

// Maps of Formula Student list cones by their colors, in no order along the track.
TEST(PathCsv, TellsConesFromThePointsOfAPath) {
  EXPECT_THAT(Error("p.csv", "tag,x,y\nblue,0,1.5\nblue,5,1.5\nbig_orange,0,-1.5\n"),
              AllOf(HasSubstr("p.csv:4: tag: big_orange after blue"), HasSubstr("are cones")));
  EXPECT_THAT(Error("p.csv", "X,Y,color\n0,1.5,Yellow\n5,1.5,Blue\n"),
              AllOf(HasSubstr("p.csv:3: color"), HasSubstr("are cones")));
  EXPECT_THAT(Error("p.csv", "blue,0.2,1.8,0.0,0.0\nblue,5,1.5,0.0,0.0\n"), HasSubstr("are cones"));
  PathMap map;
  map.columns.x = "x";
  EXPECT_EQ(Read("p.csv", "tag,x,y\nblue,0,1.5\nyellow,5,1.5\n", map).points.size(), 2U);
  // One color may be that of a line in a drawing.
  EXPECT_EQ(Read("p.csv", "x,y,color\n0,1.5,blue\n5,1.5,blue\n").points.size(), 2U);
  EXPECT_EQ(Read("p.csv", "x,y,tag\n0,1.5,start\n5,1.5,blue\n9,2,yellow\n").points.size(), 3U);
}

TEST(PathCsv, NumbersAreNoNamesOfColumns) {
  EXPECT_THAT(Error("p.csv", "start,0.5,0.5,1\nturn,2,3,4\n"),
              AllOf(HasSubstr("p.csv:1: 0.5"), HasSubstr("add a line of names above")));
}

TEST(CommonRoad, SaysWhatIsWrong) {
  EXPECT_THAT(Error("s.xml", "<CommonRoadSolution>"), HasSubstr("not XML"));
  EXPECT_THAT(Error("s.xml", "no xml"), HasSubstr("not XML"));
  EXPECT_THAT(Error("s.xml", "<OpenSCENARIO></OpenSCENARIO>"),
              HasSubstr("must be CommonRoadSolution"));
  EXPECT_THAT(Error("s.xml", "<CommonRoadSolution></CommonRoadSolution>"),
              HasSubstr("no trajectory"));
  const std::string begin = "<CommonRoadSolution><ksTrajectory>\n<ksState>";
  const std::string end = "</ksState></ksTrajectory></CommonRoadSolution>";
  EXPECT_THAT(Error("s.xml", begin + "<x>1</x>" + end),
              AllOf(HasSubstr("s.xml:2"), HasSubstr("missing in ksState")));
  EXPECT_THAT(Error("s.xml", begin + "<x>one</x><y>2</y>" + end),
              HasSubstr("'one' is not a finite"));
  EXPECT_THAT(Error("s.xml", begin + "<x>1</x><y>2</y><velocity>-300</velocity>" + end),
              HasSubstr("out of range"));
}

TEST(CommonRoad, ExpandsNoEntities) {
  const std::string bomb =
      "<!DOCTYPE a [<!ENTITY a \"1\"><!ENTITY b \"&a;&a;&a;&a;&a;&a;&a;&a;\">"
      "<!ENTITY c \"&b;&b;&b;&b;&b;&b;&b;&b;\">]>"
      "<CommonRoadSolution><ksTrajectory><ksState><x>&c;</x><y>2</y></ksState></ksTrajectory>"
      "</CommonRoadSolution>";
  EXPECT_THAT(Error("s.xml", bomb), HasSubstr("s.xml"));
  std::string deep;
  for (int i = 0; i < 100000; ++i) {
    deep += "<a>";
  }
  EXPECT_THAT(Error("s.xml", deep), HasSubstr("not XML"));
}

// --- GeoJSON -------------------------------------------------------------------------------------

std::string Line(const std::string& coordinates, const std::string& more = "") {
  return R"({"type": "FeatureCollection", )" + more +
         R"("features": [{"type": "Feature", "properties": {}, "geometry": )"
         R"({"type": "LineString", "coordinates": )" +
         coordinates + "}}]}";
}

// The formulas for the ellipsoid WGS 84, with the semi-major axis a = 6378137 m and e^2 =
// 0.00669437999. At latitude phi, a degree of latitude is pi/180 a (1 - e^2)/(1 - e^2 sin^2
// phi)^1.5 long. A degree of longitude is pi/180 a cos phi/(1 - e^2 sin^2 phi)^0.5 long. Over 0.001
// degrees, the curvature of the meridian and of the parallel changes the result by less than 1 mm.
TEST(GeoJson, ProjectsDegrees) {
  const double phi = 48.1 * kPi / 180.0;
  const double w = 1.0 - 0.00669437999 * std::sin(phi) * std::sin(phi);
  const double north = kPi / 180.0 * 6378137.0 * (1.0 - 0.00669437999) / std::pow(w, 1.5);
  const double east = kPi / 180.0 * 6378137.0 * std::cos(phi) / std::sqrt(w);
  for (const std::string name : {"p.geojson", "p.json"}) {
    const PathPoints points =
        Read(name, Line("[[11.5, 48.1, 500.0], [11.501, 48.1], [11.5, 48.101]]"));
    ASSERT_EQ(points.points.size(), 3U);
    EXPECT_NEAR(points.points[0].norm(), 0.0, Tolerance(1e-6));
    EXPECT_NEAR(points.points[1].x(), 0.001 * east, Tolerance(1e-3));
    EXPECT_NEAR(points.points[1].y(), 0.0, Tolerance(1e-3));
    EXPECT_NEAR(points.points[2].y(), 0.001 * north, Tolerance(1e-3));
  }
  PathMap map;
  map.origin_latitude = 48.1;
  map.origin_longitude = 11.501;
  EXPECT_NEAR(Read("p.geojson", Line("[[11.5, 48.1], [11.501, 48.1]]"), map).points[0].x(),
              -0.001 * east, Tolerance(1e-3));
}

TEST(GeoJson, TakesMetersIfToldOrNamed) {
  PathMap meters;
  meters.coordinates = PathCoordinates::kMeters;
  EXPECT_EQ(Read("p.geojson", Line("[[500, 600], [700, 800]]"), meters).points[1],
            Vec2(700.0, 800.0));
  EXPECT_EQ(
      Read(
          "p.geojson",
          Line(
              "[[500, 600], [700, 800]]",
              R"("crs": {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::32632"}}, )"))
          .points[0],
      Vec2(500.0, 600.0));
}

TEST(GeoJson, SaysWhatIsWrong) {
  EXPECT_THAT(
      Error("p.geojson", Line("[[500, 600], [700, 800]]")),
      AllOf(HasSubstr("features[0].geometry.coordinates[0]"), HasSubstr("coordinates: meters")));
  EXPECT_THAT(Error("p.geojson", Line("[[1, 2], [3]]")), HasSubstr("position of two"));
  EXPECT_THAT(Error("p.geojson", Line("[[1, 2], [3, \"x\"]]")), HasSubstr("not a finite number"));
  EXPECT_THAT(Error("p.geojson", Line("[]")), HasSubstr("no positions"));
  EXPECT_THAT(Error("p.geojson", Line("7")), HasSubstr("list of positions"));
  EXPECT_THAT(Error("p.geojson", R"({"type": "Point", "coordinates": [1, 2]})"),
              HasSubstr("has no line: no LineString, but 1 single point,"));
  EXPECT_THAT(
      Error("p.geojson",
            R"({"type": "MultiLineString", "coordinates": [[[1, 2], [1, 3]], [[1, 2], [3, 4]]]})"),
      HasSubstr("2 line strings"));
  EXPECT_THAT(Error("p.geojson", Line("[[1, 2], [90, 3]]")), HasSubstr("too far from the origin"));
  PathMap half;
  half.origin_latitude = 3.0;
  EXPECT_THAT(Error("p.geojson", Line("[[1, 2], [1, 3]]"), half), HasSubstr("origin_longitude"));
}

/// Returns the content of a path file of the format; empty if the function has none.
std::string Example(PathFormat format) {
  const auto file = [](const char* name) {
    return ReadFile(std::filesystem::path(TRACKBED_SOURCE_DIR) / "tests/data" / name);
  };
  switch (format) {
    case PathFormat::kAuto:
      return "";
    case PathFormat::kCsv:
      return "x_m,y_m,speed_mps\n1,2,3\n4,5,6\n";
    case PathFormat::kNavPath:
      return "poses: [{pose: {position: {x: 1, y: 2}}}, {pose: {position: {x: 2, y: 2}}}]";
    case PathFormat::kCommonRoad:
      return "<CommonRoadSolution><ksTrajectory><ksState><x>1</x><y>2</y></ksState><ksState>"
             "<x>2</x><y>2</y></ksState></ksTrajectory></CommonRoadSolution>";
    case PathFormat::kGeoJson:
      return R"({"type": "LineString", "coordinates": [[1, 2], [1.01, 2]]})";
    case PathFormat::kGpx:
      return "<gpx><trk><trkseg><trkpt lat='48' lon='11'/><trkpt lat='48.001' lon='11'/></trkseg>"
             "</trk></gpx>";
    case PathFormat::kKml:
      return "<kml><Placemark><LineString><coordinates>11,48 11,48.001</coordinates></LineString>"
             "</Placemark></kml>";
    case PathFormat::kLanelet2:
      return file("paths/lanelet2.osm");
    case PathFormat::kBag:
      return file("bags/odometry.mcap");
  }
  return "";
}

TEST(PathFile, ReadsAnyFormatFromAnyBytes) {
  // The test truncates the example of each format, and replaces single bytes of the example.
  // Reading must return a path or throw an InputError with a message. Long examples are changed at
  // about kPlaces places.
  constexpr std::size_t kPlaces = 400;
  const TempFolder folder;
  for (const PathFormatEntry& entry : PathFormats()) {
    SCOPED_TRACE(entry.name);
    PathMap map = Of(entry.format);
    if (entry.format == PathFormat::kLanelet2) {
      map.lanelets = {"21", "22"};
    }
    if (entry.format == PathFormat::kBag) {
      map.topic = "/odom";
    }
    const auto read = [&](const std::string& text) {
      try {
        ReadPathFile(folder.Write("p", text), map);
      } catch (const InputError& error) {
        EXPECT_STRNE(error.what(), "");
      }
    };
    const std::string text = Example(entry.format);
    ASSERT_NE(text, "") << "add an example of the format";
    EXPECT_EQ(Error("q", text, map), "");
    for (std::size_t i = 0; i < text.size(); i += 1 + text.size() / kPlaces) {
      read(text.substr(0, i));
      const std::string bytes(
          "\0\"[-\xff"
          "9:&#<",
          10);
      std::string other = text;
      other[i] = bytes[i % bytes.size()];
      read(other);
    }
  }
}

}  // namespace
}  // namespace trackbed
