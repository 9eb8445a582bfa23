#pragma once

#include "trackbed/options/method_options.h"

namespace trackbed {

struct Plan;

/// How to treat a plan that exceeds the car's limits; see feasibility.h.
enum class InfeasiblePolicy {
  kSlowDown,  ///< driven more slowly if that helps, else rejected
  kRefuse,    ///< no plan
  kAllow,     ///< driven unchanged
};

/// The options of a planner. The type of the struct that it holds identifies the planner.
using PlannerOptions = MethodOptions<Plan>;

}  // namespace trackbed
