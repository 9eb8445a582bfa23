#pragma once

#include <optional>

#include "trackbed/vehicle/params.h"

/// Radii of turns that leave room for the steering ramps on their legs (Skackauskas, dissertation,
/// eqs. (C.34) and (C.40)). The comments use the symbols of fillet.h.
namespace trackbed {

/// A closed interval of radii [m].
struct RadiusInterval {
  double low = 0.0;
  double high = 0.0;
};

/// A closed interval of speeds [m/s].
struct SpeedInterval {
  double low = 0.0;
  double high = 0.0;
};

/// Returns g(r) [m], which is <= 0 if the radius r leaves room for the steering ramps (eq. (C.40),
/// see SteeringRoomRadii).
double SteeringRoom(const VehicleParams& vehicle, double speed, double interior_angle,
                    double shorter_leg, double neutral, double radius);

/// Returns the radius r within `bounds` that leaves most room for the steering ramps, at the
/// minimum of g(r) in eq. (C.40) [m]. The function g(r) decreases below the returned radius and
/// increases above it.
double RoomiestRadius(const VehicleParams& vehicle, double speed, double interior_angle,
                      double neutral, RadiusInterval bounds);

/// Returns the least part of a leg that eq. (C.40) reserves for a turn at `speed`, over all radii
/// within `bounds` [m]. LeastSteeringRoom assumes that the wheels are straight between turns.
double LeastSteeringRoom(const VehicleParams& vehicle, double speed, double interior_angle,
                         RadiusInterval bounds);

/// Returns the radii within `bounds` that leave room for the steering ramps (eq. (C.40)); nullopt
/// if no radius does. Eq. (C.40) is equivalent to g(r) = r/tan(phi/2) + v/omega_delta |atan(L/r) -
/// n| - q_S/2 <= 0, with the interior angle phi, the steering rate omega_delta and the shorter leg
/// q_S. The argument `neutral` is the neutral steering angle n = sgn(h) d_0 [rad], positive toward
/// the turn. With growing radius r, g(r) first decreases and then increases, so that the returned
/// radii form one interval. The ends of the returned interval are accurate to the last few bits.
std::optional<RadiusInterval> SteeringRoomRadii(const VehicleParams& vehicle, double speed,
                                                double interior_angle, double shorter_leg,
                                                RadiusInterval bounds, double neutral = 0.0);

/// Returns the highest speed within `speeds` at which a radius within `bounds` leaves room for the
/// steering ramps (eq. (C.40)); nullopt if there is no such speed.
std::optional<double> SteeringRoomSpeed(const VehicleParams& vehicle, double interior_angle,
                                        double shorter_leg, RadiusInterval bounds,
                                        SpeedInterval speeds, double neutral = 0.0);

/// Returns the radii r within `bounds` with which turns do not overlap: r/tan(phi/2) <= q_S/2 (eq.
/// (C.34)), with the interior angle phi and the shorter leg q_S; nullopt if there are none.
std::optional<RadiusInterval> HalfLegRadii(double interior_angle, double shorter_leg,
                                           RadiusInterval bounds);

}  // namespace trackbed
