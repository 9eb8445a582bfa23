// Error model of lqr and mpc: the single-track car beside its path, and the path ahead.
//
// The continuous model (Rajamani 2012, ch. 2) is linear in the state, the steering rate, the
// curvature and a constant. The exponential of the model's augmented matrix yields the exact time
// step. The class Ahead moves a point along the path at the planned speed plus the car's present
// excess speed. Between two knots of the speed profile, the acceleration a is constant. In a time
// step T, a point with the speed v on the path therefore moves by v T + a T^2/2, until it stops.
// The regulator is found by doubling (Chu et al. 2004). The weight of the steering rate in the
// regulator's cost grows with the path errors (Megretski 1996).
#include "src/control/error_model.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <unsupported/Eigen/MatrixFunctions>

#include "src/control/ramped_path.h"
#include "src/control/steering_limit.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

enum State { kOffset, kHeading, kActuator, kWheels, kLateral, kYawRate };

/// Minimum speed for which the error model is made [m/s]. The tyre terms of the model grow without
/// bound as the speed approaches 0.
constexpr double kMinModelSpeed = 1.0;
/// Minimum steering lag that the error model assumes [s].
constexpr double kMinLag = 1e-3;

using Matrix = ErrorModel::Matrix;
using Vector = ErrorModel::Vector;

double SlowestSpeed(const VehicleParams& vehicle) {
  const CarScale scale = ComputeCarScale(vehicle);
  return kMinModelSpeed * std::min(1.0, scale.length / scale.time);
}

Vector SteadyState(const VehicleParams& vehicle, const Motion& motion, const ErrorModel& model) {
  const SteadyTurn turn = OperateOn(vehicle, model.tyres, motion).turn;
  Vector x = Vector::Zero(model.a.rows());
  x[kHeading] = turn.heading_error;
  x[kActuator] = turn.steering;
  x[kWheels] = turn.steering;
  if (x.size() > kLateral) {
    x[kLateral] = turn.lateral_speed;
    x[kYawRate] = turn.yaw_rate;
  }
  return x;
}

/// Returns the amount by which the car now exceeds the planned speed [m/s].
double ExcessSpeed(const ControlInput& input) {
  const int direction = input.reference.path.BendAt(input.station).direction;
  return direction * input.state.speed - input.reference.speed.SpeedAt(input.station);
}

/// Returns the distance [m] that the car drives within `time` [s] from `station` on, at the planned
/// speed plus `excess`.
double WayFrom(const ControlInput& input, double station, double excess, double time) {
  const SpeedProfile& planned = input.reference.speed;
  const double speed = planned.SpeedAt(station);
  const double acceleration = planned.AccelerationAt(station);
  const double rolling = acceleration < 0.0 ? std::min(time, speed / -acceleration) : time;
  const double way = (speed + 0.5 * acceleration * rolling) * rolling;
  // Use a lower bound of the distance driven, because a car that is much slower than planned will
  // speed up.
  return std::max(way + excess * time, std::min(way, SlowestSpeed(input.vehicle) * time));
}

double TangentExcess(double steering) {
  return std::tan(steering) - steering;
}

}  // namespace

ErrorModel MakeErrorModel(const ControlInput& input, const Tracking& tracking, double period,
                          TyreForces tyre_forces) {
  const int direction = tracking.foot.direction;
  const double speed = std::max(direction * input.state.speed, SlowestSpeed(input.vehicle));
  return MakeErrorModelFor(input.vehicle,
                           {.curvature = tracking.foot.curvature,
                            .speed = direction * speed,
                            .acceleration = input.reference.speed.AccelerationAt(input.station)},
                           period, tyre_forces);
}

