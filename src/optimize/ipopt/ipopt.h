#pragma once

#include "trackbed/optimize/sparse_quadratic_program.h"

namespace trackbed {

struct IpoptResult {
  bool solved = false;  ///< to its tolerance, as IPOPT says
  Eigen::VectorXd x;
  Eigen::VectorXd multipliers;
  int iterations = 0;
};

/// Solves a program that was checked, its matrices compressed. RunError in a build without IPOPT.
IpoptResult SolveByIpopt(const SparseQuadraticProgram& program, const Eigen::VectorXd& start,
                         InteriorSteps steps);

}  // namespace trackbed
