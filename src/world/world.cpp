#include "trackbed/world/world.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"

namespace trackbed {

double RoadFactor(const World& world, const Vec2& point_W) {
  return RoadFactor(world.friction, world.friction_patches, point_W);
}

double RoadFactor(double friction, const std::vector<FrictionPatch>& patches, const Vec2& point_W) {
  TRACKBED_REQUIRE(point_W.allFinite(), "RoadFactor: the point {}, {} is not finite", point_W.x(),
                   point_W.y());
  const auto on_top =
      std::find_if(patches.rbegin(), patches.rend(),
                   [&](const FrictionPatch& patch) { return Contains(patch.area, point_W); });
  return on_top == patches.rend() ? friction : on_top->friction;
}

double GroundHeight(const World& world, const Vec2& point_W) {
  return GroundHeight(world.ground, point_W);
}

Eigen::Vector3d GroundNormal(const World& world, const Vec2& point_W) {
  return GroundNormal(world.ground, point_W);
}

Vec2 WindAt(const World& world, const Vec2& point_W, double time) {
  return WindAt(world.wind, point_W, time);
}

namespace {

bool HasMap(const World& world) {
  return world.map && world.map->data;
}

}  // namespace

bool HasObstacles(const World& world) {
  return !world.obstacles.empty() || !MapWalls(world).empty();
}

const std::vector<OrientedBox>& MapWalls(const World& world) {
  static const std::vector<OrientedBox> none;
  return HasMap(world) ? world.map->data->boxes() : none;
}

OrientedBox FootprintAt(const VehicleParams& vehicle, const Pose2& pose) {
  const Vec2 middle = ToWorld(pose, {0.5 * vehicle.length - vehicle.rear_overhang, 0.0});
  return {{middle.x(), middle.y(), pose.yaw}, vehicle.length, vehicle.width};
}

namespace {

/// A piece of an obstacle's motion, from one pose to the next.
struct MotionPiece {
  TimedPose from;
  TimedPose to;
  Vec2 velocity;    // [m/s]
  double yaw_rate;  // [rad/s]
};

/// Returns the piece of an obstacle's motion at the time `time`. Before the start of the obstacle's
/// motion, returns the first piece, and after the end the last piece.
MotionPiece PieceAt(const std::vector<TimedPose>& motion, double time) {
  const auto after =
      std::upper_bound(motion.begin() + 1, motion.end() - 1, time,
                       [](double t, const TimedPose& pose) { return t < pose.time; });
  const TimedPose& from = *(after - 1);
  const TimedPose& to = *after;
  const double duration = to.time - from.time;
  return {from, to, (to.pose.position() - from.pose.position()) / duration,
          AngleDifference(to.pose.yaw, from.pose.yaw) / duration};
}

}  // namespace

ObstacleMotion MotionAt(const Obstacle& obstacle, double time) {
  if (obstacle.until && time > *obstacle.until) {
    constexpr double kGone = 1e6;  // [m]
    return {.displacement = {kGone, 0.0, 0.0}};
  }
  if (obstacle.motion.empty()) {
    return {
        {obstacle.velocity.x() * time, obstacle.velocity.y() * time, 0.0}, obstacle.velocity, 0.0};
  }
  const MotionPiece piece = PieceAt(obstacle.motion, time);
  const double since = time - piece.from.time;
  const double rotated = std::clamp(since, 0.0, piece.to.time - piece.from.time);
  const Vec2 place = piece.from.pose.position() + since * piece.velocity;
  const Pose2& start = obstacle.footprint.center;
  return {{place.x() - start.x, place.y() - start.y,
           piece.from.pose.yaw + rotated * piece.yaw_rate - start.yaw},
          piece.velocity,
          rotated == since ? piece.yaw_rate : 0.0};
}

OrientedBox FootprintAt(const Obstacle& obstacle, double time) {
  const Pose2 moved = MotionAt(obstacle, time).displacement;
  OrientedBox box = obstacle.footprint;
  box.center.x += moved.x;
  box.center.y += moved.y;
  box.center.yaw += moved.yaw;
  return box;
}

bool IsKnown(const Obstacle& obstacle, double time, const OrientedBox& footprint) {
  if (obstacle.known_from_range) {
    return Distance(footprint, FootprintAt(obstacle, time)) <= *obstacle.known_from_range;
  }
  return time >= obstacle.known_from_time.value_or(0.0);
}

std::optional<double> Clearance(const World& world, const VehicleParams& vehicle, const Pose2& pose,
                                double time) {
  if (!HasObstacles(world)) {
    return std::nullopt;
  }
  const OrientedBox footprint = FootprintAt(vehicle, pose);
  const Vec2 middle = footprint.center.position();
  const double radius = 0.5 * std::hypot(footprint.length, footprint.width);
  double nearest = std::numeric_limits<double>::infinity();
  for (const Obstacle& obstacle : world.obstacles) {
    const OrientedBox box = FootprintAt(obstacle, time);
    // Skip boxes whose bounding circles are so far away that another box must be nearer.
    const double circles = nearest + radius + 0.5 * std::hypot(box.length, box.width);
    if ((box.center.position() - middle).squaredNorm() < circles * circles) {
      nearest = std::min(nearest, Distance(footprint, box));
    }
  }
  return HasMap(world) ? world.map->data->index().DistanceTo(footprint, nearest) : nearest;
}

namespace {

/// Returns the largest speed of a point of an obstacle between two times [m/s].
double MaxSpeed(const Obstacle& obstacle, double from, double to) {
  if (obstacle.motion.empty()) {
    return obstacle.velocity.norm();
  }
  const double radius = 0.5 * std::hypot(obstacle.footprint.length, obstacle.footprint.width);
  double fastest = 0.0;
  for (double time = from;;) {
    const MotionPiece piece = PieceAt(obstacle.motion, time);
    fastest = std::max(fastest, piece.velocity.norm() + std::abs(piece.yaw_rate) * radius);
    if (piece.to.time >= to || piece.to.time <= time) {
      return fastest;
    }
    time = piece.to.time;
  }
}

/// Returns an upper bound of the distance by which a point of the footprint moves relative to an
/// obstacle between two samples [m].
double MaxRelativeMotion(const World& world, const VehicleParams& vehicle,
                         const ClearanceSample& from, const ClearanceSample& to) {
  const double reach = std::hypot(
      std::max(vehicle.length - vehicle.rear_overhang, vehicle.rear_overhang), 0.5 * vehicle.width);
  double fastest = 0.0;
  for (const Obstacle& obstacle : world.obstacles) {
    fastest = std::max(fastest, MaxSpeed(obstacle, from.time, to.time));
  }
  return (to.pose.position() - from.pose.position()).norm() +
         reach * std::abs(to.pose.yaw - from.pose.yaw) + fastest * (to.time - from.time);
}

/// Largest number of bisections in the search for the smallest clearance. The limit kMaxBisections
/// of bisections suffices for any real motion of a car, and limits the computing time if a
/// simulation has diverged.
constexpr long kMaxBisections = 100000;

/// Searches for the smallest clearance between two samples by bisection. Between the two samples,
/// the clearance changes by at most `moved` [m]. The bisection stops when no further reduction of
/// the smallest known clearance by more than a tolerance is possible.
void Approach(const World& world, const VehicleParams& vehicle, const ClearanceSample& from,
              const ClearanceSample& to, double moved, long& looks, ClosestApproach& best) {
  constexpr double kTolerance = 5e-3;  // [m]
  constexpr double kShare = 1e-2;
  constexpr double kDepth = 1e-3;  // [m]
  const double least = 0.5 * (from.clearance + to.clearance - moved);
  const double near = best.clearance - std::max(kTolerance, kShare * best.clearance);
  // If the car may touch an obstacle, ignore the tolerance and continue until the clearance changes
  // by less than kDepth between the samples.
  if (best.clearance == 0.0 || moved < kDepth || (least > 0.0 && least >= near) || --looks < 0) {
    return;
  }
  ClearanceSample middle{
      .pose = {std::lerp(from.pose.x, to.pose.x, 0.5), std::lerp(from.pose.y, to.pose.y, 0.5),
               std::lerp(from.pose.yaw, to.pose.yaw, 0.5)},
      .time = std::lerp(from.time, to.time, 0.5)};
  middle.clearance = *Clearance(world, vehicle, middle.pose, middle.time);
  if (middle.clearance < best.clearance) {
    best = {middle.clearance, middle.time};
  }
  Approach(world, vehicle, from, middle, 0.5 * moved, looks, best);
  Approach(world, vehicle, middle, to, 0.5 * moved, looks, best);
}

}  // namespace

ClosestApproach ApproachBetween(const World& world, const VehicleParams& vehicle,
                                const ClearanceSample& from, const ClearanceSample& to) {
  TRACKBED_CHECK(HasObstacles(world), "no obstacles");
  const double moved = MaxRelativeMotion(world, vehicle, from, to);
  TRACKBED_REQUIRE(std::isfinite(moved) && from.clearance >= 0.0 && to.clearance >= 0.0,
                   "ApproachBetween: {} m moved between clearances of {} and {} m; must be finite, "
                   "the clearances at least 0",
                   moved, from.clearance, to.clearance);
  long looks = kMaxBisections;
  ClosestApproach best = from.clearance <= to.clearance ? ClosestApproach{from.clearance, from.time}
                                                        : ClosestApproach{to.clearance, to.time};
  Approach(world, vehicle, from, to, moved, looks, best);
  return best;
}

}  // namespace trackbed
