#pragma once

#include <variant>

#include "trackbed/optimize/search.h"
#include "trackbed/options/key_visitor.h"

/// The options of the local planners (avoidance.h, which also defines the symbols).
namespace trackbed {

/// Details of the original listing (turn_maneuver.h) that are either reproduced exactly or
/// corrected. If all details are corrected, a right turn is the exact mirror image of a left one,
/// and the result is continuous in the parameters.
struct LiteralTurn {
  /// If true, samples the arc from the angle theta_turn_dec upwards in steps of 0.01 rad, and
  /// places the obstacle on the nearest sample. In general, no sample lies at the end angle
  /// theta_turn. The arc then starts up to 0.01 rad late, and the safe point lies up to 0.01 rad
  /// before the obstacle. Swept angles are pi/2 less than the angles of the listing, so that the
  /// arc starts at A only if theta_turn is pi/2. If false, samples the whole arc and places the
  /// obstacle exactly.
  bool grid = false;
  /// If true, shifts P_5 of a right turn along x by cos(pi/2 - theta_turn_dec) meters, as in defect
  /// L9 of the listing.
  bool right_shift = false;
  /// If true, uses separate rules for P_5 to P_7 if theta_turn_dec is exactly 0, as in defect L18
  /// of the listing. If false, applies the same rule as for all other angles.
  bool right_angle_rule = false;
};
inline constexpr LiteralTurn kLiteralTurn{true, true, true};

enum class PassingSideChoice {
  /// Pass on the side of the RRT* path. If passing on that side fails, pass on the other side.
  kAuto,
  kInner,  ///< Pass only on the inner side.
  kOuter,
};

struct BezierAvoidanceOptions {
  double safe_distance = 1.5;  ///< Safe distance SD [m], >= 0.
  double delay = 0.9;  ///< System delay t_d [s], >= 0, during which the car follows the old plan.
  /// Side on which to pass; on a straight, inner means left.
  PassingSideChoice passing_side = PassingSideChoice::kAuto;
  double min_speed = 0.5;  ///< Lowest speed at which the car passes an obstacle [m/s].
  double max_lateral_acceleration = 3.0;  ///< Largest lateral acceleration on the curve [m/s^2].
  /// Largest steering rate on the curve, as a fraction of the car's limit.
  double max_steering_rate_fraction = 0.9;
  /// Preferred largest steering rate on the curve, as a fraction of the car's limit.
  double comfortable_steering_rate_fraction = 0.5;
  int rrt_iterations = 2000;
  double rrt_step = 5.0;  ///< Step of the RRT* [m].
  /// Options of the search for the control points. A curve may need several searches.
  SearchOptions search{.method = SearchMethod::kSlsqp, .evaluations = 2000, .tolerance = 1e-6};
};
void Visit(KeyVisitor& keys, BezierAvoidanceOptions& options);

/// Options of the local planner `listing`, which converts the turn of the plan that contains an
/// obstacle to the problem of the original listing (turn_maneuver.h). The problem consists of the
/// turn's arc, the straights before and after the arc, and the mission's speed. The obstacle is
/// aligned with the maneuver's frame and placed on the nearest sixth of the arc. If no turn
/// contains the obstacle, the plan ends before the obstacle. The curve is used regardless of its
/// clearance and steering, even if `plan.infeasible` rejects infeasible plans.
struct ListingAvoidanceOptions {
  double safe_distance = 1.5;  ///< Safe distance SD [m], >= 0.
  double delay = 0.9;  ///< System delay t_d [s], >= 0, during which the car follows the old plan.
  double inner_width = 1.0;  ///< Free width toward the turn's center [m], >= 0.
  /// Free width on the outer side of the turn [m], >= 0. The car passes on the wider side.
  double outer_width = 0.0;
  LiteralTurn literal = kLiteralTurn;  ///< Details of the listing to reproduce exactly.
};
void Visit(KeyVisitor& keys, ListingAvoidanceOptions& options);

/// The options of a local planner.
using AvoiderOptions = std::variant<BezierAvoidanceOptions, ListingAvoidanceOptions>;

}  // namespace trackbed
