#include "trackbed/planning/common/speed_at_limit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "trackbed/core/error.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/world/world.h"

namespace trackbed {
namespace {

constexpr double kSamePlace = 1e-9;  // Distance below which two stations count as equal [m].
// First words of the plan's note with the predicted driving time.
const std::string kAtLimit = "speeds at ";
/// Fraction of the station spacing below which two stations are merged.
constexpr double kMerged = 0.002;

double LargerOf(double a, double b) {
  return std::abs(a) > std::abs(b) ? a : b;
}

/// Returns stations along path segments, each with the path's curvature. The stations begin at
/// `from` [m].
std::vector<LimitStation> Nodes(const std::vector<Segment>& segments, double from, double spacing) {
  std::vector<LimitStation> nodes;
  double start = from;
  for (const Segment& segment : segments) {
    const double pieces = std::ceil(segment.length / spacing);
    for (double i = 0.0; i <= pieces; i += 1.0) {
      const double d = segment.length * i / pieces;
      const double curvature = segment.CurvatureAt(d);
      if (!nodes.empty() && start + d < nodes.back().s + kMerged * spacing) {
        nodes.back().curvature = LargerOf(nodes.back().curvature, curvature);
      } else {
        nodes.push_back({.s = start + d, .curvature = curvature});
      }
    }
    start += segment.length;
  }
  if (nodes.size() > 1 && start - nodes.back().s > 0.0) {
    nodes.back().s = start;  // avoid a rounding error at the end of the path
  }
  return nodes;
}

/// Determines ground height and friction along a path.
class Surface {
 public:
  Surface(const Path& path, const PlanRequest& request) : path_(path), request_(request) {
    const VehicleParams& vehicle = request.vehicle;
    front_ = vehicle.kind == VehicleKind::kSteered ? vehicle.wheelbase : 0.0;
    share_ = front_ > 0.0 ? vehicle.cg_to_rear / vehicle.wheelbase : 0.0;
    flat_ = IsFlat(request.limits->ground);
  }

  void Describe(LimitStation& at) const {
    if (flat_ && request_.friction_patches.empty()) {
      at.road = request_.friction;
      return;
    }
    const Pose2 pose = path_.At(at.s).pose;
    const Vec2 rear = pose.position();
    const Vec2 front = ToWorld(pose, {front_, 0.0});
    const auto factor = [&](const Vec2& point) {
      return RoadFactor(request_.friction, request_.friction_patches, point);
    };
    at.road = std::min(factor(rear), factor(front));
    if (flat_) {
      return;
    }
    const double half = 0.5 * std::max(request_.vehicle.wheelbase, 0.1);
    const double before = Height(path_.At(at.s - half).pose);
    const double here = Height(pose);
    const double after = Height(path_.At(at.s + half).pose);
    at.grade = (after - before) / (2.0 * half);
    at.crest = (after - 2.0 * here + before) / (half * half);
    const Ground& ground = request_.limits->ground;
    const Vec2 slope =
        (1.0 - share_) * GroundSlope(ground, rear) + share_ * GroundSlope(ground, front);
    at.bank = slope.dot(LeftNormal(Direction(pose.yaw)));
  }

 private:
  /// Returns the ground height under the center of gravity, interpolated between the axles.
  [[nodiscard]] double Height(const Pose2& pose) const {
    const Ground& ground = request_.limits->ground;
    return std::lerp(GroundHeight(ground, pose.position()),
                     GroundHeight(ground, ToWorld(pose, {front_, 0.0})), share_);
  }

