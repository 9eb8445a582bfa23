#include "trackbed/planning/avoidance/avoidance.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "src/planning/avoidance/avoidance_stretch.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/common/open_loop.h"
#include "trackbed/planning/common/plan_stretch.h"
#include "trackbed/world/world.h"

namespace trackbed {
namespace {

using avoidance::Conflict;
using avoidance::CurveCheck;
using avoidance::FirstConflict;
using avoidance::kLook;
using avoidance::Stretch;
using avoidance::StretchSearch;
using nlohmann::json;

/// Of the curve's pieces of path [m].
constexpr double kCurveSpacing = 0.1;

json Point(const Vec2& p) {
  return json::array({p.x(), p.y()});
}

class AroundObstacles {
 public:
  AroundObstacles(const AvoidanceRequest& request, const BezierAvoidanceOptions& options)
      : request_(request), options_(options), plan_(request.plan) {}

  Plan Run() {
    double from = request_.station;
    if (request_.car) {
      StartAtCar();
      from = 0.0;
    }
    plan_.blocked.clear();
    for (std::size_t round = 0;; ++round) {
      const std::optional<Conflict> conflict =
          FirstConflict(request_, options_, plan_.reference.path, from);
      if (!conflict) {
        break;
      }
      // Each round leaves one obstacle behind, unless the curves around two meet each other's.
      StretchSearch found{std::nullopt, "the curves around others lead back to it"};
      if (round < 2 * request_.obstacles.size()) {
        found = FindStretch(request_, options_, plan_, *conflict, from);
      }
      if (!found.stretch) {
        StopBefore(*conflict, from, found.why);
        break;
      }
      from = Replace(*found.stretch);
    }
    if (plan_.diagnostics.contains("avoid") || !plan_.blocked.empty()) {
      TellOpenLoop();
    }
    return plan_;
  }

 private:
  [[nodiscard]] const Path& path() const { return plan_.reference.path; }

  /// What lies ahead of the car, in stations from there.
  void StartAtCar() {
    plan_ = RestOf(plan_, request_.station, request_.station_speed, request_.speed);
    plan_.diagnostics.erase("avoid");  // told of stations that no longer count
    plan_.tree.clear();
    MoveTurns({-1.0, -1.0}, -request_.station);
  }

  void SetSpeed(double start_speed, double open_loop_end) {
    plan_.reference.speed = StopAtEnd(path().length(), start_speed, request_.speed, plan_.caps);
    plan_.schedule_speed = StopAtEnd(open_loop_end, start_speed, request_.speed, plan_.caps);
  }

  /// Puts the curve in place of the plan between its stations; where it is back on the old path.
  double Replace(const Stretch& stretch) {
    const Path old = path();
    const double leave = stretch.leave;
    const auto points = stretch.repair.curve.Points(kCurveSpacing, stretch.problem.start.pose.yaw);
    const double back = leave + points.back().s;
    const double shift = back - stretch.back;  // of what follows
    const Stations before{0.0, leave};
    const Stations after{stretch.back, std::numeric_limits<double>::infinity()};

    std::vector<Segment> segments = old.Cut(before);
    Append(segments, SegmentsThrough(points));
    Append(segments, old.Cut(after));
    // A curve from the car starts where the car is, not where it should be.
    const Pose2 start = leave > 0.0 ? old.At(0.0).pose : stretch.problem.start.pose;
    plan_.reference.path = Path(start, std::move(segments));

    std::vector<SteeringSchedule::Knot> knots = Moved(plan_.schedule, {-1.0, leave}, 0.0);
    for (const CurvePoint& point : points) {
      knots.push_back({leave + point.s, SteeringForCurvature(request_.vehicle, point.curvature)});
    }
    Append(knots, Moved(plan_.schedule, after, shift));
    plan_.schedule = SteeringSchedule::Through(std::move(knots));

    std::vector<SpeedCap> caps = Moved(plan_.caps, before, 0.0);
    if (stretch.problem.speed < request_.speed.speed) {
      caps.push_back({leave, back, stretch.problem.speed});
    }
    Append(caps, Moved(plan_.caps, after, shift));
    plan_.caps = caps;

    std::vector<LoneTurn> turns = Moved(plan_.turns, before, 0.0);
    Append(turns, Moved(plan_.turns, after, shift));
    plan_.turns = turns;

    SetSpeed(plan_.reference.speed.SpeedAt(0.0), plan_.schedule_speed.knots().back().s + shift);
    MoveTurns({leave, stretch.back}, shift);
    Tell(stretch, leave, back);
    return back;
  }

