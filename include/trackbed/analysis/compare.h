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

/// Comparison of two runs over arc length.
///
/// Symbols: s station [m]: that of the nearest point of the path, or without a path the distance
/// traveled; p position of the rear axle [m]; psi yaw [rad]; psi' yaw rate [rad/s]; delta steering
/// of the road wheels as measured [rad]. Indices 1 and 2 are the first and second run, compared at
/// equal s, whatever the times. Signed differences are second minus first: positive when the second
/// run is further to the left.
namespace trackbed {

/// A run over increasing station. Omits rows without progress, so that a standing car stays at its
/// stopping point, and rows after the first contact with an obstacle. All vectors have equal
/// length.
struct Trace {
  std::string name;  ///< the plant's, or a label of the run
  std::vector<double> station;
  std::vector<double> time;
  std::vector<Pose2> pose;  ///< yaw is not wrapped
  std::vector<double> yaw_rate;
  std::vector<double> steering;
  std::vector<bool> valid{};  ///< false for rows within a gap of a record; empty: no gaps

  /// The pose at a station, linear between rows. Needs at least two rows.
  [[nodiscard]] Pose2 PoseAt(double at) const;
  /// The time at a station [s], linear between rows. Needs at least two rows.
  [[nodiscard]] double TimeAt(double at) const;
};

/// `source` selects the station of a run with a path.
Trace MakeTrace(const RunLog& log, StationSource source = StationSource::kProjection);

/// Reads the log `<plant>.csv` of a run. Throws InputError where ReadCsvExcerpt does, and if the
/// file has fewer than two rows.
/// Rows after `contact_time` [s] are left out.
Trace ReadTrace(const std::filesystem::path& file, const std::string& name,
                std::optional<double> contact_time = std::nullopt);

/// The difference in one quantity over the stations common to both runs.
struct Difference {
  double rms = 0.0;    ///< root of the mean square over arc length
  double max = 0.0;    ///< largest magnitude
  double max_s = 0.0;  ///< where [m]
  double max_t = 0.0;  ///< time of the first run there [s]
};

/// The differences between two runs at equal station.
struct PlantComparison {
  std::string first;
  std::string second;
  double from_s = 0.0;  ///< start of the common stations [m]
  double to_s = 0.0;    ///< end of the common stations [m]
  Difference position;  ///< |p_2 - p_1| [m]
  Difference heading;   ///< |psi_2 - psi_1|, in [0, pi] [rad]
  Difference yaw_rate;  ///< |psi'_2 - psi'_1| [rad/s]
  Difference steering;  ///< |delta_2 - delta_1| [rad]

  /// Whether the station ranges overlap; if not, the differences are undefined.
  [[nodiscard]] bool comparable() const { return to_s > from_s; }
};

/// A compared quantity: its names in compare.json, tolerances, messages and reports.
struct ComparedQuantity {
  const char* key;   ///< of metrics.json and of tolerances: "yaw_rate"
  const char* name;  ///< in messages: "yaw rate"
  const char* unit;
  const char* max_label;  ///< of the largest difference on a report
  const char* rms_label;
  Difference PlantComparison::*difference;
  std::optional<double> DifferenceBounds::*bound;  ///< its key in a scenario is KEY_max
};

/// Position, heading, yaw rate, steering.
const std::vector<ComparedQuantity>& ComparedQuantities();

/// Compares two runs, interpolated linearly between rows.
///
/// Guarantees: exact for runs that are linear between rows, at any spacing of the rows; the largest
/// differences are those at the rows of either run. Exchanging the runs changes `max_t` alone.
/// Cost: linear in the rows.
PlantComparison CompareTraces(const Trace& first, const Trace& second);

PlantComparison ComparePlants(const RunLog& first, const RunLog& second);

/// The signed differences over arc length, a row for every station of a row of either log: `s_m`,
/// `first_t_s`, `second_t_s`, `x_m`, `y_m`, `position_m` (unsigned), `yaw_rad`, `yaw_rate_radps`,
/// `steering_rad`.
Table DifferencesOverArcLength(const Trace& first, const Trace& second);

/// One plant of a finished run, read from its folder.
struct FinishedDrive {
  std::string status;  ///< of metrics.json: "arrived", …
  Trace trace;         ///< named after the plant
};

/// Reads the plants of a run folder in the order of metrics.json. InputError when the folder holds
/// no finished run or an interrupted one, or when columns or rows are missing in its logs.
std::vector<FinishedDrive> ReadRunFolder(const std::filesystem::path& folder);

nlohmann::ordered_json ToJson(const PlantComparison& comparison);

}  // namespace trackbed
