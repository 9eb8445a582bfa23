#pragma once

#include "trackbed/options/method_options.h"

namespace trackbed {

struct Plan;

/// What becomes of a plan that asks more of the car than it can do; see feasibility.h.
enum class InfeasiblePolicy {
  kSlowDown,  ///< driven more slowly where that helps, else refused
  kRefuse,    ///< no plan
  kAllow,     ///< driven as it is, to see what happens
};

/// The options of a planner. The type of the struct that it holds identifies the planner.
using PlannerOptions = MethodOptions<Plan>;

}  // namespace trackbed
