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
/// points in the order of driving, from the start line on. The track is closed, but the file does
/// not repeat the first point at the end.
///
/// Throws InputError, which lists up to twenty problems with file and line, including the problems
/// that ReadCsvExcerpt finds. A point is a problem if its position is beyond 1e5 m, if a width is
/// not above 0 or exceeds 1000 m, or if the point coincides with the previous point. A point at
/// which the center line turns by more than 150 degrees is also a problem. The track as a whole has
/// a problem if a lap is longer than 200 km, if there are fewer than Track::kMinPoints or more than
/// Track::kMaxPoints points, if the file is larger than 16 MB, or if the track has a fold
/// (TrackFold). Throws RunError if the file cannot be read. `smoothing` is the same argument as
/// that of Track's constructor.
Track ReadTrack(const std::filesystem::path& file, std::optional<double> smoothing = {});

/// The file name of a track in the run folder, next to the resolved scenario.
inline constexpr const char* kTrackCsv = "track.csv";

/// Formats the points of a track as a file from which ReadTrack reads equal points.
std::string TrackCsv(const std::vector<TrackPoint>& points);

}  // namespace trackbed
