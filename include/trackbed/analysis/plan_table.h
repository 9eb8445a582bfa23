#pragma once

#include "trackbed/core/table.h"
#include "trackbed/planning/common/plan.h"

namespace trackbed {

/// Returns the content of plan.csv: points of the path at most 0.1 m apart, with their speeds and
/// times (docs/conventions.md). Every cusp, stop and wait of the plan is a point of the table. The
/// times in plan.csv are those of a car that follows the planned speeds and waits, without the time
/// in which wheels turn at rest. A wait adds a second row at the same place, whose time is later by
/// the duration of the wait. The plan must be ok. Computing time: about 1 us per row of plan.csv.
Table PlanTable(const Plan& plan);

}  // namespace trackbed
