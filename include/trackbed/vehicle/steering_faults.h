#pragma once

#include <cstddef>
#include <vector>

/// Simulates faults between a steering controller and its actuator.
namespace trackbed {

/// The faults of the steering. For a commanded angle u(t), the actuator's input is u_3(t):
///   u_1(t) = factor u(t), for a steering ratio that differs from the controller's ratio
///   u_2(t) = u_1(t - delay), for a transport delay, as on a bus
///   u_3(t) with |u_3 - u_2| <= b/2, for the backlash b; changes only at the edges of the play.
/// If `factor` is 1, slow changes of the commanded angle pass unchanged except for the backlash.
struct SteeringFaults {
  /// Ratio of the road-wheel angle to the commanded angle, > 0.
  double factor = 1.0;
  double delay = 0.0;     ///< Transport delay of the command [s], >= 0.
  double backlash = 0.0;  ///< Backlash b, which is the total play at the road wheels [rad], >= 0.
};

/// Applies the faults of the steering to commanded angles. Guarantees: without faults, the
/// actuator's input equals the commanded angle, bit for bit. The transport delay is rounded to a
/// whole number of timesteps; the control period does not matter. Cost: O(1). Throws
/// PreconditionError if a parameter of the faults is not finite, or if the delay exceeds 10^7
/// timesteps.
class FaultySteering {
 public:
  /// The wheels and the actuator start at the angle `start` [rad], in the middle of the play, as
  /// after a long time of constant command. The argument `timestep` [s], > 0, is the time between
  /// calls of Pass.
  FaultySteering(const SteeringFaults& faults, double timestep, double start);

  /// Returns the angle [rad] that the actuator receives in the present timestep if `wanted` is
  /// commanded now.
  double Pass(double wanted);

 private:
  SteeringFaults faults_;
  std::vector<double> delay_line_;  // Ring buffer.
  std::size_t oldest_ = 0;
  double output_;
};

}  // namespace trackbed
