#pragma once

#include <array>

#include "trackbed/vehicle/params.h"

namespace trackbed {

/// A steering linkage in MJCF: the front wheels' angles as polynomials of the rack angle,
///   <joint joint1="steer_fl" joint2="rack" polycoef="c_0 c_1 c_2 c_3 c_4"/>.
/// Only MuJoCo's viewer uses these polynomials; Trackbed's plant uses the exact relation.
struct LinkagePolynomials {
  std::array<double, 5> left{};   ///< Coefficients c_0 to c_4 [1], c_0 = 0 and c_1 = 1.
  std::array<double, 5> right{};  ///< Mirror image: c_2 and c_4 with the opposite sign.
  double error = 0.0;             ///< Largest error over the steering range [rad].
};

/// Fits quartics to AckermannAngles over +- `steering_limit`, with slope 1 at zero. The fit uses
/// least squares on 200 Chebyshev nodes, which is close to the minimax fit. InternalError unless
/// wheelbase and steering limit are above 0.
LinkagePolynomials FitLinkage(const VehicleParams& params);

}  // namespace trackbed
