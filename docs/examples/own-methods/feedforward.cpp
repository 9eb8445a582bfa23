#include <trackbed/control/steering_controller.h>
#include <trackbed/core/angle.h>

#include <algorithm>
#include <cmath>

using namespace trackbed;

/// Options of a controller that steers by the mean curvature of the path near the car, corrected by
/// the cross-track and heading errors of the rear axle.
struct FeedforwardOptions {
  double time = 2.0;      ///< Driving time over which the curvature is averaged [s], > 0.
  double distance = 6.0;  ///< Driven distance over which tracking errors decay [m], > 0.
};

void Visit(KeyVisitor& keys, FeedforwardOptions& options) {
  keys.Field({"time", "s", "of the mean curvature"}, options.time, Need::kOptional, kPositive);
  keys.Field({"distance", "m", "over which errors die out"}, options.distance, Need::kOptional,
             kPositive);
}

class FeedforwardController final : public SteeringController {
 public:
  explicit FeedforwardController(const FeedforwardOptions& options) : options_(options) {}

  // kappa = kappa_mean - 2 psi/d - e/d^2: tracking errors decay as exp(-s/d), critically damped.
  double Steer(const ControlInput& input) override {
    const Path& path = input.reference.path;
    const double speed = std::max(std::abs(input.state.speed), 0.1);
    const double middle = input.station + speed * input.period;
    const double half = 0.5 * speed * options_.time;
    const double mean =
        AngleDifference(path.At(middle + half).pose.yaw, path.At(middle - half).pose.yaw) /
        (2.0 * half);
    const Pose2 foot = path.At(input.station).pose;
    const double e = ToLocal(foot, input.state.pose.position()).y();
    const double psi = AngleDifference(input.state.pose.yaw, foot.yaw);
    const double d = options_.distance;
    return SteeringForCurvature(input.vehicle, mean - 2.0 * psi / d - e / (d * d));
  }

 private:
  FeedforwardOptions options_;
};

ControllerEntry Feedforward() {
  return {.name = "feedforward",
          .summary = "path curvature with proportional feedback",
          .defaults = FeedforwardOptions{},
          .make = MakeBy<FeedforwardOptions, FeedforwardController>};
}
