#pragma once

#include <filesystem>
#include <string>

#include "trackbed/control/playback.h"

namespace trackbed {

/// Reads recorded inputs from a CSV file with a header line. The columns of the axis and of the
/// steering are required. If `columns` names a speed or an acceleration column, that column is
/// read; otherwise the column with the default name is read, if the file has such a column. The
/// order of columns does not matter; other columns are ignored.
///
/// Errors: throws InputError with file, line and column name for every cell that is not a finite
/// number or is out of range. Steering must be from -1.5 to 1.5 rad, speed from 0 to 100 m/s. If
/// the axis is the distance, the speed must be above 0 in all rows but the last, because a car at
/// speed 0 would never reach the next row. Throws InputError if the axis is not strictly
/// increasing, or if columns or rows are missing. Throws InputError if the file has both speed and
/// acceleration and `columns` selects neither, or if `columns` names both. Throws RunError if the
/// file cannot be read.
Recording ReadRecording(const std::filesystem::path& file, PlaybackAxis by,
                        const RecordingColumns& columns = {});

/// The file name of a recording in the run folder, next to the resolved scenario.
inline constexpr const char* kRecordingCsv = "recording.csv";

/// Formats a recording as the text of a CSV file with default column names. ReadRecording of this
/// file returns an equal recording. Throws PreconditionError unless all signals have knots at the
/// same values of the axis.
std::string RecordingCsv(const Recording& recording, PlaybackAxis by);

}  // namespace trackbed
