#pragma once

#include <vector>

#include "trackbed/planning/curves/shortest_curve.h"

/// Computes short paths between two poses, without obstacles, of a car whose wheels take time to
/// turn. The curvature is continuous and changes by at most sigma per length (Fraichard and Scheuer
/// 2004, Banzhaf et al. 2017).
///
/// Symbols: kappa is the curvature [1/m], positive to the left, at most 1/r in magnitude; sigma the
/// largest sharpness, the change of curvature per length [1/m^2]. For a car with the wheelbase L
/// and the steering rate omega at the speed v, the sharpness sigma = omega/(L v) keeps the steering
/// rate below omega.
///
/// A turn consists of a clothoid from the present curvature to 1/r, an arc of the smallest radius
/// r, and a clothoid to the curvature 0. All turns to one side from the same state end, with
/// curvature 0, on one circle of a radius R larger than the smallest radius r. Turns are joined by
/// straights, or directly where the end circles (radius R) of two turns touch. A turn that is too
/// short to reach the curvature 1/r consists of two clothoids with a smaller peak curvature.
namespace trackbed {

/// A pose of the car and the curvature of its path at this pose.
struct CurveState {
  Pose2 pose;
  double curvature = 0.0;  ///< Curvature kappa [1/m].
};

/// Limits on a curve of continuous curvature.
struct CurveLimits {
  double radius = 1.0;     ///< Smallest radius r [m], > 0.
  double sharpness = 1.0;  ///< Largest sharpness sigma (curvature per length) [1/m^2], > 0.
};

/// The circle on which all turns to one side end if they begin in the same state of curvature 0.
/// All lengths in TurnCircle are in units of the smallest radius r.
struct TurnCircle {
  double sharpness = 1.0;  ///< Largest sharpness in units of 1/r^2, equal to sigma r^2.
  double least = 0.0;      ///< Heading change on a clothoid between the curvatures 0 and 1/r [rad].
  /// Distance of the circle's center from the start of the turn, along the start's heading.
  double along = 0.0;
  /// Distance of the circle's center from the start of the turn, across the start's heading.
  double across = 1.0;
};

/// The curves of continuous curvature between two states, for given limits.
///
/// Guarantees, for distances up to 1e3 r: the curve starts with the pose and curvature of the state
/// `from`. The curve ends within 1e-9 m and 1e-9 rad of the state `to`. Except for rounding errors,
/// the curvature never exceeds 1/r for the smallest radius r, and the sharpness never exceeds its
/// limit sigma. For mirrored states, the result is the mirrored curve. Curves of continuous
/// curvature are at least as long as Dubins and Reeds-Shepp curves of the same radius. They
/// approach the lengths of Dubins and Reeds-Shepp curves as the largest sharpness sigma grows. The
/// returned curve is the shortest among the tested families of words (sequences of turns and
/// straights), but not always the shortest possible curve of continuous curvature.
///
/// All functions throw PreconditionError if a pose is not finite, or if the magnitude of a
/// curvature is above 1/r by more than rounding errors.
class ContinuousCurves {
 public:
  /// Throws InternalError unless the radius and the sharpness are positive and finite.
  explicit ContinuousCurves(const CurveLimits& limits);

  /// Returns the shortest curve for a car that only drives forwards (CC-Dubins). At least one
  /// CC-Dubins curve exists for any two states.
  [[nodiscard]] ShortestCurve Dubins(const CurveState& from, const CurveState& to) const;

  /// Returns the shortest CC-Dubins curve for each word (sequence of turns such as "L+S+R+",
  /// CurveWord), shortest curve first. Given a length `longest` [m], leaves out curves that are not
  /// shorter.
  [[nodiscard]] std::vector<ShortestCurve> DubinsWords(const CurveState& from,
                                                       const CurveState& to) const;
  [[nodiscard]] std::vector<ShortestCurve> DubinsWords(const CurveState& from, const CurveState& to,
                                                       double longest) const;

  /// Returns the shortest curve for a car that drives forwards and backwards, with continuous
  /// curvature also at cusps (CC-Reeds-Shepp). The CC-Reeds-Shepp curve is never longer than the
  /// curve that Dubins returns.
  [[nodiscard]] ShortestCurve ReedsShepp(const CurveState& from, const CurveState& to) const;
  [[nodiscard]] std::vector<ShortestCurve> ReedsSheppWords(const CurveState& from,
                                                           const CurveState& to) const;
  [[nodiscard]] std::vector<ShortestCurve> ReedsSheppWords(const CurveState& from,
                                                           const CurveState& to,
                                                           double longest) const;

  /// Returns the shortest curve for a car that drives forwards and backwards, and whose curvature
  /// may step at a cusp, where the car stands (HC-Reeds-Shepp). If the curve has a cusp right at
  /// its start or end, and the given state at this end has the full curvature 1/r, the curvature
  /// steps at this state. The HC-Reeds-Shepp curve is never longer than the curve that ReedsShepp
  /// returns. If no curve with curvature steps is shorter, HybridReedsShepp returns the same curve
  /// as ReedsShepp.
  ///
  /// Between two poses closer than 1e-9 m with full curvatures 1/r of opposite signs, the curve may
  /// be longer than necessary, or end with the curvature of `from`.
  [[nodiscard]] ShortestCurve HybridReedsShepp(const CurveState& from, const CurveState& to) const;
  /// Returns only the Reeds-Shepp curves whose curvature steps at all cusps. ReedsSheppWords
  /// returns the Reeds-Shepp curves without curvature steps.
  [[nodiscard]] std::vector<ShortestCurve> HybridReedsSheppWords(const CurveState& from,
                                                                 const CurveState& to) const;
  [[nodiscard]] std::vector<ShortestCurve> HybridReedsSheppWords(const CurveState& from,
                                                                 const CurveState& to,
                                                                 double longest) const;

  [[nodiscard]] const CurveLimits& limits() const { return limits_; }

 private:
  CurveLimits limits_;
  TurnCircle circle_;
};

}  // namespace trackbed
