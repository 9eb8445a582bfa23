#pragma once

#include <string>

#include "trackbed/planning/common/limit_profile.h"
#include "trackbed/planning/common/planner.h"
#include "trackbed/planning/racing/track_line.h"
#include "trackbed/track/track.h"

/// The line around a track with the shortest lap at the car's limit.
///
/// Symbols: d(s) offset of the line from the center line over its station [m], with coefficients c;
/// b half of the car's width and the margin together [m]; T lap time of the limit profile
/// (LimitSpeedsAround) along the line [s].
///
///   minimize T(c)   subject to   right(s) + b <= d(s) <= left(s) - b,   |kappa| <= kappa_max
///
/// A trust-region method that starts at the line of least curvature. Each step linearizes curvature
/// and length of the line and the boundary of the g-g-v diagram about the last line and its limit
/// profile, and solves a quadratic program for changes of c and of the speeds at all stations. The
/// new line gets a new limit profile, and is kept only if it is faster. The problem is that of
/// Casanova 2000 and of Christ et al. 2021 for a point mass with a g-g-v diagram, with the speeds
/// eliminated.
namespace trackbed {

/// The limits on the speed of a lap, on a level road with uniform friction.
struct LapLimits {
  GgvDiagram diagram;
  LimitOptions options{};
  double road = 1.0;           ///< factor on the tyres' friction [1], > 0
  double wheelbase = 0.0;      ///< L [m]; for steering angles atan(L kappa)
  double steering_rate = 0.0;  ///< the largest [rad/s]; 0: no limit
  double curvature_max = 0.0;  ///< kappa_max [1/m]; 0: no limit
};

/// The lap's limits in a request with limits.
LapLimits LimitsOfLap(const PlanRequest& request);

/// The lap time [s] of a line by its limit profile, over stations spaced at a quarter of the
/// spacing of the track's points, at most 1.3 m. PreconditionError if the line folds over.
double LapTime(const Track& track, const TrackLine& line, const LapLimits& limits);

enum class MinimumTimeEnd {
  /// No step promises more than 1e-4 of the lap time, or no part of a step that promises up to 5e-4
  /// gains anything.
  kConverged,
  kNoGain,          ///< no step is faster, down to changes of a millimeter
  kIterationLimit,  ///< the iterations are used up
  kProgramNotSolved,
};
/// "converged", "no_gain", "iteration_limit", "program_not_solved": the spelling of plan.json.
const char* ToString(MinimumTimeEnd end);

struct MinimumTimeLine {
  std::string refused;  ///< why there is no line; else empty
  TrackLine line;
  double time = 0.0;        ///< its LapTime [s]
  double start_time = 0.0;  ///< LapTime of the line of least curvature [s]
  bool improved = false;    ///< false: `line` is the line of least curvature
  MinimumTimeEnd end = MinimumTimeEnd::kConverged;
  int iterations = 0;      ///< number of quadratic programs solved
  double last_gain = 0.0;  ///< of the last accepted step [s]
};

/// The fastest line whose points stay at least `beside` [m], b, away from the edges. Refused if the
/// track is too narrow for that, if no line within kappa_max was found, or if the car cannot keep
/// moving.
///
/// Guarantees: by LapTime, never slower than the line of least curvature for the same b; bounds met
/// to 1e-6 m at two points or more per knot; the same arguments give the same bits on one machine.
/// A local minimum: the problem is not convex. Ignores slopes, banks and changes of friction.
/// RunError in a build without IPOPT. Cost: 5 to 20 programs, each 1.4 s per kilometer of points 5
/// m apart.
MinimumTimeLine FindMinimumTime(const Track& track, double beside, const LapLimits& limits,
                                int iterations = 40);

struct MinimumTimeOptions {
  double margin = 0.5;  ///< of the car's sides from the edges [m], >= 0
  int iterations = 40;  ///< at most, >= 1
};
void Visit(KeyVisitor& keys, MinimumTimeOptions& options);

struct MinimumTimeDiagnostics {
  TrackPlanDiagnostics plan;
  double lap_time = 0.0;                    ///< MinimumTimeLine::time [s]
  double minimum_curvature_lap_time = 0.0;  ///< MinimumTimeLine::start_time [s]
  std::string end;                          ///< MinimumTimeLine::end
  int iterations = 0;
};
void Visit(DiagnosticsVisitor& out, const MinimumTimeDiagnostics& own);

/// The planner `minimum_time`.
PlannerEntry MinimumTimePlanner();

}  // namespace trackbed
