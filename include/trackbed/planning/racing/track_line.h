#pragma once

#include <Eigen/Core>
#include <optional>

#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/common/planner.h"
#include "trackbed/track/closed_spline.h"
#include "trackbed/track/track.h"

/// Describes closed lines on a track by their offset from the track's center line, and plans laps
/// along such lines.
///
/// Symbols: s is the station along the track's center line [m], and kappa_c(s) the curvature of the
/// center line. The offset of a line from the center line [m], positive to the left, is d(s).
namespace trackbed {

/// The offset d of a line and the derivatives d' and d'' at one station.
struct LineOffset {
  double d = 0.0;      ///< Offset d of the line from the center line [m].
  double slope = 0.0;  ///< First derivative d' = dd/ds of the offset.
  double bend = 0.0;   ///< Second derivative d'' = d^2d/ds^2 of the offset [1/m].
};

/// A closed line on a track. A default-constructed TrackLine is the center line.
class TrackLine {
 public:
  TrackLine() = default;
  /// Makes a line whose offset d is a closed spline as a function of the station. The matrix
  /// `coefficients` must have one column, and the period of `basis` must be the length of the
  /// track.
  TrackLine(const ClosedSplineBasis& basis, Eigen::MatrixXd coefficients);

  [[nodiscard]] LineOffset At(double s) const;
  /// Returns the coefficients of the offset spline; empty for the center line.
  [[nodiscard]] const Eigen::MatrixXd& coefficients() const { return coefficients_; }

 private:
  std::optional<ClosedSplineBasis> basis_;
  Eigen::MatrixXd coefficients_;
};

/// Length, curvature and tightest bend of a closed line.
struct LineFindings {
  double length = 0.0;  ///< Length of the closed line [m].
  /// Integral of the squared curvature kappa^2 over the length of the line [1/m].
  double curvature_square = 0.0;
  double radius_min = 0.0;  ///< Radius of the line's tightest bend [m].
};
LineFindings MeasureLine(const Track& track, const TrackLine& line);

/// Diagnostics of a plan on a track, for plan.json.
struct TrackPlanDiagnostics {
  double track_length = 0.0;   ///< Length of the track's center line [m].
  double smoothing = 0.0;      ///< Wavelength below which the track's center line is smoothed [m].
  double deviation_max = 0.0;  ///< Largest distance by which smoothing moved a track point [m].
  /// Root mean square of the distances by which smoothing moved the track points [m].
  double deviation_rms = 0.0;
  double join = 0.0;  ///< Distance over which the car moves from its start onto the line [m].
  /// Distance that the plan continues beyond the finish line, for braking [m].
  double run_out = 0.0;
  LineFindings lap;  ///< Length, curvature and tightest bend of the line.
};
void Visit(DiagnosticsVisitor& out, const TrackPlanDiagnostics& own);

/// Plans laps along a line on the track. The plan leads from the car onto the line, and
/// TrackLaps::laps times around the track. The plan continues beyond the finish line by the
/// distance that the car needs to brake from the mission's speed.
///
/// The car may start anywhere on the track, facing along the track. A car that starts up to half a
/// lap before the start line first drives to the start line. A car that starts on or beyond the
/// start line begins its first lap at once. From its start, the car approaches the line along a
/// polynomial of degree 5, which reduces the car's offset from the line to 0. The car's approach to
/// the line is at most half a lap long. Up to half a lap, the length of the approach is the largest
/// of three values: the distance that the car drives in three seconds at the mission's speed, ten
/// times the offset, and four wheelbases. If a car that starts rolling cannot steer fast enough on
/// the approach to the line, FollowLine plans a longer approach.
///
/// Guarantees: the curvature of the planned path is continuous. The planned path ignores obstacles.
/// The plan is rejected, with a reason, if there is no track, or if the car is off the track or
/// faces across the track. Computing time: 50 us per meter of path.
Plan FollowLine(const PlanRequest& request, const TrackLine& line);

/// Returns the curvature [1/m] of a path that begins at the car's pose and keeps the car's offset
/// and angle from the center line. The planners on tracks use StartCurvatureOnTrack as
/// PlannerEntry::start_curvature. Returns nullopt if there is no track, or if the car does not face
/// along the track.
std::optional<double> StartCurvatureOnTrack(const PlannerOptions& options, const RouteStart& route);

}  // namespace trackbed
