#include "src/planning/avoidance/avoidance_curve.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "trackbed/core/error.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/world/world.h"

// Changes a degree-7 Bezier curve past obstacles until the curve is feasible. Position, heading and
// curvature are given at both ends of the curve. These end conditions fix the control points P_0
// and P_7, the directions from P_0 to P_1 and from P_7 to P_6, and the lateral offsets of P_2 and
// P_5. Fit makes an initial curve by placing the control points P_3 and P_4 by least squares along
// a polyline. RepairCurve then minimizes the integral of (dkappa/ds)^2 over the eight remaining
// variables. The limits of clearance, steering angle, steering rate and lateral acceleration and
// the passing side are inequality constraints, evaluated at 193 samples. The curve past an obstacle
// follows Skackauskas (dissertation, listing F.2). The repair of the curve is not part of the
// dissertation.

namespace trackbed::avoidance {
namespace {

constexpr std::size_t kDegree = 7;
// Distance between the points at which a finished curve is checked [m].
constexpr double kCheckSpacing = 0.05;
/// Safety margins of the search, which are needed because it checks the curve only at samples.
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

/// Variables of the search: the coordinates of the control points that the end conditions do not
/// fix. The variables are lengths in the mirror frame of the start, divided by the distance between
/// the curve's ends.
enum Variable : std::size_t {
  kStartFirst,
  kStartSecond,
  kX3,
  kY3,
  kX4,
  kY4,
  kEndSecond,
  kEndFirst
};
constexpr std::size_t kVariables = 8;
using Variables = std::span<const double>;

using Points = std::array<Vec2, kDegree + 1>;

/// Maps variables to the control points P_0 to P_7, in the mirror frame of the start. The control
/// point P_1 lies on the tangent at the start of the curve. The offset h of P_2 from the tangent
/// follows from the curvature at the start: kappa = (6/7) h/|P_0 P_1|^2. The offset of P_5 from the
/// tangent at the end follows in the same way from the curvature at the end.
class EndConditions {
 public:
  explicit EndConditions(const CurveProblem& problem)
      : scale_((problem.end.pose.position() - problem.start.pose.position()).norm()),
        start_curvature_(problem.mirror * problem.start.curvature),
        end_curvature_(problem.mirror * problem.end.curvature),
        end_(problem.Frame().In(problem.end.pose.position())),
        forward_(Direction(problem.Frame().In(problem.end.pose.yaw))) {}

  [[nodiscard]] double scale() const { return scale_; }

  [[nodiscard]] Points ToPoints(Variables x) const {
    constexpr double kOffset = static_cast<double>(kDegree) / (kDegree - 1.0);
    const double a = scale_ * x[kStartFirst];
    const double b = scale_ * x[kStartSecond];
    const double c = scale_ * x[kEndSecond];
    const double d = scale_ * x[kEndFirst];
    const Vec2 last = end_ - d * forward_;
    return {Vec2{0.0, 0.0},
            Vec2{a, 0.0},
            Vec2{a + b, kOffset * start_curvature_ * a * a},
            scale_ * Vec2{x[kX3], x[kY3]},
            scale_ * Vec2{x[kX4], x[kY4]},
            last - c * forward_ + kOffset * end_curvature_ * d * d * LeftNormal(forward_),
            last,
            end_};
  }

  [[nodiscard]] std::array<double, kVariables> ToVariables(const Points& p) const {
    return {p[1].x() / scale_,
            (p[2] - p[1]).x() / scale_,
            p[3].x() / scale_,
            p[3].y() / scale_,
            p[4].x() / scale_,
            p[4].y() / scale_,
            (p[6] - p[5]).dot(forward_) / scale_,
            (p[7] - p[6]).dot(forward_) / scale_};
  }

 private:
  double scale_;
  double start_curvature_;
  double end_curvature_;
  Vec2 end_;
  Vec2 forward_;
};

/// Returns the y coordinate at which the line between two points on either side of the y axis
/// crosses the axis.
double CrossingY(const Vec2& a, const Vec2& b) {
  return a.y() + (b.y() - a.y()) * a.x() / (a.x() - b.x());
}

/// Values of the Bernstein polynomials of degree 7 and of their first three derivatives at evenly
/// spaced parameters.
struct BasisSamples {
  static constexpr Eigen::Index kSamples = 193;
  using Matrix = Eigen::Matrix<double, kSamples, kDegree + 1>;
  std::array<Matrix, 4> of_order;

