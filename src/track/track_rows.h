#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/core/table.h"
#include "trackbed/track/track_file.h"

namespace trackbed {

/// Number of quantities in the columns of a track: x, y, widths to the right and to the left, and
/// the whole width.
inline constexpr std::size_t kTrackQuantities = 5;
using TrackNumbers = std::array<double, kTrackQuantities>;

/// Parameters for reading a file without columns of widths as the log of a drive.
struct LogReading {
  double spacing = 0.0;     // Distance between track points; log rows in between are skipped [m].
  double half_width = 0.0;  // Width of the road to either side [m].
};

/// Rows of a track file.
class TrackRows {
 public:
  /// Reads the rows of a track file. Throws InputError if a row or the header of the file has a
  /// problem. Drops the last points of the track if they repeat the first point. If the argument
  /// `log` is given, the file needs no columns of track widths.
  TrackRows(const std::filesystem::path& file, const TrackReading& reading,
            std::optional<LogReading> log = {});

  /// Returns whether the file was read as the log of a drive.
  [[nodiscard]] bool is_log() const { return log_.has_value(); }

  /// Adds a problem of the track point with the index `point`.
  void Add(std::size_t point, std::string key, std::string message) {
    problems.Add({name_, lines[point], 0, std::move(key), std::move(message)});
  }

  ProblemList problems;
  std::vector<TrackPoint> points;
  std::vector<int> lines;  // Line number of each track point in the file.
  std::vector<std::string> notes;

 private:
  void TakeNames(const std::vector<std::string>& names, int line);
  void TakeNumbers(int line);
  void TakeRow(const std::vector<std::string>& cells, int line);
  void CheckNumbers(const TrackNumbers& numbers);
  void CheckExtent();
  void DropRepeatedEnd();

  std::string name_;
  const TrackReading& reading_;
  std::optional<LogReading> log_;  // Parameters for reading a driven log as a track; empty if the
                                   // file has track widths.
  std::vector<std::string> names_;
  std::array<std::optional<std::size_t>, kTrackQuantities> columns_;
  bool is_broken_ = false;
};

}  // namespace trackbed
