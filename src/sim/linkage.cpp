#include "trackbed/sim/linkage.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "trackbed/core/error.h"

namespace trackbed {

LinkagePolynomials FitLinkage(const VehicleParams& params) {
  TRACKBED_CHECK(params.wheelbase > 0.0 && params.steering_limit > 0.0,
                 "a wheelbase of {} m and a steering limit of {} rad", params.wheelbase,
                 params.steering_limit);
  constexpr int kNodes = 200;
  Eigen::MatrixX3d powers(kNodes, 3);
  Eigen::VectorXd rest(kNodes);
  const auto node = [&](int i) {
    return params.steering_limit * std::cos(std::numbers::pi * (i + 0.5) / kNodes);
  };
  for (int i = 0; i < kNodes; ++i) {
    const double x = node(i);
    powers.row(i) << x * x, x * x * x, x * x * x * x;
    rest(i) = AckermannAngles(params, x).left - x;
  }
  const Eigen::Vector3d c = powers.colPivHouseholderQr().solve(rest);
  LinkagePolynomials fit{.left = {0.0, 1.0, c[0], c[1], c[2]},
                         .right = {0.0, 1.0, -c[0], c[1], -c[2]}};
  // The error of the steering polynomials is evaluated only at the nodes of the fit. The outermost
  // nodes of the fit are within 1e-4 of the ends of the steering range, where the error of the
  // polynomials is largest.
  fit.error = (powers * c - rest).cwiseAbs().maxCoeff();
  return fit;
}

}  // namespace trackbed
