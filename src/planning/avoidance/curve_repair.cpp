#include "src/planning/avoidance/curve_repair.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "src/planning/avoidance/curve_variables.h"
#include "trackbed/vehicle/steering_reach.h"
#include "trackbed/world/world.h"

// Changes a degree-7 Bezier curve past obstacles until the curve is feasible. Position, heading and
// curvature are given at both ends of the curve. The conditions at the ends fix the control points
// P_0 and P_7, the directions from P_0 to P_1 and from P_7 to P_6, and the lateral offsets of P_2
// and P_5. RepairCurve minimizes the integral of (dkappa/ds)^2 over the eight remaining variables.
// The limits of clearance, steering angle, steering rate and lateral acceleration and the passing
// side are inequality constraints, evaluated at 193 samples. The curve past an obstacle follows
// Skackauskas (dissertation, listing F.2). The repair of the curve is not part of Skackauskas's
// dissertation.

namespace trackbed::avoidance {
namespace {

/// Safety margins of the search, which are needed because the search checks the curve only at
/// samples.
constexpr double kClearanceMargin = 0.02;  // [m]
constexpr double kLimitMargin = 0.99;
/// After kProbeEvaluations evaluations, the search is abandoned if a constraint is violated by more
/// than kMaxRepairableViolation.
constexpr int kProbeEvaluations = 200;
constexpr double kMaxRepairableViolation = 0.5;
/// A stalled search continues with COBYLA, which builds linear models of the objective and the
/// constraints.
constexpr SearchOptions kRescueOptions{
    .method = SearchMethod::kCobyla, .evaluations = 300, .tolerance = 1e-5};
/// Excess over the required clearance up to which distances to obstacles are computed exactly [m].
constexpr double kMaxExcessDistance = 3.0;

/// Objective and constraints of the curve repair, evaluated at the samples of the basis.
class Evaluation {
 public:
  /// Number of curve samples that one constraint covers. Each constraint limits the worst value
  /// over sixteen samples of the curve. The worst value over sixteen samples depends more smoothly
  /// on the variables than the worst value of the whole curve, so the search converges better.
  static constexpr Eigen::Index kStretch = 16;
  static constexpr std::size_t kStretches = (BasisSamples::kSamples - 1) / kStretch;
  static constexpr std::size_t kConstraints = 2 * kStretches + 4;

  explicit Evaluation(const CurveProblem& problem)
      : problem_(problem),
        ends_(problem),
        passage_(problem.Frame().In(problem.passage.frame.position())),
        along_passage_(Direction(problem.Frame().In(problem.passage.frame.yaw))),
        wanted_(problem.safe_distance + kClearanceMargin) {
    const VehicleParams& vehicle = problem.vehicle;
    for (const OrientedBox& box : problem.obstacles) {
      obstacles_.push_back(
          {problem.Frame().In(box),
           0.5 * (std::hypot(box.length, box.width) + std::hypot(vehicle.length, vehicle.width))});
    }
  }

  [[nodiscard]] const EndConditions& ends() const { return ends_; }

  double Objective(Variables x) {
    Evaluate(x);
    return objective_;
  }

  void Constraints(Variables x, std::span<double> values) {
    Evaluate(x);
    std::copy(constraints_.begin(), constraints_.end(), values.begin());
  }

