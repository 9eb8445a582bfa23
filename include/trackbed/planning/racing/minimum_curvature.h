#pragma once

#include <string>

#include "trackbed/planning/common/planner.h"
#include "trackbed/planning/racing/track_line.h"
#include "trackbed/track/track.h"

/// Finds the line of least curvature around a track; this line permits high speeds in all bends.
///
/// Symbols: d(s) is the offset of the line from the track's center line at the station s [m]; kappa
/// is the curvature of the line, and l the length along the line; b is half of the car's width plus
/// the margin [m]. The line of least curvature, between the track edges right(s) and left(s),
/// solves this problem:
///
///   minimize  integral of kappa^2 dl   subject to  right(s) + b <= d(s) <= left(s) - b
///
/// The offset d of the line is a closed spline with as many knots as the track has points. The line
/// of least curvature is found iteratively (Gauss-Newton). Each step linearizes the root kappa
/// sqrt(dl/ds) of the integrand about the last line, with the exact derivatives by d, d' and d'',
/// and then solves a quadratic program for d. Braghin et al. 2008 minimize the curvature by one
/// quadratic program; Heilmeier et al. 2020 repeat the linearization.
namespace trackbed {

struct MinimumCurvatureOptions {
  double margin = 0.5;  ///< Distance of the car's sides from the track's edges [m], >= 0.
};
void Visit(KeyVisitor& keys, MinimumCurvatureOptions& options);

struct MinimumCurvatureLine {
  std::string refused;  ///< Reason why no line was found; else empty.
  TrackLine line;
  int iterations = 0;  ///< Number of quadratic programs that the search solved.
  /// Upper limit of the distance b of lines from the track's edges [m]: lines exist only for
  /// smaller b. The upper limit is b plus half of the smallest distance between the bounds of the
  /// offset.
  double room = 0.0;
};

/// Finds the line of least curvature that stays at least b = `beside` [m] away from the track's
/// edges. If the track is too narrow, the result contains no line, and `refused` names the
/// narrowest place.
///
/// Guarantees: at two points per knot, the line keeps the distance b from the edges, to within 1e-6
/// m. The last iteration changed the integral of the squared curvature kappa^2 by a fraction of
/// less than 1e-6. The minimization of the curvature is not convex, so that the line is only a
/// local minimum. The car's rear axle follows the line. Because the rear axle follows the line, a
/// front corner of the car is farther out in a bend of radius r than the car's side at the rear
/// axle. The difference is about l_f^2/(2 r), with the distance l_f from the rear axle to the car's
/// front [m]. Throws RunError if the program was built without IPOPT. Computing time: 0.6 s per
/// kilometer of track, for track points 5 m apart.
MinimumCurvatureLine FindMinimumCurvature(const Track& track, double beside);

struct MinimumCurvatureDiagnostics {
  TrackPlanDiagnostics plan;
  int iterations = 0;
  /// Integral of kappa^2 over the length of the center line [1/m], see
  /// LineFindings::curvature_square.
  double center_curvature_square = 0.0;
};
void Visit(DiagnosticsVisitor& out, const MinimumCurvatureDiagnostics& own);

/// Returns the planner `minimum_curvature`.
PlannerEntry MinimumCurvaturePlanner();

}  // namespace trackbed
