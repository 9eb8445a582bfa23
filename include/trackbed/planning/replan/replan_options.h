#pragma once

#include <optional>
#include <variant>

#include "trackbed/options/key_visitor.h"
#include "trackbed/planning/common/planner_options.h"
#include "trackbed/planning/frenet/frenet_options.h"
#include "trackbed/planning/sampling/comparator_options.h"

/// The options of replanning (replan.h, along_route.h).
namespace trackbed {

/// How motions are found: PlanFrenet or PlanLattice. Their safe distance is not looked at: that of
/// AlongSettings holds.
using AlongOptions = std::variant<FrenetOptions, LatticeOptions>;

struct AlongSettings {
  double safe_distance = 0.3;  ///< of the car's footprint from obstacles [m], >= 0
  RoadWidths road;
  double gap = 3.0;       ///< from bumper to bumper behind what is in the way, at rest [m]
  double time_gap = 1.5;  ///< besides, behind what moves [s]
  /// For how long the way must be clear, if the car goes on as its motion ends [s]: a method's own
  /// horizon is made no shorter.
  double look_ahead = 12.0;
};

/// How a detour is chosen (detour.h).
struct DetourChoice {
  int attempts = 4;          ///< of a random planner, with seeds of their own, >= 1
  double wind_weight = 1.0;  ///< k_w, see WindScoring
  ComparatorOptions comparator;
};
void Visit(KeyVisitor& keys, DetourChoice& choice);

struct ReplanOptions {
  double period = 0.5;     ///< between two looks [s], > 0
  AlongSettings settings;  ///< its look-ahead, at the planned speeds, for plans that are kept too
  std::optional<AlongOptions> along;
  std::optional<PlannerOptions> detour;      ///< a planner that fits PlanDetour
  std::optional<DetourChoice> comparator{};  ///< none: the defaults
};
void Visit(KeyVisitor& keys, ReplanOptions& options);

}  // namespace trackbed
