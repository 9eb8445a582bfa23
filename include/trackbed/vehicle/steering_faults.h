#pragma once

#include <cstddef>
#include <vector>

/// Faults between a steering controller and its actuator.
namespace trackbed {

/// The faults determine the actuator's input u_3(t) for a commanded angle u(t):
///   u_1(t) = factor u(t)             a steering ratio that differs from the controller's
///   u_2(t) = u_1(t - delay)          transport delay, as on a bus
///   u_3(t), with |u_3 - u_2| <= b/2  backlash b: changes only at the edges of the play
/// Slow changes pass unchanged except for the backlash.
struct SteeringFaults {
  /// Factor from the commanded angle to that of the road wheels, > 0.
  double factor = 1.0;
  double delay = 0.0;     ///< Transport delay [s], >= 0.
  double backlash = 0.0;  ///< Backlash b, the total play at the road wheels [rad], >= 0.
};

/// Applies the faults to commanded angles. Guarantees: without faults, the output equals the input,
/// bit for bit. The delay is rounded to a whole number of timesteps, for any control period. Cost
/// O(1). PreconditionError for numbers that are not finite, or a delay of more than 10^7 timesteps.
class FaultySteering {
 public:
  /// Wheels and actuator start at `start` [rad], in the middle of the play. The initial state is
  /// that after a long constant command. `timestep` [s] > 0 is the time between calls of Pass.
  FaultySteering(const SteeringFaults& faults, double timestep, double start);

  /// The angle [rad] that the actuator receives now if `wanted` is commanded now.
  double Pass(double wanted);

 private:
  SteeringFaults faults_;
  std::vector<double> delay_line_;  // Ring buffer.
  std::size_t oldest_ = 0;
  double output_;
};

}  // namespace trackbed
