#pragma once

#include <string>
#include <variant>

#include "trackbed/sim/car_model.h"

namespace trackbed {

/// What Trackbed knows of a vehicle, read from its compiled model.
struct VehicleDescription {
  std::variant<CarParts, WheelPairParts> parts;
  VehicleParams params;
};

/// What a car whose tyres are described must say of them; MagicFormulaFields' required ones.
inline constexpr const char* kNeededCoefficients =
    "p_cx1, p_dx1, p_kx1, p_cy1, p_dy1 and p_ky1, of both axles under these names or of each with "
    "_front and _rear";

/// Names of what WithPayload adds.
inline constexpr const char* kPayloadBody = "payload";
inline constexpr const char* kLadenKeyframe = "laden";

/// The parts of a car; InputError naming its file when it has no steered wheels. `needed_by` is
/// what cannot do without.
const CarParts& SteeredParts(const CarModel& car, const std::string& needed_by);

/// The car's tyres; InputError naming its file and what is missing there when it has none.
const CarTyres& RequireTyres(const CarModel& car, const std::string& needed_by);

/// InputError naming `file` and every part that is missing; or, when all are there, every one that
/// is not as docs/models.md asks.
VehicleDescription DescribeVehicle(const mjModel_& model, const std::string& file);

}  // namespace trackbed
