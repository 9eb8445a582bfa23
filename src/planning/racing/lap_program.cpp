#include "src/planning/racing/lap_program.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

// Builds the quadratic programs of the trust-region method in minimum_time.h (problem of Casanova
// 2000 and Christ et al. 2021). The variables are the changes of the line's spline coefficients and
// the relative changes of the squared speeds. The objective is the lap time, to second order in
// speeds and lengths. The constraints (rows) of the quadratic program limit offsets, steps,
// curvature, steering rate, lateral force, and the forces of motor and brakes. Further constraints
// are tangents to the g-g-v boundary of the tyres. The curvature of the g-g-v boundary at active
// tangents enters the Hessian, weighted by the multipliers of the previous program.

namespace trackbed {
namespace {

/// Large finite number that replaces an infinite bound of a row, since bounds must be finite;
/// actual bounds are far smaller.
constexpr double kUnbounded = 50.0;
/// Value of the argument `keep` of AddCut with which no cut (linear inequality) is skipped. No cut
/// (linear inequality) may be skipped if a braking point may move along a straight, so that
/// intervals change from driving to braking.
constexpr double kKeepAlways = kUnbounded;
constexpr double kMinRange = 1e-9;  // Minimum difference between upper and lower bound of a row.

double Squared(double x) {
  return x * x;
}

/// Returns the amount by which a cut (linear inequality) is violated; negative if the cut is
/// satisfied.
double Excess(const GgvCut& cut, double across, double along) {
  return cut.across * across + cut.along * along - cut.bound;
}

/// Returns the angles near `angle` at which the program adds tangents to the g-g-v boundary. Even
/// small steps change accelerations considerably, so the tangents must approximate the boundary
/// closely.
std::vector<double> CutAngles(double angle) {
  constexpr std::array<double, 5> kAngleOffsets{-0.3, -0.1, 0.0, 0.1, 0.3};
  std::vector<double> angles;
  for (const double by : kAngleOffsets) {
    if (angle + by >= 0.0 && angle + by <= 0.5 * std::numbers::pi) {
      angles.push_back(angle + by);
    }
  }
  return angles;
}

}  // namespace

LapProgram::LapProgram(const LapModel& model, const ClosedSplineBasis& basis,
                       std::vector<OffsetBounds> bounds)
    : model_(model), basis_(basis), bounds_(std::move(bounds)), prices_(model.count()) {
  for (std::size_t i = 0; i < model.count(); ++i) {
    locals_.push_back(basis.At(model.StationAt(i)));
  }
}

void LapProgram::Form::Add(const Form& other, double factor) {
  for (const auto& [variable, value] : other.terms) {
    terms.emplace_back(variable, factor * value);
  }
}

/// Returns the linearized change of a function of the line's offset d, d' and d'' at the station i.
/// The vector `by` holds the function's partial derivatives by d, d' and d''.
LapProgram::Form LapProgram::OffsetForm(std::size_t i, const Eigen::Vector3d& by) const {
  Form form;
  for (std::size_t k = 0; k < ClosedSplineBasis::kSupport; ++k) {
    double value = 0.0;
    for (std::size_t order = 0; order < 3; ++order) {
      value += by[static_cast<Eigen::Index>(order)] * locals_[i].weight[order][k];
    }
    form.Add(locals_[i].index[k], value);
  }
  return form;
}

void LapProgram::Linearize(const Lap& lap) {
  const std::size_t count = model_.count();
  curvature_.clear();
  stretch_.clear();
  for (std::size_t i = 0; i < count; ++i) {
    const LineShape& shape = lap.shapes[i];
    const OffsetDerivatives curvature = shape.cross / pow(shape.square, 1.5);
    const OffsetDerivatives stretch = sqrt(shape.square);
    curvature_.push_back(OffsetForm(i, curvature.derivatives()));
    stretch_.push_back(OffsetForm(i, stretch.derivatives()));
  }
  acceleration_.assign(count, {});
  accelerations_.assign(count, 0.0);
  for (std::size_t i = 0; i < count; ++i) {
    // In an interval of length l from station i to j, the acceleration is a = (w_j - w_i)/(2 l).
    const std::size_t next = model_.After(i);
    const double length = lap.lengths[i];
    const double from = Squared(lap.speeds[i]);
    const double to = Squared(lap.speeds[next]);
    accelerations_[i] = (to - from) / (2.0 * length);
    acceleration_[i].Add(SpeedVariable(next), to / (2.0 * length));
    acceleration_[i].Add(SpeedVariable(i), -from / (2.0 * length));
    const double by_stretch = -accelerations_[i] / length * 0.5 * model_.step();
    acceleration_[i].Add(stretch_[i], by_stretch);
    acceleration_[i].Add(stretch_[next], by_stretch);
  }
}

void LapProgram::AddRow(const Form& form, double lower, double upper) {
  const auto row = static_cast<Eigen::Index>(lower_.size());
  for (const auto& [variable, value] : form.terms) {
    rows_.emplace_back(row, variable, value);
  }
  lower_.push_back(lower);
  upper_.push_back(std::max(upper, lower + kMinRange));
}

/// Adds the lap time, which is the sum of 2 l/(v_i + v_j), to the objective, up to second order in
/// speeds and lengths.
void LapProgram::AddTime(const Lap& lap) {
  const std::size_t count = model_.count();
  std::vector<double> pace(count);  // derivative of the lap time by the line's stretch factor at
                                    // each station [s]
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t next = model_.After(i);
    const double p = lap.speeds[i];
    const double q = lap.speeds[next];
    const double sum = p + q;
    const double time = 2.0 * lap.lengths[i] / sum;
    const Eigen::Index a = SpeedVariable(i);
    const Eigen::Index b = SpeedVariable(next);
    linear_[a] -= time * p / (2.0 * sum);
    linear_[b] -= time * q / (2.0 * sum);
    squares_.emplace_back(a, a, time * (p / (4.0 * sum) + Squared(p / sum) / 2.0));
    squares_.emplace_back(b, b, time * (q / (4.0 * sum) + Squared(q / sum) / 2.0));
    squares_.emplace_back(a, b, time * p * q / (2.0 * sum * sum));
    squares_.emplace_back(b, a, time * p * q / (2.0 * sum * sum));
    pace[i] += model_.step() / sum;
    pace[next] += model_.step() / sum;
  }
  for (std::size_t i = 0; i < count; ++i) {
    for (const auto& [variable, value] : stretch_[i].terms) {
      linear_[variable] += pace[i] * value;
    }
    // The stretch |r'| is the norm of a vector that is linear in d and d', so the Hessian of |r'|
    // has the form u u^T/|r'|^3.
    const PathPoint& center = model_.center(i);
    const double slope = lap.shapes[i].square.derivatives()[1] / 2.0;  // d'
    const double along = std::sqrt(std::max(0.0, Squared(lap.stretch[i]) - Squared(slope)));
    const Form u = OffsetForm(i, {-center.curvature * slope, -along, 0.0});
    const double weight = pace[i] / (lap.stretch[i] * Squared(lap.stretch[i]));
    for (const auto& [row, left] : u.terms) {
      for (const auto& [column, right] : u.terms) {
        squares_.emplace_back(row, column, weight * left * right);
      }
    }
  }
}

