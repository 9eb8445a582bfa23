#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "trackbed/recording/log_map.h"
#include "trackbed/recording/recorded_drive.h"

/// A recorded drive in a scenario: every plant replays it and is compared with it.
namespace trackbed {

/// The section `record` of a scenario.
struct RecordSpec {
  std::string file;                ///< a log, or a `record.csv` of a run
  std::optional<std::string> map;  ///< how to read the log; none: the file is a `record.csv`
  std::optional<double> from{};    ///< replaces the map's `from` [s]
  std::optional<double> to{};      ///< replaces the map's `to` [s]
  ReplaySteering steering = ReplaySteering::kCommand;
  ReplayDrive drive = ReplayDrive::kSpeed;
  std::vector<double> windows{};  ///< horizons after which plants restart at the record [s]
  double min_speed = 0.3;         ///< slower moments and windows are ignored [m/s]
  /// RecordedDrive::notes, one per line; none: those of the import.
  std::optional<std::string> notes{};

  // Not a key: the drive itself, shared by all scenarios copied from one.
  std::shared_ptr<const RecordedDrive> data{};
};

/// The names allowed in drive.plants: those of Plants(), and kRecordedPlant, whose run is the
/// record itself.
std::vector<std::string> DrivenPlantNames();

/// Names and one-line summaries of these plants, for users.
std::vector<std::pair<std::string, std::string>> DrivenPlantSummaries();

/// Reads a log map strictly. InputError with every problem of the file: unknown keys (with the
/// nearest known one), missing or repeated keys, wrong types, values out of range, each with file,
/// line, column and dotted key.
LogMap ReadLogMap(const std::filesystem::path& file);

/// Whether the file has the keys `time` and `position`, which log maps have and scenarios do not.
/// False when it cannot be read.
bool IsLogMap(const std::filesystem::path& file);

}  // namespace trackbed