  /// What the method before told of its turns, in stations of the new plan.
  void MoveTurns(Stations replaced, double shift) {
    if (!plan_.diagnostics.contains("turns")) {
      return;
    }
    for (json& turn : plan_.diagnostics["turns"]) {
      if (turn["steer_start_m"].get<double>() >= replaced.to) {
        for (const char* key : {"arc_start_s_m", "steer_start_m", "steer_return_m"}) {
          turn[key] = turn[key].get<double>() + shift;
        }
      } else if (turn["steer_return_m"].get<double>() > replaced.from) {
        turn["note"] = "led around an obstacle here";
      }
    }
  }

  void TellOpenLoop() {
    double speed = request_.speed.speed;
    for (const SpeedCap& cap : plan_.caps) {
      speed = std::min(speed, cap.speed);
    }
    const double stop = plan_.schedule_speed.knots().back().s;
    plan_.diagnostics["stop_distance_m"] = stop;
    plan_.diagnostics["open_loop"] =
        ToJson(DriveOpenLoop(request_.vehicle, path(), plan_.schedule, stop));
  }

  void Tell(const Stretch& stretch, double leave, double back) {
    const CurveCheck& check = stretch.repair.check;
    const Vec2 obstacle = stretch.obstacle.centre.position();
    json entry{{"method", "bezier"},
               {"obstacle_m", Point(obstacle)},
               {"ring", ToString(stretch.ring)},
               {"leave_s_m", leave},
               {"return_s_m", back},
               {"speed_mps", stretch.problem.speed},
               {"length_m", check.length},
               {"clearance_m", check.clearance},
               {"steering_max_rad", check.steering},
               {"steering_rate_max_radps", check.steering_rate},
               {"lateral_acceleration_max_mps2", check.lateral_acceleration},
               {"curves_tried", stretch.tried}};
    for (const Vec2& point : stretch.repair.curve.control_points()) {
      entry["control_points_m"].push_back(Point(point));
    }
    entry["rrt_star"] = {{"status", ToString(stretch.tree.status)},
                         {"iterations", stretch.tree.iterations},
                         {"nodes", stretch.tree.nodes.size()}};
    if (stretch.tree.ok()) {
      entry["rrt_star"]["cost_m"] = stretch.tree.cost;
      for (const Vec2& point : stretch.tree.path) {
        entry["rrt_star"]["path_m"].push_back(Point(point));
      }
    }
    const std::size_t first = plan_.tree.size();
    for (TreeNode node : stretch.tree.nodes) {
      node.parent += first;
      plan_.tree.push_back(node);
    }
    entry["search"] = {{"method", SearchFor(options_.search.method).name},
                       {"evaluations", stretch.repair.search.evaluations},
                       {"objective", stretch.repair.search.value}};
    // The check of listing F.2, for comparison: a single point of the path, two meters before
    // it is beside the obstacle, against a corner; ours is the nearest one.
    const double share = (stretch.beside - stretch.leave) / (stretch.back - stretch.leave);
    const double beside = stretch.repair.check.length * share;
    const Vec2 point = path().At(leave + std::max(beside - 2.0, 0.0)).pose.position();
    double corner = std::numeric_limits<double>::infinity();
    for (const Vec2& p : stretch.obstacle.Corners()) {
      corner = std::min(corner, (p - point).norm());
    }
    entry["one_point_check"] = {
        {"distance_m", corner},
        {"passed", corner >= options_.safe_distance + 0.5 * request_.vehicle.width}};
    // Driven open loop by the curve's own steering, from its own start.
    const PathPoint start = path().At(leave);
    const PathPoint end = path().At(back);
    const std::vector<SteeringSchedule::Knot> own =
        Moved(plan_.schedule, {leave - 1e-6, back + 1e-6}, -leave);
    const KinematicState driven =
        RollOut(request_.vehicle,
                {.pose = start.pose,
                 .speed = stretch.problem.speed,
                 .steering = SteeringForCurvature(request_.vehicle, start.curvature)},
                SteeringSchedule::Through(own), back - leave, kCurveSpacing);
    entry["open_loop"] = {
        {"end_distance_m", (driven.pose.position() - end.pose.position()).norm()},
        {"end_heading_error_rad", AngleDifference(driven.pose.yaw, end.pose.yaw)}};
    plan_.diagnostics["avoid"].push_back(entry);
  }

