#pragma once

#include <optional>

#include "trackbed/path/path.h"

/// The Frenet frame of a path: conversion of a car's pose and motion to path coordinates and back.
///
/// Symbols: r(s), theta_r, kappa_r, kappa_r' point, yaw, curvature and sharpness of the path at
/// station s; n its left normal; d = (x - r(s)) n lateral offset [m], positive to the left; d' =
/// dd/ds and d'' = d^2d/ds^2; s_t, s_tt derivatives of s by time; Dtheta = theta - theta_r; v, a,
/// kappa speed, acceleration and curvature of the car's motion.
///   x = r + d n                            d' = (1 - kappa_r d) tan Dtheta
///   v = s_t (1 - kappa_r d)/cos Dtheta
///   d'' = -(kappa_r' d + kappa_r d') tan Dtheta
///         + (1 - kappa_r d)/cos^2 Dtheta (kappa (1 - kappa_r d)/cos Dtheta - kappa_r)
///   a = s_tt (1 - kappa_r d)/cos Dtheta + s_t^2/cos Dtheta
///       [(1 - kappa_r d) tan Dtheta (kappa (1 - kappa_r d)/cos Dtheta - kappa_r)
/// (Werling et al. 2010). The derivatives d' and d'' by s are also defined at standstill. The
/// derivatives by time are d_t = d' s_t and d_tt = d'' s_t^2 + d' s_tt.
namespace trackbed {

/// The state of a car in path coordinates.
struct FrenetState {
  double s = 0.0;               ///< Station [m].
  double s_rate = 0.0;          ///< Rate of the station, s_t [m/s].
  double s_acceleration = 0.0;  ///< Acceleration of the station, s_tt [m/s^2].
  double d = 0.0;               ///< Lateral offset [m], positive left of the path.
  double d_slope = 0.0;         ///< Slope d' of the offset over the station.
  double d_bend = 0.0;          ///< Second derivative d'' of the offset over the station [1/m].

  /// The derivatives of the offset by time, d_t [m/s] and d_tt [m/s^2].
  [[nodiscard]] double d_rate() const { return d_slope * s_rate; }
  [[nodiscard]] double d_acceleration() const {
    return d_bend * s_rate * s_rate + d_slope * s_acceleration;
  }

  bool operator==(const FrenetState&) const = default;
};

/// The motion of a car's rear-axle center in the world.
struct MotionState {
  Pose2 pose;
  double curvature = 0.0;     ///< Curvature kappa of the steering [1/m].
  double speed = 0.0;         ///< Speed v [m/s].
  double acceleration = 0.0;  ///< Acceleration a along the heading [m/s^2].

  bool operator==(const MotionState&) const = default;
};

/// Returns the path coordinates of a car, relative to the nearest point of the path within the
/// stations; nullopt if the frame is undefined. The frame is undefined if the car is at or beyond
/// the path's center of curvature (1 - kappa_r d <= 0), or faces across or against the path
/// (|Dtheta| >= 90 degrees). The frame is also undefined if the path is driven backwards at the
/// nearest point. Cost: that of Path::Project.
std::optional<FrenetState> ToFrenet(const Path& path, const MotionState& motion,
                                    Stations within = {});

/// Computes the inverse of ToFrenet. Returns nullopt if 1 - kappa_r d <= 0 or the path is driven
/// backwards. The yaw of the result is continuous with the path's yaw and is not wrapped.
/// Conversion to path coordinates and back is exact to 1e-9 if the path's curvature is continuous,
/// and to rounding for lines and arcs.
///
/// For motions, use a path with continuous curvature: a jump of the path's curvature makes the
/// heading jump unless d or d' is 0, and a jump of the path's sharpness makes the curvature jump.
std::optional<MotionState> FromFrenet(const Path& path, const FrenetState& state);

/// As FromFrenet above, with the path's point at `state.s` already evaluated.
std::optional<MotionState> FromFrenet(const PathPoint& at, const FrenetState& state);

}  // namespace trackbed
