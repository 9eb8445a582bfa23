#pragma once

#include <optional>
#include <variant>

#include "trackbed/options/key_visitor.h"
#include "trackbed/planning/common/planner_options.h"
#include "trackbed/planning/frenet/frenet_options.h"
#include "trackbed/planning/sampling/comparator_options.h"

/// The options for replanning during a run (replan.h, along_route.h).
namespace trackbed {

/// Options of the method that finds motions along the route, which is PlanFrenet or PlanLattice.
/// AlongSettings::safe_distance overrides the safe distance in the options of PlanFrenet and
/// PlanLattice.
using AlongOptions = std::variant<FrenetOptions, LatticeOptions>;

struct AlongSettings {
  /// Distance that the car's footprint keeps from obstacles [m], >= 0.
  double safe_distance = 0.3;
  RoadWidths road;
  double gap = 3.0;  ///< Distance from a standing car's bumper to a standing obstacle ahead [m].
  double time_gap = 1.5;  ///< Additional time gap to a moving obstacle ahead [s].
  /// Time for which a motion and its continuation must be clear of obstacles [s]. If the horizon of
  /// the method (PlanFrenet or PlanLattice) is longer than `look_ahead`, the horizon of the method
  /// applies.
  double look_ahead = 12.0;
};

/// Settings for choosing a detour (detour.h).
struct DetourChoice {
  int attempts = 4;  ///< Number of attempts with different seeds, if the planner is random, >= 1.
  double wind_weight = 1.0;  ///< Weight k_w of the wind in the score of a path, see WindScoring.
  ComparatorOptions comparator;
};
void Visit(KeyVisitor& keys, DetourChoice& choice);

struct ReplanOptions {
  double period = 0.5;  ///< Time between two checks of the current plan [s], > 0.
  /// Settings for motions along the route. The look-ahead `settings.look_ahead` also applies when
  /// the current plan is checked for conflicts.
  AlongSettings settings;
  std::optional<AlongOptions> along;
  /// Options of the planner for detours, which must meet the requirements of PlanDetour.
  std::optional<PlannerOptions> detour;
  /// Settings for choosing a detour; none: the default settings.
  std::optional<DetourChoice> comparator{};
};
void Visit(KeyVisitor& keys, ReplanOptions& options);

}  // namespace trackbed
