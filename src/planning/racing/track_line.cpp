#include "trackbed/planning/racing/track_line.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <limits>
#include <utility>

#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/path/frenet_frame.h"
#include "trackbed/planning/common/diagnostics.h"
#include "trackbed/planning/common/route.h"
#include "trackbed/planning/frenet/polynomial.h"

// Converts a line on a track to a plan of laps. The line is given by the offset d(s) from the
// center line. The station s is unrolled: it keeps increasing over all laps. From the car's initial
// offset, a quintic polynomial reduces the offset from the line to zero, over a distance on which a
// rolling car can steer fast enough. The path consists of segments of quadratic curvature through
// points of the line with exact curvatures. After the last lap, the line continues for the braking
// distance.

namespace trackbed {
namespace {

/// Transition from the car's initial offset to the offset of the line.
struct Join {
  double from = 0.0;    // Station at which the transition begins [m].
  double length = 0.0;  // Length of the transition [m].
  Polynomial difference;
};

/// A line as a function of the unrolled station, including the transition from the car's offset
/// onto the line.
class Unrolled {
 public:
  Unrolled(const Track& track, const TrackLine& line, const Join& join)
      : track_(track), line_(line), join_(join) {}

  [[nodiscard]] LineOffset OffsetAt(double s) const {
    LineOffset offset = line_.At(s);
    const double along = s - join_.from;
    if (along < join_.length) {
      offset.d += join_.difference.At(along, 0);
      offset.slope += join_.difference.At(along, 1);
      offset.bend += join_.difference.At(along, 2);
    }
    return offset;
  }

  /// Returns pose and curvature of the line at the unrolled station s; nullopt if the Frenet frame
  /// does not exist at station s.
  [[nodiscard]] std::optional<MotionState> At(double s) const {
    const LineOffset offset = OffsetAt(s);
    return FromFrenet(
        track_.At(s),
        {.s = s, .s_rate = 1.0, .d = offset.d, .d_slope = offset.slope, .d_bend = offset.bend});
  }

  [[nodiscard]] double Length(double from, double to) const {
    return boost::math::quadrature::gauss<double, 7>::integrate(
        [&](double s) {
          const LineOffset offset = OffsetAt(s);
          return std::hypot(1.0 - track_.At(s).curvature * offset.d, offset.slope);
        },
        from, to);
  }

