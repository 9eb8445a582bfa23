#include "trackbed/control/optimal_steering_controller.h"

#include <algorithm>
#include <cmath>

#include "src/control/control_keys.h"
#include "src/control/preview_distance.h"
#include "src/control/turn_round.h"
#include "trackbed/core/angle.h"

namespace trackbed {
namespace {

class OptimalSteeringController final : public SteeringController {
 public:
  explicit OptimalSteeringController(const OptimalSteeringOptions& options) : options_(options) {
    if (options_.search.evaluations == 0) {
      options_.search.evaluations = ControlEvaluations(options_.search.method);
    }
  }

  double Steer(const ControlInput& input) override {
    const Primary primary = PrimaryAt(input);
    const double limit = std::min(options_.max_steering.value_or(input.vehicle.steering_limit),
                                  input.vehicle.steering_limit);
    const double speed = std::max(std::abs(input.state.speed), kCrawl);
    const int direction = input.reference.path.BendAt(input.station).direction;
    deviation_ = ComputeDeviation(input.state.pose, RelativePathPose(input, primary.station));
    const double planned = std::max(options_.horizon ? *options_.horizon : planned_.Next(input),
                                    options_.time * primary.speed.value_or(speed));
    const double horizon =
        options_.matching == Matching::kTime
            ? planned
            : std::max(planned, ReturnDistance(input.vehicle, speed, deviation_.y));
    if (const std::optional<double> steering = turn_round_.Steer(input)) {
      match_ = {.steering = std::clamp(*steering, -limit, limit)};
      last_ = match_.steering;
      return match_.steering;
    }
    const Pose2 wanted = RelativePathPose(input, primary.station + horizon);
    const Vec2 aim = ToLocal(input.state.pose, wanted.position());
    const SteeringProblem problem{
        .wanted = {aim.x(), aim.y(), wanted.yaw - input.state.pose.yaw},
        .distance = direction * horizon * speed / primary.speed.value_or(speed),
        .speed = speed,
        .steering = input.state.steering_actuator,
        .max_steering = limit,
        .start = last_.value_or(input.state.steering_actuator)};
    const double ahead =
        primary.station + std::abs(input.state.speed) *
                              (input.period + input.vehicle.steering_response.time_constant);
    const double feed_forward = std::clamp(
        SteeringForCurvature(input.vehicle, input.reference.path.BendAt(ahead).curvature), -limit,
        limit);
    match_ = Keeps(deviation_) && Keeps(DeviationAhead(input.vehicle, problem, feed_forward))
                 ? SteeringMatch{.steering = feed_forward}
                 : SearchSteering(input.vehicle, problem, options_.weights, options_.search);
    last_ = match_.steering;
    return match_.steering;
  }

  [[nodiscard]] std::vector<std::string> Columns() const override {
    return {"deviation_x_m", "deviation_y_m", "deviation_yaw_rad", "search_evaluations",
            "search_cost"};
  }

  [[nodiscard]] std::vector<double> Values() const override {
    return {deviation_.x, deviation_.y, deviation_.yaw, static_cast<double>(match_.evaluations),
            match_.cost};
  }

 private:
  /// Station of the primary, which is the path point to which the car is compared. Some matching
  /// methods also need the primary's planned speed.
  struct Primary {
    double station = 0.0;
    std::optional<double> speed;
  };

  [[nodiscard]] bool Keeps(const Deviation& deviation) const {
    return std::sqrt(DeviationCost(deviation, options_.weights)) <= options_.deviation_limit;
  }

  [[nodiscard]] Primary PrimaryAt(const ControlInput& input) const {
    if (options_.matching == Matching::kArcLength) {
      return {input.station, {}};
    }
    const double station = input.reference.speed.StationAt(input.plan_time);
    return {station, std::max(input.reference.speed.SpeedAt(station), kCrawl)};
  }

  /// Returns the path's pose at `station` with an unwrapped yaw. The returned yaw counts all
  /// turning of the path between the car and `station`, including full turns.
  static Pose2 RelativePathPose(const ControlInput& input, double station) {
    const Path& path = input.reference.path;
    const double here = path.At(input.station).pose.yaw;
    Pose2 pose = path.At(station).pose;
    pose.yaw += AngleDifference(here, input.state.pose.yaw) - here + input.state.pose.yaw;
    return pose;
  }

  OptimalSteeringOptions options_;
  std::optional<double> last_;  // steering angle at which the next search starts [rad]
  Deviation deviation_;
  SteeringMatch match_;
  HeldPreviewDistance planned_;
  TurnRound turn_round_;
};

std::vector<OptionProblem> CheckWeights(const OptimalSteeringOptions& options,
                                        const CouldReadKey& could_read) {
  if (!could_read("weights.position") || !could_read("weights.heading") ||
      options.weights.position != 0.0 || options.weights.heading != 0.0) {
    return {};
  }
  return {{"weights", "position and heading must not both be 0"}};
}

}  // namespace

ControllerEntry OptimalSteering() {
  return {
      .name = "optimal_steering",
      .summary =
          "searches the steering angle whose predicted pose is nearest to the path's pose ahead",
      .defaults = OptimalSteeringOptions{},
      .station = StationSource::kProjection,
      .needs_plan = true,
      .make = MakeBy<OptimalSteeringOptions, OptimalSteeringController>,
      .check = OnOptions<OptimalSteeringOptions, CheckWeights>};
}

}  // namespace trackbed
