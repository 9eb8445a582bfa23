#include "trackbed/planning/avoidance/turn_maneuver.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/uniform_01.hpp>
#include <cmath>
#include <limits>

#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/vehicle/steering_reach.h"
#include "trackbed/world/world.h"

// Computes the curve past an obstacle in a turn as printed in Skackauskas (dissertation, listing
// F.2). Listing F.2 samples the turn's arc; with `literal.grid`, the samples lie on the grid of
// 0.01 rad that the listing prints. The obstacle stands at n sixths of the arc, and the safe point,
// which the curve passes, lies beside the obstacle at the radius r_k. An RRT* tree of floor(S/2)
// samples determines the y coordinate of the control point P_3. Explicit formulas determine all
// other coordinates of the Bezier curve's eight control points. Listing F.2 does not change an
// infeasible curve; SimulateManeuver only evaluates the curve at 501 parameters.

namespace trackbed {
namespace {

constexpr double kGrid = 0.01;  // Step of the printed grid of angles [rad].
// Distance from the test point to the obstacle along the curve [m].
constexpr double kProbeDistance = 2.0;
constexpr double kTreeStep = 1.0;    // Maximum length EPS of an edge of the RRT* tree [m].
constexpr double kNeighbors = 10.0;  // Radius r in which the RRT* tree searches for neighbors [m].
constexpr std::size_t kIntervals = 500;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

double Sign(const TurnManeuver& maneuver) {
  return maneuver.side == TurnSide::kLeft ? 1.0 : -1.0;
}

/// Returns a point on a circle around the turn's center C. The points of left and right turns
/// differ only in the sign of y, so they are exact mirror images.
Vec2 PointAt(const TurnManeuver& maneuver, double radius, double angle) {
  return {maneuver.straight() + radius * std::sin(angle),
          Sign(maneuver) * (maneuver.radius - radius * std::cos(angle))};
}

void CheckRanges(const TurnManeuver& m, const VehicleParams& vehicle) {
  TRACKBED_CHECK(m.radius > 0.0 && std::isfinite(m.radius), "radius {}", m.radius);
  TRACKBED_CHECK(m.speed > 0.0 && std::isfinite(m.speed), "speed {}", m.speed);
  TRACKBED_CHECK(m.delay >= 0.0 && std::isfinite(m.delay), "delay {}", m.delay);
  TRACKBED_CHECK(std::isfinite(m.turn_angle) && std::isfinite(m.reduction) &&
                     std::abs(m.turn_angle - m.reduction) < 2.0 * kPi,
                 "turn of {} less {}", m.turn_angle, m.reduction);
  TRACKBED_CHECK(m.obstacle_sixth >= 1 && m.obstacle_sixth <= 5, "obstacle at sixth {}",
                 m.obstacle_sixth);
  TRACKBED_CHECK(m.obstacle_length > 0.0 && std::isfinite(m.obstacle_length) &&
                     m.obstacle_width > 0.0 && std::isfinite(m.obstacle_width),
                 "obstacle of {} by {}", m.obstacle_length, m.obstacle_width);
  TRACKBED_CHECK(m.safe_distance >= 0.0 && std::isfinite(m.safe_distance), "safe distance {}",
                 m.safe_distance);
  TRACKBED_CHECK(m.inner_width >= 0.0 && std::isfinite(m.inner_width) && m.outer_width >= 0.0 &&
                     std::isfinite(m.outer_width),
                 "free widths {} and {}", m.inner_width, m.outer_width);
  TRACKBED_CHECK(vehicle.width > 0.0 && std::isfinite(vehicle.width), "width {}", vehicle.width);
}

/// Returns the width 2 (SD + IS_k + w_a) that the maneuver requires [m]; SD is the safe distance,
/// IS_k half the obstacle's diagonal and w_a the car's width.
double RequiredWidth(const TurnManeuver& maneuver, double vehicle_width) {
  const double half_diagonal = 0.5 * std::hypot(maneuver.obstacle_width, maneuver.obstacle_length);
  return 2.0 * maneuver.safe_distance + 2.0 * half_diagonal + 2.0 * vehicle_width;
}

/// Returns the angles sigma of the arc's sample points from A to E, in ascending order.
std::vector<double> ArcAngles(const TurnManeuver& maneuver) {
  const double sweep = maneuver.turn_angle - maneuver.reduction;
  std::vector<double> angles;
  if (!(sweep > 0.0)) {
    return angles;
  }
  // The factor 1 + 1e-12 ensures that rounding does not drop the last point if the arc's angle is a
  // whole number of steps.
  const double steps = sweep / kGrid;
  if (maneuver.literal.grid) {
    const double last = std::floor(steps * (1.0 + 1e-12));
    for (double i = last; i >= 0.0; i -= 1.0) {
      angles.push_back(0.5 * kPi - (maneuver.reduction + kGrid * i));
    }
  } else {
    const double last = std::ceil(steps);
    for (double i = 0.0; i <= last; i += 1.0) {
      angles.push_back(sweep * (i / last));
    }
  }
  return angles;
}

/// Returns whether two line segments cross: the two ends of each segment must lie on different
/// sides of the other segment's line. An end point exactly on the other segment's line counts as
/// right of this line.
bool LinesCross(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const auto left = [](const Vec2& p, const Vec2& q, const Vec2& r) {
    return Cross(q - p, r - p) > 0.0;
  };
  return left(a, c, d) != left(b, c, d) && left(a, b, c) != left(a, b, d);
}

/// Returns whether a segment crosses no side of the box. A segment entirely within the box crosses
/// no side and counts as free, as in listing F.2 (deviation L13).
bool CrossesNoSide(const Vec2& from, const Vec2& to, const OrientedBox& box) {
  const std::array<Vec2, 4> corners = box.Corners();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (LinesCross(from, to, corners[i], corners[(i + 1) % corners.size()])) {
      return false;
    }
  }
  return true;
}

/// Returns the index of the node nearest to a point; among equally near nodes, returns the first.
std::size_t NearestNode(const std::vector<TreeNode>& nodes, const Vec2& point) {
  std::size_t nearest = 0;
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    if ((nodes[i].position - point).norm() < (nodes[nearest].position - point).norm()) {
      nearest = i;
    }
  }
  return nearest;
}