  BasisSamples() {
    for (std::size_t i = 0; i <= kDegree; ++i) {
      std::vector<Vec2> unit(kDegree + 1, Vec2::Zero());
      unit[i].x() = 1.0;
      const BezierCurve curve(unit);
      for (Eigen::Index k = 0; k < kSamples; ++k) {
        const double u = static_cast<double>(k) / (kSamples - 1);
        for (std::size_t order = 0; order < of_order.size(); ++order) {
          of_order[order](k, static_cast<Eigen::Index>(i)) = curve.Derivative(u, order).x();
        }
      }
    }
  }
};

const BasisSamples& BernsteinBasis() {
  static const BasisSamples basis;
  return basis;
}

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
    constraints_[2 * kStretches] = steering / (kLimitMargin * vehicle.steering_limit) - 1.0;
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
  /// The result is at most the required clearance plus kMaxExcessDistance. For obstacles farther
  /// away, the distance between circumscribed circles is used instead of the exact distance.
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

BezierCurve InWorld(const CurveProblem& problem, const Points& points) {
  std::vector<Vec2> control;
  for (const Vec2& point : points) {
    control.push_back(problem.Frame().Out(point));
  }
  return BezierCurve(control);
}

/// Returns evenly spaced points along a polyline, including both ends.
std::vector<Vec2> Evenly(const std::vector<Vec2>& polyline, std::size_t count) {
  std::vector<double> along{0.0};
  for (std::size_t i = 1; i < polyline.size(); ++i) {
    along.push_back(along.back() + (polyline[i] - polyline[i - 1]).norm());
  }
  std::vector<Vec2> points;
  std::size_t i = 1;
  for (std::size_t k = 0; k < count; ++k) {
    const double s = along.back() * static_cast<double>(k) / static_cast<double>(count - 1);
    while (i + 1 < along.size() && along[i] < s) {
      ++i;
    }
    const double piece = along[i] - along[i - 1];
    const double share = piece > 0.0 ? std::clamp((s - along[i - 1]) / piece, 0.0, 1.0) : 0.0;
    points.emplace_back(polyline[i - 1] + share * (polyline[i] - polyline[i - 1]));
  }
  return points;
}

double PolylineLength(const std::vector<Vec2>& polyline) {
  double length = 0.0;
  for (std::size_t i = 1; i < polyline.size(); ++i) {
    length += (polyline[i] - polyline[i - 1]).norm();
  }
  return length;
}

}  // namespace

double CurveProblem::SpeedAt(double distance) const {
  const double square = start_speed * start_speed - 2.0 * deceleration * distance;
  return std::sqrt(std::max(square, speed * speed));
}

bool CurveCheck::Keeps(const CurveProblem& problem) const {
  return clearance >= problem.safe_distance && steering <= problem.vehicle.steering_limit &&
         steering_rate <= problem.steering_rate &&
         lateral_acceleration <= problem.lateral_acceleration;
}

CurveCheck Check(const CurveProblem& problem, const BezierCurve& curve) {
  const VehicleParams& vehicle = problem.vehicle;
  CurveCheck check;
  check.clearance = std::numeric_limits<double>::infinity();
  const Path path(problem.start.pose,
                  SegmentsThrough(curve.Points(kCheckSpacing, problem.start.pose.yaw)));
  check.length = path.length();
  for (const PathPoint& point : path.Sample(kCheckSpacing)) {
    const double speed = problem.SpeedAt(point.s);
    const double tangent = vehicle.wheelbase * point.curvature;
    const double rate = vehicle.wheelbase * point.sharpness / (1.0 + tangent * tangent) * speed;
    check.steering = std::max(check.steering, std::abs(std::atan(tangent)));
    check.steering_rate = std::max(check.steering_rate, std::abs(rate));
    check.lateral_acceleration =
        std::max(check.lateral_acceleration, std::abs(point.curvature) * speed * speed);
    for (const OrientedBox& obstacle : problem.obstacles) {
      check.clearance =
          std::min(check.clearance, Distance(FootprintAt(vehicle, point.pose), obstacle));
    }
  }
  return check;
}

bool GoesThrough(const PassageConstraint& passage, const std::vector<Vec2>& polyline) {
  int crossings = 0;
  for (std::size_t i = 1; i < polyline.size(); ++i) {
    const Vec2 a = ToLocal(passage.frame, polyline[i - 1]);
    const Vec2 b = ToLocal(passage.frame, polyline[i]);
    if ((a.x() < 0.0) != (b.x() < 0.0)) {
      crossings += passage.side * CrossingY(a, b) > 0.0 ? 1 : 0;
    }
  }
  return crossings % 2 == 1;
}

BezierCurve Fit(const CurveProblem& problem, const std::vector<Vec2>& polyline) {
  TRACKBED_CHECK(polyline.size() >= 2, "{} points", polyline.size());
  const EndConditions ends(problem);
  const double seventh = PolylineLength(polyline) / kDegree / ends.scale();
  std::array<double, kVariables> x{seventh, seventh, 0.0, 0.0, 0.0, 0.0, seventh, seventh};
  Points points = ends.ToPoints(x);
  // Subtract the contribution of the known control points from the polyline, then fit the control
  // points P_3 and P_4 to the remainder.
  constexpr Eigen::Index kSamples = BasisSamples::kSamples;
  const auto& bernstein = BernsteinBasis().of_order[0];
  Eigen::Matrix<double, kSamples, 2> rest;
  const std::vector<Vec2> samples = Evenly(polyline, kSamples);
  for (Eigen::Index k = 0; k < kSamples; ++k) {
    Vec2 known = Vec2::Zero();
    for (const std::size_t i : {0U, 1U, 2U, 5U, 6U, 7U}) {
      known += bernstein(k, static_cast<Eigen::Index>(i)) * points[i];
    }
    rest.row(k) = (problem.Frame().In(samples[static_cast<std::size_t>(k)]) - known).transpose();
  }
  const Eigen::Matrix<double, kSamples, 2> free = bernstein.middleCols<2>(3);
  const Eigen::Matrix2d fitted = free.colPivHouseholderQr().solve(rest);
  points[3] = fitted.row(0).transpose();
  points[4] = fitted.row(1).transpose();
  return InWorld(problem, points);
}

std::optional<Repair> RepairCurve(const CurveProblem& problem, const BezierCurve& guess,
                                  const SearchOptions& search, std::uint64_t seed) {
  Evaluation evaluation(problem);
  Points points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] = problem.Frame().In(guess.control_points()[i]);
  }
  const std::array<double, kVariables> start = evaluation.ends().ToVariables(points);
  // Bounds of the search: each end length is 0.02 to 1 times the distance between the curve's ends.
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