void LapProgram::AddBounds(const TrackLine& line, const Lap& lap, const LapTrust& trust) {
  for (std::size_t i = 0; i < model_.count(); ++i) {
    const double d = line.At(model_.StationAt(i)).d;
    const double lower = std::clamp(bounds_[i].lower - d, -trust.offset, 0.0);
    const double upper = std::clamp(bounds_[i].upper - d, 0.0, trust.offset);
    AddRow(OffsetForm(i, {1.0, 0.0, 0.0}), lower, upper);
    Form speed;
    speed.Add(SpeedVariable(i), 1.0);
    const double spare = Squared(model_.fastest() / lap.speeds[i]) - 1.0;
    AddRow(speed, -trust.squared, std::clamp(spare, 0.0, trust.squared));
  }
}

/// Adds rows that limit the curvature of the line, and rows that limit the steering rate between
/// adjacent stations.
void LapProgram::AddCurvatures(const Lap& lap) {
  const double most = model_.limits().curvature_max;
  for (std::size_t i = 0; i < model_.count(); ++i) {
    const double curvature = lap.curvature[i];
    if (most > 0.0 && std::abs(curvature) > 0.5 * most) {
      const double reach = std::max(most, std::abs(curvature));
      AddRow(curvature_[i], -reach - curvature, reach - curvature);
    }
    AddSteering(lap, i);
  }
}

