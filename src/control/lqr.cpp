#include "trackbed/control/lqr.h"

#include <algorithm>
#include <cmath>

#include "src/control/bounded_regulator.h"
#include "src/control/control_keys.h"
#include "src/control/error_model.h"
#include "src/control/ramped_path.h"
#include "src/control/turn_round.h"

namespace trackbed {
namespace {

class Lqr final : public SteeringController {
 public:
  explicit Lqr(const LqrOptions& options) : options_(options) {}

  double Steer(const ControlInput& input) override {
    if (const std::optional<double> steering = turn_round_.Steer(input)) {
      return angle_.Approach(input, *steering);
    }
    const VehicleParams& vehicle = input.vehicle;
    const auto steps = static_cast<long>(std::ceil(options_.preview / input.period));
    path_.Update(input, DistanceAhead(input, input.period, steps));
    const Tracking tracking = path_.Track();
    const ErrorModel model = MakeErrorModel(input, tracking, input.period, options_.tyres);
    Ahead ahead(input, tracking, model, &path_);
    ErrorModel::Vector z = ErrorState(input, tracking, options_.tyres) - ahead.steady();
    ErrorWeights weights = WeightsFor(vehicle, options_, model.speed, input.period);
    const Regulator regulator = ScheduledRegulator(model, vehicle.steering_rate, weights, z);

    bounded_.Clear();
    for (long k = 0; k < steps; ++k) {
      const ErrorModel::Vector push = ahead.Next();
      bounded_.Append(push, ahead.rate());
    }
    const double rate = bounded_.Input(model, regulator, z, vehicle.steering_rate);
    return angle_.Turn(input, rate);
  }

 private:
  LqrOptions options_;
  CommandedAngle angle_;
  RampedPath path_;
  BoundedRegulator bounded_;
  TurnRound turn_round_;
};

}  // namespace

ControllerEntry LqrController() {
  return {.name = "lqr",
          .summary = "linear-quadratic regulator with preview of the path's curvature",
          .defaults = LqrOptions{},
          .station = StationSource::kProjection,
          .needs_plan = true,
          .make = MakeBy<LqrOptions, Lqr>};
}

void Visit(KeyVisitor& keys, LqrOptions& options) {
  keys.Field(kCrossTrackWeight, options.cross_track, kWeight);
  keys.Field(kHeadingWeight, options.heading, Need::kOptional, Range{.min = 0.0, .max = 1e6});
  keys.Field(kRateWeight, options.steering_rate, kWeight);
  Visit(keys, options.tyres);
  keys.Field({"preview", "s", "preview time of the path's curvature"}, options.preview,
             Need::kOptional, Range{.min = 0.0, .max = 20.0});
}

}  // namespace trackbed
