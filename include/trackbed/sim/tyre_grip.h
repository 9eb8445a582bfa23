#pragma once

#include <cstddef>

#include "trackbed/sim/car_model.h"
#include "trackbed/sim/plant_options.h"
#include "trackbed/vehicle/magic_formula.h"

namespace trackbed {

/// The largest longitudinal and lateral forces of a tyre divided by its load, on a road of factor
/// 1. The result is PeakFriction of the Magic Formula at `load` [N], or the coefficient of MuJoCo's
/// contact, which does not depend on the load. `wheel` is an index of kWheels; `law` must be
/// resolved by SelectTyreLaw.
///
/// Errors: InternalError for a vehicle without steered front wheels, or an invalid wheel.
TyreFriction FindTyreFriction(const CarModel& car, TyreLaw law, std::size_t wheel, double load);

}  // namespace trackbed
