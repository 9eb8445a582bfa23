#pragma once

#include <string>
#include <vector>

#include "trackbed/scenario/scenario.h"

/// The columns of a run log, `<plant>.csv` (docs/conventions.md).
namespace trackbed {

/// Optional contents of a log, in addition to the car's state.
struct LogContents {
  bool path = false;                      ///< Has errors relative to a path.
  bool obstacles = false;                 ///< Has clearance and contact force.
  bool noise = false;                     ///< Has a measured pose.
  bool wheels = false;                    ///< Has tyre forces and slip.
  bool gaps = false;                      ///< Has the validity of each row of a recorded drive.
  std::vector<std::string> controller{};  ///< Names from SteeringController::Columns.
};

/// The names of the columns, in order. The names include units.
std::vector<std::string> LogColumns(const LogContents& contents);

/// The columns that the log of a plant may have for the scenario. The columns include those of the
/// wheels, except for `kinematic`, `single_track` and `recorded`, which have no wheels.
std::vector<std::string> LogColumns(const Scenario& scenario, const std::string& plant);

}  // namespace trackbed
