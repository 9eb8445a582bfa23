#pragma once

#include <optional>
#include <variant>

#include "trackbed/options/key_visitor.h"
#include "trackbed/planning/common/planner_options.h"
#include "trackbed/planning/frenet/frenet_options.h"
#include "trackbed/planning/sampling/comparator_options.h"

/// The options of replanning (replan.h, along_route.h).
namespace trackbed {

/// The method that finds motions: PlanFrenet or PlanLattice. The safe distance of these options is
/// ignored; that of AlongSettings applies.
using AlongOptions = std::variant<FrenetOptions, LatticeOptions>;

struct AlongSettings {
  double safe_distance = 0.3;  ///< Distance of the car's footprint from obstacles [m], >= 0.
  RoadWidths road;
  double gap = 3.0;       ///< Gap to an obstacle ahead, between the bumpers at rest [m].
  double time_gap = 1.5;  ///< Additional gap to a moving obstacle ahead [s].
  /// Time for which the way must be clear, with the motion continued after its end [s]. A longer
  /// horizon of the method takes precedence.
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
  /// Settings of motions. The look-ahead also applies, at the planned speeds, to plans that are
  /// kept.
  AlongSettings settings;
  std::optional<AlongOptions> along;
  std::optional<PlannerOptions> detour;      ///< Planner of detours, which must fit PlanDetour.
  std::optional<DetourChoice> comparator{};  ///< Choice of a detour; none: the defaults.
};
void Visit(KeyVisitor& keys, ReplanOptions& options);

}  // namespace trackbed
