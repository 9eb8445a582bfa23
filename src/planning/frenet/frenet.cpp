#include "trackbed/planning/frenet/frenet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "src/planning/frenet/frenet_keys.h"
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

// Distance below which a motion gets no lateral polynomial d(s) [m].
constexpr double kShort = 0.05;

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
/// lasts until the horizon. Returns none if the piece itself lasts until the horizon.
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

LineMotion LongitudinalMotion(const FrenetState& state) {
  return {state.s, state.s_rate, state.s_acceleration};
}

bool AddOverStation(const FrenetState& start, double offset, FrenetPiece& piece) {
  const double way = piece.s.At(piece.duration) - start.s;
  piece.over_station = true;
  if (!(way > -kShort)) {
    return false;
  }
  piece.d = way < kShort
                ? Polynomial{{start.d, start.d_slope, 0.5 * start.d_bend}}
                : QuinticBetween({start.d, start.d_slope, start.d_bend}, {offset, 0.0, 0.0}, way);
  return true;
}

void AddOverTime(const FrenetState& start, double offset, FrenetPiece& piece) {
  piece.over_station = false;
  piece.d = QuinticBetween({start.d, start.d_rate(), start.d_acceleration()}, {offset, 0.0, 0.0},
                           piece.duration);
}

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

std::string ExplainFailure(const FrenetPlan& plan, const char* of_what, int budget) {
  if (plan.candidates == 0) {
    return fmt::format("there are no {}", of_what);
  }
  if (plan.checked >= budget && plan.checked < plan.candidates) {
    return fmt::format("none of the first {} of {} {} is feasible{}{}", plan.checked,
                       plan.candidates, of_what, plan.checked > 0 ? ": " : "",
                       plan.rejected.ToString());
  }
  return fmt::format("none of {} {} is feasible: {}", plan.candidates, of_what,
                     plan.rejected.ToString());
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

void Visit(KeyVisitor& keys, FrenetWeights& weights) {
  keys.Field({"k_dj", "s^5/m^2", "weight of the lateral jerk"}, weights.k_dj, Need::kOptional,
             kNonNegative);
  keys.Field({"k_d", "1/m^2", "weight of the final lateral offset"}, weights.k_d, Need::kOptional,
             kNonNegative);
  keys.Field({"k_dt", "1/s", "weight of the time, lateral"}, weights.k_dt, Need::kOptional,
             kNonNegative);
  keys.Field({"k_sj", "s^5/m^2", "weight of the longitudinal jerk"}, weights.k_sj, Need::kOptional,
             kNonNegative);
  keys.Field({"k_s", "1/m^2", "weight of the final station error"}, weights.k_s, Need::kOptional,
             kNonNegative);
  keys.Field({"k_v", "s^2/m^2", "weight of the final speed error"}, weights.k_v, Need::kOptional,
             kNonNegative);
  keys.Field({"k_st", "1/s", "weight of the time, longitudinal"}, weights.k_st, Need::kOptional,
             kNonNegative);
  keys.Field({"k_lat", "", "weight of the lateral cost"}, weights.k_lat, Need::kOptional,
             kNonNegative);
  keys.Field({"k_lon", "", "weight of the longitudinal cost"}, weights.k_lon, Need::kOptional,
             kNonNegative);
  keys.Field({"derivative_order", "",
              "derivative in the cost integrals: 3 jerk (Werling et al. 2010), 2 acceleration"},
             weights.derivative_order, Need::kOptional, Range{.min = 2, .max = 3});
}

void VisitLimits(KeyVisitor& keys, FrenetLimits& limits) {
  keys.Field({"max_lateral_acceleration", "m/s^2", "maximum lateral acceleration"},
             limits.max_lateral_acceleration, Need::kOptional, kPositive);
  keys.Field({"max_steering_rate_fraction", "",
              "maximum fraction of the car's steering rate that a motion may use"},
             limits.max_steering_rate_fraction, Need::kOptional, Range{.max = 1.0, .above = 0.0});
  keys.Field({"speed_tolerance", "", "fraction by which a motion may exceed the mission speed"},
             limits.speed_tolerance, Need::kOptional, Range{.min = 0.0, .max = 1.0});
}

void Visit(KeyVisitor& keys, FrenetOptions& options) {
  keys.Field({"end_times", "s", "candidate durations"}, options.end_times, Need::kOptional,
             Range{.max = 60.0, .above = 0.0});
  keys.Field(kEndOffsets, options.end_offsets, Need::kOptional, kOffsetRange);
  keys.Field(kSpeedFactors, options.speed_factors, Need::kOptional, kFactorRange);
  keys.Field({"station_offsets", "m", "candidate station offsets when stopping or following"},
             options.station_offsets, Need::kOptional, kOffsetRange);
  keys.Field(
      {"horizon", "s", "time until which a motion, extrapolated past its end, must stay clear"},
      options.horizon, Need::kOptional, Range{.min = 0.0, .max = 60.0});
  static const EnumNames<LateralMotion> laterals{{LateralMotion::kAuto, "auto"},
                                                 {LateralMotion::kOverTime, "over_time"},
                                                 {LateralMotion::kOverStation, "over_station"}};
  keys.Field({"lateral", "",
              "lateral motion as a function of time, of station, or of station at low speed"},
             options.lateral, Need::kOptional, laterals);
  keys.Field({"low_speed", "m/s", "speed below which 'auto' uses the station"}, options.low_speed,
             Need::kOptional, kNonNegative);
  VisitLimits(keys, options.limits);
  keys.Section({"weights", "", "weights of the cost"}, options.weights);
  keys.Field({"budget", "", "maximum number of motions checked"}, options.budget, Need::kOptional,
             Range{.min = 0, .max = 1e9});
}

}  // namespace trackbed
