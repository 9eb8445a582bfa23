#include "trackbed/core/error.h"
#include "trackbed/optimize/sparse_quadratic_program.h"

namespace trackbed {

SparseQuadraticSolution Solve(const SparseQuadraticProgram& /*program*/,
                              const Eigen::VectorXd& /*start*/) {
  throw RunError("this Trackbed was built without IPOPT (TRACKBED_IPOPT=OFF)");
}

}  // namespace trackbed
