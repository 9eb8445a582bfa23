#pragma once

#include <string>

struct mjModel_;

namespace trackbed {

/// Checks a compiled model before any of its data is used. Every number must be finite and within
/// the range of a vehicle, and gravity must point down. Names of joints, which become log columns,
/// must be plain and unique.
///
/// Throws InputError with every problem, each under the name of the body, joint, geom or number.
void CheckModel(const mjModel_& model, const std::string& file);

}  // namespace trackbed