ErrorModel MakeErrorModelFor(const VehicleParams& vehicle, const Motion& motion, double period,
                             TyreForces tyre_forces) {
  const bool tyres = HasTyres(vehicle) && tyre_forces != TyreForces::kNone;
  const int n = tyres ? kYawRate + 1 : kWheels + 1;
  ErrorModel model;
  model.period = period;
  model.tyres = tyre_forces;
  model.speed = motion.speed;
  const double u = model.speed;

  // The augmented matrix maps the state x, the steering rate w, the curvature kappa and the
  // constant c to their derivatives. The steering rate, kappa and c are constant over a time step.
  // The exponential of the augmented matrix yields the exact discrete-time step.
  using Augmented = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0,
                                  ErrorModel::kMaxStates + 3, ErrorModel::kMaxStates + 3>;
  Augmented rates = Augmented::Zero(n + 3, n + 3);
  const int rate = n;
  const int curvature = n + 1;
  const int excess = n + 2;
  rates(kOffset, kHeading) = u;
  rates(kHeading, curvature) = -u;
  rates(kActuator, rate) = 1.0;
  const double lag = std::max(vehicle.steering_delay(), kMinLag);
  rates(kWheels, kActuator) = 1.0 / lag;
  rates(kWheels, kWheels) = -1.0 / lag;
  if (tyres) {
    rates(kOffset, kLateral) = 1.0;
    rates(kOffset, kYawRate) = -vehicle.cg_to_rear;
    rates(kHeading, kYawRate) = 1.0;
    const Eigen::Matrix<double, 2, 3> lateral =
        LateralRates(vehicle, OperateOn(vehicle, tyre_forces, motion).stiffness, u);
    rates.block<2, 2>(kLateral, kLateral) = lateral.leftCols<2>();
    rates.block<2, 1>(kLateral, kWheels) = lateral.col(2);
    rates.block<2, 1>(kLateral, excess) = lateral.col(2);
  } else {
    rates(kHeading, kWheels) = u / vehicle.wheelbase;
    rates(kHeading, excess) = u / vehicle.wheelbase;
  }
  const Augmented scaled = rates * period;
  const Augmented after = scaled.exp();
  model.a = after.topLeftCorner(n, n);
  model.b = after.col(rate).head(n);
  model.d = after.col(curvature).head(n);
  model.c = after.col(excess).head(n);
  return model;
}

Vector ErrorState(const ControlInput& input, const Tracking& tracking, TyreForces tyre_forces) {
  const bool tyres = HasTyres(input.vehicle) && tyre_forces != TyreForces::kNone;
  Vector x(tyres ? kYawRate + 1 : kWheels + 1);
  x[kOffset] = tracking.cross_track;
  x[kHeading] = tracking.heading_error;
  x[kActuator] = input.state.steering_actuator;
  x[kWheels] = input.state.steering;
  if (tyres) {
    x[kLateral] = input.state.lateral_speed;
    x[kYawRate] = input.state.yaw_rate;
  }
  return x;
}

Vector StateCost(const ErrorModel& model, const ErrorWeights& weights) {
  Vector cost = Vector::Zero(model.a.rows());
  cost[kOffset] = weights.cross_track;
  cost[kHeading] = weights.heading;
  return cost;
}

double CommandedAngle::Now(const ControlInput& input) const {
  // Clamps the angle to the steering limit, because rounding may have moved the actuator slightly
  // beyond this limit.
  const double limit = input.vehicle.steering_limit;
  return std::clamp(last_.value_or(input.state.steering_actuator), -limit, limit);
}

double CommandedAngle::Turn(const ControlInput& input, double rate) {
  const VehicleParams& vehicle = input.vehicle;
  const double turn =
      std::clamp(rate, -vehicle.steering_rate, vehicle.steering_rate) * input.period;
  const double curvature = input.reference.path.BendAt(input.station).curvature;
  const SteeringRange range = AllowedSteering(vehicle, input.state, curvature);
  last_ = std::clamp(Now(input) + turn, range.lowest, range.highest);
  return *last_;
}

double CommandedAngle::Approach(const ControlInput& input, double angle) {
  return Turn(input, (angle - Now(input)) / input.period);
}

Regulator SolveRegulator(const ErrorModel& model, const ErrorWeights& weights) {
  const auto n = model.a.rows();
  const Matrix identity = Matrix::Identity(n, n);
  Matrix a = model.a;
  Matrix g = model.b * model.b.transpose() / weights.steering_rate;
  Matrix h = StateCost(model, weights).asDiagonal();
  constexpr int kMaxDoublings = 40;
  for (int i = 0; i < kMaxDoublings; ++i) {
    const Matrix inverse = (identity + g * h).partialPivLu().inverse();
    const Matrix step = a.transpose() * h * inverse * a;
    g += (a * inverse * g * a.transpose()).eval();
    a = (a * inverse * a).eval();
    h += step;
    h = (0.5 * (h + h.transpose())).eval();
    if (step.lpNorm<Eigen::Infinity>() <= 1e-13 * h.lpNorm<Eigen::Infinity>()) {
      break;
    }
  }
  TRACKBED_CHECK(h.allFinite(), "no regulator at {} m/s", model.speed);
  Regulator regulator;
  regulator.cost = h;
  regulator.input_cost = weights.steering_rate + model.b.dot(h * model.b);
  regulator.gain = model.b.transpose() * h * model.a / regulator.input_cost;
  return regulator;
}

