#pragma once

#include <Eigen/Core>

#include "trackbed/optimize/smooth_program.h"

/// Computes the ends of paths of many short clothoids, with derivatives.
namespace trackbed {

/// A path of clothoids, with the smallest radius as the unit of length.
struct LinearParts {
  Eigen::VectorXd curvatures;  // Curvatures between the clothoids and at both ends.
  Eigen::VectorXd lengths;
};

/// The end point of a path of clothoids that begins at the origin along x. The derivatives of the
/// end point are by the curvatures, then by the lengths.
struct PartsEnd {
  Eigen::Vector3d end;  // x, y and yaw
  SmoothValues::Rows rows;
};

/// Returns the end point of a path of clothoids. The displacement of each part is an integral by
/// Gaussian quadrature.
PartsEnd EndOf(const LinearParts& parts);

}  // namespace trackbed
