#pragma once

#include <filesystem>
#include <optional>

#include "trackbed/path_files/globe.h"
#include "trackbed/path_files/globe_file.h"
#include "trackbed/path_files/path_file.h"

namespace trackbed {

/// Returns the path along one line of the file: the only line, or the line PathMap::line.
PathFile PathOfGlobeFile(const std::filesystem::path& file, GlobeFile lines, const PathMap& map);

/// Returns the origin that the map specifies for the projection, if any.
std::optional<GlobePosition> OriginOf(const PathMap& map);

}  // namespace trackbed
