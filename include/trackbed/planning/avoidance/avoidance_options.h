#pragma once

#include <variant>

#include "trackbed/optimize/search.h"
#include "trackbed/options/key_visitor.h"

/// The options of the local planners (avoidance.h, with their symbols).
namespace trackbed {

/// Where the listing is followed to the letter instead of being mended. All off: a right turn is
/// the exact mirror of a left one, and nothing jumps when a parameter changes a little.
struct LiteralTurn {
  /// The arc sampled from theta_turn_dec upwards in steps of 0.01 rad, which miss theta_turn, and
  /// the obstacle on the nearest of these points: the arc starts up to 0.01 rad late, the safe
  /// point lies up to 0.01 rad before the obstacle. Swept angles are pi/2 less the listing's, so
  /// that only a theta_turn of pi/2 starts at A. Off: from end to end, the obstacle exact.
  bool grid = false;
  /// P_5 of a right turn is shifted along x by cos(pi/2 - theta_turn_dec) meters (L9).
  bool right_shift = false;
  /// P_5 to P_7 have rules of their own where theta_turn_dec is 0 exactly (L18). Off: the rule of
  /// all other angles.
  bool right_angle_rule = false;
};
inline constexpr LiteralTurn kLiteralTurn{true, true, true};

enum class PassingSideChoice {
  kAuto,   ///< that of the RRT* path; the other one if it cannot be had
  kInner,  ///< this one alone
  kOuter,
};

struct BezierAvoidanceOptions {
  double safe_distance = 1.5;  ///< SD [m], >= 0
  double delay = 0.9;          ///< t_d [s], >= 0: until then the old plan is driven
  PassingSideChoice passing_side = PassingSideChoice::kAuto;  ///< on a straight, inner means left
  double min_speed = 0.5;  ///< the car is not made slower than this to get past [m/s]
  double max_lateral_acceleration = 3.0;            ///< of the curve [m/s^2]
  double max_steering_rate_fraction = 0.9;          ///< of the car's steering rate
  double comfortable_steering_rate_fraction = 0.5;  ///< curves that ask for no more are preferred
  int rrt_iterations = 2000;
  double rrt_step = 5.0;  ///< [m]
  /// Of the control points; one curve may take a few such searches.
  SearchOptions search{.method = SearchMethod::kSlsqp, .evaluations = 2000, .tolerance = 1e-6};
};
void Visit(KeyVisitor& keys, BezierAvoidanceOptions& options);

/// The turn of the plan in which an obstacle stands is taken as the listing's problem
/// (turn_maneuver.h): its arc and the straights before and after it, the mission's speed, the box
/// along the axes of the maneuver's frame and on the nearest sixth of the arc. Where there is no
/// such turn the plan ends before the obstacle. The curve is driven as it is, however near it comes
/// and whatever it asks of the steering, also where `plan.infeasible` refuses other plans.
struct ListingAvoidanceOptions {
  double safe_distance = 1.5;          ///< SD [m], >= 0
  double delay = 0.9;                  ///< t_d [s], >= 0: until then the old plan is driven
  double inner_width = 1.0;            ///< free toward the turn's center [m], >= 0
  double outer_width = 0.0;            ///< free on the other side [m], >= 0; the wider one is taken
  LiteralTurn literal = kLiteralTurn;  ///< what is followed to the letter
};
void Visit(KeyVisitor& keys, ListingAvoidanceOptions& options);

/// The options of one way to avoid obstacles.
using AvoiderOptions = std::variant<BezierAvoidanceOptions, ListingAvoidanceOptions>;

}  // namespace trackbed
