#include "src/control/preview_distance.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "src/control/steering_limit.h"
#include "src/control/tracking.h"

namespace trackbed {
namespace {

constexpr double kWheelbases = 0.75;  ///< Minimum ratio of preview distance to wheelbase.
/// Minimum ratio of the preview distance R to v T, the distance driven at the speed v in the
/// response time T.
constexpr double kResponses = 3.0;
constexpr double kRampShare = 0.65;  ///< Factor of the ramp length S in the preview distance R.
/// Ratio of the distances of successive sampled stations from the car. A curvature step between two
/// sampled stations is assumed at the station closer to the car.
constexpr double kSpacingRatio = 1.3;

/// Computes the ramp length S [m], driven while the wheels lag behind the path, for a range of
/// stations that can be extended.
class RampScan {
 public:
  explicit RampScan(double turned)
      : min_minus_(turned), max_minus_(turned), min_plus_(turned), max_plus_(turned) {}

  /// Adds a station at the signed distance `s` [m] from the car. The argument `turned` is v
  /// delta/omega at the station [m], with the steering angle delta and the steering rate omega. A
  /// curvature step may lie anywhere within `gap` [m] before the added station.
  void Extend(double turned, double s, double gap) {
    if (s > 0.0) {
      ramp_ = std::max({ramp_, turned - s - min_minus_ + gap, max_plus_ - turned - s + gap});
    } else {
      ramp_ = std::max({ramp_, max_minus_ - turned + s + gap, turned + s - min_plus_ + gap});
    }
    min_minus_ = std::min(min_minus_, turned - s);
    max_minus_ = std::max(max_minus_, turned - s);
    min_plus_ = std::min(min_plus_, turned + s);
    max_plus_ = std::max(max_plus_, turned + s);
  }

  [[nodiscard]] double ramp() const { return ramp_; }

