#include "trackbed/path_files/globe_file.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "src/path_files/formats.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"

namespace trackbed {

namespace fs = std::filesystem;

bool IsGlobeFile(const fs::path& file) {
  const std::string ending = LowerEnding(file);
  return ending == ".gpx" || ending == ".kml" || ending == ".kmz" || ending == ".geojson";
}

void RefuseNoLine(const fs::path& file, const GlobeFile& found) {
  std::string text =
      fmt::format("has no line: no {}", found.format == "GPX"   ? "trk with trkpt, no rte"
                                        : found.format == "KML" ? "LineString, no gx:Track"
                                                                : "LineString");
  if (found.single_points > 0) {
    text += fmt::format(
        ", but {} single point{}, whose order need not be that of driving; if it is, write a CSV "
        "file "
        "with the columns latitude and longitude and a row for each point",
        found.single_points, found.single_points == 1 ? "" : "s");
  }
  Refuse(file, "", text);
}

GlobeFile ReadGlobeFile(const fs::path& file) {
  const std::string text = ReadFile(file, kMaxGlobeBytes);
  GlobeFile found;
  if (LowerEnding(file) == ".geojson") {
    found = ReadGeoJsonLines(file, ParseJsonText(text, file.string()));
  } else {
    found = ReadGlobeXml(file, text);
  }
  if (found.lines.empty()) {
    RefuseNoLine(file, found);
  }
  return found;
}

}  // namespace trackbed
