#pragma once

#include <optional>

#include "trackbed/control/steering_controller.h"

/// Steering over time: the open-loop maneuvers of handling tests.
///
/// Symbols: t time since the start of the run [s]; t0 `at`, when the maneuver begins; tau = t - t0;
/// A `amplitude`; f frequency [Hz]; delta the commanded bicycle angle [rad], positive to the left,
/// 0 before t0. A negative amplitude mirrors the maneuver.
namespace trackbed {

/// A constant angle from the start of the run.
struct ConstantSteeringOptions {
  double steering = 0.0;  ///< [rad]
};
void Visit(KeyVisitor& keys, ConstantSteeringOptions& options);

/// A step to A (ISO 7401, step input). With a rate r, delta = A min(1, r tau/abs(A)); without one,
/// it jumps after t0, limited by the car's actuator.
struct StepSteeringOptions {
  double amplitude = 0.0;      ///< A [rad]
  double at = 1.0;             ///< t0 [s]
  std::optional<double> rate;  ///< r [rad/s], > 0
};
void Visit(KeyVisitor& keys, StepSteeringOptions& options);

/// Slowly increasing steer (SAE J266, ISO 4138): toward `end` at a constant rate r, then constant.
struct RampSteeringOptions {
  double end = 0.0;    ///< [rad]
  double rate = 0.01;  ///< r [rad/s], > 0
  double at = 1.0;     ///< t0 [s]
};
void Visit(KeyVisitor& keys, RampSteeringOptions& options);

/// delta = A sin(2 pi f tau) for a number of cycles, then 0; half cycles also end at 0.
struct SineSteeringOptions {
  double amplitude = 0.0;  ///< A [rad]
  double frequency = 0.4;  ///< f [Hz], > 0
  double cycles = 1.0;     ///< > 0
  double at = 1.0;         ///< t0 [s]
};
void Visit(KeyVisitor& keys, SineSteeringOptions& options);

/// ISO 19365: one sine cycle with a dwell at its second peak, -A at tau = 3/(4 f), then back to 0
/// at tau = 1/f + dwell.
struct SineWithDwellOptions {
  double amplitude = 0.0;  ///< A [rad]
  double frequency = 0.7;  ///< f [Hz], > 0
  double dwell = 0.5;      ///< [s], >= 0
  double at = 1.0;         ///< t0 [s]
};
void Visit(KeyVisitor& keys, SineWithDwellOptions& options);

/// Frequency from f0 to f1 over the duration T.
enum class Sweep {
  kLinear,       ///< f(tau) = f0 + (f1 - f0) tau/T
  kExponential,  ///< f(tau) = f0 (f1/f0)^(tau/T): equal time per octave
};

/// delta = A sin(phi(tau)) for 0 <= tau < T, then 0, with phi' = 2 pi f(tau), phi(0) = 0:
///   linear:       phi = 2 pi (f0 tau + (f1 - f0) tau^2/(2 T))
///   exponential:  phi = 2 pi f0 T ((f1/f0)^(tau/T) - 1)/ln(f1/f0)
struct SweptSineOptions {
  double amplitude = 0.0;        ///< A [rad]
  double start_frequency = 0.2;  ///< f0 [Hz], > 0
  double end_frequency = 2.0;    ///< f1 [Hz], > 0
  double duration = 20.0;        ///< T [s], > 0
  Sweep sweep = Sweep::kLinear;
  double at = 1.0;  ///< t0 [s]
};
void Visit(KeyVisitor& keys, SweptSineOptions& options);

/// delta(t) [rad].
double SteeringAt(const ConstantSteeringOptions& options, double time);
double SteeringAt(const StepSteeringOptions& options, double time);
double SteeringAt(const RampSteeringOptions& options, double time);
double SteeringAt(const SineSteeringOptions& options, double time);
double SteeringAt(const SineWithDwellOptions& options, double time);
double SteeringAt(const SweptSineOptions& options, double time);

/// The controllers of these profiles.
ControllerEntry ConstantSteering();
ControllerEntry StepSteering();
ControllerEntry RampSteering();
ControllerEntry SineSteering();
ControllerEntry SineWithDwell();
ControllerEntry SweptSine();

}  // namespace trackbed
