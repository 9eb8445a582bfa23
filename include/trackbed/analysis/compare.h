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

/// Compares two runs at equal arc length.
///
/// Symbols: s station [m] of the nearest point of the path, or the distance traveled if there is no
/// path; p position of the rear axle [m]; psi yaw [rad]; psi' yaw rate [rad/s]; delta steering of
/// the road wheels as measured [rad]. The indices 1 and 2 denote the first and the second run. Runs
/// are compared at equal station, not at equal time. A signed difference is the value of the second
/// run minus that of the first run: it is positive when the second run is further to the left.
namespace trackbed {

/// The log of a run, reduced to rows of increasing station. Rows in which the car does not advance
/// are omitted, and so are rows after the first contact with an obstacle. All vectors have equal
/// length.
struct Trace {
  std::string name;  ///< Name of the plant, or a label of the run.
  std::vector<double> station;
  std::vector<double> time;
  std::vector<Pose2> pose;  ///< Pose of each row; the yaw is not wrapped to (-pi, pi].
  std::vector<double> yaw_rate;
  std::vector<double> steering;
  /// False for rows in a gap of the record; empty if the record has no gaps.
  std::vector<bool> valid{};

  /// Returns the pose at a station, interpolated linearly between rows. The trace must have at
  /// least two rows.
  [[nodiscard]] Pose2 PoseAt(double at) const;
  /// Returns the time at a station [s], interpolated linearly between rows. The trace must have at
  /// least two rows.
  [[nodiscard]] double TimeAt(double at) const;
};

/// Makes the trace of a log. For a run with a path, `source` selects how the station is measured.
Trace MakeTrace(const RunLog& log, StationSource source = StationSource::kProjection);

/// Reads the log `<plant>.csv` of a run. Throws the InputErrors of ReadCsvExcerpt, and InputError
/// if the file has fewer than two rows. Omits rows after `contact_time` [s].
Trace ReadTrace(const std::filesystem::path& file, const std::string& name,
                std::optional<double> contact_time = std::nullopt);

/// The difference in one quantity over the stations common to both runs.
struct Difference {
  double rms = 0.0;    ///< Root mean square of the difference over arc length.
  double max = 0.0;    ///< Largest magnitude of the difference over arc length.
  double max_s = 0.0;  ///< Station of the largest magnitude [m].
  double max_t = 0.0;  ///< Time at which the first run reaches `max_s` [s].
};

/// The differences between two runs at equal station.
struct PlantComparison {
  std::string first;
  std::string second;
  double from_s = 0.0;  ///< Start of the common stations [m].
  double to_s = 0.0;    ///< End of the common stations [m].
  Difference position;  ///< Distance of the positions, |p_2 - p_1| [m].
  Difference heading;   ///< Heading difference |psi_2 - psi_1|, in [0, pi] [rad].
  Difference yaw_rate;  ///< Yaw rate difference |psi'_2 - psi'_1| [rad/s].
  Difference steering;  ///< Steering difference |delta_2 - delta_1| [rad].

  /// Whether the station ranges overlap; if not, the differences are undefined.
  [[nodiscard]] bool comparable() const { return to_s > from_s; }
};

/// A compared quantity: its names in compare.json, tolerances, messages and reports.
struct ComparedQuantity {
  const char* key;   ///< Key in metrics.json and in tolerances: "yaw_rate".
  const char* name;  ///< Name in messages: "yaw rate".
  const char* unit;
  const char* max_label;  ///< Label of the largest difference in a report.
  const char* rms_label;
  Difference PlantComparison::*difference;
  /// Tolerance; the scenario's key for the tolerance is `key` with the suffix "_max".
  std::optional<double> DifferenceBounds::*bound;
};

/// The compared quantities: position, heading, yaw rate, steering.
const std::vector<ComparedQuantity>& ComparedQuantities();

/// Compares two runs. Values between rows are interpolated linearly.
///
/// Guarantees: the result is exact for runs that are linear between rows. Each largest difference
/// occurs at a row of one of the runs. Swapping the runs changes only `max_t`. Cost: linear in the
/// number of rows.
PlantComparison CompareTraces(const Trace& first, const Trace& second);

PlantComparison ComparePlants(const RunLog& first, const RunLog& second);

/// Returns a table of the signed differences, with one row for each station of either log: `s_m`,
/// `first_t_s`, `second_t_s`, `x_m`, `y_m`, `position_m` (unsigned), `yaw_rad`, `yaw_rate_radps`,
/// `steering_rad`.
Table DifferencesOverArcLength(const Trace& first, const Trace& second);

/// One plant of a finished run, read from the run folder.
struct FinishedDrive {
  std::string status;  ///< Status in metrics.json: "arrived", …
  Trace trace;         ///< Trajectory, named after the plant.
};

/// Reads the plants of a run folder in the order of metrics.json. InputError if the folder has no
/// finished run, or if its logs lack columns or rows.
std::vector<FinishedDrive> ReadRunFolder(const std::filesystem::path& folder);

nlohmann::ordered_json ToJson(const PlantComparison& comparison);

}  // namespace trackbed
