#pragma once

#include <string>
#include <string_view>
#include <variant>

#include "trackbed/sim/car_model.h"

namespace trackbed {

/// Parts and parameters of a vehicle, read from its compiled model.
struct VehicleDescription {
  std::variant<CarParts, WheelPairParts> parts;
  VehicleParams params;
};

/// Text for error messages that lists the MagicFormulaFields that a car with tyre coefficients must
/// have.
inline constexpr const char* kNeededCoefficients =
    "p_cx1, p_dx1, p_kx1, p_cy1, p_dy1 and p_ky1, of both axles under these names or of each with "
    "_front and _rear";

/// MJCF names of the body and the keyframe that WithPayload adds to a model.
inline constexpr const char* kPayloadBody = "payload";
inline constexpr const char* kLadenKeyframe = "laden";

/// Returns the parts (wheels, joints, actuators) of a car with steered wheels. Throws InputError,
/// naming the car's file and the feature `needed_by`, if the car has no steered wheels.
const CarParts& SteeredParts(const CarModel& car, std::string_view needed_by);

/// Returns the tyre parameters of a car. Throws InputError, naming the car's file and the missing
/// coefficients, if the file has no tyre coefficients.
const CarTyres& RequireTyres(const CarModel& car, std::string_view needed_by);

/// Finds and checks the parts of a vehicle in its compiled model. Throws InputError, naming `file`
/// and every missing part, if parts are missing. Throws InputError, listing every part that
/// violates docs/models.md, if all parts exist but some are invalid.
VehicleDescription DescribeVehicle(const mjModel_& model, const std::string& file);

}  // namespace trackbed