 private:
  void Evaluate(Variables x) {
    if (evaluated_ && std::equal(x.begin(), x.end(), x_.begin())) {
      return;
    }
    std::copy(x.begin(), x.end(), x_.begin());
    evaluated_ = true;
    const Points points = ends_.ToPoints(x);
    Eigen::Matrix<double, kDegree + 1, 2> control;
    for (std::size_t i = 0; i < points.size(); ++i) {
      control.row(static_cast<Eigen::Index>(i)) = points[i].transpose();
    }
    std::array<Eigen::Matrix<double, BasisSamples::kSamples, 2>, 4> curve;
    for (std::size_t order = 0; order < curve.size(); ++order) {
      curve[order].noalias() = BernsteinBasis().of_order[order] * control;
    }

    const VehicleParams& vehicle = problem_.vehicle;
    double length = 0.0;
    double variation = 0.0;
    double last_speed = 0.0;
    double steering = 0.0;
    double acceleration = 0.0;
    double slowest = std::numeric_limits<double>::infinity();
    // Smallest offset of the curve from the obstacle, measured toward the passing side, over the
    // part of the curve beside the obstacle.
    double on_side = std::numeric_limits<double>::infinity();
    Vec2 last_at_passage{0.0, 0.0};
    constraints_.fill(-1.0);
    for (Eigen::Index k = 0; k < BasisSamples::kSamples; ++k) {
      const Vec2 first = curve[1].row(k);
      const Vec2 second = curve[2].row(k);
      const Vec2 third = curve[3].row(k);
      const double parameter_speed = first.norm();
      const double curvature = CurvatureFromDerivatives(first, second);
      const double sharpness = SharpnessFromDerivatives(first, second, third);
      // Use the trapezoidal rule with the same samples for every curve, so that the integration
      // error varies smoothly with the variables.
      length += k == 0 ? 0.0 : 0.5 * (parameter_speed + last_speed) / (BasisSamples::kSamples - 1);
      last_speed = parameter_speed;
      slowest = std::min(slowest, parameter_speed);
      const Vec2 position = curve[0].row(k);
      const Vec2 from_passage = position - passage_;
      const Vec2 at_passage{along_passage_.dot(from_passage), Cross(along_passage_, from_passage)};
      if (k > 0 && (at_passage.x() < 0.0) != (last_at_passage.x() < 0.0)) {
        on_side = std::min(on_side, problem_.passage.side * problem_.mirror *
                                        CrossingY(last_at_passage, at_passage));
      }
      last_at_passage = at_passage;
      const double weight = k == 0 || k == BasisSamples::kSamples - 1 ? 0.5 : 1.0;
      variation += weight * sharpness * sharpness * parameter_speed / (BasisSamples::kSamples - 1);

      const double speed = problem_.SpeedAt(length);
      const double tangent = vehicle.wheelbase * curvature;
      const double rate = vehicle.wheelbase * sharpness / (1.0 + tangent * tangent) * speed;
      const auto stretch = static_cast<std::size_t>(
          std::min<Eigen::Index>(k / kStretch, static_cast<Eigen::Index>(kStretches) - 1));
      Raise(constraints_[stretch], std::abs(rate) / (kLimitMargin * problem_.steering_rate) - 1.0);
      steering = std::max(steering, std::abs(std::atan(tangent)));
      acceleration = std::max(acceleration, std::abs(curvature) * speed * speed);
      const double nearest = NearestObstacle(position, first / parameter_speed);
      Raise(constraints_[kStretches + stretch], (wanted_ - nearest) / (1.0 + wanted_));
    }
    constraints_[2 * kStretches] = steering / (kLimitMargin * SteeringReach(vehicle, 0.0)) - 1.0;
    constraints_[2 * kStretches + 1] =
        acceleration / (kLimitMargin * problem_.lateral_acceleration) - 1.0;
    // Prevents cusps: the norm of the curve's derivative with respect to the parameter must be at
    // least a tenth of the distance between the curve's ends.
    const double scale = ends_.scale();
    constraints_[2 * kStretches + 2] = 1.0 - slowest / (0.1 * scale);
    constraints_[2 * kStretches + 3] = std::isfinite(on_side) ? -on_side / scale : 1.0;
    objective_ = variation * scale * scale * scale;
  }

