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

/// Defines the interface of planners that plan a whole path.
namespace trackbed {

/// The state of the car in which the plans of a planner begin. The planner's start state overrides
/// the mission's start state.
struct PlannedStart {
  Pose2 pose;
  /// Speed of the car at the start [m/s]; none: the mission's start speed.
  std::optional<double> speed;
};

/// The part of a mission that determines how a given route begins.
struct RouteStart {
  Pose2 pose;            ///< Pose of the car at the start.
  TrackLaps on_track{};  ///< Track and laps to drive (PlanRequest::on_track).
  LaneMission lanes{};   ///< Route over lanes (PlanRequest::lanes).
};

/// An additional table about a plan, written into the run folder.
struct PlannerTable {
  const char* file;  ///< File name of the table, such as "convergence.csv".
  /// Makes the table from the diagnostics of a plan. The table is written into the run folder only
  /// if it has rows.
  Table (*make)(const PlanDiagnostics& diagnostics);
};

/// An entry of the planner registry (planners.h). All function pointers except `plan` may be null.
struct PlannerEntry {
  const char* name;
  const char* summary;  ///< One-line description of the planner for users.
  PlannerOptions defaults;
  Plan (*plan)(const PlanRequest& request, const PlannerOptions& options);
  /// Minimum number of waypoints of the route; 0 if the planner needs no route.
  std::size_t min_waypoints = 0;
  /// Whether the planner follows a track, and needs PlanRequest::on_track.
  bool follows_track = false;
  /// Whether the planner always plans speeds at the car's limit, and needs PlanRequest::limits.
  bool needs_limits = false;
  /// Whether the planner follows lanes, and needs PlanRequest::lanes.
  bool follows_lanes = false;
  bool keeps_clear = false;  ///< Whether the planner avoids the obstacles of the request.
  /// Whether the planned path has the headings PlanRequest::headings at the waypoints.
  bool has_headings = false;
  bool has_gates = false;       ///< Whether the planned paths pass through gates (Plan::gates).
  bool goes_backwards = false;  ///< Whether the planned paths may contain reverse segments.
  /// Whether the car's length is the default bound on the distance of the planned path from the
  /// waypoints (PlanRequest::max_waypoint_miss).
  bool bounds_waypoint_miss = false;
  /// Whether the planner searches for a path around obstacles within a limited budget.
  bool searches = false;
  /// Whether the planner may choose arbitrarily between paths of equal cost, such as mirrored
  /// paths.
  bool has_ties = false;
  /// Whether the planner is random, so that its plan depends on PlanRequest::seed.
  bool is_random = false;
  /// Returns whether a plan made with the given options may contain reverse segments. If
  /// `may_go_backwards` is null, `goes_backwards` applies to all options.
  bool (*may_go_backwards)(const PlannerOptions& options) = nullptr;
  /// Returns whether a plan made with the given options may end before the goal (Plan::partial). If
  /// `may_be_partial` is null, every plan leads to the goal.
  bool (*may_be_partial)(const PlannerOptions& options) = nullptr;

  // Rules that the planner's options must meet. OnOptions adapts a check of the planner's own
  // options struct to the type PlannerOptions.

  /// Checks rules that relate the values of several options of the planner.
  std::vector<OptionProblem> (*check)(const PlannerOptions& options,
                                      const CouldReadKey& could_read) = nullptr;
  /// Checks further rules that the planner's options must meet if the planner plans detours
  /// (plan.replan.detour).
  std::vector<OptionProblem> (*check_detour)(const PlannerOptions& options) = nullptr;
  /// Default options of the planner for planning detours. If `detour_defaults` is nullopt, detours
  /// use the planner's general `defaults`.
  std::optional<PlannerOptions> detour_defaults{};
  /// Returns the steering angle of the bicycle model on straights [rad]; if `neutral_steering` is
  /// null, the angle is 0. Scenarios set the steering angle on straights by the key
  /// `neutral_steering`.
  double (*neutral_steering)(const PlannerOptions& options) = nullptr;
  /// Returns the state of the car in which the planner's plans begin. If `start` is null or returns
  /// nullopt, plans begin in the mission's start state.
  std::optional<PlannedStart> (*start)(const PlannerOptions& options) = nullptr;
  /// Returns the curvature with which the mission's route begins [1/m], positive to the left. If
  /// the mission does not set the start steering, the wheels start at the steering angle that
  /// matches the route's first curvature. Only planners that follow a given route define
  /// `start_curvature`; the paths of other planners begin with PlanRequest::start_steering. The
  /// function `start_curvature` returns nullopt if the route is not known.
  std::optional<double> (*start_curvature)(const PlannerOptions& options,
                                           const RouteStart& route) = nullptr;

  // Input files that the planner's options name.

  /// Reads the files that the planner's options name, and stores their contents in the options.
  void (*read_inputs)(PlannerOptions& options, InputReader& reader) = nullptr;
  /// Returns the input files of the planner's options, in the form in which the run folder stores
  /// them.
  std::vector<InputFile> (*input_files)(const PlannerOptions& options) = nullptr;
  std::vector<std::string> input_names{};  ///< All file names that `input_files` may return.
  /// Replaces the file names in the options by the names of the files that `input_files` returns.
  void (*resolve)(PlannerOptions& options) = nullptr;
  /// Returns the coordinates of all positions in the contents of the planner's input files [m].
  std::vector<Vec2> (*places)(const PlannerOptions& options) = nullptr;
  /// Moves all positions in the contents of the planner's input files by a vector [m]. A planner
  /// whose options store positions needs `translate` for scenarios with a local origin.
  void (*translate)(PlannerOptions& options, const Vec2& by) = nullptr;
  std::vector<PlannerTable> tables{};  ///< Additional tables about each plan.
};

/// Adapts a planning function that takes its own options struct to the signature of
/// PlannerEntry::plan.
template <typename Options, Plan (*PlanWith)(const Options&, const PlanRequest&)>
Plan PlanBy(const PlanRequest& request, const PlannerOptions& options) {
  return PlanWith(options.Get<Options>(), request);
}

}  // namespace trackbed
