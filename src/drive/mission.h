#pragma once

#include <functional>
#include <vector>

#include "trackbed/planning/common/feasibility.h"
#include "trackbed/planning/common/limit_profile.h"
#include "trackbed/scenario/scenario.h"
#include "trackbed/vehicle/params.h"

namespace trackbed {

/// Returns the car's g-g-v diagram for the friction coefficients of the roads of a world.
using DiagramOfRoads = std::function<GgvDiagram(const std::vector<double>& roads)>;

/// Plans the mission of a scenario, and adds notes for the user to the plan. PlanMission calls
/// `diagram` only if the mission asks for speeds at the car's limit.
FeasiblePlan PlanMission(const Scenario& scenario, const VehicleParams& vehicle,
                         const DiagramOfRoads& diagram);

}  // namespace trackbed
