#pragma once

#include <cstdint>
#include <optional>

#include "trackbed/control/steering_controller.h"

namespace trackbed {

/// Model predictive path integral control (MPPI, Williams et al. 2018). In each control period, the
/// controller simulates many steering motions ("roll-outs") and applies the mean of the motions,
/// weighted by exp(-cost/lambda).
///
/// Model of a roll-out: the single-track car on the brush model of its axles, with the road's
/// friction factor at the car. In a roll-out, the load transfer and the friction circle are
/// computed for the planned acceleration. A car without tyre coefficients does not slip, and
/// neither does a car whose rear axle has never moved sideways, such as a KinematicCar. In a
/// roll-out, the steering angle follows the sampled steering rates within the car's limits of angle
/// and rate, and the wheels follow with the steering lag. MPPI accounts for dead time, lag and
/// backlash of the actuator as every controller does (docs/algorithms/control.md). The speed
/// follows the plan: MPPI steers, and leaves the speed to SpeedControl.
///
/// Cost of a roll-out, in the units of LqrOptions:
///   sum over all steps of  cross_track e^2 + heading (psi - psi_0)^2 + steering_rate w^2
///     + lateral acceleration beyond `grip`
///     + closeness to obstacles, walls and track edges within `margin`; collisions cost more than
///       any deviation from the path
///   + the remaining cost of lqr behind the horizon, z^T P z.
/// Roll-outs assume that obstacles keep their velocity and yaw rate during the horizon.
///
/// The roll-outs vary the cheaper one of two motions: the last plan of MPPI, or the motion of a car
/// that lqr steers. The steering rates of the roll-outs deviate from those of the chosen motion by
/// normally distributed numbers, each constant for a tenth of the horizon. The steering-rate
/// deviations of the roll-outs come in pairs of opposite sign, and in four sizes. The candidates
/// for the new plan are the weighted mean, the mean of the plan and the weighted mean, and the
/// cheapest roll-out. A candidate replaces the last plan of MPPI only if its cost is lower. A car
/// that moves by less than 1/1000 of its wheelbase in a control period is steered by the law of lqr
/// without preview.
///
/// Guarantees: the commands are the same, bit for bit, for the same seed and inputs, for any number
/// of threads. MPPI keeps a plan of cost 0, for example while the car is on its path in a steady
/// turn. The commanded angle changes at most at the car's steering rate. MPPI allocates memory only
/// in its first control period, or when more obstacles are near than before. Cost: about 4 ms of
/// processor time per control period with 1000 roll-outs of 50 steps, divided among the threads of
/// oneTBB.
struct MppiOptions {
  int samples = 1000;  ///< Number of roll-outs, from 8 to 100000; rounded up to be even.
  int steps = 50;      ///< Number of steps of a roll-out, from 10 to 500.
  /// Duration of a roll-out [s], from 0.1 to 10. Default: the time in which the car can move aside
  /// by twice its width w at the speed v, but at least 1 s and at most 5 s. With the wheelbase L,
  /// the time to move aside by 2 w is the larger one of cbrt(64 w L/(v^2 omega)), at the full
  /// steering rate omega, and sqrt(8 w/a), at the lateral grip a.
  std::optional<double> horizon;
  std::uint64_t seed = 0;  ///< Seed of the random deviations of the steering rates.
  /// Ratio of lambda (in the weights exp(-cost/lambda)) to the spread of the roll-outs' costs [1],
  /// > 0.
  double temperature = 0.1;
  /// Scales the random deviations of the steering rate in the roll-outs [1], > 0. The factor
  /// on the steering-rate deviations multiplies the smaller one of two rates: the car's steering
  /// rate, and the rate at which random steering reaches the lateral grip at the end of the
  /// horizon.
  double noise = 1.0;
  /// Weight of the cross-track error [1/m^2], > 0; same default as in LqrOptions.
  std::optional<double> cross_track;
  double heading = 1.0;  ///< Weight of the heading error [1/rad^2], >= 0.
  /// Weight of the steering rate [s^2/rad^2], > 0; same default as in LqrOptions.
  std::optional<double> steering_rate;
  /// Clearance below which obstacles and edges add to the cost of a roll-out [m], >= 0; default: a
  /// quarter of the car's width.
  std::optional<double> margin;
  double grip = 1.0;  ///< Fraction of the lateral grip that is free of cost [1], > 0.
};
void Visit(KeyVisitor& keys, MppiOptions& options);

ControllerEntry MppiController();

}  // namespace trackbed
