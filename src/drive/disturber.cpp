#include "src/drive/disturber.h"

#include <algorithm>
#include <boost/random/normal_distribution.hpp>
#include <cmath>

namespace trackbed {

VehicleParams BelievedBy(const Disturbances& disturbances, const CarModel& car) {
  VehicleParams vehicle = car.unladen();
  vehicle.wheelbase *= disturbances.wheelbase;
  return vehicle;
}

Disturber::Disturber(const Scenario& scenario)
    : scenario_(scenario),
      steering_(scenario.disturb.steering, scenario.drive.timestep, StartOf(scenario).steering),
      random_(scenario.seed) {}

std::optional<Pose2> Disturber::Measure(const Pose2& pose) {
  const MeasurementNoise& noise = scenario_.disturb.noise;
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

double Disturber::Slow(double acceleration, double speed, double time, double station) {
  const auto& loss = scenario_.disturb.speed_loss;
  if (!loss) {
    return acceleration;
  }
  constexpr double kSameTime = 1e-9;  // [s]
  slowed_ = slowed_ || (loss->station ? station >= *loss->station
                                      : time >= loss->from.value_or(0.0) - kSameTime);
  if (!slowed_) {
    return acceleration;
  }
  const SpeedControlOptions& options = scenario_.control.speed;
  const double toward = options.gain * (loss->speed - speed);
  return std::min(acceleration, std::max(toward, -2.0 * options.deceleration));
}

void Disturber::Kick(long step, Plant& plant) const {
  const double timestep = scenario_.drive.timestep;
  double force = 0.0;
  for (const trackbed::Kick& kick : scenario_.disturb.kicks) {
    const long first = std::lround(kick.at / timestep);
    if (kick.displacement && step == first) {
      plant.Shift(*kick.displacement);
    }
    const double duration = kick.duration.value_or(kKickDuration);
    const long steps = std::max(1L, std::lround(duration / timestep));
    if (kick.impulse && step >= first && step < first + steps) {
      force += *kick.impulse / (static_cast<double>(steps) * timestep);
    }
  }
  if (force != 0.0) {
    plant.Push(force);
  }
}

}  // namespace trackbed
