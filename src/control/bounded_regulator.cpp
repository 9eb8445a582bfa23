#include "src/control/bounded_regulator.h"

#include <algorithm>
#include <cmath>

namespace trackbed {

void BoundedRegulator::PredictWithoutBounds(const ErrorModel& model, const Regulator& regulator,
                                            const ErrorModel::Vector& z) {
  const ErrorModel::Matrix closed = model.a - model.b * regulator.gain;
  ErrorModel::Vector s = ErrorModel::Vector::Zero(z.size());
  for (std::size_t k = inputs_.size(); k-- > 0;) {
    const ErrorModel::Vector push = pushes_[k] + path_rates_[k] * model.b;
    s = (regulator.cost * push + closed.transpose() * s).eval();
    inputs_[k] = -model.b.dot(s) / regulator.input_cost;
  }
  ErrorModel::Vector state = z;
  for (std::size_t k = 0; k < inputs_.size(); ++k) {
    inputs_[k] += path_rates_[k] - regulator.gain.dot(state);
    state = (model.a * state + inputs_[k] * model.b + pushes_[k]).eval();
  }
}

void BoundedRegulator::Begin(const ErrorModel& model, const Regulator& regulator, double most) {
  // Compute half of the derivative of the cost J with respect to the inputs w, at w = 0. At w = 0,
  // the deviation q from the unbounded optimum w* is -w*.
  ErrorModel::Vector x = ErrorModel::Vector::Zero(model.a.rows());
  for (std::size_t k = 0; k < steps_.size(); ++k) {
    const double q = -inputs_[k] / most;
    steps_[k].slope = q + regulator.gain.dot(x);
    x = (model.a * x + q * model.b).eval();
  }
  ErrorModel::Vector adjoint = ErrorModel::Vector::Zero(model.a.rows());
  double largest = 0.0;
  for (std::size_t k = steps_.size(); k-- > 0;) {
    Step& step = steps_[k];
    const double excess = step.slope;
    step.slope += model.b.dot(adjoint);
    largest = std::max(largest, std::abs(step.slope));
    adjoint = (excess * regulator.gain.transpose() + model.a.transpose() * adjoint).eval();
  }
  // Choose stationary multipliers: the cost's derivative plus the upper minus the lower multiplier
  // of each input is 0.
  for (Step& step : steps_) {
    const double both = 0.1 * largest;
    step.input = 0.0;
    step.upper = std::max(-step.slope, 0.0) + both;
    step.lower = std::max(step.slope, 0.0) + both;
  }
}

void BoundedRegulator::Factor(const ErrorModel& model, const Regulator& regulator) {
  // The cost of the steps from k on is x'S x + 2 s'x plus a constant, with the state x.
  const auto n = model.a.rows();
  const ErrorModel::Matrix gains = regulator.gain.transpose() * regulator.gain;
  ErrorModel::Matrix cost = ErrorModel::Matrix::Zero(n, n);
  for (std::size_t k = steps_.size(); k-- > 0;) {
    Step& step = steps_[k];
    const ErrorModel::Matrix after = cost * model.a;
    const double barrier = step.upper / (1.0 - step.input) + step.lower / (1.0 + step.input);
    step.curvature = 1.0 + barrier + model.b.dot(cost * model.b);
    step.feedback = (regulator.gain + model.b.transpose() * after) / step.curvature;
    cost = gains;
    cost.noalias() += model.a.transpose() * after;
    cost.noalias() -= step.curvature * step.feedback.transpose() * step.feedback;
  }
}

void BoundedRegulator::ComputeStep(const ErrorModel& model, double product, bool corrects) {
  ErrorModel::Vector s = ErrorModel::Vector::Zero(model.a.rows());
  for (std::size_t k = steps_.size(); k-- > 0;) {
    Step& step = steps_[k];
    // The second-order terms are products of the changes of a bound's slack and multiplier. The
    // slack of the upper bound is 1 - w for the input w.
    const double above = corrects ? product + step.turn * step.upper_change : product;
    const double below = corrects ? product - step.turn * step.lower_change : product;
    step.upper_change = above / (1.0 - step.input) - step.upper;
    step.lower_change = below / (1.0 + step.input) - step.lower;
    step.slope = step.upper_change - step.lower_change;
    step.turn = (step.slope + model.b.dot(s)) / step.curvature;
    s = (model.a.transpose() * s - step.curvature * step.turn * step.feedback.transpose()).eval();
  }
  ErrorModel::Vector x = ErrorModel::Vector::Zero(model.a.rows());
  for (Step& step : steps_) {
    step.turn = -step.feedback.dot(x) - step.turn;
    x = (model.a * x + step.turn * model.b).eval();
    step.upper_change += step.upper / (1.0 - step.input) * step.turn;
    step.lower_change -= step.lower / (1.0 + step.input) * step.turn;
  }
}

double BoundedRegulator::StepToBound() const {
  double part = 1.0;
  const auto bound = [&](double value, double change) {
    if (change < 0.0) {
      part = std::min(part, -value / change);
    }
  };
  for (const Step& step : steps_) {
    bound(1.0 - step.input, -step.turn);
    bound(1.0 + step.input, step.turn);
    bound(step.upper, step.upper_change);
    bound(step.lower, step.lower_change);
  }
  return part;
}

double BoundedRegulator::MeanProduct(double part) const {
  double sum = 0.0;
  for (const Step& step : steps_) {
    const double input = step.input + part * step.turn;
    sum += (1.0 - input) * (step.upper + part * step.upper_change) +
           (1.0 + input) * (step.lower + part * step.lower_change);
  }
  return sum / static_cast<double>(2 * steps_.size());
}

double BoundedRegulator::Input(const ErrorModel& model, const Regulator& regulator,
                               const ErrorModel::Vector& z, double most) {
  const std::size_t count = pushes_.size();
  iterations_ = 0;
  steps_.resize(count);
  inputs_.resize(count);
  if (count == 0) {
    return std::clamp(-regulator.gain.dot(z), -most, most);
  }
  PredictWithoutBounds(model, regulator, z);
  const bool within = std::all_of(inputs_.begin(), inputs_.end(),
                                  [&](double input) { return std::abs(input) <= most; });
  if (within) {
    return inputs_[0];
  }
  Begin(model, regulator, most);
  // The sum of the complementarity products (slack times multiplier) is half of the duality gap.
  const double last = 0.5 * kGap / static_cast<double>(2 * count);
  double product = MeanProduct(0.0);
  for (; iterations_ < kMaxIterations && product > last; ++iterations_) {
    // Compute the predictor step and the corrector step of Mehrotra (1992).
    Factor(model, regulator);
    ComputeStep(model, 0.0, false);
    const double ratio = MeanProduct(StepToBound()) / product;
    ComputeStep(model, product * ratio * ratio * ratio, true);
    // Shorten the Newton step, so that it stops slightly before the nearest bound. The omitted
    // fraction of the Newton step is the predicted ratio of the new to the old complementarity
    // products, within limits.
    const double part = (1.0 - std::clamp(ratio, 1e-6, 0.01)) * StepToBound();
    for (Step& step : steps_) {
      step.input += part * step.turn;
      step.upper += part * step.upper_change;
      step.lower += part * step.lower_change;
    }
    product = MeanProduct(0.0);
  }
  for (std::size_t k = 0; k < count; ++k) {
    inputs_[k] = std::clamp(most * steps_[k].input, -most, most);
  }
  return inputs_[0];
}

}  // namespace trackbed
