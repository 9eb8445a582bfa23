#include "trackbed/path/frenet_frame.h"

#include <cmath>

namespace trackbed {
namespace {

/// Terms shared by the transformations to and from the Frenet frame.
struct Frame {
  double narrow;   // Factor 1 - kappa_r d; d: offset from a path of curvature kappa_r.
  double tangent;  // Tangent of the heading difference Dtheta of car and path.
  double cosine;   // Cosine of the heading difference Dtheta of car and path.
  double drift;    // Derivative of kappa_r d with respect to the station s.

  Frame(const PathPoint& at, double d, double slope)
      : narrow(1.0 - at.curvature * d),
        tangent(slope / narrow),
        cosine(1.0 / std::sqrt(1.0 + tangent * tangent)),
        drift(at.sharpness * d + at.curvature * slope) {}

  /// Returns the derivative of the heading difference Dtheta between car and path with respect to
  /// the station s: kappa (1 - kappa_r d)/cos Dtheta - kappa_r, with the car's curvature kappa.
  [[nodiscard]] double Turning(const PathPoint& at, double curvature) const {
    return curvature * narrow / cosine - at.curvature;
  }
  /// Returns the factor of the squared speed s_t^2 along the path in the formula of the car's
  /// acceleration.
  [[nodiscard]] double Added(double turning) const {
    return (narrow * tangent * turning - drift) / cosine;
  }
};

}  // namespace

std::optional<FrenetState> ToFrenet(const Path& path, const MotionState& motion, Stations within) {
  const Projection projection = path.Project(motion.pose, within);
  const PathPoint at = path.At(projection.s);
  const double d = projection.cross_track;
  const double narrow = 1.0 - at.curvature * d;
  const double cosine = std::cos(projection.heading_error);
  if (!(narrow > 0.0) || !(cosine > 0.0) || at.direction != 1) {
    return std::nullopt;
  }
  const double slope = narrow * std::tan(projection.heading_error);
  const Frame frame(at, d, slope);
  const double turning = frame.Turning(at, motion.curvature);
  const double rate = motion.speed * frame.cosine / narrow;
  return FrenetState{
      projection.s,
      rate,
      (motion.acceleration - rate * rate * frame.Added(turning)) * frame.cosine / narrow,
      d,
      slope,
      -frame.drift * frame.tangent + narrow / (frame.cosine * frame.cosine) * turning};
}

std::optional<MotionState> FromFrenet(const PathPoint& at, const FrenetState& state) {
  const Frame frame(at, state.d, state.d_slope);
  if (!(frame.narrow > 0.0) || at.direction != 1) {
    return std::nullopt;
  }
  const double turning =
      (state.d_bend + frame.drift * frame.tangent) * frame.cosine * frame.cosine / frame.narrow;
  const Vec2 position = at.pose.position() + state.d * LeftNormal(Direction(at.pose.yaw));
  return MotionState{{position.x(), position.y(), at.pose.yaw + std::atan(frame.tangent)},
                     (turning + at.curvature) * frame.cosine / frame.narrow,
                     state.s_rate * frame.narrow / frame.cosine,
                     state.s_acceleration * frame.narrow / frame.cosine +
                         state.s_rate * state.s_rate * frame.Added(turning)};
}

std::optional<MotionState> FromFrenet(const Path& path, const FrenetState& state) {
  return FromFrenet(path.At(state.s), state);
}

}  // namespace trackbed
