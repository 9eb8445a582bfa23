#pragma once

#include <optional>

#include "trackbed/path/path.h"

/// Converts the pose and motion of a car to path coordinates (the Frenet frame of a path) and back.
///
/// Symbols: r(s), theta_r, kappa_r and kappa_r' are the point, yaw, curvature and sharpness of the
/// path at station s; n is the left normal of the path; x and theta are the position and yaw of the
/// car; d = (x - r(s)) n is the lateral offset [m], positive to the left; d' = dd/ds and d'' =
/// d^2d/ds^2; s_t and s_tt are the time derivatives of s; Dtheta = theta - theta_r; v, a and kappa
/// are the speed, acceleration and curvature of the car's motion. The conversion formulas are
/// (Werling et al. 2010):
///   x = r + d n                            d' = (1 - kappa_r d) tan Dtheta
///   v = s_t (1 - kappa_r d)/cos Dtheta
///   d'' = -(kappa_r' d + kappa_r d') tan Dtheta
///         + (1 - kappa_r d)/cos^2 Dtheta (kappa (1 - kappa_r d)/cos Dtheta - kappa_r)
///   a = s_tt (1 - kappa_r d)/cos Dtheta + s_t^2/cos Dtheta
///       [(1 - kappa_r d) tan Dtheta (kappa (1 - kappa_r d)/cos Dtheta - kappa_r)
///        - (kappa_r' d + kappa_r d')].
/// The derivatives d' and d'' with respect to the station are also defined
/// at standstill. The time derivatives of the lateral offset d are d_t = d' s_t and d_tt = d''
/// s_t^2 + d' s_tt.
namespace trackbed {

/// The state of a car in path coordinates.
struct FrenetState {
  double s = 0.0;               ///< Station [m].
  double s_rate = 0.0;          ///< Time derivative s_t of the station [m/s].
  double s_acceleration = 0.0;  ///< Second time derivative s_tt of the station [m/s^2].
  /// Lateral offset of the car from the path [m], positive to the left.
  double d = 0.0;
  /// Derivative d' of the lateral offset with respect to the station.
  double d_slope = 0.0;
  /// Second derivative d'' of the lateral offset with respect to the station [1/m].
  double d_bend = 0.0;

  /// Returns the time derivatives of the lateral offset, d_t [m/s] and d_tt [m/s^2].
  [[nodiscard]] double d_rate() const { return d_slope * s_rate; }
  [[nodiscard]] double d_acceleration() const {
    return d_bend * s_rate * s_rate + d_slope * s_acceleration;
  }

  bool operator==(const FrenetState&) const = default;
};

/// The motion of a car's rear-axle center in the world.
struct MotionState {
  Pose2 pose;
  /// Curvature kappa of the car's motion, as determined by the steering [1/m].
  double curvature = 0.0;
  double speed = 0.0;         ///< Speed v [m/s].
  double acceleration = 0.0;  ///< Acceleration a of the car along its heading [m/s^2].

  bool operator==(const MotionState&) const = default;
};

/// Returns the path coordinates of a car, relative to the point of the path nearest to the car,
/// within the given stations. Returns nullopt if the Frenet frame is undefined at the car's pose.
/// The Frenet frame is undefined if the car is at or beyond the path's center of curvature (1 -
/// kappa_r d <= 0). The Frenet frame is also undefined if the car faces across or against the path
/// (|Dtheta| >= 90 degrees). The Frenet frame is also undefined if the car drives backwards at the
/// nearest point of the path. The conversion to path coordinates takes as long as Path::Project.
std::optional<FrenetState> ToFrenet(const Path& path, const MotionState& motion,
                                    Stations within = {});

/// Converts path coordinates to the motion of a car; the inverse of ToFrenet. Returns nullopt if 1
/// - kappa_r d <= 0, or if the car drives backwards on the path. The returned yaw is not wrapped
/// and differs from the path's yaw by less than 90 degrees. The error of a conversion to path
/// coordinates and back is at most 1e-9 if the path's curvature is continuous. On lines and arcs, a
/// conversion to path coordinates and back has only a rounding error.
///
/// To plan motions, use a path with continuous curvature. Where the path's curvature jumps, the
/// heading of the converted motion jumps unless the lateral offset d or its derivative d' is 0.
/// Where the path's sharpness jumps, the curvature of the motion jumps.
std::optional<MotionState> FromFrenet(const Path& path, const FrenetState& state);

/// Works like FromFrenet above, for callers that have already computed the path's point at
/// `state.s`.
std::optional<MotionState> FromFrenet(const PathPoint& at, const FrenetState& state);

}  // namespace trackbed
