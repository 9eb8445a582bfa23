#include "trackbed/planning/racing/minimum_curvature.h"

#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <limits>

#include "src/planning/racing/line_shape.h"
#include "trackbed/optimize/sparse_quadratic_program.h"
#include "trackbed/options/key_visitor.h"
#include "trackbed/planning/common/diagnostics.h"
#include "trackbed/planning/common/route.h"

namespace trackbed {
namespace {

using Sparse = Eigen::SparseMatrix<double>;
/// Returns the residual kappa sqrt(dl/ds) at a station. The integral of the squared residual over
/// the station equals the integral of kappa^2 along the line.
OffsetDerivatives Residual(const PathPoint& center, const LineOffset& at) {
  const LineShape shape = ShapeAt(center, at);
  return shape.cross / pow(shape.square, 1.25);
}

class CurvatureProblem {
 public:
  CurvatureProblem(const Track& track, double beside)
      : basis_(OffsetBasis(track)), step_(track.length() / static_cast<double>(Samples())) {
    program_.lower.resize(Samples());
    program_.upper.resize(Samples());
    std::vector<Eigen::Triplet<double>> entries;
    double narrowest = 0.0;
    for (Eigen::Index i = 0; i < Samples(); ++i) {
      const double s = step_ * static_cast<double>(i);
      centers_.push_back(track.At(s));
      locals_.push_back(basis_.At(s));
      const OffsetBounds bounds = BoundsAt(track, centers_.back(), s, beside);
      program_.lower[i] = bounds.lower;
      program_.upper[i] = bounds.upper;
      const double room = 0.5 * (bounds.upper - bounds.lower) + beside;
      // Tolerance of widths: of equally narrow places of the track, the message names the first.
      constexpr double kSameRoom = 1e-6;  // [m]
      if (room < room_ - kSameRoom) {
        room_ = room;
        narrowest = s;
      }
      for (std::size_t k = 0; k < ClosedSplineBasis::kSupport; ++k) {
        entries.emplace_back(i, locals_.back().index[k], locals_.back().weight[0][k]);
      }
    }
    program_.constraints.resize(Samples(), Variables());
    program_.constraints.setFromTriplets(entries.begin(), entries.end());
    if (room_ <= beside) {
      refused_ = TooNarrow(track, narrowest, beside);
    }
  }

  [[nodiscard]] const std::string& refused() const { return refused_; }
  [[nodiscard]] double room() const { return room_; }
  [[nodiscard]] const ClosedSplineBasis& basis() const { return basis_; }
  [[nodiscard]] Eigen::Index Variables() const { return static_cast<Eigen::Index>(basis_.count()); }

  /// Returns the integral of kappa^2 along the line with the given coefficients.
  [[nodiscard]] double Integral(const Eigen::MatrixXd& coefficients) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < centers_.size(); ++i) {
      const double residual = Residual(centers_[i], OffsetAt(i, coefficients)).value();
      sum += residual * residual * step_;
    }
    return sum;
  }

  /// Builds the Gauss-Newton quadratic program about a line.
  const SparseQuadraticProgram& Linearize(const Eigen::VectorXd& coefficients) {
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::VectorXd residuals(Samples());
    for (std::size_t i = 0; i < centers_.size(); ++i) {
      const OffsetDerivatives residual = Residual(centers_[i], OffsetAt(i, coefficients));
      const auto row = static_cast<Eigen::Index>(i);
      residuals[row] = residual.value();
      for (std::size_t k = 0; k < ClosedSplineBasis::kSupport; ++k) {
        double slope = 0.0;
        for (std::size_t order = 0; order < 3; ++order) {
          slope += residual.derivatives()[static_cast<Eigen::Index>(order)] *
                   locals_[i].weight[order][k];
        }
        entries.emplace_back(row, locals_[i].index[k], slope);
      }
    }
    Sparse jacobian(Samples(), Variables());
    jacobian.setFromTriplets(entries.begin(), entries.end());
    // If no bound of the offset is active, shifting the whole line hardly changes the curvature;
    // therefore penalize the distance from the previous line.
    const Sparse squares = jacobian.transpose() * jacobian;
    const double hold = 1e-10 * squares.diagonal().mean();
    Sparse identity(Variables(), Variables());
    identity.setIdentity();
    program_.hessian = squares + hold * identity;
    program_.linear =
        jacobian.transpose() * (residuals - jacobian * coefficients) - hold * coefficients;
    return program_;
  }