/// Adds rows that limit the steering between adjacent stations, at the speeds of both ends of the
/// interval. To limit steering in the direction opposite to that of the lap, a row at one end of
/// the interval is sufficient.
void LapProgram::AddSteering(const Lap& lap, std::size_t i) {
  if (model_.limits().vehicle.steering_rate <= 0.0) {
    return;
  }
  const std::size_t next = model_.After(i);
  const double by_length = 0.5 * model_.step() / lap.lengths[i];
  for (const std::size_t end : {i, next}) {
    const double speed = lap.speeds[end];
    const LapModel::Turn turn = model_.TurnAt(lap, i, speed);
    const double side = turn.ratio < 0.0 ? -1.0 : 1.0;
    const double ratio = std::abs(turn.ratio);
    Form form;
    form.Add(curvature_[next], side * turn.by_to);
    form.Add(curvature_[i], side * turn.by_from);
    // The speed changes by half of the relative change of its square.
    form.Add(SpeedVariable(end), 0.5 * speed * side * turn.by_speed);
    form.Add(stretch_[i], -ratio * by_length);
    form.Add(stretch_[next], -ratio * by_length);
    if (end == i || ratio > 0.5) {
      AddRow(form, end == i ? -1.0 - ratio : -kUnbounded, std::max(0.0, 1.0 - ratio));
    }
  }
}

/// Adds a row that limits the lateral force to the left and to the right.
void LapProgram::AddLateral(const Lap& lap, std::size_t i) {
  const LapLimits& limits = model_.limits();
  const double squared = Squared(lap.speeds[i]);
  const auto largest_at = [&](double at) {
    return limits.options.share *
           limits.diagram.MaxLateral({.speed = std::sqrt(at), .road = limits.road});
  };
  const double largest = largest_at(squared);
  const double rate = (largest_at(1.01 * squared) - largest_at(0.99 * squared)) / 0.02;
  const double force = squared * lap.curvature[i];
  const double side = force < 0.0 ? -1.0 : 1.0;
  Form form;
  form.Add(curvature_[i], side * squared);
  form.Add(SpeedVariable(i), std::abs(force) - rate);
  AddRow(form, -largest - std::abs(force), std::max(0.0, largest - std::abs(force)));
}

/// Adds a row that applies a cut (linear inequality) to the acceleration in the interval
/// `interval`, for the limits at the interval's end `at`. The argument `bound_rate` is the
/// derivative of the cut's margin, at constant forces, by the relative change of the squared speed
/// w. Skips the cut if the lap satisfies it with a margin of more than `keep`. Returns whether the
/// program got a row for the cut.
bool LapProgram::AddCut(const Lap& lap, std::size_t at, std::size_t interval, const GgvCut& cut,
                        double bound_rate, double keep) {
  const double squared = Squared(lap.speeds[at]);
  const double across = squared * std::abs(lap.curvature[at]);
  const double excess = Excess(cut, across, accelerations_[interval]);
  if (excess < -keep) {
    return false;
  }
  Form form;
  form.Add(acceleration_[interval], cut.along);
  const double side = lap.curvature[at] < 0.0 ? -1.0 : 1.0;
  form.Add(curvature_[at], cut.across * side * squared);
  form.Add(SpeedVariable(at), cut.across * across - bound_rate);
  // If the g-g-v diagram is not convex, a tangent may exclude the lap about which the program is
  // linearized. If a tangent excludes the lap, AddCut moves the bound so that the lap is feasible.
  AddRow(form, -kUnbounded, std::max(0.0, -excess));
  return true;
}

/// Adds a cost to the objective that accounts for the curvature of the g-g-v boundary, which a
/// tangent neglects. The added cost is weight/2 times the squared displacement along the tangent.
void LapProgram::AddBend(const Lap& lap, std::size_t at, std::size_t interval, const GgvCut& cut,
                         double weight) {
  const double squared = Squared(lap.speeds[at]);
  const double side = lap.curvature[at] < 0.0 ? -1.0 : 1.0;
  const double resistance =
      model_.limits().diagram.forces().drag * squared / model_.limits().diagram.forces().mass;
  Form along;
  along.Add(acceleration_[interval], -cut.across);
  along.Add(curvature_[at], cut.along * side * squared);
  along.Add(SpeedVariable(at),
            cut.along * squared * std::abs(lap.curvature[at]) - cut.across * resistance);
  for (const auto& [row, left] : along.terms) {
    for (const auto& [column, right] : along.terms) {
      squares_.emplace_back(row, column, weight * left * right);
    }
  }
}

