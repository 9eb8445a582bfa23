#pragma once

#include <string>

#include "trackbed/planning/common/planner.h"
#include "trackbed/planning/racing/track_line.h"
#include "trackbed/track/track.h"

/// Finds the line of least curvature around a track, which permits high speeds through all bends
/// together.
///
/// Symbols: d(s) offset of the line from the center line over its station [m]; kappa, l curvature
/// and length of the line; b half of the car's width plus the margin [m].
///
///   minimize  integral of kappa^2 dl   subject to  right(s) + b <= d(s) <= left(s) - b
///
/// The offset d is a closed spline with as many knots as the track has points. Each step linearizes
/// kappa sqrt(dl/ds) about the last line, with the exact derivatives with respect to d, d' and d''
/// (Gauss-Newton). Each step then solves the quadratic program for d. Braghin et al. 2008 minimize
/// curvature by a quadratic program; Heilmeier et al. 2020 repeat the linearization.
namespace trackbed {

struct MinimumCurvatureOptions {
  double margin = 0.5;  ///< Distance of the car's sides from the edges [m], >= 0.
};
void Visit(KeyVisitor& keys, MinimumCurvatureOptions& options);

struct MinimumCurvatureLine {
  std::string refused;  ///< Reason why there is no line; else empty.
  TrackLine line;
  int iterations = 0;  ///< Number of quadratic programs solved.
};

/// Finds the line of least curvature whose points stay at least b = `beside` [m] away from the
/// edges. The result has no line if the track is too narrow.
///
/// Guarantees: the bounds are met to 1e-6 m at two points per knot; the last step changed the
/// integral of kappa^2 by a fraction of less than 1e-6. The line is a local minimum, because the
/// problem is not convex. The rear axle follows the line. In bends of radius r, a front corner of
/// the car is therefore farther out than the side at the rear axle, by about l^2/(2 r). Here, l is
/// the distance from the rear axle to the car's front [m]. Throws RunError in a build without
/// IPOPT. Cost: 0.6 s per kilometer of points 5 m apart.
MinimumCurvatureLine FindMinimumCurvature(const Track& track, double beside);

struct MinimumCurvatureDiagnostics {
  TrackPlanDiagnostics plan;
  int iterations = 0;
  /// Integral of kappa^2 over the center line [1/m], see LineFindings::curvature_square.
  double center_curvature_square = 0.0;
};
void Visit(DiagnosticsVisitor& out, const MinimumCurvatureDiagnostics& own);

/// Returns the planner `minimum_curvature`.
PlannerEntry MinimumCurvaturePlanner();

}  // namespace trackbed
