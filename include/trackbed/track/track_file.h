#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/track/track.h"

namespace trackbed {

/// Reads a track in the format of TUM's racetrack database: CSV, a header
///   # x_m,y_m,w_tr_right_m,w_tr_left_m
/// (with or without the '#', columns in any order, others ignored), then points in the order of
/// driving from the start line on. The track is closed; the first point is not repeated.
///
/// Errors: InputError with file and line, for up to twenty problems: as ReadCsvExcerpt; positions
/// beyond 1e5 m; widths that are not above 0, or above 1000 m; a point that coincides with the
/// previous one; a lap of more than 200 km; points at which the line turns by more than 150
/// degrees; fewer than Track::kMinPoints or more than kMaxPoints; a file of more than 16 MB; and
/// bends that are tighter than the track is wide (TrackFold). RunError when the file cannot be
/// read. `smoothing` as Track.
Track ReadTrack(const std::filesystem::path& file, std::optional<double> smoothing = {});

/// The file name of a track beside the resolved scenario of a run.
inline constexpr const char* kTrackCsv = "track.csv";

/// The points as a file that ReadTrack reads back to equal points.
std::string TrackCsv(const std::vector<TrackPoint>& points);

}  // namespace trackbed
