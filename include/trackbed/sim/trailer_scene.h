#pragma once

#include "trackbed/sim/car_model.h"

namespace trackbed {

/// Returns the scene of a car with a trailer. On level ground, the car stands as it does without
/// the trailer: a preload of the car's springs carries the trailer's nose.
///
/// The trailer is the body `trailer` below the chassis. Three hinges at the hitch (hitch_yaw,
/// hitch_pitch and hitch_roll) together act as a ball joint. The trailer's wheels, tyres, spring
/// travel and damping follow from the car's rear axle. The unsprung masses of trailer and car have
/// the same ratio as the total masses. At rest, the trailer's springs are deflected by 0.35 wheel
/// radii; their damping ratio is 0.3. A car without springs gets a trailer without springs. The
/// trailer's wheels have neither brakes nor bearing friction. The numbers of the trailer are in the
/// <custom> numeric `trailer`.
///
/// Throws InputError if the car has no steered front wheels, if the car already has a trailer, or
/// if the trailer's yaw inertia is less than that of the trailer's wheels.
Scene WithTrailer(const CarModel& car, const TrailerParams& trailer);

}  // namespace trackbed
