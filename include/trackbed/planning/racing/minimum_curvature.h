#pragma once

#include <string>

#include "trackbed/planning/common/planner.h"
#include "trackbed/planning/racing/track_line.h"
#include "trackbed/track/track.h"

/// The line of least curvature around a track, for the highest speed through all bends together.
///
/// Symbols: d(s) offset of the line from the center line over its station [m]; kappa, l curvature
/// and length of the line; b half of the car's width and the margin together [m].
///
///   minimize  integral of kappa^2 dl   subject to  right(s) + b <= d(s) <= left(s) - b
///
/// d is a closed spline with as many knots as the track has points. Each step replaces
/// kappa sqrt(dl/ds) by its linearization about the last line, exact in d, d' and d''
/// (Gauss-Newton), and solves the quadratic program for d. Braghin et al. 2008 minimize curvature
/// in this way; Heilmeier et al. 2020 repeat the linearization.
namespace trackbed {

struct MinimumCurvatureOptions {
  double margin = 0.5;  ///< of the car's sides from the edges [m], >= 0
};
void Visit(KeyVisitor& keys, MinimumCurvatureOptions& options);

struct MinimumCurvatureLine {
  std::string refused;  ///< why there is no line; else empty
  TrackLine line;
  int iterations = 0;  ///< number of quadratic programs solved
};

/// The line whose points stay at least `beside` [m], b, away from the edges. Refused if the track
/// is too narrow for that.
///
/// Guarantees: the bounds are met to 1e-6 m at two points per knot; the last step changed the
/// integral by a fraction of less than 1e-6. A local minimum: the problem is not convex. The rear
/// axle follows the line: in bends, a front corner of the car is farther out than its side at the
/// rear axle, by about l^2/(2 r), with l the distance from the rear axle to the front, and r the
/// radius. RunError in a build without IPOPT. Cost: 0.6 s per kilometer of points 5 m apart.
MinimumCurvatureLine FindMinimumCurvature(const Track& track, double beside);

struct MinimumCurvatureDiagnostics {
  TrackPlanDiagnostics plan;
  int iterations = 0;
  double center_curvature_square = 0.0;  ///< LineFindings of the center line [1/m]
};
void Visit(DiagnosticsVisitor& out, const MinimumCurvatureDiagnostics& own);

/// The planner `minimum_curvature`.
PlannerEntry MinimumCurvaturePlanner();

}  // namespace trackbed
