#pragma once

#include "trackbed/sim/car_model.h"
#include "trackbed/sim/plant_options.h"
#include "trackbed/vehicle/grip_model.h"

namespace trackbed {

/// Returns the tyres, springs, brakes and drive of a car without its payload, from which its g-g-v
/// diagram is computed.
///
/// The roll stiffness of an axle results from the slide joints between wheels and chassis, and from
/// the fixed tendons on these joints. The vertical springs of Magic Formula tyres are in series
/// with these springs. If an axle has neither suspension springs nor Magic Formula tyres, its roll
/// stiffness is set to 1e7 N m/rad for each ton of the car. `law` must not be kAuto (see
/// SelectTyreLaw). Throws InternalError for a vehicle without steered front wheels.
GripModel MakeGripModel(const CarModel& car, TyreLaw law);

/// Computes the g-g-v diagram of a vehicle on roads with the given friction factors. A vehicle with
/// differential drive has the diagram of FrictionGgv. The deceleration of a car is limited to
/// MaxDeceleration, which no command exceeds.
GgvDiagram ComputeGgv(const CarModel& car, TyreLaw law, const std::vector<double>& roads);

}  // namespace trackbed
