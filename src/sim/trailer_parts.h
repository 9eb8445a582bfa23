#pragma once

#include <array>
#include <optional>

#include "trackbed/sim/car_model.h"

struct mjModel_;

namespace trackbed {

/// MJCF names of the body and the numeric that WithTrailer adds to a model.
inline constexpr const char* kTrailerBody = "trailer";
inline constexpr const char* kTrailerNumeric = "trailer";
/// Suffixes of the names of the trailer's wheels.
inline constexpr std::array kTrailerSides{"trailer_left", "trailer_right"};
/// Names of the joints of the hitch, from the car to the trailer.
inline constexpr std::array kHitchJoints{"hitch_yaw", "hitch_pitch", "hitch_roll"};

/// Finds the parts of the trailer that WithTrailer added to a model; nullopt without a trailer.
std::optional<TrailerParts> FindTrailer(const mjModel_& model);

/// Returns whether the given body of the model belongs to the trailer.
bool IsOfTrailer(const mjModel_& model, const TrailerParts& trailer, int body);

/// Returns the trailer's mass plus the rotational inertia of its wheels as an equivalent mass [kg].
double RollingMass(const TrailerParts& trailer);

/// Returns the trailer's mass times the sine of the slope under its axle along its heading,
/// positive uphill, for a car at the pose `car` [kg].
double TrailerClimb(const TrailerParams& trailer, const Ground& ground, const Pose2& car,
                    double angle);

/// Returns the loads that the trailer's nose adds to the front and the rear axle of a car with the
/// given wheelbase at rest [N].
std::array<double, 2> NoseLoads(const TrailerParams& trailer, double wheelbase, double gravity);

}  // namespace trackbed
