#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/support/temp_folder.h"
#include "tests/tolerance.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/path_files/globe.h"
#include "trackbed/path_files/path_file.h"
#include "trackbed/recording/import_log.h"
#include "trackbed/recording/log_listing.h"

// Tests the import of GPS tracks and of bags of ROS 2 by the maps that ListLog proposes, against
// the motion that the files were made from.
namespace trackbed {
namespace import_other_logs_test {

namespace fs = std::filesystem;
using testing::Contains;
using testing::HasSubstr;

const fs::path kBags = fs::path(TRACKBED_SOURCE_DIR) / "tests/data/bags";

constexpr double kRadius = 20.0;
constexpr double kSpeed = 5.0;
constexpr double kRate = kSpeed / kRadius;

TEST(ListLog, ProposesAMapThatReadsABag) {
  for (const char* name : {"odometry.mcap", "autoware.mcap", "sqlite", "sqlite_zstd", "mcap"}) {
    SCOPED_TRACE(name);
    const LogListing listing = ListLog(kBags / name);
    ASSERT_TRUE(listing.map.has_value()) << listing.problem;
    const RecordedDrive drive = ImportLog(kBags / name, *listing.map);
    EXPECT_NEAR(drive.duration(), 2.0, Tolerance(0.05));
    EXPECT_EQ(drive.valid_fraction(), 1.0);
    for (const RecordedSample& sample : drive.samples) {
      const double angle = kRate * sample.time;
      // Over the half width h of its window, a parabola through rows 0.1 s apart deviates from the
      // circle by up to R rate^3 h^3/6 = 1.4 mm. The fit amplifies this deviation by at most 3, the
      // sum of the magnitudes of its weights.
      EXPECT_NEAR(sample.pose.x, kRadius * std::sin(angle), Tolerance(4.2e-3));
      EXPECT_NEAR(sample.pose.y, kRadius * (1.0 - std::cos(angle)), Tolerance(4.2e-3));
      // The yaw, the speed and the yaw rate are linear in time, which parabolas fit exactly.
      EXPECT_NEAR(sample.pose.yaw, angle, Tolerance(1e-9));
      if (listing.map->speed) {
        EXPECT_NEAR(sample.velocity_V.x(), kSpeed, Tolerance(1e-6));
      }
      EXPECT_NEAR(sample.yaw_rate, kRate, Tolerance(1e-6));
    }
  }
}

// The rows at the edges of the window have no weight, so that they cannot determine a parabola.
TEST(ImportLog, UsesFurtherRowsIfThoseAtTheEdgeOfTheWindowHaveNoWeight) {
  for (const double half_width : {0.1, 0.15, 0.2}) {
    LogMap map = *ListLog(kBags / "sqlite").map;
    map.resample = {.rate = 100.0, .half_width = half_width, .degree = 2};
    for (const RecordedSample& sample : ImportLog(kBags / "sqlite", map).samples) {
      // The tolerance is that of ProposesAMapThatReadsABag; the yaw is linear in time.
      EXPECT_NEAR(sample.pose.yaw, kRate * sample.time, Tolerance(1e-6));
      EXPECT_NEAR(sample.pose.x, kRadius * std::sin(kRate * sample.time), Tolerance(4.2e-3));
    }
  }
}

// A circle of 50 m at 10 m/s, behind lines about the session, with a line of units.
TEST(ListLog, ProposesAMapWithTheUnitsOfALogger) {
  const std::filesystem::path log =
      std::filesystem::path(TRACKBED_SOURCE_DIR) / "tests/data/recordings/logger.csv";
  const LogListing listing = ListLog(log);
  ASSERT_TRUE(listing.map) << listing.problem;
  EXPECT_EQ(listing.map->time.column, "Time [s]");
  EXPECT_EQ(listing.map->speed->column, "GPS Speed [km/h]");
  EXPECT_EQ(listing.map->speed->unit, "km/h");
  for (const RecordedSample& sample : ImportLog(log, *listing.map).samples) {
    // 36.0 km/h in all rows, and polynomials reproduce constants.
    EXPECT_NEAR(sample.velocity_V.x(), 10.0, Tolerance(1e-9));
  }
}

// The same drive along x at 10 m/s, in the units and names of other programs.
TEST(ListLog, ReadsUnitsAndPosesFromNames) {
  struct Table {
    const char* names;
    double time;      // units of time in a second
    double position;  // units of length in a meter
    double speed;     // units of speed in a meter per second
  };
  for (const Table& table : {Table{"timestamp_ms,pos_x,pos_y,velocity_kph", 1e3, 1.0, 3.6},
                             Table{"stamp_us,px,py,v_kmh", 1e6, 1.0, 3.6},
                             Table{"t,East,North,speed_mph", 1.0, 1.0, 2.2369363},
                             Table{"Time [s],PosX [m],PosY [m],Ground Speed [km/h]", 1.0, 1.0, 3.6},
                             Table{"time_s,x_cm,y_cm,speed_ms", 1.0, 100.0, 1.0},
                             Table{"time,waypoint_x,waypoint_y,speed km/h", 1.0, 1.0, 3.6},
                             Table{"Time(sec),xPos,yPos,Velocity (KPH)", 1.0, 1.0, 3.6},
                             Table{"Time,Car.tx,Car.ty,Car.v", 1.0, 1.0, 1.0},
                             Table{"Time [s],Xcg_TM [m],Ycg_TM [m],Vx [km/h]", 1.0, 1.0, 3.6},
                             // Units of time that no name states.
                             Table{"timestamp,x,y,speed_mps", 1e3, 1.0, 1.0},
                             Table{"timestamp,x,y,speed_mps", 1e6, 1.0, 1.0},
                             Table{"time,x_mm,y_mm,speed_mps", 1e9, 1000.0, 1.0}}) {
    SCOPED_TRACE(table.names);
    const TempFolder folder;
    std::string text = std::string(table.names) + "\n";
    for (int i = 0; i <= 50; ++i) {
      const double t = 0.1 * i;
      text += fmt::format("{:.9g},{:.9g},0,{:.9g}\n", t * table.time, 10.0 * t * table.position,
                          10.0 * table.speed);
    }
    const fs::path log = folder.Write("log.csv", text);
    const LogListing listing = ListLog(log);
    ASSERT_TRUE(listing.map) << listing.problem;
    ASSERT_TRUE(listing.map->speed);
    const RecordedDrive drive = ImportLog(log, *listing.map);
    EXPECT_NEAR(drive.duration(), 5.0, Tolerance(1e-6));
    EXPECT_NEAR(drive.samples.back().pose.x, 50.0, Tolerance(1e-6));
    for (const RecordedSample& sample : drive.samples) {
      // Polynomials reproduce constants; the factor of mph has eight digits.
      EXPECT_NEAR(sample.velocity_V.x(), 10.0, Tolerance(1e-6));
    }
  }
  const TempFolder folder;
  const LogListing two =
      ListLog(folder.Write("log.csv", "t,map_x,map_y,odom_x,odom_y\n0,1,2,3,4\n"));
  EXPECT_FALSE(two.map);
  // A velocity beside vy may be one along the axes of the world.
  const LogListing world = ListLog(folder.Write("log.csv", "t,x,y,vx,vy\n0,1,2,3,4\n1,4,6,3,4\n"));
  ASSERT_TRUE(world.map);
  EXPECT_FALSE(world.map->speed);
  EXPECT_THAT(two.problem, HasSubstr("several columns for x: map_x, odom_x"));
}

// Drives with slow rows or a long stop at the start, whose names state no unit of time.
TEST(ListLog, ProposesUnitsOfTimeOnlyForSpeedsOfCars) {
  const TempFolder folder;
  const auto unit_of = [&](const std::string& rows) {
    const LogListing listing = ListLog(folder.Write("log.csv", "time,x,y\n" + rows));
    return listing.map ? listing.map->time.unit : listing.problem;
  };
  // 15 m/s with rows 60 s apart. In ms, the speed would be 15 km/s.
  EXPECT_EQ(unit_of("0,0,0\n60,900,0\n120,1800,0\n180,2700,0\n"), "s");
  // Timestamps are always in seconds. In ms, the speed would be 15 km/s here, and 10 m/s below.
  EXPECT_EQ(unit_of("2024-05-01T12:00:00Z,0,0\n2024-05-01T12:01:00Z,900,0\n"), "s");
  EXPECT_EQ(unit_of("2024-05-01T12:00:00Z,0,0\n2024-05-01T12:01:00Z,0.6,0\n"), "s");
  // 120 s at rest, then 10 s at 10 m/s, in rows 10 ms apart.
  std::string rows;
  for (int i = 0; i <= 13'000; ++i) {
    rows += fmt::format("{},{},0\n", 10 * i, 0.1 * std::max(0, i - 12'000));
  }
  EXPECT_EQ(unit_of(rows), "ms");
}

// A drive at 10 m/s to the north, with the times of the day and the dates of other programs.
TEST(ListLog, ReadsTimesOfTheDay) {
  for (const char* time : {"{:02}:59:{:02}.{}", "01-May-2024 {:02}:59:{:02}.{}"}) {
    SCOPED_TRACE(time);
    const TempFolder folder;
    std::string text = "TIME,LATITUDE,LONGITUDE,SPEED_KPH\n";
    for (int i = 0; i <= 50; ++i) {
      text += fmt::format(fmt::runtime(time), 9, 50 + i / 10, i % 10) +
              fmt::format(",{:.9f},11.5,36\n", 48.0 + 1e-5 * i);
    }
    const fs::path log = folder.Write("log.csv", text);
    const LogListing listing = ListLog(log);
    ASSERT_TRUE(listing.map) << listing.problem;
    const RecordedDrive drive = ImportLog(log, *listing.map);
    EXPECT_NEAR(drive.duration(), 5.0, Tolerance(1e-6));
    EXPECT_NEAR(drive.samples.front().velocity_V.x(), 10.0, Tolerance(1e-6));
  }
}

TEST(ListLog, SaysHowManyTimesAFileOfPositionsHas) {
  const TempFolder folder;
  const std::string timed = "<trkpt lat='52' lon='9'><time>2024-01-01T00:00:00Z</time></trkpt>";
  const auto problem = [&](const std::string& points) {
    const LogListing listing = ListLog(folder.Write(
        "log.gpx", "<gpx version='1.1'><trk><trkseg>" + points + "</trkseg></trk></gpx>"));
    EXPECT_FALSE(listing.map);
    return listing.problem;
  };
  EXPECT_EQ(problem(timed), "1 point; a recording has at least 2");
  EXPECT_THAT(problem(timed + "<trkpt lat='52.1' lon='9'/>"),
              HasSubstr("1 of 2 points has a time"));
  EXPECT_THAT(problem("<trkpt lat='52' lon='9'/><trkpt lat='52.1' lon='9'/>"),
              HasSubstr("the file has no times, so the file is a path"));
}

// To the east at 10 m/s along the parallel of 52 degrees, over midnight.
TEST(ListLog, ProposesAMapThatReadsAVboFile) {
  const TempFolder folder;
  std::string text =
      "[header]\nsatellites\ntime\nlatitude\nlongitude\nvelocity kmh\n\n[column names]\nsats time "
      "lat long velocity\n\n[data]\n";
  // Radius of the parallel on the ellipsoid of WGS 84: a cos(lat) / sqrt(1 - (e sin(lat))^2).
  const double latitude = 52.0 * kPi / 180.0;
  const double radius = 6378137.0 * std::cos(latitude) /
                        std::sqrt(1.0 - 0.00669437999014 * std::pow(std::sin(latitude), 2.0));
  for (int i = 0; i < 40; ++i) {
    const double minutes = -60.0 - 0.5 * i / radius * 180.0 / kPi * 60.0;
    text += fmt::format("009 {} +03120.00000000 {:+015.8f} 036.000\n",
                        i < 20 ? fmt::format("2359{:05.2f}", 59.0 + 0.05 * i)
                               : fmt::format("0000{:05.2f}", 0.05 * (i - 20)),
                        minutes);
  }
  const std::filesystem::path log = folder.Write("drive.vbo", text);
  const LogListing listing = ListLog(log);
  ASSERT_TRUE(listing.map) << listing.problem;
  EXPECT_EQ(listing.map->speed->unit, "km/h");
  const RecordedDrive drive = ImportLog(log, *listing.map);
  EXPECT_NEAR(drive.duration(), 39 * 0.05, Tolerance(0.03));
  for (const RecordedSample& sample : drive.samples) {
    EXPECT_NEAR(sample.velocity_V.x(), 10.0, Tolerance(1e-9));
    // Minutes have 8 decimals, 1e-5 m here, in rows 0.5 m apart. The parallel bends away from the
    // east by less than x tan(lat) / radius = 1e-5 rad.
    EXPECT_NEAR(sample.pose.yaw, 0.0, Tolerance(1e-4));
    EXPECT_NEAR(sample.pose.x, 10.0 * sample.time, Tolerance(1e-3));
  }
}

TEST(ListLog, ReadsPosesOfRostopic) {
  const TempFolder folder;
  std::string text =
      "%time,field.header.seq,field.pose.pose.position.x,field.pose.pose.position.y,"
      "field.pose.pose.orientation.x,field.pose.pose.orientation.y,field.pose.pose.orientation.z,"
      "field.pose.pose.orientation.w,field.twist.twist.linear.x\n";
  for (int i = 0; i < 40; ++i) {
    // Straight on at 2 m/s to the north: a yaw of pi/2.
    text += fmt::format("{},{},0,{},0,0,{},{},2\n", 1'600'000'000'000'000'000LL + i * 50'000'000LL,
                        i, 0.1 * i, std::sin(kPi / 4.0), std::cos(kPi / 4.0));
  }
  const std::filesystem::path log = folder.Write("odom.csv", text);
  const LogListing listing = ListLog(log);
  ASSERT_TRUE(listing.map) << listing.problem;
  EXPECT_EQ(listing.map->time.unit, "ns");
  for (const RecordedSample& sample : ImportLog(log, *listing.map).samples) {
    EXPECT_NEAR(sample.pose.yaw, kPi / 2.0, Tolerance(1e-9));
  }
}

TEST(ListLog, FindsSteeringAndCommands) {
  const RecordedDrive odometry =
      ImportLog(kBags / "odometry.mcap", *ListLog(kBags / "odometry.mcap").map);
  EXPECT_FALSE(odometry.has_steering);
  // Commands with 32 bits have an error of half a unit in the last place, which is 2^-28 for these
  // values.
  EXPECT_NEAR(odometry.samples[3].steering_command, 0.12, Tolerance(4e-9));
  const RecordedDrive autoware =
      ImportLog(kBags / "autoware.mcap", *ListLog(kBags / "autoware.mcap").map);
  EXPECT_NEAR(autoware.samples[3].steering, 0.1, Tolerance(4e-9));
  EXPECT_NEAR(autoware.samples[3].steering_command, 0.12, Tolerance(4e-9));
  EXPECT_EQ(autoware.samples[3].throttle, 0.25);
}

TEST(ImportLog, SaysWhatIsWrongWithTheColumnsOfABag) {
  const auto error = [](const std::function<void(LogMap&)>& change) -> std::string {
    LogMap map = *ListLog(kBags / "odometry.mcap").map;
    change(map);
    try {
      ImportLog(kBags / "odometry.mcap", map);
      return "no error";
    } catch (const InputError& problem) {
      return problem.what();
    }
  };
  EXPECT_THAT(error([](LogMap& map) { map.position.x = "x"; }), HasSubstr("names no topic"));
  EXPECT_THAT(error([](LogMap& map) { map.position.y = "/drive.drive.speed"; }),
              HasSubstr("not a column of the topic of the position, /odom"));
  EXPECT_THAT(error([](LogMap& map) { map.speed->column = "/odom.twist.twist.linear.xx"; }),
              HasSubstr("twist.twist.linear.x'?"));
  EXPECT_THAT(error([](LogMap& map) { map.speed->column = "/drives.drive.speed"; }),
              HasSubstr("no topic '/drives'; did you mean '/drive'?"));
}

TEST(ReadPathFile, ReadsAPathOfABag) {
  const PathFile path = ReadPathFile(kBags / "odometry.mcap");
  ASSERT_EQ(path.points.points.size(), 12U);
  EXPECT_NEAR(path.points.points[4].x(), kRadius * std::sin(kRate * 0.8), Tolerance(1e-14));
  EXPECT_NEAR(path.points.yaw[4], kRate * 0.8, Tolerance(1e-14));
  PathMap map;
  map.topic = "/odom";
  EXPECT_EQ(ReadPathFile(kBags / "odometry.mcap", map).points.points.size(), 21U);
  map.topic = "/odo";
  EXPECT_THROW(ReadPathFile(kBags / "odometry.mcap", map), InputError);
}

/// Returns GPS rows at 1 Hz for a drive at 5 m/s along a circle through the origin of a plane at
/// latitude 48.1, longitude 11.5. Newton's method on the projection computes the degrees.
std::string Fixes(const char* row) {
  const LocalPlane plane({48.1, 11.5});
  std::string rows;
  for (int second = 0; second <= 30; ++second) {
    const double angle = kRate * 0.2 * second;
    const Vec2 wanted(5.0 * kRadius * std::sin(angle), 5.0 * kRadius * (1.0 - std::cos(angle)));
    GlobePosition at{48.1, 11.5};
    for (int i = 0; i < 10; ++i) {
      const Vec2 error = wanted - *plane.ToMeters(at);
      at.latitude += error.y() / 111'000.0;
      at.longitude += error.x() / 74'000.0;
    }
    rows += fmt::format(fmt::runtime(row), at.latitude, at.longitude, second);
  }
  return rows;
}

void ExpectCircle(const fs::path& log, const LogMap& map) {
  const RecordedDrive drive = ImportLog(log, map);
  EXPECT_NEAR(drive.duration(), 30.0, Tolerance(0.1));
  EXPECT_EQ(drive.valid_fraction(), 1.0);
  for (const RecordedSample& sample : drive.samples) {
    const double angle = 0.2 * kRate * sample.time;  // radius 100 m
    // At an end, the half width h of the window is up to 2 s. The deviation R rate^3 h^3/6 is then
    // 17 mm, which the fit amplifies by up to 3.
    EXPECT_NEAR(sample.pose.x, 100.0 * std::sin(angle), Tolerance(0.05));
    EXPECT_NEAR(sample.pose.y, 100.0 * (1.0 - std::cos(angle)), Tolerance(0.05));
    // The error of a slope is twice the error of a value divided by h, which is 0.05 m/s for a
    // speed of 5 m/s.
    EXPECT_NEAR(AngleDifference(sample.pose.yaw, angle), 0.0, Tolerance(0.02));
  }
  EXPECT_THAT(drive.notes, Contains(HasSubstr("UTM zone 32N")));
  EXPECT_THAT(drive.notes, Contains(HasSubstr("the yaw is the direction of motion")));
}

TEST(ImportLog, ReadsGpsTracks) {
  const TempFolder folder;
  const fs::path gpx = folder.Write(
      "ride.gpx",
      "<gpx><trk><trkseg><trkpt lat='0' lon='0'><time>2024-04-30T23:59:50Z</time></trkpt>" +
          Fixes("<trkpt lat='{:.10f}' lon='{:.10f}'><time>2024-05-01T00:00:{:02d}Z</time>"
                "</trkpt>") +
          "</trkseg></trk></gpx>");
  const LogListing listing = ListLog(gpx);
  ASSERT_TRUE(listing.map.has_value()) << listing.problem;
  ExpectCircle(gpx, *listing.map);
  EXPECT_THAT(ImportLog(gpx, *listing.map).notes, Contains(HasSubstr("1 position skipped")));
  const fs::path csv = folder.Write(
      "ride.csv", "time;GPS Latitude;GPS Longitude\n" + [] {
        std::string rows = Fixes("2024-05-01T00:00:{2:02d}+00:00;{0:.10f};{1:.10f}\n");
        return rows;
      }());
  const LogListing of_csv = ListLog(csv);
  ASSERT_TRUE(of_csv.map.has_value()) << of_csv.problem;
  ExpectCircle(csv, *of_csv.map);
}

TEST(ImportLog, RefusesDegreesAsMeters) {
  const auto error = [](const std::function<void(LogMap&)>& change) -> std::string {
    LogMap map;
    map.name = "log";
    map.time.column = "t";
    map.heading_from_motion = true;
    map.position = {.x = "lon", .y = "lat"};
    change(map);
    const TempFolder folder;
    try {
      ImportLog(folder.Write("log.csv", "t,lat,lon\n0,48.1,11.5\n1,48.1001,11.5\n2,48.1002,11.5\n"),
                map);
      return "no error";
    } catch (const InputError& problem) {
      return problem.what();
    }
  };
  EXPECT_THAT(error([](LogMap&) {}),
              HasSubstr("position.x: 'lon' is in degrees, which are not meters"));
  EXPECT_THAT(error([](LogMap& map) { map.position = {.latitude = "lon", .longitude = "lat"}; }),
              HasSubstr("swap position.latitude and position.longitude"));
  EXPECT_THAT(error([](LogMap& map) {
                map.position = {.latitude = "lat", .longitude = "lon", .unit = "m"};
              }),
              HasSubstr("not a unit of latitude and longitude"));
  EXPECT_THAT(error([](LogMap& map) { map.position = {.latitude = "lat", .longitude = "lon"}; }),
              HasSubstr("set gap: 3 "));
  EXPECT_THAT(error([](LogMap& map) {
                map.position = {.latitude = "lat", .longitude = "lon"};
                map.gap = 3.0;
              }),
              testing::StartsWith("no error"));
}

TEST(ImportLog, RefusesHemispheresInColumnsOfTheirOwn) {
  LogMap map;
  map.name = "log";
  map.time.column = "t";
  map.heading_from_motion = true;
  map.position = {.latitude = "lat", .longitude = "lon"};
  map.gap = 3.0;
  const TempFolder folder;
  const fs::path log = folder.Write(
      "log.csv", "t,lat,N/S,lon,E/W\n0,33.9,S,18.4,E\n1,33.9001,S,18.4,E\n2,33.9002,S,18.4,E\n");
  try {
    ImportLog(log, map);
    ADD_FAILURE() << "no error";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("log.csv:2: N/S: 'S' beside a positive latitude; write "
                                        "southern latitudes as negative numbers"));
  }
}

}  // namespace import_other_logs_test
}  // namespace trackbed
