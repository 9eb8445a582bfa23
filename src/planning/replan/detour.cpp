#include "trackbed/planning/replan/detour.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "trackbed/core/error.h"
#include "trackbed/planning/common/course_schedule.h"
#include "trackbed/planning/common/curvature_steps.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/common/plan_stretch.h"
#include "trackbed/planning/common/planner.h"
#include "trackbed/planning/registry/planners.h"
#include "trackbed/world/world.h"

namespace trackbed {
namespace {

/// Between the points at which ways are looked at [m].
constexpr double kLook = 0.1;
/// Less curvature than this is straight [1/m].
constexpr double kStraight = 1e-4;
/// Lengths that a path with corners goes straight on first and last [m]: long ones leave room for
/// gentle corners, short ones fit before what is near.
constexpr std::array<double, 3> kStraightOn{10.0, 6.0, 3.0};
/// Between the places at which to come back [m], and how many of them.
constexpr double kBackStep = 5.0;
constexpr int kBacks = 3;
/// For how long the route is straight after the way has come back, at the mission's speed [s].
constexpr double kSettle = 2.0;
/// What a route keeps of the driven path, at least [m] and [s].
constexpr double kLead = 0.5;
constexpr double kLeadTime = 0.5;

bool IsStraight(const Path& path, double s) {
  const PathPoint at = path.At(s);
  return std::abs(at.curvature) < kStraight && std::abs(at.sharpness) < kStraight;
}

/// The first station at or beyond `from` from which the path is straight for `length`, or to its
/// end.
std::optional<double> StraightFrom(const Path& path, double from, double length) {
  double straight = 0.0;
  for (double s = from; s <= path.length(); s += kLook) {
    straight = IsStraight(path, s) ? straight + kLook : 0.0;
    if (straight > length) {
      return s - (straight - kLook);
    }
  }
  const double left = path.length() - straight;
  return straight > 0.0 ? std::optional(std::max(from, left)) : std::nullopt;
}

/// What a joint between two pieces of path takes of the speed, as CapsOfSteps does it.
std::vector<SpeedCap> CapOfJoint(const VehicleParams& vehicle, const Path& path, double s,
                                 double speed) {
  const double before = path.At(s - kLook).curvature;
  const double after = path.At(s + kLook).curvature;
  const double joint = StepSpeed(vehicle, before, after);
  if (joint >= speed) {
    return {};
  }
  const double turned =
      std::abs(SteeringForCurvature(vehicle, after) - SteeringForCurvature(vehicle, before));
  const double half = 0.5 * joint * turned / vehicle.steering_rate;
  return {{std::max(s - half, 0.0), std::min(s + half, path.length()), joint}};
}

std::vector<Vec2> SamplePoints(const Path& path) {
  constexpr double kSpacing = 0.25;  // [m]
  std::vector<Vec2> points;
  for (const PathPoint& point : path.Sample(kSpacing)) {
    points.push_back(point.pose.position());
  }
  return points;
}

/// Whether a car at `speed` can come down to every cap in time.
bool CanSlowDown(const std::vector<SpeedCap>& caps, double speed, const SpeedLimits& limits) {
  return std::all_of(caps.begin(), caps.end(), [&](const SpeedCap& cap) {
    const double slower = speed * speed - 2.0 * limits.deceleration * std::max(cap.from, 0.0);
    return slower <= cap.speed * cap.speed + 1e-9;
  });
}

class DetourSearch {
 public:
  DetourSearch(const DetourRequest& request, const PlannerOptions& planner,
               const DetourChoice& choice)
      : request_(request), planner_(planner), choice_(choice), entry_(PlannerFor(planner)) {}

  Detour Run() {
    Detour detour;
    detour.current = Score(WayAsItIs());
    detour.best.total = std::numeric_limits<double>::infinity();
    if (!detour.current.collides) {
      detour.why = "no static obstacle blocks the path";
      return detour;
    }
    const Path& path = request_.driven.reference.path;
    const double lead = request_.station + kLead + kLeadTime * request_.station_speed;
    // At once, or once the car could have stopped.
    const double braking =
        0.5 * request_.station_speed * request_.station_speed / request_.speed.deceleration;
    std::vector<double> leaves;
    for (const double from : {lead, lead + braking}) {
      const auto leave = StraightFrom(path, from, 0.0);
      if (leave && (leaves.empty() || *leave > leaves.back())) {
        leaves.push_back(*leave);
      }
    }
    if (leaves.empty()) {
      detour.why = "the path ahead has no straight segment for leaving it";
      return detour;
    }
    const std::vector<double> backs = Backs();
    const int attempts = entry_.is_random ? choice_.attempts : 1;
    for (int attempt = 0; attempt < attempts; ++attempt) {
      for (const double leave : leaves) {
        for (const double back : backs) {
          Try(leave, back, static_cast<std::uint64_t>(attempt), detour);
        }
      }
      if (!detour.route) {
        break;  // what finds nothing anywhere will not do so with another seed
      }
    }
    if (detour.route && !IsBetter(detour.best, detour.current)) {
      detour.route.reset();
      detour.why = fmt::format("the best detour scores {:.4g} m, the current path {:.4g} m",
                               detour.best.total, detour.current.total);
    }
    return detour;
  }

