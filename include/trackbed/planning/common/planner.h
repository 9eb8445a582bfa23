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

/// The interface of planners of a whole path.
namespace trackbed {

/// The state in which a planner's plans begin, whatever the mission says.
struct PlannedStart {
  Pose2 pose;
  double curvature = 0.0;       ///< of the path there, positive to the left [1/m]
  std::optional<double> speed;  ///< [m/s]; none: the mission's
};

/// A further table of a plan in the run folder.
struct PlannerTable {
  const char* file;  ///< its name: "convergence.csv"
  /// The table; it is written if it has rows.
  Table (*make)(const PlanDiagnostics& diagnostics);
};

/// A planner in the registry (planners.h). The functions may be null, except `plan`.
struct PlannerEntry {
  const char* name;
  const char* summary;  ///< one line, for users
  PlannerOptions defaults;
  Plan (*plan)(const PlanRequest& request, const PlannerOptions& options);
  std::size_t min_waypoints = 0;  ///< minimum number of waypoints; 0: takes no route
  bool follows_track = false;     ///< follows PlanRequest::on_track, which it needs
  bool needs_limits = false;      ///< plans speeds at the limit: needs PlanRequest::limits
  bool follows_lanes = false;     ///< follows PlanRequest::lanes, which it needs
  bool keeps_clear = false;       ///< avoids the obstacles of the request
  bool has_headings = false;      ///< meets PlanRequest::headings at the waypoints
  bool has_gates = false;         ///< leads through gates: Plan::gates
  bool goes_backwards = false;    ///< its paths may contain reverse segments
  bool searches = false;          ///< searches for a path around obstacles, within a budget
  bool has_ties = false;   ///< does not distinguish paths of equal cost, such as mirrored ones
  bool is_random = false;  ///< its plan depends on PlanRequest::seed
  /// Whether a plan with these options may contain reverse segments; null: goes_backwards.
  bool (*may_go_backwards)(const PlannerOptions& options) = nullptr;
  /// Whether a plan with these options may be partial (Plan::partial); null: no.
  bool (*may_be_partial)(const PlannerOptions& options) = nullptr;

  // Rules of the options. OnOptions adapts functions that take the options struct.

  /// Rules between the planner's keys.
  std::vector<OptionProblem> (*check)(const PlannerOptions& options,
                                      const CouldReadKey& could_read) = nullptr;
  /// Further rules for a planner of detours (plan.replan.detour).
  std::vector<OptionProblem> (*check_detour)(const PlannerOptions& options) = nullptr;
  /// Defaults of a planner of detours; none: `defaults`.
  std::optional<PlannerOptions> detour_defaults{};
  /// Bicycle angle of the wheels on straights [rad]; null: 0. Its key is `neutral_steering`.
  double (*neutral_steering)(const PlannerOptions& options) = nullptr;
  /// The state in which plans begin; null, or none: the mission's.
  std::optional<PlannedStart> (*start)(const PlannerOptions& options) = nullptr;

  // Files.

  /// Reads the files that the options name into the options.
  void (*read_inputs)(PlannerOptions& options, InputReader& reader) = nullptr;
  /// The files of the options as the run folder keeps them.
  std::vector<InputFile> (*input_files)(const PlannerOptions& options) = nullptr;
  std::vector<std::string> input_names{};  ///< every name that `input_files` may return
  /// Changes the options to name the files of `input_files`.
  void (*resolve)(PlannerOptions& options) = nullptr;
  std::vector<PlannerTable> tables{};  ///< further tables of a plan
};

/// Adapts a planning function that takes its options struct to PlannerEntry::plan.
template <typename Options, Plan (*PlanWith)(const Options&, const PlanRequest&)>
Plan PlanBy(const PlanRequest& request, const PlannerOptions& options) {
  return PlanWith(options.Get<Options>(), request);
}

}  // namespace trackbed
