#pragma once

#include <cstddef>

#include "trackbed/sim/car_model.h"
#include "trackbed/sim/plant_options.h"
#include "trackbed/vehicle/magic_formula.h"

namespace trackbed {

/// The largest forces of a tyre over its load, along and across, on a road of factor 1:
/// PeakFriction of the Magic Formula at `load` [N], or the coefficient of MuJoCo's contact, which
/// is the same at every load. `wheel` is an index of kWheels, and `law` is resolved by
/// SelectTyreLaw.
///
/// Errors: InternalError for a vehicle without steered front wheels, or a wheel that there is not.
TyreFriction FindTyreFriction(const CarModel& car, TyreLaw law, std::size_t wheel, double load);

}  // namespace trackbed
