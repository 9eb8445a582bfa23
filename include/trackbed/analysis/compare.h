#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/control/steering_controller.h"
#include "trackbed/core/table.h"
#include "trackbed/drive/run_log.h"
#include "trackbed/scenario/scenario.h"

/// Compares two runs at equal positions along the path (equal arc length).
///
/// Symbols: s station [m] of the path point nearest to the car (without a path: distance traveled);
/// p position of the rear axle [m]; psi yaw [rad]; psi' yaw rate [rad/s]; delta measured steering
/// angle of the road wheels [rad]. The indices 1 and 2 denote the first and the second run. Values
/// of the two runs are compared at equal station, not at equal time. A signed difference is the
/// value of the second run minus the value of the first run. A signed lateral difference is
/// positive if the second run is further to the left.
namespace trackbed {

/// A trace is the log of a run, reduced to rows with increasing station. A trace omits the rows in
/// which the car does not advance. A trace omits the rows after the first contact with an obstacle.
/// All vectors of a trace have the same length.
struct Trace {
  std::string name;  ///< Name of the plant that was driven, or a label of the run.
  std::vector<double> station;
  std::vector<double> time;
  std::vector<Pose2> pose;  ///< Pose of the car in each row; the yaw is not wrapped.
  std::vector<double> yaw_rate;
  std::vector<double> steering;
  /// Whether each row has recorded data; false in a gap of the record. `valid` is empty if the
  /// record has no gaps.
  std::vector<bool> valid{};
  Vec2 origin = Vec2::Zero();  ///< Local origin from which the positions count [m].

  /// Returns the car's pose at the station `at`, interpolated linearly between rows. The trace must
  /// have at least two rows.
  [[nodiscard]] Pose2 PoseAt(double at) const;
  /// Returns the time [s] at which the car reached the station `at`, interpolated linearly between
  /// rows. The trace must have at least two rows.
  [[nodiscard]] double TimeAt(double at) const;
};

/// Converts the log of a run to a trace. For a run with a path, `source` selects how the station is
/// measured.
Trace MakeTrace(const RunLog& log, StationSource source = StationSource::kProjection);

/// Returns the local origin that a table of positions states in its first row; (0, 0) if the table
/// states none.
Vec2 OriginIn(const Table& table);

/// Reads the log `<plant>.csv` of a run. Throws InputError if the file has fewer than two rows, or
/// if ReadCsvExcerpt throws InputError. Log rows later than `contact_time` [s] are omitted from the
/// trace.
Trace ReadTrace(const std::filesystem::path& file, const std::string& name,
                std::optional<double> contact_time = std::nullopt);

/// Statistics of the difference in one quantity, over the stations that both runs reach.
struct Difference {
  double rms = 0.0;    ///< Root mean square of the difference between the two runs.
  double max = 0.0;    ///< Largest magnitude of the difference between the two runs.
  double max_s = 0.0;  ///< Station at which the two runs differ most [m].
  double max_t = 0.0;  ///< Time at which the first run reaches the station `max_s` [s].
};

/// The differences between two runs at equal station.
struct PlantComparison {
  std::string first;
  std::string second;
  double from_s = 0.0;  ///< First station that both runs reach [m].
  double to_s = 0.0;    ///< Last station that both runs reach [m].
  Difference position;  ///< Distance between the positions, |p_2 - p_1| [m].
  Difference heading;   ///< Heading difference |psi_2 - psi_1|, in [0, pi] [rad].
  Difference yaw_rate;  ///< Yaw rate difference |psi'_2 - psi'_1| [rad/s].
  Difference steering;  ///< Steering difference |delta_2 - delta_1| [rad].

  /// Whether the station ranges of the two runs overlap; if not, the differences are undefined.
  [[nodiscard]] bool comparable() const { return to_s > from_s; }
};

/// The names of a compared quantity in compare.json, tolerances, messages and reports.
struct ComparedQuantity {
  const char* key;   ///< Key of the quantity in metrics.json and in tolerances, such as "yaw_rate".
  const char* name;  ///< Name of the quantity in messages, such as "yaw rate".
  const char* unit;
  const char* max_label;  ///< Label, in a report, of the largest difference.
  const char* rms_label;
  Difference PlantComparison::*difference;
  /// Tolerance of the quantity. In a scenario, the key of the tolerance is `key` with the suffix
  /// "_max".
  std::optional<double> DifferenceBounds::*bound;
};

/// Returns the quantities that are compared: position, heading, yaw rate and steering.
const std::vector<ComparedQuantity>& ComparedQuantities();

/// Compares two runs. Values between rows are interpolated linearly.
///
/// Guarantees: the result is exact if the motion is linear between the rows of the logs. The
/// largest difference of each quantity occurs at a row of one of the runs. If the first and the
/// second run are swapped, only `max_t` changes. Cost: linear in the number of rows.
PlantComparison CompareTraces(const Trace& first, const Trace& second);

PlantComparison ComparePlants(const RunLog& first, const RunLog& second);

/// Returns a table of the signed differences, with one row for each station of either log: `s_m`,
/// `first_t_s`, `second_t_s`, `x_m`, `y_m`, `position_m` (unsigned), `yaw_rad`, `yaw_rate_radps`,
/// `steering_rad`.
Table DifferencesOverArcLength(const Trace& first, const Trace& second);

/// One plant of a finished run, read from the run folder.
struct FinishedDrive {
  std::string status;  ///< End status of the plant in metrics.json, such as "arrived".
  Trace trace;         ///< Trajectory of the car; its `name` is the plant's name.
};

/// Reads the results of all plants from a run folder, in the order of metrics.json. Throws
/// InputError if the folder has no finished run, or if its logs lack columns or rows.
std::vector<FinishedDrive> ReadRunFolder(const std::filesystem::path& folder);

nlohmann::ordered_json ToJson(const PlantComparison& comparison);

}  // namespace trackbed
