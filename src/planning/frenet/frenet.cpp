#include "trackbed/planning/frenet/frenet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "src/planning/frenet/frenet_pieces.h"
#include "src/planning/frenet/trajectory_check.h"
#include "trackbed/core/error.h"

// Plans optimal motions in the Frenet frame (Werling et al. 2010; weights as in the Frenet
// lecture). For every duration of the motion, the planner computes polynomials s(t) that reach the
// longitudinal targets. For every lateral offset at the end, the planner combines each s(t) with a
// polynomial d(t) or, at low speed, d(s). The planner sorts the candidate motions by their cost C.
// The plan is the first candidate that passes the coarse check and then the fine check of the full
// motion.

namespace trackbed {
namespace {

/// Returns the polynomials s(t) that reach the longitudinal targets at the end of one duration.
std::vector<FrenetPiece> AlongPath(const FrenetRequest& request, const FrenetOptions& options,
                                   double duration) {
  const LineMotion from = LongitudinalMotion(request.start);
  const FrenetTarget target = TargetAt(request.goal, request.vehicle, duration);
  std::vector<FrenetPiece> pieces;
  if (!target.station) {
    for (const double factor : options.speed_factors) {
      pieces.push_back(
          {duration, QuarticBetween(from, {0.0, factor * target.speed, 0.0}, duration), {}});
    }
  } else {
    for (const double offset : options.station_offsets) {
      pieces.push_back(
          {duration,
           QuinticBetween(from, {*target.station + offset, target.speed, 0.0}, duration),
           {}});
    }
  }
  return pieces;
}

/// Returns a motion at constant speed and constant offset that begins at the end of a piece and
/// lasts until the horizon. Returns nullopt if the piece already lasts until the horizon.
std::optional<FrenetPiece> Extrapolate(const FrenetPiece& piece, double horizon) {
  if (!(horizon > piece.duration)) {
    return std::nullopt;
  }
  const FrenetState end = piece.At(piece.duration);
  return FrenetPiece{horizon - piece.duration, Polynomial{{end.s, std::max(end.s_rate, 0.0)}},
                     Polynomial{{end.d}}, true};
}

bool IsOverStation(const FrenetPiece& piece, const FrenetOptions& options) {
  if (options.lateral != LateralMotion::kAuto) {
    return options.lateral == LateralMotion::kOverStation;
  }
  return std::min(piece.s.At(0.0, 1), piece.s.At(piece.duration, 1)) < options.low_speed;
}

}  // namespace

FrenetTarget TargetAt(const FrenetGoal& goal, const VehicleParams& vehicle, double time) {
  if (const auto* keep = std::get_if<KeepSpeed>(&goal)) {
    return {std::nullopt, keep->speed};
  }
  if (const auto* stop = std::get_if<StopAt>(&goal)) {
    return {stop->station, 0.0};
  }
  const auto& leader = std::get<FollowLeader>(goal);
  const double front = vehicle.length - vehicle.rear_overhang;
  return {leader.station + leader.speed * (time - leader.time_gap) - front - leader.gap,
          leader.speed};
}

FrenetCost PieceCost(const FrenetPiece& piece, const FrenetTarget& target,
                     const FrenetWeights& weights) {
  const auto order = static_cast<std::size_t>(weights.derivative_order);
  const double duration = piece.duration;
  const double station = piece.s.At(duration);
  const double way = station - piece.s.coefficients[0];
  double roughness = 0.0;
  double offset = 0.0;
  if (piece.over_station) {
    const double v = way / duration;  // mean speed
    roughness = (order == 3 ? v * v * v * v * v : v * v * v) * piece.d.IntegralOfSquare(order, way);
    offset = piece.d.At(way);
  } else {
    roughness = piece.d.IntegralOfSquare(order, duration);
    offset = piece.d.At(duration);
  }
  const double missed_speed = piece.s.At(duration, 1) - target.speed;
  const double station_error = target.station ? station - *target.station : 0.0;
  FrenetCost cost;
  cost.lateral = weights.k_dj * roughness + weights.k_d * offset * offset + weights.k_dt * duration;
  cost.longitudinal = weights.k_sj * piece.s.IntegralOfSquare(order, duration) +
                      weights.k_s * station_error * station_error +
                      weights.k_v * missed_speed * missed_speed + weights.k_st * duration;
  cost.total = weights.k_lat * cost.lateral + weights.k_lon * cost.longitudinal;
  return cost;
}

std::vector<FrenetCandidate> FrenetCandidates(const FrenetRequest& request,
                                              const FrenetOptions& options) {
  std::vector<FrenetCandidate> candidates;
  for (const double duration : options.end_times) {
    TRACKBED_CHECK(duration > 0.0 && std::isfinite(duration), "end time {}", duration);
    const FrenetTarget target = TargetAt(request.goal, request.vehicle, duration);
    for (FrenetPiece piece : AlongPath(request, options, duration)) {
      const bool over_station = IsOverStation(piece, options);
      for (const double offset : options.end_offsets) {
        if (!over_station) {
          AddOverTime(request.start, offset, piece);
        } else if (!AddOverStation(request.start, offset, piece)) {
          break;
        }
        candidates.push_back({piece, PieceCost(piece, target, options.weights)});
      }
    }
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const FrenetCandidate& a, const FrenetCandidate& b) {
                     return a.cost.total < b.cost.total;
                   });
  return candidates;
}