  /// Returns the distance between the nearest obstacle and the footprint at a point of the curve.
  /// The returned distance is at most the required clearance plus kMaxExcessDistance. For obstacles
  /// farther away, the distance between circumscribed circles is used instead of the exact
  /// distance.
  [[nodiscard]] double NearestObstacle(const Vec2& rear_axle, const Vec2& forward) const {
    const VehicleParams& vehicle = problem_.vehicle;
    const Vec2 middle = rear_axle + (0.5 * vehicle.length - vehicle.rear_overhang) * forward;
    double nearest = wanted_ + kMaxExcessDistance;
    for (const Near& near : obstacles_) {
      const double reach = nearest + near.radius;
      if ((middle - near.box.center.position()).squaredNorm() < reach * reach) {
        const OrientedBox footprint{{middle.x(), middle.y(), std::atan2(forward.y(), forward.x())},
                                    vehicle.length,
                                    vehicle.width};
        nearest = std::min(nearest, Separation(footprint, near.box));
      }
    }
    return nearest;
  }

  static void Raise(double& constraint, double value) { constraint = std::max(constraint, value); }

  const CurveProblem& problem_;
  EndConditions ends_;
  Vec2 passage_{0.0, 0.0};  // Position of the passed obstacle in the frame of the start.
  Vec2 along_passage_{1.0, 0.0};
  double wanted_;  // Required clearance [m].
  /// An obstacle in the frame of the start, with the largest distance between car center and
  /// obstacle center at which the two can touch.
  struct Near {
    OrientedBox box;
    double radius;
  };
  std::vector<Near> obstacles_;
  bool evaluated_ = false;
  std::array<double, kVariables> x_{};
  double objective_ = 0.0;
  std::array<double, kConstraints> constraints_{};
};

}  // namespace

std::optional<Repair> RepairCurve(const CurveProblem& problem, const BezierCurve& guess,
                                  const SearchOptions& search, std::uint64_t seed) {
  Evaluation evaluation(problem);
  Points points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] = problem.Frame().In(guess.control_points()[i]);
  }
  const std::array<double, kVariables> start = evaluation.ends().ToVariables(points);
  // The first two and the last two control points are 0.02 to 1 times the chord of the curve apart.
  // For the positions of P_3 and P_4, the search uses wide bounds.
  SearchProblem moved{
      .lower = {0.02, 0.02, -1.0, -1.5, -1.0, -1.5, 0.02, 0.02},
      .upper = {1.0, 1.0, 2.0, 1.5, 2.0, 1.5, 1.0, 1.0},
      .start = {start.begin(), start.end()},
      .objective = [&](Variables x) { return evaluation.Objective(x); },
      .constraint_count = Evaluation::kConstraints,
      .constraints = [&](Variables x,
                         std::span<double> values) { evaluation.Constraints(x, values); }};
  int evaluations = 0;
  const auto search_from = [&](const std::vector<double>& x, const SearchOptions& options) {
    if (!x.empty()) {
      moved.start = x;
    }
    SearchResult found = Search(moved, options, seed);
    evaluations += found.evaluations;
    return found;
  };
  SearchOptions look = search;
  look.evaluations =
      search.evaluations > 0 ? std::min(search.evaluations, kProbeEvaluations) : kProbeEvaluations;
  SearchResult result = search_from({}, look);
  if (!result.ok() && result.violation > kMaxRepairableViolation) {
    return std::nullopt;
  }
  result = search_from(result.x, search);
  if (!result.ok()) {
    // If the search stalls at a curve that violates limits, continue with COBYLA, then retry the
    // first method.
    result = search_from(result.x, kRescueOptions);
    if (result.ok()) {
      const SearchResult better = search_from(result.x, search);
      result = better.ok() ? better : result;
    }
  }
  if (!result.ok()) {
    return std::nullopt;
  }
  BezierCurve curve = InWorld(problem, evaluation.ends().ToPoints(result.x));
  const CurveCheck check = Check(problem, curve);
  if (!check.Keeps(problem)) {
    return std::nullopt;
  }
  result.evaluations = evaluations;
  return Repair{std::move(curve), check, result};
}

}  // namespace trackbed::avoidance
