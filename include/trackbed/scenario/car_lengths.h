#pragma once

#include "trackbed/options/key_visitor.h"
#include "trackbed/scenario/scenario.h"

namespace trackbed {

/// Length of the smallest car for which the default lengths of planners are meant [m].
inline constexpr double kFullSizeCar = 4.0;

/// Returns whether the default of a key of the section `plan` is a length that scales with the size
/// of the car. Lengths that scale with the car are distances from obstacles, cells and margins of
/// searches, and costs as a path length. `method` is the method of the key's section. Lengths that
/// describe the route, the file of a path or a standard maneuver do not scale with the car.
bool FollowsCarSize(const Key& key, const std::string& method);

/// Returns the factor by which default lengths are multiplied for the scenario's car: min(1,
/// length/kFullSizeCar). Returns 1 if the car cannot be loaded; another function reports this error
/// later. Cost: the compilation of the car's model, except for the default car.
double CarLengthScale(const Scenario& scenario);

}  // namespace trackbed
