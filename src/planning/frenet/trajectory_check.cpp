#include "src/planning/frenet/trajectory_check.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "trackbed/core/error.h"
#include "trackbed/world/world.h"

namespace trackbed {
namespace {

constexpr double kNodeSpacing = 0.25;  // Distance between the nodes of the path table [m].
// Relative tolerance that accepts motions that reach a limit exactly.
constexpr double kRounding = 1e-9;
// Smallest speed at which the heading is computed from d(t) [m/s].
constexpr double kMinHeadingSpeed = 0.1;

double HalfDiagonal(const OrientedBox& box) {
  return 0.5 * std::hypot(box.length, box.width);
}

}  // namespace

PathTable::PathTable(const Path& path, Stations within) : from_(within.from) {
  const double count = std::ceil(std::max(within.to - within.from, 0.0) / kNodeSpacing);
  nodes_.reserve(static_cast<std::size_t>(count) + 2);
  for (double i = 0.0; i <= count + 1.0; i += 1.0) {
    const PathPoint point = path.At(from_ + i * kNodeSpacing);
    nodes_.push_back({point, Direction(point.pose.yaw)});
  }
}

PathPoint PathTable::At(double s) const {
  const double index = std::clamp(std::round((s - from_) / kNodeSpacing), 0.0,
                                  static_cast<double>(nodes_.size() - 1));
  const Node& node = nodes_[static_cast<std::size_t>(index)];
  const double u = s - node.point.s;
  const double k = node.point.curvature;
  const double k_rate = node.point.sharpness;
  const double ahead = u * (1.0 - k * u * u * (k / 6.0 + u * k_rate / 8.0));
  const double left = u * u * (k / 2.0 + u * (k_rate / 6.0 - k * k * k * u / 24.0));
  const Vec2 position =
      node.point.pose.position() + ahead * node.forward + left * LeftNormal(node.forward);
  return {s,
          {position.x(), position.y(), node.point.pose.yaw + u * (k + 0.5 * u * k_rate)},
          k + u * k_rate,
          node.point.direction,
          k_rate};
}

TrajectoryCheck::TrajectoryCheck(const Path& path, const FrenetRequest& request,
                                 const FrenetLimits& limits, double to)
    : path_(path),
      request_(request),
      limits_(limits),
      table_(path, {request.start.s - 1.0, std::max(to, request.start.s) + 1.0}) {
  const PathPoint at = path.At(request.start.s);
  const auto start = FromFrenet(at, request.start);
  if (!start) {
    blocked_ = "the path has no Frenet frame at the car's position";
    return;
  }
  const auto loosened = [](double limit, double at_start) {
    const double most = std::max(limit, at_start);
    return most + kRounding * (1.0 + std::abs(most));
  };
  const double v = start->speed;
  slowest_ = std::min(v, 0.0) - kRounding;
  speed_ = loosened(request.speed.speed * (1.0 + limits.speed_tolerance), v);
  acceleration_ = loosened(request.speed.acceleration, start->acceleration);
  deceleration_ = loosened(request.speed.deceleration, -start->acceleration);
  lateral_acceleration_ =
      loosened(limits.max_lateral_acceleration, v * v * std::abs(start->curvature));
  curvature_ = loosened(1.0 / request.vehicle.min_turning_radius(), std::abs(start->curvature));
  steering_rate_ = loosened(limits.max_steering_rate_fraction * request.vehicle.steering_rate, 0.0);
  const Reach reach = ComputeReach(at, request.start);
  left_ = loosened(request.road.left, reach.left);
  right_ = loosened(request.road.right, reach.right);
  if (request.edges) {
    start_excess_ = loosened(0.0, ReachBeyond(*request.edges, request.vehicle, at, request.start));
  }
  const OrientedBox footprint = FootprintAt(request.vehicle, start->pose);
  for (const MovingBox& obstacle : request.obstacles) {
    const double clearance = Separation(footprint, obstacle.box);
    if (clearance <= 0.0) {
      blocked_ = "the car is in collision with an obstacle";
      return;
    }
    obstacles_.push_back({obstacle, std::min(limits.safe_distance, clearance) - kRounding,
                          HalfDiagonal(footprint) + HalfDiagonal(obstacle.box) +
                              std::min(limits.safe_distance, clearance)});
  }
}

TrajectoryCheck::Reach TrajectoryCheck::ComputeReach(const PathPoint& at,
                                                     const FrenetState& frenet) const {
  const VehicleParams& car = request_.vehicle;
  const double k = at.curvature;
  const double tangent = frenet.d_slope / (1.0 - k * frenet.d);
  const double cosine = 1.0 / std::sqrt(1.0 + tangent * tangent);
  const double sine = tangent * cosine;
  Reach reach{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const double x : {-car.rear_overhang, car.length - car.rear_overhang}) {
    for (const double y : {-0.5 * car.width, 0.5 * car.width}) {
      const double ahead = x * cosine - y * sine;
      const double aside = frenet.d + x * sine + y * cosine;
      // On a path of curvature k, the point (ahead, aside) of the footprint has the offset d = (1 -
      // sqrt((k ahead)^2 + (1 - k aside)^2))/k. The code uses a form that also holds for k = 0.
      const double to_center = 1.0 - k * aside;
      const double d = (2.0 * aside - k * (aside * aside + ahead * ahead)) /
                       (1.0 + std::sqrt(k * ahead * k * ahead + to_center * to_center));
      reach.left = std::max(reach.left, d);
      reach.right = std::max(reach.right, -d);
    }
  }
  return reach;
}

bool TrajectoryCheck::Collides(double time, const Pose2& pose) const {
  const OrientedBox footprint = FootprintAt(request_.vehicle, pose);
  return std::any_of(obstacles_.begin(), obstacles_.end(), [&](const Obstacle& obstacle) {
    const OrientedBox box = obstacle.box.At(time);
    const Vec2 apart = box.center.position() - footprint.center.position();
    return apart.squaredNorm() < obstacle.reach * obstacle.reach &&
           Separation(footprint, box) < obstacle.margin;
  });
}

std::optional<Rejection> TrajectoryCheck::CheckPoint(double time, const PathPoint& at,
                                                     const FrenetState& frenet,
                                                     const MotionState& motion,
                                                     std::optional<PreviousPoint>& before) const {
  const double v = motion.speed;
  if (!(v <= speed_ && v >= slowest_)) {
    return Rejection::kSpeed;
  }
  if (!(motion.acceleration <= acceleration_ && motion.acceleration >= -deceleration_) ||
      !(v * v * std::abs(motion.curvature) <= lateral_acceleration_)) {
    return Rejection::kAcceleration;
  }
  if (!(std::abs(motion.curvature) <= curvature_)) {
    return Rejection::kCurvature;
  }
  const double steering = SteeringForCurvature(request_.vehicle, motion.curvature);
  if (before && std::abs(steering - before->steering) > steering_rate_ * (time - before->time)) {
    return Rejection::kSteeringRate;
  }
  before = {time, steering};
  const Reach reach = ComputeReach(at, frenet);
  if (reach.left > left_ || reach.right > right_) {
    return Rejection::kRoad;
  }
  if (request_.edges &&
      ReachBeyond(*request_.edges, request_.vehicle, at, frenet) > start_excess_) {
    return Rejection::kRoad;
  }
  if (Collides(time, motion.pose)) {
    return Rejection::kCollision;
  }
  return std::nullopt;
}

std::optional<Rejection> TrajectoryCheck::CheckCoarsely(const FrenetPiece& piece,
                                                        double time) const {
  std::optional<PreviousPoint> before;
  const auto check = [&](double t) -> std::optional<Rejection> {
    const FrenetState frenet = piece.At(t);
    if (!piece.over_station && frenet.s_rate < kMinHeadingSpeed) {
      return Rejection::kSpeed;
    }
    const PathPoint at = table_.At(frenet.s);
    const auto motion = FromFrenet(at, frenet);
    if (!motion) {
      return Rejection::kFrame;
    }
    return CheckPoint(time + t, at, frenet, *motion, before);
  };
  const double duration = piece.duration;
  const int intervals = std::max(1, static_cast<int>(std::ceil(duration / limits_.time_step)));
  // Motions along quintic polynomials have the highest steering rates at both ends, so also check
  // points at the fine spacing from each end.
  const double first = std::min(duration / intervals, limits_.spacing / piece.s.At(0.0, 1));
  const double last = std::min(duration / intervals, limits_.spacing / piece.s.At(duration, 1));
  auto rejection = check(0.0);
  if (!rejection && first > 0.0 && first < 0.9 * duration / intervals) {
    rejection = check(first);
  }
  for (int i = 1; i < intervals && !rejection; ++i) {
    rejection = check(duration * i / intervals);
  }
  if (!rejection && last > 0.0 && last < 0.9 * duration / intervals) {
    rejection = check(duration - last);
  }
  return rejection ? rejection : check(duration);
}

std::optional<TrajectoryCheck::Flaw> TrajectoryCheck::CheckFinely(
    const std::vector<TrajectoryPoint>& points) const {
  std::optional<PreviousPoint> before;
  for (const TrajectoryPoint& point : points) {
    const PathPoint at = path_.At(point.frenet.s);
    if (const auto rejection = CheckPoint(point.t, at, point.frenet, point.motion, before)) {
      return Flaw{*rejection, point.t};
    }
  }
  return std::nullopt;
}

void CheckRequest(const FrenetRequest& request, const FrenetLimits& limits,
                  const FrenetWeights& weights) {
  const FrenetState& start = request.start;
  TRACKBED_CHECK(std::isfinite(start.s) && std::isfinite(start.d) && std::isfinite(start.d_slope) &&
                     std::isfinite(start.d_bend) && std::isfinite(start.s_acceleration) &&
                     std::isfinite(start.s_rate),
                 "start at station {}, offset {}, rate {}", start.s, start.d, start.s_rate);
  TRACKBED_CHECK(limits.time_step > 0.0 && limits.spacing > 0.0 && limits.safe_distance >= 0.0,
                 "time step {}, spacing {}, safe distance {}", limits.time_step, limits.spacing,
                 limits.safe_distance);
  TRACKBED_CHECK(weights.derivative_order == 2 || weights.derivative_order == 3,
                 "derivative order {}", weights.derivative_order);
}

}  // namespace trackbed
