#pragma once

#include <Eigen/Core>
#include <optional>

#include "trackbed/planning/common/plan.h"
#include "trackbed/track/closed_spline.h"
#include "trackbed/track/track.h"

/// Closed lines on a track, described by their offset from the center line, and plans along such
/// lines.
///
/// Symbols: s station along the center line [m], kappa_c(s) its curvature; d(s) offset of the line
/// [m], positive to the left.
namespace trackbed {

/// The offset d and its derivatives d' and d'' at one station.
struct LineOffset {
  double d = 0.0;      ///< Offset [m].
  double slope = 0.0;  ///< Slope dd/ds.
  double bend = 0.0;   ///< Second derivative d^2d/ds^2 [1/m].
};

/// A closed line on a track. The default is the center line.
class TrackLine {
 public:
  TrackLine() = default;
  /// Makes a line whose offset d is a closed spline over the station. The matrix of coefficients
  /// has one column; the period of the basis is the length of the track.
  TrackLine(const ClosedSplineBasis& basis, Eigen::MatrixXd coefficients);

  [[nodiscard]] LineOffset At(double s) const;
  /// Returns the coefficients of the spline; empty for the center line.
  [[nodiscard]] const Eigen::MatrixXd& coefficients() const { return coefficients_; }

 private:
  std::optional<ClosedSplineBasis> basis_;
  Eigen::MatrixXd coefficients_;
};

/// Measures of a closed line over one lap.
struct LineFindings {
  double length = 0.0;            ///< Length of the line [m].
  double curvature_square = 0.0;  ///< Integral of kappa^2 over the line [1/m].
  double radius_min = 0.0;        ///< Radius of the tightest bend [m].
};
LineFindings MeasureLine(const Track& track, const TrackLine& line);

/// Diagnostics of a plan on a track, for plan.json.
struct TrackPlanDiagnostics {
  double track_length = 0.0;   ///< Length of the center line [m].
  double smoothing = 0.0;      ///< Wavelength below which the center line is smoothed [m].
  double deviation_max = 0.0;  ///< Largest displacement of a track point by smoothing [m].
  double deviation_rms = 0.0;  ///< Root mean square displacement of all track points [m].
  double join = 0.0;           ///< Distance over which the car joins the line [m].
  double run_out = 0.0;        ///< Braking distance beyond the finish line [m].
  LineFindings lap;            ///< Measures of the line over one lap.
};
void Visit(DiagnosticsVisitor& out, const TrackPlanDiagnostics& own);

/// Plans laps along a line. The plan leads from the car onto the line, TrackLaps::laps times around
/// the track, and beyond the finish line by the braking distance from the mission's speed.
///
/// The car may start anywhere on the track, facing along the track. A car up to half a lap before
/// the start line first drives to the start line; a car on or beyond the start line begins in its
/// first lap. A polynomial of degree 5 reduces the car's offset from the line to 0. The length of
/// this polynomial is the largest of three values, but at most half a lap: the distance of three
/// seconds at the mission's speed, ten times the offset, and four wheelbases.
///
/// Guarantees: the curvature is continuous. Obstacles are ignored. The plan is rejected, with a
/// reason, if there is no track, or if the car is off the track or faces across the track. Cost: 50
/// us per meter.
Plan FollowLine(const PlanRequest& request, const TrackLine& line);

}  // namespace trackbed
