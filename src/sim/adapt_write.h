#pragma once

#include <string>

#include "src/sim/adapt_parts.h"

namespace trackbed::adapt {

/// Data from which the proposed car file is written.
struct Proposal {
  std::string name;    ///< Name of the model.
  std::string source;  ///< Name of the file that was adapted.
  FoundLimits limits;
  PartMasses masses;
  Footprint footprint;
  CopiedLooks looks;
  double gravity = 9.81;  ///< [m/s^2]
  bool has_springs = false;
  /// Positions in the vehicle frame V at which a vehicle with differential drive stands on casters
  /// or skids [m]; z is the radius of the ball that represents the support.
  std::vector<Vector> supports;
};

/// Returns the MJCF text of a car with steered wheels.
std::string WriteCar(const FoundModel& found, const FoundVehicle& vehicle, const Proposal& proposal,
                     const Findings& findings);

/// Returns the MJCF text of a vehicle with differential drive.
std::string WriteWheelPair(const FoundVehicle& vehicle, const Proposal& proposal,
                           const Findings& findings);

}  // namespace trackbed::adapt
