#include "src/planning/avoidance/avoidance_listing.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "trackbed/core/angle.h"
#include "trackbed/planning/avoidance/turn_maneuver.h"
#include "trackbed/planning/common/feasibility.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/common/road_hold.h"

namespace trackbed::avoidance {
namespace {

/// Tolerance for the rounding errors of stations (sums of lengths) [m] and of angles (lengths
/// divided by radii) [rad].
constexpr double kRounding = 1e-9;

/// A turn of the plan: an arc together with the two adjacent straights.
struct Turn {
  Stations arc;            ///< Stations at which the turn's arc begins and ends [m].
  double curvature = 0.0;  ///< Signed curvature of the turn's arc [1/m].
  /// Stations at which the first straight begins and the second straight ends [m].
  Stations straights;

  [[nodiscard]] double sweep() const { return std::abs(curvature) * (arc.to - arc.from); }
};

/// Returns the turn whose arc contains a station. Returns nullopt for a station on a straight or on
/// a clothoid.
std::optional<Turn> TurnAt(const Path& path, double s) {
  const std::vector<Segment>& segments = path.segments();
  const auto is_straight = [](const Segment& segment) {
    return segment == Segment{segment.length};
  };
  double start = 0.0;
  std::size_t i = 0;
  while (i < segments.size() && start + segments[i].length < s) {
    start += segments[i].length;
    ++i;
  }
  if (i == segments.size() || is_straight(segments[i]) || segments[i].sharpness != 0.0 ||
      segments[i].sharpness_rate != 0.0) {
    return std::nullopt;
  }
  Turn turn{.arc = {start, start + segments[i].length}, .curvature = segments[i].curvature};
  turn.straights = turn.arc;
  for (std::size_t k = i; k > 0 && is_straight(segments[k - 1]); --k) {
    turn.straights.from -= segments[k - 1].length;
  }
  for (std::size_t k = i + 1; k < segments.size() && is_straight(segments[k]); ++k) {
    turn.straights.to += segments[k].length;
  }
  return turn;
}

/// Sets up the problem of listing F.2 (Skackauskas). Listing F.2 measures the angles on its arc
/// backward from a right angle, even if the turn's heading change is not a right angle.
TurnManeuver ProblemFor(const AvoidanceRequest& request, const ListingAvoidanceOptions& options,
                        const Turn& turn, const OrientedBox& obstacle, double beside) {
  TurnManeuver problem;
  problem.radius = 1.0 / std::abs(turn.curvature);
  problem.speed = request.speed.speed;
  problem.delay = options.delay;
  problem.turn_angle = 0.5 * kPi;
  problem.reduction = problem.turn_angle - turn.sweep();
  if (std::abs(problem.reduction) < kRounding) {
    // For a turn by a right angle, the reduction must be exactly zero, because listing F.2 has
    // special rules for a reduction of zero.
    problem.reduction = 0.0;
  }
  problem.side = turn.curvature > 0.0 ? TurnSide::kLeft : TurnSide::kRight;
  const double share = (beside - turn.arc.from) / (turn.arc.to - turn.arc.from);
  problem.obstacle_sixth = std::clamp(static_cast<int>(std::lround(6.0 * share)), 1, 5);
  problem.obstacle_length = obstacle.length;
  problem.obstacle_width = obstacle.width;
  problem.safe_distance = options.safe_distance;
  problem.inner_width = options.inner_width;
  problem.outer_width = options.outer_width;
  problem.literal = options.literal;
  return problem;
}

/// Returns a note if the curve's clearance is below the safe distance; MakeFeasible reports
/// violations of all other limits.
std::vector<std::string> ClearanceNotes(const CurveCheck& check, double safe_distance,
                                        const OrientedBox& obstacle) {
  if (check.clearance >= safe_distance) {
    return {};
  }
  return {fmt::format(
      "infeasible, kept anyway: the curve past the obstacle at ({:.4g}, {:.4g}): clearance {:.3g} "
      "m is below the safe distance of {:.3g} m",
      obstacle.center.x, obstacle.center.y, check.clearance, safe_distance)};
}

ListingAvoidanceDiagnostics DiagnosticsOn(const TurnManeuver& problem, const TurnLayout& layout,
                                          const LiteralTree& tree, const VehicleParams& vehicle,
                                          const std::array<Vec2, 8>& points) {
  const ManeuverRun drive =
      SimulateManeuver(problem, layout, vehicle, BezierCurve({points.begin(), points.end()}));
  return {.obstacle_sixth = problem.obstacle_sixth,
          .tree_nodes = tree.nodes.size(),
          .goal_distance = tree.goal_distance,
          .final_y = tree.final_y,
          .one_point_check = {.distance = drive.test_distance, .passed = drive.test_passed}};
}

}  // namespace

ReplacementSearch FindListingCurve(const AvoidanceRequest& request,
                                   const ListingAvoidanceOptions& options, const Plan& plan,
                                   const Conflict& conflict, double from) {
  const VehicleParams& vehicle = request.vehicle;
  const Path& path = plan.reference.path;
  const double beside = StationBeside(path, vehicle, conflict);
  const std::optional<Turn> turn = TurnAt(path, beside);
  if (!turn || turn->sweep() >= 2.0 * kPi) {
    return {std::nullopt, "the listing only handles obstacles in turns of constant radius"};
  }
  const TurnManeuver problem = ProblemFor(request, options, *turn, conflict.obstacle, beside);
  const TurnLayout layout = LayOutTurn(problem, vehicle);
  if (!layout.ok()) {
    return {std::nullopt, layout.reason};
  }
  const LiteralTree tree = LiteralRrtStar(problem, layout, request.seed);
  const std::array<Vec2, 8> points = ControlPoints(problem, layout, vehicle, tree.final_y);
  // The control points P_6 and P_7 lie on the tangent at the end of the arc.
  const Vec2 exit = (points[7] - points[6]).normalized();
  const double before = problem.straight();
  const double after = exit.dot(points[7] - layout.arc.back().position);
  const double room_before = turn->arc.from - std::max(turn->straights.from, from);
  const double room_after = turn->straights.to - turn->arc.to;
  if (before > room_before + kRounding || after > room_after + kRounding) {
    return {std::nullopt, fmt::format("the listing needs straights of {:.4g} m before and {:.4g} m "
                                      "after the turn; found {:.4g} m and {:.4g} m",
                                      before, after, std::max(room_before, 0.0), room_after)};
  }

  const Pose2 X_WM = ManeuverFrame(problem, path.At(turn->arc.from).pose);
  std::vector<Vec2> control;
  for (const Vec2& point : points) {
    control.push_back(ToWorld(X_WM, point));
  }
  std::vector<TreeNode> nodes = tree.nodes;
  for (TreeNode& node : nodes) {
    node.position = ToWorld(X_WM, node.position);
  }
  const BezierCurve curve(control);
  const CurveCheck check = Check({.vehicle = vehicle,
                                  .start = {X_WM, 0.0},
                                  .obstacles = request.obstacles,
                                  .start_speed = problem.speed,
                                  .speed = problem.speed},
                                 curve);
  // Listing F.2 assumes a constant speed and ignores the limit of the tyre forces, so lower the
  // speed to what the road's grip allows.
  const RoadHoldLimits hold = MinRoadHold(path, {turn->arc.from - before, turn->arc.to + after},
                                          RequestOn(request.road, vehicle, request.speed));
  const double held = hold.lateral > 0.0 && check.lateral_acceleration > hold.lateral
                          ? std::sqrt(hold.lateral / check.lateral_acceleration)
                          : 1.0;
  return {Replacement{
              .stations = {std::max(turn->arc.from - before, from),
                           std::min(turn->arc.to + after, path.length())},
              .start = X_WM,
              .curve = curve,
              .check = check,
              .speed = held * problem.speed,
              .passing_side = problem.passing_side(),
              .tree = nodes,
              .notes = ClearanceNotes(check, options.safe_distance, conflict.obstacle),
              .diagnostics = [own = DiagnosticsOn(problem, layout, tree, vehicle, points)](
                                 const Plan&, const Stations&) { return MethodDiagnostics(own); }},
          ""};
}

}  // namespace trackbed::avoidance
