#pragma once

#include <boost/random/mersenne_twister.hpp>
#include <optional>

#include "trackbed/scenario/scenario.h"
#include "trackbed/sim/plant.h"

namespace trackbed {

/// The car as its controller takes it to be.
VehicleParams BelievedBy(const Disturbances& disturbances, const CarModel& car);

/// Does to one drive what its scenario's section `disturb` says; without that, nothing. Random
/// numbers are those of the scenario's seed, the same on every plant.
class Disturber {
 public:
  explicit Disturber(const Scenario& scenario);

  /// What is measured of a pose in this control period; none without noise.
  std::optional<Pose2> Measure(const Pose2& pose);

  /// The acceleration [m/s^2] that is left of a wanted one, along the gear, for a car with `speed`
  /// [m/s] along the gear at `station` of the log.
  double Slow(double acceleration, double speed, double time, double station);

  /// The steering angle [rad] that reaches the actuator in the coming physics step.
  double Steer(double wanted) { return steering_.Pass(wanted); }

  /// Kicks the car if this, the drive's `step`-th physics step from 0, is one in which it is.
  void Kick(long step, Plant& plant) const;

 private:
  const Scenario& scenario_;
  FaultySteering steering_;
  boost::random::mt19937_64 random_;
  bool slowed_ = false;
};

}  // namespace trackbed
