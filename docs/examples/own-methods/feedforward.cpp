#include <trackbed/control/steering_controller.h>
#include <trackbed/core/angle.h>

#include <cmath>

#include "trackbed/control/steering_controller.h"

using namespace trackbed;

/// The path's curvature, corrected by the cross-track and heading errors of the rear axle.
struct FeedforwardOptions {
  double distance = 4.0;  ///< over which both errors die out [m], > 0
};

void Visit(KeyVisitor& keys, FeedforwardOptions& options) {
  keys.Field({"distance", "m", "over which errors die out"}, options.distance, Need::kOptional,
             kPositive);
}

class FeedforwardController final : public SteeringController {
 public:
  explicit FeedforwardController(const FeedforwardOptions& options) : options_(options) {}

  // kappa = kappa_path - 2 psi/d - e/d^2: the errors of a slow car decay as exp(-s/d), critically
  // damped.
  double Steer(const ControlInput& input) override {
    const double ahead = std::abs(input.state.speed) * input.period;
    const PathPoint foot = input.reference.path.At(input.station);
    const double e = ToLocal(foot.pose, input.state.pose.position()).y();
    const double psi = AngleDifference(input.state.pose.yaw, foot.pose.yaw);
    const double d = options_.distance;
    const double curvature = input.reference.path.At(input.station + ahead).curvature;
    return SteeringForCurvature(input.vehicle, curvature - 2.0 * psi / d - e / (d * d));
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
