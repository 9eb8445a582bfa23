#include "trackbed/control/mppi.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "src/control/control_keys.h"
#include "src/control/error_model.h"
#include "src/control/roll_out.h"
#include "src/control/steering_limit.h"
#include "src/control/turn_round.h"
#include "trackbed/control/surroundings.h"
#include "trackbed/core/angle.h"

// MPPI in each control period:
//   1. Shift the last plan (a steering rate for each step) in time by the control period.
//   2. Replace the plan by the steering rates of the controller lqr, if they have a lower cost.
//   3. Compute in parallel (oneTBB) the costs of roll-outs, whose steering rates deviate randomly
//      from the plan.
//   4. Average the roll-outs' deviations from the plan, weighted by exp(-cost/lambda), in a fixed
//      order.
//   5. Add the average deviation, or half of it, to the plan if the sum costs less. Replace the
//      plan by the cheapest roll-out if that costs even less.
namespace trackbed {
namespace {

/// Number of intervals of a roll-out in which its deviation from the plan is constant.
constexpr std::size_t kHolds = 10;
/// Number of standard deviations (sizes) of the random changes to the plan, and the ratio between
/// successive sizes. Small deviations refine the plan near its optimum; large deviations find ways
/// around obstacles.
constexpr std::size_t kSizes = 4;
constexpr double kSizeRatio = 4.0;
/// Fraction of the roll-outs, the cheapest ones, whose range of costs scales the weights. Expensive
/// roll-outs, which may collide, do not affect the range of costs.
constexpr double kSpreadShare = 0.1;
/// Cost per step below which a plan is optimal up to rounding.
constexpr double kNoCost = 1e-20;

/// Hashes a counter to pseudorandom bits (SplitMix64).
std::uint64_t MixedBits(std::uint64_t counter) {
  std::uint64_t z = (counter + 1) * 0x9e3779b97f4a7c15ULL;
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31U);
}

/// Returns a number from a standard normal distribution, which depends only on the arguments
/// (transformation of Box and Muller).
double NormalNumber(std::uint64_t seed, std::uint64_t counter) {
  constexpr double kUnit = 0x1p-53;
  const std::uint64_t key = MixedBits(seed);
  const auto uniform = [&](std::uint64_t at) {
    return (static_cast<double>(MixedBits(key ^ at) >> 11U) + 0.5) * kUnit;
  };
  return std::sqrt(-2.0 * std::log(uniform(2 * counter))) *
         std::cos(2.0 * kPi * uniform(2 * counter + 1));
}

/// Returns the default prediction horizon [s] for the car's present speed (MppiOptions::horizon).
double DefaultHorizon(const ControlInput& input) {
  constexpr double kShortest = 1.0;  // [s]
  constexpr double kLongest = 5.0;   // [s]
  const VehicleParams& car = input.vehicle;
  const double speed = std::abs(input.state.speed);
  const double turning =
      std::cbrt(64.0 * car.width * car.wheelbase / (speed * speed * car.steering_rate));
  const double gripping = std::sqrt(8.0 * car.width / LateralGrip(car));
  return std::min(std::max({kShortest, turning, gripping}), kLongest);
}

/// Returns whether the car moves by less than 1/1000 of its wheelbase in a control period.
bool Stands(const ControlInput& input) {
  constexpr double kShare = 1e-3;
  return std::abs(input.state.speed) * input.period < kShare * input.vehicle.wheelbase;
}

class Mppi final : public SteeringController, public SeesSurroundings {
 public:
  explicit Mppi(const MppiOptions& options)
      : options_(options),
        steps_(static_cast<std::size_t>(options.steps)),
        pairs_((static_cast<std::size_t>(options.samples) + 1) / 2),
        noise_(pairs_ * kHolds),
        plan_(steps_, 0.0),
        other_(steps_, 0.0),
        change_(steps_, 0.0),
        costs_(2 * pairs_),
        sorted_(2 * pairs_) {
    for (std::size_t i = 0; i < noise_.size(); ++i) {
      const auto size = static_cast<double>(i / kHolds % kSizes);
      noise_[i] = NormalNumber(options.seed, i) * std::pow(kSizeRatio, -size);
    }
  }

  void See(const Surroundings& surroundings) override { surroundings_ = &surroundings; }

  [[nodiscard]] std::unique_ptr<SteeringController> Clone() const override {
    auto copy = std::make_unique<Mppi>(*this);
    copy->surroundings_ = nullptr;  // the caller calls See() of the clone
    return copy;
  }