Ahead::Ahead(const ControlInput& input, const Tracking& tracking, const ErrorModel& model,
             const RampedPath* path)
    : input_(input),
      model_(model),
      path_(path),
      station_(input.station),
      excess_speed_(ExcessSpeed(input)),
      direction_(tracking.foot.direction),
      curvature_(tracking.foot.curvature),
      steady_(SteadyState(input.vehicle, MotionOn(curvature_), model)),
      yaw_(tracking.foot.pose.yaw) {}

Motion Ahead::MotionOn(double curvature) const {
  const SpeedProfile& planned = input_.reference.speed;
  const double speed =
      std::max(planned.SpeedAt(station_) + excess_speed_, SlowestSpeed(input_.vehicle));
  return {.curvature = curvature,
          .speed = direction_ * speed,
          .acceleration = planned.AccelerationAt(station_)};
}

double DistanceAhead(const ControlInput& input, double period, long steps) {
  const double excess = ExcessSpeed(input);
  double distance = 0.0;
  for (long k = 0; k < steps; ++k) {
    distance += WayFrom(input, input.station + distance, excess, period);
  }
  return distance;
}

Vector Ahead::Next(const ErrorModel& model) {
  const Motion from = MotionOn(curvature_);
  const double stride = WayFrom(input_, station_, excess_speed_, model.period);
  const auto point = [&](double station) {
    return path_ ? path_->At(station) : input_.reference.path.At(station);
  };
  const PathPoint next = point(station_ + stride);
  const bool ends = station_ + stride >= input_.reference.path.length();
  if (next.direction != direction_ || ends) {
    // At a cusp or at the end of the path, return no disturbance: the car stops there, and its
    // wheels keep their angle until then. Beyond an end on a bend, the path would be straight.
    rate_ = 0.0;
    return Vector::Zero(steady_.size());
  }
  station_ += stride;
  // Mean path curvature over the prediction step, computed from the heading change so that it
  // includes curvature jumps. For a step below kLeastStride, rounding errors would dominate the
  // heading change.
  constexpr double kLeastStride = 1e-6;  // [m]
  const double mean = stride > kLeastStride
                          ? AngleDifference(next.pose.yaw, yaw_) / (direction_ * stride)
                          : next.curvature;
  const auto steering = [&](double curvature) {
    Motion motion = from;
    motion.curvature = curvature;
    return OperateOn(input_.vehicle, model.tyres, motion).turn.steering;
  };
  // Add only changes of the path's curvature, because a car in the steady turn x_0 otherwise stays
  // in this turn.
  const Vector after =
      steady_ + model.d * (mean - curvature_) +
      model.c * (TangentExcess(steering(mean)) - TangentExcess(steering(curvature_)));
  yaw_ = next.pose.yaw;
  curvature_ = next.curvature;
  const double before = steady_[kActuator];
  steady_ = SteadyState(input_.vehicle, MotionOn(curvature_), model_);
  const double most = input_.vehicle.steering_rate;
  rate_ = std::clamp((steady_[kActuator] - before) / model.period, -most, most);
  return after - steady_;
}

Regulator ScheduledRegulator(const ErrorModel& model, double steering_rate, ErrorWeights& weights,
                             Vector& z) {
  constexpr double kApproach = 0.6;  // [rad]
  constexpr double kMaxRates = 2.0;
  constexpr int kMaxRaises = 30;
  for (int i = 0;; ++i) {
    const Regulator regulator = SolveRegulator(model, weights);
    const double per_offset = std::abs(regulator.gain[kOffset]);
    const double per_heading = std::abs(regulator.gain[kHeading]);
    const double most = kApproach * per_heading / per_offset;
    const double offset = std::clamp(z[kOffset], -most, most);
    const double rate =
        std::max(per_offset * std::abs(offset), per_heading * std::abs(z[kHeading]));
    if (rate <= kMaxRates * steering_rate || i == kMaxRaises) {
      z[kOffset] = offset;
      return regulator;
    }
    weights.steering_rate *= 2.0;
  }
}

}  // namespace trackbed