 private:
  /// A plan from the car on, and between which of its stations it is the planner's.
  struct JoinedPlan {
    Plan plan;
    Stations replaced;  ///< [m]
  };

  /// Asks the planner for a path between two stations, and keeps it if it is the best so far.
  void Try(double leave, double back, std::uint64_t attempt, Detour& detour) const {
    for (const double straight_on : kStraightOn) {
      ++detour.tried;
      std::optional<JoinedPlan> found = Between(leave, back, straight_on, attempt, detour.why);
      if (found) {
        const PathScore score = Score(SamplePoints(found->plan.reference.path));
        if (IsBetter(score, detour.best)) {
          detour.best = score;
          detour.route = std::move(found->plan);
          detour.replaced = found->replaced;
        }
        return;
      }
      if (entry_.has_headings) {
        return;  // those do not go straight on
      }
    }
  }

  [[nodiscard]] std::vector<Vec2> WayAsItIs() const {
    const Path& path = request_.route.reference.path;
    return SamplePoints(Path(path.At(request_.route_station).pose,
                             path.Cut({request_.route_station, path.length()})));
  }

  /// A path from the car on. Its center line keeps as far from what does not block it as the
  /// footprint's sides do.
  [[nodiscard]] PathScore Score(const std::vector<Vec2>& way) const {
    const VehicleParams& car = request_.vehicle;
    const double inflation =
        std::min(0.5 * car.width, car.rear_overhang) + 0.9 * request_.safe_distance;
    return ScorePath(way, way.front(), request_.obstacles, inflation,
                     {.wind = request_.wind,
                      .time = request_.time,
                      .speed = request_.speed.speed,
                      .weight = choice_.wind_weight},
                     choice_.comparator);
  }

  /// Where to come back to the route: straight, and with some of it left.
  [[nodiscard]] std::vector<double> Backs() const {
    const Path& path = request_.route.reference.path;
    const std::vector<Stations> blocked = BlockedStretches(
        request_.vehicle, path, request_.route_station, request_.obstacles, request_.safe_distance);
    const double behind = blocked.empty() ? request_.route_station : blocked.back().to;
    std::vector<double> backs;
    double from = behind + kStraightOn.front();
    while (static_cast<int>(backs.size()) < kBacks) {
      const auto back = StraightFrom(path, from, kSettle * request_.speed.speed);
      if (!back) {
        break;
      }
      backs.push_back(*back);
      from = *back + kBackStep;
    }
    // At the end only where there is nowhere else: it would leave out what the mission leads
    // through.
    if (backs.empty() && behind < path.length() - 2.0 * kLook) {
      backs.push_back(path.length());
    }
    return backs;
  }

  std::optional<JoinedPlan> Between(double leave, double back, double straight_on,
                                    std::uint64_t attempt, std::string& why) const {
    const Path& driven = request_.driven.reference.path;
    const Path& route = request_.route.reference.path;
    const Pose2 from = driven.At(leave).pose;
    const Pose2 to = route.At(back).pose;
    if ((to.position() - from.position()).norm() < kLead) {
      why = "it would leave the path where it returns to it";
      return std::nullopt;
    }
    const double speed = std::min(request_.station_speed, request_.speed.speed);
    PlanRequest request{.vehicle = request_.vehicle,
                        .waypoints = {from.position()},
                        .obstacles = request_.obstacles,
                        .start = from,
                        .start_speed = speed,
                        .speed = request_.speed,
                        .seed = request_.seed + attempt};
    if (entry_.has_headings) {
      request.waypoints.push_back(to.position());
      request.headings = {from.yaw, to.yaw};
    } else {
      const Vec2 on = from.position() + straight_on * Direction(from.yaw);
      const Vec2 before = to.position() - straight_on * Direction(to.yaw);
      request.waypoints.insert(request.waypoints.end(), {on, before, to.position()});
    }
    const Plan way = MakePlan(request, planner_);
    if (!way.ok() || !way.partial.empty() || !way.stops.empty()) {
      const std::string own =
          way.stops.empty() ? way.reason + way.partial : std::string("it would require a stop");
      why = why.empty() ? own : why;
      return std::nullopt;
    }
    const PathPoint first = way.reference.path.At(0.0);
    const PathPoint last = way.reference.path.At(way.reference.path.length());
    constexpr double kAligned = 1e-6;  // [rad]
    if (std::abs(std::remainder(first.pose.yaw - from.yaw, 2.0 * M_PI)) > kAligned ||
        std::abs(std::remainder(last.pose.yaw - to.yaw, 2.0 * M_PI)) > kAligned) {
      why = "no room for straight segments at its start and end";
      return std::nullopt;
    }
    return Joined(leave, way, back, why);
  }

