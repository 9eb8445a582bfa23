#pragma once

#include <filesystem>
#include <string>

#include "trackbed/control/playback.h"

namespace trackbed {

/// Reads recorded inputs from a CSV file with a header line. The columns of the axis and of the
/// steering are required. Of speed and acceleration, the column that `columns` names is read,
/// otherwise the column with the default name, if any. The order of columns does not matter; other
/// columns are ignored.
///
/// Errors: InputError with file, line and column name for every cell that is not a finite number or
/// is out of range. Steering is from -1.5 to 1.5 rad, speed from 0 to 100 m/s. By distance, the
/// speed must be above 0 before the last row, because the car would stop at 0. InputError for an
/// axis that is not strictly increasing, and for missing columns and rows. InputError if both speed
/// and acceleration are present and `columns` does not select one, or if `columns` names both.
/// RunError if the file cannot be read.
Recording ReadRecording(const std::filesystem::path& file, PlaybackAxis by,
                        const RecordingColumns& columns = {});

/// The file name of a recording in the run folder, next to the resolved scenario.
inline constexpr const char* kRecordingCsv = "recording.csv";

/// The recording as a CSV file with default column names; ReadRecording reads it back to an equal
/// recording. PreconditionError unless all signals have knots at the same values of the axis.
std::string RecordingCsv(const Recording& recording, PlaybackAxis by);

}  // namespace trackbed
