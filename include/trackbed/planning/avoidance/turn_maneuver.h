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

/// The geometry of the local planner `listing`: one Bezier curve of degree seven passes an obstacle
/// in a turn (Skackauskas, dissertation, listing F.2; called "the listing" below).
///
/// The maneuver frame M has its origin at the start of the maneuver, its x axis along the heading
/// at the start, and its y axis to the left. The turn's arc begins at the distance S ahead of the
/// origin.
///   r_1    radius of the turn [m];  sg = +1 for a left turn, -1 for a right one
///   S      = r_1 + v_a t_d: length of the straights before and after the arc [m]
///   C      = (S, sg r_1): center of the arc;  A, E first and last point of the arc
///   sigma  angle swept from A [rad], >= 0: the arc is C + r_1 (sin sigma, -sg cos sigma)
///   r_k    distance from C to the safe point, the control point beside the obstacle [m]
namespace trackbed {

enum class TurnSide { kLeft, kRight };

/// The input of a maneuver. The defaults are those of the listing.
struct TurnManeuver {
  double radius = 20.0;                    ///< Radius r_1 of the turn [m], > 0.
  double speed = 3.0;                      ///< Speed v_a [m/s], > 0.
  double delay = 0.9;                      ///< System delay t_d [s], >= 0.
  double turn_angle = 1.5707963267948966;  ///< Angle theta_turn of the turn [rad].
  /// Reduction theta_turn_dec [rad]. The heading changes by theta_turn - theta_turn_dec.
  double reduction = 0.2617993877991494;
  TurnSide side = TurnSide::kLeft;
  int obstacle_sixth = 3;        ///< Number n of sixths of the arc before the obstacle, 1 to 5.
  double obstacle_length = 2.0;  ///< Length L_k, along the x axis of M [m], > 0.
  double obstacle_width = 2.0;   ///< Width w_k, along the y axis of M [m], > 0.
  double safe_distance = 1.5;    ///< Safe distance SD [m], >= 0.
  double inner_width = 1.0;      ///< Free width toward the center [m], >= 0.
  double outer_width = 0.0;      ///< Free width on the outer side [m], >= 0.
  LiteralTurn literal;

  /// Returns the side with more free width; the inner side if both widths are equal.
  [[nodiscard]] PassingSide passing_side() const {
    return inner_width >= outer_width ? PassingSide::kInner : PassingSide::kOuter;
  }
  /// Returns the length S of the straights before and after the arc [m].
  [[nodiscard]] double straight() const { return radius + speed * delay; }
};

/// The result of laying out a maneuver.
enum class TurnStatus {
  kOk,
  kNoTurn,       ///< The reduction leaves no turn, or a turn that is too short for the grid.
  kNoSafePoint,  ///< r_k <= 0: the turn is too tight to pass the obstacle on the inner side.
};

/// A point of the turn's arc.
struct ArcPoint {
  double angle = 0.0;  ///< Swept angle sigma [rad].
  Vec2 position{0.0, 0.0};
};

/// The layout of a maneuver in the frame M. If the status is not kOk, only the reason is valid.
struct TurnLayout {
  TurnStatus status = TurnStatus::kOk;
  std::string reason;         ///< Reason of a failure; empty if ok.
  std::vector<ArcPoint> arc;  ///< The V_L points of the arc from A to E, at most 0.01 rad apart.
  /// Index, from 1, of the arc's point nearest to the obstacle (Padetis_k in the listing).
  std::size_t obstacle_at = 0;
  OrientedBox obstacle;       ///< Obstacle, aligned with the axes of M.
  double safe_radius = 0.0;   ///< Radius r_k [m].
  double safe_angle = 0.0;    ///< Swept angle sigma of the safe point [rad].
  Vec2 safe_point{0.0, 0.0};  ///< Safe point q_goal: C + r_k (sin sigma, -sg cos sigma).

