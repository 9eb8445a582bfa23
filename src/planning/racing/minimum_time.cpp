#include "trackbed/planning/racing/minimum_time.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "src/planning/racing/gentle_line.h"
#include "src/planning/racing/lap_model.h"
#include "src/planning/racing/lap_program.h"
#include "trackbed/core/error.h"
#include "trackbed/optimize/sparse_quadratic_program.h"
#include "trackbed/options/key_visitor.h"
#include "trackbed/planning/common/diagnostics.h"
#include "trackbed/planning/common/route.h"
#include "trackbed/planning/racing/minimum_curvature.h"
#include "trackbed/vehicle/steering_reach.h"

// Finds the line with the least lap time (problem of Casanova 2000 and Christ et al. 2021) by a
// trust-region method. The search starts at the line with the least curvature. If the line of least
// curvature has bends that are too tight for the car, ReduceCurvature first makes these bends
// wider, or shows that no line nearby is wide enough. Each step solves a quadratic program
// (LapProgram) for changes of the line and of the speeds. The search tries the whole step, then a
// half, a quarter and a tenth of the step. For each new line, the lap time is computed with the
// speed profile at the car's limit on this line. The search accepts a step only if the lap gets
// faster within the largest curvature. If no step is accepted, the trust region shrinks. The lap
// times of the result come from a finer model with twice as many stations.

namespace trackbed {
namespace {

constexpr double kSameCurvature = 1e-6;  // relative tolerance of the largest permitted curvature

/// Returns the number of stations of the quadratic programs, with at least two stations per knot of
/// the spline and a spacing of at most 2.6 m.
std::size_t ProgramStations(const Track& track) {
  constexpr double kMaxSpacing = 2.6;  // [m]
  const double knots = static_cast<double>(OffsetBasis(track).count());
  return static_cast<std::size_t>(knots *
                                  std::max(2.0, std::ceil(track.length() / (knots * kMaxSpacing))));
}

/// Searches for the line with the least lap time. The object holds the best line and lap so far,
/// and the reason why the search ended.
class LapSearch {
 public:
  LapSearch(const Track& track, double beside, const LapLimits& limits, const TrackLine& start)
      : model_(track, limits, ProgramStations(track)),
        basis_(OffsetBasis(track)),
        program_(model_, basis_, AllBounds(track, beside)),
        line_(start),
        lap_(model_.Drive(start)) {}

  void Run(int iterations) {
    while (found_.iterations < iterations) {
      if (Step()) {
        return;
      }
    }
    found_.end = MinimumTimeEnd::kIterationLimit;
  }

  [[nodiscard]] const TrackLine& line() const { return line_; }
  /// Returns a result with the number of iterations, the last decrease of the lap time and the
  /// reason for the end of the search. The caller sets the line and the times of the result.
  [[nodiscard]] const MinimumTimeLine& found() const { return found_; }

 private:
  [[nodiscard]] std::vector<OffsetBounds> AllBounds(const Track& track, double beside) const {
    std::vector<OffsetBounds> bounds;
    for (std::size_t i = 0; i < model_.count(); ++i) {
      bounds.push_back(BoundsAt(track, model_.center(i), model_.StationAt(i), beside));
    }
    return bounds;
  }

  /// Returns whether the car can drive all bends of a lap, or whether no bend is tighter than the
  /// tightest bend of the present lap.
  [[nodiscard]] bool IsWithin(const Lap& lap) const {
    const double most = model_.limits().curvature_max;
    return most <= 0.0 || lap.sharpest <= std::max(lap_.sharpest, most * (1.0 + kSameCurvature));
  }

  /// Solves one quadratic program and tries the resulting step. Returns whether the search is over.
  bool Step() {
    constexpr double kMinScale = 1e-3;
    // Predicted gain below which the search ends, as a fraction of the lap time.
    constexpr double kConvergenceTolerance = 1e-4;
    const LapTrust trust{.offset = kTrustOffset * scale_, .squared = kTrustSquared * scale_};
    const SparseQuadraticProgram program = program_.About(line_, lap_, trust);
    const SparseQuadraticSolution solution = Solve(
        program, Eigen::VectorXd::Zero(program.linear.size()), InteriorSteps::kPredictorCorrector);
    ++found_.iterations;
    if (!solution.ok) {
      found_.end = MinimumTimeEnd::kProgramNotSolved;
      scale_ *= 0.1;
      return scale_ < kMinScale;
    }
    program_.TakeMultipliers(solution.multipliers);
    const double promised =
        -(program.linear.dot(solution.x) + 0.5 * solution.x.dot(program.hessian * solution.x));
    found_.end = MinimumTimeEnd::kConverged;
    if (promised < kConvergenceTolerance * lap_.time) {
      return true;
    }
    if (Take(solution.x, promised)) {
      return false;
    }
    if (promised < 5.0 * kConvergenceTolerance * lap_.time) {
      return true;
    }
    found_.end = MinimumTimeEnd::kNoGain;
    return scale_ < kMinScale;
  }

