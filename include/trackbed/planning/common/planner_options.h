#pragma once

#include "trackbed/options/method_options.h"

namespace trackbed {

struct Plan;

/// How to treat a plan that exceeds the car's limits (feasibility.h).
enum class InfeasiblePolicy {
  kSlowDown,  ///< Slow the plan down if that helps, else reject it.
  kRefuse,    ///< Reject the plan.
  kAllow,     ///< Drive the plan unchanged.
};

/// The options of a planner. The type of the contained struct identifies the planner.
using PlannerOptions = MethodOptions<Plan>;

}  // namespace trackbed
