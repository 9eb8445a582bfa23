#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "trackbed/road_network/road_network.h"

namespace trackbed {

/// The maximum size of an OpenDRIVE file [bytes].
inline constexpr std::size_t kMaxOpenDriveBytes = std::size_t{32} << 20U;

/// Reads an OpenDRIVE file of version 1.4 to 1.7; other versions 1.x are read as 1.7, with a note.
/// Reads reference lines of line, arc, spiral, poly3 and paramPoly3; elevation, superelevation and
/// lane offset; lane sections with lanes, widths or borders, links and road marks; links of roads
/// and connections of junctions. Objects, signals, controllers, railroads, surfaces, user data and
/// the geographic reference are skipped. Skipped elements that would change heights are listed in
/// Road::unread_heights and RoadNetwork::notes.
///
/// Errors: InputError with line and place of each of the first twenty problems. Problems are
/// invalid XML, a wrong root element, a document type declaration, and a missing or repeated id. A
/// number that is missing, not finite or out of range is a problem. Other problems are decreasing
/// stations, and gaps of more than 0.1 m in the stations of a reference line. Lanes that are not
/// numbered consecutively or have no width, and links to missing elements, are also problems.
/// RunError if the file cannot be read or is larger than kMaxOpenDriveBytes. Cost: about 20 ms per
/// megabyte, and 25 times the file's size in memory during reading.
RoadNetwork ReadOpenDrive(const std::filesystem::path& file);

/// The text of a file and the network that was read from it.
struct OpenDriveFile {
  std::string text;
  RoadNetwork network;
};

/// As ReadOpenDrive, but also returns the text for the run folder.
OpenDriveFile ReadOpenDriveFile(const std::filesystem::path& file);

/// The file name of a road network in the run folder, next to the resolved scenario.
inline constexpr const char* kRoadNetworkXodr = "road_network.xodr";

/// As ReadOpenDrive, but parses a text. Messages use `name` as the file's name.
RoadNetwork ParseOpenDrive(std::string_view xml, const std::string& name);

}  // namespace trackbed