  /// Applies the step, or the largest fraction of the step that improves the lap. Returns false if
  /// no fraction of the step improves the lap.
  bool Take(const Eigen::VectorXd& step, double promised) {
    for (const double part : {1.0, 0.5, 0.25, 0.1}) {
      TrackLine line(basis_, line_.coefficients() + part * step.head(program_.coefficients()));
      Lap lap = model_.Drive(line);
      const double gain = lap_.time - lap.time;
      if (IsWithin(lap) && gain > 0.1 * part * promised) {
        scale_ = part == 1.0 && gain > 0.75 * promised ? std::min(2.0 * scale_, kMaxScale)
                                                       : std::max(0.5, part) * scale_;
        found_.last_gain = gain;
        line_ = std::move(line);
        lap_ = std::move(lap);
        return true;
      }
    }
    // Shrink the trust region to a tenth of its size or of the step's size, whichever is smaller.
    const double squared =
        step.tail(step.size() - program_.coefficients()).lpNorm<Eigen::Infinity>();
    scale_ = 0.1 * std::min(scale_, squared / kTrustSquared);
    return false;
  }

  static constexpr double kTrustOffset = 1.0;  // Limit of the change of the offset d at scale 1.
  // Limit of the relative change of a squared speed if the scale is 1.
  static constexpr double kTrustSquared = 0.3;
  static constexpr double kMaxScale = 2.0;

