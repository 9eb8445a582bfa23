#pragma once

#include "trackbed/optimize/sparse_quadratic_program.h"

namespace trackbed {

struct IpoptResult {
  bool solved = false;  ///< whether IPOPT has solved the quadratic program to its tolerance
  Eigen::VectorXd x;
  Eigen::VectorXd multipliers;
  int iterations = 0;
};

/// Solves a quadratic program with IPOPT. The caller must have checked the program, and the sparse
/// matrices of the program must be compressed. Throws RunError in a build without IPOPT.
IpoptResult SolveByIpopt(const SparseQuadraticProgram& program, const Eigen::VectorXd& start,
                         InteriorSteps steps);

}  // namespace trackbed
