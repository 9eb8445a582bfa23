#include "trackbed/control/preview.h"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>

#include "src/control/control_keys.h"
#include "src/control/preview_distance.h"
#include "src/control/tracking.h"
#include "src/control/turn_round.h"
#include "trackbed/core/angle.h"

namespace trackbed {
namespace {

/// Returns the heading error [rad] of the car in the steady turn on its path. The curvature of the
/// turn is the mean over the next wheelbase, so that a short flaw of the path does not move the
/// wheels. A car without tyre coefficients heads along its path.
double SteadyHeading(const ControlInput& input, int direction) {
  if (!HasTyres(input.vehicle)) {
    return 0.0;
  }
  const Path& path = input.reference.path;
  const double ahead = input.vehicle.wheelbase;
  const double turned =
      AngleDifference(path.At(input.station + ahead).pose.yaw, path.At(input.station).pose.yaw);
  const double curvature = turned / (direction * ahead);
  const double speed = direction * std::abs(input.state.speed);
  // A slip angle of SteadyTurnOn is the ratio of the lateral to the longitudinal speed.
  return std::atan(SteadyTurnOn(input.vehicle, curvature, speed).heading_error);
}

class Preview final : public SteeringController {
 public:
  explicit Preview(const PreviewOptions& options) : options_(options) {}

  double Steer(const ControlInput& input) override {
    const double shortest = options_.distance ? *options_.distance : planned_.Next(input);
    const double distance =
        std::max({shortest, options_.time * std::abs(input.state.speed), ReturnDistance(input)});
    const double angle =
        PreviewAngle(input.reference.path, input.state.pose, input.station, distance);
    if (const std::optional<double> steering = turn_round_.Steer(input, angle)) {
      return *steering;
    }
    const int direction = input.reference.path.BendAt(input.station).direction;
    // In the steady turn, the heading differs from the direction of motion.
    const double u = angle + (options_.slip ? SteadyHeading(input, direction) : 0.0);
    // In reverse gear, steering to the right turns the direction of motion to the left.
    const double bend =
        direction * 2.0 / distance * (options_.law == PreviewLaw::kLinear ? u : std::sin(u));
    const double limit = input.vehicle.steering_limit;
    return std::clamp(SteeringOn(input, bend, direction), -limit, limit);
  }

 private:
  /// Returns the steering angle delta for a curvature [rad].
  [[nodiscard]] double SteeringOn(const ControlInput& input, double curvature,
                                  int direction) const {
    const double speed = direction * std::abs(input.state.speed);
    const SteadyTurn turn = options_.slip ? SteadyTurnOn(input.vehicle, curvature, speed)
                                          : TurnWithoutSlip(input.vehicle, curvature, speed);
    return options_.law == PreviewLaw::kLinear ? std::tan(turn.steering) : turn.steering;
  }

  PreviewOptions options_;
  HeldPreviewDistance planned_;
  TurnRound turn_round_;
};

/// Returns the station of the first path point after `station` that is `distance` away from the
/// point `p`.
double PreviewStation(const Path& path, const Vec2& p, double station, double distance) {
  const auto beyond = [&](double s) { return (path.At(s).pose.position() - p).norm() - distance; };
  if (beyond(station) >= 0.0) {
    return station + distance;
  }
  // A path leaves the circle with radius `distance` around `p` no earlier than a straight line
  // would. Steps of an eighth of the distance find the first crossing if the path's radii of
  // curvature are larger than a step.
  const double stride = distance / 8.0;
  double inside = station;
  while (beyond(inside + stride) < 0.0) {
    if (inside + stride == inside) {
      return station + distance;  // the distance is smaller than the rounding error of the station
    }
    inside += stride;
  }
  std::uintmax_t iterations = 100;
  const auto [low, high] = boost::math::tools::toms748_solve(
      beyond, inside, inside + stride, boost::math::tools::eps_tolerance<double>(48), iterations);
  return 0.5 * (low + high);
}

}  // namespace

double PreviewAngle(const Path& path, const Pose2& pose, double station, double distance) {
  TRACKBED_REQUIRE(distance > 0.0 && std::isfinite(distance) && std::isfinite(station),
                   "PreviewAngle: {} m ahead of station {} m; must be finite, ahead", distance,
                   station);
  const double s = PreviewStation(path, pose.position(), station, distance);
  // In reverse, the direction of motion is opposite to the heading.
  const Vec2 to_point = path.BendAt(station).direction * ToLocal(pose, path.At(s).pose.position());
  return std::atan2(to_point.y(), to_point.x());
}

void Visit(KeyVisitor& keys, PreviewOptions& options) {
  keys.Field(
      {"distance", "m",
       "minimum lookahead distance ahead of the rear axle; default: from car, speed and path"},
      options.distance, kAhead);
  keys.Field(kAheadTime, options.time, Need::kOptional, kNonNegative);
  static const EnumNames<PreviewLaw> laws{{PreviewLaw::kLinear, "linear"},
                                          {PreviewLaw::kExactArc, "exact_arc"}};
  keys.Field({"law", "",
              "steering law: MacAdam's gain on the angle to the preview point, or the arc through "
              "the point"},
             options.law, Need::kOptional, laws);
  keys.Field({"slip", "", "whether to account for tyre slip"}, options.slip, Need::kOptional);
}

ControllerEntry PreviewController() {
  return {.name = "preview",
          .summary = "steers to the path point at a preview distance (MacAdam, one point)",
          .defaults = PreviewOptions{},
          .station = StationSource::kProjection,
          .needs_plan = true,
          .make = MakeBy<PreviewOptions, Preview>};
}

}  // namespace trackbed
