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

/// Coefficients that a car with a tyre description must have: the required MagicFormulaFields.
inline constexpr const char* kNeededCoefficients =
    "p_cx1, p_dx1, p_kx1, p_cy1, p_dy1 and p_ky1, of both axles under these names or of each with "
    "_front and _rear";

/// Names of the elements that WithPayload adds.
inline constexpr const char* kPayloadBody = "payload";
inline constexpr const char* kLadenKeyframe = "laden";

/// The parts of a car; InputError naming its file if it has no steered wheels. `needed_by` names
/// the feature that needs them.
const CarParts& SteeredParts(const CarModel& car, const std::string& needed_by);

/// The car's tyres; InputError naming its file and the missing coefficients if it has none.
const CarTyres& RequireTyres(const CarModel& car, const std::string& needed_by);

/// InputError naming `file` and every missing part; if all are there, every part that does not meet
/// the requirements of docs/models.md.
VehicleDescription DescribeVehicle(const mjModel_& model, const std::string& file);

}  // namespace trackbed
