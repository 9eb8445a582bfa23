#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "trackbed/path/path.h"
#include "trackbed/vehicle/params.h"

/// Computes the steering that a path demands from a car, for each short piece of the path.
///
/// The steering angle delta(kappa, v) is that of the car on its tyres in a steady turn with the
/// path's curvature kappa and the speed v (SteeringInBend). Along the path, the steering angle
/// delta changes with the curvature and with the speed.
namespace trackbed {

/// Curvature of a path at a station.
struct Bend {
  double curvature = 0.0;  ///< Curvature kappa [1/m].
  double sharpness = 0.0;  ///< Derivative of the curvature by the station [1/m^2].
};

/// A short piece of a path, and its curvature.
struct PathPiece {
  Stations stations;
  double curvature = 0.0;  ///< Largest curvature |kappa| on the piece of the path [1/m].
  int direction = 1;       ///< Direction of travel: 1 forwards, -1 backwards.
  /// Curvatures of the path at both ends of the piece and at an extremum of the curvature within
  /// the piece, if any.
  std::array<Bend, 3> samples{};
  std::size_t count = 0;  ///< Number of curvature samples of the piece, 2 or 3.

  [[nodiscard]] std::span<const Bend> bends() const { return {samples.data(), count}; }
};

/// Speed of a car on a piece of a path.
struct PieceSpeed {
  double speed = 0.0;         ///< Magnitude of the speed v [m/s], >= 0.
  double acceleration = 0.0;  ///< Rate of change of the speed v [m/s^2].
  int direction = 1;          ///< Direction of travel: 1 forwards, -1 backwards.
  double road = 1.0;          ///< Factor of the road on the tyres' friction [1], > 0.
};

/// Returns the derivative of a kinematic car's steering angle by the station, |d delta/ds| = L
/// |kappa'|/(1 + (L kappa)^2) [rad/m].
double SteeringSlope(const VehicleParams& vehicle, const Bend& bend);

/// Returns the largest steering rate |d delta/dt| [rad/s] that the car needs in any of the `bends`.
/// The returned steering rate is the larger one of the rates with and without tyre slip.
double SteeringRateOn(const VehicleParams& vehicle, std::span<const Bend> bends,
                      const PieceSpeed& speed);

/// Returns a speed of at most `at.speed` with which the car needs at most the steering rate `rate`
/// [rad/s] in all of the `bends`. Returns infinity (no speed limit is needed) if the steering rate
/// that the car needs at `at.speed` is at most `rate`. For an understeering car, the required
/// steering rate increases with the speed, so the returned speed is the largest possible one, to
/// nine digits. Besides the speed, the argument `at` contains the acceleration of the car and the
/// friction of the road. The value 0 of `rate` means that the steering rate is not limited.
double SpeedForSteeringRate(const VehicleParams& vehicle, std::span<const Bend> bends, double rate,
                            const PieceSpeed& at);

/// Divides each segment of the path into equal pieces of at most `spacing` [m], and calls `call`
/// for each piece. A segment shorter than `spacing` forms a single piece.
template <typename Call>
void ForEachPiece(const Path& path, double spacing, const Call& call) {
  double start = 0.0;
  for (const Segment& segment : path.segments()) {
    const auto count = static_cast<long>(std::ceil(segment.length / spacing));
    for (long i = 0; i < count; ++i) {
      const double from = segment.length * static_cast<double>(i) / static_cast<double>(count);
      const double to = segment.length * static_cast<double>(i + 1) / static_cast<double>(count);
      PathPiece piece{.stations = {start + from, start + to}, .direction = segment.direction};
      const auto take = [&](double d) {
        const double curvature = segment.CurvatureAt(d);
        piece.curvature = std::max(piece.curvature, std::abs(curvature));
        piece.samples[piece.count++] = {curvature, segment.sharpness + d * segment.sharpness_rate};
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
