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
  /// d as a closed spline over the station; one column of coefficients, the period is that of the
  /// track.
  TrackLine(const ClosedSplineBasis& basis, Eigen::MatrixXd coefficients);

  [[nodiscard]] LineOffset At(double s) const;
  /// Empty for the center line.
  [[nodiscard]] const Eigen::MatrixXd& coefficients() const { return coefficients_; }

 private:
  std::optional<ClosedSplineBasis> basis_;
  Eigen::MatrixXd coefficients_;
};

/// A closed line, once around.
struct LineFindings {
  double length = 0.0;            ///< [m]
  double curvature_square = 0.0;  ///< integral of kappa^2 over the line [1/m]
  double radius_min = 0.0;        ///< of its tightest bend [m]
};
LineFindings MeasureLine(const Track& track, const TrackLine& line);

/// What plan.json says of a plan on a track.
struct TrackPlanDiagnostics {
  double track_length = 0.0;   ///< of the center line [m]
  double smoothing = 0.0;      ///< wavelength below which the center line was smoothed [m]
  double deviation_max = 0.0;  ///< by which that moved a point of the track [m]
  double deviation_rms = 0.0;  ///< likewise, of all points [m]
  double join = 0.0;           ///< distance in which the car comes onto the line [m]
  double run_out = 0.0;        ///< to brake in, behind the finish line [m]
  LineFindings lap;            ///< of the line, once around
};
void Visit(DiagnosticsVisitor& out, const TrackPlanDiagnostics& own);

/// A plan along a line: from the car onto the line, TrackLaps::laps times around, and so far beyond
/// the line that the car can brake from the mission's speed.
///
/// The car may start anywhere on the track, and looks along it. Up to half a lap before the start
/// line it first drives up to it; a car that starts on the line or after it does so in its first
/// lap. Its offset from the line is taken back by a polynomial of degree 5 over three seconds at
/// the mission's speed, ten times the offset or four wheelbases, whichever is the longest, at most
/// half a lap.
///
/// Guarantees: continuous curvature. Does not look for obstacles. Refused, with a reason, without a
/// track and where the car is off the track or looks across it. Cost: 50 us a meter.
Plan FollowLine(const PlanRequest& request, const TrackLine& line);

}  // namespace trackbed
