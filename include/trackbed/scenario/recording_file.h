#pragma once

#include <filesystem>

#include "trackbed/control/playback.h"

namespace trackbed {

/// Reads recorded inputs from a CSV file with a header line. Needed are the axis and the steering;
/// of speed and acceleration the one that `columns` names, or else the one that is there under its
/// default name, if any. The order of columns does not matter, and others are ignored.
///
/// Errors: InputError with file, line and column name for every cell that is no finite number or
/// out of range (steering within 1.5 rad on either side, speeds from 0 to 100 m/s, by distance
/// above 0 before the last row: the car would stay there), for an axis that does not rise strictly,
/// for missing columns and rows, and where there are both speed and acceleration and `columns`
/// chooses none; without a file, with the key `control.columns`, when it names both. RunError when
/// the file cannot be read.
Recording ReadRecording(const std::filesystem::path& file, PlaybackAxis by,
                        const RecordingColumns& columns = {});

}  // namespace trackbed
