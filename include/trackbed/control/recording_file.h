#pragma once

#include <filesystem>
#include <string>

#include "trackbed/control/playback.h"

namespace trackbed {

/// Reads recorded inputs from a CSV file with a header line. The axis and the steering are
/// required; of speed and acceleration, reads the one that `columns` names, or else the one that is
/// present under its default name, if any. The order of columns does not matter; other columns are
/// ignored.
///
/// Errors: InputError with file, line and column name for every cell that is not a finite number or
/// is out of range (steering within 1.5 rad on either side; speeds from 0 to 100 m/s, by distance
/// above 0 before the last row, because the car would stop at 0); for an axis that is not strictly
/// increasing; for missing columns and rows; and if both speed and acceleration are present and
/// `columns` selects neither. InputError with the key `columns` if `columns` names both.
/// RunError when the file cannot be read.
Recording ReadRecording(const std::filesystem::path& file, PlaybackAxis by,
                        const RecordingColumns& columns = {});

/// The file name of a recording beside the resolved scenario of a run.
inline constexpr const char* kRecordingCsv = "recording.csv";

/// The recording as a CSV file with default column names; ReadRecording reads it back to an equal
/// recording. PreconditionError unless all signals have the same values of the axis.
std::string RecordingCsv(const Recording& recording, PlaybackAxis by);

}  // namespace trackbed
