#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "trackbed/road_network/road_network.h"

namespace trackbed {

/// The maximum size of an OpenDRIVE file [bytes].
inline constexpr std::size_t kMaxOpenDriveBytes = std::size_t{32} << 20U;

/// Reads an OpenDRIVE file of version 1.4 to 1.7 (others of 1.x are read as 1.7, with a note):
/// reference lines of line, arc, spiral, poly3 and paramPoly3; elevation, superelevation and lane
/// offset; lane sections with lanes, widths or borders, links and road marks; links of roads and
/// connections of junctions. Objects, signals, controllers, railroads, surfaces, user data and the
/// geographic reference are skipped. Skipped elements that would change heights are listed in
/// Road::unread_heights and RoadNetwork::notes.
///
/// Errors: InputError with line and place of each of the first twenty problems: invalid XML,
/// another root element, a document type declaration, a missing or repeated id, a number that is
/// missing, not finite or out of range, stations that fall, reference lines with gaps in their
/// stations of more than 0.1 m, lanes not numbered consecutively, lanes without width, links to
/// missing elements. RunError when the file cannot be read or is larger than kMaxOpenDriveBytes.
/// Cost: about 20 ms per megabyte, and 25 times the file's size in memory during reading.
RoadNetwork ReadOpenDrive(const std::filesystem::path& file);

/// The text of a file and the network that was read from it.
struct OpenDriveFile {
  std::string text;
  RoadNetwork network;
};

/// As ReadOpenDrive, with the text for the folder of a run.
OpenDriveFile ReadOpenDriveFile(const std::filesystem::path& file);

/// The file name of a road network beside the resolved scenario of a run.
inline constexpr const char* kRoadNetworkXodr = "road_network.xodr";

/// As ReadOpenDrive, from text; `name` is the file's name in messages.
RoadNetwork ParseOpenDrive(std::string_view xml, const std::string& name);

}  // namespace trackbed
