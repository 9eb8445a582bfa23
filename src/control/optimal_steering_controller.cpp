#include "src/control/optimal_steering_controller.h"

#include <algorithm>
#include <cmath>

#include "src/control/preview_distance.h"
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
    const Primary primary = PrimaryOf(input);
    const double limit = std::min(options_.max_steering.value_or(input.vehicle.steering_limit),
                                  input.vehicle.steering_limit);
    const double speed = std::max(std::abs(input.state.speed), kCrawl);
    const int direction = input.reference.path.At(input.station).direction;
    deviation_ = DeviationOf(input.state.pose, Seen(input, primary.station));
    const double planned = std::max(options_.horizon ? *options_.horizon : PreviewDistance(input),
                                    options_.time * primary.speed.value_or(speed));
    const double horizon =
        options_.matching == Matching::kTime
            ? planned
            : std::max(planned, ReturnDistance(input.vehicle, speed, deviation_.y));
    const Pose2 wanted = Seen(input, primary.station + horizon);
    const Vec2 aim = ToLocal(input.state.pose, wanted.position());
    const SteeringProblem problem{
        .wanted = {aim.x(), aim.y(), wanted.yaw - input.state.pose.yaw},
        .distance = direction * horizon * speed / primary.speed.value_or(speed),
        .speed = speed,
        .steering = input.state.steering_actuator,
        .max_steering = limit,
        .start = last_.value_or(input.state.steering_actuator)};
    const double ahead = primary.station + std::abs(input.state.speed) * input.period;
    const double feed_forward =
        std::clamp(SteeringForCurvature(input.vehicle, input.reference.path.At(ahead).curvature),
                   -limit, limit);
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
  /// Where the primary is, and how fast if that matters.
  struct Primary {
    double station = 0.0;
    std::optional<double> speed;
  };

  [[nodiscard]] bool Keeps(const Deviation& deviation) const {
    return std::sqrt(CostOf(deviation, options_.weights)) <= options_.deviation_limit;
  }

  [[nodiscard]] Primary PrimaryOf(const ControlInput& input) const {
    if (options_.matching == Matching::kArcLength) {
      return {input.station, {}};
    }
    const double station = input.reference.speed.StationAt(input.plan_time);
    return {station, std::max(input.reference.speed.SpeedAt(station), kCrawl)};
  }

  /// The path's pose at `station`, its yaw counted from that of the car so that turns in between
  /// count.
  static Pose2 Seen(const ControlInput& input, double station) {
    const Path& path = input.reference.path;
    const double here = path.At(input.station).pose.yaw;
    Pose2 pose = path.At(station).pose;
    pose.yaw += AngleDifference(here, input.state.pose.yaw) - here + input.state.pose.yaw;
    return pose;
  }

  OptimalSteeringOptions options_;
  std::optional<double> last_;  // where the next search begins [rad]
  Deviation deviation_;
  SteeringMatch match_;
};

}  // namespace

std::unique_ptr<SteeringController> MakeOptimalSteering(const OptimalSteeringOptions& options) {
  return std::make_unique<OptimalSteeringController>(options);
}

}  // namespace trackbed
