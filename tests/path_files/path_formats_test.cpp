#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "tests/support/error_text.h"
#include "tests/support/temp_folder.h"
#include "trackbed/core/error.h"
#include "trackbed/path_files/path_file.h"

namespace trackbed {
namespace {

constexpr const char* kCsv = "x,y\n0,0\n3,4\n";
constexpr const char* kNavPath =
    R"({"poses": [{"pose": {"position": {"x": 0, "y": 0}}},
                  {"pose": {"position": {"x": 3, "y": 4}}}]})";
constexpr const char* kGeoJson =
    R"({"type": "LineString", "coordinates": [[0, 0], [3, 4]],
        "crs": {"type": "name", "properties": {"name": "EPSG:25832"}}})";

/// Returns the last point of the path as text, or the message of the first problem.
std::string LastPoint(const std::string& name, const std::string& text, PathFormat format) {
  const TempFolder folder;
  PathMap map;
  map.format = format;
  try {
    const Vec2 last = ReadPathFile(folder.Write(name, text), map).points.points.back();
    return fmt::format("{}, {}", last.x(), last.y());
  } catch (const InputError& error) {
    return error.problems().front().message;
  }
}

TEST(PathFormats, AreFoundByEndingAndContent) {
  for (const auto& [name, text] :
       std::vector<std::pair<const char*, const char*>>{{"a.csv", kCsv},
                                                        {"a.CSV", kCsv},
                                                        {"a.txt", kCsv},
                                                        {"a", kCsv},
                                                        {"a.yaml", kNavPath},
                                                        {"a.yml", kNavPath},
                                                        {"a.YAML", kNavPath},
                                                        {"a.json", kNavPath},
                                                        {"a.json", kGeoJson},
                                                        {"a.JSON", kGeoJson},
                                                        {"a.geojson", kGeoJson},
                                                        {"a.GeoJSON", kGeoJson}}) {
    EXPECT_EQ(LastPoint(name, text, PathFormat::kAuto), "3, 4") << name << " " << text;
  }
}

TEST(PathFormats, AreThoseOfTheMapWhateverTheEnding) {
  for (const char* name : {"a.csv", "a.json", "a.geojson", "a.xml", "a"}) {
    EXPECT_EQ(LastPoint(name, kCsv, PathFormat::kCsv), "3, 4") << name;
    EXPECT_EQ(LastPoint(name, kNavPath, PathFormat::kNavPath), "3, 4") << name;
    EXPECT_EQ(LastPoint(name, kGeoJson, PathFormat::kGeoJson), "3, 4") << name;
  }
  EXPECT_NE(LastPoint("a.json", kGeoJson, PathFormat::kNavPath), "3, 4");
}

TEST(PathFormats, AreListedForUsers) {
  EXPECT_EQ(PathFormatList(),
            "CSV, nav_msgs/Path (YAML, JSON), CommonRoad solution, GeoJSON, GPX, KML, rosbag2 or "
            "Lanelet2");
}

// Some programs name GPX and KML files after their syntax.
TEST(PathFormats, RecognizesXmlByItsRoot) {
  const std::string gpx =
      "<gpx><trk><trkseg><trkpt lat='48' lon='11'/><trkpt lat='48.001' lon='11'/></trkseg></trk>"
      "</gpx>";
  const std::string kml =
      "<k:kml xmlns:k='http://www.opengis.net/kml/2.2'><k:Placemark><k:LineString><k:coordinates>"
      "11,48 11,48.001</k:coordinates></k:LineString></k:Placemark></k:kml>";
  const TempFolder folder;
  for (const std::string& text :
       {gpx, "<?xml version='1.0'?>\n<!-- <kml> -->\n" + gpx, kml, "<!DOCTYPE kml>" + kml}) {
    SCOPED_TRACE(text);
    const PathFile read = ReadPathFile(folder.Write("track.xml", text));
    ASSERT_EQ(read.points.points.size(), 2U);
    // A thousandth of a degree of latitude is 111.19 m at 48 degrees (WGS 84).
    EXPECT_NEAR((read.points.points[1] - read.points.points[0]).norm(), 111.19, 0.01);
  }
  EXPECT_THAT(ErrorText([&] { ReadPathFile(folder.Write("map.xml", "<osm/>")); }),
              testing::HasSubstr("no lanelet for cars"));
  EXPECT_THAT(ErrorText([&] { ReadPathFile(folder.Write("map.xml", "<other/>")); }),
              testing::HasSubstr("must be CommonRoadSolution or commonRoad"));
}

}  // namespace
}  // namespace trackbed
