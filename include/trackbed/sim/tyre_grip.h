#pragma once

#include <cstddef>

#include "trackbed/sim/car_model.h"
#include "trackbed/sim/plant_options.h"
#include "trackbed/vehicle/magic_formula.h"

namespace trackbed {

/// Returns the largest longitudinal and lateral force of a tyre, divided by the tyre's load, on a
/// road with the friction factor 1. For the Magic Formula, the returned friction is PeakFriction at
/// the tyre load `load` [N]. For contact tyres, the returned friction is MuJoCo's friction
/// coefficient, which does not depend on the load. The argument `wheel` is an index of kWheels;
/// `law` must not be kAuto (see SelectTyreLaw).
///
/// Errors: throws InternalError if the vehicle has no steered front wheels, or if `wheel` is
/// invalid.
TyreFriction FindTyreFriction(const CarModel& car, TyreLaw law, std::size_t wheel, double load);

}  // namespace trackbed