  double Steer(const ControlInput& input) override {
    const Surroundings* const surroundings = std::exchange(surroundings_, nullptr);
    if (const std::optional<double> steering = turn_round_.Steer(input)) {
      std::fill(plan_.begin(), plan_.end(), 0.0);
      return angle_.Approach(input, *steering);
    }
    const double horizon = options_.horizon.value_or(DefaultHorizon(input));
    Shift(horizon / static_cast<double>(steps_));
    roll_out_.Prepare(
        input, ProjectOntoPath(input), angle_.Now(input), surroundings,
        {.steps = options_.steps,
         .step = step_,
         .weights = WeightsFor(input.vehicle, options_, std::abs(input.state.speed), input.period),
         .margin = options_.margin.value_or(0.25 * input.vehicle.width),
         .grip = options_.grip});
    if (Stands(input)) {
      // Do not use roll-outs at rest: they assume that the car starts at once, but it waits for its
      // actuator.
      std::fill(plan_.begin(), plan_.end(), 0.0);
      elapsed_ = 0.0;
      return angle_.Turn(input, roll_out_.StartRate());
    }
    cost_ = CostOf(plan_);
    FollowRegulator();
    if (cost_ > kNoCost * static_cast<double>(steps_)) {
      // Each random steering rate is held for the time `hold`. If kHolds steering rates have the
      // standard deviation grip/sqrt(hold * horizon), their integral, the steering angle, has the
      // standard deviation `grip`.
      const double grip = SteeringAtGrip(input.vehicle, input.state.speed);
      const double hold = horizon / static_cast<double>(kHolds);
      Improve(options_.noise *
              std::min(input.vehicle.steering_rate, grip / std::sqrt(hold * horizon)));
    }
    elapsed_ = input.period;
    return angle_.Turn(input, FirstRate(input.period));
  }

 private:
  [[nodiscard]] double CostOf(const std::vector<double>& plan) const {
    return roll_out_.Cost(
        [&](int k, const RolledCar&) { return plan[static_cast<std::size_t>(k)]; });
  }

  /// Replaces the plan by the plan `other_` if `other_` has a lower cost.
  void TakeIfCheaper() {
    const double cost = CostOf(other_);
    if (cost < cost_) {
      cost_ = cost;
      plan_.swap(other_);
    }
  }

  /// Replaces the plan by the steering rates of the controller lqr if they have a lower cost.
  void FollowRegulator() {
    const double most = roll_out_.rate_limit();
    static_cast<void>(roll_out_.Cost([&](int k, const RolledCar& car) {
      return other_[static_cast<std::size_t>(k)] =
                 std::clamp(roll_out_.RegulatorRate(car), -most, most);
    }));
    TakeIfCheaper();
  }

  /// Returns by how much the steering rates of a pair of roll-outs deviate from the plan in a step,
  /// as a multiple of the largest standard deviation.
  [[nodiscard]] double Deviation(std::size_t pair, std::size_t step) const {
    return noise_[pair * kHolds + step * kHolds / steps_];
  }

  /// Returns the steering rate of a roll-out in a step. Each roll-out with an odd number deviates
  /// from the plan opposite to the preceding roll-out.
  [[nodiscard]] double SampledRate(std::size_t roll_out, std::size_t step, double size) const {
    const double side = roll_out % 2 == 0 ? size : -size;
    const double most = roll_out_.rate_limit();
    return std::clamp(plan_[step] + side * Deviation(roll_out / 2, step), -most, most);
  }

