#pragma once

#include <optional>

#include "trackbed/control/steering_controller.h"

/// Steering profiles over time for the open-loop maneuvers of handling tests.
///
/// Symbols: t time since the start of the run [s]; t0 the option `at`, at which the maneuver
/// begins; tau = t - t0; A the option `amplitude`; f frequency [Hz]; delta the commanded bicycle
/// angle [rad], positive to the left, 0 before t0. A negative amplitude A mirrors the maneuver's
/// steering to the other side.
namespace trackbed {

/// Commands a constant steering angle from the start of the run.
struct ConstantSteeringOptions {
  double steering = 0.0;  ///< Commanded angle [rad].
};
void Visit(KeyVisitor& keys, ConstantSteeringOptions& options);

/// Commands a steering step to the angle A (step input of ISO 7401). If the rate r is set, the
/// angle rises over the time tau to the amplitude A: delta = A min(1, r tau/abs(A)). If no rate is
/// set, the commanded angle jumps after the start time t0, and only the car's actuator limits the
/// steering rate.
struct StepSteeringOptions {
  double amplitude = 0.0;      ///< Step A [rad].
  double at = 1.0;             ///< Time t0 at which the maneuver starts [s].
  std::optional<double> rate;  ///< Rate r of the commanded steering angle [rad/s], > 0.
};
void Visit(KeyVisitor& keys, StepSteeringOptions& options);

/// Slowly increasing steer (SAE J266, ISO 4138): the commanded angle rises to `end` at a constant
/// rate r and then stays constant.
struct RampSteeringOptions {
  double end = 0.0;    ///< Final angle [rad].
  double rate = 0.01;  ///< Rate r of the commanded steering angle [rad/s], > 0.
  double at = 1.0;     ///< Time t0 at which the maneuver starts [s].
};
void Visit(KeyVisitor& keys, RampSteeringOptions& options);

/// Sine steering, with the angle delta = A sin(2 pi f tau) for a number of cycles, and then 0. The
/// number of cycles may be a multiple of 1/2, since the sine also returns to 0 after half a cycle.
struct SineSteeringOptions {
  double amplitude = 0.0;  ///< Amplitude A [rad].
  double frequency = 0.4;  ///< Frequency f of the sine [Hz], > 0.
  double cycles = 1.0;     ///< Number of sine cycles, > 0.
  double at = 1.0;         ///< Time t0 at which the maneuver starts [s].
};
void Visit(KeyVisitor& keys, SineSteeringOptions& options);

/// Sine with dwell (ISO 19365): one sine cycle that dwells at its second peak, -A at tau = 3/(4 f).
/// The commanded angle returns to 0 at tau = 1/f + dwell, one period and the dwell after the start.
struct SineWithDwellOptions {
  double amplitude = 0.0;  ///< Amplitude A [rad].
  double frequency = 0.7;  ///< Frequency f of the sine [Hz], > 0.
  double dwell = 0.5;      ///< Duration for which the angle dwells at the second peak [s], >= 0.
  double at = 1.0;         ///< Time t0 at which the maneuver starts [s].
};
void Visit(KeyVisitor& keys, SineWithDwellOptions& options);

/// Defines how the frequency of a swept sine changes from f0 to f1 over the duration T.
enum class Sweep {
  kLinear,  ///< The frequency changes linearly from f0 to f1: f(tau) = f0 + (f1 - f0) tau/T.
  /// The frequency changes exponentially from f0 to f1, f(tau) = f0 (f1/f0)^(tau/T), so that each
  /// octave takes the same time.
  kExponential,
};

/// A swept sine, with the angle delta = A sin(phi(tau)) for 0 <= tau < T, and then 0. The phase phi
/// of the swept sine is the integral of 2 pi f over the time tau since the start. With a linear or
/// exponential Sweep, the phase is:
///   linear:       phi = 2 pi (f0 tau + (f1 - f0) tau^2/(2 T))
///   exponential:  phi = 2 pi f0 T ((f1/f0)^(tau/T) - 1)/ln(f1/f0)
struct SweptSineOptions {
  double amplitude = 0.0;        ///< Amplitude A [rad].
  double start_frequency = 0.2;  ///< Initial frequency f0 [Hz], > 0.
  double end_frequency = 2.0;    ///< Final frequency f1 [Hz], > 0.
  double duration = 20.0;        ///< Duration T of the swept sine [s], > 0.
  Sweep sweep = Sweep::kLinear;
  double at = 1.0;  ///< Time t0 at which the maneuver starts [s].
};
void Visit(KeyVisitor& keys, SweptSineOptions& options);

/// Returns the commanded steering angle delta(t) [rad] at the time t = `time` [s].
double SteeringAt(const ConstantSteeringOptions& options, double time);
double SteeringAt(const StepSteeringOptions& options, double time);
double SteeringAt(const RampSteeringOptions& options, double time);
double SteeringAt(const SineSteeringOptions& options, double time);
double SteeringAt(const SineWithDwellOptions& options, double time);
double SteeringAt(const SweptSineOptions& options, double time);

/// Return the registry entries of the controllers that steer by the profiles above.
ControllerEntry ConstantSteering();
ControllerEntry StepSteering();
ControllerEntry RampSteering();
ControllerEntry SineSteering();
ControllerEntry SineWithDwell();
ControllerEntry SweptSine();

}  // namespace trackbed
