#include "trackbed/planning/replan/along_route.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "src/planning/replan/passing.h"
#include "trackbed/core/error.h"
#include "trackbed/path/smooth_curvature.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/vehicle/state.h"
#include "trackbed/vehicle/steering_reach.h"
#include "trackbed/world/world.h"

// Plans motions along a route among obstacles, by polynomials in the Frenet frame or by a lattice.
// The planner first tries to stop at the goal, to proceed at the wanted speed, to pull out beside a
// moving leading obstacle, and to follow it. If all maneuvers at the wanted speed fail, the planner
// tries to proceed more slowly and then to stop behind an obstacle. The planner accepts a motion
// only if the car can brake to a stop after the motion. While braking, the car must keep clear of
// obstacles, stay within the steering limits and the track's edges, and stop before the goal.
// Moving obstacles are extrapolated at constant velocity.

namespace trackbed {
namespace {

/// Largest distance of a smooth stop, as a fraction of the product of speed and duration.
constexpr double kStopShare = 0.55;

/// Largest distance between a stop and the goal at which the goal counts as reached [m]; the
/// lattice planner uses the same value.
constexpr double kGoalTolerance = 0.05;

/// Returns the options of the planning method, with the safe distance and the horizon of the
/// settings, and with the speed factors `factors`.
FrenetOptions AdaptOptions(FrenetOptions options, const AlongSettings& settings,
                           const std::vector<double>& factors) {
  options.limits.safe_distance = settings.safe_distance;
  options.horizon = std::max(options.horizon, settings.look_ahead);
  options.speed_factors = factors;
  return options;
}

LatticeOptions AdaptOptions(LatticeOptions options, const AlongSettings& settings,
                            const std::vector<double>& factors) {
  options.limits.safe_distance = settings.safe_distance;
  options.speed_factors = factors;
  return options;
}

FrenetPlan Find(const Path& path, const FrenetRequest& request, const FrenetOptions& options) {
  return PlanFrenet(path, request, options);
}

FrenetPlan Find(const Path& path, const FrenetRequest& request, const LatticeOptions& options) {
  return PlanLattice(path, request, options);
}

AlongOptions WithFactors(const AlongOptions& options, const AlongSettings& settings,
                         const std::vector<double>& factors) {
  return std::visit(
      [&](const auto& own) -> AlongOptions { return AdaptOptions(own, settings, factors); },
      options);
}

/// Returns the longest distance over which the planning method can plan a stop [m].
double StopReach(const FrenetOptions& options, double speed) {
  const auto longest = std::max_element(options.end_times.begin(), options.end_times.end());
  return longest == options.end_times.end() ? 0.0 : kStopShare * speed * *longest;
}

double StopReach(const LatticeOptions& options, double) {
  return options.layers * options.spacing;
}

const FrenetLimits& MotionLimits(const AlongOptions& options) {
  return std::visit([](const auto& own) -> const FrenetLimits& { return own.limits; }, options);
}

const std::vector<double>& SpeedFactors(const AlongOptions& options) {
  return std::visit(
      [](const auto& own) -> const auto& { return own.speed_factors; }, options);
}

class AlongRoute {
 public:
  AlongRoute(const RouteFrame& frame, const AlongRequest& request, const AlongSettings& settings,
             const AlongOptions& options)
      : frame_(frame), request_(request), settings_(settings), options_(options) {}

