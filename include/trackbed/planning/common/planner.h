#pragma once

#include <cstddef>

#include "trackbed/options/method_options.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/common/planner_options.h"

/// The interface of everything that plans a whole path.
namespace trackbed {

/// A planner in the registry (planners.h).
struct PlannerEntry {
  const char* name;
  const char* summary;  ///< for people, on one line
  PlannerOptions defaults;
  Plan (*plan)(const PlanRequest& request, const PlannerOptions& options);
  std::size_t min_waypoints = 0;  ///< least number of waypoints; 0: takes no route
  bool follows_track = false;     ///< leads along PlanRequest::on_track, and needs one
  bool needs_limits = false;      ///< plans for speeds at the limit: needs PlanRequest::limits
  bool follows_lanes = false;     ///< leads along PlanRequest::lanes, and needs them
  bool keeps_clear = false;       ///< avoids the obstacles of the request
  bool has_headings = false;      ///< meets PlanRequest::headings at the waypoints
  bool goes_backwards = false;    ///< its paths may contain reverse segments
  bool searches = false;          ///< searches for a path around obstacles, within a budget
  bool has_ties = false;   ///< does not distinguish paths of equal cost, such as mirrored ones
  bool is_random = false;  ///< its plan depends on PlanRequest::seed
  /// Whether a plan with these options may contain reverse segments; null: goes_backwards.
  bool (*may_go_backwards)(const PlannerOptions& options) = nullptr;
  /// Whether a plan with these options may be partial (Plan::partial); null: no.
  bool (*may_be_partial)(const PlannerOptions& options) = nullptr;
};

/// Adapts a planning function that takes its own options struct to PlannerEntry::plan.
template <typename Options, Plan (*PlanWith)(const Options&, const PlanRequest&)>
Plan PlanBy(const PlanRequest& request, const PlannerOptions& options) {
  return PlanWith(options.Get<Options>(), request);
}

}  // namespace trackbed
