// Random planning problems for the property tests.
//
// A problem consists of a car, a route, start and goal headings, obstacles and planner options. The
// size of the car and of the scene is a power of ten. A route is easily drivable, or lies on a
// lattice and contains degenerate legs. Mirrored() and Moved() transform a problem without changing
// the shape of its solution.

#include "tests/properties/problems.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "tests/properties/option_numbers.h"
#include "tests/properties/property.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/core/angle.h"
#include "trackbed/planning/course/course.h"
#include "trackbed/planning/course/lane_change.h"
#include "trackbed/planning/grid/astar_planner.h"
#include "trackbed/planning/grid/hybrid_astar.h"
#include "trackbed/planning/path_file/path_file_planner.h"
#include "trackbed/planning/sampling/rrt_planner.h"
#include "trackbed/planning/sampling/rrt_star_planner.h"

namespace properties {
namespace {

using namespace trackbed;

/// Returns a random heading [rad]: a multiple of an eighth of a turn, a heading very close to such
/// a multiple, or any heading.
double AnyHeading() {
  const double eighths = 0.25 * kPi * Pick(0, 7);
  switch (Pick(0, 3)) {
    case 0:
      return eighths;
    case 1:
      return eighths + *PowerOfTen(-15, -1);
    case 2:
      return eighths - *PowerOfTen(-15, -1);
    default:
      return *Within(kPi);
  }
}

/// Returns random points of a lattice. Many of the points coincide, lie on one line or turn back.
/// Some points lie slightly off the lattice.
std::vector<Vec2> LatticeRoute(std::size_t count, double scale) {
  std::vector<Vec2> route;
  for (std::size_t i = 0; i < count; ++i) {
    Vec2 point = 15.0 * scale * Vec2(Pick(-3, 3), Pick(-3, 3));
    if (OnceIn(3)) {
      point += 15.0 * scale * *PowerOfTen(-15, -1) * Direction(AnyHeading());
    }
    route.push_back(point);
  }
  return route;
}

/// Returns a route whose legs turn by less than a right angle.
std::vector<Vec2> EasyRoute(std::size_t count, double scale) {
  std::vector<Vec2> route{scale * Vec2(*Within(30.0), *Within(30.0))};
  double heading = *Within(kPi);
  for (std::size_t i = 1; i < count; ++i) {
    route.push_back(route.back() + scale * *Between(25.0, 60.0) * Direction(heading));
    heading += *Within(1.3);
  }
  return route;
}

/// Sets distances that suit the size of the car, and budgets that limit the time of a test case to
/// 0.1 s.
void SetOptions(PlannerOptions& options, double scale, bool adversarial) {
  ForEachNumber([&](KeyVisitor& keys) { Visit(keys, options); },
                [&](const std::string& key, double& value, Range) {
                  if (key == "safe_distance") {
                    value *= scale;
                  }
                });
  if (auto* course = options.GetIf<CourseOptions>()) {
    const int count = Pick(1, 4);
    for (int i = 0; i < count; ++i) {
      CoursePiece piece{.length = scale * *Between(0.5, 20.0)};
      const double curvature = *Within(adversarial ? 0.4 : 0.15) / scale;
      (OnceIn(2) ? piece.curvature_to : piece.curvature) = curvature;
      course->segments.push_back(piece);
    }
  } else if (auto* path = options.GetIf<PathFileOptions>()) {
    FittedPath fitted;
    const double length = scale * *Between(0.5, 20.0);
    const double curvature = *Within(adversarial ? 0.4 : 0.15) / scale;
    fitted.path = Path(Pose2{}, {{.length = length},
                                 {.length = length, .sharpness = curvature / length},
                                 {.length = length, .curvature = curvature}});
    fitted.given.points = {{0.0, 0.0}, fitted.path.At(3.0 * length).pose.position()};
    fitted.stations = {0.0, fitted.path.length()};
    path->path = std::make_shared<const FittedPath>(std::move(fitted));
  } else if (auto* lane_change = options.GetIf<LaneChangePlannerOptions>()) {
    lane_change->lead_in = *Between(0.1, 20.0);
  } else if (auto* hybrid = options.GetIf<HybridAStarOptions>()) {
    hybrid->reverse = OnceIn(2);
    hybrid->budget = 2000;
  } else if (auto* rrt = options.GetIf<RrtPlannerOptions>()) {
    rrt->trees = 2;
    rrt->iterations = 1000;
  } else if (auto* rrt_star = options.GetIf<RrtStarPlannerOptions>()) {
    rrt_star->trees = 2;
    rrt_star->iterations = 1000;
  } else if (auto* astar = options.GetIf<AStarOptions>()) {
    astar->budget = 20000;
  }
}

/// Applies `transform` to the path in the options of the planner path_file.
template <typename Transform>
void TransformPath(PlannerOptions& options, const Transform& transform) {
  auto* own = options.GetIf<PathFileOptions>();
  if (own != nullptr && own->path != nullptr) {
    FittedPath fitted = *own->path;
    fitted.path = transform(fitted.path);
    own->path = std::make_shared<const FittedPath>(std::move(fitted));
  }
}

void AddObstacles(PlanRequest& request, double scale, bool adversarial) {
  const int count = OnceIn(2) ? Pick(1, 3) : 0;
  for (int i = 0; i < count; ++i) {
    Vec2 at = 15.0 * scale * Vec2(*Within(4.0), *Within(4.0));
    if (adversarial && OnceIn(3)) {
      at = OnceIn(2) || request.waypoints.empty() ? request.start.position()
                                                  : request.waypoints.back();
    }
    const double size = adversarial ? scale * *PowerOfTen(-3, 1) : scale;
    request.obstacles.push_back(
        {{at.x(), at.y(), AnyHeading()}, size * *Between(0.1, 3.0), size * *Between(0.1, 3.0)});
  }
}

void SetStart(PlanRequest& request, double scale, bool adversarial) {
  const std::vector<Vec2>& route = request.waypoints;
  request.start = {scale * 15.0 * Pick(-3, 3), scale * 15.0 * Pick(-3, 3), AnyHeading()};
  if (route.size() >= 2 && !(adversarial && OnceIn(4))) {
    const Vec2 leg = route[1] - route[0];
    request.start = {route[0].x(), route[0].y(), std::atan2(leg.y(), leg.x())};
  }
  if (OnceIn(2)) {
    request.start_speed = request.speed.speed * *Between(0.0, adversarial ? 3.0 : 1.0);
  }
  if (adversarial && OnceIn(3)) {
    request.start_steering = *Within(1.2) * request.vehicle.steering_limit;
  }
}

}  // namespace

VehicleParams ScaledCar(double scale) {
  VehicleParams car = ReferenceCar();
  for (double* length :
       {&car.wheelbase, &car.cg_to_rear, &car.track_front, &car.track_rear, &car.wheel_radius,
        &car.length, &car.width, &car.height, &car.rear_overhang}) {
    *length *= scale;
  }
  return car;
}

Problem AnyProblem(const PlannerEntry& entry, const Wildness& wildness) {
  const bool adversarial = wildness.adversarial;
  const double scale = adversarial ? *PowerOfTen(wildness.smallest, wildness.largest) : 1.0;
  Problem problem{.request = {}, .options = entry.defaults};
  PlanRequest& request = problem.request;
  // In half of the adversarial problems, the car has full size in a scene of any size. Otherwise,
  // the size of the car suits the scene.
  const double car = adversarial && OnceIn(2) ? scale : 1.0;
  request.vehicle = ScaledCar(car);
  const double speed = car * *Between(0.5, 10.0);
  request.speed = {speed, car * *Between(0.5, 3.0), car * *Between(0.5, 5.0)};
  request.seed = static_cast<std::uint64_t>(Pick(0, 100));
  const std::size_t fewest = std::max<std::size_t>(entry.min_waypoints, 2);
  const auto count = fewest + static_cast<std::size_t>(Pick(0, 2));
  request.waypoints =
      adversarial && !OnceIn(4) ? LatticeRoute(count, scale) : EasyRoute(count, scale);
  if (adversarial && OnceIn(20)) {
    request.waypoints.resize(request.waypoints.size() / 3);
  }
  SetStart(request, scale, adversarial);
  if (adversarial && entry.has_headings && OnceIn(2)) {
    for (std::size_t i = 0; i < request.waypoints.size(); ++i) {
      request.headings.push_back(AnyHeading());
    }
  }
  SetOptions(problem.options, car, adversarial);
  AddObstacles(request, scale, adversarial);
  if (adversarial && OnceIn(4)) {
    const double shift = *PowerOfTen(0, 6);
    problem = Moved(problem, {shift, -shift, 0.0});
  }
  TransformPath(problem.options,
                [&](const Path& path) { return Path(problem.request.start, path.segments()); });
  return problem;
}

Problem Mirrored(const Problem& problem) {
  Problem mirrored = problem;
  PlanRequest& request = mirrored.request;
  const auto mirror = [](Pose2& pose) { pose = {pose.x, -pose.y, -pose.yaw}; };
  for (Vec2& point : request.waypoints) {
    point.y() = -point.y();
  }
  for (double& heading : request.headings) {
    heading = -heading;
  }
  for (OrientedBox& box : request.obstacles) {
    mirror(box.center);
  }
  mirror(request.start);
  request.start_steering = -request.start_steering;
  if (auto* lane_change = mirrored.options.GetIf<LaneChangePlannerOptions>()) {
    lane_change->first = lane_change->first == Side::kLeft ? Side::kRight : Side::kLeft;
  }
  TransformPath(mirrored.options, [](const Path& path) {
    const Pose2 start = path.At(0.0).pose;
    std::vector<Segment> segments = path.segments();
    for (Segment& segment : segments) {
      segment.curvature = -segment.curvature;
      segment.sharpness = -segment.sharpness;
    }
    return Path({start.x, -start.y, -start.yaw}, segments);
  });
  if (auto* course = mirrored.options.GetIf<CourseOptions>()) {
    for (CoursePiece& piece : course->segments) {
      for (std::optional<double>* own :
           {&piece.curvature, &piece.curvature_from, &piece.curvature_to}) {
        if (*own) {
          **own = -**own;
        }
      }
    }
  }
  return mirrored;
}

Problem Moved(const Problem& problem, const Pose2& by) {
  Problem moved = problem;
  PlanRequest& request = moved.request;
  for (Vec2& point : request.waypoints) {
    point = ToWorld(by, point);
  }
  for (double& heading : request.headings) {
    heading += by.yaw;
  }
  for (OrientedBox& box : request.obstacles) {
    box.center = Compose(by, box.center);
  }
  request.start = Compose(by, request.start);
  TransformPath(moved.options, [&](const Path& path) {
    return Path(Compose(by, path.At(0.0).pose), path.segments());
  });
  return moved;
}

std::string ToText(const Problem& problem) {
  const PlanRequest& request = problem.request;
  std::string text = fmt::format(
      "car of {} m, speed {} acceleration {} deceleration {}, start {} {} {} at {} m/s with {} "
      "rad, seed {}",
      request.vehicle.length, request.speed.speed, request.speed.acceleration,
      request.speed.deceleration, request.start.x, request.start.y, request.start.yaw,
      request.start_speed, request.start_steering, request.seed);
  for (std::size_t i = 0; i < request.waypoints.size(); ++i) {
    text += fmt::format("\n  waypoint {} {}", request.waypoints[i].x(), request.waypoints[i].y());
    if (!request.headings.empty()) {
      text += fmt::format(" heading {}", request.headings[i]);
    }
  }
  for (const OrientedBox& box : request.obstacles) {
    text += fmt::format("\n  box {} {} {} of {} x {}", box.center.x, box.center.y, box.center.yaw,
                        box.length, box.width);
  }
  if (const auto* course = problem.options.GetIf<CourseOptions>()) {
    for (const CoursePiece& piece : course->segments) {
      text += fmt::format("\n  piece {} curvature {} to {}", piece.length,
                          piece.curvature.value_or(NAN), piece.curvature_to.value_or(NAN));
    }
  }
  return text;
}

}  // namespace properties