  AlongPlan Plan() {
    const double speed = std::max(request_.wanted, request_.start.s_rate);
    const double reach =
        std::visit([&](const auto& own) { return StopReach(own, speed); }, options_);
    const bool goal_in_reach = frame_.goal - request_.start.s <= reach;
    if (goal_in_reach && Try(StopAt{frame_.goal})) {
      AlongPlan plan = AcceptedPlan(ManeuverType::kProceed);
      // A motion that stops before an obstacle near the goal does not lead to the goal.
      plan.to_goal = std::abs(points_.back().frenet.s - frame_.goal) <= kGoalTolerance;
      return plan;
    }
    // Look farther ahead than the motions reach, to find the obstacles that the motions approach.
    const auto leader = LeaderIn(frame_.path, request_, settings_,
                                 request_.start.s + FrontOverAxle(request_.vehicle) +
                                     std::max(reach, speed * settings_.look_ahead));
    const std::vector<double>& all = SpeedFactors(options_);
    std::vector<double> falling = all;
    std::sort(falling.rbegin(), falling.rend());
    std::optional<AlongPlan> for_now;
    const auto on = [&](const std::vector<double>& factors) {
      if (!Try(KeepSpeed{request_.wanted}, factors)) {
        return false;
      }
      if (!leader || Passes(*leader)) {
        return true;
      }
      if (!for_now) {
        for_now = AcceptedPlan(ManeuverType::kApproach);
      }
      return false;
    };
    if (on({falling.front()})) {
      return AcceptedPlan(ManeuverType::kProceed);
    }
    if (leader && leader->speed >= kStandstillSpeed) {
      if (PullsOut(*leader)) {
        return AcceptedPlan(ManeuverType::kProceed);
      }
      const std::string why = why_;
      if (Try(FollowLeader{leader->rear, std::min(leader->speed, request_.wanted), settings_.gap,
                           settings_.time_gap})) {
        AlongPlan plan = AcceptedPlan(ManeuverType::kFollow);
        plan.why = why;
        return plan;
      }
    }
    if (on(all)) {
      return AcceptedPlan(ManeuverType::kProceed);
    }
    for (auto factor = falling.begin() + 1; factor != falling.end(); ++factor) {
      if (on({*factor})) {
        return AcceptedPlan(ManeuverType::kProceed);
      }
    }
    if (request_.start.d != 0.0 && KeepsOffset(all) && (!leader || Passes(*leader))) {
      return AcceptedPlan(ManeuverType::kProceed);
    }
    if (leader && leader->speed < kStandstillSpeed &&
        Try(StopAt{leader->rear - FrontOverAxle(request_.vehicle) - settings_.gap})) {
      return AcceptedPlan(ManeuverType::kStop);
    }
    return for_now ? *for_now : AlongPlan{.kind = ManeuverType::kNone, .found = found_};
  }

 private:
  /// Finds a motion to the goal state. Accepts a motion only if the car can brake to a stop after
  /// it without hitting obstacles and within the steering limits. Rejects motions that pass the
  /// goal of the route before the car has braked to a stop. Also rejects motions that stop beside
  /// the route, because the car could not return to the route.
  bool Try(const FrenetGoal& goal, const std::vector<double>& factors = {1.0}) {
    return TryWith(goal, WithFactors(options_, settings_, factors));
  }

  bool TryWith(const FrenetGoal& goal, const AlongOptions& options) {
    passes_ = false;
    const FrenetRequest request{.vehicle = request_.vehicle,
                                .speed = request_.speed,
                                .road = settings_.road,
                                .start = request_.start,
                                .goal = goal,
                                .obstacles = request_.obstacles,
                                .edges = frame_.edges};
    found_ = std::visit([&](const auto& own) { return Find(frame_.path, request, own); }, options);
    if (!found_.ok()) {
      return false;
    }
    const FrenetState end = found_.motion.At(found_.motion.duration());
    if (std::holds_alternative<StopAt>(goal) && end.s_rate > kAtRestSpeed) {
      return false;  // the lattice does not extend as far as the stop
    }
    return BrakesAfter(end, end.d) || (frame_.edges && end.d != 0.0 && BrakesAfter(end, 0.0));
  }

  /// Returns whether the car can brake to a stop after the motion while moving laterally to
  /// `offset`.
  bool BrakesAfter(const FrenetState& end, double offset) {
    points_ = WithBraking(end, offset);
    return EndsBeforeGoal(points_.back().frenet) && BrakingIsClear() && BrakingIsDrivable() &&
           BrakingIsOnTrack();
  }

  /// Returns whether a car that stands at `stop` could return to the route before its goal, by two
  /// opposite turns at the steering limit.
  [[nodiscard]] bool EndsBeforeGoal(const FrenetState& stop) const {
    const VehicleParams& car = request_.vehicle;
    const double radius = car.min_turning_radius();
    const double offset = std::max(std::abs(stop.d) - kGoalTolerance, 0.0);
    const double back = std::sqrt(offset * std::max(4.0 * radius - offset, 0.0));
    return stop.s + back <= frame_.goal + kGoalTolerance;
  }

  [[nodiscard]] std::vector<TrajectoryPoint> WithBraking(const FrenetState& end,
                                                         double offset) const {
    FrenetMotion motion = found_.motion;
    if (end.s_rate > 0.0) {
      // From the final speed end.s_rate, a car with the deceleration a stops after the time
      // end.s_rate/a and the distance end.s_rate^2/(2 a).
      const double braking = request_.speed.deceleration;
      const double distance = 0.5 * end.s_rate * end.s_rate / braking;
      motion.pieces.push_back(
          {end.s_rate / braking, Polynomial{{end.s, end.s_rate, -0.5 * braking}},
           offset == end.d ? Polynomial{{end.d}} : QuinticBetween({end.d}, {offset}, distance),
           true});
    }
    const FrenetLimits& limits = MotionLimits(options_);
    auto points = SampleMotion(frame_.path, motion, limits.time_step, limits.spacing);
    // If the Frenet frame does not exist at some point before the stop, return the motion without
    // braking.
    return points ? std::move(*points) : found_.points;
  }

