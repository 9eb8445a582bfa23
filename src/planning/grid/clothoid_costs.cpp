#include "src/planning/grid/clothoid_costs.h"

#include <algorithm>
#include <cmath>

namespace trackbed {

ClothoidCosts::ClothoidCosts(const VehicleParams& vehicle, const HybridAStarOptions& options,
                             const ClothoidDrive& drive, double radius)
    : vehicle_(vehicle),
      options_(options),
      drive_(drive),
      radius_(radius),
      // A car may keep the lateral acceleration that it has at the start.
      lateral_acceleration_(
          std::max(drive.lateral_acceleration,
                   drive.start_speed * drive.start_speed * std::abs(drive.start_curvature))) {}

double ClothoidCosts::SharpnessAt(double speed) const {
  return drive_.steering_rate / (vehicle_.wheelbase * speed);
}

double ClothoidCosts::CurvatureAt(double speed) const {
  return lateral_acceleration_ / (speed * speed);
}

std::vector<double> ClothoidCosts::Speeds() const {
  const double fastest = std::max(drive_.speed, drive_.start_speed);
  const double slowest = std::min(drive_.min_speed, fastest);
  // Neighboring speeds differ by at most a factor of two.
  const double intervals = std::ceil(std::log2(fastest / slowest));
  std::vector<double> speeds;
  for (double i = 0.0; i < intervals; i += 1.0) {
    speeds.push_back(fastest * std::pow(slowest / fastest, i / intervals));
  }
  speeds.push_back(slowest);
  return speeds;
}

double ClothoidCosts::SpeedOn(const Segment& segment) const {
  double speed = std::max(drive_.speed, drive_.start_speed);
  if (segment.sharpness != 0.0) {
    speed =
        std::min(speed, drive_.steering_rate / (vehicle_.wheelbase * std::abs(segment.sharpness)));
  }
  const double curvature =
      std::max(std::abs(segment.curvature), std::abs(segment.CurvatureAt(segment.length)));
  if (speed * speed * curvature > lateral_acceleration_) {
    speed = std::sqrt(lateral_acceleration_ / curvature);
  }
  return speed;
}

double ClothoidCosts::Of(const Segment& before, const Segment& segment, bool is_reverse) const {
  const double v = drive_.speed;
  const double w = std::min(SpeedOn(segment), v);
  double cost = segment.length * v / w;
  double steered = std::abs(segment.CurvatureAt(segment.length) - segment.curvature);
  if (before.length > 0.0) {
    const double end = before.CurvatureAt(before.length);
    if (before.direction != segment.direction) {
      const double turned = std::abs(SteeringForCurvature(vehicle_, segment.curvature) -
                                     SteeringForCurvature(vehicle_, end));
      cost += options_.switch_cost + v * turned / vehicle_.steering_rate;
      steered += std::abs(segment.curvature - end);
    } else {
      const double other = std::min(SpeedOn(before), v);
      const double fast = std::max(w, other);
      const double slower = fast - std::min(w, other);
      // A car that slows down on a segment speeds up again later, which takes time, too. Slowing
      // down and speeding up cost the same: the mean of the time lost by braking and the time lost
      // by accelerating.
      const double per_acceleration = 0.5 / drive_.acceleration + 0.5 / drive_.deceleration;
      cost += 0.5 * slower * slower * per_acceleration * v / fast;
    }
  }
  return cost * (is_reverse ? options_.reverse_cost : 1.0) +
         options_.steering_cost * radius_ * steered;
}

bool ClothoidCosts::BrakesFor(const Segment& segment, double length) const {
  const double square =
      drive_.start_speed * drive_.start_speed - 2.0 * drive_.deceleration * length;
  if (square <= 0.0) {
    return true;
  }
  constexpr double kRounding = 1e-9;
  const double speed = SpeedOn(segment);
  return segment.direction > 0 && speed * speed >= square * (1.0 - kRounding);
}

}  // namespace trackbed
