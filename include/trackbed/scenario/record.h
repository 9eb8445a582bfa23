#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "trackbed/recording/log_map.h"
#include "trackbed/recording/recorded_drive.h"

/// The recorded drive of a scenario. Every plant replays the recorded drive, and the simulated
/// motion is compared with the recorded drive.
namespace trackbed {

struct BankedTrack;

/// The section `record` of a scenario.
struct RecordSpec {
  std::string file;  ///< File of the recorded drive: a log, or the `record.csv` of a run.
  /// File of the log map that describes the log; nullopt if the recorded drive is a `record.csv`.
  std::optional<std::string> map;
  std::optional<double> from{};  ///< Start time in the log that replaces `from` of the log map [s].
  std::optional<double> to{};    ///< End time in the log that replaces `to` of the log map [s].
  /// File of a banked track or open road, whose surface is the ground (recording/banked_track.h);
  /// nullopt: the ground of the world.
  std::optional<std::string> ground{};
  ReplaySteering steering = ReplaySteering::kCommand;
  ReplayDrive drive = ReplayDrive::kSpeed;
  std::vector<double> windows{};  ///< Lengths of the prediction windows [s].
  /// Minimum recorded speed; samples and windows with a lower speed are ignored [m/s].
  double min_speed = 0.3;
  /// Notes on the recorded drive (RecordedDrive::notes), one note per line; nullopt: the notes are
  /// those of the import of the log.
  std::optional<std::string> notes{};

  // Data of the recorded drive, which copies of the scenario share; not a key of the scenario file.
  std::shared_ptr<const RecordedDrive> data{};
  // Content of the file `ground`, which copies of the scenario share.
  std::shared_ptr<const BankedTrack> ground_data{};
};

/// Returns the plant names that are allowed in drive.plants: the names in Plants(), and
/// kRecordedPlant. The log of the plant kRecordedPlant is the recorded drive itself.
std::vector<std::string> DrivenPlantNames();

/// Returns the names of the plants that are allowed in drive.plants, each with a summary of one
/// line for users.
std::vector<std::pair<std::string, std::string>> DrivenPlantSummaries();

/// Reads a log map and rejects any invalid key. Throws InputError, which lists every problem of the
/// file, each with file, line, column and dotted key: unknown keys (with the most similar known
/// key), missing or repeated keys, wrong types, and values out of range.
LogMap ReadLogMap(const std::filesystem::path& file);

/// Returns true if the file has the keys `time` and `position`, which log maps have but scenarios
/// do not. Returns false if the file cannot be read.
bool IsLogMap(const std::filesystem::path& file);

}  // namespace trackbed
