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
/// sweep of an arc [rad], and kappa the curvature of the arc [1/m]. The length S = v L kappa/omega
/// is an upper bound on a steering ramp from straight to the curvature kappa [m], because the
/// steering angle atan(L kappa) is at most L kappa.
///
/// An arc of a shortest curve counts as short if it has no room for its steering ramps. Instead of
/// a short arc of the angle phi, the car turns by phi on a gentler arc of the curvature kappa =
/// sqrt(omega phi/(4 L v)), with the steering rate omega, the wheelbase L and the speed v. The
/// gentler arc is four ramp lengths S long. If the angle phi of a short arc tends to zero, the
/// length and the curvature of the gentler arc tend to zero. Because gentler arcs vanish with their
/// angles, tiny turns from rounding errors have no effect, and need no threshold.
namespace trackbed {

/// Speeds and limits with which a car drives a curve between two poses.
struct CurveDrive {
  double speed = 0.0;         ///< Desired speed v on the curve [m/s], > 0.
  double min_speed = 0.0;     ///< Lowest speed at a step of curvature [m/s], > 0.
  double radius = 0.0;        ///< Radius of the arcs of shortest curves [m], > 0.
  double road = 1.0;          ///< Factor of the road on the tyres' friction, > 0.
  double start_speed = 0.0;   ///< Speed of a car that rolls at the start [m/s], >= 0.
  double deceleration = 1.0;  ///< Deceleration before the first steering ramp [m/s^2], > 0.
  PathBend before{};          ///< Curvature and direction of travel before the curve.
  PathBend after{};           ///< Curvature and direction of travel after the curve.
};

/// Returns whether an arc of the radius `drive.radius`, `length` m long, has room for its steering
/// ramps at the lower one of two speeds: StepSpeed and `drive.speed`.
bool HasRoomForRamps(const VehicleParams& vehicle, double length, const CurveDrive& drive);

/// Returns the path segments of the curve `word` from one pose to the other. If an arc at an end of
/// an arc-straight-arc curve is too short for its steering ramps, a gentler arc replaces it, with
/// straights on both sides for the ramps. The gentler arcs are made for the highest speed, up to
/// `drive.speed`, at which the pieces fit between the poses. The short arcs stay if the gentler
/// arcs do not fit, or if the car would have to pass the gentler arcs more slowly than the short
/// arcs. The returned segments end within 1e-9 m and 1e-9 rad of the pose `to` for distances up to
/// 1 km. Computing time: a microsecond if the curve fits at `drive.speed`.
std::vector<Segment> DrivablePieces(const VehicleParams& vehicle, const Pose2& from,
                                    const Pose2& to, const ShortestCurve& word,
                                    const CurveDrive& drive);

/// Returns the curvature and direction of travel at the beginning of a path along the curve `word`;
/// the curvature is 0 if the first arc is too short for its steering ramps.
PathBend FirstBend(const VehicleParams& vehicle, const ShortestCurve& word,
                   const CurveDrive& drive);

/// Appends pieces to the path. Joins neighboring pieces of the same curvature and direction, so
/// that ramps can use the length of both.
void AppendPieces(std::vector<Segment>& path, const std::vector<Segment>& pieces);

/// Returns the curvature and direction of travel at the end of the path.
PathBend LastBend(const std::vector<Segment>& path);

/// Returns whether a car that rolls at `request.start_speed` can follow the pieces of a path. The
/// pieces must begin with the present curvature `curvature` [1/m] of the car, and the car must be
/// able to slow down before each steering ramp.
bool CanStartRolling(const PlanRequest& request, double curvature,
                     const std::vector<Segment>& pieces, double min_speed);

}  // namespace trackbed