  const Path& path_;
  const PlanRequest& request_;
  double front_ = 0.0;  // Distance between front and rear axle [m].
  double share_ = 0.0;  // Fraction of the car's weight on the front axle.
  bool flat_ = true;
};

/// Applies speed caps to stations. A rolling car that brakes at the request's deceleration may be
/// faster than a cap. A speed cap that is not strict is raised to the speed of the braking car.
void ApplyCaps(const std::vector<SpeedCap>& caps, const PlanRequest& request,
               std::vector<LimitStation>& stations) {
  const auto allowed = [&](const SpeedCap& cap, double s) {
    const double braked =
        request.start_speed * request.start_speed - 2.0 * request.speed.deceleration * s;
    return cap.strict ? cap.speed : std::sqrt(std::max(cap.speed * cap.speed, braked));
  };
  const auto before = [](const LimitStation& at, double s) { return at.s < s; };
  for (const SpeedCap& cap : caps) {
    if (stations.empty() || cap.to < stations.front().s - kSamePlace ||
        cap.from > stations.back().s + kSamePlace) {
      continue;
    }
    // Apply the cap also to the stations just before and just after the capped stretch, because
    // between two stations the speed may reach the larger of the stations' speeds.
    auto first = std::lower_bound(stations.begin(), stations.end(), cap.from + kSamePlace, before);
    auto last = std::lower_bound(stations.begin(), stations.end(), cap.to - kSamePlace, before);
    first = first == stations.begin() ? first : first - 1;
    last = last == stations.end() ? last : last + 1;
    for (; first != last; ++first) {
      const double speed = allowed(cap, first->s);
      first->cap = first->cap > 0.0 ? std::min(first->cap, speed) : speed;
    }
  }
}

struct Timed {
  SpeedProfile profile;
  std::optional<LimitExcess> excess;
};

/// Computes the speeds over the legs of a path. Each leg ends at rest.
Timed SpeedsOver(const std::vector<Stations>& legs, const Path& path, const PlanRequest& request,
                 const std::vector<SpeedCap>& caps) {
  const SpeedAtLimit& limits = *request.limits;
  const LimitOptions options{.share = limits.options.share,
                             .jerk = limits.options.jerk.value_or(0.0),
                             .speed = request.speed.speed};
  Timed timed;
  std::vector<SpeedProfile::Knot> knots;
  for (const Stations& leg : legs) {
    const std::vector<LimitStation> stations = StationsAlong(path, leg, request, caps);
    if (stations.size() < 2) {
      continue;
    }
    const LimitSpeeds own = LimitSpeedsAlong(stations, limits.diagram, options,
                                             knots.empty() ? request.start_speed : 0.0, 0.0);
    if (own.excess && !timed.excess) {
      timed.excess = own.excess;
    }
    for (std::size_t i = 0; i < stations.size(); ++i) {
      if (knots.empty() || stations[i].s > knots.back().s + 0.5 * kSamePlace) {
        knots.push_back({stations[i].s, own.speeds[i]});
      }
    }
  }
  timed.profile = SpeedProfile(knots.empty() ? std::vector<SpeedProfile::Knot>{{0.0, 0.0}} : knots);
  return timed;
}

LimitProfileFindings Describe(const Plan& plan, double share) {
  const Path& path = plan.reference.path;
  const SpeedProfile& speed = plan.reference.speed;
  LimitProfileFindings findings{.share = share, .predicted_time = plan.Duration()};
  const std::vector<SpeedProfile::Knot>& knots = speed.knots();
  double before = 0.0;
  for (std::size_t i = 0; i < knots.size(); ++i) {
    const double square = knots[i].speed * knots[i].speed;
    findings.lateral_max =
        std::max(findings.lateral_max, square * std::abs(path.BendAt(knots[i].s).curvature));
    const double after = speed.AccelerationAt(knots[i].s);
    findings.driving_max = std::max(findings.driving_max, after);
    findings.braking_max = std::max(findings.braking_max, -after);
    const bool valley = before < 0.0 && after >= 0.0 && knots[i].speed > 0.0;
    if (valley && (findings.slowest == 0.0 || knots[i].speed < findings.slowest)) {
      findings.slowest = knots[i].speed;
      findings.slowest_s = knots[i].s;
    }
    before = after;
  }
  return findings;
}

}  // namespace

std::vector<LimitStation> StationsAlong(const Path& path, const Stations& part,
                                        const PlanRequest& request,
                                        const std::vector<SpeedCap>& caps) {
  TRACKBED_CHECK(request.limits.has_value(), "a request {}", "without limits");
  std::vector<Segment> segments = path.Cut(part);
  const double beyond = part.to - std::max(path.length(), part.from);
  if (beyond > kSamePlace) {
    segments.push_back({.length = beyond});
  }
  // Divide even short legs, because a leg that begins and ends at rest needs stations in between.
  constexpr double kPieces = 16.0;
  const double spacing =
      std::min({0.5, 0.2 * request.vehicle.wheelbase, (part.to - part.from) / kPieces});
  std::vector<LimitStation> stations = Nodes(segments, part.from, spacing);
  const Surface surface(path, request);
  for (LimitStation& at : stations) {
    surface.Describe(at);
  }
  ApplyCaps(caps, request, stations);
  return stations;
}

std::optional<LimitExcess> SetSpeedsAtLimit(Plan& plan, const PlanRequest& request,
                                            const std::vector<SpeedCap>& caps) {
  const Path& path = plan.reference.path;
  const double stop =
      plan.schedule_speed.knots().empty() ? path.length() : plan.schedule_speed.knots().back().s;
  const std::vector<Stations> legs = SplitIntoLegs(path, plan.stops);
  Timed timed = SpeedsOver(legs, path, request, caps);
  plan.reference.speed = timed.profile;
  plan.schedule_speed = std::abs(stop - path.length()) < kSamePlace
                            ? plan.reference.speed
                            : SpeedsOver({{0.0, stop}}, path, request, caps).profile;
  const LimitProfileFindings findings = Describe(plan, request.limits->options.share);
  plan.diagnostics.speed_profile = findings;
  const std::string slowest = findings.slowest > 0.0
                                  ? fmt::format(", slowest {:.3g} m/s at s = {:.4g} m",
                                                findings.slowest, findings.slowest_s)
                                  : "";
  // Remove the predicted time of the previous plan, which a rerouted plan still has in its notes.
  std::erase_if(plan.notes, [](const std::string& note) { return note.starts_with(kAtLimit); });
  if (std::isfinite(findings.predicted_time)) {
    plan.notes.push_back(kAtLimit + fmt::format("{:.3g} of the limit: predicted time {:.4g} s{}",
                                                findings.share, findings.predicted_time, slowest));
  }
  return timed.excess;
}

void Visit(DiagnosticsVisitor& out, const LimitProfileFindings& findings) {
  out.Number("share", findings.share);
  out.Number("predicted_time_s", findings.predicted_time);
  if (findings.slowest > 0.0) {
    out.Number("slowest_mps", findings.slowest);
    out.Number("slowest_s_m", findings.slowest_s);
  }
  out.Number("lateral_acceleration_max_mps2", findings.lateral_max);
  out.Number("acceleration_max_mps2", findings.driving_max);
  out.Number("deceleration_max_mps2", findings.braking_max);
}

}  // namespace trackbed
