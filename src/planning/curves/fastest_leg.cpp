// Minimizes the driving time of a leg by direct transcription into a smooth program.
//
// The knots 0 to n separate n pieces. On the piece i, the steering angle delta and the speed v
// change linearly over the time h_i. The fastest motion mostly turns its wheels and changes its
// speed at a limit, so that few pieces suffice. With the acceleration a, the deceleration d, the
// steering rate omega, the wheelbase L and kappa = tan(delta)/L, the program is:
//   minimize    sum of h_i
//   subject to  -d h_i <= v_(i+1) - v_i <= a h_i,  |delta_(i+1) - delta_i| <= omega h_i,
//               v_i^2 |kappa_i| <= lateral acceleration,  and the pose of the goal.
// In this optimization, only the lateral acceleration limit and the goal pose are nonlinear in the
// variables. The path divides each piece into parts of equal time, on which the curvature is linear
// over the length. The end of the path is a sum of integrals over the parts, by Gaussian
// quadrature. The solution meets the goal to the tolerance of the program; Gauss-Newton steps of
// the least change of lengths and curvatures meet the goal exactly. The search amplifies rounding
// errors of its inputs. To give a moved or mirrored leg the same solution, the search rounds its
// inputs, and mirrors a leg whose first turn is to the right. Source of the transcription: Betts
// 2010.
#include "src/planning/curves/fastest_leg.h"

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "src/planning/curves/linear_parts.h"
#include "trackbed/core/angle.h"
#include "trackbed/optimize/smooth_program.h"

namespace trackbed {
namespace {

/// Tolerance of the program, relative to the radius and to the time from lock to straight wheels.
/// The coarse tolerance of the optimization suffices, because the end of the path is corrected
/// afterwards, and the speeds are computed from the path.
constexpr double kTolerance = 1e-3;
constexpr double kLeastTime = 1e-3;  // Least duration of a piece, in units of the program.
constexpr double kInputGrid =
    0x1p-20;  // Inputs are rounded to multiples of kInputGrid, in units of the program.
constexpr Eigen::Index kPathParts = 16;  // Parts per piece; the curvature is linear on each part.

double RoundedInput(double value) {
  return std::round(value / kInputGrid) * kInputGrid;
}

/// The smooth program of a leg. The units of the optimization program are the smallest radius, the
/// mission's speed, the largest steering angle, and the time in which the wheels turn by this
/// angle. The variables are the steering angles and the speeds between the pieces, and the times of
/// the pieces. The car does not steer on a piece that begins or ends at rest.
class LegProgram {
 public:
  explicit LegProgram(const FastestLeg& leg)
      : leg_(leg),
        n_(static_cast<Eigen::Index>(leg.lengths.size())),
        held_at_start_(leg.speeds.front() == 0.0 ? 1 : 0),
        held_at_end_(leg.speeds.back() == 0.0 ? 1 : 0),
        radius_(1.0 / leg.curvature),
        speed_(leg.limits.speed.speed),
        steering_(std::atan(leg.limits.wheelbase * leg.curvature)),
        time_(steering_ / leg.limits.steering_rate),
        direction_(leg.start.front().direction) {
    const Path path({}, leg.start);
    const Pose2 end = path.At(path.length()).pose;
    // A leg that is driven backwards is mirrored to a forward leg. The heading of the goal includes
    // full turns.
    goal_ = {direction_ * end.x / radius_, end.y / radius_, 0.0};
    for (const Segment& segment : leg.start) {
      goal_.z() += segment.length * segment.CurvatureAt(0.5 * segment.length);
    }
    const Segment& last = leg.start.back();
    first_curvature_ = std::clamp(leg.start.front().curvature * radius_, -1.0, 1.0);
    last_curvature_ = std::clamp(last.CurvatureAt(last.length) * radius_, -1.0, 1.0);
    first_ = RoundedInput(SteeringOf(first_curvature_ / radius_));
    last_ = RoundedInput(SteeringOf(last_curvature_ / radius_));
  }

