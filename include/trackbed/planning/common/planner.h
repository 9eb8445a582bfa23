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

/// The state in which the plans of a planner begin. This state overrides the start state of the
/// mission.
struct PlannedStart {
  Pose2 pose;
  double curvature = 0.0;       ///< Curvature of the path at the start, positive to the left [1/m].
  std::optional<double> speed;  ///< Speed at the start [m/s]; none: the start speed of the mission.
};

/// An additional table of a plan in the run folder.
struct PlannerTable {
  const char* file;  ///< File name, such as "convergence.csv".
  /// Makes the table. The run folder contains the table only if it has rows.
  Table (*make)(const PlanDiagnostics& diagnostics);
};

/// A planner in the registry (planners.h). All functions except `plan` may be null.
struct PlannerEntry {
  const char* name;
  const char* summary;  ///< One-line summary for users.
  PlannerOptions defaults;
  Plan (*plan)(const PlanRequest& request, const PlannerOptions& options);
  std::size_t min_waypoints = 0;  ///< Minimum number of waypoints; 0: the planner takes no route.
  /// Whether the planner follows a track, and thus needs PlanRequest::on_track.
  bool follows_track = false;
  /// Whether the planner always plans speeds at the car's limit, and thus needs
  /// PlanRequest::limits.
  bool needs_limits = false;
  /// Whether the planner follows lanes, and thus needs PlanRequest::lanes.
  bool follows_lanes = false;
  bool keeps_clear = false;   ///< Whether the planner avoids the obstacles of the request.
  bool has_headings = false;  ///< Whether the planner meets PlanRequest::headings at the waypoints.
  bool has_gates = false;     ///< Whether the planned paths pass through gates (Plan::gates).
  bool goes_backwards = false;  ///< Whether the planned paths may contain reverse segments.
  /// Whether the planner searches for a path around obstacles, within a budget.
  bool searches = false;
  /// Whether the choice between paths of equal cost, such as mirrored paths, is arbitrary.
  bool has_ties = false;
  bool is_random = false;  ///< Whether the plan depends on PlanRequest::seed.
  /// Returns whether a plan with these options may contain reverse segments. If null,
  /// goes_backwards applies.
  bool (*may_go_backwards)(const PlannerOptions& options) = nullptr;
  /// Returns whether a plan with these options may be partial (Plan::partial). If null, no plan may
  /// be partial.
  bool (*may_be_partial)(const PlannerOptions& options) = nullptr;

  // Rules of the options. OnOptions adapts functions that take the options struct.

  /// Checks rules that relate several keys of the planner.
  std::vector<OptionProblem> (*check)(const PlannerOptions& options,
                                      const CouldReadKey& could_read) = nullptr;
  /// Checks further rules for a planner of detours (plan.replan.detour).
  std::vector<OptionProblem> (*check_detour)(const PlannerOptions& options) = nullptr;
  /// Default options of the planner when it plans detours. If nullopt, `defaults` applies.
  std::optional<PlannerOptions> detour_defaults{};
  /// Returns the steering angle of the bicycle model on straights [rad]. If null, the angle is 0.
  /// The option of this angle has the key `neutral_steering`.
  double (*neutral_steering)(const PlannerOptions& options) = nullptr;
  /// Returns the state in which plans begin. If null, or if the result is nullopt, plans begin in
  /// the start state of the mission.
  std::optional<PlannedStart> (*start)(const PlannerOptions& options) = nullptr;

  // Input files of the options.

  /// Reads the files that the options name into the options.
  void (*read_inputs)(PlannerOptions& options, InputReader& reader) = nullptr;
  /// Returns the files of the options in the form that the run folder stores.
  std::vector<InputFile> (*input_files)(const PlannerOptions& options) = nullptr;
  std::vector<std::string> input_names{};  ///< All names that `input_files` may return.
  /// Changes the options so that they name the files of `input_files`.
  void (*resolve)(PlannerOptions& options) = nullptr;
  std::vector<PlannerTable> tables{};  ///< Additional tables of a plan.
};

/// Adapts a planning function that takes its options struct to PlannerEntry::plan.
template <typename Options, Plan (*PlanWith)(const Options&, const PlanRequest&)>
Plan PlanBy(const PlanRequest& request, const PlannerOptions& options) {
  return PlanWith(options.Get<Options>(), request);
}

}  // namespace trackbed
