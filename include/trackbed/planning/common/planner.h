#pragma once

#include <cstddef>

#include "trackbed/options/method_options.h"
#include "trackbed/planning/common/plan.h"

/// The interface of everything that plans a whole path.
namespace trackbed {

/// The options of one planner; which struct it holds says which planner is meant.
using PlannerOptions = MethodOptions<Plan>;

/// A planner in the registry (planners.h).
struct PlannerEntry {
  const char* name;
  const char* summary;  ///< for people, on one line
  PlannerOptions defaults;
  Plan (*plan)(const PlanRequest& request, const PlannerOptions& options);
  std::size_t min_waypoints = 0;  ///< that it can plan with; 0: it needs no route
  bool keeps_clear = false;       ///< it knows obstacles and keeps clear of them itself
  bool has_headings = false;      ///< it leads through the waypoints with headings
  bool goes_backwards = false;    ///< it may
  bool searches = false;   ///< as long as its budget lasts; so it finds paths around obstacles
  bool has_ties = false;   ///< of paths that cost the same it takes any, mirrored or not
  bool is_random = false;  ///< another seed, another plan
  /// Whether a plan with these options may lead backwards somewhere; null: goes_backwards.
  bool (*may_go_backwards)(const PlannerOptions& options) = nullptr;
  /// Whether it may lead only part of the way (Plan::partial); null: no.
  bool (*may_be_partial)(const PlannerOptions& options) = nullptr;
};

/// A PlannerEntry::plan of a function that takes the options themselves.
template <typename Options, Plan (*PlanWith)(const Options&, const PlanRequest&)>
Plan PlanBy(const PlanRequest& request, const PlannerOptions& options) {
  return PlanWith(options.Get<Options>(), request);
}

}  // namespace trackbed