/// Returns the corner of the obstacle to which listing F.2 measures distances. If the car passes on
/// the inside of the turn, the result is the rear inner corner of the obstacle. If the car passes
/// on the outside, the result is the front outer corner.
Vec2 TestCorner(const TurnManeuver& maneuver, const OrientedBox& obstacle) {
  const double inward = maneuver.passing_side() == PassingSide::kInner ? 1.0 : -1.0;
  return ToWorld(obstacle.center,
                 {-inward * 0.5 * obstacle.length, inward * Sign(maneuver) * 0.5 * obstacle.width});
}

}  // namespace

double SafeRadius(const TurnManeuver& maneuver, double vehicle_width, PassingSide passing_side) {
  const double need = RequiredWidth(maneuver, vehicle_width);
  return passing_side == PassingSide::kInner
             ? maneuver.radius - need - maneuver.inner_width
             : 1.5 * (maneuver.radius + need + maneuver.outer_width);
}

TurnLayout LayOutTurn(const TurnManeuver& maneuver, const VehicleParams& vehicle) {
  CheckRanges(maneuver, vehicle);
  TurnLayout layout;
  const std::vector<double> angles = ArcAngles(maneuver);
  const double sixths = maneuver.obstacle_sixth / 6.0;
  const double count = static_cast<double>(angles.size());
  layout.obstacle_at =
      static_cast<std::size_t>(maneuver.literal.grid ? std::round(count * sixths)
                                                     : 1.0 + std::round((count - 1.0) * sixths));
  if (angles.empty() || layout.obstacle_at == 0) {
    layout.status = TurnStatus::kNoTurn;
    layout.reason = fmt::format("a turn of {:.6g} rad less {:.6g} rad leaves no arc",
                                maneuver.turn_angle, maneuver.reduction);
    return layout;
  }
  layout.safe_radius = SafeRadius(maneuver, vehicle.width, maneuver.passing_side());
  if (!(layout.safe_radius > 0.0)) {
    layout.status = TurnStatus::kNoSafePoint;
    layout.reason = fmt::format(
        "passing on the inside needs {:.6g} m (safe distance, obstacle diagonal, car width and the "
        "{:.6g} m kept free); the turn radius is {:.6g} m",
        maneuver.radius - layout.safe_radius, maneuver.inner_width, maneuver.radius);
    return layout;
  }
  for (const double angle : angles) {
    layout.arc.push_back({angle, PointAt(maneuver, maneuver.radius, angle)});
  }
  double obstacle_angle = sixths * (maneuver.turn_angle - maneuver.reduction);
  layout.safe_angle = obstacle_angle;
  if (maneuver.literal.grid) {
    // Listing F.2 reverses the points of the arc but not their angles. Due to this inconsistency,
    // the angle of the safe point is wrong by the remainder of the arc's angle divided by the grid
    // step.
    obstacle_angle = angles[layout.obstacle_at - 1];
    layout.safe_angle = kGrid * static_cast<double>(layout.obstacle_at - 1);
  }
  const Vec2 center = PointAt(maneuver, maneuver.radius, obstacle_angle);
  layout.obstacle = {
      {center.x(), center.y(), 0.0}, maneuver.obstacle_length, maneuver.obstacle_width};
  layout.safe_point = PointAt(maneuver, layout.safe_radius, layout.safe_angle);
  return layout;
}