void LapProgram::TakeMultipliers(const Eigen::VectorXd& multipliers) {
  prices_.assign(model_.count(), {});
  for (const TangentRow& tangent : tangents_) {
    prices_[tangent.interval][tangent.end][static_cast<std::size_t>(tangent.side)] +=
        std::max(0.0, multipliers[tangent.row]);
  }
}

void LapProgram::AddTyres(const Lap& lap, std::size_t i, GgvSide side) {
  constexpr double kStep = 0.01;  // Relative step of the squared speed for finite differences.
  // Distance from the lap up to which cuts are kept, as a fraction of the largest lateral force.
  constexpr double kKeepFraction = 0.3;
  const LapLimits& limits = model_.limits();
  const double squared = Squared(lap.speeds[i]);
  const double across = squared * std::abs(lap.curvature[i]);
  const double largest = limits.options.share *
                         limits.diagram.MaxLateral({.speed = lap.speeds[i], .road = limits.road});
  const double angle = std::acos(std::min(1.0, across / largest));
  const std::size_t before = i == 0 ? model_.count() - 1 : i - 1;
  for (const double cut_angle : CutAngles(angle)) {
    const GgvCut cut = TyreCut(limits, squared, cut_angle, side);
    const GgvCut faster = TyreCut(limits, (1.0 + kStep) * squared, cut_angle, side);
    const GgvCut slower = TyreCut(limits, (1.0 - kStep) * squared, cut_angle, side);
    for (const std::size_t interval : {before, i}) {
      const double along = accelerations_[interval];
      const double rate =
          -(Excess(faster, across, along) - Excess(slower, across, along)) / (2.0 * kStep);
      const auto row = static_cast<Eigen::Index>(lower_.size());
      if (AddCut(lap, i, interval, cut, rate,
                 cut_angle == angle ? kKeepAlways : kKeepFraction * largest)) {
        tangents_.push_back({row, interval, interval == i ? 0U : 1U, side});
      }
    }
  }
  const double bend = TyreCurvature(limits, squared, angle, side);
  const GgvCut tangent = TyreCut(limits, squared, angle, side);
  for (const std::size_t interval : {before, i}) {
    const double price = prices_[interval][interval == i ? 0 : 1][static_cast<std::size_t>(side)];
    if (price > 0.0) {
      AddBend(lap, i, interval, tangent, price * bend);
    }
  }
}

void LapProgram::AddForces(const Lap& lap, std::size_t i, GgvSide side) {
  constexpr double kStep = 0.01;
  const LapLimits& limits = model_.limits();
  const double squared = Squared(lap.speeds[i]);
  const GgvCut cut = ForceCut(limits, squared, side);
  if (!std::isfinite(cut.bound)) {
    return;
  }
  const double rate = (ForceCut(limits, (1.0 + kStep) * squared, side).bound -
                       ForceCut(limits, (1.0 - kStep) * squared, side).bound) /
                      (2.0 * kStep);
  for (const std::size_t interval : {i == 0 ? model_.count() - 1 : i - 1, i}) {
    AddCut(lap, i, interval, cut, rate, kKeepAlways);
  }
}

SparseQuadraticProgram LapProgram::About(const TrackLine& line, const Lap& lap,
                                         const LapTrust& trust) {
  const Eigen::Index variables = SpeedVariable(model_.count());
  rows_.clear();
  tangents_.clear();
  lower_.clear();
  upper_.clear();
  squares_.clear();
  linear_ = Eigen::VectorXd::Zero(variables);
  Linearize(lap);
  AddTime(lap);
  AddBounds(line, lap, trust);
  AddCurvatures(lap);
  for (std::size_t i = 0; i < model_.count(); ++i) {
    AddLateral(lap, i);
    for (const GgvSide side : {GgvSide::kDriving, GgvSide::kBraking}) {
      AddTyres(lap, i, side);
      AddForces(lap, i, side);
    }
  }
  SparseQuadraticProgram program;
  program.hessian.resize(variables, variables);
  program.hessian.setFromTriplets(squares_.begin(), squares_.end());
  program.linear = linear_;
  const auto count = static_cast<Eigen::Index>(lower_.size());
  program.constraints.resize(count, variables);
  program.constraints.setFromTriplets(rows_.begin(), rows_.end());
  program.lower = Eigen::Map<const Eigen::VectorXd>(lower_.data(), count);
  program.upper = Eigen::Map<const Eigen::VectorXd>(upper_.data(), count);
  return program;
}

}  // namespace trackbed
