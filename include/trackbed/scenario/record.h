#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "trackbed/recording/log_map.h"
#include "trackbed/recording/recorded_drive.h"

/// A recorded drive in a scenario: replayed on every plant, and what these are measured against.
namespace trackbed {

/// The section `record` of a scenario.
struct RecordSpec {
  std::string file;                ///< a log, or a `record.csv` of a run
  std::optional<std::string> map;  ///< how to read the log; none: the file is a `record.csv`
  std::optional<double> from{};    ///< instead of the map's [s]
  std::optional<double> to{};      ///< likewise [s]
  ReplaySteering steering = ReplaySteering::kCommand;
  ReplayDrive drive = ReplayDrive::kSpeed;
  std::vector<double> windows{};       ///< horizons after which plants restart at the record [s]
  double min_speed = 0.3;              ///< slower moments and windows are not measured [m/s]
  std::optional<std::string> notes{};  ///< RecordedDrive::notes, a line each; none: what is found

  // Not a key: the drive itself, the same for all scenarios that were made of one.
  std::shared_ptr<const RecordedDrive> data{};
};

/// The names that drive.plants may have: those of Plants(), and kRecordedPlant, whose run is the
/// record itself.
std::vector<std::string> DrivenPlantNames();

/// Names and one-line summaries of these, for users.
std::vector<std::pair<std::string, std::string>> DrivenPlantSummaries();

/// Reads a map strictly. InputError with every problem of the file: unknown keys (with the nearest
/// known one), missing or repeated keys, wrong types, values out of range, each with file, line,
/// column and dotted key.
LogMap ReadLogMap(const std::filesystem::path& file);

/// Whether the file has the keys `time` and `position`, which maps have and scenarios do not. False
/// when it cannot be read.
bool IsLogMap(const std::filesystem::path& file);

}  // namespace trackbed
