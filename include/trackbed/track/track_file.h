#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/track/track.h"

namespace trackbed {

/// Reads a track in the format of TUM's racetrack database, a CSV file with the header
///   # x_m,y_m,w_tr_right_m,w_tr_left_m
/// The '#' is optional, columns may have any order, and other columns are ignored. The rows are
/// points in the order of driving, from the start line on. The track is closed; the first point is
/// not repeated.
///
/// Errors: InputError lists up to twenty problems with file and line, including those of
/// ReadCsvExcerpt. Problems of points are positions beyond 1e5 m, widths that are not above 0 or
/// exceed 1000 m, and a point that coincides with the previous one. A point at which the line turns
/// by more than 150 degrees is also a problem. Problems of the track are a lap of more than 200 km,
/// fewer than Track::kMinPoints or more than kMaxPoints points, a file of more than 16 MB, and
/// bends that are tighter than the track is wide (TrackFold). RunError if the file cannot be read.
/// `smoothing` has the meaning of Track's argument.
Track ReadTrack(const std::filesystem::path& file, std::optional<double> smoothing = {});

/// The file name of a track in the run folder, next to the resolved scenario.
inline constexpr const char* kTrackCsv = "track.csv";

/// Formats the points as a file from which ReadTrack restores equal points.
std::string TrackCsv(const std::vector<TrackPoint>& points);

}  // namespace trackbed