  /// The driven path up to `leave`, the detour, the route from `back` on.
  std::optional<JoinedPlan> Joined(double leave, const Plan& way, double back,
                                   std::string& why) const {
    const Path& driven = request_.driven.reference.path;
    const Path& route = request_.route.reference.path;
    const double lead = leave - request_.station;
    const double beyond = lead + way.reference.path.length();
    std::vector<Segment> segments = SegmentsBetween(driven, {request_.station, leave});
    Append(segments, way.reference.path.segments());
    Append(segments, route.Cut({back, route.length()}));
    Plan plan;
    plan.caps = Moved(request_.driven.caps, {request_.station, leave}, -request_.station);
    Append(plan.caps, Moved(way.caps, {0.0, way.reference.path.length()}, lead));
    Append(plan.caps, Moved(request_.route.caps, {back, route.length()}, beyond - back));
    plan.reference.path = Path(driven.At(request_.station).pose, std::move(segments));
    const Path& path = plan.reference.path;
    for (const double joint : {lead, beyond}) {
      Append(plan.caps, CapOfJoint(request_.vehicle, path, joint, request_.speed.speed));
    }
    if (!CanSlowDown(plan.caps, request_.station_speed, request_.speed)) {
      why = "the car is too fast for the first corner";
      return std::nullopt;
    }
    if (!BlockedStretches(request_.vehicle, path, 0.0, request_.obstacles,
                          0.9 * request_.safe_distance)
             .empty()) {
      why = "an obstacle is too close to the junction of the paths";
      return std::nullopt;
    }
    plan.reference.speed =
        StopAtEnd(path.length(), request_.station_speed, request_.speed, plan.caps);
    plan.schedule =
        CourseSchedule(request_.vehicle, path.segments(), request_.speed.speed, plan.caps);
    plan.schedule_speed = plan.reference.speed;
    plan.goal = request_.route.goal;
    plan.tree = way.tree;
    return JoinedPlan{std::move(plan), {lead, beyond}};
  }

  const DetourRequest& request_;
  const PlannerOptions& planner_;
  const DetourChoice& choice_;
  const PlannerEntry& entry_;
};

}  // namespace

std::vector<Stations> BlockedStretches(const VehicleParams& vehicle, const Path& path,
                                       double station, const std::vector<OrientedBox>& obstacles,
                                       double distance) {
  std::vector<Stations> stretches;
  bool blocked = false;
  for (double s = station; s <= path.length(); s += kLook) {
    const OrientedBox footprint = FootprintAt(vehicle, path.At(s).pose);
    const bool here = std::any_of(
        obstacles.begin(), obstacles.end(),
        [&](const OrientedBox& obstacle) { return Separation(footprint, obstacle) < distance; });
    if (here && !blocked) {
      stretches.push_back({s, s});
    }
    if (here) {
      stretches.back().to = s;
    }
    blocked = here;
  }
  return stretches;
}

Detour PlanDetour(const DetourRequest& request, const PlannerOptions& planner,
                  const DetourChoice& choice) {
  const PlannerEntry& entry = PlannerFor(planner);
  TRACKBED_CHECK(entry.keeps_clear && !MayGoBackwards(planner) && choice.attempts >= 1 &&
                     request.driven.ok() && request.route.ok(),
                 "{} attempts of a detour by {}", choice.attempts, entry.name);
  return DetourSearch(request, planner, choice).Run();
}

void Visit(DiagnosticsVisitor& out, const DetourFindings& own) {
  out.Text("planner", own.planner);
  out.Integer("tried", own.tried);
  out.Section("current", own.current);
  if (own.best) {
    out.Section("best", *own.best);
  }
  if (own.replaced) {
    out.Number("leave_s_m", own.replaced->from);
    out.Number("return_s_m", own.replaced->to);
  } else {
    out.Text("why", own.why);
  }
}

}  // namespace trackbed
