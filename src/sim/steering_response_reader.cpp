#include "src/sim/steering_response_reader.h"

#include <fmt/format.h>

#include <cmath>
#include <span>
#include <string>
#include <vector>

namespace trackbed {
namespace {

/// Maximum dead time and time constant of a steering actuator [s]. With a larger dead time or time
/// constant, the car could not be steered.
constexpr double kMaxResponseTime = 10.0;

void ReadWithin(const Numerics& numerics, const std::string& name, double max, const char* unit,
                double& value) {
  numerics.Read(name, value);
  if (!(value >= 0.0 && value <= max)) {
    numerics.AddError(
        name, fmt::format("must be between 0 and {:.4g} {}, found {:.4g}", max, unit, value));
    value = 0.0;
  }
}

std::vector<Vec2> ReadCurve(const Numerics& numerics) {
  const std::string name = "steering_curve";
  const std::span<const double> numbers = numerics.List(name);
  if (numbers.empty()) {
    return {};
  }
  if (numbers.size() < 8 || numbers.size() % 2 != 0) {
    numerics.AddError(name,
                      fmt::format("has {} numbers; must be pairs of commanded angle and angle "
                                  "of the road wheels [rad], at least four",
                                  numbers.size()));
    return {};
  }
  std::vector<Vec2> curve;
  for (std::size_t i = 0; i < numbers.size(); i += 2) {
    curve.emplace_back(numbers[i], numbers[i + 1]);
    const bool rises = i == 0 || (numbers[i] > numbers[i - 2] && numbers[i + 1] > numbers[i - 1]);
    if (!curve.back().allFinite() || !rises) {
      numerics.AddError(name, fmt::format("pair {} is {:.4g} {:.4g}; both numbers must increase "
                                          "from pair to pair",
                                          i / 2 + 1, numbers[i], numbers[i + 1]));
      return {};
    }
  }
  return curve;
}

}  // namespace

SteeringResponse ReadSteeringResponse(const Numerics& numerics, double limit) {
  SteeringResponse response;
  response.curve = ReadCurve(numerics);
  ReadWithin(numerics, "steering_dead_time", kMaxResponseTime, "s", response.dead_time);
  ReadWithin(numerics, "steering_time_constant", kMaxResponseTime, "s", response.time_constant);
  ReadWithin(numerics, "steering_backlash", 2.0 * std::abs(limit), "rad", response.backlash);
  return response;
}

}  // namespace trackbed
