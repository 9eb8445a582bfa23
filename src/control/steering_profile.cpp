#include "trackbed/control/steering_profile.h"

#include <algorithm>
#include <cmath>

#include "src/control/control_keys.h"
#include "trackbed/core/angle.h"

namespace trackbed {
namespace {

constexpr Range kFrequency{.max = 100.0, .above = 0.0};  // [Hz]
constexpr Key kAmplitude{"amplitude", "rad", "amplitude of the sine; positive: first to the left"};

/// Controller that steers by a profile of the steering angle over time. The type `Options`
/// describes the profile.
template <typename Options>
class ProfileController final : public SteeringController {
 public:
  explicit ProfileController(const Options& options) : options_(options) {}

  double Steer(const ControlInput& input) override {
    return SteeringAt(options_, input.state.time + input.period);
  }

 private:
  Options options_;
};

double Phase(const SweptSineOptions& options, double tau) {
  const double f0 = options.start_frequency;
  const double f1 = options.end_frequency;
  if (options.sweep == Sweep::kLinear) {
    return 2.0 * kPi * (f0 + 0.5 * (f1 - f0) * tau / options.duration) * tau;
  }
  // Compute (e^k - 1)/k, with k = ln(f1/f0) tau/duration, by expm1, which is precise for almost
  // equal frequencies f0 and f1. For f0 = f1, the quotient (e^k - 1)/k has the limit 1.
  const double k = std::log(f1 / f0) * tau / options.duration;
  return 2.0 * kPi * f0 * tau * (k == 0.0 ? 1.0 : std::expm1(k) / k);
}

/// Returns the steering angle at the time tau after the start of a ramp that rises from 0 to `end`
/// at the rate `rate`.
double Ramp(double end, double rate, double tau) {
  return std::copysign(std::clamp(rate * tau, 0.0, std::abs(end)), end);
}

}  // namespace

double SteeringAt(const ConstantSteeringOptions& options, double) {
  return options.steering;
}

double SteeringAt(const StepSteeringOptions& options, double time) {
  const double tau = time - options.at;
  if (options.rate) {
    return Ramp(options.amplitude, *options.rate, tau);
  }
  constexpr double kSameTime = 1e-9;  // [s]
  return tau < kSameTime ? 0.0 : options.amplitude;
}

double SteeringAt(const RampSteeringOptions& options, double time) {
  return Ramp(options.end, options.rate, time - options.at);
}

double SteeringAt(const SineSteeringOptions& options, double time) {
  const double turns = options.frequency * (time - options.at);
  return turns > 0.0 && turns < options.cycles ? options.amplitude * std::sin(2.0 * kPi * turns)
                                               : 0.0;
}

double SteeringAt(const SineWithDwellOptions& options, double time) {
  const double tau = time - options.at;
  const double peak = 0.75 / options.frequency;
  // During the dwell, the phase of the sine is constant.
  const double own = tau < peak ? tau : std::max(peak, tau - options.dwell);
  const double turns = options.frequency * own;
  return turns > 0.0 && turns < 1.0 ? options.amplitude * std::sin(2.0 * kPi * turns) : 0.0;
}

double SteeringAt(const SweptSineOptions& options, double time) {
  const double tau = time - options.at;
  return tau > 0.0 && tau < options.duration ? options.amplitude * std::sin(Phase(options, tau))
                                             : 0.0;
}

void Visit(KeyVisitor& keys, ConstantSteeringOptions& options) {
  keys.Field({"steering", "rad", "bicycle angle, positive to the left"}, options.steering,
             Need::kRequired, kSteering);
}

ControllerEntry ConstantSteering() {
  return {.name = "constant_steering",
          .summary = "constant steering angle",
          .defaults = ConstantSteeringOptions{},
          .station = StationSource::kOdometer,
          .needs_plan = false,
          .make = MakeBy<ConstantSteeringOptions, ProfileController<ConstantSteeringOptions>>};
}

void Visit(KeyVisitor& keys, StepSteeringOptions& options) {
  keys.Field({"amplitude", "rad", "final steering angle, positive to the left"}, options.amplitude,
             Need::kRequired, kSteering);
  keys.Field({"rate", "rad/s", "steering rate; default: the car's limit"}, options.rate, kPositive);
  keys.Field(kBegin, options.at, Need::kOptional, kNonNegative);
}

ControllerEntry StepSteering() {
  return {.name = "step",
          .summary = "steering step at a given rate (ISO 7401)",
          .defaults = StepSteeringOptions{},
          .station = StationSource::kOdometer,
          .needs_plan = false,
          .make = MakeBy<StepSteeringOptions, ProfileController<StepSteeringOptions>>};
}

void Visit(KeyVisitor& keys, RampSteeringOptions& options) {
  keys.Field({"end", "rad", "final steering angle, positive to the left"}, options.end,
             Need::kRequired, kSteering);
  keys.Field({"rate", "rad/s", "steering rate"}, options.rate, Need::kOptional, kPositive);
  keys.Field(kBegin, options.at, Need::kOptional, kNonNegative);
}

ControllerEntry RampSteering() {
  return {.name = "ramp",
          .summary = "slow steering ramp to an angle (SAE J266, ISO 4138)",
          .defaults = RampSteeringOptions{},
          .station = StationSource::kOdometer,
          .needs_plan = false,
          .make = MakeBy<RampSteeringOptions, ProfileController<RampSteeringOptions>>};
}

void Visit(KeyVisitor& keys, SineSteeringOptions& options) {
  keys.Field(kAmplitude, options.amplitude, Need::kRequired, kSteering);
  keys.Field({"frequency", "Hz", "frequency of the sine"}, options.frequency, Need::kOptional,
             kFrequency);
  keys.Field({"cycles", "", "number of cycles"}, options.cycles, Need::kOptional, kPositive);
  keys.Field(kBegin, options.at, Need::kOptional, kNonNegative);
}

ControllerEntry SineSteering() {
  return {.name = "sine",
          .summary = "sine steering for a number of cycles",
          .defaults = SineSteeringOptions{},
          .station = StationSource::kOdometer,
          .needs_plan = false,
          .make = MakeBy<SineSteeringOptions, ProfileController<SineSteeringOptions>>};
}

void Visit(KeyVisitor& keys, SineWithDwellOptions& options) {
  keys.Field(kAmplitude, options.amplitude, Need::kRequired, kSteering);
  keys.Field({"frequency", "Hz", "frequency of the sine"}, options.frequency, Need::kOptional,
             kFrequency);
  keys.Field({"dwell", "s", "dwell time at the second peak"}, options.dwell, Need::kOptional,
             kNonNegative);
  keys.Field(kBegin, options.at, Need::kOptional, kNonNegative);
}

ControllerEntry SineWithDwell() {
  return {.name = "sine_with_dwell",
          .summary = "one sine cycle with a dwell at its second peak (ISO 19365)",
          .defaults = SineWithDwellOptions{},
          .station = StationSource::kOdometer,
          .needs_plan = false,
          .make = MakeBy<SineWithDwellOptions, ProfileController<SineWithDwellOptions>>};
}

void Visit(KeyVisitor& keys, SweptSineOptions& options) {
  keys.Field(kAmplitude, options.amplitude, Need::kRequired, kSteering);
  keys.Field({"start_frequency", "Hz", "start frequency"}, options.start_frequency, Need::kOptional,
             kFrequency);
  keys.Field({"end_frequency", "Hz", "end frequency"}, options.end_frequency, Need::kOptional,
             kFrequency);
  keys.Field({"duration", "s", "duration"}, options.duration, Need::kOptional, kPositive);
  static const EnumNames<Sweep> sweeps{{Sweep::kLinear, "linear"},
                                       {Sweep::kExponential, "exponential"}};
  keys.Field({"sweep", "", "frequency over time: linear, or exponential (equal time per octave)"},
             options.sweep, Need::kOptional, sweeps);
  keys.Field(kBegin, options.at, Need::kOptional, kNonNegative);
}

ControllerEntry SweptSine() {
  return {.name = "swept_sine",
          .summary = "sine sweep from one frequency to another",
          .defaults = SweptSineOptions{},
          .station = StationSource::kOdometer,
          .needs_plan = false,
          .make = MakeBy<SweptSineOptions, ProfileController<SweptSineOptions>>};
}

}  // namespace trackbed
