#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "trackbed/recording/log_map.h"
#include "trackbed/recording/recorded_drive.h"

/// A recorded drive in a scenario. Every plant replays the drive and is compared with it.
namespace trackbed {

/// The section `record` of a scenario.
struct RecordSpec {
  std::string file;  ///< A log, or the `record.csv` of a run.
  /// Log map that describes the log; none: the file is a `record.csv`.
  std::optional<std::string> map;
  std::optional<double> from{};  ///< Start time that replaces `from` of the log map [s].
  std::optional<double> to{};    ///< End time that replaces `to` of the log map [s].
  ReplaySteering steering = ReplaySteering::kCommand;
  ReplayDrive drive = ReplayDrive::kSpeed;
  std::vector<double> windows{};  ///< Lengths of prediction windows [s].
  double min_speed = 0.3;  ///< Recorded speed below which samples and windows are ignored [m/s].
  /// Notes on the recorded drive (RecordedDrive::notes), one per line; nullopt: the notes of the
  /// import.
  std::optional<std::string> notes{};

  // The recorded drive, shared by copies of the scenario. The member is not a key of the file.
  std::shared_ptr<const RecordedDrive> data{};
};

/// Returns the names allowed in drive.plants: those of Plants(), and kRecordedPlant. The plant
/// kRecordedPlant reproduces the record itself.
std::vector<std::string> DrivenPlantNames();

/// Returns the names and one-line summaries of the plants allowed in drive.plants, for users.
std::vector<std::pair<std::string, std::string>> DrivenPlantSummaries();

/// Reads a log map strictly. InputError lists every problem of the file, each with file, line,
/// column and dotted key: unknown keys (with the most similar known key), missing or repeated keys,
/// wrong types, and values out of range.
LogMap ReadLogMap(const std::filesystem::path& file);

/// Whether the file has the keys `time` and `position`, which log maps have and scenarios do not.
/// False if the file cannot be read.
bool IsLogMap(const std::filesystem::path& file);

}  // namespace trackbed
