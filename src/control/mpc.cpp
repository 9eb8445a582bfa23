#include "trackbed/control/mpc.h"

#include <algorithm>
#include <cmath>

#include "src/control/control_keys.h"
#include "src/control/error_model.h"
#include "src/control/turn_round.h"
#include "trackbed/optimize/quadratic_program.h"

namespace trackbed {
namespace {

static_assert(MpcOptions::kMaxHorizon <= QuadraticProgram::kMaxVariables);

/// Predicted deviation z from the steady turn after a step, as a linear function of all steering
/// rates w: free + reach w.
struct Prediction {
  ErrorModel::Vector free;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, ErrorModel::kMaxStates,
                MpcOptions::kMaxHorizon>
      reach;
};

class Mpc final : public SteeringController {
 public:
  explicit Mpc(const MpcOptions& options) : options_(options) {}

  double Steer(const ControlInput& input) override {
    if (const std::optional<double> steering = turn_round_.Steer(input)) {
      return angle_.Approach(input, *steering);
    }
    const VehicleParams& vehicle = input.vehicle;
    const Tracking tracking = ProjectOntoPath(input);
    const double step = Step(input);
    ErrorModel model = MakeErrorModel(input, tracking, step, options_.tyres);
    Ahead ahead(input, tracking, model);
    Prediction z{ErrorState(input, tracking, options_.tyres) - ahead.steady(), {}};
    ErrorWeights weights = WeightsFor(vehicle, options_, model.speed, input.period);
    Regulator regulator = ScheduledRegulator(model, vehicle.steering_rate, weights, z.free);
    z.reach.setZero(model.a.rows(), options_.horizon);

    const double present = model.speed;
    QuadraticProgram program;
    program.hessian.setZero(options_.horizon, options_.horizon);
    program.hessian.diagonal().setConstant(weights.steering_rate);
    program.linear.setZero(options_.horizon);
    const ErrorModel::Matrix cost = StateCost(model, weights).asDiagonal();
    for (int k = 0; k < options_.horizon; ++k) {
      if (const Motion motion = ahead.Now(); k > 0 && !Describes(model, motion)) {
        model = MakeErrorModelFor(vehicle, motion, step, options_.tyres);
      }
      z.free = (model.a * z.free + ahead.Next(model)).eval();
      program.linear[k] -= weights.steering_rate * ahead.rate();
      z.reach = (model.a * z.reach).eval();
      z.reach.col(k) += model.b;
      const bool last = k + 1 == options_.horizon;
      if (last && model.speed != present) {
        regulator = SolveRegulator(model, weights);
      }
      const ErrorModel::Matrix& of_step = last ? regulator.cost : cost;
      program.hessian += z.reach.transpose() * of_step * z.reach;
      program.linear += z.reach.transpose() * (of_step * z.free);
    }
    Limit(vehicle, angle_.Now(input), step, program);
    return angle_.Turn(input, Solve(program).x[0]);
  }

 private:
  /// Returns the duration of a step of MPC's prediction [s].
  [[nodiscard]] double Step(const ControlInput& input) const {
    constexpr double kStep = 0.1;
    const VehicleParams& vehicle = input.vehicle;
    const double swing = vehicle.steering_limit / vehicle.steering_rate;
    return std::max(options_.step.value_or(std::max(kStep, swing / options_.horizon)),
                    input.period);
  }

  /// Returns whether the linear model `model`, made for a certain speed, also holds for `motion`.
  static bool Describes(const ErrorModel& model, const Motion& motion) {
    return model.speed == motion.speed;
  }

  /// Adds lower and upper bounds of the steering rates and of the steering angles, which are sums
  /// of the steering rates.
  static void Limit(const VehicleParams& vehicle, double start, double step,
                    QuadraticProgram& program) {
    const auto n = program.linear.size();
    program.constraints.setZero(4 * n, n);
    program.bounds.resize(4 * n);
    for (Eigen::Index k = 0; k < n; ++k) {
      program.constraints(k, k) = 1.0;
      program.constraints(n + k, k) = -1.0;
      program.constraints.row(2 * n + k).head(k + 1).setConstant(step);
      program.constraints.row(3 * n + k).head(k + 1).setConstant(-step);
    }
    program.bounds.head(2 * n).setConstant(vehicle.steering_rate);
    program.bounds.segment(2 * n, n).setConstant(vehicle.steering_limit - start);
    program.bounds.tail(n).setConstant(vehicle.steering_limit + start);
  }

  MpcOptions options_;
  CommandedAngle angle_;
  TurnRound turn_round_;
};

}  // namespace

ControllerEntry MpcController() {
  return {.name = "mpc",
          .summary =
              "model predictive control: the cost of lqr within the steering angle and rate limits",
          .defaults = MpcOptions{},
          .station = StationSource::kProjection,
          .needs_plan = true,
          .make = MakeBy<MpcOptions, Mpc>};
}

void Visit(KeyVisitor& keys, MpcOptions& options) {
  keys.Field(kCrossTrackWeight, options.cross_track, kWeight);
  keys.Field(kHeadingWeight, options.heading, Need::kOptional, Range{.min = 0.0, .max = 1e6});
  keys.Field(kRateWeight, options.steering_rate, kWeight);
  Visit(keys, options.tyres);
  keys.Field({"horizon", "", "number of prediction steps"}, options.horizon, Need::kOptional,
             Range{.min = 1, .max = MpcOptions::kMaxHorizon});
  keys.Field(
      {"step", "s",
       "prediction step; at least the control period; default: 0.1 s, or more for slow wheels"},
      options.step, Range{.min = 1e-3, .max = 1.0});
}

}  // namespace trackbed
