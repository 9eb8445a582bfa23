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

/// The geometry of the local planner `listing`, which passes an obstacle in a turn by one Bezier
/// curve of degree seven (Skackauskas, dissertation, listing F.2; called "the listing" below).
///
/// The maneuver frame M has its origin at the start of the maneuver, its x axis along the heading
/// at the start, and its y axis to the left. The turn's arc begins at the distance S ahead of the
/// maneuver frame's origin. Symbols of the geometry:
///   r_1    radius of the turn [m];  sg = +1 for a left turn, -1 for a right one
///   S      = r_1 + v_a t_d: length of the straights before and after the arc [m]
///   C      = (S, sg r_1): center of the arc;  A, E first and last point of the arc
///   sigma  angle swept from A [rad], >= 0: the arc is C + r_1 (sin sigma, -sg cos sigma)
///   r_k    distance from C to the safe point, the control point beside the obstacle [m]
namespace trackbed {

enum class TurnSide { kLeft, kRight };

/// The input of a maneuver that passes an obstacle in a turn. The default values are those of the
/// original code listing.
struct TurnManeuver {
  double radius = 20.0;                    ///< Radius r_1 of the turn [m], > 0.
  double speed = 3.0;                      ///< Constant speed v_a of the car [m/s], > 0.
  double delay = 0.9;                      ///< System delay t_d [s], >= 0.
  double turn_angle = 1.5707963267948966;  ///< Angle theta_turn of the turn [rad].
  /// Reduction theta_turn_dec of the turn's angle [rad]: in the turn, the heading changes by
  /// theta_turn - theta_turn_dec.
  double reduction = 0.2617993877991494;
  TurnSide side = TurnSide::kLeft;
  int obstacle_sixth = 3;  ///< Position n of the obstacle on the arc, in sixths of the arc, 1 to 5.
  /// Obstacle's length L_k along the x axis of the frame M [m], > 0.
  double obstacle_length = 2.0;
  double obstacle_width = 2.0;  ///< Obstacle's width w_k along the y axis of the frame M [m], > 0.
  double safe_distance = 1.5;   ///< Safe distance SD of the car from the obstacle [m], >= 0.
  double inner_width = 1.0;     ///< Free width toward the turn's center [m], >= 0.
  double outer_width = 0.0;     ///< Free width on the outer side of the turn [m], >= 0.
  LiteralTurn literal;

  /// Returns the side with more free width; the inner side if both widths are equal.
  [[nodiscard]] PassingSide passing_side() const {
    return inner_width >= outer_width ? PassingSide::kInner : PassingSide::kOuter;
  }
  /// Returns the length S of the straights before and after the arc [m].
  [[nodiscard]] double straight() const { return radius + speed * delay; }
};

/// Whether the geometry of a maneuver could be computed.
enum class TurnStatus {
  kOk,
  /// The reduced angle of the turn is not positive, or so small that the arc has too few points.
  kNoTurn,
  kNoSafePoint,  ///< The turn is too tight to pass the obstacle on the inner side (r_k <= 0).
};

/// A point of the turn's arc.
struct ArcPoint {
  double angle = 0.0;  ///< Angle sigma swept from the start of the arc [rad].
  Vec2 position{0.0, 0.0};
};

/// The layout of a maneuver in the frame M. If the layout's status is not kOk, only its `reason` is
/// valid.
struct TurnLayout {
  TurnStatus status = TurnStatus::kOk;
  std::string reason;  ///< Reason why the maneuver's layout failed; empty if ok.
  /// Points of the arc from A to E, at most 0.01 rad apart (V_L points in the listing).
  std::vector<ArcPoint> arc;
  /// Index, counted from 1, of the arc's point nearest to the obstacle (Padetis_k in the listing).
  std::size_t obstacle_at = 0;
  OrientedBox obstacle;       ///< Obstacle, aligned with the axes of the frame M.
  double safe_radius = 0.0;   ///< Distance r_k from the arc's center to the safe point [m].
  double safe_angle = 0.0;    ///< Angle sigma from the arc's start to the safe point [rad].
  Vec2 safe_point{0.0, 0.0};  ///< Safe point q_goal = C + r_k (sin sigma, -sg cos sigma).