const char* ToString(Rejection rejection) {
  switch (rejection) {
    case Rejection::kSpeed:
      return "speed";
    case Rejection::kAcceleration:
      return "acceleration";
    case Rejection::kCurvature:
      return "curvature";
    case Rejection::kSteeringRate:
      return "steering_rate";
    case Rejection::kFrame:
      return "frame";
    case Rejection::kRoad:
      return "road";
    case Rejection::kCollision:
      return "collision";
  }
  return "";
}

int RejectionCounts::Of(Rejection rejection) const {
  return counts[static_cast<std::size_t>(rejection)];
}

void RejectionCounts::Add(Rejection rejection) {
  ++counts[static_cast<std::size_t>(rejection)];
}

int RejectionCounts::total() const {
  return std::accumulate(counts.begin(), counts.end(), 0);
}

std::string RejectionCounts::ToString() const {
  std::string text;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] > 0) {
      text += fmt::format("{}{} {}", text.empty() ? "" : ", ", counts[i],
                          trackbed::ToString(static_cast<Rejection>(i)));
    }
  }
  return text;
}

FrenetPlan PlanFrenet(const Path& reference, const FrenetRequest& request,
                      const FrenetOptions& options) {
  CheckRequest(request, options.limits, options.weights);
  const std::vector<FrenetCandidate> candidates = FrenetCandidates(request, options);
  FrenetPlan plan;
  plan.candidates = static_cast<int>(candidates.size());
  double to = request.start.s;
  for (const FrenetCandidate& candidate : candidates) {
    const double end = candidate.piece.s.At(candidate.piece.duration);
    const double rate = candidate.piece.s.At(candidate.piece.duration, 1);
    to = std::max(to, end + rate * std::max(options.horizon - candidate.piece.duration, 0.0));
  }
  const TrajectoryCheck check(reference, request, options.limits, to);
  if (check.blocked()) {
    plan.status = PlanStatus::kStartBlocked;
    plan.reason = *check.blocked();
    return plan;
  }
  for (const FrenetCandidate& candidate : candidates) {
    if (plan.checked >= options.budget) {
      break;
    }
    ++plan.checked;
    if (const auto rejection = check.CheckCoarsely(candidate.piece, 0.0)) {
      plan.rejected.Add(*rejection);
      continue;
    }
    const auto later = Extrapolate(candidate.piece, options.horizon);
    if (later && check.CheckCoarsely(*later, candidate.piece.duration) == Rejection::kCollision) {
      plan.rejected.Add(Rejection::kCollision);
      continue;
    }
    FrenetMotion motion{{candidate.piece}};
    auto points = SampleMotion(reference, motion, options.limits.time_step, options.limits.spacing);
    if (!points) {
      plan.rejected.Add(Rejection::kFrame);
      continue;
    }
    if (const auto flaw = check.CheckFinely(*points)) {
      plan.rejected.Add(flaw->rejection);
      continue;
    }
    plan.passed = 1;
    plan.status = PlanStatus::kOk;
    plan.motion = std::move(motion);
    plan.points = std::move(*points);
    plan.cost = candidate.cost.total;
    return plan;
  }
  plan.reason = ExplainFailure(plan, "candidates", options.budget);
  return plan;
}

}  // namespace trackbed
