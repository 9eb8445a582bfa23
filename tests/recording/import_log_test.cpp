#include "trackbed/recording/import_log.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <ostream>
#include <random>
#include <string>
#include <vector>

#include "tests/support/temp_folder.h"
#include "tests/tolerance.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/geometry/pose.h"

// Tests the import of logs: motion by local polynomials on a circle with known derivatives, units,
// time stamps, commands, gaps, and errors with their lines.
namespace trackbed {
namespace {

using testing::Contains;
using testing::DoubleNear;
using testing::HasSubstr;

using PoseAt = std::function<Pose2(double t)>;

LogMap PoseMap() {
  LogMap map;
  map.name = "log";
  map.time.column = "t";
  map.position = {.x = "x", .y = "y"};
  map.yaw.emplace();
  map.yaw->column = "yaw";
  return map;
}

/// Times from 0 to `end` that are `step` apart on average, with up to a third of variation.
std::vector<double> IrregularTimes(double end, double step) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> off(-step / 3.0, step / 3.0);
  std::vector<double> times{0.0};
  for (double t = step; t < end - 0.5 * step; t += step) {
    times.push_back(t + off(random));
  }
  times.push_back(end);
  return times;
}

std::string PoseCsv(const std::vector<double>& times, const PoseAt& pose_at) {
  std::string csv = "t,x,y,yaw\n";
  for (const double t : times) {
    const Pose2 pose = pose_at(t);
    csv += fmt::format("{},{},{},{}\n", t, pose.x, pose.y, pose.yaw);
  }
  return csv;
}

RecordedDrive Import(const std::string& csv, const LogMap& map) {
  const TempFolder folder;
  return ImportLog(folder.Write("log.csv", csv), map);
}

/// All problems, without the folder's name.
std::string Problems(const std::string& csv, const LogMap& map) {
  const TempFolder folder;
  try {
    ImportLog(folder.Write("log.csv", csv), map);
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

// The rear axle moves on a circle of radius 2 m at 1.5 m/s to the left, with 0.05 rad of outward
// slip.
constexpr double kRadius = 2.0;
constexpr double kSpeed = 1.5;
constexpr double kRate = kSpeed / kRadius;  // [rad/s]
constexpr double kSlip = 0.05;

Pose2 OnCircle(double t) {
  const double course = 0.3 + kRate * t;
  return {kRadius * std::sin(course), -kRadius * std::cos(course), course + kSlip};
}

/// The largest error of a value from a local polynomial of degree 2 on a circle. By Taylor's
/// theorem, the circle deviates from a parabola by up to R rate^3 h^3/6, with the half width h of
/// the window. The fit amplifies this deviation by at most 3, the sum of the magnitudes of its
/// weights (1.6 in the middle, below 3 at an end).
double ValueError(double half_width) {
  return 3.0 / 6.0 * kRadius * std::pow(kRate, 3.0) * std::pow(half_width, 3.0);
}

TEST(ImportLog, FindsTheMotionOnACircleFromALeverArm) {
  LogMap map = PoseMap();
  map.sensor = {.x = 0.4, .y = -0.1, .yaw = 0.02};
  map.trim = 0.2;
  const Pose2 X_VS{map.sensor.x, map.sensor.y, map.sensor.yaw};
  const RecordedDrive drive = Import(
      PoseCsv(IrregularTimes(12.0, 0.02), [&](double t) { return Compose(OnCircle(t), X_VS); }),
      map);
  // The error of a slope is twice the error of a value divided by the half width. The error of a
  // second derivative is four times the error of a value divided by the square of the half width.
  const double value = Tolerance(ValueError(0.1));
  const double slope = Tolerance(2.0 * ValueError(0.1) / 0.1);
  const double curvature = Tolerance(4.0 * ValueError(0.1) / 0.01);
  const VehicleParams car{.cg_to_rear = 0.5};
  ASSERT_EQ(drive.samples.size(), 1161U);
  for (const RecordedSample& sample : drive.samples) {
    const Pose2 pose = OnCircle(sample.time + 0.2);
    ASSERT_TRUE(sample.valid);
    EXPECT_THAT(sample.pose.x, DoubleNear(pose.x, value));
    EXPECT_THAT(sample.pose.y, DoubleNear(pose.y, value));
    // The yaw is linear in time, so the fit is exact to rounding.
    EXPECT_THAT(sample.pose.yaw, DoubleNear(pose.yaw, Tolerance(1e-9)));
    EXPECT_THAT(sample.yaw_rate, DoubleNear(kRate, Tolerance(1e-7)));
    EXPECT_THAT(sample.velocity_V.x(), DoubleNear(kSpeed * std::cos(kSlip), slope));
    const VehicleState state = StateOf(sample, car, false);
    EXPECT_THAT(state.lateral_speed, DoubleNear(-kSpeed * std::sin(kSlip) + 0.5 * kRate, slope));
    // The rear axle's acceleration points to the center. The forward acceleration of the center of
    // gravity is smaller by l rate^2.
    EXPECT_THAT(state.lateral_acceleration,
                DoubleNear(kSpeed * kRate * std::cos(kSlip), curvature));
    EXPECT_THAT(state.longitudinal_acceleration,
                DoubleNear(kSpeed * kRate * std::sin(kSlip) - 0.5 * kRate * kRate, curvature));
  }
}

TEST(ImportLog, IsExactForPolynomialsOfItsDegree) {
  const PoseAt parabola = [](double t) {
    return Pose2{1.0 + 0.5 * t + 0.1 * t * t, 0.3 - 0.2 * t * t, 0.1 * t + 0.02 * t * t};
  };
  for (const int degree : {2, 3}) {
    LogMap map = PoseMap();
    map.check = false;  // otherwise the sideways motion is rejected
    map.resample = {.rate = 30.0, .half_width = 0.15, .degree = degree};
    const RecordedDrive drive = Import(PoseCsv(IrregularTimes(5.0, 0.03), parabola), map);
    ASSERT_EQ(drive.samples.size(), 151U);
    for (const RecordedSample& sample : drive.samples) {
      const double t = sample.time;
      const Pose2 pose = parabola(t);
      // The tolerances cover rounding of 1e-15. The condition number of the fit amplifies this by
      // up to 1e3 for a value at the ends, and by 1/(0.15 s) for each derivative.
      EXPECT_THAT(sample.pose.x, DoubleNear(pose.x, Tolerance(1e-12)));
      EXPECT_THAT(sample.pose.yaw, DoubleNear(pose.yaw, Tolerance(1e-12)));
      const Vec2 velocity = ToWorld({0.0, 0.0, pose.yaw}, sample.velocity_V);
      EXPECT_THAT(velocity.x(), DoubleNear(0.5 + 0.2 * t, Tolerance(1e-11)));
      EXPECT_THAT(velocity.y(), DoubleNear(-0.4 * t, Tolerance(1e-11)));
      const Vec2 acceleration = ToWorld({0.0, 0.0, pose.yaw}, sample.acceleration_V);
      EXPECT_THAT(acceleration.y(), DoubleNear(-0.4, Tolerance(1e-9)));
      EXPECT_THAT(sample.yaw_rate, DoubleNear(0.1 + 0.04 * t, Tolerance(1e-11)));
      EXPECT_THAT(sample.yaw_acceleration, DoubleNear(0.04, Tolerance(1e-9)));
    }
  }
}

// The same log with other delimiters, comments, and its names in a comment.
TEST(ImportLog, ReadsTheDialectsOfPaths) {
  const std::string csv = PoseCsv(IrregularTimes(4.0, 0.02), OnCircle);
  const RecordedDrive plain = Import(csv, PoseMap());
  for (const char delimiter : {',', ';', '\t'}) {
    std::string own = "# recorded \"by hand\"\n# " + csv + "# end\n";
    std::replace(own.begin(), own.end(), ',', delimiter);
    const RecordedDrive drive = Import(own, PoseMap());
    ASSERT_EQ(drive.samples.size(), plain.samples.size());
    EXPECT_EQ(drive.samples.back().pose, plain.samples.back().pose);
  }
}

TEST(ImportLog, UnderstandsNorthEastDown) {
  LogMap map = PoseMap();
  map.frame = LogFrame::kNed;
  map.yaw->unit = "deg";
  map.position.unit = "mm";
  map.yaw_rate.emplace();
  map.yaw_rate->column = "r";
  map.yaw_rate->unit = "deg/s";
  map.steering.emplace();
  map.steering->column = "steer";
  map.steering->unit = "deg";
  std::string csv = "t,x,y,yaw,r,steer\n";
  for (const double t : IrregularTimes(4.0, 0.02)) {
    const Pose2 pose = OnCircle(t);
    const double compass = std::fmod(720.0 + 90.0 - pose.yaw * 180.0 / kPi, 360.0);
    csv += fmt::format("{},{},{},{},{},{}\n", t, 1000.0 * pose.y, 1000.0 * pose.x, compass,
                       -kRate * 180.0 / kPi, -9.0);
  }
  const RecordedDrive drive = Import(csv, map);
  for (const RecordedSample& sample : drive.samples) {
    const Pose2 pose = OnCircle(sample.time);
    EXPECT_THAT(sample.pose.x, DoubleNear(pose.x, Tolerance(ValueError(0.1))));
    EXPECT_THAT(sample.pose.y, DoubleNear(pose.y, Tolerance(ValueError(0.1))));
    EXPECT_THAT(WrapAngle(sample.pose.yaw - pose.yaw), DoubleNear(0.0, Tolerance(1e-9)));
    EXPECT_THAT(sample.yaw_rate, DoubleNear(kRate, Tolerance(1e-9)));
    EXPECT_THAT(sample.steering, DoubleNear(0.05 * kPi, Tolerance(1e-12)));  // 9 degrees left
  }
}

TEST(ImportLog, TakesTheYawOfAQuaternionAndStampsOfRos) {
  LogMap map = PoseMap();
  map.yaw.reset();
  map.orientation = LogOrientation{.x = "qx", .y = "qy", .z = "qz", .w = "qw"};
  map.time = {.column = "s", .unit = "s", .nanoseconds = "ns"};
  std::string csv = ",s,ns,x,y,qx,qy,qz,qw\n";
  for (int i = 0; i <= 200; ++i) {
    const Pose2 pose = OnCircle(0.02 * i);
    csv += fmt::format("0,{},{},{},{},0,0,{},{}\n", 1650776486 + (i + 40) / 50,
                       (i + 40) % 50 * 20'000'000, pose.x, pose.y, std::sin(0.5 * pose.yaw),
                       std::cos(0.5 * pose.yaw));
  }
  const RecordedDrive drive = Import(csv, map);
  EXPECT_THAT(drive.duration(), DoubleNear(4.0, Tolerance(1e-9)));
  for (const RecordedSample& sample : drive.samples) {
    EXPECT_THAT(sample.pose.yaw, DoubleNear(OnCircle(sample.time).yaw, Tolerance(1e-9)));
  }
}

TEST(ImportLog, ReadsTimesOfAnyUnitFromAnyMoment) {
  for (const auto& [unit, per_second] : {std::pair("ms", 1e3), {"us", 1e6}, {"ns", 1e9}}) {
    LogMap map = PoseMap();
    map.time.unit = unit;
    std::string csv = "t,x,y,yaw\n";
    for (int i = 0; i <= 100; ++i) {
      const Pose2 pose = OnCircle(0.02 * i);
      csv += fmt::format("{:.0f},{},{},{}\n", (1.7e9 + 0.02 * i) * per_second, pose.x, pose.y,
                         pose.yaw);
    }
    const RecordedDrive drive = Import(csv, map);
    // Near 1.7e18 ns, neighboring double values are 256 ns apart.
    EXPECT_THAT(drive.duration(), DoubleNear(2.0, Tolerance(1e-6))) << unit;
    EXPECT_THAT(drive.At(1.0).yaw_rate, DoubleNear(kRate, Tolerance(1e-4))) << unit;
  }
}

/// The circle with additional columns from `more`.
std::string CircleWith(const std::string& names, const std::function<std::string(double)>& more) {
  std::string csv = "t,x,y,yaw," + names + "\n";
  for (int i = 0; i <= 200; ++i) {
    const double t = 0.02 * i;
    const Pose2 pose = OnCircle(t);
    csv += fmt::format("{},{},{},{},{}\n", t, pose.x, pose.y, pose.yaw, more(t));
  }
  return csv;
}

TEST(ImportLog, PassesCommandsThroughScaleAndCurve) {
  LogMap map = PoseMap();
  map.steering_command.emplace();
  map.steering_command->column = "c";
  map.steering_command->unit = "1";
  map.steering_command->scale = -1.0;
  map.steering_command->offset = 0.1;
  map.steering_command->curve = {{-1.0, -0.4}, {0.0, 0.0}, {1.0, 0.2}};
  const RecordedDrive drive = Import(
      CircleWith("c", [](double t) { return fmt::format("{}", t < 2.0 ? -0.4 : 0.6); }), map);
  EXPECT_THAT(drive.At(1.0).steering_command, DoubleNear(0.1, Tolerance(1e-12)));  // 0.2 (0.4+0.1)
  EXPECT_THAT(drive.At(3.0).steering_command,
              DoubleNear(-0.2, Tolerance(1e-12)));  // 0.4 (-0.6+0.1)
  EXPECT_TRUE(drive.has_steering_command);
  EXPECT_FALSE(drive.has_steering);
}

TEST(ImportLog, TakesTheUpdatesOfASlowerLoop) {
  LogMap map = PoseMap();
  map.throttle.emplace();
  map.throttle->column = "a";
  map.throttle->unit = "g";
  map.throttle->delay = 0.02;
  map.throttle->period = 0.1;
  // The throttle is 0 until 1 s, rises by 0.1 g every 0.1 s until 2 s, is constant until 3 s and is
  // then 0.
  const RecordedDrive drive = Import(CircleWith("a",
                                                [](double t) {
                                                  const double steps = std::floor(10.0 * t + 1e-9);
                                                  const double a = std::clamp(steps - 9, 0.0, 11.0);
                                                  return fmt::format("{}", t < 2.999 ? 0.1 * a : 0);
                                                }),
                                     map);
  constexpr double kG = 9.80665;
  const auto at = [&](double t) { return drive.At(t - 0.02).throttle / kG; };  // sent 20 ms earlier
  EXPECT_THAT(at(0.5), DoubleNear(0.0, Tolerance(1e-12)));
  EXPECT_THAT(at(1.0), DoubleNear(0.1, Tolerance(1e-12)));
  EXPECT_THAT(at(0.94), DoubleNear(0.04, Tolerance(1e-12)));  // rising toward the update at 1 s
  EXPECT_THAT(at(1.56), DoubleNear(0.66, Tolerance(1e-12)));
  EXPECT_THAT(at(2.88), DoubleNear(1.1, Tolerance(1e-12)));  // held until 0.1 s before 3 s
  EXPECT_THAT(at(2.96), DoubleNear(0.44, Tolerance(1e-12)));
}

TEST(ImportLog, PrefersMeasuredSpeedYawRateAndAcceleration) {
  LogMap map = PoseMap();
  map.speed.emplace();
  map.speed->column = "v";
  map.speed->unit = "km/h";
  map.yaw_rate.emplace();
  map.yaw_rate->column = "r";
  map.yaw_rate->unit = "rad/s";
  map.accelerometer = LogAccelerometer{.x = "ax", .y = "ay", .unit = "g", .ahead = 1.0};
  const RecordedDrive drive = Import(
      CircleWith(
          "v,r,ax,ay",
          [](double t) { return fmt::format("{},{},{},{}", 3.6 * 1.4, 0.7 + 0.01 * t, 0.0, 0.2); }),
      map);
  const RecordedSample sample = drive.At(2.0);
  EXPECT_THAT(sample.velocity_V.x(), DoubleNear(1.4, Tolerance(1e-12)));
  EXPECT_THAT(sample.yaw_rate, DoubleNear(0.72, Tolerance(1e-12)));
  EXPECT_THAT(sample.yaw_acceleration, DoubleNear(0.01, Tolerance(1e-10)));
  // The accelerometer is 1 m ahead of the rear axle. With the yaw rate r, the accelerometer reads
  // -r^2 * 1 m more forward and r' * 1 m more to the left.
  EXPECT_THAT(sample.acceleration_V.x(), DoubleNear(0.72 * 0.72, Tolerance(1e-10)));
  EXPECT_THAT(sample.acceleration_V.y(), DoubleNear(0.2 * 9.80665 - 0.01, Tolerance(1e-10)));
}

TEST(ImportLog, ReadsSignalsOfOtherFiles) {
  const TempFolder folder;
  const auto log = folder.Write("poses.csv", PoseCsv(IrregularTimes(4.0, 0.02), OnCircle));
  folder.Write("commands.csv", "t,delta\n-0.5,0\n2,0.1\n2,0.3\n4.5,0.2\n");
  LogMap map = PoseMap();
  map.steering_command.emplace();
  map.steering_command->column = "delta";
  map.steering_command->file = "commands.csv";
  const RecordedDrive drive = ImportLog(log, map);
  EXPECT_THAT(drive.At(1.0).steering_command, DoubleNear(0.06, Tolerance(1e-12)));
  EXPECT_THAT(drive.At(3.0).steering_command, DoubleNear(0.14, Tolerance(1e-12)));
  map.steering_command->file = "../commands.csv";
  EXPECT_THROW(ImportLog(log, map), InputError);
}

TEST(ImportLog, MarksGapsAndGoesStraightThroughThem) {
  LogMap map = PoseMap();
  map.valid = {{.column = "ok", .equals = 1.0}};
  const RecordedDrive drive =
      Import(CircleWith("ok", [](double t) { return t > 1.001 && t < 1.999 ? "0" : "1"; }), map);
  EXPECT_TRUE(drive.At(1.0).valid);
  EXPECT_FALSE(drive.At(1.01).valid);
  EXPECT_FALSE(drive.At(1.5).valid);
  EXPECT_TRUE(drive.At(2.0).valid);
  const Vec2 chord = OnCircle(2.0).position() - OnCircle(1.0).position();
  const RecordedSample middle = drive.At(1.5);
  const Vec2 half = OnCircle(1.0).position() + 0.5 * chord;
  EXPECT_THAT((middle.pose.position() - half).norm(),
              DoubleNear(0.0, Tolerance(2.0 * ValueError(0.1))));
  EXPECT_THAT(middle.velocity_V.norm(), DoubleNear(chord.norm(), Tolerance(2.0 * ValueError(0.1))));
  EXPECT_THAT(drive.notes, Contains(HasSubstr("1 gap of more than 0.2 s, 0.99 s in all")));
  EXPECT_THAT(drive.notes, Contains("49 rows dropped that `valid` excludes"));
  EXPECT_THAT(drive.valid_fraction(), DoubleNear(302.0 / 401.0, Tolerance(1e-12)));
}

TEST(ImportLog, DropsRepeatedRowsAndRowsWithoutAPose) {
  std::string csv = PoseCsv(IrregularTimes(4.0, 0.02), OnCircle);
  const std::size_t third = csv.find('\n', csv.find('\n') + 1) + 1;
  const std::string row = csv.substr(third, csv.find('\n', third) + 1 - third);
  csv.insert(third, row);
  const double later = 4.01;
  csv += fmt::format("{},nan,0,0\n{},,,\n", later, later + 0.01);
  const RecordedDrive drive = Import(csv, PoseMap());
  EXPECT_THAT(drive.notes,
              Contains("1 rows dropped that have the time of the row before, the first in line 4"));
  EXPECT_THAT(drive.notes, Contains("2 rows dropped that have no number for the pose"));
  EXPECT_THAT(drive.duration(), DoubleNear(4.0, Tolerance(1e-9)));
}

TEST(ImportLog, CutsAPartOut) {
  LogMap map = PoseMap();
  map.from = 1.0;
  map.to = 3.0;
  const RecordedDrive drive = Import(PoseCsv(IrregularTimes(4.0, 0.02), OnCircle), map);
  EXPECT_THAT(drive.duration(), DoubleNear(2.0, Tolerance(1e-9)));
  EXPECT_THAT(drive.samples.front().pose.yaw, DoubleNear(OnCircle(1.0).yaw, Tolerance(1e-9)));
}

TEST(ImportLog, SaysWhatIsWrongInAFile) {
  const std::string good = PoseCsv(IrregularTimes(4.0, 0.02), OnCircle);
  LogMap map = PoseMap();
  map.position.x = "xx";
  EXPECT_EQ(Problems(good, map), "log.csv:1: no column 'xx'; did you mean 'x'?");
  map = PoseMap();
  EXPECT_EQ(Problems("t,x,y,yaw\n0,0,0,0\n1,1,0,0\n0.5,2,0,0\n2,3,0,0\n", map),
            "log.csv:4: t: the time goes back by 0.5 s; sort the rows, or cut the part out with "
            "from and to");
  EXPECT_EQ(Problems("t,x,y,yaw\n0,0,0,0\nnan,1,0,0\n", map), "log.csv:3: t: no time");
  EXPECT_EQ(Problems("t,x,y,yaw\n0,0,0,0\n1,one,0,0\n", map),
            "log.csv:3: cell 2 (x): 'one' is not a number");
  EXPECT_EQ(Problems("t,x,y,yaw\n0,0,0,0\n0.5,1,0,0\n", map),
            "log.csv: 0.5 s of data between 0 s and 0.5 s; must be at least 1 s");
  EXPECT_EQ(
      Problems("t,x,y,yaw\n0,3,0,0\n5,3,0,1\n9,3,0,2\n", map),
      "log.csv: the position never changes (x, y): the car stands, or these are other columns");
  EXPECT_EQ(
      Problems("t,x,y,yaw\n0,0,0,0\n1,5,0,0\n2,10,-3e8,0\n3,15,0,0\n", map),
      "log.csv: the positions extend over 300000000 m; must extend over at most 200000 m: the "
      "farthest jump, of 300000000 m, is from (5, 0) at 1 s after the first row to (10, "
      "-3e+08) at 2 s after the first row; is a coordinate wrong?");
  EXPECT_THAT(Problems("t,x,y,yaw\n", map), HasSubstr("0 rows with a pose of 0 in the log"));
  EXPECT_THAT(Problems("t,x,y,yaw\n0,0,0,0\n1e6,1,0,0\n", map),
              HasSubstr("log.csv: 1e+08 samples at 100 per second; must be at most 1e+06"));
  map.yaw.reset();
  EXPECT_EQ(Problems(good, map),
            "yaw: give either yaw or orientation, or heading_from_motion: true if the log has no "
            "heading");
}

constexpr const char* kAnyway = " (check: false in the map imports it anyway)";

/// A weaving car turns to both sides.
std::string Weaving(const std::function<std::string(double t, const Pose2& pose)>& row) {
  std::string csv = "t,x,y,yaw,v,r,steer\n";
  Pose2 pose;
  for (int i = 0; i <= 500; ++i) {
    const double t = 0.02 * i;
    csv += row(t, pose) + "\n";
    pose = MoveOnArc(pose, 2.0 * 0.02, 1.5 * std::sin(t) * 0.02);
  }
  return csv;
}

struct Nonsense {
  const char* name;
  double yaw = 1.0;
  double speed = 1.0;
  double yaw_rate = 1.0;
  double steering = 1.0;
  const char* message;
};

void PrintTo(const Nonsense& wrong, std::ostream* out) {
  *out << wrong.name;
}

class Contradiction : public testing::TestWithParam<Nonsense> {};

TEST_P(Contradiction, IsNoticed) {
  const Nonsense& wrong = GetParam();
  LogMap map = PoseMap();
  map.speed.emplace();
  map.speed->column = "v";
  map.yaw_rate.emplace();
  map.yaw_rate->column = "r";
  map.steering.emplace();
  map.steering->column = "steer";
  const std::string csv = Weaving([&](double t, const Pose2& pose) {
    const double rate = 1.5 * std::sin(t);
    return fmt::format("{},{},{},{},{},{},{}", t, pose.x, pose.y, wrong.yaw * WrapAngle(pose.yaw),
                       wrong.speed * 2.0, wrong.yaw_rate * rate,
                       wrong.steering * std::atan(0.3 * rate / 2.0));
  });
  const std::string expected =
      *wrong.message == '\0' ? "no problem" : fmt::format("log.csv: {}{}", wrong.message, kAnyway);
  EXPECT_EQ(Problems(csv, map), expected);
  map.check = false;
  const RecordedDrive drive = Import(csv, map);
  if (*wrong.message != '\0') {
    EXPECT_THAT(drive.notes, Contains(wrong.message));
  }
}

/// A drive at 1.5 m/s and 100 rows per second whose curvature varies by `bend` [1/m], with noise of
/// 5 mm and 5 mrad; the logged yaw is `factor` times the true one.
std::string NoisyCsv(double bend, double factor) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, 5e-3);
  constexpr double kStep = 0.01;
  std::string csv = "t,x,y,yaw,v,r\n";
  Pose2 pose{};
  for (int i = 0; i < 3000; ++i) {
    const double rate = kSpeed * bend * std::sin(2.0 * kPi * i * kStep / 8.0);
    csv += fmt::format("{},{},{},{},{},{}\n", i * kStep, pose.x + noise(random),
                       pose.y + noise(random), factor * (pose.yaw + noise(random)),
                       kSpeed + noise(random), rate + noise(random));
    pose.x += kStep * kSpeed * std::cos(pose.yaw);
    pose.y += kStep * kSpeed * std::sin(pose.yaw);
    pose.yaw += kStep * rate;
  }
  return csv;
}

TEST(ImportLog, TellsNoiseFromContradictions) {
  // The local polynomials of 0.1 s to either side have accelerations with a deviation of
  // 5 mm sqrt(720/21^5)/(0.01 s)^2 = 0.66 m/s^2, 0.44 rad/s of the course at 1.5 m/s. The drive
  // turns by at most 0.3 rad/s, or by nothing.
  LogMap map = PoseMap();
  map.speed.emplace();
  map.speed->column = "v";
  map.yaw_rate.emplace();
  map.yaw_rate->column = "r";
  EXPECT_EQ(Problems(NoisyCsv(0.2, 1.0), map), "no problem");
  EXPECT_EQ(Problems(NoisyCsv(0.0, 1.0), map), "no problem");
  EXPECT_THAT(Problems(NoisyCsv(0.2, -1.0), map),
              HasSubstr("yaw: the car turns the other way than its path does"));
  EXPECT_THAT(Problems(NoisyCsv(0.2, 0.0), map),
              HasSubstr("yaw: the yaw is constant while the path turns"));
  EXPECT_THAT(Problems(NoisyCsv(0.2, kPi / 180.0), map),
              HasSubstr("yaw: the numbers look like radians that are read as degrees"));
}

constexpr double kDegrees = 180.0 / kPi;

INSTANTIATE_TEST_SUITE_P(
    ImportLog, Contradiction,
    testing::Values(
        Nonsense{.name = "None", .message = ""},
        Nonsense{.name = "YawInDegrees",
                 .yaw = kDegrees,
                 .message = "yaw: the numbers look like degrees that are read as radians: set "
                            "unit: deg"},
        Nonsense{.name = "YawReversed",
                 .yaw = -1.0,
                 .message = "yaw: the car turns the other way than its path does: look at frame, "
                            "and at the order of position.x and position.y, or set scale: -1"},
        Nonsense{.name = "YawConstant",
                 .yaw = 0.0,
                 .message = "yaw: the yaw is constant while the path turns"},
        Nonsense{.name = "SpeedInKmh",
                 .speed = 3.6,
                 .message = "speed: the numbers look like km/h that are read as m/s: set unit: "
                            "km/h"},
        Nonsense{.name = "SpeedTwice",
                 .speed = 2.0,
                 .message = "speed: the column's speed is 2 times that of the position: look at "
                            "the units of both"},
        Nonsense{.name = "YawRateInDegrees",
                 .yaw_rate = kDegrees,
                 .message = "yaw_rate: the numbers look like deg/s that are read as rad/s: set "
                            "unit: deg/s"},
        Nonsense{.name = "YawRateReversed",
                 .yaw_rate = -1.0,
                 .message = "yaw_rate: the column turns the other way than the yaw does: set "
                            "scale: -1, or look at frame"},
        Nonsense{.name = "SteeringReversed",
                 .steering = -1.0,
                 .message = "steering: the car turns the other way than it steers: set scale: -1, "
                            "or look at frame"}),
    [](const auto& test) { return test.param.name; });

TEST(ImportLog, NoticesAndRemovesTheDelayOfASignal) {
  // The gyroscope's filter delays the yaw rate by 0.24 s. Weaving holds the yaw rate over each row
  // of 0.02 s, so that the pose is 0.01 s late, and the yaw rate lags the pose by 0.23 s.
  const std::string csv = Weaving([&](double t, const Pose2& pose) {
    return fmt::format("{},{},{},{},{},{},0", t, pose.x, pose.y, pose.yaw, 2.0,
                       1.5 * std::sin(t - 0.24));
  });
  LogMap map = PoseMap();
  map.yaw_rate.emplace();
  map.yaw_rate->column = "r";
  EXPECT_THAT(Import(csv, map).notes, Contains(testing::ContainsRegex(
                                          "yaw_rate lags the motion of the pose by 0.23[0-9]* s "
                                          "[(]standard error [0-9.e-]+ s[)]: shift it with "
                                          "--align, or set "
                                          "yaw_rate.delay: 0.23")));
  map.align = true;
  const RecordedDrive aligned = Import(csv, map);
  EXPECT_THAT(aligned.notes, Contains(HasSubstr("shifted by this delay")));
  // The program finds the delay to a tenth of its resolution, which is half the distance between
  // two rows. The yaw rate changes by at most 1.5 rad/s^2.
  EXPECT_NEAR(aligned.At(5.0).yaw_rate, 1.5 * std::sin(5.0 - 0.01), Tolerance(1.5 * 0.1 * 0.01));
  map.align = false;
  map.yaw_rate->delay = 0.23;
  for (const std::string& note : Import(csv, map).notes) {
    EXPECT_THAT(note, testing::Not(HasSubstr("yaw_rate lags")));
  }
}

TEST(ImportLog, NotesHowLateTheCarTurns) {
  // The steering is 0.15 s early, and the pose of the helper Weaving is 0.01 s late.
  const std::string csv = Weaving([&](double t, const Pose2& pose) {
    return fmt::format("{},{},{},{},{},{},{}", t, pose.x, pose.y, pose.yaw, 2.0, 0.0,
                       std::atan(0.3 * 1.5 * std::sin(t + 0.15) / 2.0));
  });
  LogMap map = PoseMap();
  map.steering.emplace();
  map.steering->column = "steer";
  EXPECT_THAT(Import(csv, map).notes,
              Contains(testing::ContainsRegex("the yaw rate follows steering by 0.16[0-9]* s")));
}

TEST(ImportLog, NoticesACompassHeading) {
  const std::string csv = PoseCsv(IrregularTimes(6.0, 0.02), [](double t) {
    const Pose2 pose = OnCircle(t);
    return Pose2{pose.x, pose.y, pose.yaw - 0.5 * kPi};
  });
  EXPECT_THAT(
      Problems(csv, PoseMap()),
      HasSubstr("yaw: the car moves 1.52 rad to the left of where it points, all the time"));
}

TEST(ImportLog, NoticesRadiansReadAsDegrees) {
  LogMap map = PoseMap();
  map.yaw->unit = "deg";
  EXPECT_THAT(Problems(PoseCsv(IrregularTimes(6.0, 0.02), OnCircle), map),
              HasSubstr("yaw: the numbers look like radians that are read as degrees"));
}

TEST(ImportLog, ReadsManyRowsInBoundedMemory) {
  // 3e5 rows at 1 kHz are 300 s, read as a stream and resampled to 10 per second.
  LogMap map = PoseMap();
  map.resample = {.rate = 10.0, .half_width = 0.05, .degree = 2};
  std::string csv = "t,x,y,yaw\n";
  for (int i = 0; i <= 300'000; ++i) {
    const Pose2 pose = OnCircle(0.001 * i);
    csv += fmt::format("{:.3f},{:.6f},{:.6f},{:.6f}\n", 0.001 * i, pose.x, pose.y, pose.yaw);
  }
  const RecordedDrive drive = Import(csv, map);
  EXPECT_EQ(drive.samples.size(), 3001U);
  // The poses are rounded to 1e-6, and each window has 100 rows.
  EXPECT_THAT(drive.At(150.0).yaw_rate, DoubleNear(kRate, Tolerance(1e-4)));
}

}  // namespace
}  // namespace trackbed
