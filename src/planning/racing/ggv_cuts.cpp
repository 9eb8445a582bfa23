#include "src/planning/racing/ggv_cuts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace trackbed {

GgvCut TyreCut(const LapLimits& limits, double squared, double angle, GgvSide side) {
  // Step of the finite difference with respect to the sine of the angle.
  constexpr double kStep = 1e-3;
  const GgvDiagram& diagram = limits.diagram;
  GgvPoint point{.speed = std::sqrt(squared), .road = limits.road};
  const double lateral = diagram.MaxLateral(point);
  const double sign = side == GgvSide::kDriving ? 1.0 : -1.0;
  const auto force_at = [&](double sine) {
    point.lateral = lateral * std::sqrt(1.0 - sine * sine);
    const TyreRange range = diagram.TyresAt(point);
    return sign * (side == GgvSide::kDriving ? range.driving : range.braking);
  };
  const double sine = std::sin(angle);
  const double below = std::max(0.0, sine - kStep);
  const double above = std::min(1.0, sine + kStep);
  // At the angle q, the boundary (f_y, f_x) = (lateral cos q, F(sin q)) has the normal vector (F'
  // cos q, lateral sin q). F is the longitudinal force, and `lateral` the maximum of f_y.
  const double rise = std::max(0.0, (force_at(above) - force_at(below)) / (above - below));
  double across = rise * std::cos(angle);
  double along = lateral * sine;
  const double size = std::hypot(across, along);
  if (size <= 1e-9 * lateral) {
    across = 1.0;  // at a corner of the boundary, the inequality only limits f_y to its maximum
    along = 0.0;
  } else {
    across /= size;
    along /= size;
  }
  const LongitudinalForces& car = diagram.forces();
  const double resistance = car.drag * squared / car.mass;
  // Rewrite the inequality for the acceleration a, using f_x = a + resistance.
  return {.across = across,
          .along = sign * along,
          .bound =
              limits.options.share * (across * lateral * std::cos(angle) + along * force_at(sine)) -
              sign * along * resistance};
}

double TyreCurvature(const LapLimits& limits, double squared, double angle, GgvSide side) {
  // Step of the angle parameter [rad] along the boundary, which consists of elliptic arcs.
  constexpr double kAngleStep = 0.05;
  const double from = std::max(0.0, angle - kAngleStep);
  const double to = std::min(0.5 * std::numbers::pi, angle + kAngleStep);
  const GgvCut a = TyreCut(limits, squared, from, side);
  const GgvCut b = TyreCut(limits, squared, to, side);
  // The curvature of the boundary is the angle between the two tangents, divided by the length of
  // the boundary between the tangent points.
  const double sign = side == GgvSide::kDriving ? 1.0 : -1.0;
  GgvPoint point{.speed = std::sqrt(squared), .road = limits.road};
  const double lateral = limits.diagram.MaxLateral(point);
  const auto along_at = [&](double at) {
    point.lateral = lateral * std::cos(at);
    const TyreRange range = limits.diagram.TyresAt(point);
    return sign * (side == GgvSide::kDriving ? range.driving : range.braking);
  };
  const double length = limits.options.share * std::hypot(lateral * (std::cos(to) - std::cos(from)),
                                                          along_at(to) - along_at(from));
  const double turned = std::atan2(sign * b.along, b.across) - std::atan2(sign * a.along, a.across);
  return std::clamp(turned / std::max(length, 1e-3), 0.0, 1.0);
}

GgvCut ForceCut(const LapLimits& limits, double squared, GgvSide side) {
  const LongitudinalForces& car = limits.diagram.forces();
  const double against = car.rolling_resistance + car.drag * squared;
  if (side == GgvSide::kDriving) {
    return {
        .along = 1.0,
        .bound = (limits.options.share * limits.diagram.DriveForce(std::sqrt(squared)) - against) /
                 car.rolling_mass};
  }
  const double brakes =
      car.brake_force > 0.0 ? car.brake_force : std::numeric_limits<double>::infinity();
  return {.along = -1.0, .bound = (limits.options.share * brakes + against) / car.rolling_mass};
}

}  // namespace trackbed
