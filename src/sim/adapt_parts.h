#pragma once

#include <string>
#include <vector>

#include "src/sim/adapt_limits.h"

namespace trackbed::adapt {

/// Masses of the parts of the proposed vehicle. All parts together have the mass, center of gravity
/// and inertia of the model.
struct PartMasses {
  MassSum total;
  MassSum chassis;
  MassSum rack;                   ///< Steering rack, a part of cars only.
  std::vector<MassSum> knuckles;  ///< Knuckle of each wheel; its mass is 0 if the wheel has no
                                  ///< knuckle.
  std::vector<MassSum> wheels;
};

/// Splits the mass of the model among the parts of the proposed vehicle. Wheels and knuckles become
/// symmetric about their axes; the chassis gets the remaining mass and inertia.
PartMasses SplitMasses(const FoundModel& found, const FoundVehicle& vehicle, bool has_springs,
                       Findings& findings);

/// The box around the vehicle, in the vehicle frame V, symmetric about y = 0.
struct Footprint {
  double rear = 0.0;   ///< Smallest x [m].
  double front = 0.0;  ///< Largest x [m].
  double half_width = 0.0;
  double height = 0.0;
};

Footprint FindFootprint(const FoundModel& found, const FoundVehicle& vehicle);

/// Returns the position of a wheel's center in the proposed file, in the vehicle frame V.
Vector HubOf(const FoundVehicle& vehicle, std::size_t wheel);

/// MJCF text of the vehicle's visible geoms, which are copied only for drawing.
struct CopiedLooks {
  std::string meshes;               ///< For <asset>.
  std::vector<std::string> wheels;  ///< One for each wheel.
  std::string chassis;
};

/// Copies the vehicle's visible geoms. Meshes become boxes if `as_boxes` is true, or if they have
/// many faces.
CopiedLooks CopyLooks(const FoundModel& found, const FoundVehicle& vehicle, bool as_boxes);

}  // namespace trackbed::adapt