std::array<Vec2, 8> ControlPoints(const TurnManeuver& maneuver, const TurnLayout& layout,
                                  const VehicleParams& vehicle, double final_y) {
  TRACKBED_CHECK(layout.ok(), "the layout failed: {}", layout.reason);
  TRACKBED_CHECK(std::isfinite(final_y), "final y {}", final_y);
  const double sign = Sign(maneuver);
  const double straight = maneuver.straight();
  const Vec2 arc_start = layout.arc.front().position;
  const Vec2 arc_end = layout.arc.back().position;
  std::array<Vec2, 8> points;
  points[0] = Vec2::Zero();
  points[2] =
      maneuver.obstacle_sixth > 3 ? arc_start : Vec2{2.0 / 3.0 * arc_start.x(), arc_start.y()};
  points[1] = {0.5 * points[2].x(), 0.0};
  points[3] = {arc_start.x(), final_y};
  points[4] = layout.safe_point;
  const double end_angle = layout.arc.back().angle;
  Vec2 exit{std::cos(end_angle), sign * std::sin(end_angle)};
  points[5] = arc_end;
  if (maneuver.literal.right_angle_rule && maneuver.reduction == 0.0) {
    // Give P_5 the y coordinate that the safe point has if the car passes on the inside of the
    // turn, even if the car passes on the outside.
    const double radius = SafeRadius(maneuver, vehicle.width, PassingSide::kInner);
    const double y = maneuver.passing_side() == PassingSide::kInner
                         ? layout.safe_point.y()
                         : PointAt(maneuver, radius, layout.safe_angle).y();
    points[5] = {arc_end.x(), y};
    exit = {0.0, sign};
  }
  points[6] = points[5] + 0.5 * straight * exit;
  points[7] = points[5] + straight * exit;
  if (maneuver.literal.right_shift && maneuver.side == TurnSide::kRight &&
      !(maneuver.literal.right_angle_rule && maneuver.reduction == 0.0)) {
    points[5].x() += std::cos(end_angle);
  }
  return points;
}

LiteralTree LiteralRrtStar(const TurnManeuver& maneuver, const TurnLayout& layout,
                           std::uint64_t seed) {
  TRACKBED_CHECK(layout.ok(), "the layout failed: {}", layout.reason);
  boost::random::mt19937_64 random(seed);
  const auto uniform = [&random] { return boost::random::uniform_01<double>()(random); };
  const OrientedBox& obstacle = layout.obstacle;
  const double x_max = obstacle.center.x;
  const double y_max =
      maneuver.passing_side() == PassingSide::kInner ? obstacle.center.y : -obstacle.center.y;
  const int iterations = static_cast<int>(std::floor(0.5 * maneuver.straight()));

  LiteralTree tree;
  std::vector<TreeNode>& nodes = tree.nodes;
  nodes.push_back({{0.0, 0.0}, 0, 0.0});
  for (int i = 0; i < iterations; ++i) {
    const double x = std::floor(uniform() * x_max);
    const double y = std::floor(uniform() * y_max);
    const Vec2 sample{x, y};
    const std::size_t near = NearestNode(nodes, sample);
    const Vec2 from = nodes[near].position;
    if (!CrossesNoSide(from, sample, obstacle)) {
      continue;
    }
    const double distance = (sample - from).norm();
    const Vec2 position =
        distance < kTreeStep ? sample : Vec2(from + (sample - from) * (kTreeStep / distance));
    const double near_cost = nodes[near].cost + (position - from).norm();
    std::size_t parent = near;
    double cheapest = near_cost;
    for (std::size_t j = 0; j < nodes.size(); ++j) {
      const double length = (nodes[j].position - position).norm();
      if (length <= kNeighbors && nodes[j].cost + length < cheapest &&
          CrossesNoSide(nodes[j].position, position, obstacle)) {
        parent = j;
        cheapest = nodes[j].cost + length;
      }
    }
    nodes.push_back({position, parent, near_cost});
  }
  tree.final_node = NearestNode(nodes, layout.safe_point);
  tree.goal_distance = (nodes[tree.final_node].position - layout.safe_point).norm();
  tree.final_y = nodes[tree.final_node].position.y();
  return tree;
}

