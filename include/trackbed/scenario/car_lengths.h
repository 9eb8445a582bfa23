#pragma once

#include "trackbed/options/key_visitor.h"
#include "trackbed/scenario/scenario.h"

namespace trackbed {

/// Length of the smallest car for which the default lengths of planners are meant [m].
inline constexpr double kFullSizeCar = 4.0;

/// Returns whether the default of a key of the section `plan` is a length that scales with the size
/// of the car. The lengths that scale with the car are distances from obstacles, cells and margins
/// of searches, and costs in meters of path. The argument `method` is the name of the method to
/// which the key belongs. Lengths that describe the route, the file of a path or a standard
/// maneuver do not scale with the car.
bool FollowsCarSize(const Key& key, const std::string& method);

/// Returns the factor by which default lengths are multiplied for the scenario's car: min(1,
/// length/kFullSizeCar). Returns the factor 1 if the car cannot be loaded, an error that another
/// function reports later. CarLengthScale compiles the car's model, unless the model is the default
/// car.
double CarLengthScale(const Scenario& scenario);

}  // namespace trackbed
