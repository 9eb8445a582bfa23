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

// Searches for a detour around static obstacles by any planner that keeps clear of obstacles. The
// detour leaves the driven path on a straight, either as early as possible or after the car's
// braking distance. The detour returns to the route at one of up to three places on straights
// beyond the last blocked stretch. If the planner ignores headings, the first and the last leg of
// the detour are straight and 10, 6 or 3 m long. The comparator selects the best path. The car
// takes the selected path only if the comparator rates it better than the current path.

namespace trackbed {
namespace {

/// Spacing of collision checks along paths [m].
constexpr double kPathCheckSpacing = 0.1;
/// Largest curvature that counts as straight [1/m].
constexpr double kStraight = 1e-4;
/// Lengths that the search tries for the first and the last straight of a path with corners [m].
/// Long straights leave room for gentle corners; short straights fit before nearby obstacles.
constexpr std::array<double, 3> kStraightLengths{10.0, 6.0, 3.0};
/// Spacing of the places at which the detour may return to the route [m], and the largest number of
/// these places.
constexpr double kReturnSpacing = 5.0;
constexpr int kReturnPoints = 3;
/// Minimum duration of straight driving at the mission's speed after the return to the route [s].
constexpr double kSettlingTime = 2.0;
/// Minimum distance between the car and the start of the detour on the driven path: kMinLead [m]
/// plus the distance driven in kLeadTime [s].
constexpr double kMinLead = 0.5;
constexpr double kLeadTime = 0.5;

bool IsStraight(const Path& path, double s) {
  const PathPoint at = path.At(s);
  return std::abs(at.curvature) < kStraight && std::abs(at.sharpness) < kStraight;
}

/// Returns the first station at or after `from` from which the path is straight over `length` [m]
/// or up to its end.
std::optional<double> StraightFrom(const Path& path, double from, double length) {
  double straight = 0.0;
  for (double s = from; s <= path.length(); s += kPathCheckSpacing) {
    straight = IsStraight(path, s) ? straight + kPathCheckSpacing : 0.0;
    if (straight > length) {
      return s - (straight - kPathCheckSpacing);
    }
  }
  const double left = path.length() - straight;
  return straight > 0.0 ? std::optional(std::max(from, left)) : std::nullopt;
}

/// Returns the speed cap at a joint between two path pieces, computed as in PlanSteps.
std::vector<SpeedCap> CapOfJoint(const VehicleParams& vehicle, const Path& path, double s,
                                 double speed) {
  const double before = path.At(s - kPathCheckSpacing).curvature;
  const double after = path.At(s + kPathCheckSpacing).curvature;
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

/// Returns whether a car at `speed` can slow down to every speed cap in time.
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
    detour.current = Score(CurrentPath());
    detour.best.total = std::numeric_limits<double>::infinity();
    if (!detour.current.collides) {
      detour.why = "no static obstacle blocks the path";
      return detour;
    }
    const Path& path = request_.driven.reference.path;
    const double lead = request_.station + kMinLead + kLeadTime * request_.station_speed;
    // Leave the driven path as early as possible, or after the braking distance.
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
      if (!detour.route || IsBudgetUsed(detour)) {
        break;  // further attempts with another random seed would not help
      }
    }
    if (!detour.route && IsBudgetUsed(detour)) {
      detour.why += fmt::format("; the search ended after {} random samples", detour.samples);
    }
    if (detour.route && !IsBetter(detour.best, detour.current)) {
      detour.route.reset();
      detour.why = fmt::format("the best detour scores {:.4g} m, the current path {:.4g} m",
                               detour.best.total, detour.current.total);
    }
    return detour;
  }

 private:
  /// A plan from the car to the end of the route, and the stations of the route that the detour
  /// replaces.
  struct JoinedPlan {
    FeasiblePlan plan;
    Stations replaced;  ///< [m]
  };

  /// Plans a detour from the station `leave` of the driven path to the station `back` of the route.
  /// Stores the detour if it is the best so far.
  void Try(double leave, double back, std::uint64_t attempt, Detour& detour) const {
    for (const double straight_on : kStraightLengths) {
      if (IsBudgetUsed(detour)) {
        return;
      }
      ++detour.tried;
      std::optional<JoinedPlan> found = Between(leave, back, straight_on, attempt, detour);
      if (found) {
        const PathScore score = Score(SamplePoints(found->plan->reference.path));
        if (IsBetter(score, detour.best)) {
          detour.best = score;
          detour.route = std::move(found->plan);
          detour.replaced = found->replaced;
        }
        return;
      }
      if (entry_.has_headings) {
        return;  // planners that choose headings need no straight start
      }
    }
  }

  static bool IsBudgetUsed(const Detour& detour) { return detour.samples >= kMaxDetourSamples; }