  [[nodiscard]] bool BrakingIsClear() const {
    const auto margins = ClearanceMargins(request_, settings_, points_.front().motion.pose);
    return !FirstTooNear(request_, margins, points_, found_.motion.duration());
  }

  /// Checks the steering limits while the car brakes, because the car may be too fast for a bend
  /// after the end of the motion.
  [[nodiscard]] bool BrakingIsDrivable() const {
    constexpr double kRounding = 1.0 + 1e-9;
    const VehicleParams& car = request_.vehicle;
    const double rate =
        kRounding * MotionLimits(options_).max_steering_rate_fraction * car.steering_rate;
    const double angle = kRounding * SteeringReach(car, 0.0);
    const double began = found_.motion.duration();
    const auto steering = [&](const TrajectoryPoint& point) {
      return SteeringForCurvature(car, point.motion.curvature);
    };
    for (std::size_t i = 1; i < points_.size(); ++i) {
      const TrajectoryPoint& before = points_[i - 1];
      const TrajectoryPoint& point = points_[i];
      if (before.t < began) {
        continue;
      }
      const double turned = std::abs(steering(point) - steering(before));
      if (std::abs(steering(point)) > angle || turned > rate * (point.t - before.t)) {
        return false;
      }
    }
    return true;
  }

  /// Checks that the footprint stays within the track's edges while braking. If the footprint
  /// starts beyond the track's edges, it may stay beyond the edges by the same distance.
  [[nodiscard]] bool BrakingIsOnTrack() const {
    if (!frame_.edges) {
      return true;
    }
    constexpr double kClearanceTolerance = 1e-3;  // [m]
    const auto beyond = [&](const TrajectoryPoint& point) {
      return ReachBeyond(*frame_.edges, request_.vehicle, frame_.path.At(point.frenet.s),
                         point.frenet);
    };
    const double most = std::max(0.0, beyond(points_.front())) + kClearanceTolerance;
    return std::all_of(points_.begin(), points_.end(), [&](const TrajectoryPoint& point) {
      return point.t <= found_.motion.duration() || beyond(point) <= most;
    });
  }

  /// Tries to keep the present offset, which may be the only one beside an obstacle on a narrow
  /// road.
  bool KeepsOffset(const std::vector<double>& factors) {
    AlongOptions options = WithFactors(options_, settings_, factors);
    std::visit([&](auto& own) { own.end_offsets = {request_.start.d}; }, options);
    return TryWith(KeepSpeed{request_.wanted}, options);
  }

  /// Tries to pull out beside a moving leader, at the desired speed or more slowly. Stores the
  /// reason in `why_` if no motion pulls out, or if the car could not finish passing.
  bool PullsOut(const Leader& leader) {
    const std::vector<double> offsets = PassingOffsets(request_, settings_, leader, options_);
    const std::vector<double> speeds = PassingSpeeds(request_, leader, options_);
    why_ = leader.speed >= request_.wanted
               ? fmt::format("it drives at {:.3g} m/s, no slower than the car's desired {:.3g} m/s",
                             leader.speed, request_.wanted)
           : offsets.empty() ? WhyNoRoom(request_, settings_, leader)
                             : std::string();
    if (!why_.empty()) {
      return false;
    }
    RejectionCounts rejected;
    for (const double speed : speeds) {
      for (const AlongOptions& options :
           PullOutOptions(WithFactors(options_, settings_, {1.0}), request_, offsets, speed)) {
        if (TryWith(KeepSpeed{request_.wanted}, options) && Passes(leader)) {
          return true;
        }
        for (std::size_t i = 0; i < rejected.counts.size(); ++i) {
          rejected.counts[i] += found_.rejected.counts[i];
        }
      }
    }
    why_ = why_.empty() ? WhyNoPullOut(rejected) : why_;
    return false;
  }

  /// Returns whether the motion passes the obstacle. To pass a moving obstacle, the car must also
  /// have room to complete the maneuver after the motion; if it has no room, stores the reason in
  /// `why_`.
  bool Passes(const Leader& leader) {
    if (!PassesObstacle(leader)) {
      return false;
    }
    if (leader.speed >= kStandstillSpeed) {
      const std::string why =
          WhyNotPast(frame_, request_, settings_, MotionLimits(options_), leader, found_.motion);
      if (!why.empty()) {
        why_ = why;
        return false;
      }
    }
    passes_ = true;
    return true;
  }

  /// Returns whether the motion ends beyond the obstacle, or beside the obstacle and laterally
  /// clear of it.
  [[nodiscard]] bool PassesObstacle(const Leader& leader) const {
    const FrenetState end = found_.motion.At(found_.motion.duration());
    return ClearsLaterally(request_, settings_, leader, end.d) ||
           end.s - request_.vehicle.rear_overhang >
               leader.rear + leader.speed * found_.motion.duration();
  }

