#pragma once

#include <deque>

/// What comes between a controller and a steering actuator that are not made for each other.
namespace trackbed {

/// Of a wanted angle u(t) the actuator gets to see
///   u_1(t) = factor u(t)             a steering ratio that is another than the controller's
///   u_2(t) = u_1(t - delay)          transport, as on a bus
///   u_3(t), with |u_3 - u_2| <= b/2  play b: it moves only where it would come out of it
/// Nothing is lost of a change that is slower than all of it, but the play.
struct SteeringFaults {
  double factor = 1.0;    ///< wanted angle to that of the road wheels, > 0
  double delay = 0.0;     ///< [s], >= 0
  double backlash = 0.0;  ///< b, the whole play, at the road wheels [rad], >= 0
};

/// Guarantees: without faults, what is asked for comes out, bit for bit. The delay is the whole
/// number of timesteps nearest to it, whatever the control period is. Cost O(1).
class FaultySteering {
 public:
  /// Wheels and actuator stand at `start` [rad], in the middle of the play, and nothing else has
  /// been asked for before. `timestep` [s] > 0 is the time from one Pass to the next.
  FaultySteering(const SteeringFaults& faults, double timestep, double start);

  /// The angle [rad] that the actuator is given now, when `wanted` is asked for now.
  double Pass(double wanted);

 private:
  SteeringFaults faults_;
  std::deque<double> on_the_way_;  // oldest first
  double given_;
};

}  // namespace trackbed
