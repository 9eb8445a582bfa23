#pragma once

#include <string>
#include <vector>

#include "trackbed/scenario/scenario.h"

/// The columns of a run log, `<plant>.csv` (docs/conventions.md).
namespace trackbed {

/// Optional contents of a log, in addition to the car's state.
struct LogContents {
  bool path = false;                      ///< errors relative to a path
  bool obstacles = false;                 ///< clearance and contact force
  bool noise = false;                     ///< the measured pose
  bool wheels = false;                    ///< tyre forces and slip
  bool gaps = false;                      ///< of a recorded drive: the validity of each row
  std::vector<std::string> controller{};  ///< SteeringController::Columns
};

/// The names of the columns, in their order. Names carry their units.
std::vector<std::string> LogColumns(const LogContents& contents);

/// The columns that the log of a plant can have in a run of the scenario. They include wheel
/// columns, except for `kinematic`, `single_track` and `recorded`, which have no wheels.
std::vector<std::string> LogColumns(const Scenario& scenario, const std::string& plant);

}  // namespace trackbed