  /// Ends the plan where the obstacle comes closer than SD, or as soon as the car can stop.
  void StopBefore(const Conflict& conflict, double from, const std::string& why) {
    const double start_speed = plan_.reference.speed.SpeedAt(0.0);
    const double speed = plan_.reference.speed.SpeedAt(from);
    // A car that is too close already brakes twice as hard as it otherwise would.
    const double shortest = std::max(speed * speed / (4.0 * request_.speed.deceleration), kLook);
    const Stations before{0.0, std::max(conflict.from - kLook, from + shortest)};
    plan_.reference.path = Path(path().At(0.0).pose, path().Cut(before));
    plan_.caps = Moved(plan_.caps, before, 0.0);
    plan_.turns = Moved(plan_.turns, before, 0.0);
    SetSpeed(start_speed, path().length());
    const Vec2 obstacle = conflict.obstacle.centre.position();
    plan_.blocked = fmt::format("stops before the obstacle at ({:.4g}, {:.4g}): {}", obstacle.x(),
                                obstacle.y(), why);
    plan_.diagnostics["blocked"] = plan_.blocked;
  }

  const AvoidanceRequest& request_;
  const BezierAvoidanceOptions& options_;
  Plan plan_;
};

Plan PlanAroundWith(const BezierAvoidanceOptions& options, const AvoidanceRequest& request) {
  TRACKBED_CHECK(options.safe_distance >= 0.0 && options.delay >= 0.0 && options.min_speed > 0.0 &&
                     options.max_lateral_acceleration > 0.0 && options.steering_rate_share > 0.0 &&
                     options.steering_rate_share <= 1.0 && options.comfortable_rate_share > 0.0,
                 "safe distance {}, delay {}, minimum speed {}, lateral acceleration {}, share {}",
                 options.safe_distance, options.delay, options.min_speed,
                 options.max_lateral_acceleration, options.steering_rate_share);
  return AroundObstacles(request, options).Run();
}

}  // namespace

const char* ToString(Ring ring) {
  return ring == Ring::kInner ? "inner" : "outer";
}

const std::vector<AvoiderEntry>& Avoiders() {
  static const std::vector<AvoiderEntry> table{
      {"bezier", "RRT* and a degree-7 Bezier curve, repaired until it can be driven (F.2)",
       BezierAvoidanceOptions{}},
  };
  return table;
}

bool IsInTheWay(const VehicleParams& vehicle, const Path& path, double station,
                const OrientedBox& obstacle, double distance) {
  for (double s = station; s <= path.length(); s += kLook) {
    if (Separation(OutlineAt(vehicle, path.At(s).pose), obstacle) < distance) {
      return true;
    }
  }
  return false;
}

Plan PlanAround(const AvoidanceRequest& request, const AvoiderOptions& options) {
  TRACKBED_CHECK(request.plan.ok(), "a plan with status {}", ToString(request.plan.status));
  return std::visit([&](const auto& own) { return PlanAroundWith(own, request); }, options);
}

void Visit(KeyVisitor& keys, BezierAvoidanceOptions& options) {
  keys.Field({"safe_distance", "m", "of the car's outline from obstacles"}, options.safe_distance,
             Need::kOptional, kNotNegative);
  keys.Field({"delay", "s", "from learning of an obstacle to the new plan"}, options.delay,
             Need::kOptional, kNotNegative);
  static const EnumNames<RingChoice> rings{
      {RingChoice::kAuto, "auto"}, {RingChoice::kInner, "inner"}, {RingChoice::kOuter, "outer"}};
  keys.Field(
      {"ring", "",
       "on which side to pass: toward the turn's center (left on a straight), away from it, or "
       "as RRT* finds it shorter"},
      options.ring, Need::kOptional, rings);
  keys.Field({"min_speed", "m/s", "no slower than this to get past"}, options.min_speed,
             Need::kOptional, kPositive);
  keys.Field({"max_lateral_acceleration", "m/s^2", "of the curve"},
             options.max_lateral_acceleration, Need::kOptional, kPositive);
  keys.Field({"steering_rate_share", "", "of the car's steering rate that the curve may ask for"},
             options.steering_rate_share, Need::kOptional, Range{.max = 1.0, .above = 0.0});
  keys.Field({"comfortable_rate_share", "", "curves that ask for no more are preferred"},
             options.comfortable_rate_share, Need::kOptional, Range{.max = 1.0, .above = 0.0});
  keys.Field({"rrt_iterations", "", "samples of RRT*"}, options.rrt_iterations, Need::kOptional,
             Range{.min = 0, .max = 1e6});
  keys.Field({"rrt_step", "m", "from a node toward a sample at most"}, options.rrt_step,
             Need::kOptional, kPositive);
  keys.Section({"search", "", "how the curve's control points are moved"}, options.search);
}

}  // namespace trackbed
