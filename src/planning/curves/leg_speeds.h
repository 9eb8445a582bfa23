#pragma once

#include <vector>

#include "trackbed/path/path.h"
#include "trackbed/path/reference.h"
#include "trackbed/vehicle/params.h"

/// Speeds along the turns of a leg of continuous curvature.
///
/// Symbols: kappa is the curvature [1/m], sigma its change per length [1/m^2], L the wheelbase, and
/// v the speed. The steering angle atan(L kappa) changes at the rate v L sigma/(1 + (L kappa)^2).
namespace trackbed {

/// Limits on the motion along a leg.
struct LegLimits {
  SpeedLimits speed;           ///< Speed on straights; acceleration, deceleration.
  double steering_rate = 1.0;  ///< Largest steering rate of the plan [rad/s].
  double lateral = 1.0;        ///< Largest lateral acceleration v^2 kappa [m/s^2].
  double wheelbase = 1.0;      ///< L [m].
};

/// A piece of a leg with one speed limit.
struct LegPiece {
  double length = 0.0;  // Length of the piece [m].
  double speed = 0.0;   // Largest speed [m/s], at most LegLimits::speed.
  bool stops = false;   // Whether the car changes its direction of motion before the piece.
};

/// Returns the largest magnitude of the curvature at the ends of segments [1/m].
double SharpestCurvature(const std::vector<Segment>& segments);

/// Splits segments into pieces, each clothoid into `parts` of equal length. The speed of a piece is
/// the largest that keeps the limits at its ends, but at least `least`.
std::vector<LegPiece> LegPieces(const LegLimits& limits, const std::vector<Segment>& segments,
                                double least, int parts = 8);

/// Returns a lower bound of the time in which the car drives the pieces of segments (LegPieces with
/// any number of parts), without the time to speed up and to brake [s].
double LeastLegTime(const LegLimits& limits, const std::vector<Segment>& segments, double least);

/// Returns the driving time of pieces from the speed `start` to the speed `end` [s]. The car speeds
/// up and brakes at the limits, and stops at changes of direction.
double LegTime(const LegLimits& limits, const std::vector<LegPiece>& pieces, double start,
               double end);

}  // namespace trackbed
