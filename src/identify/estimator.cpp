#include "src/identify/estimator.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "trackbed/optimize/quadratic_program.h"
#include "trackbed/sim/car_parameters.h"

namespace trackbed {

ProgressCounter::ProgressCounter(const IdentificationHooks& hooks, int max_evaluations)
    : hooks_(hooks), max_evaluations_(std::max(max_evaluations, 1)) {}

void ProgressCounter::Count() {
  ++evaluations_;
  if (hooks_.progress) {
    hooks_.progress(std::min(1.0, static_cast<double>(evaluations_) / max_evaluations_));
  }
  if (hooks_.interrupted && hooks_.interrupted()) {
    throw Interrupted{};
  }
}

void ProgressCounter::SkipTo(int evaluations) {
  max_evaluations_ -= std::max(0, evaluations - evaluations_);
}

std::vector<double> StartValues(const Identification& study, const CarModel& car) {
  std::vector<double> values;
  for (const IdentifiedParameter& parameter : study.parameters) {
    const double own =
        IsBankParameter(parameter.name) ? 0.0 : CarParameterValue(car, parameter.name);
    values.push_back(std::clamp(parameter.start.value_or(own), parameter.from, parameter.to));
  }
  return values;
}

Estimator::Estimator(const Identification& study, const ResidualModel& model, ProgressCounter& work)
    : study_(study), model_(model), counter_(work), start_(StartValues(study, model.car())) {
  free_.resize(start_.size());
  std::iota(free_.begin(), free_.end(), std::size_t{0});
  best_ = start_;
  best_cost_ = Cost(start_);
}

double Estimator::Cost(const std::vector<double>& values) const {
  return CostOf(study_, model_, values);
}

std::vector<std::size_t> Estimator::FixInertParameters() {
  std::vector<std::size_t> inert;
  for (const std::size_t i : free_) {
    const IdentifiedParameter& parameter = study_.parameters[i];
    // Size of the change that tests whether a parameter has an effect, as a fraction of the
    // parameter's range.
    constexpr double kProbeFraction = 0.1;
    const double move = kProbeFraction * (parameter.to - parameter.from);
    std::vector<double> moved = start_;
    moved[i] = start_[i] + move <= parameter.to ? start_[i] + move : start_[i] - move;
    counter_.Count();
    if (!study_.parameters[i].prior && Cost(moved) == best_cost_) {
      inert.push_back(i);
    }
  }
  for (const std::size_t i : inert) {
    std::erase(free_, i);
  }
  return inert;
}

double Estimator::Improve(std::vector<double> at) {
  // Step of the parameters below which the search stops, as a fraction of each parameter's range.
  constexpr double kMinStep = 1e-4;
  // Reduction of the cost in one step below which the search stops, as a fraction of the cost.
  constexpr double kMinGain = 1e-5;
  const int last = counter_.evaluations() + study_.evaluations;
  double radius = 0.25;  // radius of the trust region, as a fraction of each parameter's range
  double cost = Cost(at);
  Keep(at, cost);
  while (std::isfinite(cost) && counter_.evaluations() < last) {
    const LinearModel linear = Linearize(study_, model_, at, free_, [this] { counter_.Count(); });
    bool moved = false;
    double gained = 0.0;
    while (!moved && radius > kMinStep) {
      const Eigen::VectorXd step = Step(linear, at, radius);
      const double expected = -linear.gradient.dot(step) - 0.5 * step.dot(linear.hessian * step);
      if (!(expected > 0.0)) {
        return cost;
      }
      const std::vector<double> next = Moved(at, step);
      counter_.Count();
      const double reached = Cost(next);
      const double share = (cost - reached) / expected;
      const double length = step.cwiseAbs().maxCoeff();
      if (share > 0.1) {  // false if the cost is NaN
        moved = true;
        gained = cost - reached;
        at = next;
        cost = reached;
        Keep(at, cost);
        radius = share > 0.75 ? std::max(radius, 2.0 * length) : radius;
        if (length < kMinStep) {
          return cost;
        }
      } else {
        radius = 0.3 * length;
      }
    }
    if (!moved || gained < kMinGain * cost) {
      return cost;
    }
  }
  return cost;
}

std::vector<double> Estimator::Random(std::mt19937_64& generator) const {
  std::vector<double> values = start_;
  for (const std::size_t i : free_) {
    const IdentifiedParameter& parameter = study_.parameters[i];
    const double share = static_cast<double>(generator() >> 11U) * 0x1p-53;
    values[i] = std::lerp(parameter.from, parameter.to, share);
  }
  return values;
}

void Estimator::FixParameter(std::size_t index) {
  std::erase(free_, index);
  best_[index] = start_[index];
  best_cost_ = Cost(best_);
}

void Estimator::Keep(const std::vector<double>& values, double cost) {
  if (cost < best_cost_) {
    best_ = values;
    best_cost_ = cost;
  }
}

std::vector<double> Estimator::Moved(std::vector<double> values,
                                     const Eigen::VectorXd& step) const {
  for (std::size_t k = 0; k < free_.size(); ++k) {
    const IdentifiedParameter& parameter = study_.parameters[free_[k]];
    const double move = step[static_cast<Eigen::Index>(k)] * (parameter.to - parameter.from);
    values[free_[k]] = std::clamp(values[free_[k]] + move, parameter.from, parameter.to);
  }
  return values;
}

Eigen::VectorXd Estimator::Step(const LinearModel& linear, const std::vector<double>& at,
                                double radius) const {
  const Eigen::Index n = linear.gradient.size();
  // Add a small multiple of the identity matrix to the Hessian, so that parameters without effect
  // on the cost keep their values.
  constexpr double kMinRidge = 1e-9;
  const double ridge = std::max(kMinRidge * linear.hessian.trace(), kMinRidge);
  QuadraticProgram program;
  program.hessian = linear.hessian + ridge * Eigen::MatrixXd::Identity(n, n);
  program.linear = linear.gradient;
  program.constraints = QuadraticProgram::Rows::Zero(2 * n, n);
  program.bounds = QuadraticProgram::Bounds::Zero(2 * n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const std::size_t index = free_[static_cast<std::size_t>(i)];
    const IdentifiedParameter& parameter = study_.parameters[index];
    const double width = parameter.to - parameter.from;
    program.constraints(2 * i, i) = 1.0;
    program.bounds[2 * i] = std::min(radius, (parameter.to - at[index]) / width);
    program.constraints(2 * i + 1, i) = -1.0;
    program.bounds[2 * i + 1] = std::min(radius, (at[index] - parameter.from) / width);
  }
  return Solve(program).x;
}

}  // namespace trackbed
