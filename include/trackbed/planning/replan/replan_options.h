#pragma once

#include <optional>
#include <variant>

#include "trackbed/options/key_visitor.h"
#include "trackbed/planning/common/planner_options.h"
#include "trackbed/planning/frenet/frenet_options.h"
#include "trackbed/planning/sampling/comparator_options.h"

/// The options of replanning (replan.h, along_route.h).
namespace trackbed {

/// The method that finds motions: PlanFrenet or PlanLattice. The safe distance in these options is
/// ignored; AlongSettings::safe_distance applies.
using AlongOptions = std::variant<FrenetOptions, LatticeOptions>;

struct AlongSettings {
  double safe_distance = 0.3;  ///< Distance of the car's footprint from obstacles [m], >= 0.
  RoadWidths road;
  double gap = 3.0;       ///< Gap to an obstacle ahead, between the bumpers at rest [m].
  double time_gap = 1.5;  ///< Additional gap to a moving obstacle ahead [s].
  /// Time for which the way must be clear [s], on the motion and on its continuation. If the
  /// horizon of the method is longer, that horizon applies.
  double look_ahead = 12.0;
};

/// How a detour is chosen (detour.h).
struct DetourChoice {
  int attempts = 4;  ///< Number of attempts of a random planner, with different seeds, >= 1.
  double wind_weight = 1.0;  ///< Weight k_w of wind, see WindScoring.
  ComparatorOptions comparator;
};
void Visit(KeyVisitor& keys, DetourChoice& choice);

struct ReplanOptions {
  double period = 0.5;  ///< Time between two checks [s], > 0.
  /// Settings of motions. The current plan, at its planned speeds, is also checked over the
  /// look-ahead of these settings.
  AlongSettings settings;
  std::optional<AlongOptions> along;
  /// Planner of detours, which must meet the requirements of PlanDetour.
  std::optional<PlannerOptions> detour;
  /// Settings for choosing a detour; none: the defaults.
  std::optional<DetourChoice> comparator{};
};
void Visit(KeyVisitor& keys, ReplanOptions& options);

}  // namespace trackbed
