#pragma once

#include <string>
#include <vector>

#include "trackbed/scenario/scenario.h"

/// The columns of a run log, `<plant>.csv` (docs/conventions.md).
namespace trackbed {

/// Optional contents of a log, in addition to the car's state.
struct LogContents {
  bool path = false;       ///< Whether the log has errors relative to a path.
  bool obstacles = false;  ///< Whether the log has clearance and contact force.
  bool noise = false;      ///< Whether the log has a measured pose.
  bool wheels = false;     ///< Whether the log has tyre forces and slip.
  bool gaps = false;       ///< Whether the log has the validity of each row of a recorded drive.
  std::vector<std::string> controller{};  ///< Column names from SteeringController::Columns.
};

/// Returns the names of the columns, including units, in order.
std::vector<std::string> LogColumns(const LogContents& contents);

/// Returns the columns that the log of a plant may have for the scenario. Columns of the wheels are
/// included, except for the plants `kinematic`, `single_track` and `recorded`, which have no
/// wheels.
std::vector<std::string> LogColumns(const Scenario& scenario, const std::string& plant);

}  // namespace trackbed