  [[nodiscard]] SmoothProgram Program() const {
    SmoothProgram program;
    program.start = Start().unaryExpr(&RoundedInput);
    program.lower = Eigen::VectorXd::Constant(Count(), -1.0);
    program.upper = Eigen::VectorXd::Constant(Count(), 1.0);
    program.lower.segment(SpeedIndex(1), n_ - 1)
        .setConstant(std::min(leg_.min_speed / speed_, 1.0));
    const double held_speed = std::min(leg_.held_speed / speed_, 1.0);
    if (held_at_start_ > 0) {
      program.lower[SpeedIndex(1)] = held_speed;
    }
    if (held_at_end_ > 0) {
      program.lower[SpeedIndex(n_ - 1)] = held_speed;
    }
    program.lower.tail(n_).setConstant(kLeastTime);
    program.upper.tail(n_).setConstant(2.0 * program.start.tail(n_).sum() + 1.0);
    program.equal_count = 3;
    program.at_most_0_count = 4 * n_ + 2 * (n_ - 1);
    program.evaluate = [this](const Eigen::VectorXd& x, SmoothValues& values) {
      Evaluate(x, values);
    };
    return program;
  }

  /// Returns all values that define the program `program`, except constants.
  [[nodiscard]] std::vector<double> Key(const SmoothProgram& program) const {
    const LegLimits& limits = leg_.limits;
    const Eigen::Vector3d goal = goal_.unaryExpr(&RoundedInput);
    std::vector<double> key{static_cast<double>(n_),
                            leg_.curvature,
                            speed_,
                            limits.speed.acceleration,
                            limits.speed.deceleration,
                            limits.steering_rate,
                            limits.lateral,
                            limits.wheelbase,
                            first_,
                            last_,
                            SpeedAtEnd(0),
                            SpeedAtEnd(n_),
                            goal.x(),
                            goal.y(),
                            goal.z()};
    for (const Eigen::VectorXd* values : {&program.start, &program.lower, &program.upper}) {
      key.insert(key.end(), values->begin(), values->end());
    }
    return key;
  }

  /// Returns the path of the variables x, changed by Newton steps of least norm until it ends at
  /// the goal, except for rounding errors. Returns nullopt if the Newton steps do not converge.
  [[nodiscard]] std::optional<std::vector<Segment>> PathOf(const Eigen::VectorXd& x) const {
    constexpr int kMostSteps = 10;
    constexpr double kGoalRounding = 1e-13;
    LinearParts parts = PartsOf(x);
    const Eigen::Index count = parts.lengths.size();
    const Eigen::Index held_at_start = held_at_start_ * kPathParts;
    const Eigen::Index held_at_end = held_at_end_ * kPathParts;
    parts.curvatures.head(held_at_start + 1).setConstant(first_curvature_);
    parts.curvatures.tail(held_at_end + 1).setConstant(last_curvature_);
    for (int i = 0; i < kMostSteps; ++i) {
      PartsEnd found = EndOf(parts);
      const Eigen::Vector3d miss = found.end - goal_;
      if (miss.norm() <= kGoalRounding * (1.0 + goal_.norm())) {
        return Segments(parts);
      }
      // The curvatures at both ends of the leg, and curvatures at the limit, do not change.
      for (Eigen::Index k = 0; k <= count; ++k) {
        if (k <= held_at_start || k >= count - held_at_end ||
            std::abs(parts.curvatures[k]) >= 1.0) {
          found.rows.col(k).setZero();
        }
      }
      // Scale the change of each length by the length, so that short parts keep a positive length.
      found.rows.rightCols(count) *= parts.lengths.asDiagonal();
      const Eigen::Matrix3d square = found.rows * found.rows.transpose();
      const Eigen::VectorXd step =
          found.rows.transpose() * square.fullPivHouseholderQr().solve(miss);
      parts.curvatures -= step.head(count + 1);
      parts.curvatures = parts.curvatures.cwiseMax(-1.0).cwiseMin(1.0);
      parts.lengths.array() *= 1.0 - step.tail(count).array();
      if (!step.allFinite() || parts.lengths.minCoeff() <= 0.0) {
        return std::nullopt;
      }
    }
    return std::nullopt;
  }