 private:
  [[nodiscard]] Eigen::Index Samples() const { return 2 * Variables(); }

  [[nodiscard]] LineOffset OffsetAt(std::size_t i, const Eigen::MatrixXd& coefficients) const {
    return {Evaluate(locals_[i], coefficients, 0)[0], Evaluate(locals_[i], coefficients, 1)[0],
            Evaluate(locals_[i], coefficients, 2)[0]};
  }

  ClosedSplineBasis basis_;
  double step_;  // distance between adjacent samples [m]
  std::vector<PathPoint> centers_;
  std::vector<ClosedSplineBasis::Local> locals_;
  SparseQuadraticProgram program_;
  std::string refused_;
  double room_ = std::numeric_limits<double>::infinity();  // Value of MinimumCurvatureLine::room.
};

Plan PlanWith(const MinimumCurvatureOptions& options, const PlanRequest& request) {
  if (!request.on_track.track) {
    return FollowLine(request, TrackLine());
  }
  const Track& track = *request.on_track.track;
  const MinimumCurvatureLine found =
      FindMinimumCurvature(track, 0.5 * request.vehicle.width + options.margin);
  if (!found.refused.empty()) {
    return route::Refused(
        PlanStatus::kNoPath,
        found.refused + "; " + RemedyForNarrowTrack(found.room, request.vehicle.width));
  }
  Plan plan = FollowLine(request, found.line);
  if (const auto* own = plan.diagnostics.planner.GetIf<TrackPlanDiagnostics>()) {
    plan.diagnostics.planner = MinimumCurvatureDiagnostics{
        .plan = *own,
        .iterations = found.iterations,
        .center_curvature_square = MeasureLine(track, TrackLine()).curvature_square};
  }
  return plan;
}

}  // namespace

MinimumCurvatureLine FindMinimumCurvature(const Track& track, double beside) {
  constexpr int kMaxIterations = 30;
  // The iteration ends below this relative change of the integral of kappa^2.
  constexpr double kConvergenceTolerance = 1e-6;
  CurvatureProblem problem(track, beside);
  MinimumCurvatureLine found{.refused = problem.refused(), .line = {}, .room = problem.room()};
  Eigen::VectorXd line = Eigen::VectorXd::Zero(problem.Variables());
  double integral = 0.0;
  bool done = !found.refused.empty();
  while (!done) {
    const SparseQuadraticSolution solution = Solve(problem.Linearize(line), line);
    ++found.iterations;
    if (!solution.ok) {
      found.refused = "the quadratic program for the line was not solved";
      return found;
    }
    // In the first iteration, the integral of kappa^2 may rise, because the initial line may
    // violate the bounds; in later iterations, it must not rise.
    Eigen::VectorXd next = solution.x;
    double next_integral = problem.Integral(next);
    for (int half = 0; found.iterations > 1 && next_integral > integral && half < 10; ++half) {
      next = 0.5 * (line + next);
      next_integral = problem.Integral(next);
    }
    done = (found.iterations > 1 && next_integral > (1.0 - kConvergenceTolerance) * integral) ||
           found.iterations == kMaxIterations;
    if (found.iterations == 1 || next_integral < integral) {
      line = next;
      integral = next_integral;
    }
  }
  if (found.refused.empty()) {
    found.line = TrackLine(problem.basis(), line);
  }
  return found;
}

void Visit(KeyVisitor& keys, MinimumCurvatureOptions& options) {
  keys.Field({"margin", "m", "distance of the car's sides from the edges"}, options.margin,
             Need::kOptional, Range{.min = 0.0, .max = 100.0});
}

void Visit(DiagnosticsVisitor& out, const MinimumCurvatureDiagnostics& own) {
  Visit(out, own.plan);
  out.Number("center_curvature_square_radpm", own.center_curvature_square);
  out.Integer("iterations", own.iterations);
}

PlannerEntry MinimumCurvaturePlanner() {
  return {.name = "minimum_curvature",
          .summary = "laps along the line of least curvature within the edges of a track",
          .defaults = MinimumCurvatureOptions{},
          .plan = PlanBy<MinimumCurvatureOptions, PlanWith>,
          .follows_track = true,
          .start_curvature = StartCurvatureOnTrack};
}

}  // namespace trackbed
