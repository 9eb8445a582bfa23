#include "trackbed/analysis/compare.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/temp_folder.h"
#include "tests/tolerance.h"
#include "trackbed/analysis/verdict.h"
#include "trackbed/control/steering_controller.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"

namespace trackbed {
namespace {

/// A trace along y = `offset` at 2 m/s, with rows at these stations.
Trace Line(const std::string& name, const std::vector<double>& stations, double offset) {
  Trace trace{.name = name};
  for (const double s : stations) {
    trace.station.push_back(s);
    trace.time.push_back(s / 2.0);
    trace.pose.push_back({s, offset, 0.0});
    trace.yaw_rate.push_back(0.0);
    trace.steering.push_back(0.0);
  }
  return trace;
}

/// A circle to the left of radius R from the origin, heading east, at 3 m/s: psi = s/R.
Trace Circle(const std::string& name, double radius, double wheelbase, double length,
             double spacing) {
  Trace trace{.name = name};
  for (int i = 0; i * spacing <= length; ++i) {
    const double s = i * spacing;
    trace.station.push_back(s);
    trace.time.push_back(s / 3.0);
    trace.pose.push_back(
        {radius * std::sin(s / radius), radius * (1.0 - std::cos(s / radius)), s / radius});
    trace.yaw_rate.push_back(3.0 / radius);
    trace.steering.push_back(std::atan(wheelbase / radius));
  }
  return trace;
}

TEST(CompareTraces, LeavesOutGapsOfARecord) {
  // The traces are 1 m apart up to s = 10 m and 5 m apart from s = 20 m on; the second trace has a
  // gap between these stations.
  Trace second = Line("recorded", {0, 5, 10, 12, 18, 20, 25}, 1.0);
  for (std::size_t i = 3; i < 7; ++i) {
    second.pose[i].y = 5.0;
  }
  second.valid = {true, true, true, false, false, true, true};
  const PlantComparison c = CompareTraces(Line("a", {0, 1, 15, 25}, 0.0), second);
  EXPECT_DOUBLE_EQ(c.position.max, 5.0);
  EXPECT_EQ(c.position.max_s, 20.0);
  // The position difference is 1 m over 10 m and 5 m over 5 m, so its RMS is sqrt((10 * 1 + 5 *
  // 25)/15) m.
  EXPECT_DOUBLE_EQ(c.position.rms, 3.0);
  EXPECT_EQ(DifferencesOverArcLength(Line("a", {0, 1, 15, 25}, 0.0), second).rows(), 6U);
}

TEST(CompareTraces, KnowsHowFarShiftedLinesAreApart) {
  const PlantComparison c =
      CompareTraces(Line("a", {0, 1, 5, 20}, 0.2), Line("b", {0, 3, 12, 20}, 0.5));
  EXPECT_EQ(c.first, "a");
  EXPECT_EQ(c.second, "b");
  EXPECT_DOUBLE_EQ(c.position.max, 0.3);
  EXPECT_DOUBLE_EQ(c.position.rms, 0.3);
  EXPECT_EQ(c.position.max_s, 0.0);
  EXPECT_EQ(c.heading.max, 0.0);
  EXPECT_EQ(c.yaw_rate.max, 0.0);
  EXPECT_EQ(c.steering.max, 0.0);
  EXPECT_EQ(c.from_s, 0.0);
  EXPECT_EQ(c.to_s, 20.0);
}

TEST(CompareTraces, IntegratesOverArcLengthAndNotOverRows) {
  // The difference is 0 up to s = 6 m and grows linearly to 0.9 m at s = 9 m. The mean square of
  // the difference is 0.81/3 m^2 over the last 3 m, and therefore 0.81/9 m^2 over all 9 m. The
  // second trace has dense rows where the traces agree.
  Trace bent = Line("b", {0, 1, 2, 3, 4, 5, 6, 9}, 0.0);
  bent.pose.back().y = 0.9;
  const PlantComparison c = CompareTraces(Line("a", {0, 9}, 0.0), bent);
  EXPECT_DOUBLE_EQ(c.position.max, 0.9);
  EXPECT_DOUBLE_EQ(c.position.max_s, 9.0);
  EXPECT_DOUBLE_EQ(c.position.max_t, 4.5);
  EXPECT_DOUBLE_EQ(c.position.rms, 0.3);
}

TEST(CompareTraces, KnowsHowTwoCirclesPart) {
  // Both circles start with the same tangent. The differences follow from the equations of the
  // circles, psi = s/R, psi' = v/R and delta = atan(L/R). Between rows, chords of length h deviate
  // from the circle by h^2/(8 R) = 1.25 um. The largest difference is at the end.
  constexpr double kLength = 15.0;
  constexpr double kSpacing = 0.01;
  const Trace a = Circle("a", 10.0, 2.7, kLength, kSpacing);
  const Trace b = Circle("b", 12.5, 2.7, kLength, 1.5 * kSpacing);
  const PlantComparison c = CompareTraces(a, b);
  const auto apart = [](double s) {
    const double dx = 10.0 * std::sin(s / 10.0) - 12.5 * std::sin(s / 12.5);
    const double dy = 10.0 * (1.0 - std::cos(s / 10.0)) - 12.5 * (1.0 - std::cos(s / 12.5));
    return std::hypot(dx, dy);
  };
  EXPECT_NEAR(c.position.max, apart(kLength), Tolerance(2e-6));
  EXPECT_NEAR(c.position.max_s, kLength, Tolerance(1e-9));
  EXPECT_NEAR(c.position.max_t, kLength / 3.0, Tolerance(1e-9));
  EXPECT_NEAR(c.heading.max, kLength * (1.0 / 10.0 - 1.0 / 12.5), Tolerance(1e-12));
  // A difference that grows linearly with s from 0 has an RMS of 1/sqrt(3) of its maximum.
  EXPECT_NEAR(c.heading.rms, c.heading.max / std::sqrt(3.0), Tolerance(1e-12));
  EXPECT_NEAR(c.yaw_rate.max, 3.0 / 10.0 - 3.0 / 12.5, Tolerance(1e-12));
  EXPECT_NEAR(c.yaw_rate.rms, 3.0 / 10.0 - 3.0 / 12.5, Tolerance(1e-12));
  EXPECT_NEAR(c.steering.max, std::atan(0.27) - std::atan(2.7 / 12.5), Tolerance(1e-12));
  // Simpson's rule over 300 intervals of the exact curve is accurate to 1e-9.
  double integral = 0.0;
  for (int i = 0; i <= 300; ++i) {
    const double weight = i == 0 || i == 300 ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
    integral += weight * std::pow(apart(kLength * i / 300.0), 2.0);
  }
  EXPECT_NEAR(c.position.rms, std::sqrt(integral / 900.0), Tolerance(2e-6));
}

TEST(CompareTraces, IsSymmetric) {
  const Trace a = Circle("a", 10.0, 2.7, 15.0, 0.7);
  const Trace b = Circle("b", 12.5, 2.7, 14.0, 0.3);
  const PlantComparison ab = CompareTraces(a, b);
  const PlantComparison ba = CompareTraces(b, a);
  EXPECT_EQ(ab.position.max, ba.position.max);
  EXPECT_EQ(ab.position.max_s, ba.position.max_s);
  EXPECT_EQ(ab.position.rms, ba.position.rms);
  EXPECT_EQ(ab.heading.rms, ba.heading.rms);
  EXPECT_EQ(ab.steering.max, ba.steering.max);
}

TEST(CompareTraces, ComparesOnlyWhatBothHaveDriven) {
  const PlantComparison c = CompareTraces(Line("a", {0, 4, 30}, 0.0), Line("b", {2, 10}, 0.1));
  EXPECT_EQ(c.from_s, 2.0);
  EXPECT_EQ(c.to_s, 10.0);
  EXPECT_TRUE(c.comparable());
  for (const Trace& other : {Line("b", {31, 40}, 0.0), Line("b", {3}, 0.0), Line("b", {}, 0.0)}) {
    const PlantComparison nothing = CompareTraces(Line("a", {0, 4, 30}, 0.0), other);
    EXPECT_FALSE(nothing.comparable());
    EXPECT_THAT(
        Exceeded({.position_max = 1.0}, nothing),
        testing::ElementsAre("a and b: cannot be compared: their station ranges do not overlap"));
  }
}

TEST(CompareTraces, TurnsHeadingsTheShortWay) {
  Trace a = Line("a", {0, 10}, 0.0);
  Trace b = Line("b", {0, 10}, 0.0);
  a.pose[0].yaw = a.pose[1].yaw = 3.1;
  b.pose[0].yaw = b.pose[1].yaw = -3.1;  // 2 pi - 6.2 further left
  EXPECT_NEAR(CompareTraces(a, b).heading.max, 2.0 * kPi - 6.2, Tolerance(1e-12));
}

TEST(DifferencesOverArcLength, AreThoseOfTheSecondFromTheFirst) {
  Trace b = Line("b", {0, 4}, 0.5);
  b.pose[1] = {4.0, 0.5, 0.2};
  b.yaw_rate = {0.1, 0.1};
  b.steering = {-0.1, -0.1};
  const Table table = DifferencesOverArcLength(Line("a", {0, 2, 4}, 0.0), b);
  EXPECT_THAT(table.Column("s_m"), testing::ElementsAre(0.0, 2.0, 4.0));
  EXPECT_THAT(table.Column("first_t_s"), testing::ElementsAre(0.0, 1.0, 2.0));
  EXPECT_THAT(table.Column("second_t_s"), testing::ElementsAre(0.0, 1.0, 2.0));
  EXPECT_THAT(table.Column("x_m"), testing::Each(0.0));
  EXPECT_THAT(table.Column("y_m"), testing::Each(0.5));
  EXPECT_THAT(table.Column("position_m"), testing::Each(0.5));
  EXPECT_THAT(table.Column("yaw_rad"), testing::ElementsAre(0.0, 0.1, 0.2));
  EXPECT_THAT(table.Column("yaw_rate_radps"), testing::Each(0.1));
  EXPECT_THAT(table.Column("steering_rad"), testing::Each(-0.1));
}

TEST(Exceeded, SaysWhatWasExpectedWhatWasWhereAndWhen) {
  const auto apart = [](double max) {
    return Difference{.rms = 0.1, .max = max, .max_s = 20.0 * max, .max_t = 8.0 * max};
  };
  const PlantComparison c{.first = "a",
                          .second = "b",
                          .from_s = 0.0,
                          .to_s = 20.0,
                          .position = apart(0.5),
                          .heading = apart(0.25),
                          .yaw_rate = apart(0.75),
                          .steering = apart(1.0)};
  EXPECT_THAT(Exceeded({0.5, 0.25, 0.75, 1.0}, c), testing::IsEmpty());
  EXPECT_THAT(Exceeded({}, c), testing::IsEmpty());
  EXPECT_THAT(Exceeded({0.4, 0.2, 0.7, 0.9}, c),
              testing::ElementsAre(
                  "a and b: position difference 0.5 m exceeds 0.4 m at s = 10 m, t = 4 s",
                  "a and b: heading difference 0.25 rad exceeds 0.2 rad at s = 5 m, t = 2 s",
                  "a and b: yaw rate difference 0.75 rad/s exceeds 0.7 rad/s at s = 15 m, t = 6 s",
                  "a and b: steering difference 1 rad exceeds 0.9 rad at s = 20 m, t = 8 s"));
}

TEST(Exceeded, DistinguishesWhatFourDigitsDoNot) {
  const PlantComparison c{
      .first = "a", .second = "b", .from_s = 0, .to_s = 1, .position = {.max = 0.0370349}};
  EXPECT_THAT(Exceeded({.position_max = 0.03703}, c),
              testing::ElementsAre(
                  "a and b: position difference 0.037035 m exceeds 0.03703 m at s = 0 m, t = 0 s"));
}

TEST(MakeTrace, LeavesOutWhereTheCarDoesNotGetOn) {
  RunLog log{.plant = "made_up", .configurations = Table({"t_s"})};
  for (const double s : {0.0, 1.0, 1.0, 0.999, 2.0}) {
    LogRow row;
    row.state.time = static_cast<double>(log.rows.size());
    row.state.distance = 10.0 * s;
    row.state.steering = 0.1 * row.state.time;
    row.tracking = Projection{.s = s};
    log.rows.push_back(row);
  }
  const Trace trace = MakeTrace(log);
  EXPECT_EQ(trace.name, "made_up");
  EXPECT_THAT(trace.station, testing::ElementsAre(0.0, 1.0, 2.0));
  EXPECT_THAT(trace.time, testing::ElementsAre(0.0, 1.0, 4.0));
  EXPECT_THAT(trace.steering, testing::ElementsAre(0.0, 0.1, 0.4));
  EXPECT_THAT(MakeTrace(log, StationSource::kOdometer).station,
              testing::ElementsAre(0.0, 10.0, 20.0));
}

TEST(MakeTrace, EndsAtTheContact) {
  RunLog log{.plant = "made_up", .configurations = Table({"t_s"})};
  for (int i = 0; i < 5; ++i) {
    LogRow row;
    row.state.time = i;
    row.state.distance = 10.0 * i;
    log.rows.push_back(row);
  }
  log.contact_time = 2.5;
  EXPECT_THAT(MakeTrace(log).station, testing::ElementsAre(0.0, 10.0, 20.0));
}

TEST(ReadRunFolder, EndsTracesAtTheContact) {
  const TempFolder folder;
  folder.Write("metrics.json",
               R"({"plants": {"kinematic": {"status": "collided", "status_t": 1.5}, )"
               R"("mujoco": {"status": "arrived", "status_t": 1.5}}})");
  const std::string log =
      "t_s,x_m,y_m,yaw_rad,yaw_rate_radps,steering_rad,s_m\n"
      "0,0,0,0,0,0,0\n1,3,0,0,0,0,3\n2,6,0,0,0,0,6\n";
  folder.Write("kinematic.csv", log);
  folder.Write("mujoco.csv", log);
  const std::vector<FinishedDrive> drives = ReadRunFolder(folder.path());
  EXPECT_THAT(drives[0].trace.station, testing::ElementsAre(0.0, 3.0));
  EXPECT_THAT(drives[1].trace.station, testing::ElementsAre(0.0, 3.0, 6.0));
}

TEST(ReadRunFolder, GivesTheDrivesThatWereLogged) {
  const TempFolder folder;
  folder.Write("metrics.json",
               R"({"plants": {"kinematic": {"status": "arrived"}, "mujoco:contact": {"status": )"
               R"("collided"}}})");
  const std::string header = "t_s,x_m,y_m,yaw_rad,yaw_rate_radps,steering_rad,other,s_m\n";
  folder.Write("kinematic.csv", header + "0,0,0,0,0,0,9,0\n1,3,0.5,0.1,0.2,0.3,9,3\n");
  folder.Write("mujoco-contact.csv", header + "0,0,0,0,0,0,9,0\n1,0,0,0,0,0,9,0\n");
  const std::vector<FinishedDrive> drives = ReadRunFolder(folder.path());
  ASSERT_EQ(drives.size(), 2U);
  EXPECT_EQ(drives[0].status, "arrived");
  EXPECT_EQ(drives[0].trace.name, "kinematic");
  EXPECT_THAT(drives[0].trace.station, testing::ElementsAre(0.0, 3.0));
  EXPECT_THAT(drives[0].trace.time, testing::ElementsAre(0.0, 1.0));
  EXPECT_EQ(drives[0].trace.pose[1], (Pose2{3.0, 0.5, 0.1}));
  EXPECT_THAT(drives[0].trace.yaw_rate, testing::ElementsAre(0.0, 0.2));
  EXPECT_THAT(drives[0].trace.steering, testing::ElementsAre(0.0, 0.3));
  EXPECT_EQ(drives[1].status, "collided");
  EXPECT_EQ(drives[1].trace.name, "mujoco:contact");
  EXPECT_THAT(drives[1].trace.station, testing::ElementsAre(0.0));  // the car did not move
}

std::string ErrorMessage(const std::filesystem::path& folder) {
  try {
    ReadRunFolder(folder);
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

TEST(ReadRunFolder, RefusesWhatIsNoRun) {
  const TempFolder folder;
  EXPECT_EQ(ErrorMessage(folder.path()),
            folder.path().string() + ": not the folder of a finished run (no metrics.json)");
  auto file = folder.Write("metrics.json", "{\"plants\": {\"kinematic\": ");
  EXPECT_THAT(ErrorMessage(folder.path()),
              testing::StartsWith(file.string() + ":1:26: not JSON: "));
  file = folder.Write("metrics.json", R"({"plants": {"kinematic": 3}})");
  EXPECT_EQ(
      ErrorMessage(folder.path()),
      file.string() + ": plants.kinematic: expected a section, found 3; not as Trackbed writes it");
  folder.Write("metrics.json", R"({"plants": {"kinematic": {"status": "arrived"}}})");
  const auto log = folder.Write("kinematic.csv", "t_s,x_m\n0,0\n");
  EXPECT_THAT(ErrorMessage(folder.path()), testing::StartsWith(log.string() + ":1"));
  const std::string header = "t_s,x_m,y_m,yaw_rad,yaw_rate_radps,steering_rad,s_m\n";
  for (const auto& [rows, count] : {std::pair("", 0), std::pair("0,0,0,0,0,0,0\n", 1)}) {
    folder.Write("kinematic.csv", header + rows);
    EXPECT_EQ(ErrorMessage(folder.path()),
              fmt::format("{}: a log needs at least two rows; found {}", log.string(), count));
  }
  folder.Write("metrics.json", R"({"plants": []})");
  EXPECT_EQ(
      ErrorMessage(folder.path()),
      file.string() + ": plants: expected a section, found a list of 0; not as Trackbed writes it");
  folder.Write("metrics.json", R"({"plants": {"../kinematic": {"status": "arrived"}}})");
  EXPECT_EQ(ErrorMessage(folder.path()),
            file.string() + ": plants: unknown '../kinematic'; did you mean 'kinematic'?");
  folder.Write("metrics.json", R"({"complete": false, "plants": {}})");
  EXPECT_EQ(ErrorMessage(folder.path()),
            folder.path().string() + ": the run was interrupted; its logs are incomplete");
}

}  // namespace
}  // namespace trackbed
