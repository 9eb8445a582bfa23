#include "src/drive/fault_injector.h"

#include <algorithm>
#include <boost/random/normal_distribution.hpp>
#include <cmath>

namespace trackbed {

VehicleParams NominalVehicle(const Disturbances& disturbances, VehicleParams vehicle) {
  vehicle.wheelbase *= disturbances.wheelbase;
  return vehicle;
}

FaultInjector::FaultInjector(const Disturbances& disturbances, const Options& options)
    : disturbances_(disturbances),
      options_(options),
      steering_(disturbances.steering, options.timestep, options.start_steering),
      random_(options.seed) {}

std::optional<Pose2> FaultInjector::Measure(const Pose2& pose) {
  const MeasurementNoise& noise = disturbances_.noise;
  if (noise.position == 0.0 && noise.heading == 0.0) {
    return std::nullopt;
  }
  boost::random::normal_distribution<double> normal;
  const double x = normal(random_);
  const double y = normal(random_);
  const double yaw = normal(random_);
  return Pose2{pose.x + noise.position * x, pose.y + noise.position * y,
               pose.yaw + noise.heading * yaw};
}

double FaultInjector::LimitSpeed(double acceleration, double speed, double time, double station) {
  const auto& loss = disturbances_.speed_loss;
  if (!loss) {
    return acceleration;
  }
  constexpr double kSameTime = 1e-9;  // [s]
  speed_lost_ = speed_lost_ || (loss->station ? station >= *loss->station
                                              : time >= loss->from.value_or(0.0) - kSameTime);
  if (!speed_lost_) {
    return acceleration;
  }
  const double toward = options_.speed.gain * (loss->speed - speed);
  return std::min(acceleration, std::max(toward, -2.0 * options_.speed.deceleration));
}

void FaultInjector::Kick(long step, Plant& plant) const {
  const double timestep = options_.timestep;
  double force = 0.0;
  for (const trackbed::Kick& kick : disturbances_.kicks) {
    const long first = std::lround(kick.at / timestep);
    if (kick.displacement && step == first) {
      plant.ApplyLateralOffset(*kick.displacement);
    }
    const double duration = kick.duration.value_or(kKickDuration);
    const long steps = std::max(1L, std::lround(duration / timestep));
    if (kick.impulse && step >= first && step < first + steps) {
      force += *kick.impulse / (static_cast<double>(steps) * timestep);
    }
  }
  if (force != 0.0) {
    plant.ApplyLateralForce(force);
  }
}

}  // namespace trackbed
