#pragma once

#include <algorithm>
#include <cmath>

#include "trackbed/path/path.h"
#include "trackbed/vehicle/params.h"

/// Computes the steering that a path demands from a car, for each short piece of the path.
namespace trackbed {

/// A short piece of a path, and its largest steering demands.
struct PathPiece {
  Stations stations;
  double curvature = 0.0;  ///< Largest curvature |kappa| on the piece [1/m].
  /// Largest slope |d delta/ds| of the steering angle on the piece, apart from steps of curvature
  /// [rad/m].
  double slope = 0.0;
};

/// Returns the derivative of the steering angle by the station, |d delta/ds| = L |kappa'|/(1 + (L
/// kappa)^2) [rad/m].
double SteeringSlope(const VehicleParams& vehicle, double curvature, double sharpness);

/// Divides each segment of the path into equal pieces of at most `spacing` [m], and calls `call`
/// for each piece. A segment shorter than `spacing` forms a single piece.
template <typename Call>
void ForEachPiece(const Path& path, const VehicleParams& vehicle, double spacing,
                  const Call& call) {
  double start = 0.0;
  for (const Segment& segment : path.segments()) {
    const auto count = static_cast<long>(std::ceil(segment.length / spacing));
    for (long i = 0; i < count; ++i) {
      const double from = segment.length * static_cast<double>(i) / static_cast<double>(count);
      const double to = segment.length * static_cast<double>(i + 1) / static_cast<double>(count);
      PathPiece piece{{start + from, start + to}};
      const auto take = [&](double d) {
        const double curvature = segment.CurvatureAt(d);
        piece.curvature = std::max(piece.curvature, std::abs(curvature));
        piece.slope = std::max(
            piece.slope,
            SteeringSlope(vehicle, curvature, segment.sharpness + d * segment.sharpness_rate));
      };
      take(from);
      take(to);
      const double vertex = -segment.sharpness / segment.sharpness_rate;
      if (vertex > from && vertex < to) {
        take(vertex);
      }
      call(piece);
    }
    start += segment.length;
  }
}

}  // namespace trackbed
