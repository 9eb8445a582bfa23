#include "trackbed/planning/common/path_pieces.h"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <limits>

#include "trackbed/vehicle/steady_turn.h"

namespace trackbed {
double SteeringSlope(const VehicleParams& vehicle, const Bend& bend) {
  const double tangent = vehicle.wheelbase * bend.curvature;
  return vehicle.wheelbase * std::abs(bend.sharpness) / (1.0 + tangent * tangent);
}

double SteeringRateOn(const VehicleParams& vehicle, std::span<const Bend> bends,
                      const PieceSpeed& speed) {
  double largest = 0.0;
  for (const Bend& bend : bends) {
    // Use the larger of the steering rates with and without slip, because kinematic plants drive
    // the same plan without slip.
    largest = std::max(largest, SteeringSlope(vehicle, bend) * speed.speed);
    if (HasTyres(vehicle)) {
      const double rate = SteeringRateInBend(vehicle, {.curvature = bend.curvature,
                                                       .sharpness = bend.sharpness,
                                                       .speed = speed.direction * speed.speed,
                                                       .acceleration = speed.acceleration,
                                                       .road = speed.road});
      largest = std::max(largest, std::abs(rate));
    }
  }
  return largest;
}

double SpeedForSteeringRate(const VehicleParams& vehicle, std::span<const Bend> bends, double rate,
                            const PieceSpeed& at) {
  const auto beyond = [&](double speed) {
    PieceSpeed slower = at;
    slower.speed = speed;
    return SteeringRateOn(vehicle, bends, slower) - rate;
  };
  const double high = beyond(at.speed);
  if (rate <= 0.0 || high <= 0.0) {
    return std::numeric_limits<double>::infinity();
  }
  if (!HasTyres(vehicle)) {  // without slip, the steering rate is proportional to the speed
    return rate / SteeringRateOn(vehicle, bends, {.speed = 1.0});
  }
  const auto close = [](double low, double upper) { return upper - low <= 1e-9 * upper; };
  std::uintmax_t iterations = 100;
  return boost::math::tools::toms748_solve(beyond, 0.0, at.speed, -rate, high, close, iterations)
      .first;
}

}  // namespace trackbed
