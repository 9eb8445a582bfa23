#include "src/optimize/ipopt/ipopt.h"
#include "trackbed/core/error.h"

namespace trackbed {

IpoptResult SolveByIpopt(const SparseQuadraticProgram& /*program*/,
                         const Eigen::VectorXd& /*start*/, InteriorSteps /*steps*/) {
  throw RunError("this Trackbed was built without IPOPT (TRACKBED_IPOPT=OFF)");
}

}  // namespace trackbed
