#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "trackbed/path_files/path_file.h"

/// Limits of path files, and functions that all readers of path files share.
namespace trackbed {

/// Largest magnitude of a path point's x and y coordinates [m].
inline constexpr double kMaxPosition = 1e7;
inline constexpr double kMaxPathSpeed = 100.0;    ///< Largest speed [m/s].
inline constexpr double kMaxPathCurvature = 1e6;  ///< Largest curvature [1/m].
inline constexpr int kMaxDepth = 64;              ///< Largest nesting depth.
/// Largest size of a GPX, KML or GeoJSON file that is read as a recording [bytes].
inline constexpr std::size_t kMaxGlobeBytes = std::size_t{64} << 20U;

/// Returns the ending of a file's name in lower case, such as ".gpx".
std::string LowerEnding(const std::filesystem::path& file);

/// Stores the times at which the points are reached, from 0 [s]. If the points have no speeds,
/// computes the speed at each point from the times. If successive points have equal times, their
/// speed is constant up to the next point with a later time. If the times decrease or are all
/// equal, or if a computed speed is out of range, drops the speeds and the times. For dropped
/// times, adds a problem that names the point to PathFile::speed_problems.
void TakeTimes(PathFile& found, std::vector<double> times, const std::string& file);

/// Takes the stamps of ROS messages [s], one for each point, as TakeTimes does. Ignores stamps that
/// are all equal, as those of a planner that does not set them.
void TakeStamps(PathFile& found, std::vector<double> stamps, const std::string& file);

/// Throws InputError with the given message about a key of a file, and about a line if it is not 0.
[[noreturn]] void Refuse(const std::filesystem::path& file, const std::string& key,
                         std::string message, int line = 0);

}  // namespace trackbed
