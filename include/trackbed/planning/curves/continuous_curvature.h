#pragma once

#include <vector>

#include "trackbed/planning/curves/shortest_curve.h"

/// Computes short paths between two poses, without obstacles, of a car whose wheels take time to
/// turn. The curvature is continuous and changes by at most sigma per length (Fraichard and Scheuer
/// 2004, Banzhaf et al. 2017).
///
/// Symbols: kappa is the curvature [1/m], positive to the left, at most 1/r in magnitude; sigma the
/// largest sharpness, the change of curvature per length [1/m^2]. For a car with the wheelbase L
/// and the steering rate omega at the speed v, sigma = omega/(L v) keeps the steering rate below
/// omega.
///
/// A turn consists of a clothoid from the present curvature to 1/r, an arc of the radius r, and a
/// clothoid to the curvature 0. All turns to one side from the same state end on one circle of
/// radius R > r, where the curvature is 0. Turns are joined by straights, or directly where two
/// circles of radius R touch. A turn that is too short for the curvature 1/r has two clothoids with
/// a smaller peak curvature.
namespace trackbed {

/// A pose of the car and the curvature of its path at this pose.
struct CurveState {
  Pose2 pose;
  double curvature = 0.0;  ///< Curvature kappa [1/m].
};

/// Limits on a curve of continuous curvature.
struct CurveLimits {
  double radius = 1.0;     ///< Smallest radius r [m], > 0.
  double sharpness = 1.0;  ///< Largest sharpness sigma [1/m^2], > 0.
};

/// The circle on which all turns to one side end if they begin in the same state of curvature 0.
/// The lengths of the circle are in units of the smallest radius r.
struct TurnCircle {
  double sharpness = 1.0;  ///< Largest sharpness, sigma r^2.
  double least = 0.0;      ///< Deflection of a clothoid between the curvatures 0 and 1/r [rad].
  double along = 0.0;      ///< Distance of the center from the start, along the start's heading.
  double across = 1.0;     ///< Distance of the center from the start, across the start's heading.
};

/// The curves of continuous curvature between two states, for given limits.
///
/// Guarantees, for distances up to 1e3 r: the curve starts with the pose and curvature of the state
/// `from`. The curve ends within 1e-9 m and 1e-9 rad of the state `to`. The curvature never exceeds
/// 1/r, and the sharpness never exceeds sigma, except for rounding errors. For mirrored states, the
/// result is the mirrored curve. The curves are at least as long as Dubins and Reeds-Shepp curves
/// of radius r, and approach the lengths of these curves as sigma grows. The curve is the shortest
/// among the tested families of words, but not always the shortest possible curve of continuous
/// curvature.
///
/// All functions throw PreconditionError if a pose is not finite, or if the magnitude of a
/// curvature is above 1/r by more than rounding errors.
class ContinuousCurves {
 public:
  /// Throws InternalError unless the radius and the sharpness are positive and finite.
  explicit ContinuousCurves(const CurveLimits& limits);

  /// Returns the shortest word for a car that only drives forwards (CC-Dubins). At least one word
  /// exists for any two states.
  [[nodiscard]] ShortestCurve Dubins(const CurveState& from, const CurveState& to) const;

  /// Returns the words of a car that only drives forwards, shortest first: the shortest curve of
  /// each spelling (CurveWord).
  [[nodiscard]] std::vector<ShortestCurve> DubinsWords(const CurveState& from,
                                                       const CurveState& to) const;

  /// Returns the shortest word for a car that drives forwards and backwards, with continuous
  /// curvature also at cusps (CC-Reeds-Shepp). The curve is never longer than the curve that Dubins
  /// returns.
  [[nodiscard]] ShortestCurve ReedsShepp(const CurveState& from, const CurveState& to) const;
  [[nodiscard]] std::vector<ShortestCurve> ReedsSheppWords(const CurveState& from,
                                                           const CurveState& to) const;

  /// Returns the shortest word for a car that drives forwards and backwards, and whose curvature
  /// may step at a cusp, where the car stands (HC-Reeds-Shepp). If the curve has a cusp right at
  /// its start or end, and the state there has the full curvature 1/r, the curvature steps at this
  /// state. The curve is never longer than the curve that ReedsShepp returns. If no word with
  /// curvature steps is shorter, HybridReedsShepp returns the same curve as ReedsShepp.
  [[nodiscard]] ShortestCurve HybridReedsShepp(const CurveState& from, const CurveState& to) const;
  /// Returns only the Reeds-Shepp words whose curvature steps at all cusps. ReedsSheppWords returns
  /// the words without curvature steps.
  [[nodiscard]] std::vector<ShortestCurve> HybridReedsSheppWords(const CurveState& from,
                                                                 const CurveState& to) const;

  [[nodiscard]] const CurveLimits& limits() const { return limits_; }

 private:
  CurveLimits limits_;
  TurnCircle circle_;
};

}  // namespace trackbed
