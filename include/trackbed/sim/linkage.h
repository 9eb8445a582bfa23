#pragma once

#include <array>

#include "trackbed/vehicle/params.h"

namespace trackbed {

/// Approximates a steering linkage in MJCF by polynomials that compute the angles of the front
/// wheels from the rack angle:
///   <joint joint1="steer_fl" joint2="rack" polycoef="c_0 c_1 c_2 c_3 c_4"/>.
/// Only MuJoCo's viewer uses the polynomials of the linkage; Trackbed's plant uses the exact
/// Ackermann angles.
struct LinkagePolynomials {
  /// Polynomial coefficients c_0 to c_4 for the left wheel, with c_0 = 0 and c_1 = 1.
  std::array<double, 5> left{};
  /// Polynomial coefficients for the right wheel, equal to those of the left wheel but with the
  /// opposite sign of c_2 and c_4.
  std::array<double, 5> right{};
  double error = 0.0;  ///< Largest error of a wheel angle over the whole steering range [rad].
};

/// Fits polynomials of degree 4 to AckermannAngles, from -`steering_limit` to `steering_limit`,
/// with slope 1 at zero. The polynomials are fitted by least squares on 200 Chebyshev nodes, which
/// is close to a minimax fit. Throws InternalError unless the wheelbase and the steering limit are
/// above 0.
LinkagePolynomials FitLinkage(const VehicleParams& params);

}  // namespace trackbed
