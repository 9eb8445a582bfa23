#pragma once

#include "trackbed/sim/car_model.h"
#include "trackbed/sim/plant_options.h"
#include "trackbed/vehicle/grip_model.h"

namespace trackbed {

/// The tyres, springs, brakes and drive of a car without its payload, for its g-g-v diagram.
///
/// The roll stiffness of an axle results from the slide joints between wheels and chassis and the
/// fixed tendons over these joints. The springs of Magic Formula tyres are in series with that
/// stiffness. An axle without springs on contact tyres has no stiffness in the model, and gets 1e7
/// N m/rad for each ton. `law` must be resolved by SelectTyreLaw. InternalError for a vehicle
/// without steered front wheels.
GripModel MakeGripModel(const CarModel& car, TyreLaw law);

/// The diagram of a vehicle on roads of the given friction factors. The diagram is that of
/// ComputeGgv for a car, and that of FrictionGgv for a vehicle with differential drive. Braking is
/// limited to MaxDeceleration, which no command exceeds.
GgvDiagram ComputeGgv(const CarModel& car, TyreLaw law, const std::vector<double>& roads);

}  // namespace trackbed
