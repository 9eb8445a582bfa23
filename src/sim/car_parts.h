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

/// Names of the coefficients that a car with a tyre description must have. The names are those of
/// the required MagicFormulaFields.
inline constexpr const char* kNeededCoefficients =
    "p_cx1, p_dx1, p_kx1, p_cy1, p_dy1 and p_ky1, of both axles under these names or of each with "
    "_front and _rear";

/// Names of the elements that WithPayload adds.
inline constexpr const char* kPayloadBody = "payload";
inline constexpr const char* kLadenKeyframe = "laden";

/// The parts of a car. SteeredParts throws InputError naming the car's file if the car has no
/// steered wheels. Messages name `needed_by`, the feature that needs the parts.
const CarParts& SteeredParts(const CarModel& car, const std::string& needed_by);

/// The tyres of a car. RequireTyres throws InputError naming the car's file and the missing
/// coefficients if the car has no tyres.
const CarTyres& RequireTyres(const CarModel& car, const std::string& needed_by);

/// Throws InputError naming `file` and every missing part. If all parts exist, the error names
/// every part that does not meet the requirements of docs/models.md.
VehicleDescription DescribeVehicle(const mjModel_& model, const std::string& file);

}  // namespace trackbed