 private:
  /// Returns the number of variable steering angles.
  [[nodiscard]] Eigen::Index Steered() const {
    return std::max<Eigen::Index>(n_ - 1 - held_at_start_ - held_at_end_, 0);
  }
  [[nodiscard]] Eigen::Index Count() const { return Steered() + 2 * n_ - 1; }
  // Return the indices of the steering angle and the speed at a knot between two pieces, and of the
  // duration of a piece, in the vector of variables.
  [[nodiscard]] Eigen::Index SteeringIndex(Eigen::Index knot) const {
    return knot - 1 - held_at_start_;
  }
  [[nodiscard]] Eigen::Index SpeedIndex(Eigen::Index knot) const { return Steered() + knot - 1; }
  [[nodiscard]] Eigen::Index TimeIndex(Eigen::Index piece) const {
    return Steered() + n_ - 1 + piece;
  }
  [[nodiscard]] bool IsInner(Eigen::Index knot) const { return knot > 0 && knot < n_; }
  [[nodiscard]] bool IsSteered(Eigen::Index knot) const {
    return knot > held_at_start_ && knot < n_ - held_at_end_;
  }

  /// Returns the steering angle for a curvature [1/m].
  [[nodiscard]] double SteeringOf(double curvature) const {
    return std::clamp(std::atan(leg_.limits.wheelbase * curvature) / steering_, -1.0, 1.0);
  }
  /// Returns the curvature for a steering angle, and its derivative.
  [[nodiscard]] std::array<double, 2> CurvatureOf(double steering) const {
    const double tan = std::tan(steering_ * steering);
    const double unit = radius_ / leg_.limits.wheelbase;
    return {std::clamp(tan * unit, -1.0, 1.0), (1.0 + tan * tan) * steering_ * unit};
  }

  [[nodiscard]] double Steering(const Eigen::VectorXd& x, Eigen::Index knot) const {
    return IsSteered(knot) ? x[SteeringIndex(knot)] : knot <= held_at_start_ ? first_ : last_;
  }
  [[nodiscard]] double Speed(const Eigen::VectorXd& x, Eigen::Index knot) const {
    return IsInner(knot) ? x[SpeedIndex(knot)] : SpeedAtEnd(knot);
  }
  /// Returns the rounded speed at knot 0 or n.
  [[nodiscard]] double SpeedAtEnd(Eigen::Index knot) const {
    return RoundedInput((knot == 0 ? leg_.speeds.front() : leg_.speeds.back()) / speed_);
  }

  [[nodiscard]] Eigen::VectorXd Start() const {
    Eigen::VectorXd x(Count());
    std::size_t segment = 0;
    double within = 0.0;  // distance from the start of the segment [m]
    for (Eigen::Index i = 0; i < n_; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const double length = leg_.lengths[k];
      const double sum =
          std::max(leg_.speeds[k], leg_.min_speed) + std::max(leg_.speeds[k + 1], leg_.min_speed);
      x[TimeIndex(i)] = 2.0 * length / (sum * time_);
      within += length;
      // The last part of a segment ends at the segment's end, up to rounding.
      if (within > leg_.start[segment].length - 0.5 * length && segment + 1 < leg_.start.size()) {
        within -= leg_.start[segment].length;
        ++segment;
      }
      if (IsSteered(i + 1)) {
        x[SteeringIndex(i + 1)] =
            SteeringOf(leg_.start[segment].CurvatureAt(std::max(within, 0.0)));
      }
      if (i + 1 < n_) {
        x[SpeedIndex(i + 1)] = std::clamp(leg_.speeds[k + 1] / speed_, 0.0, 1.0);
      }
    }
    return x;
  }

  [[nodiscard]] LinearParts PartsOf(const Eigen::VectorXd& x) const {
    const Eigen::Index count = n_ * kPathParts;
    LinearParts parts{Eigen::VectorXd(count + 1), Eigen::VectorXd(count)};
    parts.curvatures[0] = CurvatureOf(first_)[0];
    for (Eigen::Index i = 0; i < n_; ++i) {
      const double unit = speed_ * time_ / radius_ / static_cast<double>(kPathParts);
      for (Eigen::Index k = 0; k < kPathParts; ++k) {
        const double end = static_cast<double>(k + 1) / static_cast<double>(kPathParts);
        const double middle = end - 0.5 / static_cast<double>(kPathParts);
        const Eigen::Index part = i * kPathParts + k;
        parts.curvatures[part + 1] =
            CurvatureOf(Steering(x, i) + end * (Steering(x, i + 1) - Steering(x, i)))[0];
        parts.lengths[part] =
            unit * x[TimeIndex(i)] * (Speed(x, i) + middle * (Speed(x, i + 1) - Speed(x, i)));
      }
    }
    return parts;
  }

