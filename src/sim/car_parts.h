#pragma once

#include <string>
#include <variant>

#include "trackbed/sim/car_model.h"

namespace trackbed {

/// Parts and parameters of a vehicle, read from its compiled model.
struct VehicleDescription {
  std::variant<CarParts, WheelPairParts> parts;
  VehicleParams params;
};

/// Text that lists the tyre coefficients that a car must have if it has any: the required
/// MagicFormulaFields.
inline constexpr const char* kNeededCoefficients =
    "p_cx1, p_dx1, p_kx1, p_cy1, p_dy1 and p_ky1, of both axles under these names or of each with "
    "_front and _rear";

/// MJCF names of the body and the keyframe that WithPayload adds.
inline constexpr const char* kPayloadBody = "payload";
inline constexpr const char* kLadenKeyframe = "laden";

/// Returns the parts of a car. Throws InputError naming the car's file if the car has no steered
/// wheels. The message also names the feature that needs the parts, `needed_by`.
const CarParts& SteeredParts(const CarModel& car, const std::string& needed_by);

/// Returns the tyre parameters of a car. If the car's file has none, throws InputError naming the
/// file and the missing coefficients.
const CarTyres& RequireTyres(const CarModel& car, const std::string& needed_by);

/// Finds and checks the parts of a vehicle in its compiled model. Throws InputError naming `file`
/// and every missing part. If all parts exist, the error lists every part that violates
/// docs/models.md.
VehicleDescription DescribeVehicle(const mjModel_& model, const std::string& file);

}  // namespace trackbed
