#pragma once

#include <boost/random/mersenne_twister.hpp>
#include <cstdint>
#include <optional>

#include "trackbed/control/speed_controller.h"
#include "trackbed/scenario/disturbances.h"
#include "trackbed/sim/plant.h"
#include "trackbed/vehicle/steering_faults.h"

namespace trackbed {

/// The vehicle as its controller takes it to be.
VehicleParams NominalVehicle(const Disturbances& disturbances, VehicleParams vehicle);

/// Injects disturbances into one run; without any, nothing. Random numbers are those of the seed,
/// the same on every plant.
class FaultInjector {
 public:
  struct Options {
    double timestep = 0.0;        ///< of the physics [s]
    double start_steering = 0.0;  ///< of wheels and actuator [rad]
    SpeedControlOptions speed{};  ///< by which a speed loss brakes
    std::uint64_t seed = 0;
  };

  FaultInjector(const Disturbances& disturbances, const Options& options);

  /// What is measured of a pose in this control period; none without noise.
  std::optional<Pose2> Measure(const Pose2& pose);

  /// The acceleration [m/s^2] that is left of a wanted one, along the gear, for a car with `speed`
  /// [m/s] along the gear at `station` of the log.
  double LimitSpeed(double acceleration, double speed, double time, double station);

  /// The steering angle [rad] that reaches the actuator in the coming physics step.
  double Steer(double wanted) { return steering_.Pass(wanted); }

  /// Kicks the car if this, the run's `step`-th physics step from 0, is one in which it is.
  void Kick(long step, Plant& plant) const;

 private:
  Disturbances disturbances_;
  Options options_;
  FaultySteering steering_;
  boost::random::mt19937_64 random_;
  bool speed_lost_ = false;
};

}  // namespace trackbed