  [[nodiscard]] std::vector<Segment> Segments(const LinearParts& parts) const {
    std::vector<Segment> segments;
    for (Eigen::Index i = 0; i < parts.lengths.size(); ++i) {
      const double length = parts.lengths[i] * radius_;
      const double first = parts.curvatures[i] / radius_;
      const double last = parts.curvatures[i + 1] / radius_;
      segments.push_back({.length = length,
                          .curvature = first,
                          .direction = direction_,
                          .sharpness = (last - first) / length});
    }
    return segments;
  }

  /// Adds the derivative with respect to the steering or the speed at a knot, unless the steering
  /// or the speed is fixed.
  template <typename Row>
  void AddSteering(Row&& row, Eigen::Index knot, double value) const {
    if (IsSteered(knot)) {
      row[SteeringIndex(knot)] += value;
    }
  }
  template <typename Row>
  void AddSpeed(Row&& row, Eigen::Index knot, double value) const {
    if (IsInner(knot)) {
      row[SpeedIndex(knot)] += value;
    }
  }

  void Evaluate(const Eigen::VectorXd& x, SmoothValues& values) const {
    values.objective = x.tail(n_).sum();
    values.gradient.tail(n_).setOnes();
    MeetGoal(x, values);
    Eigen::Index row = 0;
    const SpeedLimits& limits = leg_.limits.speed;
    for (Eigen::Index i = 0; i < n_; ++i) {
      for (const double sign : {1.0, -1.0}) {
        const double h = x[TimeIndex(i)];
        const double most =
            (sign > 0.0 ? limits.acceleration : limits.deceleration) * time_ / speed_;
        values.at_most_0[row] = sign * (Speed(x, i + 1) - Speed(x, i)) - most * h;
        values.at_most_0_rows(row, TimeIndex(i)) = -most;
        AddSpeed(values.at_most_0_rows.row(row), i + 1, sign);
        AddSpeed(values.at_most_0_rows.row(row), i, -sign);
        ++row;
        values.at_most_0[row] = sign * (Steering(x, i + 1) - Steering(x, i)) - h;
        values.at_most_0_rows(row, TimeIndex(i)) = -1.0;
        AddSteering(values.at_most_0_rows.row(row), i + 1, sign);
        AddSteering(values.at_most_0_rows.row(row), i, -sign);
        ++row;
      }
    }
    const double most = leg_.limits.lateral * radius_ / (speed_ * speed_);
    for (Eigen::Index knot = 1; knot < n_; ++knot) {
      for (const double sign : {1.0, -1.0}) {
        const double v = Speed(x, knot);
        const auto [curvature, slope] = CurvatureOf(Steering(x, knot));
        values.at_most_0[row] = sign * v * v * curvature - most;
        AddSteering(values.at_most_0_rows.row(row), knot, sign * v * v * slope);
        AddSpeed(values.at_most_0_rows.row(row), knot, 2.0 * sign * v * curvature);
        ++row;
      }
    }
  }

  /// Sets the distances of the path's end from the goal pose, with derivatives by the chain rule
  /// over the parts.
  void MeetGoal(const Eigen::VectorXd& x, SmoothValues& values) const {
    const PartsEnd found = EndOf(PartsOf(x));
    values.equal = found.end - goal_.unaryExpr(&RoundedInput);
    const Eigen::Index count = n_ * kPathParts;
    const double unit = speed_ * time_ / radius_ / static_cast<double>(kPathParts);
    for (int axis = 0; axis < 3; ++axis) {
      auto row = values.equal_rows.row(axis);
      for (Eigen::Index part = 0; part < count; ++part) {
        const Eigen::Index i = part / kPathParts;
        const double end =
            static_cast<double>(part % kPathParts + 1) / static_cast<double>(kPathParts);
        const double middle = end - 0.5 / static_cast<double>(kPathParts);
        const double steering = Steering(x, i) + end * (Steering(x, i + 1) - Steering(x, i));
        const double by_steering = found.rows(axis, part + 1) * CurvatureOf(steering)[1];
        AddSteering(row, i, (1.0 - end) * by_steering);
        AddSteering(row, i + 1, end * by_steering);
        const double by_length = found.rows(axis, count + 1 + part) * unit;
        const double v = Speed(x, i) + middle * (Speed(x, i + 1) - Speed(x, i));
        row[TimeIndex(i)] += by_length * v;
        AddSpeed(row, i, (1.0 - middle) * by_length * x[TimeIndex(i)]);
        AddSpeed(row, i + 1, middle * by_length * x[TimeIndex(i)]);
      }
    }
  }