ManeuverRun SimulateManeuver(const TurnManeuver& maneuver, const TurnLayout& layout,
                             const VehicleParams& vehicle, const BezierCurve& curve) {
  TRACKBED_CHECK(layout.ok(), "the layout failed: {}", layout.reason);
  ManeuverRun drive;
  drive.clearance = kInfinity;
  drive.samples.reserve(kIntervals + 1);
  for (std::size_t i = 0; i <= kIntervals; ++i) {
    const double u = static_cast<double>(i) / static_cast<double>(kIntervals);
    const Vec2 position = curve.At(u);
    const Vec2 tangent = curve.Derivative(u, 1);
    ManeuverSample sample;
    sample.u = u;
    sample.pose = {position.x(), position.y(), std::atan2(tangent.y(), tangent.x())};
    if (i > 0) {
      sample.s = drive.samples.back().s + (position - drive.samples.back().pose.position()).norm();
    }
    sample.time = sample.s / maneuver.speed;
    sample.curvature = curve.Curvature(u);
    sample.steering = SteeringForCurvature(vehicle, sample.curvature);
    // With the wheelbase L and the curvature K, the steering rate is d atan(L K)/dt = v L K'/(1 +
    // (L K)^2).
    const double slope = vehicle.wheelbase * sample.curvature;
    const double rate =
        std::abs(maneuver.speed * vehicle.wheelbase * curve.Sharpness(u) / (1.0 + slope * slope));
    // Where the derivative of the curve vanishes, the steering angle is NaN, which counts as
    // exceeding every limit.
    const double angle = std::abs(sample.steering);
    drive.steering_max = std::max(drive.steering_max, std::isnan(angle) ? kInfinity : angle);
    drive.steering_rate_max =
        std::max(drive.steering_rate_max, std::isnan(rate) ? kInfinity : rate);
    drive.clearance =
        std::min(drive.clearance, Distance(FootprintAt(vehicle, sample.pose), layout.obstacle));
    drive.samples.push_back(sample);
  }
  drive.length = drive.samples.back().s;
  drive.duration = drive.length / maneuver.speed;

  const double station = drive.length * (maneuver.obstacle_sixth / 6.0) - kProbeDistance;
  const auto reached =
      std::find_if(drive.samples.begin() + 1, drive.samples.end(),
                   [&](const ManeuverSample& sample) { return sample.s >= station; });
  const std::size_t index = static_cast<std::size_t>(reached - drive.samples.begin());
  drive.test_point = drive.samples[std::max<std::size_t>(index, 2) - 2].pose.position();
  drive.test_corner = TestCorner(maneuver, layout.obstacle);
  drive.test_distance = (drive.test_point - drive.test_corner).norm();

  drive.test_passed = drive.test_distance >= maneuver.safe_distance + 0.5 * vehicle.width;
  drive.keeps_clear = drive.clearance >= maneuver.safe_distance;
  drive.steerable = drive.steering_max <= SteeringReach(vehicle, 0.0) &&
                    drive.steering_rate_max <= vehicle.steering_rate;
  return drive;
}

Pose2 ManeuverFrame(const TurnManeuver& maneuver, const Pose2& X_WA) {
  return Compose(X_WA, {-maneuver.straight(), 0.0, 0.0});
}

}  // namespace trackbed
