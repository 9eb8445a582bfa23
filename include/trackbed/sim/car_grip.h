#pragma once

#include "trackbed/sim/car_model.h"
#include "trackbed/sim/plant_options.h"
#include "trackbed/vehicle/grip_model.h"

namespace trackbed {

/// Returns the properties of a car without payload (tyres, springs, brakes and drive) from which
/// the g-g-v diagram of the car is computed.
///
/// The roll stiffness of an axle results from the slide joints between wheels and chassis, and from
/// the fixed tendons on these joints. Magic Formula tyres act as additional vertical springs in
/// series with the suspension. If an axle has neither suspension springs nor Magic Formula tyres,
/// its roll stiffness is set to 1e7 N m/rad per ton of car mass. The tyre law `law` must not be
/// kAuto (see SelectTyreLaw). Throws InternalError for a vehicle without steered front wheels.
GripModel MakeGripModel(const CarModel& car, TyreLaw law);

/// Computes the g-g-v diagram of a vehicle on roads with the friction factors `roads`. For a
/// vehicle with differential drive, the result is the diagram of FrictionGgv. The deceleration of a
/// car is limited to MaxDeceleration, because commands never exceed MaxDeceleration.
GgvDiagram ComputeGgv(const CarModel& car, TyreLaw law, const std::vector<double>& roads);

}  // namespace trackbed
