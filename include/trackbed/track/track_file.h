#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/track/track.h"

namespace trackbed {

/// How to read a track.
struct TrackReading {
  std::optional<double> smoothing{};  ///< Wavelength of the smoothing (Track) [m].
  /// Width of a track whose file has no widths [m], > 0: half on either side of the center line.
  std::optional<double> width{};
};

/// A track, and notes about how it was read.
struct TrackFile {
  Track track;
  /// Differences from the file, with line numbers: narrowed edges, a repeated first point, and the
  /// columns if their names are not those of TUM.
  std::vector<std::string> notes;
  /// Wavelength with which the same track can be read again from the points of `track` [m].
  /// The member `chosen_smoothing` is set if the reader has chosen a wavelength or has narrowed an
  /// edge of the track; nullopt: TrackReading::smoothing applies.
  std::optional<double> chosen_smoothing{};
};

/// Reads a track from a CSV file, such as those of TUM's racetrack database with the header
///   # x_m,y_m,w_tr_right_m,w_tr_left_m
/// The file is read as by ReadCsvTable: cells are separated by commas, semicolons or tabs, the
/// header may begin with '#', and there may be comments. Columns may have any order and several
/// usual names, and other columns are ignored. In a file without column names, four columns are x,
/// y, and the widths to the right and to the left; two columns are x and y. The rows of a track
/// file are points in the order of driving, from the start line on. The track is closed; if the
/// last row repeats the first point, this row is dropped. If there are no columns of widths,
/// `reading.width` is the width of the track.
///
/// Without `reading.smoothing`, the wavelength of the smoothing is the default of Track, multiplied
/// by the power of 2 nearest to 1 (1/64 to 64) that gives an acceptable wavelength, if one exists.
/// A wavelength is rejected if an edge would have to be narrowed to less than half, or if the
/// smoothing moves a point by more than a tenth of the narrowest width. Between two points, the
/// center line may also leave the straight line by a tenth of the narrowest width, or by the
/// height of an arc that is plausible there. On longer swings, points are added on the straight
/// line, with a note: halves of the step, until the center line stays within this bound.
///
/// The inner edge may fold over in a bend (TrackFold). An inner edge that folds over is narrowed to
/// 95 % of the bend's radius, but must keep at least half of its width in the file.
///
/// Throws InputError, which lists up to twenty problems with file and line, including the problems
/// that ReadCsvTable finds. ReadTrackFile reports points with a coordinate beyond 1e7 m, and widths
/// that are not above 0 or exceed 1000 m. ReadTrackFile also reports points that coincide with the
/// previous point, and points at which the center line turns by more than 150 degrees.
/// ReadTrackFile reports a problem of the whole track if a lap is longer than 200 km, or if there
/// are fewer than Track::kMinPoints or more than Track::kMaxPoints points. ReadTrackFile reports
/// files of more than 16 MB. ReadTrackFile also reports edges that would have to be narrowed to
/// less than half of their width. Throws RunError if the file cannot be read.
TrackFile ReadTrackFile(const std::filesystem::path& file, const TrackReading& reading = {});

/// The points of a track file, each with its line in the file.
struct TrackFilePoints {
  std::vector<TrackPoint> points;
  std::vector<int> lines;
  bool is_log = false;  ///< Whether the track file has no columns of widths.
};

/// Reads the points of a track file whose center line may be open instead of a closed lap. Throws
/// the same errors as ReadTrackFile about single rows and the size of the file, but does not check
/// the shape of the center line. A track file without columns of widths may be the log of a drive.
/// In a log, rows nearer than `log_spacing` [m] to the previous point are skipped, and the road is
/// 2 `log_half_width` [m] wide.
TrackFilePoints ReadTrackPoints(const std::filesystem::path& file, double log_spacing,
                                double log_half_width);

/// Reads a track like ReadTrackFile, without the notes.
Track ReadTrack(const std::filesystem::path& file, std::optional<double> smoothing = {});

/// The file name of a track in the run folder, next to the resolved scenario.
inline constexpr const char* kTrackCsv = "track.csv";

/// Formats the points of a track as a file from which ReadTrack reads equal points.
std::string TrackCsv(const std::vector<TrackPoint>& points);

}  // namespace trackbed
