#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/cli/program.h"
#include "tests/tolerance.h"
#include "trackbed/core/file.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

const fs::path kSource = TRACKBED_SOURCE_DIR;

std::string Bends() {
  return (kSource / "scenarios/paths/bends.csv").string();
}

TEST(CheckPath, ExitsWithTheVerdict) {
  const TempFolder folder;
  const Outcome slow = Trackbed(folder, "check-path " + Bends() + " --speed 5 --vehicle prius");
  EXPECT_EQ(slow.code, 0) << slow.output;
  EXPECT_THAT(slow.output, AllOf(HasSubstr("bends: drivable at 5 m/s with prius"),
                                 HasSubstr("limited by friction"), HasSubstr("spline within 0.0")));
  const Outcome fast = Trackbed(folder, "check-path " + Bends() + " --speed 20");
  EXPECT_EQ(fast.code, 3) << fast.output;
  EXPECT_THAT(fast.output, AllOf(HasSubstr("bends: not drivable at 20 m/s"),
                                 HasSubstr("(friction)"), HasSubstr(" at s = ")));
  EXPECT_EQ(Trackbed(folder, "check-path " + Bends() + " --speed 5 -q").output, "");
}

TEST(CheckPath, ReadsEveryFormat) {
  const TempFolder folder;
  for (const char* name :
       {"nav_path.yaml", "nav_path.json", "commonroad.xml", "line.geojson", "raceline.csv"}) {
    const Outcome outcome =
        Trackbed(folder, "check-path " + (kSource / "tests/data/paths" / name).string() +
                             " --speed 2 --json");
    ASSERT_EQ(outcome.code, 0) << outcome.output;
    const auto json = nlohmann::json::parse(outcome.output);
    EXPECT_EQ(json.at("points"), 12) << name;
    // The path has 11 chords of 2 m of a circle with the radius 15 m. The tolerance covers the
    // GeoJSON file, which was projected on a sphere.
    EXPECT_NEAR(json.at("length_m").get<double>(), 22.0, Tolerance(0.15)) << name;
    EXPECT_TRUE(json.at("faults").empty());
  }
}

TEST(CheckPath, NamesPlaceAndReason) {
  const TempFolder folder;
  folder.Write("corner.csv", "x,y\n0,0\n5,0\n10,0\n15,0\n15,5\n15,10\n15,15\n");
  const Outcome lines =
      Trackbed(folder, "check-path corner.csv --speed 1 --fit polyline --json --report p.html");
  ASSERT_EQ(lines.code, 3) << lines.output;
  const auto json = nlohmann::json::parse(lines.output);
  EXPECT_FALSE(json.at("drivable").get<bool>());
  ASSERT_EQ(json.at("faults").size(), 1U);
  EXPECT_EQ(json.at("faults")[0].at("kind"), "heading_jump");
  EXPECT_EQ(json.at("faults")[0].at("x_m"), 15.0);
  EXPECT_EQ(json.at("faults")[0].at("y_m"), 0.0);
  EXPECT_EQ(json.at("max_speed_mps"), 0.0);
  const std::string page = ReadFile(folder.path() / "p.html");
  EXPECT_THAT(page, AllOf(HasSubstr("\"path_check\""), HasSubstr("heading jumps by 1.57 rad")));
  const Outcome spline = Trackbed(folder, "check-path corner.csv --speed 1");
  EXPECT_EQ(spline.code, 3) << spline.output;
  EXPECT_THAT(spline.output, HasSubstr("steering angle"));
  folder.Write("back.csv", "x,y\n0,0\n5,0\n1,0\n");
  const Outcome back = Trackbed(folder, "check-path back.csv --speed 1 --report back.html");
  EXPECT_EQ(back.code, 3) << back.output;
  EXPECT_THAT(back.output, HasSubstr("turns back on itself by 3.14 rad at s = 5 m, (5, 0)"));
}

TEST(CheckPath, TakesKeysOfThePlan) {
  const TempFolder folder;
  folder.Write("my path.csv", "east,north\n0,0\n1000,0\n2000,0\n");
  const Outcome outcome = Trackbed(folder,
                                   "check-path 'my path.csv' --speed 3 --set plan.columns.x=east "
                                   "plan.columns.y=north plan.columns.position_unit=cm");
  EXPECT_EQ(outcome.code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, AllOf(HasSubstr("my_path: drivable"), HasSubstr("20 m, spline")));
}

TEST(CheckPath, DrivesThePath) {
  const TempFolder folder;
  const Outcome outcome =
      Trackbed(folder, "check-path " + Bends() + " --speed 5 --drive --plant kinematic --out run");
  EXPECT_EQ(outcome.code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("kinematic  arrived"));
  EXPECT_TRUE(fs::exists(folder.path() / "run/path.csv"));
  EXPECT_TRUE(fs::exists(folder.path() / "run/metrics.json"));
}

TEST(CheckPath, SaysWhatIsWrong) {
  const TempFolder folder;
  folder.Write("p.csv", "x,y\n0,0\n1,two\n");
  const Outcome cell = Trackbed(folder, "check-path p.csv --speed 1");
  EXPECT_EQ(cell.code, 2);
  EXPECT_THAT(cell.output, HasSubstr("p.csv:3: y: 'two' is not a finite number"));
  EXPECT_EQ(Trackbed(folder, "check-path none.csv --speed 1").code, 2);
  EXPECT_EQ(Trackbed(folder, "check-path p.csv").code, 2);
  EXPECT_EQ(Trackbed(folder, "check-path p.csv --speed 0").code, 2);
  EXPECT_EQ(Trackbed(folder, "check-path p.csv --speed 1 --fit cubic").code, 2);
  const Outcome out = Trackbed(folder, "check-path p.csv --speed 1 --out run");
  EXPECT_EQ(out.code, 2);
  EXPECT_THAT(out.output, HasSubstr("need --drive"));
  // Escape sequences in a file's column names must not reach the terminal.
  folder.Write("e.csv", "x,\"y\x1b[31m\"\n0,0\n1,0\n");
  EXPECT_THAT(Trackbed(folder, "check-path e.csv --speed 1").output, Not(HasSubstr("\x1b[31m")));
}

}  // namespace
}  // namespace trackbed
