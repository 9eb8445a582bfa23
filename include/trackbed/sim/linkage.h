#pragma once

#include <array>

#include "trackbed/vehicle/params.h"

namespace trackbed {

/// A steering linkage in MJCF: the front wheels' angles as polynomials of the rack angle,
///   <joint joint1="steer_fl" joint2="rack" polycoef="c_0 c_1 c_2 c_3 c_4"/>.
/// Used only by MuJoCo's viewer; Trackbed's plant uses the exact relation.
struct LinkagePolynomials {
  std::array<double, 5> left{};   ///< c_0 to c_4 [1], c_0 = 0 and c_1 = 1
  std::array<double, 5> right{};  ///< the mirror image: c_2 and c_4 with the opposite sign
  double error = 0.0;             ///< largest, over the steering range [rad]
};

/// The quartics that fit AckermannAngles over +- `steering_limit`: least squares on 200 Chebyshev
/// nodes, close to the minimax fit, with slope 1 at zero. InternalError unless wheelbase and
/// steering limit are above 0.
LinkagePolynomials FitLinkage(const VehicleParams& params);

}  // namespace trackbed