 private:
  double ramp_ = 0.0;
  // Extreme values of turned - s and turned + s over all sampled stations s added so far.
  double min_minus_;
  double max_minus_;
  double min_plus_;
  double max_plus_;
};

/// Returns the preview distance 0.65 S + v T, with the ramp length S, but at least `shortest`. The
/// argument `response` is the distance v T [m] driven in the response time T.
double RampPreview(const ControlInput& input, double speed, double response, double shortest) {
  const Path& path = input.reference.path;
  const VehicleParams& vehicle = input.vehicle;
  // Distance that the car drives while the wheels turn by one radian [m/rad].
  const double way = speed / vehicle.steering_rate;
  // Reuse the previous station's steering angle if the path's curvature has not changed, to save
  // time.
  std::optional<double> last_curvature;
  double last_turned = 0.0;
  const auto turned = [&](const PathBend& bend) {
    if (bend.curvature != last_curvature) {
      last_curvature = bend.curvature;
      last_turned = way * std::clamp(SteeringForCurvature(vehicle, bend.curvature),
                                     -vehicle.steering_limit, vehicle.steering_limit);
    }
    return last_turned;
  };
  const double longest = kRampShare * way * 2.0 * vehicle.steering_limit + response;
  const PathBend here = path.BendAt(input.station);
  RampScan scan(turned(here));
  double preview = shortest;
  bool ahead = true;
  bool behind = true;
  double near = 0.0;
  for (double far = 0.5 * shortest; near < longest && (ahead || behind); far *= kSpacingRatio) {
    for (const double side : {1.0, -1.0}) {
      bool& path_continues = side > 0.0 ? ahead : behind;
      if (!path_continues) {
        continue;
      }
      const double end = side > 0.0 ? path.length() : 0.0;
      const double left = side * (end - input.station);
      path_continues = far < left;
      const double s = std::min(far, left);
      if (s <= near) {
        continue;
      }
      const PathBend bend = path.BendAt(path_continues ? input.station + side * s : end);
      if (bend.direction != here.direction) {
        path_continues = false;  // at a cusp, the car stands still while the wheels turn
        continue;
      }
      scan.Extend(turned(bend), side * s, s - near);
    }
    const double distance = kRampShare * scan.ramp() + response;
    if (distance >= near) {
      preview = std::max(preview, distance);
    }
    near = far;
  }
  return preview;
}

/// Returns the lowest planned speed [m/s] within `distance` of the car, which drives at `speed`.
/// The plan slows down before curvature steps, so the car passes a curvature step at the lowest
/// planned speed. The returned speed is at least a quarter of `speed`, so that a planned stop does
/// not shrink the preview distance to zero.
double SlowestWithin(const ControlInput& input, double speed, double distance) {
  constexpr int kSamples = 6;
  // Lower bound of the returned speed as a fraction of the car's speed.
  constexpr double kMinSpeedFraction = 0.25;
  const SpeedProfile& profile = input.reference.speed;
  double slowest = speed;
  for (int i = -kSamples; i <= kSamples && !profile.knots().empty(); ++i) {
    const double s = input.station + distance * static_cast<double>(i) / kSamples;
    if (s >= 0.0) {
      slowest = std::min(slowest, std::max(profile.SpeedAt(s), kMinSpeedFraction * speed));
    }
  }
  return slowest;
}

}  // namespace

double ResponseTime(const VehicleParams& vehicle, double speed, double period) {
  const double tyres =
      HasTyres(vehicle) ? vehicle.mass * std::abs(speed) /
                              (vehicle.cornering_stiffness_front + vehicle.cornering_stiffness_rear)
                        : 0.0;
  return period + vehicle.steering_delay() + tyres;
}

double TyreDelay(const VehicleParams& vehicle, double speed) {
  if (!HasTyres(vehicle)) {
    return 0.0;
  }
  const double mass = vehicle.mass;
  const double to_rear = vehicle.cg_to_rear;
  const double to_front = vehicle.cg_to_front();
  const double front = vehicle.cornering_stiffness_front;
  const double rear = vehicle.cornering_stiffness_rear;
  const double wheelbase = vehicle.wheelbase;
  const double per_front = (mass * to_rear * to_rear + vehicle.yaw_inertia) / wheelbase;
  const double per_rear =
      (vehicle.yaw_inertia - mass * to_rear * to_front) / wheelbase + mass * to_front;
  const double understeer = mass / wheelbase * (to_rear / front - to_front / rear);
  // Above its critical speed, an oversteering car has no steady turn.
  const double length = wheelbase + std::max(understeer, 0.0) * speed * speed;
  return std::abs(speed) * (per_front / front + per_rear / rear) / length;
}

double ResponseDistance(const ControlInput& input) {
  const VehicleParams& vehicle = input.vehicle;
  const double speed = std::abs(input.state.speed);
  return speed * (input.period + vehicle.steering_delay() + TyreDelay(vehicle, speed));
}

double ShortestPreview(const VehicleParams& vehicle, double speed, double period, double delay) {
  // For a differential drive, `wheelbase` is the distance between the wheels of the axle.
  const double size = vehicle.kind == VehicleKind::kDifferential
                          ? std::max(vehicle.wheelbase, vehicle.length)
                          : vehicle.wheelbase;
  const double response = std::abs(speed) * (ResponseTime(vehicle, speed, period) + delay);
  return std::max(kWheelbases * size, kResponses * response);
}

double PreviewDistance(const ControlInput& input, double delay) {
  const double speed = std::abs(input.state.speed);
  const double response = speed * (ResponseTime(input.vehicle, speed, input.period) + delay);
  const double shortest = ShortestPreview(input.vehicle, speed, input.period, delay);
  const double far = RampPreview(input, speed, response, shortest);
  const double slower = SlowestWithin(input, speed, far);
  return slower < speed ? RampPreview(input, slower, response, shortest) : far;
}

double HeldPreviewDistance::Next(const ControlInput& input, double delay) {
  const int direction = input.reference.path.BendAt(input.station).direction;
  const double held =
      direction == direction_ ? distance_ - std::abs(input.state.speed) * input.period : 0.0;
  direction_ = direction;
  distance_ = std::max(PreviewDistance(input, delay), held);
  return distance_;
}

double ReturnDistance(const VehicleParams& vehicle, double speed, double offset) {
  // The factor kShare was determined by simulations with initial offsets of 0.2 to 4 m and preview
  // distances of 2 to 4 m. With kShare = 1.5, all cars converge to the path. With kShare = 1, some
  // cars oscillate about the path forever; with kShare = 2, all cars converge more slowly.
  constexpr double kShare = 1.5;
  // Multiple of wheelbase times steering rate. At lower speeds, the limit of the steering angle
  // restricts the car, not the limit of the steering rate.
  constexpr double kMinSpeed = 1.25;
  const double slowest = kMinSpeed * vehicle.wheelbase * vehicle.steering_rate;
  const double curvature_rate =
      vehicle.steering_rate / (vehicle.wheelbase * std::max(std::abs(speed), slowest));
  // Tyres and actuator respond late, so the car drives the distance `response` before it turns.
  const double response = std::abs(speed) * ResponseTime(vehicle, speed, 0.0);
  const double turning = kShare * std::cbrt(std::abs(offset) / curvature_rate) + response;
  // An arc from the cross-track offset e to a path point at the distance R has the curvature 2
  // e/R^2.
  const double gripping = std::abs(speed) * std::sqrt(2.0 * std::abs(offset) /
                                                      (kReturnGripShare * LateralGrip(vehicle)));
  return std::max(turning, gripping);
}

double ReturnDistance(const ControlInput& input) {
  const Vec2 foot = input.reference.path.At(input.station).pose.position();
  const double offset = (input.state.pose.position() - foot).norm();
  return ReturnDistance(input.vehicle, input.state.speed, offset);
}

}  // namespace trackbed
