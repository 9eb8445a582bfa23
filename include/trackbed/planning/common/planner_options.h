#pragma once

#include "trackbed/options/method_options.h"

namespace trackbed {

struct Plan;

/// Policy for a plan that exceeds the car's limits (feasibility.h).
enum class InfeasiblePolicy {
  kSlowDown,  ///< Slow the plan down if lower speeds meet the limits, else reject the plan.
  kRefuse,    ///< Reject the plan.
  kAllow,     ///< Drive the plan unchanged, beyond the car's limits.
};

/// The options of any planner. The type of the contained options struct identifies the planner.
using PlannerOptions = MethodOptions<Plan>;

}  // namespace trackbed
