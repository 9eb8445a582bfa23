#pragma once

#include <array>
#include <optional>
#include <string>

#include "trackbed/geometry/oriented_box.h"
#include "trackbed/geometry/pose.h"
#include "trackbed/vehicle/params.h"

/// A passive trailer with one axle, on a hitch behind the rear axle of a car.
///
/// Symbols: b distance of the hitch behind the car's rear axle [m], l distance from the hitch to
/// the trailer's axle [m], theta hitch angle: the trailer's yaw minus the car's yaw [rad], positive
/// if the trailer is turned to the left, v speed of the car's rear axle [m/s], kappa curvature of
/// the path of the car's rear axle [1/m]. In a steady left turn, the hitch angle is negative.
namespace trackbed {

/// The keys of vehicle.trailer in a scenario; a value that is not set follows from the car
/// (MakeTrailer).
struct TrailerOptions {
  std::optional<double> hitch{};         ///< Distance b of the hitch behind the rear axle [m].
  std::optional<double> hitch_height{};  ///< Height of the hitch above the ground [m].
  std::optional<double> tongue{};        ///< Distance l from the hitch to the trailer's axle [m].
  std::optional<double> track{};         ///< Distance between the trailer's wheels [m].
  std::optional<double> length{};        ///< Length of the trailer's body, without drawbar [m].
  std::optional<double> width{};         ///< Width of the trailer's body [m].
  std::optional<double> height{};        ///< Height of the trailer's top above the ground [m].
  /// Distance of the middle of the trailer's body ahead of the trailer's axle [m].
  std::optional<double> body_ahead{};
  std::optional<double> mass{};          ///< Mass with wheels [kg].
  std::optional<double> yaw_inertia{};   ///< Yaw inertia about the trailer's CG [kg m^2].
  std::optional<double> cg_ahead{};      ///< Distance of the trailer's CG ahead of its axle [m].
  std::optional<double> cg_height{};     ///< Height of the trailer's CG above the ground [m].
  std::optional<double> wheel_radius{};  ///< Radius of the trailer's wheels [m].
};

/// The complete parameters of a trailer; TrailerOptions describes each parameter.
struct TrailerParams {
  double hitch = 0.0;
  double hitch_height = 0.0;
  double tongue = 0.0;
  double track = 0.0;
  double length = 0.0;
  double width = 0.0;
  double height = 0.0;
  double body_ahead = 0.0;
  double mass = 0.0;
  double yaw_inertia = 0.0;
  double cg_ahead = 0.0;
  double cg_height = 0.0;
  double wheel_radius = 0.0;

  /// Share of the trailer's weight that rests on the hitch of a car on level ground [1]; negative
  /// if the trailer lifts the hitch.
  [[nodiscard]] double nose_share() const { return cg_ahead / tongue; }
  /// Distance from the hitch back to the front of the trailer's body [m].
  [[nodiscard]] double body_front() const { return tongue - body_ahead - 0.5 * length; }
};

/// Returns the parameters of a trailer as a list of numbers, in the order of TrailerParams.
std::array<double, 13> TrailerNumbers(const TrailerParams& trailer);
/// Returns the trailer with the given parameter values; the inverse of TrailerNumbers.
TrailerParams TrailerFromNumbers(const std::array<double, 13>& numbers);

/// Returns the trailer that a scenario describes. Defaults, with the car's wheelbase L and wheel
/// radius R: hitch 2 % of the car's length behind the car's rear end, hitch_height 1.2 R, tongue L,
/// and the track of the car's rear axle. The default body has 0.6 times the car's length, the car's
/// width, 0.8 times the car's height, and body_ahead 0. By default, the trailer's mass is 0.4 times
/// the car's mass, and its yaw inertia is that of a uniform box as large as the body. By default,
/// cg_ahead is 6 % of the tongue, cg_height is 1.75 times the car's wheel radius, and wheel_radius
/// is the car's wheel radius.
///
/// Throws InputError, with the key below vehicle.trailer and the allowed values, if the hitch is
/// not behind the car, or if the body reaches ahead of the hitch. Also throws InputError if the
/// trailer's center of gravity is at least as far from the axle as the hitch.
TrailerParams MakeTrailer(const TrailerOptions& options, const VehicleParams& car);

/// State of a trailer relative to the car.
struct TrailerState {
  double angle = 0.0;  ///< Hitch angle theta [rad].
  double rate = 0.0;   ///< Rate of the hitch angle [rad/s].
  double lean = 0.0;   ///< Angle between the trailer's z axis and the vertical [rad], >= 0.
};

/// Returns the pose of the middle of the trailer's axle, for a car with its rear axle at `car`.
Pose2 TrailerPose(const TrailerParams& trailer, const Pose2& car, double angle);

/// Returns the footprint of the body of a trailer whose axle is at `pose` (TrailerPose).
OrientedBox TrailerFootprint(const TrailerParams& trailer, const Pose2& pose);

/// Returns the trailer's body as a vehicle whose reference point is the middle of the trailer's
/// axle, for functions that need a footprint. Only the members name, length, width, height and
/// rear_overhang of the returned parameters are set.
VehicleParams TrailerBody(const TrailerParams& trailer);

/// Returns the smallest magnitude of the hitch angle at which body or drawbar of the trailer touch
/// the footprint of the car, seen from above [rad]; from 0 to pi. The drawbar is the segment from
/// the hitch to the front of the body.
double JackknifeAngle(const TrailerParams& trailer, const VehicleParams& car);

/// Returns the rate of the hitch angle theta = `angle` of a trailer whose wheels do not slip
/// [rad/s]:
///   theta' = -v sin(theta)/l - r (1 + b cos(theta)/l),
/// with the car's yaw rate r and rear-axle speed v, and the distances b and l from the hitch to the
/// car's rear axle and to the trailer's axle.
double RollingHitchRate(const TrailerParams& trailer, double angle, double speed, double yaw_rate);

/// Returns the hitch angle after the car's rear axle has moved by `distance` [m], negative in
/// reverse, on a path of constant curvature. The wheels do not slip. The returned hitch angle theta
/// is exact except for rounding errors: u = tan(theta/2) satisfies a Riccati equation with constant
/// coefficients. The returned hitch angle is continuous with `angle` if the hitch angle changes by
/// less than pi.
double RolledHitchAngle(const TrailerParams& trailer, double angle, double curvature,
                        double distance);

}  // namespace trackbed