  const FastestLeg& leg_;
  Eigen::Index n_;
  Eigen::Index held_at_start_;  // number of pieces without steering at the start of the leg
  Eigen::Index held_at_end_;
  double radius_;    // [m]
  double speed_;     // [m/s]
  double steering_;  // [rad]
  double time_;      // [s]
  int direction_;
  double first_curvature_ = 0.0;  // curvature at the start of the leg, in 1/radius
  double last_curvature_ = 0.0;
  double first_ = 0.0;  // steering angle at the start of the leg, rounded
  double last_ = 0.0;
  Eigen::Vector3d goal_;  // x, y and yaw
};

/// Returns the leg with an additional part at each end at which the car is at rest. On such a first
/// or last part, the car accelerates to the speed at which it starts to steer, or brakes from the
/// speed at which it stops steering.
FastestLeg WithPartsAtRest(FastestLeg leg) {
  const double speed = std::min(leg.held_speed, leg.limits.speed.speed);
  const auto part = [speed](double acceleration, double most) {
    return std::min(0.5 * speed * speed / acceleration, 0.5 * most);
  };
  if (leg.speeds.front() == 0.0) {
    const double length = part(leg.limits.speed.acceleration, leg.lengths.front());
    leg.lengths.front() -= length;
    leg.lengths.insert(leg.lengths.begin(), length);
    leg.speeds.insert(leg.speeds.begin() + 1, speed);
  }
  if (leg.speeds.back() == 0.0) {
    const double length = part(leg.limits.speed.deceleration, leg.lengths.back());
    leg.lengths.back() -= length;
    leg.lengths.push_back(length);
    leg.speeds.insert(leg.speeds.end() - 1, speed);
  }
  return leg;
}

/// Returns whether the first bend of the segments is a bend to the right.
bool TurnsRightFirst(const std::vector<Segment>& segments, double most) {
  for (const Segment& segment : segments) {
    const double bend = segment.CurvatureAt(0.5 * segment.length);
    if (std::abs(bend) > kInputGrid * most) {
      return bend < 0.0;
    }
  }
  return false;
}

void MirrorSegments(std::vector<Segment>& segments) {
  for (Segment& segment : segments) {
    segment.curvature = -segment.curvature;
    segment.sharpness = -segment.sharpness;
    segment.sharpness_rate = -segment.sharpness_rate;
  }
}

}  // namespace

std::optional<std::vector<Segment>> FasterLegs::Find(const FastestLeg& leg) {
  constexpr int kEvaluations = 200;
  FastestLeg own = WithPartsAtRest(leg);
  if (leg.lengths.size() < 2) {
    return std::nullopt;
  }
  const bool is_mirrored = TurnsRightFirst(own.start, own.curvature);
  if (is_mirrored) {
    MirrorSegments(own.start);
  }
  const LegProgram program(own);
  const SmoothProgram smooth = program.Program();
  const auto [known, is_new] = solutions_.try_emplace(program.Key(smooth));
  if (is_new) {
    SmoothSolution solution = Minimize(smooth, kEvaluations, kTolerance);
    if (solution.ok) {
      known->second = std::move(solution.x);
    }
  }
  std::optional<std::vector<Segment>> found;
  if (known->second.size() > 0) {
    found = program.PathOf(known->second);
  }
  if (found && is_mirrored) {
    MirrorSegments(*found);
  }
  return found;
}

}  // namespace trackbed
