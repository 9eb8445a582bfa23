#pragma once

#include <filesystem>
#include <string>

#include "trackbed/control/playback.h"

namespace trackbed {

/// Reads recorded inputs from a CSV file with a header line. Needed are the axis and the steering;
/// of speed and acceleration the one that `columns` names, or else the one present under its
/// default name, if any. The order of columns does not matter, and others are ignored.
///
/// Errors: InputError with file, line and column name for every cell that is not a finite number or
/// is out of range (steering within 1.5 rad on either side, speeds from 0 to 100 m/s, by distance
/// above 0 before the last row, where the car would stop), for an axis that is not strictly
/// increasing, for missing columns and rows, and where there are both speed and acceleration and
/// `columns` chooses none; without a file, with the key `control.columns`, when it names both.
/// RunError when the file cannot be read.
Recording ReadRecording(const std::filesystem::path& file, PlaybackAxis by,
                        const RecordingColumns& columns = {});

/// The name of a recording beside the resolved scenario of a run.
inline constexpr const char* kRecordingCsv = "recording.csv";

/// The recording as a CSV file that ReadRecording reads back to an equal one, with the default
/// names of columns. PreconditionError when the signals are not over the same values of the axis.
std::string RecordingCsv(const Recording& recording, PlaybackAxis by);

}  // namespace trackbed
