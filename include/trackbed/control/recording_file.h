#pragma once

#include <filesystem>
#include <string>

#include "trackbed/control/playback.h"

namespace trackbed {

/// Reads recorded inputs from a CSV file with a header line. The CSV file must have a column for
/// the axis (time or distance) and a column for the steering. If `columns` names a speed or an
/// acceleration column, the named column is read. If `columns` names neither a speed nor an
/// acceleration column, a column with a default name is read if the file has one. The order of the
/// columns in the CSV file does not matter, and other columns are ignored.
///
/// Errors: throws InputError with file, line and column name for every cell that is not a finite
/// number or is out of range. Recorded steering angles must be from -1.5 to 1.5 rad, and recorded
/// speeds from 0 to 100 m/s. If the recording's axis is the distance, the speed must be above 0 in
/// all rows but the last, because a car at speed 0 would never reach the next row. Throws
/// InputError if the values of the recording's axis are not strictly increasing, or if columns or
/// rows are missing. Throws InputError if `columns` names both a speed and an acceleration column.
/// Throws InputError if the file has both a speed and an acceleration column and `columns` names
/// neither. Throws RunError if the file cannot be read.
Recording ReadRecording(const std::filesystem::path& file, PlaybackAxis by,
                        const RecordingColumns& columns = {});

/// The name of the file with the recording in the run folder, next to the resolved scenario.
inline constexpr const char* kRecordingCsv = "recording.csv";

/// Formats a recording as the text of a CSV file with the default column names. Reading the written
/// file by ReadRecording returns an equal recording. Throws PreconditionError unless all signals of
/// the recording have knots at the same values of the axis.
std::string RecordingCsv(const Recording& recording, PlaybackAxis by);

}  // namespace trackbed
