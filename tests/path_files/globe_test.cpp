#include "trackbed/path_files/globe.h"

#include <geodesic.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "tests/support/temp_folder.h"
#include "tests/tolerance.h"
#include "trackbed/core/error.h"
#include "trackbed/core/timestamp.h"
#include "trackbed/path_files/globe_names.h"
#include "trackbed/path_files/path_file.h"

// Tests positions on the globe: the projection against geodesics (Karney 2013, in geodesic.h), the
// names of columns, GPX, KML, GeoJSON and CSV files of the same path, and refusals.
namespace trackbed {
namespace globe_test {

using testing::AllOf;
using testing::HasSubstr;

geod_geodesic Wgs84() {
  geod_geodesic ellipsoid;
  geod_init(&ellipsoid, 6378137.0, 1.0 / 298.257223563);
  return ellipsoid;
}

PathFile ReadText(const std::string& name, const std::string& text, const PathMap& map = {}) {
  const TempFolder folder;
  return ReadPathFile(folder.Write(name, text), map);
}

std::string ErrorOf(const std::string& name, const std::string& text, const PathMap& map = {}) {
  try {
    return "no error, " + ReadText(name, text, map).notes.front();
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(LocalPlane, KeepsGeodesicDistances) {
  const geod_geodesic ellipsoid = Wgs84();
  std::mt19937 random(1);
  std::uniform_real_distribution<double> latitude(-88.0, 88.0);
  std::uniform_real_distribution<double> longitude(-180.0, 180.0);
  std::uniform_real_distribution<double> azimuth(-180.0, 180.0);
  std::uniform_real_distribution<double> length(10.0, 10e3);
  for (int i = 0; i < 2000; ++i) {
    const GlobePosition origin{latitude(random), longitude(random)};
    const double distance = length(random);
    GlobePosition end;
    geod_direct(&ellipsoid, origin.latitude, origin.longitude, azimuth(random), distance,
                &end.latitude, &end.longitude, nullptr);
    if (std::abs(end.latitude) > kMaxLatitude) {
      continue;
    }
    const auto point = LocalPlane(origin).ToMeters(end);
    ASSERT_TRUE(point.has_value());
    // The scale of a transverse Mercator projection is 1 + x^2/(2 R^2), with a radius R of at least
    // 6335 km. The mean scale error over the line is between 0 and a third of the scale error at
    // the end. PROJ computes to 1 um.
    const double scale = 0.5 * std::pow(point->x() / 6.335e6, 2.0);
    EXPECT_NEAR(point->norm(), distance, Tolerance(distance * scale + 1e-6));
  }
}

TEST(LocalPlane, PointsEastAndNorthAlsoAcrossTheAntimeridian) {
  const geod_geodesic ellipsoid = Wgs84();
  for (const double longitude : {11.0, 179.9999, -179.9999, 180.0, 359.9999, 0.0}) {
    const GlobePosition origin{-17.0, longitude};
    for (const double azimuth : {0.0, 90.0}) {
      double y = 0.0;
      double x = 0.0;
      geod_direct(&ellipsoid, origin.latitude, origin.longitude, azimuth, 100.0, &y, &x, nullptr);
      const Vec2 point = LocalPlane(origin).ToMeters({y, x}).value();
      // A geodesic to the east leaves the x axis by s^2 tan(latitude)/(2 R), 0.25 mm.
      EXPECT_NEAR(point.x(), azimuth == 90.0 ? 100.0 : 0.0, Tolerance(3e-4));
      EXPECT_NEAR(point.y(), azimuth == 0.0 ? 100.0 : 0.0, Tolerance(3e-4));
    }
  }
}

// The coordinates are an example in the manual of GeographicLib's GeoConvert: the point 33.3 N,
// 44.4 E is at 38N 444140.54 3684706.36 in UTM.
TEST(LocalPlane, StatesTheUtmZoneOfItsOrigin) {
  EXPECT_THAT(LocalPlane({33.3, 44.4}).Note(1000.0),
              AllOf(HasSubstr("latitude 33.3, longitude 44.4"), HasSubstr("UTM zone 38N"),
                    HasSubstr("EPSG:32638"), HasSubstr("444140.54"), HasSubstr("3684706.3"),
                    HasSubstr("scale error at most 1.2e-08")));
  EXPECT_THAT(LocalPlane({60.4, 5.3}).Note(0.0), HasSubstr("UTM zone 32N"));
  EXPECT_THAT(LocalPlane({-33.9, 151.2}).Note(0.0), HasSubstr("UTM zone 56S (EPSG:32756)"));
  EXPECT_THAT(LocalPlane({-17.0, 180.0}).Note(0.0), HasSubstr("UTM zone"));
}

TEST(GlobeColumns, AreFoundByName) {
  for (const char* name :
       {"lat", "Lat", "LATITUDE", "latitude_deg", "lat_deg", "Latitude (deg)", "GPS Latitude",
        "gpsLatitude", "GPSLatitude", "gps_lat", "gpslat", "position_lat", "lat [deg]", "latDeg",
        "field.latitude", "gnss_0_lat", "Latitude[\xC2\xB0]"}) {
    const auto column = GlobeColumnOf(name);
    ASSERT_TRUE(column.has_value()) << name;
    EXPECT_EQ(column->axis, GlobeAxis::kLatitude) << name;
    EXPECT_EQ(column->degrees, 1.0) << name;
  }
  for (const char* name : {"lon", "lng", "Long", "longitude", "longitude_deg", "GPS_Lng",
                           "position_long", "LongitudeDeg"}) {
    const auto column = GlobeColumnOf(name);
    ASSERT_TRUE(column.has_value()) << name;
    EXPECT_EQ(column->axis, GlobeAxis::kLongitude) << name;
  }
  EXPECT_EQ(GlobeColumnOf("latitudeE7")->degrees, 1e-7);
  EXPECT_NEAR(GlobeColumnOf("lat_rad")->degrees, 57.29577951308232, Tolerance(1e-12));
  for (const char* name : {"x", "lateral", "longitudinal", "lat_acc", "lat_error_m", "flat",
                           "plateau", "altitude", "lat_long", "elongation"}) {
    EXPECT_FALSE(GlobeColumnOf(name).has_value()) << name;
  }
}

TEST(GlobeFiles, OfEveryFormatGiveTheSamePath) {
  const std::vector<std::pair<std::string, std::string>> files{
      {"p.csv", "time,lat,lon\n0,48.1,11.5\n1,48.1001,11.5001\n2,48.1002,11.5003\n"},
      {"p.csv",
       "timestamp,lat,lon\n2024-05-01T12:00:00Z,48.1,11.5\n2024-05-01 12:00:01Z,48.1001,11.5001\n"
       "2024-05-01T12:00:02Z,48.1002,11.5003\n"},
      {"p.csv", "lng;t_s;Latitude\n11.5;0;48.1\n11.5001;1;48.1001\n11.5003;2;48.1002\n"},
      {"p.csv",
       "t,lat_e7,lon_e7\n0,481000000,115000000\n1,481001000,115001000\n"
       "2,481002000,115003000\n"},
      {"p.gpx",
       "<gpx><trk><trkseg><trkpt lat='48.1' lon='11.5'><ele>500</ele><time>2024-05-01T12:00:00Z"
       "</time></trkpt></trkseg><trkseg><trkpt lat='48.1001' "
       "lon='11.5001'><time>2024-05-01T12:00:01Z</time></trkpt>"
       "<trkpt lat='48.1002' lon='11.5003'><time>2024-05-01T14:00:02+02:00</time>"
       "</trkpt></trkseg></trk></gpx>"},
      {"p.gpx",
       "<?xml version='1.0'?><gpx xmlns='http://www.topografix.com/GPX/1/1'><wpt lat='1' lon='2'/>"
       "<rte><rtept lat='48.1' lon='11.5'/><rtept lat='48.1001' lon='11.5001'/>"
       "<rtept lat='48.1002' lon='11.5003'/></rte></gpx>"},
      {"p.kml",
       "<kml><Document><Folder><Placemark><name>a</name><LineString><coordinates>\n11.5,48.1,0 "
       "11.5001,48.1001,0\n 11.5003,48.1002\n</coordinates></LineString></Placemark></Folder>"
       "</Document></kml>"},
      {"p.kml",
       "<kml><Placemark><gx:Track><when>2024-05-01T12:00:00Z</when><when>2024-05-01T12:00:01Z"
       "</when><when>2024-05-01T12:00:02Z</when><gx:coord>11.5 48.1 0</gx:coord>"
       "<gx:coord>11.5001 48.1001 0</gx:coord><gx:coord>11.5003 48.1002 0</gx:coord></gx:Track>"
       "</Placemark></kml>"},
      {"p.geojson",
       "{\"type\":\"LineString\",\"coordinates\":[[11.5,48.1],[11.5001,48.1001],[11.5003,48.1002]]"
       "}"}};
  const std::vector<Vec2> expected = ReadText("p.geojson", files.back().second).points.points;
  const geod_geodesic ellipsoid = Wgs84();
  double distance = 0.0;
  geod_inverse(&ellipsoid, 48.1, 11.5, 48.1002, 11.5003, &distance, nullptr, nullptr);
  EXPECT_NEAR(expected[2].norm(), distance, Tolerance(1e-6));
  for (const auto& [name, text] : files) {
    const PathFile found = ReadText(name, text);
    ASSERT_EQ(found.points.points.size(), 3U) << text;
    for (std::size_t i = 0; i < 3; ++i) {
      // A change of the longitude by 1e-13 degrees is a distance of 1e-8 m.
      EXPECT_NEAR((found.points.points[i] - expected[i]).norm(), 0.0, Tolerance(1e-7)) << text;
    }
    EXPECT_THAT(testing::PrintToString(found.notes), HasSubstr("UTM zone 32N")) << text;
    const bool has_times = text.find("12:00:01") != std::string::npos || name == "p.csv";
    EXPECT_EQ(found.points.speed.size(), has_times ? 3U : 0U) << text;
  }
}

TEST(GlobeFiles, StartWhereTheOriginOfTheMapSays) {
  PathMap map;
  map.origin_latitude = 48.0;
  map.origin_longitude = 11.5;
  const Vec2 point = ReadText("p.csv", "lat,lon\n48.1,11.5\n48.1001,11.5\n", map).points.points[0];
  double distance = 0.0;
  const geod_geodesic ellipsoid = Wgs84();
  geod_inverse(&ellipsoid, 48.0, 11.5, 48.1, 11.5, &distance, nullptr, nullptr);
  EXPECT_NEAR(point.x(), 0.0, Tolerance(1e-6));
  EXPECT_NEAR(point.y(), distance, Tolerance(1e-6));
}

TEST(GlobeFiles, RefuseDegreesAsMeters) {
  const std::string csv = "lat,lon,v\n48.1,11.5,1\n48.1001,11.5,1\n";
  PathMap map;
  map.columns.x = "lon";
  map.columns.y = "lat";
  EXPECT_THAT(ErrorOf("p.csv", csv, map),
              AllOf(HasSubstr("columns.x: 'lon' is in degrees"), HasSubstr("columns.longitude")));
  PathMap swapped;
  swapped.columns.latitude = "lon";
  swapped.columns.longitude = "lat";
  EXPECT_THAT(ErrorOf("p.csv", csv, swapped), HasSubstr("swap columns.latitude"));
  PathMap unit;
  unit.columns.x = "a";
  unit.columns.y = "b";
  unit.columns.position_unit = "deg";
  EXPECT_THAT(ErrorOf("p.csv", "a,b\n1,2\n", unit), HasSubstr("columns.latitude"));
  EXPECT_THAT(ErrorOf("p.csv", "lat_start,lon_start\n1,2\n3,4\n"), HasSubstr("columns.latitude"));
}

TEST(GlobeFiles, NameTheCauseAndTheRemedy) {
  const std::vector<std::pair<std::string, std::string>> cells{
      {"37.7,-122.4", "no error"},
      {"-122.4,37.7", "latitude and longitude are swapped (latitude 37.7, longitude -122.4)"},
      {"4807.038,1131.324",
       "NMEA 0183 (ddmm.mmmm); write decimal degrees, latitude 48.1173, "
       "longitude 11.5220"},
      {"481000000,115000000", "end the names of the columns with _e7"},
      {"5334785.2,691603.1", "if these are meters, name the columns x_m and y_m"},
      {"89.5,11", "too close to a pole"},
      {"nan,11", "not a finite number"},
      {"48°07'30\"N,11.5", "a quote within a cell, as in 48°07'30\"; write decimal numbers"},
      {"\"48°07'30\"\"N\",11.5", "is not in decimal degrees; write 48.125"},
      {"48.5 S,11.5", "is not in decimal degrees; write -48.5"},
      {"\"48,1\",\"11,5\"", "has a decimal comma; write 48.1"}};
  for (const auto& [cell, expected] : cells) {
    EXPECT_THAT(ErrorOf("p.csv", "lat,lon\n" + cell + "\n" + cell + "\n"), HasSubstr(expected))
        << cell;
  }
  EXPECT_THAT(ErrorOf("p.csv", "lat,N/S,lon,E/W\n33.9,S,18.4,E\n33.8,S,18.4,E\n"),
              HasSubstr("p.csv:2: N/S: 'S' beside the latitude 33.9; write southern latitudes"));
  EXPECT_THAT(ErrorOf("p.kml",
                      "<kml><LineString><coordinates>48.1, 11.5</coordinates></LineString>"
                      "</kml>"),
              HasSubstr("tuple"));
  EXPECT_THAT(ErrorOf("p.kmz", std::string("PK\x03\x04zip")), HasSubstr("unzip"));
  EXPECT_THAT(ErrorOf("p.gpx", "<gpx><wpt lat='1' lon='2'/></gpx>"),
              HasSubstr("has no line: no trk with trkpt, no rte, but 1 single point,"));
  const std::string point =
      "<Placemark><Point><coordinates>11,48</coordinates></Point></Placemark>";
  EXPECT_THAT(
      ErrorOf("p.kml", "<kml><Document>" + point + point + "</Document></kml>"),
      HasSubstr("no gx:Track, but 2 single points, whose order need not be that of driving"));
  EXPECT_THAT(
      ErrorOf(
          "p.geojson",
          R"({"type":"FeatureCollection","features":[{"type":"Feature","geometry":{"type":)"
          R"("Point","coordinates":[11,48]}},{"type":"Feature","geometry":{"type":"MultiPoint",)"
          R"("coordinates":[[11,48],[11,49]]}},{"type":"Feature","geometry":null}]})"),
      HasSubstr("no LineString, but 3 single points"));
  EXPECT_THAT(ErrorOf("p.kml", "<kml><Document/></kml>"), HasSubstr("no LineString, no gx:Track"));
  EXPECT_THAT(ErrorOf("p.gpx", "<gpx>\n<rte>\n<rtept lat='x' lon='2'/></rte></gpx>"),
              HasSubstr("p.gpx:3: lat: 'x' is not a finite number"));
}

// Programs write GPX in one line, too. Then the number of the line tells nothing about a point.
TEST(GlobeFiles, KnowTheLinesOfPointsUnlessPointsShareALine) {
  const std::string first = "<gpx><trk><trkseg><trkpt lat=\"50\" lon=\"8\"/>";
  const std::string rest = "<trkpt lat=\"50.001\" lon=\"8\"/></trkseg></trk></gpx>";
  EXPECT_EQ(ReadText("p.gpx", first + "\n" + rest).points.lines, (std::vector<int>{1, 2}));
  EXPECT_TRUE(ReadText("p.gpx", first + rest).points.lines.empty());
}

TEST(GlobeFiles, SkipPositionsWithoutAFix) {
  const PathFile found =
      ReadText("p.csv", "lat,lon,v\n0,0,0\n48.1,11.5,2\n0,0,0\n48.1001,11.5,3\n");
  ASSERT_EQ(found.points.points.size(), 2U);
  EXPECT_EQ(found.points.speed, (std::vector<double>{2.0, 3.0}));
  EXPECT_EQ(found.points.lines, (std::vector<int>{3, 5}));
  EXPECT_THAT(testing::PrintToString(found.notes), HasSubstr("2 positions skipped"));
  EXPECT_EQ(ReadText("p.csv", "lat,lon\n0,0\n0,0.0001\n").points.points.size(), 2U);
}

TEST(GlobeFiles, AskWhichLine) {
  const std::string far =
      "<gpx><trk><name>Ride</name><trkseg><trkpt lat='48.1' lon='11.5'/><trkpt lat='48.1001' "
      "lon='11.5'/></trkseg><trkseg><trkpt lat='48.2' lon='11.5'/><trkpt lat='48.2003' "
      "lon='11.5'/></trkseg></trk></gpx>";
  EXPECT_THAT(ErrorOf("p.gpx", far), AllOf(HasSubstr("2 lines"), HasSubstr("line: 1"),
                                           HasSubstr("track 1 (Ride), segment "
                                                     "2, 2 points, 33.36 m")));
  PathMap map;
  map.line = 2;
  EXPECT_NEAR(ReadText("p.gpx", far, map).points.points[1].y(), 33.36, Tolerance(0.1));
  map.line = 3;
  EXPECT_THAT(ErrorOf("p.gpx", far, map), HasSubstr("3 is not in the file, which has 2"));
}

TEST(Timestamps, AreSecondsSince1970) {
  EXPECT_EQ(TimestampSeconds("1970-01-01T00:00:00Z"), 0.0);
  EXPECT_EQ(TimestampSeconds("2024-02-29T12:30:15Z"), 1709209815.0);
  EXPECT_EQ(TimestampSeconds("2024-02-29 14:30:15.25+02:00"), 1709209815.25);
  EXPECT_EQ(TimestampSeconds("2024-02-29T12:30"), 1709209800.0);
  EXPECT_EQ(TimestampSeconds("29-Feb-2024 12:30:15"), 1709209815.0);
  EXPECT_EQ(TimestampOrTimeOfDay("12:30:15.25"), 45015.25);
  EXPECT_EQ(TimestampOrTimeOfDay("9:30:15"), 34215.0);
  EXPECT_EQ(TimestampOrTimeOfDay("2024-02-29T12:30:15Z"), 1709209815.0);
  EXPECT_FALSE(TimestampSeconds("12:30:15.25").has_value());
  for (const char* text : {"", "12:30", "2023-02-29T00:00:00Z", "2024-02-29",
                           "2024-13-01T00:00:00Z", "2024-02-29T12:30:15Zx", "29-Feb-24 12:30:15",
                           "29-feb-2024 12:30:15", "31-Feb-2024 12:30:15", "12:30:15Z", "12:61:15",
                           ":30:15", "2024-02-29T25:30:15Z", "2024-02-29T12:30:15."}) {
    EXPECT_FALSE(TimestampSeconds(text).has_value()) << text;
  }
}

}  // namespace globe_test
}  // namespace trackbed
