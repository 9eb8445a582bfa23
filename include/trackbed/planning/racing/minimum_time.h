#pragma once

#include <string>

#include "trackbed/planning/common/limit_profile.h"
#include "trackbed/planning/common/planner.h"
#include "trackbed/planning/racing/track_line.h"
#include "trackbed/track/track.h"

/// Finds the line around a track with the shortest lap time at the car's limit.
///
/// Symbols: d(s) offset of the line from the center line over its station [m], with coefficients c;
/// b half of the car's width plus the margin [m]; T lap time of the limit profile
/// (LimitSpeedsAround) on the line [s].
///
///   minimize T(c)   subject to   right(s) + b <= d(s) <= left(s) - b,   |kappa| <= kappa_max
///
/// The solver is a trust-region method that starts at the line of least curvature. Each step
/// linearizes curvature and length of the line and the boundary of the g-g-v diagram about the last
/// line and its limit profile, and solves a quadratic program for changes of c and of the speeds at
/// all stations. The new line gets a new limit profile, and is kept only if it is faster. The
/// problem is that of Casanova 2000 and of Christ et al. 2021, but for a point mass with a g-g-v
/// diagram. The limit profile eliminates the speeds from the problem.
namespace trackbed {

/// The limits on the speed of a lap, on a level road with uniform friction.
struct LapLimits {
  GgvDiagram diagram;
  LimitOptions options{};
  double road = 1.0;           ///< Factor on the tyres' friction [1], > 0.
  double wheelbase = 0.0;      ///< Wheelbase L [m], for steering angles atan(L kappa).
  double steering_rate = 0.0;  ///< Largest steering rate [rad/s]; 0: no limit.
  double curvature_max = 0.0;  ///< Largest curvature kappa_max [1/m]; 0: no limit.
};

/// Returns the limits of a lap for a request that has PlanRequest::limits.
LapLimits LimitsOfLap(const PlanRequest& request);

/// Returns the lap time [s] of a line by its limit profile. The stations of the profile are a
/// quarter of the spacing of the track's points apart, at most 1.3 m. Throws PreconditionError if
/// the line folds back on itself.
double LapTime(const Track& track, const TrackLine& line, const LapLimits& limits);

enum class MinimumTimeEnd {
  /// The predicted gain of a step is at most 1e-4 of the lap time; or the predicted gain is at most
  /// 5e-4 of the lap time, and no part of the step makes the lap faster.
  kConverged,
  kNoGain,          ///< No step makes the lap faster, even with changes of only a millimeter.
  kIterationLimit,  ///< The maximum number of iterations is reached.
  kProgramNotSolved,
};
/// Returns the spelling of an end in plan.json: "converged", "no_gain", "iteration_limit",
/// "program_not_solved".
const char* ToString(MinimumTimeEnd end);

struct MinimumTimeLine {
  std::string refused;  ///< Reason why there is no line; else empty.
  TrackLine line;
  double time = 0.0;        ///< LapTime of the line [s].
  double start_time = 0.0;  ///< LapTime of the line of least curvature [s].
  /// Whether the line is faster than the line of least curvature; if not, the result is the line of
  /// least curvature.
  bool improved = false;
  MinimumTimeEnd end = MinimumTimeEnd::kConverged;
  int iterations = 0;      ///< Number of quadratic programs solved.
  double last_gain = 0.0;  ///< Gain of the last accepted step [s].
};

/// Finds the fastest line whose points stay at least b = `beside` [m] away from the edges. The
/// result has no line if the track is too narrow, if no line within kappa_max was found, or if the
/// car cannot keep moving.
///
/// Guarantees: by LapTime, the line is never slower than the line of least curvature for the same
/// b. The bounds are met to 1e-6 m at two points or more per knot. The same arguments give the same
/// bits on one machine. The line is a local minimum, because the problem is not convex. Slopes,
/// banks and changes of friction are ignored. Throws RunError in a build without IPOPT. Cost: 5 to
/// 20 programs, each 1.4 s per kilometer of points 5 m apart.
MinimumTimeLine FindMinimumTime(const Track& track, double beside, const LapLimits& limits,
                                int iterations = 40);

struct MinimumTimeOptions {
  double margin = 0.5;  ///< Distance of the car's sides from the edges [m], >= 0.
  int iterations = 40;  ///< Maximum number of iterations, >= 1.
};
void Visit(KeyVisitor& keys, MinimumTimeOptions& options);

struct MinimumTimeDiagnostics {
  TrackPlanDiagnostics plan;
  double lap_time = 0.0;  ///< Lap time of the line [s], see MinimumTimeLine::time.
  /// Lap time of the line of least curvature [s], see MinimumTimeLine::start_time.
  double minimum_curvature_lap_time = 0.0;
  std::string end;  ///< Name of MinimumTimeLine::end.
  int iterations = 0;
};
void Visit(DiagnosticsVisitor& out, const MinimumTimeDiagnostics& own);

/// Returns the planner `minimum_time`.
PlannerEntry MinimumTimePlanner();

}  // namespace trackbed