  [[nodiscard]] AlongPlan AcceptedPlan(ManeuverType kind) const {
    return {.kind = kind, .found = found_, .points = points_, .passes = passes_};
  }

  const RouteFrame& frame_;
  const AlongRequest& request_;
  const AlongSettings& settings_;
  const AlongOptions& options_;
  FrenetPlan found_;  // Result of the last attempt to find a motion.
  // Points of the last motion and of the braking after the motion.
  std::vector<TrajectoryPoint> points_;
  bool passes_ = false;  // Whether the last motion passes an obstacle.
  std::string why_;      // Reason why the car does not pass its leader; empty without a leader.
};

}  // namespace

const std::vector<AlongEntry>& AlongMethods() {
  static const std::vector<AlongEntry> table{
      {"frenet", "minimum-cost polynomial motion in the route's Frenet frame", FrenetOptions{}},
      {"lattice", "minimum-cost path through a lattice of such motions", LatticeOptions{}},
  };
  return table;
}

const char* ToString(ManeuverType kind) {
  switch (kind) {
    case ManeuverType::kNone:
      return "none";
    case ManeuverType::kProceed:
      return "on";
    case ManeuverType::kFollow:
      return "follow";
    case ManeuverType::kApproach:
      return "approach";
    case ManeuverType::kStop:
      return "stop";
  }
  return "none";
}

RouteFrame MakeRouteFrame(const VehicleParams& vehicle, const Plan& route, const SpeedLimits& speed,
                          double beyond, double edge_distance) {
  const Path& path = route.reference.path;
  std::vector<Segment> segments = path.segments();
  segments.push_back({.length = beyond});
  const Path longer(path.At(0.0).pose, std::move(segments));
  if (route.laps.track) {
    return {.path = longer,
            .goal = path.length(),
            .edges = std::make_shared<const RoadEdges>(
                EdgesBeside(path, *route.laps.track, vehicle, edge_distance))};
  }
  // The smoothing window w [m] must be so long that the wheels can follow the curvature. The
  // longest window is needed where the curvature steps from 0 to k. There, the steering rate is at
  // most v L k/w with the wheelbase L. Smoothing with a window of length w increases the curvature
  // k of a bend by the fraction (k w)^2/24.
  constexpr double kSampleSpacing = 0.5;  // Spacing of the samples [m].
  double window = 0.1;                    // Smoothing window [m].
  for (const PathPoint& point : path.Sample(kSampleSpacing)) {
    double v = speed.speed;
    for (const SpeedCap& cap : route.caps) {
      if (cap.from <= point.s && point.s <= cap.to) {
        v = std::min(v, cap.speed);
      }
    }
    const double curvature = std::abs(point.curvature);
    const double turning = v * vehicle.wheelbase * curvature / vehicle.steering_rate;
    window = std::max(window, turning * (1.0 + std::pow(curvature * turning, 2) / 24.0));
  }
  RouteFrame frame{SmoothCurvature(longer, window)};
  const double length = frame.path.length();
  frame.goal =
      frame.path.Project(path.At(path.length()).pose, {length - beyond - window, length}).s;
  return frame;
}

AlongPlan PlanAlongRoute(const RouteFrame& frame, const AlongRequest& request,
                         const AlongSettings& settings, const AlongOptions& options) {
  TRACKBED_CHECK(request.wanted >= 0.0 && request.wanted <= request.speed.speed &&
                     settings.gap >= 0.0 && settings.time_gap >= 0.0,
                 "speed {} of {}, gaps {} and {}", request.wanted, request.speed.speed,
                 settings.gap, settings.time_gap);
  TRACKBED_CHECK(!SpeedFactors(options).empty(), "no speed factors");
  AlongOptions enough = options;
  AddTimesToShift(enough, request.vehicle, settings.road, request.wanted);
  return AlongRoute(frame, request, settings, enough).Plan();
}

void Visit(DiagnosticsVisitor& out, const AlongPlan& along) {
  out.Text("kind", ToString(along.kind));
  out.Text("status", ToString(along.found.status));
  out.Integer("candidates", along.found.candidates);
  out.Integer("checked", along.found.checked);
  out.Text("rejected", along.found.rejected.ToString());
  if (along.ok()) {
    const FrenetState end = along.found.motion.At(along.found.motion.duration());
    out.Number("cost", along.found.cost);
    out.Number("duration_s", along.found.motion.duration());
    out.Number("end_offset_m", end.d);
    out.Number("end_speed_mps", end.s_rate);
  }
  if (!along.why.empty()) {
    out.Text("why", along.why);
  }
}

}  // namespace trackbed
