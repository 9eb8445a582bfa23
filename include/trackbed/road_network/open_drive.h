#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "trackbed/road_network/road_network.h"

namespace trackbed {

/// The maximum size of an OpenDRIVE file [bytes].
inline constexpr std::size_t kMaxOpenDriveBytes = std::size_t{32} << 20U;

/// Reads an OpenDRIVE file of version 1.4 to 1.7; files of other versions 1.x are read like version
/// 1.7, with a note in RoadNetwork::notes. ReadOpenDrive reads these elements: reference lines
/// (line, arc, spiral, poly3 and paramPoly3); elevation, superelevation, shape and lane offset;
/// lane sections with lanes, widths or borders, links and road marks; links of roads; and
/// connections of junctions. Objects, signals, controllers, railroads, surfaces, user data and the
/// geographic reference are skipped. Road::unread_heights and RoadNetwork::notes list the skipped
/// elements that would change the height of the road.
///
/// A road or junction with a problem is left out: RoadNetwork::broken contains the first problem of
/// the road or junction, and RoadNetwork::notes names it. Links to missing or broken elements,
/// links and connections with a problem, and wrong road marks only cause a note.
///
/// Throws InputError if the document is not an OpenDRIVE file, or if each road has a problem. The
/// InputError lists the first twenty problems, each with its line in the file and its place in the
/// road network. Problems of a file are invalid XML, a wrong root element, a document type
/// declaration, and a missing or repeated id. A number in the file that is missing, not finite or
/// out of range is also a problem. Other problems of a file are decreasing stations, and gaps of
/// more than 0.1 m in the stations of a reference line. Lanes that are not numbered consecutively
/// or have no width are also problems of a file. Throws RunError if the file cannot be read or is
/// larger than kMaxOpenDriveBytes. Reading takes about 20 ms per megabyte, and temporarily needs 25
/// times the file's size in memory.
RoadNetwork ReadOpenDrive(const std::filesystem::path& file);

/// The text of an OpenDRIVE file, and the road network that was read from this text.
struct OpenDriveFile {
  std::string text;
  RoadNetwork network;
  /// Offset of the header [m]: the place of the file's origin in the coordinates of its map
  /// projection. The header's offset is not part of the coordinates of the roads.
  Vec2 offset = Vec2::Zero();
  /// Rotation in the header's offset [rad]; not applied to the roads.
  double offset_heading = 0.0;
};

/// Reads a file like ReadOpenDrive, and also returns the text of the file, which is stored in the
/// run folder.
OpenDriveFile ReadOpenDriveFile(const std::filesystem::path& file);

/// The file name of a road network in the run folder, next to the resolved scenario.
inline constexpr const char* kRoadNetworkXodr = "road_network.xodr";

/// Parses the text of an OpenDRIVE file like ReadOpenDrive. Error messages use `name` as the name
/// of the file.
RoadNetwork ParseOpenDrive(std::string_view xml, const std::string& name);

/// Parses a text like ParseOpenDrive, and also returns the text and the header's offset. The
/// coordinates of the roads are relative to the point `origin` in the coordinates of the file [m].
OpenDriveFile ParseOpenDriveFile(std::string text, const std::string& name,
                                 const Vec2& origin = Vec2::Zero());

}  // namespace trackbed
