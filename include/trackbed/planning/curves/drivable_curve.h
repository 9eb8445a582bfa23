#pragma once

#include <optional>
#include <vector>

#include "trackbed/path/path.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/curves/shortest_curve.h"
#include "trackbed/vehicle/params.h"

/// Curves between poses whose arcs are long enough for the ramps of the steering
/// (curvature_steps.h).
///
/// Symbols: v is the speed [m/s], L the wheelbase [m], omega the steering rate [rad/s], phi the
/// sweep of an arc [rad], and kappa the curvature of the arc [1/m]. S = v L kappa/omega is an upper
/// bound on the length of a ramp from straight to kappa [m], since atan(L kappa) <= L kappa.
///
/// An arc of a shortest curve is short if it has no room for its ramps. Instead of a short arc, the
/// car turns by the same angle phi on an arc of the smaller curvature kappa = sqrt(omega phi/(4 L
/// v)), whose length is 4 S. If the sweep phi tends to zero, the length and the curvature of the
/// replacing arc tend to zero. Tiny turns that are due to rounding errors thus have no effect, and
/// need no threshold.
namespace trackbed {

/// States how the car drives a curve between two poses.
struct CurveDrive {
  double speed = 0.0;         ///< Wanted speed v [m/s], > 0.
  double min_speed = 0.0;     ///< Lowest speed at a step of curvature [m/s], > 0.
  double radius = 0.0;        ///< Radius of the arcs of shortest curves [m], > 0.
  double road = 1.0;          ///< Factor on the tyres' friction, > 0.
  double start_speed = 0.0;   ///< Speed of a car that rolls at the start [m/s], >= 0.
  double deceleration = 1.0;  ///< Deceleration before the first ramp [m/s^2], > 0.
  PathBend before{};          ///< Curvature and direction of the path before the curve.
  PathBend after{};           ///< Curvature and direction of the path after the curve.
};

/// Returns whether an arc of the radius `drive.radius`, `length` m long, has room for its ramps at
/// the speed of StepSpeed, or at `drive.speed` if that is lower.
bool HasRoomForRamps(const VehicleParams& vehicle, double length, const CurveDrive& drive);

/// Returns the path pieces of the curve `word`, which leads from one pose to the other. If a short
/// arc begins or ends a word of the form arc-straight-arc, gentler arcs replace the short ones,
/// with straights on both sides for the ramps. The gentler arcs are made for the highest speed, up
/// to `drive.speed`, at which the pieces fit between the poses. The short arcs stay if the gentler
/// arcs do not fit, or if the car would have to pass the gentler arcs more slowly than the short
/// arcs. The pieces end within 1e-9 m and rad of `to` for distances up to 1 km. Computing time: a
/// microsecond if the curve fits at `drive.speed`.
std::vector<Segment> DrivablePieces(const VehicleParams& vehicle, const Pose2& from,
                                    const Pose2& to, const ShortestCurve& word,
                                    const CurveDrive& drive);

/// Returns the curvature and direction at the beginning of a path along `word`; the curvature is 0
/// if the first arc is short.
PathBend FirstBend(const VehicleParams& vehicle, const ShortestCurve& word,
                   const CurveDrive& drive);

/// Appends pieces to the path. Joins neighboring pieces of the same curvature and direction, so
/// that ramps can use the length of both.
void AppendPieces(std::vector<Segment>& path, const std::vector<Segment>& pieces);

/// Returns the curvature and direction at the end of the path.
PathBend LastBend(const std::vector<Segment>& path);

/// Returns whether the car can follow the pieces from `request.start_speed` with wheels that are
/// set for `curvature` [1/m]: whether the pieces begin with this curvature and the car can slow
/// down before each ramp.
bool CanStartRolling(const PlanRequest& request, double curvature,
                     const std::vector<Segment>& pieces, double min_speed);

}  // namespace trackbed