  [[nodiscard]] std::vector<Vec2> CurrentPath() const {
    const Path& path = request_.route.reference.path;
    return SamplePoints(Path(path.At(request_.route_station).pose,
                             path.Cut({request_.route_station, path.length()})));
  }

  /// Computes the comparator's score of a path that begins at the car. The distance that the path
  /// must keep from obstacles is the smaller of half the car's width and the rear overhang, plus
  /// 0.9 of the safe distance.
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

  /// Returns the stations on straights at which the detour may return to the route.
  [[nodiscard]] std::vector<double> Backs() const {
    const Path& path = request_.route.reference.path;
    const std::vector<Stations> blocked = BlockedStretches(
        request_.vehicle, path, request_.route_station, request_.obstacles, request_.safe_distance);
    const double behind = blocked.empty() ? request_.route_station : blocked.back().to;
    std::vector<double> backs;
    double from = behind + kStraightLengths.front();
    while (static_cast<int>(backs.size()) < kReturnPoints) {
      const auto back = StraightFrom(path, from, kSettlingTime * request_.speed.speed);
      if (!back) {
        break;
      }
      backs.push_back(*back);
      from = *back + kReturnSpacing;
    }
    // Return at the end of the route only as a last resort, because the detour then skips the
    // remaining waypoints.
    if (backs.empty() && behind < path.length() - 2.0 * kPathCheckSpacing) {
      backs.push_back(path.length());
    }
    return backs;
  }

  std::optional<JoinedPlan> Between(double leave, double back, double straight_on,
                                    std::uint64_t attempt, Detour& detour) const {
    std::string& why = detour.why;
    const Path& driven = request_.driven.reference.path;
    const Path& route = request_.route.reference.path;
    const Pose2 from = driven.At(leave).pose;
    const Pose2 to = route.At(back).pose;
    if ((to.position() - from.position()).norm() < kMinLead) {
      why = "it would leave the path where it returns to it";
      return std::nullopt;
    }
    const double speed = std::min(request_.station_speed, request_.speed.speed);
    PlanRequest request = RequestOn(request_.road, request_.vehicle, request_.speed);
    request.waypoints = {from.position()};
    request.obstacles = request_.obstacles;
    request.start = from;
    request.start_speed = speed;
    request.seed = request_.seed + attempt;
    if (entry_.has_headings) {
      request.waypoints.push_back(to.position());
      request.headings = {from.yaw, to.yaw};
    } else {
      const Vec2 on = from.position() + straight_on * Direction(from.yaw);
      const Vec2 before = to.position() - straight_on * Direction(to.yaw);
      request.waypoints.insert(request.waypoints.end(), {on, before, to.position()});
    }
    request.max_samples = kMaxDetourSamples - detour.samples;
    const Plan way = MakePlan(request, planner_);
    detour.samples += way.diagnostics.samples;
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

  /// Makes the steering schedule of a joined path. The first part is the schedule of the driven
  /// plan over the stations `driven`. The schedule of the remaining path follows from the curvature
  /// of the path segments.
  [[nodiscard]] SteeringSchedule JoinedSchedule(const Path& path, const std::vector<SpeedCap>& caps,
                                                const Stations& driven) const {
    const double lead = driven.to - driven.from;
    std::vector<SteeringSchedule::Knot> knots = SteeringBetween(request_.driven.schedule, driven);
    const Stations beyond{lead, path.length()};
    const SteeringSchedule rest = CourseSchedule(request_.vehicle, path.Cut(beyond),
                                                 request_.speed.speed, Moved(caps, beyond, -lead));
    constexpr double kDistinct = 1e-9;  // [m]
    for (const SteeringSchedule::Knot& knot : rest.knots()) {
      if (lead + knot.distance > knots.back().distance + kDistinct) {
        knots.push_back({lead + knot.distance, knot.steering});
      }
    }
    return SteeringSchedule::Through(std::move(knots));
  }

  /// Joins three parts: the driven path up to `leave`, the detour, and the route from `back` on.
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
    plan.sampled = request_.driven.sampled;
    plan.schedule = plan.sampled ? JoinedSchedule(path, plan.caps, {request_.station, leave})
                                 : CourseSchedule(request_.vehicle, path.segments(),
                                                  request_.speed.speed, plan.caps);
    plan.schedule_speed = plan.reference.speed;
    plan.goal = request_.route.goal;
    plan.tree = way.tree;
    FeasiblePlan held = MakeFeasibleFromHere(
        std::move(plan), RequestOn(request_.road, request_.vehicle, request_.speed));
    if (!held.ok()) {
      why = held->reason;
      return std::nullopt;
    }
    return JoinedPlan{std::move(held), {lead, beyond}};
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
  for (double s = station; s <= path.length(); s += kPathCheckSpacing) {
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
