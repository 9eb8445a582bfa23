#pragma once

#include <Eigen/Core>
#include <optional>

#include "trackbed/planning/common/plan.h"
#include "trackbed/track/closed_spline.h"
#include "trackbed/track/track.h"

/// Closed lines on a track, given by their offset from its center line, and plans along them.
///
/// Symbols: s station along the center line [m], kappa_c(s) its curvature; d(s) offset of the line
/// [m], positive to the left.
namespace trackbed {

/// d, d' and d'' at one station.
struct LineOffset {
  double d = 0.0;      ///< [m]
  double slope = 0.0;  ///< dd/ds
  double bend = 0.0;   ///< d^2d/ds^2 [1/m]
};

/// A closed line on a track. The default is the center line.
class TrackLine {
 public:
  TrackLine() = default;
  /// d as a closed spline over the station: one column of coefficients, with the track's period.
  TrackLine(const ClosedSplineBasis& basis, Eigen::MatrixXd coefficients);

  [[nodiscard]] LineOffset At(double s) const;
  /// Empty for the center line.
  [[nodiscard]] const Eigen::MatrixXd& coefficients() const { return coefficients_; }

 private:
  std::optional<ClosedSplineBasis> basis_;
  Eigen::MatrixXd coefficients_;
};

/// Measures of a closed line, once around.
struct LineFindings {
  double length = 0.0;            ///< [m]
  double curvature_square = 0.0;  ///< integral of kappa^2 over the line [1/m]
  double radius_min = 0.0;        ///< of its tightest bend [m]
};
LineFindings MeasureLine(const Track& track, const TrackLine& line);

/// Diagnostics of a plan on a track, for plan.json.
struct TrackPlanDiagnostics {
  double track_length = 0.0;   ///< of the center line [m]
  double smoothing = 0.0;      ///< wavelength below which the center line was smoothed [m]
  double deviation_max = 0.0;  ///< largest displacement of a track point by smoothing [m]
  double deviation_rms = 0.0;  ///< root mean square displacement of all points [m]
  double join = 0.0;           ///< distance over which the car joins the line [m]
  double run_out = 0.0;        ///< braking distance behind the finish line [m]
  LineFindings lap;            ///< of the line, once around
};
void Visit(DiagnosticsVisitor& out, const TrackPlanDiagnostics& own);

/// A plan along a line: from the car onto the line, TrackLaps::laps times around, and beyond the
/// finish line as far as the car needs to brake from the mission's speed.
///
/// The car may start anywhere on the track, facing along it. A car up to half a lap before the
/// start line first drives up to it; a car on or after the start line begins in its first lap. A
/// polynomial of degree 5 removes the offset from the line over the longest of three seconds at the
/// mission's speed, ten times the offset and four wheelbases, but at most half a lap.
///
/// Guarantees: continuous curvature. Ignores obstacles. Refused, with a reason, without a track,
/// and if the car is off the track or faces across it. Cost: 50 us per meter.
Plan FollowLine(const PlanRequest& request, const TrackLine& line);

}  // namespace trackbed
