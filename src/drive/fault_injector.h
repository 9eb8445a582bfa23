#pragma once

#include <boost/random/mersenne_twister.hpp>
#include <cstdint>
#include <optional>

#include "trackbed/control/speed_controller.h"
#include "trackbed/scenario/disturbances.h"
#include "trackbed/sim/plant.h"
#include "trackbed/vehicle/steering_faults.h"

namespace trackbed {

/// Returns the vehicle parameters that the controller assumes, including the configured error of
/// the wheelbase.
VehicleParams NominalVehicle(const Disturbances& disturbances, VehicleParams vehicle);

/// Injects the disturbances of one run. The random numbers depend only on the seed, so all plants
/// get the same disturbances.
class FaultInjector {
 public:
  struct Options {
    double timestep = 0.0;        ///< Timestep of the physics [s].
    double start_steering = 0.0;  ///< Initial angle of wheels and actuator [rad].
    /// Options of the speed control; their gain and deceleration determine how a speed loss slows
    /// the car down.
    SpeedControlOptions speed{};
    std::uint64_t seed = 0;
  };

  FaultInjector(const Disturbances& disturbances, const Options& options);

  /// Returns a noisy measurement of the car's pose for this control period; nullopt if no noise is
  /// configured.
  std::optional<Pose2> Measure(const Pose2& pose);

  /// Returns the commanded acceleration [m/s^2], reduced if a speed loss (a fault) is active.
  /// Acceleration and `speed` [m/s] are positive in the direction of the gear. `station` [m] is
  /// counted from the start of the run, as in the log.
  double LimitSpeed(double acceleration, double speed, double time, double station);

  /// Applies the steering faults to a commanded steering angle. Returns the steering angle that the
  /// actuator receives in the coming physics step [rad].
  double Steer(double wanted) { return steering_.Pass(wanted); }

  /// Applies the lateral kicks (disturbances of the car's motion) that are due in the physics step
  /// `step`, counted from 0.
  void Kick(long step, Plant& plant) const;

 private:
  Disturbances disturbances_;
  Options options_;
  FaultySteering steering_;
  boost::random::mt19937_64 random_;
  bool speed_lost_ = false;
};

}  // namespace trackbed