  LapModel model_;
  ClosedSplineBasis basis_;
  LapProgram program_;
  TrackLine line_;
  Lap lap_;
  double scale_ = 1.0;  // Factor by which the trust region is scaled.
  MinimumTimeLine found_;
};

/// Returns the number of stations at which lines are compared, twice that of the quadratic
/// programs.
std::size_t FineStations(const Track& track) {
  return 2 * ProgramStations(track);
}

/// Returns a lap model for comparing lines.
LapModel FineModel(const Track& track, const LapLimits& limits) {
  return {track, limits, FineStations(track)};
}

std::string DescribeEnd(const MinimumTimeLine& found) {
  switch (found.end) {
    case MinimumTimeEnd::kConverged:
      break;
    case MinimumTimeEnd::kNoGain:
      return "; stopped where shorter steps gained nothing more";
    case MinimumTimeEnd::kIterationLimit:
      return found.iterations == 1
                 ? fmt::format("; stopped after 1 step, which gained {:.2g} s", found.last_gain)
                 : fmt::format("; stopped after {} steps, the last of which gained {:.2g} s",
                               found.iterations, found.last_gain);
    case MinimumTimeEnd::kProgramNotSolved:
      return "; stopped because a quadratic program was not solved";
  }
  return "";
}

std::string Describe(const MinimumTimeLine& found) {
  if (!found.improved) {
    return fmt::format(
        "minimum_time found no faster line than that of least curvature ({:.4g} s a lap){}",
        found.start_time, DescribeEnd(found));
  }
  return fmt::format(
      "lap time {:.5g} s at the limit, {:.2g} % less than on the line of least "
      "curvature ({:.5g} s){}",
      found.time, 100.0 * (1.0 - found.time / found.start_time), found.start_time,
      DescribeEnd(found));
}

/// Returns an error message about a line with a bend that is too tight for the car.
std::string TooTight(const LapLimits& limits, const GentleLine& line) {
  return fmt::format(
      "the car turns on a radius of {:.3g} m at least; the widest line found within the margins "
      "bends on {:.3g} m at s = {:.4g} m",
      1.0 / limits.curvature_max, 1.0 / line.curvature, line.s);
}

/// Returns the remedy for a track on which no line was found, with "; " before it.
std::string RemedyFor(const MinimumTimeLine& found, const PlanRequest& request,
                      const MinimumTimeOptions& options) {
  const VehicleParams& vehicle = request.vehicle;
  if (found.room > 0.0) {
    return "; " + RemedyForNarrowTrack(found.room, vehicle.width);
  }
  if (found.sharpest <= 0.0) {
    return "";
  }
  const Track& track = *request.on_track.track;
  const double beside = 0.5 * vehicle.width;
  const MinimumCurvatureLine widest = FindMinimumCurvature(track, beside);
  const double most = LimitsOfLap(request).curvature_max;
  if (options.margin > 0.0 && widest.refused.empty() &&
      ReduceCurvature(track, beside, widest.line, most, FineStations(track)).curvature <= most) {
    return fmt::format("; plan.margin: 0 leaves room for a wide enough line, {} does not",
                       options.margin);
  }
  return fmt::format(
      "; the track needs a car whose wheels turn by {:.3g} rad instead of {:.3g} rad",
      std::abs(SteeringForCurvature(vehicle, found.sharpest)), SteeringReach(vehicle, 0.0));
}

Plan PlanWith(const MinimumTimeOptions& options, const PlanRequest& request) {
  if (!request.on_track.track) {
    return FollowLine(request, TrackLine());
  }
  if (!request.limits) {
    return route::Refused(PlanStatus::kNoPath,
                          "the line of least time needs speeds at the limit (speed_profile: "
                          "{method: limits})");
  }
  const MinimumTimeLine found =
      FindMinimumTime(*request.on_track.track, 0.5 * request.vehicle.width + options.margin,
                      LimitsOfLap(request), options.iterations);
  if (!found.refused.empty()) {
    return route::Refused(PlanStatus::kNoPath, found.refused + RemedyFor(found, request, options));
  }
  Plan plan = FollowLine(request, found.line);
  if (const auto* own = plan.diagnostics.planner.GetIf<TrackPlanDiagnostics>()) {
    plan.diagnostics.planner =
        MinimumTimeDiagnostics{.plan = *own,
                               .lap_time = found.time,
                               .minimum_curvature_lap_time = found.start_time,
                               .end = ToString(found.end),
                               .iterations = found.iterations};
    plan.notes.push_back(Describe(found));
  }
  return plan;
}

}  // namespace

LapLimits LimitsOfLap(const PlanRequest& request) {
  TRACKBED_CHECK(request.limits.has_value(), "a request {}", "without limits");
  const VehicleParams& vehicle = request.vehicle;
  const double sharpest = CurvatureForSteering(vehicle, SteeringReach(vehicle, 0.0));
  double speed = request.speed.speed;
  if (vehicle.top_speed > 0.0) {
    speed = std::min(speed, vehicle.top_speed);
  }
  return {.diagram = request.limits->diagram,
          .options = {.share = request.limits->options.share,
                      .jerk = request.limits->options.jerk.value_or(0.0),
                      .speed = speed},
          .road = request.friction,
          .vehicle = vehicle,
          .curvature_max = std::isfinite(sharpest) ? std::max(0.0, sharpest) : 0.0};
}

double LapTime(const Track& track, const TrackLine& line, const LapLimits& limits) {
  return FineModel(track, limits).Drive(line).time;
}

MinimumTimeLine FindMinimumTime(const Track& track, double beside, const LapLimits& limits,
                                int iterations) {
  const MinimumCurvatureLine start = FindMinimumCurvature(track, beside);
  if (!start.refused.empty()) {
    return {.refused = start.refused, .line = {}, .room = start.room};
  }
  // Relative excess of the curvature that is permitted between the stations of the search.
  constexpr double kCurvatureTolerance = 1e-3;
  const double most =
      limits.curvature_max > 0.0 ? limits.curvature_max * (1.0 + kCurvatureTolerance) : 1e9;
  TrackLine first = start.line;
  if (limits.curvature_max > 0.0) {
    GentleLine gentle =
        ReduceCurvature(track, beside, start.line, limits.curvature_max, FineStations(track));
    if (gentle.curvature > most) {
      return {.refused = TooTight(limits, gentle), .line = {}, .sharpest = gentle.curvature};
    }
    first = std::move(gentle.line);
  }
  const LapModel model = FineModel(track, limits);
  const Lap before = model.Drive(start.line);
  if (!std::isfinite(before.time)) {
    return {.refused = "the car cannot keep moving on the line of least curvature", .line = {}};
  }
  LapSearch search(track, beside, limits, first);
  search.Run(iterations);
  MinimumTimeLine found = search.found();
  const Lap after = model.Drive(search.line());
  found.start_time = before.time;
  if (before.sharpest > most) {
    // If the line of least curvature is too tight, return the line that the lap-time search found.
    // If the line of the lap-time search is too tight as well, return the line at which the search
    // began.
    found.improved = true;
    found.line = after.sharpest <= most ? search.line() : first;
    found.time = after.sharpest <= most ? after.time : model.Drive(first).time;
    return found;
  }
  found.improved = after.sharpest <= most && after.time < before.time;
  found.line = found.improved ? search.line() : start.line;
  found.time = found.improved ? after.time : before.time;
  return found;
}

const char* ToString(MinimumTimeEnd end) {
  switch (end) {
    case MinimumTimeEnd::kConverged:
      return "converged";
    case MinimumTimeEnd::kNoGain:
      return "no_gain";
    case MinimumTimeEnd::kIterationLimit:
      return "iteration_limit";
    case MinimumTimeEnd::kProgramNotSolved:
      return "program_not_solved";
  }
  return "";
}

void Visit(KeyVisitor& keys, MinimumTimeOptions& options) {
  keys.Field({"margin", "m", "distance of the car's sides from the edges"}, options.margin,
             Need::kOptional, Range{.min = 0.0, .max = 100.0});
  keys.Field({"iterations", "", "largest number of steps toward a faster line"}, options.iterations,
             Need::kOptional, Range{.min = 1.0, .max = 1000.0});
}

void Visit(DiagnosticsVisitor& out, const MinimumTimeDiagnostics& own) {
  Visit(out, own.plan);
  out.Number("lap_time_s", own.lap_time);
  out.Number("minimum_curvature_lap_time_s", own.minimum_curvature_lap_time);
  out.Integer("iterations", own.iterations);
  out.Text("end", own.end);
}

PlannerEntry MinimumTimePlanner() {
  return {.name = "minimum_time",
          .summary = "laps along the line of least lap time at the car's limit",
          .defaults = MinimumTimeOptions{},
          .plan = PlanBy<MinimumTimeOptions, PlanWith>,
          .follows_track = true,
          .needs_limits = true,
          .start_curvature = StartCurvatureOnTrack};
}

}  // namespace trackbed
