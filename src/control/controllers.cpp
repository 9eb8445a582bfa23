#include "trackbed/control/controllers.h"

#include <cmath>

#include "src/control/actuator_model.h"
#include "trackbed/control/lqr.h"
#include "trackbed/control/mpc.h"
#include "trackbed/control/mppi.h"
#include "trackbed/control/optimal_steering_controller.h"
#include "trackbed/control/playback.h"
#include "trackbed/control/preview.h"
#include "trackbed/control/preview_integral.h"
#include "trackbed/control/pure_pursuit.h"
#include "trackbed/control/rear_axle_feedback.h"
#include "trackbed/control/schedule.h"
#include "trackbed/control/stanley.h"
#include "trackbed/control/steering_profile.h"
#include "trackbed/control/surroundings.h"
#include "trackbed/options/registry.h"

namespace trackbed {
namespace {

/// Returns the registry of controllers, a table with one line per controller.
Registry<ControllerEntry>& ControllerRegistry() {
  static Registry<ControllerEntry> table("controller", {
                                                           ScheduleController(),
                                                           PreviewController(),
                                                           PreviewIntegralController(),
                                                           OptimalSteering(),
                                                           PurePursuitController(),
                                                           StanleyController(),
                                                           RearAxleFeedbackController(),
                                                           LqrController(),
                                                           MpcController(),
                                                           MppiController(),
                                                           ConstantSteering(),
                                                           StepSteering(),
                                                           RampSteering(),
                                                           SineSteering(),
                                                           SineWithDwell(),
                                                           SweptSine(),
                                                           Playback(),
                                                       });
  return table;
}

/// Rejects invalid vehicle states before the controller computes a steering angle.
class ValidatingController final : public SteeringController, public SeesSurroundings {
 public:
  explicit ValidatingController(std::unique_ptr<SteeringController> inner)
      : inner_(std::move(inner)) {}

  double Steer(const ControlInput& input) override {
    Check(input);
    return inner_->Steer(input);
  }

  std::optional<double> Accelerate(const ControlInput& input) override {
    Check(input);
    return inner_->Accelerate(input);
  }

  void See(const Surroundings& surroundings) override {
    if (auto* const sees = dynamic_cast<SeesSurroundings*>(inner_.get())) {
      sees->See(surroundings);
    }
  }

  [[nodiscard]] std::vector<std::string> Columns() const override { return inner_->Columns(); }

  [[nodiscard]] std::vector<double> Values() const override { return inner_->Values(); }

  [[nodiscard]] std::unique_ptr<SteeringController> Clone() const override {
    std::unique_ptr<SteeringController> inner = inner_->Clone();
    return inner ? std::make_unique<ValidatingController>(std::move(inner)) : nullptr;
  }

 private:
  static void Check(const ControlInput& input) {
    const VehicleState& state = input.state;
    for (const double number :
         {state.time, state.pose.x, state.pose.y, state.pose.yaw, state.speed, state.distance,
          state.lateral_speed, state.yaw_rate, state.steering_actuator, state.steering,
          input.station, input.plan_time, input.speed_gain}) {
      TRACKBED_CHECK(
          std::isfinite(number),
          "the car's state at {} s is not finite: x {}, y {}, yaw {}, speed {}, distance "
          "{}, lateral speed {}, yaw rate {}, steering {} and {}, station {}",
          state.time, state.pose.x, state.pose.y, state.pose.yaw, state.speed, state.distance,
          state.lateral_speed, state.yaw_rate, state.steering_actuator, state.steering,
          input.station);
    }
    TRACKBED_CHECK(input.period > 0.0 && std::isfinite(input.period), "a control period of {} s",
                   input.period);
  }

  std::unique_ptr<SteeringController> inner_;
};

}  // namespace

const std::vector<ControllerEntry>& Controllers() {
  return ControllerRegistry().entries();
}

void RegisterController(ControllerEntry entry) {
  ControllerRegistry().Add(std::move(entry));
}

const ControllerEntry& ControllerFor(const ControllerOptions& options) {
  return ControllerRegistry().For(options);
}

std::unique_ptr<SteeringController> MakeSteeringController(const ControllerOptions& options,
                                                           ActuatorKnowledge actuator) {
  ControllerOptions own = options;
  RequireInRange("MakeSteeringController", [&](KeyVisitor& keys) { Visit(keys, own); });
  const ControllerEntry& entry = ControllerFor(options);
  std::unique_ptr<SteeringController> controller = entry.make(options);
  if (entry.needs_plan && entry.station == StationSource::kProjection) {
    controller = WithActuatorModel(std::move(controller), actuator);
  }
  return std::make_unique<ValidatingController>(std::move(controller));
}

}  // namespace trackbed
