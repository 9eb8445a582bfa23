#pragma once

#include <cstddef>

#include "trackbed/sim/car_model.h"
#include "trackbed/sim/plant_options.h"
#include "trackbed/vehicle/magic_formula.h"

namespace trackbed {

/// Returns the largest longitudinal and lateral force of a tyre, divided by the tyre's load, on a
/// road with friction factor 1. With the Magic Formula, the result is PeakFriction at `load` [N].
/// With contact tyres, the result is MuJoCo's friction coefficient, which does not depend on the
/// load. `wheel` is an index of kWheels; `law` must not be kAuto (see SelectTyreLaw).
///
/// Errors: InternalError for a vehicle without steered front wheels, or for an invalid wheel.
TyreFriction FindTyreFriction(const CarModel& car, TyreLaw law, std::size_t wheel, double load);

}  // namespace trackbed
