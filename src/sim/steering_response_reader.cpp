#include "src/sim/steering_response_reader.h"

#include <fmt/format.h>

#include <cmath>
#include <span>
#include <string>
#include <vector>

namespace trackbed {
namespace {

/// Maximum dead time and time constant of a steering actuator [s]. With a dead time or time
/// constant above this maximum, the car could not be steered.
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

/// Adds the number steering_offset to the angles of the steering curve. If the model has no
/// steering curve, makes a curve that adds the offset to each commanded angle up to the limit.
void AddOffset(const Numerics& numerics, double limit, std::vector<Vec2>& curve) {
  const std::string name = "steering_offset";
  double offset = 0.0;
  numerics.Read(name, offset);
  if (!(std::abs(offset) < std::abs(limit))) {
    numerics.AddError(name, fmt::format("must be less than the steering limit of {:.4g} rad to "
                                        "either side, found {:.4g}",
                                        std::abs(limit), offset));
    return;
  }
  if (offset == 0.0) {
    return;
  }
  if (curve.empty()) {
    // Use points on a straight line: the monotone curve through such points is this line.
    for (const double part : {-1.0, -1.0 / 3.0, 1.0 / 3.0, 1.0}) {
      curve.emplace_back(part * std::abs(limit), part * std::abs(limit));
    }
  }
  for (Vec2& point : curve) {
    point.y() += offset;
  }
}

}  // namespace

SteeringResponse ReadSteeringResponse(const Numerics& numerics, double limit) {
  SteeringResponse response;
  response.curve = ReadCurve(numerics);
  AddOffset(numerics, limit, response.curve);
  ReadWithin(numerics, "steering_dead_time", kMaxResponseTime, "s", response.dead_time);
  ReadWithin(numerics, "steering_time_constant", kMaxResponseTime, "s", response.time_constant);
  ReadWithin(numerics, "steering_backlash", 2.0 * std::abs(limit), "rad", response.backlash);
  return response;
}

}  // namespace trackbed