  [[nodiscard]] bool ok() const { return status == TurnStatus::kOk; }
};

/// Returns the distance r_k from the turn's center to the safe point for passing on the given side
/// [m]; r_k may be negative. With the turn's radius r_1 and a required width `need`, r_k is r_1 -
/// need - inner_width on the inner side. On the outer side, r_k is 1.5 (r_1 + need + outer_width).
/// The required width is need = 2 SD + 2 IS_k + 2 w_a, with IS_k half the obstacle's diagonal and
/// w_a the car's width. The factor 1.5 on the distance r_k is needed because the curve does not
/// reach the control point at the safe point.
double SafeRadius(const TurnManeuver& maneuver, double vehicle_width, PassingSide passing_side);

/// Computes the arc, the obstacle and the safe point of a maneuver. Throws InternalError if a
/// number is not finite or outside the range stated in TurnManeuver.
TurnLayout LayOutTurn(const TurnManeuver& maneuver, const VehicleParams& vehicle);

/// Computes the control points P_0 to P_7 of the curve in the frame M; the status of `layout` must
/// be kOk. The argument `final_y` [m] is the y coordinate of the control point P_3 (q_final.y in
/// the listing).
///
/// The control points P_0 to P_2 lie on the straight before the turn. The control point P_2 lies at
/// the arc's start A if the obstacle is past the arc's middle, else at two thirds of the straight
/// before the turn. The control point P_3 has the x coordinate of the arc's start A, and P_4 is the
/// safe point. The curve's control points P_5 to P_7 lie on the tangent at the arc's end E, at the
/// distances 0, S/2 and S from E.
std::array<Vec2, 8> ControlPoints(const TurnManeuver& maneuver, const TurnLayout& layout,
                                  const VehicleParams& vehicle, double final_y);

/// The search tree that the published code listing computes.
struct LiteralTree {
  /// Nodes of the search tree. The cost of a node is the length of the path through the nearest
  /// node, not through the node's parent (defect L10 of the listing).
  std::vector<TreeNode> nodes;
  std::size_t final_node = 0;  ///< Index of the tree's node nearest to the safe point.
  double goal_distance = 0.0;  ///< Distance from the tree's final node to the safe point [m].
  /// Coordinate q_final.y of the final node [m]; the curve uses no other value of the search tree.
  double final_y = 0.0;
};

/// Runs the search exactly as printed in the listing, including the defects L5 to L13. The
/// listing's search draws floor(S/2) samples in the box between the start and the obstacle's
/// center. For passing on the outer side, the box from which the search draws samples is mirrored
/// at the x axis. The coordinates of the search's samples are rounded down to whole meters. A new
/// node of the tree lies at most 1 m from the nearest node, toward the sample. The search accepts a
/// new node if the whole line from the nearest node to the sample crosses no side of the obstacle.
/// The parent of a new node is the node within 10 m through which the path to the new node is
/// shortest; existing nodes never change their parents. The listing's search ignores the car's
/// width and never reaches its goal, because the goal lies outside the sampled box. LiteralRrtStar
/// serves only for comparison; use PlanRrtStar to find paths.
LiteralTree LiteralRrtStar(const TurnManeuver& maneuver, const TurnLayout& layout,
                           std::uint64_t seed);

/// A sample of the curve, at one of the parameters u = 0, 0.002, ..., 1.
struct ManeuverSample {
  double u = 0.0;
  Pose2 pose;  ///< Pose of the rear axle on the curve, with the x axis along the curve's tangent.
  /// Distance from the curve's start, measured along the chords between samples [m].
  double s = 0.0;
  double time = 0.0;       ///< Time s/v_a since the curve's start [s].
  double curvature = 0.0;  ///< Curvature K of the curve [1/m], positive to the left.
  double steering = 0.0;   ///< Steering angle delta = atan(L K) [rad].
};

/// The result of simulating a drive along a curve. Maxima and minima are taken over the samples of
/// the curve.
struct ManeuverRun {
  /// Samples of the curve; the steering angles of the samples are the steering signal of the
  /// listing.
  std::vector<ManeuverSample> samples;
  double length = 0.0;             ///< Length of the curve, as the sum ARC_L of all chords [m].
  double duration = 0.0;           ///< Duration of the drive, equal to length/v_a [s].
  double steering_max = 0.0;       ///< Largest steering angle |delta| on the curve [rad].
  double steering_rate_max = 0.0;  ///< Largest steering rate |d delta/dt| on the curve [rad/s].
  Vec2 test_point{0.0, 0.0};       ///< Point of the curve that the listing's safety check tests.
  Vec2 test_corner{0.0, 0.0};      ///< Corner of the obstacle that the listing's safety check uses.
  /// Distance from the test point to the obstacle's corner that the listing's safety check uses
  /// [m].
  double test_distance = 0.0;
  /// Smallest distance from the car's footprint to the obstacle [m]; 0 for a collision.
  double clearance = 0.0;

  /// Whether the listing's safety check passes: test_distance >= SD + w_a/2.
  bool test_passed = false;
  bool keeps_clear = false;  ///< Whether `clearance` is at least the safe distance SD.
  /// Whether steering angle and steering rate are within the car's limits.
  bool steerable = false;
  [[nodiscard]] bool ok() const { return test_passed && keeps_clear && steerable; }
};

/// Simulates driving along a curve at constant speed, with 501 samples. Computing time: 0.15 ms.
/// For an obstacle at the n-th sixth of the arc, the test point of the listing's safety check is
/// two samples before the first sample with s >= n length/6 - 2 m. The listing's safety check
/// compares only one test point with one corner of the obstacle, and can pass even if the car comes
/// close to the obstacle elsewhere. Because the listing's safety check tests only one point,
/// SimulateManeuver also computes the smallest clearance along the whole curve. The result
/// `steerable` of the run covers the curve between its ends, but not how the wheels reach the
/// steering angle at the curve's start. A curve that has no tangent direction at a sample is not
/// steerable.
ManeuverRun SimulateManeuver(const TurnManeuver& maneuver, const TurnLayout& layout,
                             const VehicleParams& vehicle, const BezierCurve& curve);

/// Returns the pose X_WM of the maneuver frame for a turn whose arc begins at the pose X_WA. The
/// maneuver frame lies at the distance S before the start of the arc, and has the heading of that
/// start.
Pose2 ManeuverFrame(const TurnManeuver& maneuver, const Pose2& X_WA);

}  // namespace trackbed
