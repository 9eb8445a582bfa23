#pragma once

#include <variant>

#include "trackbed/optimize/search.h"
#include "trackbed/options/key_visitor.h"

/// The options of the local planners; avoidance.h defines the symbols.
namespace trackbed {

/// Selects the details of the original code listing (turn_maneuver.h) that are reproduced exactly;
/// the other details are corrected. If all details are corrected, the result for a right turn is
/// the exact mirror image of the result for a left turn, and changes continuously with the
/// parameters.
struct LiteralTurn {
  /// If true, the planner samples the turn's arc from the angle theta_turn_dec upwards in steps of
  /// 0.01 rad, and places the obstacle on the nearest sample. In general, none of the arc's samples
  /// lies at the end angle theta_turn, so the sampled arc starts up to 0.01 rad late. The safe
  /// point may lie up to 0.01 rad of the arc before the obstacle. The swept angles are pi/2 minus
  /// the angles of the listing, so the sampled arc starts at the point A only if theta_turn is
  /// pi/2. If false, the planner samples the whole arc of the turn, and places the obstacle
  /// exactly.
  bool grid = false;
  /// If true, reproduces defect L9 of the listing: shifts the control point P_5 of a right turn
  /// along x by cos(pi/2 - theta_turn_dec) meters.
  bool right_shift = false;
  /// If true, reproduces defect L18 of the listing: uses separate rules for the control points P_5
  /// to P_7 if the turn's reduction theta_turn_dec is exactly 0. If false, the planner applies the
  /// same rule for theta_turn_dec = 0 as for all other angles.
  bool right_angle_rule = false;
};
inline constexpr LiteralTurn kLiteralTurn{true, true, true};

enum class PassingSideChoice {
  /// Pass the obstacle on the side of the RRT* path; if this fails, pass on the other side.
  kAuto,
  kInner,  ///< Pass the obstacle only on the inner side of the turn.
  kOuter,
};

struct BezierAvoidanceOptions {
  double safe_distance = 1.5;  ///< Safe distance SD of the car from obstacles [m], >= 0.
  double delay = 0.9;  ///< System delay t_d [s], >= 0, during which the car follows the old plan.
  /// Side of the turn, inner or outer, on which the car passes the obstacle; on a straight, inner
  /// means left.
  PassingSideChoice passing_side = PassingSideChoice::kAuto;
  double min_speed = 0.5;  ///< Lowest speed at which the car passes an obstacle [m/s].
  /// Largest lateral acceleration on the Bezier curve [m/s^2].
  double max_lateral_acceleration = 3.0;
  /// Largest steering rate on the Bezier curve, as a fraction of the car's limit.
  double max_steering_rate_fraction = 0.9;
  /// Preferred maximum of the steering rate on the Bezier curve, as a fraction of the car's limit.
  double comfortable_steering_rate_fraction = 0.5;
  int rrt_iterations = 2000;
  double rrt_step = 5.0;  ///< Maximum length of an edge of the RRT* tree [m].
  /// Options of the search for the control points of the Bezier curve. The planner `bezier` may
  /// need several searches to find a drivable Bezier curve.
  SearchOptions search{.method = SearchMethod::kSlsqp, .evaluations = 2000, .tolerance = 1e-6};
};
void Visit(KeyVisitor& keys, BezierAvoidanceOptions& options);

/// Options of the local planner `listing`. The planner `listing` finds the turn of the plan that
/// contains an obstacle, and states this turn as the problem of the original code listing
/// (turn_maneuver.h). The problem of the code listing consists of the turn's arc, the straights
/// before and after the arc, and the mission's speed. In the problem of the code listing, the
/// obstacle is aligned with the maneuver's frame and placed on the nearest sixth of the turn's arc.
/// If no turn contains the obstacle, the plan ends before the obstacle. The planner `listing` uses
/// the resulting Bezier curve regardless of the clearance and the required steering, even if
/// `plan.infeasible` rejects infeasible plans.
struct ListingAvoidanceOptions {
  double safe_distance = 1.5;  ///< Safe distance SD of the car from obstacles [m], >= 0.
  double delay = 0.9;  ///< System delay t_d [s], >= 0, during which the car follows the old plan.
  double inner_width = 1.0;  ///< Free width toward the turn's center [m], >= 0.
  /// Free width on the outer side of the turn [m], >= 0. The car passes the obstacle on the side
  /// with the larger free width.
  double outer_width = 0.0;
  /// Details of the original code listing to reproduce exactly.
  LiteralTurn literal = kLiteralTurn;
};
void Visit(KeyVisitor& keys, ListingAvoidanceOptions& options);

/// The options of any local planner.
using AvoiderOptions = std::variant<BezierAvoidanceOptions, ListingAvoidanceOptions>;

}  // namespace trackbed
