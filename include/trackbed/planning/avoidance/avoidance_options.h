#pragma once

#include <variant>

#include "trackbed/optimize/search.h"
#include "trackbed/options/key_visitor.h"

/// The options of the local planners (avoidance.h, which also defines the symbols).
namespace trackbed {

/// Details of the listing to reproduce exactly instead of correcting them. With all off, a right
/// turn is the exact mirror image of a left one, and the result is continuous in the parameters.
struct LiteralTurn {
  /// Samples the arc from theta_turn_dec upwards in steps of 0.01 rad, which miss theta_turn, and
  /// places the obstacle on the nearest sample: the arc starts up to 0.01 rad late, and the safe
  /// point lies up to 0.01 rad before the obstacle. Swept angles are pi/2 less than the listing's,
  /// so that only a theta_turn of pi/2 starts at A. Off: samples the whole arc and places the
  /// obstacle exactly.
  bool grid = false;
  /// Shifts P_5 of a right turn along x by cos(pi/2 - theta_turn_dec) meters (L9).
  bool right_shift = false;
  /// Uses separate rules for P_5 to P_7 if theta_turn_dec is exactly 0 (L18). Off: applies the rule
  /// of all other angles.
  bool right_angle_rule = false;
};
inline constexpr LiteralTurn kLiteralTurn{true, true, true};

enum class PassingSideChoice {
  kAuto,   ///< that of the RRT* path; the other side if that one fails
  kInner,  ///< the inner side only
  kOuter,
};

struct BezierAvoidanceOptions {
  double safe_distance = 1.5;  ///< SD [m], >= 0
  double delay = 0.9;          ///< t_d [s], >= 0: the car follows the old plan until then
  PassingSideChoice passing_side = PassingSideChoice::kAuto;  ///< on a straight, inner means left
  double min_speed = 0.5;  ///< lowest speed at which the car passes an obstacle [m/s]
  double max_lateral_acceleration = 3.0;            ///< of the curve [m/s^2]
  double max_steering_rate_fraction = 0.9;          ///< of the car's steering rate
  double comfortable_steering_rate_fraction = 0.5;  ///< preferred maximum for curves
  int rrt_iterations = 2000;
  double rrt_step = 5.0;  ///< [m]
  /// Search for the control points; a curve may take a few such searches.
  SearchOptions search{.method = SearchMethod::kSlsqp, .evaluations = 2000, .tolerance = 1e-6};
};
void Visit(KeyVisitor& keys, BezierAvoidanceOptions& options);

/// Treats the turn of the plan that contains an obstacle as the listing's problem
/// (turn_maneuver.h): its arc and the straights before and after it, the mission's speed, the box
/// aligned with the maneuver's frame and placed on the nearest sixth of the arc. If there is no
/// such turn, the plan ends before the obstacle. The curve is used whatever its clearance and
/// steering, even if `plan.infeasible` rejects infeasible plans.
struct ListingAvoidanceOptions {
  double safe_distance = 1.5;          ///< SD [m], >= 0
  double delay = 0.9;                  ///< t_d [s], >= 0: the car follows the old plan until then
  double inner_width = 1.0;            ///< free toward the turn's center [m], >= 0
  double outer_width = 0.0;            ///< free on the other side [m], >= 0; the wider side is used
  LiteralTurn literal = kLiteralTurn;  ///< details of the listing to reproduce exactly
};
void Visit(KeyVisitor& keys, ListingAvoidanceOptions& options);

/// The options of a local planner.
using AvoiderOptions = std::variant<BezierAvoidanceOptions, ListingAvoidanceOptions>;

}  // namespace trackbed
