#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "trackbed/geometry/oriented_box.h"
#include "trackbed/geometry/pose.h"
#include "trackbed/path/bezier.h"
#include "trackbed/planning/avoidance/avoidance_options.h"
#include "trackbed/planning/sampling/rrt_star.h"
#include "trackbed/vehicle/params.h"

/// The local planner's geometry: one Bezier curve of degree seven past an obstacle that stands in a
/// turn (Skackauskas, dissertation, listing F.2; below, "the listing").
///
/// Maneuver frame M: origin where the maneuver starts, x along the heading there, y to the left.
/// The turn's arc begins the distance S ahead.
///   r_1    radius of the turn [m];  sg = +1 for a left turn, -1 for a right one
///   S      = r_1 + v_a t_d: straight before the arc, and after it [m]
///   C      = (S, sg r_1): center of the arc;  A, E its first and last point
///   sigma  angle swept from A [rad], >= 0: the arc is C + r_1 (sin sigma, -sg cos sigma)
///   r_k    distance from C to the safe point, the control point beside the obstacle [m]
namespace trackbed {

enum class TurnSide { kLeft, kRight };

/// The problem. Defaults are those of the listing.
struct TurnManeuver {
  double radius = 20.0;                    ///< r_1 [m], > 0
  double speed = 3.0;                      ///< v_a [m/s], > 0
  double delay = 0.9;                      ///< t_d [s], >= 0
  double turn_angle = 1.5707963267948966;  ///< theta_turn [rad]
  double reduction = 0.2617993877991494;   ///< theta_turn_dec [rad]: the heading changes by
                                           ///< theta_turn - theta_turn_dec
  TurnSide side = TurnSide::kLeft;
  int obstacle_sixth = 3;        ///< n: how many sixths of the arc lie before it, 1 to 5
  double obstacle_length = 2.0;  ///< L_k: along the x axis of M [m], > 0
  double obstacle_width = 2.0;   ///< w_k: along its y axis [m], > 0
  double safe_distance = 1.5;    ///< SD [m], >= 0
  double inner_width = 1.0;      ///< free toward the center [m], >= 0
  double outer_width = 0.0;      ///< free on the other side [m], >= 0
  LiteralTurn literal;

  /// The side with more room; the inner one if there is the same on both.
  [[nodiscard]] PassingSide passing_side() const {
    return inner_width >= outer_width ? PassingSide::kInner : PassingSide::kOuter;
  }
  /// S [m].
  [[nodiscard]] double straight() const { return radius + speed * delay; }
};

/// How laying out a maneuver ended.
enum class TurnStatus {
  kOk,
  kNoTurn,       ///< the reduction leaves nothing of the turn, or too little for its grid
  kNoSafePoint,  ///< r_k <= 0: the turn is too tight to pass the obstacle on the inside
};

/// A point of the turn's arc.
struct ArcPoint {
  double angle = 0.0;  ///< sigma [rad]
  Vec2 position{0.0, 0.0};
};

/// What follows from the problem alone, in M. With any status but kOk there is a reason and nothing
/// else that counts.
struct TurnLayout {
  TurnStatus status = TurnStatus::kOk;
  std::string reason;           ///< for people; empty when ok
  std::vector<ArcPoint> arc;    ///< from A to E; V_L points, at most 0.01 rad apart
  std::size_t obstacle_at = 0;  ///< Padetis_k, as an index from 1: the arc's point nearest to it
  OrientedBox obstacle;         ///< along the axes of M
  double safe_radius = 0.0;     ///< r_k [m]
  double safe_angle = 0.0;      ///< sigma of the safe point [rad]
  Vec2 safe_point{0.0, 0.0};    ///< q_goal: C + r_k (sin sigma, -sg cos sigma)

