#pragma once

#include <string>

#include "trackbed/planning/common/limit_profile.h"
#include "trackbed/planning/common/planner.h"
#include "trackbed/planning/racing/track_line.h"
#include "trackbed/track/track.h"

/// Finds the line around a track on which a car that uses its limits fully has the shortest lap
/// time.
///
/// Symbols: d(s) is the offset of the line from the track's center line at the station s [m], a
/// spline with the coefficients c; b is half of the car's width plus the margin [m]; T is the lap
/// time [s] on the line at the highest possible speeds (LimitSpeedsAround). The line of minimum
/// time, between the track edges right(s) and left(s), solves this problem:
///
///   minimize T(c)   subject to   right(s) + b <= d(s) <= left(s) - b,   |kappa| <= kappa_max
///
/// The solver is a trust-region method that starts at the line of least curvature. Each step
/// linearizes three quantities about the last line and its speeds: the curvature of the line, the
/// length of the line, and the boundary of the g-g-v diagram. Each step then solves a quadratic
/// program for changes of the spline coefficients c and of the speeds at all stations.
/// LimitSpeedsAround computes the speeds of the new line, and the new line is kept only if its lap
/// time is shorter. Casanova 2000 and Christ et al. 2021 solve the same minimum-time problem, but
/// with vehicle models in place of a point mass with a g-g-v diagram. The speeds are not unknowns
/// of the minimum-time problem, because LimitSpeedsAround computes the speeds of any line.
namespace trackbed {

/// The limits on a car's speed during a lap, on a level road with uniform friction.
struct LapLimits {
  GgvDiagram diagram;
  LimitOptions options{};
  double road = 1.0;  ///< Friction of the road, as a factor on the tyres' friction [1], > 0.
  /// The car, for computing steering angles in steady turns (SteeringInBend). If the vehicle's
  /// limit of the steering rate is 0, the steering rate is not limited.
  VehicleParams vehicle{};
  /// Largest permitted curvature kappa_max of the line [1/m]; 0: no limit.
  double curvature_max = 0.0;
};

/// Returns the limits of a lap for the given request, which must have PlanRequest::limits.
LapLimits LimitsOfLap(const PlanRequest& request);

/// Returns the lap time on a line at the highest possible speeds [s]. The speeds are computed at
/// stations whose spacing is a quarter of the spacing of the track's points, but at most 1.3 m.
/// Throws PreconditionError if the line folds back on itself.
double LapTime(const Track& track, const TrackLine& line, const LapLimits& limits);

enum class MinimumTimeEnd {
  /// The search has converged if the predicted gain of a step is at most 1e-4 of the lap time. The
  /// search has also converged if the predicted gain is at most 5e-4 of the lap time, and no
  /// fraction of the step makes the lap faster.
  kConverged,
  /// No step of the search makes the lap faster, not even a step that changes the line by only a
  /// millimeter.
  kNoGain,
  kIterationLimit,  ///< The search has reached the maximum number of iterations.
  kProgramNotSolved,
};
/// Returns the name, as written in plan.json, of the reason why the search ended: "converged",
/// "no_gain", "iteration_limit", "program_not_solved".
const char* ToString(MinimumTimeEnd end);

struct MinimumTimeLine {
  std::string refused;  ///< Reason why no line was found; else empty.
  TrackLine line;
  double time = 0.0;        ///< Lap time on the found line, equal to LapTime [s].
  double start_time = 0.0;  ///< Lap time on the line of least curvature, equal to LapTime [s].
  /// Whether the found line is faster than the line of least curvature; if not, the result is the
  /// line of least curvature.
  bool improved = false;
  MinimumTimeEnd end = MinimumTimeEnd::kConverged;
  int iterations = 0;      ///< Number of quadratic programs that the search solved.
  double last_gain = 0.0;  ///< Reduction of the lap time by the last accepted step [s].
  /// Upper limit of the line's distance b from the edges if the track is too narrow
  /// (MinimumCurvatureLine::room) [m]; else 0.
  double room = 0.0;
  /// Largest curvature |kappa| of the gentlest line that was found [1/m], if this curvature is
  /// above kappa_max; else 0.
  double sharpest = 0.0;
};

/// Finds the fastest line that stays at least b = `beside` [m] away from the track's edges. The
/// result contains no line if the track is too narrow, if no line with at most the curvature
/// kappa_max was found, or if the car cannot keep moving.
///
/// Guarantees: the lap time on the line (LapTime) is never longer than on the line of least
/// curvature with the same distance b from the edges. At checked points, two or more per knot, the
/// line keeps the distance b from the edges, to within 1e-6 m. On one machine, the same arguments
/// always yield a bit-identical line. The minimization of the lap time is not convex, so that the
/// line is only a local minimum. FindMinimumTime ignores slopes, banks and changes of friction
/// along the track. Throws RunError if the program was built without IPOPT. Computing time: 5 to 20
/// quadratic programs, each 1.4 s per kilometer of track, for track points 5 m apart. If the line
/// of least curvature is too tight for the car, about 5 quadratic programs of the size of those in
/// FindMinimumCurvature are solved first. FindMinimumTime refuses a track that is too narrow or too
/// tight before any quadratic program for the lap time is solved.
MinimumTimeLine FindMinimumTime(const Track& track, double beside, const LapLimits& limits,
                                int iterations = 40);

struct MinimumTimeOptions {
  double margin = 0.5;  ///< Distance of the car's sides from the track's edges [m], >= 0.
  int iterations = 40;  ///< Maximum number of iterations, >= 1.
};
void Visit(KeyVisitor& keys, MinimumTimeOptions& options);

struct MinimumTimeDiagnostics {
  TrackPlanDiagnostics plan;
  double lap_time = 0.0;  ///< Lap time on the found line [s], see MinimumTimeLine::time.
  /// Lap time on the line of least curvature [s], see MinimumTimeLine::start_time.
  double minimum_curvature_lap_time = 0.0;
  std::string end;  ///< Reason why the search ended, as ToString(MinimumTimeEnd) returns it.
  int iterations = 0;
};
void Visit(DiagnosticsVisitor& out, const MinimumTimeDiagnostics& own);

/// Returns the planner `minimum_time`.
PlannerEntry MinimumTimePlanner();

}  // namespace trackbed
