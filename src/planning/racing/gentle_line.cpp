#include "src/planning/racing/gentle_line.h"

#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "src/planning/racing/line_shape.h"
#include "trackbed/core/error.h"
#include "trackbed/optimize/sparse_quadratic_program.h"

// Minimizes the largest curvature by sequential linear programming in a trust region. The variables
// of each program are the changes of the line's coefficients and the largest curvature t, divided
// by the largest permitted curvature. The program minimizes t, subject to |kappa| <= t at all
// stations, with kappa linearized. A tiny quadratic term selects the smallest change of the line
// among solutions of equal curvature.

namespace trackbed {
namespace {

/// Replaces an infinite bound of a row, since bounds must be finite; actual values are far smaller.
constexpr double kOneSided = 1e4;

class GentleProblem {
 public:
  GentleProblem(const Track& track, double beside, double curvature_max, std::size_t count)
      : basis_(OffsetBasis(track)),
        step_(track.length() / static_cast<double>(count)),
        most_(curvature_max) {
    for (std::size_t i = 0; i < count; ++i) {
      const double s = step_ * static_cast<double>(i);
      centers_.push_back(track.At(s));
      locals_.push_back(basis_.At(s));
      bounds_.push_back(BoundsAt(track, centers_.back(), s, beside));
    }
  }

  [[nodiscard]] TrackLine LineOf(const Eigen::MatrixXd& coefficients) const {
    return {basis_, coefficients};
  }

  /// Returns a line together with its largest curvature.
  [[nodiscard]] GentleLine Measure(TrackLine line) const {
    GentleLine measured{.line = std::move(line)};
    for (std::size_t i = 0; i < centers_.size(); ++i) {
      const double s = step_ * static_cast<double>(i);
      const LineOffset offset = measured.line.At(s);
      TRACKBED_REQUIRE(1.0 - centers_[i].curvature * offset.d > 0.0,
                       "ReduceCurvature: the line folds over at s = {} m", s);
      const LineShape shape = ShapeAt(centers_[i], offset);
      const double curvature = std::abs(shape.cross.value()) / std::pow(shape.square.value(), 1.5);
      if (curvature > measured.curvature) {
        measured.curvature = curvature;
        measured.s = s;
      }
    }
    return measured;
  }

  /// Returns the quadratic program linearized about a line, which changes offsets by at most
  /// `trust` [m]. The last variable is the largest curvature, divided by the largest permitted
  /// curvature.
  [[nodiscard]] SparseQuadraticProgram About(const GentleLine& at, double trust) const {
    const auto unknowns = static_cast<Eigen::Index>(basis_.count());
    const auto stations = static_cast<Eigen::Index>(centers_.size());
    SparseQuadraticProgram program;
    program.lower = Eigen::VectorXd::Constant(3 * stations, -kOneSided);
    program.upper = Eigen::VectorXd::Zero(3 * stations);
    std::vector<Eigen::Triplet<double>> entries;
    for (std::size_t i = 0; i < centers_.size(); ++i) {
      const auto row = 3 * static_cast<Eigen::Index>(i);
      const LineOffset offset = at.line.At(step_ * static_cast<double>(i));
      const LineShape shape = ShapeAt(centers_[i], offset);
      const OffsetDerivatives curvature = shape.cross / (pow(shape.square, 1.5) * most_);
      for (std::size_t k = 0; k < ClosedSplineBasis::kSupport; ++k) {
        const auto& weight = locals_[i].weight;
        const Eigen::Vector3d basis(weight[0][k], weight[1][k], weight[2][k]);
        const double slope = curvature.derivatives().dot(basis);
        entries.emplace_back(row, locals_[i].index[k], weight[0][k]);
        entries.emplace_back(row + 1, locals_[i].index[k], slope);
        entries.emplace_back(row + 2, locals_[i].index[k], -slope);
      }
      // Clamp the bounds, because rounding may put the present line beyond a bound.
      program.lower[row] = std::clamp(bounds_[i].lower - offset.d, -trust, 0.0);
      program.upper[row] = std::clamp(bounds_[i].upper - offset.d, kMinRange, trust);
      entries.emplace_back(row + 1, unknowns, -1.0);
      entries.emplace_back(row + 2, unknowns, -1.0);
      program.upper[row + 1] = -curvature.value();
      program.upper[row + 2] = curvature.value();
    }
    program.constraints.resize(3 * stations, unknowns + 1);
    program.constraints.setFromTriplets(entries.begin(), entries.end());
    program.hessian.resize(unknowns + 1, unknowns + 1);
    program.hessian.setIdentity();
    program.hessian *= kSmallChange / static_cast<double>(unknowns);
    program.linear = Eigen::VectorXd::Unit(unknowns + 1, unknowns);
    return program;
  }

 private:
  static constexpr double kMinRange = 1e-9;     // Minimum difference between bounds of a row [m].
  static constexpr double kSmallChange = 1e-4;  // Cost of a 1 m change of the line (RMS).

  ClosedSplineBasis basis_;
  double step_;  // Distance between adjacent stations [m].
  double most_;
  std::vector<PathPoint> centers_;
  std::vector<ClosedSplineBasis::Local> locals_;
  std::vector<OffsetBounds> bounds_;
};

}  // namespace

GentleLine ReduceCurvature(const Track& track, double beside, const TrackLine& start,
                           double curvature_max, std::size_t count) {
  TRACKBED_REQUIRE(curvature_max > 0.0 && start.coefficients().size() > 0,
                   "ReduceCurvature: curvature_max = {}, {} coefficients", curvature_max,
                   start.coefficients().size());
  constexpr int kMaxPrograms = 50;
  constexpr double kConverged = 1e-4;  // Predicted curvature decrease that ends the search.
  constexpr double kMinTrust = 1e-4;   // Trust region below which the search ends [m].
  const GentleProblem problem(track, beside, curvature_max, count);
  GentleLine best = problem.Measure(start);
  double trust = 1.0;  // [m]
  for (int i = 0; i < kMaxPrograms && best.curvature > curvature_max && trust > kMinTrust; ++i) {
    const double now = best.curvature / curvature_max;
    const SparseQuadraticProgram program = problem.About(best, trust);
    Eigen::VectorXd from = Eigen::VectorXd::Zero(program.linear.size());
    from[from.size() - 1] = now;
    const SparseQuadraticSolution solution = Solve(program, from);
    const double predicted = solution.ok ? now - solution.x[from.size() - 1] : 0.0;
    if (solution.ok && predicted < kConverged) {
      break;
    }
    if (solution.ok) {
      GentleLine next = problem.Measure(problem.LineOf(
          best.line.coefficients() + solution.x.head(best.line.coefficients().rows())));
      const double decrease = now - next.curvature / curvature_max;
      if (decrease > 0.1 * predicted) {
        trust = decrease > 0.75 * predicted ? 2.0 * trust : trust;
        best = std::move(next);
        continue;
      }
    }
    trust *= 0.25;
  }
  return best;
}

}  // namespace trackbed