  [[nodiscard]] bool ok() const { return status == TurnStatus::kOk; }
};

/// r_k on either side [m], of any sign: r_1 - need - inner_width on the inside, 1.5 (r_1 + need +
/// outer_width) on the outside, with need = 2 SD + 2 IS_k + 2 w_a, IS_k being half the obstacle's
/// diagonal and w_a the car's width. The factor makes up for a curve that only leans toward its
/// control point.
double SafeRadius(const TurnManeuver& maneuver, double vehicle_width, PassingSide passing_side);

/// Arc, obstacle and safe point. Errors: InternalError for a number out of the range that
/// TurnManeuver gives it, or not finite.
TurnLayout LayOutTurn(const TurnManeuver& maneuver, const VehicleParams& vehicle);

/// P_0 to P_7 in M, for a layout that is ok. `final_y` [m] is q_final.y: the height of P_3.
///
/// P_0 to P_2 lie on the straight before the turn (P_2 at A if the obstacle is past the arc's
/// middle, else at two thirds of the way), P_3 above A, P_4 is the safe point, P_5 to P_7 lie on
/// the tangent at E, 0, S/2 and S from it.
std::array<Vec2, 8> ControlPoints(const TurnManeuver& maneuver, const TurnLayout& layout,
                                  const VehicleParams& vehicle, double final_y);

/// The tree of the listing's search.
struct LiteralTree {
  std::vector<TreeNode> nodes;  ///< costs by way of the nearest node, not the parent (L10)
  std::size_t final_node = 0;   ///< the one nearest to the safe point
  double goal_distance = 0.0;   ///< from there to the safe point [m]
  double final_y = 0.0;         ///< q_final.y [m]: all that the curve takes from the tree
};

/// The listing's search as it stands, defects and all (L5-L13): floor(S/2) samples, rounded down to
/// whole meters, in the box between the start and the obstacle's center (below the start, where the
/// other side is taken); steps of 1 m; free if the whole line to the sample crosses no side of the
/// obstacle; the cheapest parent within 10 m; nothing rewired. It does not look at the car's width,
/// never reaches its goal (that lies outside the box, and beyond its steps) and serves as a
/// reference only: PlanRrtStar is the search to use.
LiteralTree LiteralRrtStar(const TurnManeuver& maneuver, const TurnLayout& layout,
                           std::uint64_t seed);

/// The curve at one of the parameters u = 0, 0.002, ..., 1.
struct ManeuverSample {
  double u = 0.0;
  Pose2 pose;              ///< of the rear axle: on the curve, x along the tangent
  double s = 0.0;          ///< along the chords [m]
  double time = 0.0;       ///< s/v_a [s]
  double curvature = 0.0;  ///< K [1/m], positive to the left
  double steering = 0.0;   ///< delta = atan(L K) [rad]
};

/// What driving along a curve comes to. Largest and smallest values are those of the samples.
struct ManeuverRun {
  std::vector<ManeuverSample> samples;  ///< (time, steering) are the listing's steering signal
  double length = 0.0;                  ///< ARC_L: of all chords [m]
  double duration = 0.0;                ///< length/v_a [s]
  double steering_max = 0.0;            ///< largest |delta| [rad]
  double steering_rate_max = 0.0;       ///< largest |d delta/dt| [rad/s]
  Vec2 test_point{0.0, 0.0};            ///< beside the obstacle, by the listing's rule
  Vec2 test_corner{0.0, 0.0};           ///< the corner of the obstacle that it is held against
  double test_distance = 0.0;           ///< the listing's safety check: between the two [m]
  double clearance = 0.0;               ///< smallest distance from footprint to obstacle [m]; 0 for
                                        ///< a collision

  bool test_passed = false;  ///< test_distance >= SD + w_a/2
  bool keeps_clear = false;  ///< clearance >= SD
  bool steerable = false;    ///< steering and its rate are within the car's limits
  [[nodiscard]] bool ok() const { return test_passed && keeps_clear && steerable; }
};

/// Drives along a curve at constant speed: 501 samples, some 0.15 ms. The test point is two samples
/// before the first whose s reaches n/6 of the length less 2 m: one point against one corner, which
/// passes although the car comes close elsewhere; hence the clearance besides. `steerable` is about
/// the way between the curve's ends, not about how the wheels get to the angle that it starts with.
/// A curve that has no direction at a sample is not steerable.
ManeuverRun SimulateManeuver(const TurnManeuver& maneuver, const TurnLayout& layout,
                             const VehicleParams& vehicle, const BezierCurve& curve);

/// X_WM, for a turn whose arc begins at X_WA: S back along the heading there.
Pose2 ManeuverFrame(const TurnManeuver& maneuver, const Pose2& X_WA);

}  // namespace trackbed
