#pragma once

#include <array>

#include "trackbed/vehicle/params.h"

namespace trackbed {

/// Approximation of a steering linkage for MJCF: the angles of the front wheels are polynomials of
/// the rack angle,
///   <joint joint1="steer_fl" joint2="rack" polycoef="c_0 c_1 c_2 c_3 c_4"/>.
/// Only MuJoCo's viewer uses these polynomials; Trackbed's plant uses the exact Ackermann angles.
struct LinkagePolynomials {
  std::array<double, 5> left{};   ///< Coefficients c_0 to c_4 of the left wheel, with c_0 = 0 and
                                  ///< c_1 = 1.
  std::array<double, 5> right{};  ///< Coefficients of the right wheel, whose c_2 and c_4 have the
                                  ///< opposite sign.
  double error = 0.0;             ///< Largest error of a wheel angle over the steering range [rad].
};

/// Fits polynomials of degree 4 to AckermannAngles, from -`steering_limit` to `steering_limit`,
/// with slope 1 at zero. The least-squares fit on 200 Chebyshev nodes is close to the minimax fit.
/// Throws InternalError unless wheelbase and steering limit are above 0.
LinkagePolynomials FitLinkage(const VehicleParams& params);

}  // namespace trackbed
