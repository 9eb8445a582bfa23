#pragma once

#include <Eigen/Core>
#include <functional>

/// Finds local minima of smooth functions of a few dozen variables:
///   minimize f(x)  subject to  c(x) = 0,  d(x) <= 0  and  lower <= x <= upper
namespace trackbed {

/// The functions of a smooth program at one point, with their derivatives.
struct SmoothValues {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  double objective = 0.0;    ///< Objective f(x).
  Eigen::VectorXd gradient;  ///< Derivatives of f by x.
  Eigen::VectorXd equal;     ///< Equality constraints c(x).
  Rows equal_rows;  ///< Derivatives of the equality constraints c by x, one row per constraint.
  Eigen::VectorXd at_most_0;  ///< Inequality constraints d(x).
  /// Derivatives of the inequality constraints d by x, one row per constraint.
  Rows at_most_0_rows;
};

/// A smooth program. Variables and constraints should be of the order of 1.
struct SmoothProgram {
  Eigen::VectorXd lower;  ///< Lower bounds of the variables, finite.
  Eigen::VectorXd upper;  ///< Upper bounds of the variables, finite, >= `lower`.
  Eigen::VectorXd start;  ///< Initial point of the search, clamped to the bounds.
  Eigen::Index equal_count = 0;
  Eigen::Index at_most_0_count = 0;
  /// Function that computes all members of `values`, which initially have the right sizes and
  /// contain zeros.
  std::function<void(const Eigen::VectorXd& x, SmoothValues& values)> evaluate;
};

struct SmoothSolution {
  bool ok = false;  ///< Whether x meets all constraints to the tolerance.
  Eigen::VectorXd x;
  double objective = 0.0;  ///< Objective f(x).
  double violation = 0.0;  ///< Largest violation of a constraint at x.
  int evaluations = 0;     ///< Number of points that were evaluated.
};

/// Searches for a local minimum near the start by NLopt's SLSQP (Kraft 1994), which ends when x
/// changes by less than `tolerance`, or after `evaluations` evaluations.
///
/// Guarantees: the result lies within the bounds. The result is the evaluated point with the lowest
/// objective among the points that violate no constraint by more than `tolerance`, otherwise the
/// point that violates the constraints least. The same smooth program always has a bit-identical
/// solution. Throws InternalError unless the sizes agree and the bounds are finite. Computing time:
/// the time of the evaluations, plus, for 50 variables and 100 constraints, a few milliseconds per
/// evaluation.
SmoothSolution Minimize(const SmoothProgram& program, int evaluations, double tolerance = 1e-6);

}  // namespace trackbed
