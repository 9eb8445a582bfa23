#pragma once

#include <mujoco/mujoco.h>

#include <string>

namespace trackbed {

/// Returns the quoted name of a body, joint, geom or actuator; for an unnamed object, its number.
std::string ObjectName(const mjModel& model, int type, int id);

}  // namespace trackbed