  void Improve(double size) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, costs_.size(), 16), [&](const auto& some) {
      for (std::size_t i = some.begin(); i != some.end(); ++i) {
        costs_[i] = roll_out_.Cost([&](int k, const RolledCar&) {
          return SampledRate(i, static_cast<std::size_t>(k), size);
        });
      }
    });
    const std::size_t best =
        static_cast<std::size_t>(std::min_element(costs_.begin(), costs_.end()) - costs_.begin());
    Average(costs_[best], size);
    for (const double share : {1.0, 0.5}) {
      for (std::size_t k = 0; k < steps_; ++k) {
        change_[k] *= share;
        other_[k] = plan_[k] + change_[k];
      }
      const double before = cost_;
      TakeIfCheaper();
      if (cost_ < before) {
        break;
      }
    }
    if (costs_[best] < cost_) {
      for (std::size_t k = 0; k < steps_; ++k) {
        other_[k] = SampledRate(best, k, size);
      }
      TakeIfCheaper();
    }
  }

  /// Computes the weighted mean of the roll-outs' deviations from the plan. `least` is the lowest
  /// cost of a roll-out.
  void Average(double least, double size) {
    sorted_ = costs_;
    const auto at = sorted_.begin() +
                    static_cast<std::ptrdiff_t>(kSpreadShare * static_cast<double>(sorted_.size()));
    std::nth_element(sorted_.begin(), at, sorted_.end());
    const double lambda = options_.temperature * (*at - least);
    std::fill(change_.begin(), change_.end(), 0.0);
    if (!(lambda > 0.0)) {
      return;
    }
    double sum = 0.0;
    for (std::size_t i = 0; i < costs_.size(); i += 2) {
      const double left = std::exp((least - costs_[i]) / lambda);
      const double right = std::exp((least - costs_[i + 1]) / lambda);
      sum += left + right;
      for (std::size_t k = 0; k < steps_; ++k) {
        change_[k] += left * (SampledRate(i, k, size) - plan_[k]) +
                      right * (SampledRate(i + 1, k, size) - plan_[k]);
      }
    }
    for (double& change : change_) {
      change /= sum;
    }
  }

  /// Returns the plan's mean steering rate over the control period [rad/s].
  [[nodiscard]] double FirstRate(double period) const {
    const double steps = std::min(period / step_, static_cast<double>(steps_));
    double turned = 0.0;
    for (std::size_t k = 0; static_cast<double>(k) < steps; ++k) {
      turned += plan_[k] * std::min(1.0, steps - static_cast<double>(k));
    }
    return turned / steps;
  }

  /// Moves the plan forward by the time since the last control period, and changes the duration of
  /// its steps to `step` [s].
  void Shift(double step) {
    constexpr double kRounding = 1e-9;
    const auto rate_at = [&](std::size_t k) { return k < steps_ ? plan_[k] : 0.0; };
    const double stride = step_ > 0.0 ? step / step_ : 1.0;
    const double shift = step_ > 0.0 ? elapsed_ / step_ : 0.0;
    for (std::size_t k = 0; k < steps_; ++k) {
      const double place = std::min(static_cast<double>(k) * stride + shift + kRounding,
                                    static_cast<double>(steps_));
      const auto before = static_cast<std::size_t>(place);
      const double share = place - static_cast<double>(before);
      other_[k] = share < 2.0 * kRounding ? rate_at(before)
                                          : std::lerp(rate_at(before), rate_at(before + 1), share);
    }
    plan_.swap(other_);
    step_ = step;
  }

  MppiOptions options_;
  std::size_t steps_;          // Number of steps of a roll-out.
  std::size_t pairs_;          // Number of pairs of roll-outs.
  std::vector<double> noise_;  // Deviations of each roll-out pair, in units of the largest sigma.
  std::vector<double> plan_;   // Steering rate of each step [rad/s].
  double step_ = 0.0;          // Duration of a step of the plan [s]; 0 before the first plan.
  double elapsed_ = 0.0;       // Time since the plan began [s].
  double cost_ = 0.0;          // Cost of the plan.
  std::vector<double> other_;
  std::vector<double> change_;
  std::vector<double> costs_;
  std::vector<double> sorted_;
  const Surroundings* surroundings_ = nullptr;  // Surroundings in the present control period.
  RollOuts roll_out_;
  CommandedAngle angle_;
  TurnRound turn_round_;
};

}  // namespace

ControllerEntry MppiController() {
  return {.name = "mppi",
          .summary = "samples motions of the car on its tyres, around obstacles and within edges",
          .defaults = MppiOptions{},
          .station = StationSource::kProjection,
          .needs_plan = true,
          .make = [](const ControllerOptions& options) -> std::unique_ptr<SteeringController> {
            return std::make_unique<Mppi>(options.Get<MppiOptions>());
          }};
}

void Visit(KeyVisitor& keys, MppiOptions& options) {
  keys.Field({"samples", "", "number of roll-outs"}, options.samples, Need::kOptional,
             Range{.min = 8, .max = 100000});
  keys.Field({"steps", "", "number of steps of a roll-out"}, options.steps, Need::kOptional,
             Range{.min = 10, .max = 500});
  keys.Field({"horizon", "s",
              "duration of a roll-out; default: for moving aside by twice the car's width"},
             options.horizon, Range{.min = 0.1, .max = 10.0});
  keys.Field({"seed", "", "seed of the sampled deviations"}, options.seed, Need::kOptional);
  keys.Field({"temperature", "",
              "lambda of the weights exp(-cost/lambda), relative to the spread of the costs"},
             options.temperature, Need::kOptional, Range{.min = 1e-3, .max = 1e3});
  keys.Field({"noise", "", "factor on the size of the sampled deviations"}, options.noise,
             Need::kOptional, Range{.min = 1e-3, .max = 100.0});
  keys.Field(kCrossTrackWeight, options.cross_track, kWeight);
  keys.Field(kHeadingWeight, options.heading, Need::kOptional, Range{.min = 0.0, .max = 1e6});
  keys.Field(kRateWeight, options.steering_rate, kWeight);
  keys.Field({"margin", "m",
              "clearance below which obstacles and track edges cost; default: a quarter of the "
              "car's width"},
             options.margin, Range{.min = 0.0, .max = 100.0});
  keys.Field({"grip", "", "fraction of the lateral grip that is free of cost"}, options.grip,
             Need::kOptional, Range{.min = 0.01, .max = 100.0});
}

}  // namespace trackbed
