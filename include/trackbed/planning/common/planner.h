#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/core/table.h"
#include "trackbed/options/method_options.h"
#include "trackbed/options/method_rules.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/common/planner_options.h"

/// The interface of planners that plan a whole path.
namespace trackbed {

/// The state in which the plans of a planner begin, which overrides the mission's state.
struct PlannedStart {
  Pose2 pose;
  double curvature = 0.0;       ///< Curvature of the path at the start, positive to the left [1/m].
  std::optional<double> speed;  ///< Speed at the start [m/s]; none: the mission's.
};

/// An additional table of a plan in the run folder.
struct PlannerTable {
  const char* file;  ///< File name, such as "convergence.csv".
  /// Makes the table, which is written if it has rows.
  Table (*make)(const PlanDiagnostics& diagnostics);
};

/// A planner in the registry (planners.h). The functions may be null, except `plan`.
struct PlannerEntry {
  const char* name;
  const char* summary;  ///< One-line summary for users.
  PlannerOptions defaults;
  Plan (*plan)(const PlanRequest& request, const PlannerOptions& options);
  std::size_t min_waypoints = 0;  ///< Minimum number of waypoints; 0: the planner takes no route.
  bool follows_track = false;   ///< Whether it follows PlanRequest::on_track, which it then needs.
  bool needs_limits = false;    ///< Whether it plans speeds at the limit, with PlanRequest::limits.
  bool follows_lanes = false;   ///< Whether it follows PlanRequest::lanes, which it then needs.
  bool keeps_clear = false;     ///< Whether it avoids the obstacles of the request.
  bool has_headings = false;    ///< Whether it meets PlanRequest::headings at the waypoints.
  bool has_gates = false;       ///< Whether its paths pass through gates (Plan::gates).
  bool goes_backwards = false;  ///< Whether its paths may contain reverse segments.
  bool searches = false;  ///< Whether it searches for a path around obstacles, within a budget.
  /// Whether it does not distinguish paths of equal cost, such as mirrored ones.
  bool has_ties = false;
  bool is_random = false;  ///< Whether its plan depends on PlanRequest::seed.
  /// Whether a plan with these options may contain reverse segments. Null: the value of
  /// goes_backwards.
  bool (*may_go_backwards)(const PlannerOptions& options) = nullptr;
  /// Whether a plan with these options may be partial (Plan::partial). Null: never.
  bool (*may_be_partial)(const PlannerOptions& options) = nullptr;

  // Rules of the options. OnOptions adapts functions that take the options struct.

  /// Checks rules that relate several keys of the planner.
  std::vector<OptionProblem> (*check)(const PlannerOptions& options,
                                      const CouldReadKey& could_read) = nullptr;
  /// Checks further rules for a planner of detours (plan.replan.detour).
  std::vector<OptionProblem> (*check_detour)(const PlannerOptions& options) = nullptr;
  /// Defaults for a planner of detours. Nullopt: `defaults`.
  std::optional<PlannerOptions> detour_defaults{};
  /// Steering angle of the bicycle model on straights [rad]. Null: 0. The key of this angle is
  /// `neutral_steering`.
  double (*neutral_steering)(const PlannerOptions& options) = nullptr;
  /// The state in which plans begin. Null or nullopt: the mission's state.
  std::optional<PlannedStart> (*start)(const PlannerOptions& options) = nullptr;

  // Input files of the options.

  /// Reads the files that the options name into the options.
  void (*read_inputs)(PlannerOptions& options, InputReader& reader) = nullptr;
  /// Returns the files of the options in the form that the run folder stores.
  std::vector<InputFile> (*input_files)(const PlannerOptions& options) = nullptr;
  std::vector<std::string> input_names{};  ///< All names that `input_files` may return.
  /// Changes the options to name the files of `input_files`.
  void (*resolve)(PlannerOptions& options) = nullptr;
  std::vector<PlannerTable> tables{};  ///< Additional tables of a plan.
};

/// Adapts a planning function that takes its options struct to PlannerEntry::plan.
template <typename Options, Plan (*PlanWith)(const Options&, const PlanRequest&)>
Plan PlanBy(const PlanRequest& request, const PlannerOptions& options) {
  return PlanWith(options.Get<Options>(), request);
}

}  // namespace trackbed
