#pragma once

#include <array>
#include <string>
#include <vector>

#include "trackbed/scenario/scenario.h"

/// The columns of a run log, `<plant>.csv` (docs/conventions.md).
namespace trackbed {

/// Columns of a table of positions that state the local origin of the positions, in every row.
inline constexpr std::array kOriginColumns{"origin_x_m", "origin_y_m"};

/// Optional contents of a log, in addition to the car's state.
struct LogContents {
  bool path = false;  ///< Whether the log has cross-track and heading errors relative to a path.
  /// Whether the log has the clearance to obstacles and the contact force.
  bool obstacles = false;
  /// Whether the log has columns for the measured pose, which includes measurement noise.
  bool noise = false;
  bool wheels = false;  ///< Whether the log has tyre forces and slip.
  bool abs = false;     ///< Whether the log has the states of anti-lock brakes.
  bool esc = false;     ///< Whether the log has the states of stability control.
  /// Whether the log has the torque of a locked or limited-slip differential.
  bool differential = false;
  bool trailer = false;  ///< Whether the log has the state of a trailer.
  /// Whether the log has a column that states the validity of each row of a recorded drive.
  bool gaps = false;
  bool origin = false;  ///< Whether the log states the local origin of its coordinates.
  /// Names of the controller's columns, from SteeringController::Columns.
  std::vector<std::string> controller{};
};

/// Returns the names of the log's columns, including units, in the order of the file.
std::vector<std::string> LogColumns(const LogContents& contents);

/// Returns the names of the columns that the log of a plant may have in the scenario. The names
/// include the columns for the wheels and the driver aids, unless the plant is `kinematic`,
/// `single_track` or `recorded`, which have no wheels.
std::vector<std::string> LogColumns(const Scenario& scenario, const std::string& plant);

}  // namespace trackbed