 private:
  const Track& track_;
  const TrackLine& line_;
  const Join& join_;
};

/// Returns the spacing of the path's points [m].
double Spacing(const Track& track) {
  return std::min(1.0, 0.25 * track.length() / static_cast<double>(track.points().size()));
}

/// Points of a path along the line, and the stations of the path that correspond to given stations
/// of the track.
struct LinePath {
  std::vector<CurvePoint> points;
  std::vector<double> passed;  // stations of the path [m]
};

/// Computes the path along a line over at least two ascending stations of the track. Returns
/// nullopt instead of a path if the Frenet frame does not exist at a station.
std::optional<LinePath> TraceLine(const Track& track, const Unrolled& line,
                                  const std::vector<double>& stations) {
  LinePath path;
  double length = 0.0;
  double yaw = 0.0;
  const auto add = [&](double s) {
    const std::optional<MotionState> at = line.At(s);
    if (at) {
      yaw = path.points.empty() ? at->pose.yaw : yaw + AngleDifference(at->pose.yaw, yaw);
      path.points.push_back({length, yaw, at->curvature});
    }
    return at.has_value();
  };
  constexpr double kMinSpacing = 0.75;
  const double spacing = Spacing(track);
  for (std::size_t i = 0; i + 1 < stations.size(); ++i) {
    path.passed.push_back(length);
    const double span = stations[i + 1] - stations[i];
    const double parts = std::ceil(span / spacing);
    for (double k = 0.0; k < parts; k += 1.0) {
      const double s = stations[i] + span * k / parts;
      // Skip points that are too close together, as on the inside of a hairpin. If close points
      // were kept, the finest oscillations of the line's curvature would limit the speed.
      const bool close = k > 0.0 && length - path.points.back().s < kMinSpacing * spacing;
      if (!close && !add(s)) {
        return std::nullopt;
      }
      length += line.Length(s, stations[i] + span * (k + 1.0) / parts);
    }
  }
  path.passed.push_back(length);
  return add(stations.back()) ? std::optional(path) : std::nullopt;
}

/// The car's initial state on the track, with a station within half a lap of the start line.
struct Start {
  std::optional<FrenetState> at;
  std::string refused;  // reason why the car cannot start at its pose
};

bool IsWithin(const TrackEdges& edges, double offset) {
  return offset <= edges.left && offset >= edges.right;
}

Start FindStart(const Track& track, const PlanRequest& request) {
  const double curvature = CurvatureForSteering(request.vehicle, request.start_steering);
  Start start{.at = track.ToFrenet({.pose = request.start, .curvature = curvature, .speed = 1.0}),
              .refused = {}};
  const TrackPlace place = track.Locate(request.start.position());
  const TrackEdges edges = track.EdgesAt(place.s);
  if (!IsWithin(edges, place.offset)) {
    start.refused = fmt::format(
        "the car starts off the track: {:.3g} m {} of the center line, whose edge is {:.3g} m away",
        std::abs(place.offset), place.offset > 0.0 ? "left" : "right",
        place.offset > 0.0 ? edges.left : -edges.right);
  } else if (!start.at || !IsWithin(track.EdgesAt(start.at->s), start.at->d)) {
    start.refused = "the car does not look along the track where it starts";
  } else if (start.at->s > 0.5 * track.length()) {
    start.at->s -= track.length();
  }
  return start;
}

/// Returns the transition from the car to the line, which is at least `length` long [m].
Join MakeJoin(const Track& track, const TrackLine& line, const FrenetState& car,
              const PlanRequest& request, double length) {
  constexpr double kTime = 3.0;  // [s]
  constexpr double kOffsets = 10.0;
  constexpr double kWheelbases = 4.0;
  const LineOffset own = line.At(car.s);
  const LineMotion from{car.d - own.d, car.d_slope - own.slope, car.d_bend - own.bend};
  Join join;
  join.from = car.s;
  join.length = std::min(0.5 * track.length(), std::max({length, kTime * request.speed.speed,
                                                         kOffsets * std::abs(from.position),
                                                         kWheelbases * request.vehicle.wheelbase}));
  join.difference = QuinticBetween(from, {}, join.length);
  return join;
}

/// Returns the largest steering rate on the transition of a car that brakes from its start speed at
/// the request's deceleration [rad/s]; infinite if the path folds over.
double SteeringRateOn(const Join& join, const Track& track, const TrackLine& line,
                      const PlanRequest& request) {
  const Unrolled path(track, line, join);
  const double parts = std::ceil(join.length / Spacing(track));
  double fastest = 0.0;
  double length = 0.0;
  double before = 0.0;
  for (double k = 0.0; k <= parts; k += 1.0) {
    const double s = join.from + join.length * k / parts;
    const std::optional<MotionState> at = path.At(s);
    if (!at) {
      return std::numeric_limits<double>::infinity();
    }
    const double steering = SteeringForCurvature(request.vehicle, at->curvature);
    if (k > 0.0) {
      const double piece = path.Length(join.from + join.length * (k - 1.0) / parts, s);
      const double squared =
          request.start_speed * request.start_speed - 2.0 * request.speed.deceleration * length;
      fastest = std::max(fastest,
                         std::sqrt(std::max(0.0, squared)) * std::abs(steering - before) / piece);
      length += piece;
    }
    before = steering;
  }
  return fastest;
}

/// Returns the transition from the car to the racing line. If a rolling car cannot steer fast
/// enough on the usual transition to the line, the transition is lengthened to at most half a lap.
Join DrivableJoin(const Track& track, const TrackLine& line, const FrenetState& car,
                  const PlanRequest& request) {
  constexpr double kGrowth = 1.25;
  // Usable fraction of the steering rate, because the mean rate between two points of the path is
  // a few percent lower than the largest rate.
  constexpr double kUsable = 0.9;
  const double longest = 0.5 * track.length();
  Join best = MakeJoin(track, line, car, request, 0.0);
  if (!(request.start_speed > 0.0)) {
    return best;
  }
  double least = SteeringRateOn(best, track, line, request);
  double length = best.length;
  while (least > kUsable * request.vehicle.steering_rate && length < longest) {
    length = std::min(kGrowth * length, longest);
    const Join join = MakeJoin(track, line, car, request, length);
    const double rate = SteeringRateOn(join, track, line, request);
    if (rate < least) {
      best = join;
      least = rate;
    }
  }
  return best;
}

double RunOut(const PlanRequest& request) {
  double deceleration = request.speed.deceleration;
  if (const double most = MaxDeceleration(request.vehicle, request.friction); most > 0.0) {
    deceleration = std::min(deceleration, most);
  }
  return request.speed.speed * request.speed.speed / (2.0 * deceleration);
}

}  // namespace

TrackLine::TrackLine(const ClosedSplineBasis& basis, Eigen::MatrixXd coefficients)
    : basis_(basis), coefficients_(std::move(coefficients)) {
  TRACKBED_REQUIRE(
      coefficients_.cols() == 1 && coefficients_.rows() == static_cast<Eigen::Index>(basis.count()),
      "TrackLine: {} x {} coefficients for {} functions", coefficients_.rows(),
      coefficients_.cols(), basis.count());
}

LineOffset TrackLine::At(double s) const {
  if (!basis_) {
    return {};
  }
  const ClosedSplineBasis::Local local = basis_->At(s);
  return {Evaluate(local, coefficients_, 0)[0], Evaluate(local, coefficients_, 1)[0],
          Evaluate(local, coefficients_, 2)[0]};
}

LineFindings MeasureLine(const Track& track, const TrackLine& line) {
  const Join none;
  const Unrolled unrolled(track, line, none);
  const double parts = std::ceil(track.length() / Spacing(track));
  LineFindings findings;
  double sharpest = 0.0;
  for (double k = 0.0; k < parts; k += 1.0) {
    // Use the midpoint rule, which converges as fast as any other quadrature because kappa^2 is
    // periodic over a lap.
    const double from = track.length() * k / parts;
    const double length = unrolled.Length(from, track.length() * (k + 1.0) / parts);
    const std::optional<MotionState> at = unrolled.At(track.length() * (k + 0.5) / parts);
    TRACKBED_REQUIRE(at.has_value(), "MeasureLine: the line folds over at s = {} m", from);
    findings.length += length;
    findings.curvature_square += at->curvature * at->curvature * length;
    sharpest = std::max(sharpest, std::abs(at->curvature));
  }
  findings.radius_min = 1.0 / sharpest;
  return findings;
}

void Visit(DiagnosticsVisitor& out, const TrackPlanDiagnostics& own) {
  out.Number("track_length_m", own.track_length);
  out.Number("smoothing_m", own.smoothing);
  out.Number("deviation_max_m", own.deviation_max);
  out.Number("deviation_rms_m", own.deviation_rms);
  out.Number("lap_length_m", own.lap.length);
  out.Number("lap_curvature_square_radpm", own.lap.curvature_square);
  out.Number("lap_radius_min_m", own.lap.radius_min);
  out.Number("join_m", own.join);
  out.Number("run_out_m", own.run_out);
}

Plan FollowLine(const PlanRequest& request, const TrackLine& line) {
  if (!request.on_track.track) {
    return route::Refused(PlanStatus::kNoPath, "there is no track to follow");
  }
  const Track& track = *request.on_track.track;
  const Start start = FindStart(track, request);
  if (!start.refused.empty()) {
    return route::Refused(PlanStatus::kStartBlocked, start.refused);
  }
  const Join join = DrivableJoin(track, line, *start.at, request);
  const double run_out = RunOut(request);
  const double first = start.at->s;
  std::vector<double> stations{first};
  for (int lap = first < 0.0 ? 0 : 1; lap <= request.on_track.laps; ++lap) {
    stations.push_back(lap * track.length());
  }
  stations.push_back(stations.back() + run_out);
  const std::optional<LinePath> traced = TraceLine(track, Unrolled(track, line, join), stations);
  if (!traced) {
    return route::Refused(PlanStatus::kNoPath,
                          "the track bends too sharply where the car comes onto its line");
  }
  Plan plan;
  plan.reference.path = Path({request.start.x, request.start.y, traced->points.front().yaw},
                             SegmentsThrough(traced->points));
  const Path& path = plan.reference.path;
  plan.reference.speed = StopAtEnd(path.length(), request.start_speed, request.speed);
  std::vector<SteeringSchedule::Knot> knots;
  for (const CurvePoint& point : traced->points) {
    knots.push_back({point.s, SteeringForCurvature(request.vehicle, point.curvature)});
  }
  plan.schedule = SteeringSchedule::Through(std::move(knots));
  plan.schedule_speed = plan.reference.speed;
  plan.goal = path.At(path.length()).pose;
  plan.laps = {.track = request.on_track.track,
               .lines = {traced->passed.begin() + (first < 0.0 ? 1 : 0), traced->passed.end() - 1}};
  plan.diagnostics.planner = TrackPlanDiagnostics{.track_length = track.length(),
                                                  .smoothing = track.smoothing(),
                                                  .deviation_max = track.deviation_max(),
                                                  .deviation_rms = track.deviation_rms(),
                                                  .join = join.length,
                                                  .run_out = run_out,
                                                  .lap = MeasureLine(track, line)};
  return plan;
}

std::optional<double> StartCurvatureOnTrack(const PlannerOptions& /*options*/,
                                            const RouteStart& route) {
  if (!route.on_track.track) {
    return std::nullopt;
  }
  const Track& track = *route.on_track.track;
  std::optional<FrenetState> car = track.ToFrenet({.pose = route.pose, .speed = 1.0});
  if (!car) {
    return std::nullopt;
  }
  car->d_bend = 0.0;
  const std::optional<MotionState> along = FromFrenet(track.At(car->s), *car);
  return along ? std::optional(along->curvature) : std::nullopt;
}

}  // namespace trackbed
