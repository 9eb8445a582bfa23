#pragma once

#include <string>

struct mjModel_;

namespace trackbed {

/// Checks a compiled model before anything is read from it: every number is finite and of a
/// magnitude that a vehicle can have, gravity points down, and the names of joints, which are
/// columns of logs, are plain and differ.
///
/// InputError with every problem, each under the name of the body, joint, geom or number.
void CheckModel(const mjModel_& model, const std::string& file);

}  // namespace trackbed
