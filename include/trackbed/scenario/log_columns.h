#pragma once

#include <string>
#include <vector>

#include "trackbed/scenario/scenario.h"

/// The columns of a run log, `<plant>.csv` (docs/conventions.md).
namespace trackbed {

/// What a log has besides the car's state.
struct LogContents {
  bool path = false;                      ///< errors against one
  bool obstacles = false;                 ///< clearance and contact force
  bool noise = false;                     ///< the measured pose
  bool wheels = false;                    ///< tyre forces and slip
  bool gaps = false;                      ///< of a recorded drive: whether a row is valid
  std::vector<std::string> controller{};  ///< SteeringController::Columns
};

/// The names of the columns, in their order. Names carry their units.
std::vector<std::string> LogColumns(const LogContents& contents);

/// The columns that the log of a plant can have in a run of the scenario. Those of wheels are among
/// them for every plant but `kinematic`, `single_track` and `recorded`, which have none.
std::vector<std::string> LogColumns(const Scenario& scenario, const std::string& plant);

}  // namespace trackbed