  [[nodiscard]] bool ok() const { return status == TurnStatus::kOk; }
};

/// Returns the radius r_k for passing on a side [m]; the radius may be negative. On the inner side,
/// r_k is r_1 - need - inner_width; on the outer side, r_k is 1.5 (r_1 + need + outer_width). The
/// required width is need = 2 SD + 2 IS_k + 2 w_a, with IS_k half the obstacle's diagonal and w_a
/// the car's width. The factor 1.5 compensates for the curve not reaching its control point.
double SafeRadius(const TurnManeuver& maneuver, double vehicle_width, PassingSide passing_side);

/// Computes the arc, the obstacle and the safe point of a maneuver. Errors: InternalError for a
/// number that is not finite or outside the range stated in TurnManeuver.
TurnLayout LayOutTurn(const TurnManeuver& maneuver, const VehicleParams& vehicle);

/// Computes the control points P_0 to P_7 in the frame M, for a layout that is ok. The argument
/// `final_y` [m] is q_final.y, the y coordinate of P_3.
///
/// P_0 to P_2 lie on the straight before the turn. P_2 lies at A if the obstacle is past the arc's
/// middle, else at two thirds of the straight. P_3 has the x coordinate of A, and P_4 is the safe
/// point. P_5 to P_7 lie on the tangent at E, at the distances 0, S/2 and S from E.
std::array<Vec2, 8> ControlPoints(const TurnManeuver& maneuver, const TurnLayout& layout,
                                  const VehicleParams& vehicle, double final_y);

/// The search tree of the listing.
struct LiteralTree {
  /// Nodes of the tree. The cost of a node is the cost through the nearest node, not through the
  /// parent (defect L10).
  std::vector<TreeNode> nodes;
  std::size_t final_node = 0;  ///< Index of the node nearest to the safe point.
  double goal_distance = 0.0;  ///< Distance from the final node to the safe point [m].
  /// Coordinate q_final.y [m], the only value of the tree that the curve uses.
  double final_y = 0.0;
};

/// Runs the search of the listing as printed, including its defects L5 to L13. The search draws
/// floor(S/2) samples in the box between the start and the obstacle's center. For passing on the
/// outer side, the box is mirrored at the x axis. The coordinates of samples are rounded down to
/// whole meters. Steps are at most 1 m long. A step is accepted if the whole line to the sample
/// crosses no side of the obstacle. The parent is the cheapest node within 10 m, without rewiring.
/// The search ignores the car's width and never reaches its goal, which lies outside the box and
/// beyond its steps. The search is only a reference: use PlanRrtStar.
LiteralTree LiteralRrtStar(const TurnManeuver& maneuver, const TurnLayout& layout,
                           std::uint64_t seed);

/// The point of the curve at one of the parameters u = 0, 0.002, ..., 1.
struct ManeuverSample {
  double u = 0.0;
  Pose2 pose;              ///< Pose of the rear axle on the curve, x along the tangent.
  double s = 0.0;          ///< Distance from the start along the chords between samples [m].
  double time = 0.0;       ///< Time s/v_a [s].
  double curvature = 0.0;  ///< Curvature K [1/m], positive to the left.
  double steering = 0.0;   ///< Steering delta = atan(L K) [rad].
};

/// The result of driving along a curve. Largest and smallest values are taken over the samples.
struct ManeuverRun {
  /// Samples of the curve. The steering over the time is the steering signal of the listing.
  std::vector<ManeuverSample> samples;
  double length = 0.0;             ///< Total length ARC_L of the chords [m].
  double duration = 0.0;           ///< Duration length/v_a [s].
  double steering_max = 0.0;       ///< Largest |delta| [rad].
  double steering_rate_max = 0.0;  ///< Largest |d delta/dt| [rad/s].
  Vec2 test_point{0.0, 0.0};       ///< Point of the curve that the listing's safety check tests.
  Vec2 test_corner{0.0, 0.0};      ///< Corner of the obstacle used in the test.
  /// The listing's safety check: distance from the test point to the corner [m].
  double test_distance = 0.0;
  /// Smallest distance from footprint to obstacle [m]; 0 for a collision.
  double clearance = 0.0;

  bool test_passed = false;  ///< Whether test_distance >= SD + w_a/2.
  bool keeps_clear = false;  ///< Whether clearance >= SD.
  /// Whether steering angle and steering rate are within the car's limits.
  bool steerable = false;
  [[nodiscard]] bool ok() const { return test_passed && keeps_clear && steerable; }
};

/// Simulates driving along a curve at constant speed, with 501 samples. Cost: 0.15 ms. The test
/// point is two samples before the first sample with s >= n/6 of the length minus 2 m. The
/// listing's check compares only this point with one corner of the obstacle, and can pass although
/// the car comes close to the obstacle elsewhere. The function therefore also computes the smallest
/// clearance along the whole curve. The result `steerable` covers the curve between its ends, but
/// not how the wheels reach their initial angle. A curve without a direction at a sample is not
/// steerable.
ManeuverRun SimulateManeuver(const TurnManeuver& maneuver, const TurnLayout& layout,
                             const VehicleParams& vehicle, const BezierCurve& curve);

/// Returns the pose X_WM of the maneuver frame for a turn whose arc begins at the pose X_WA. The
/// frame lies the distance S behind the start of the arc, with the same heading.
Pose2 ManeuverFrame(const TurnManeuver& maneuver, const Pose2& X_WA);

}  // namespace trackbed
