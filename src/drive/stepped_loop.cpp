#include "trackbed/drive/stepped_loop.h"

#include <cmath>
#include <utility>

#include "src/drive/loop_core.h"
#include "src/drive/loop_preconditions.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

/// Returns commands that the caller of SteppedLoop::Step gave. The controller columns of the log
/// still contain the values of the scenario's controller.
class GivenCommands final : public SteeringController {
 public:
  GivenCommands(const SteeringController& own, double steering, std::optional<double> acceleration)
      : own_(own), steering_(steering), acceleration_(acceleration) {}

  double Steer(const ControlInput& /*input*/) override { return steering_; }
  std::optional<double> Accelerate(const ControlInput& /*input*/) override { return acceleration_; }
  [[nodiscard]] std::vector<std::string> Columns() const override { return own_.Columns(); }
  [[nodiscard]] std::vector<double> Values() const override { return own_.Values(); }

 private:
  const SteeringController& own_;
  double steering_;
  std::optional<double> acceleration_;
};

template <typename Part>
std::unique_ptr<Part> Copied(const Part& part, const char* what, const char* function) {
  std::unique_ptr<Part> copy = part.Clone();
  if (!copy) {
    throw InputError(Problem{.message = fmt::format("the {} of this loop cannot be copied, because "
                                                    "its class does not implement {}",
                                                    what, function)});
  }
  return copy;
}

}  // namespace

struct SteppedLoop::Parts {
  std::shared_ptr<const void> owner;
  std::shared_ptr<const LoopConfig> config;
  std::unique_ptr<Plant> plant;
  std::unique_ptr<SteeringController> controller;
  std::unique_ptr<LoopCore> core{};
};

SteppedLoop::SteppedLoop(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}

SteppedLoop::SteppedLoop(std::unique_ptr<Plant> plant,
                         std::unique_ptr<SteeringController> controller, const FeasiblePlan& plan,
                         LoopConfig config, std::shared_ptr<const void> owner, bool keeps_log) {
  TRACKBED_REQUIRE(plant != nullptr && controller != nullptr,
                   "SteppedLoop: plant and controller must not be nullptr");
  CheckLoopArguments(*plant, plan, config);
  if (!keeps_log) {
    config.configuration_columns.clear();
  }
  parts_ = std::make_unique<Parts>(Parts{.owner = std::move(owner),
                                         .config = std::make_shared<LoopConfig>(std::move(config)),
                                         .plant = std::move(plant),
                                         .controller = std::move(controller)});
  parts_->core = std::make_unique<LoopCore>(*parts_->plant, *parts_->controller, plan,
                                            *parts_->config, keeps_log);
}

SteppedLoop::SteppedLoop(SteppedLoop&&) noexcept = default;
SteppedLoop& SteppedLoop::operator=(SteppedLoop&&) noexcept = default;
SteppedLoop::~SteppedLoop() = default;

SteppedLoop SteppedLoop::Copy() const {
  auto copy = std::make_unique<Parts>(
      Parts{.owner = parts_->owner,
            .config = parts_->config,
            .plant = Copied(*parts_->plant, "plant", "Plant::Clone"),
            .controller = Copied(*parts_->controller, "controller", "SteeringController::Clone")});
  copy->core = std::make_unique<LoopCore>(*parts_->core, *copy->plant);
  return SteppedLoop(std::move(copy));
}

const std::optional<DriveStatus>& SteppedLoop::status() const {
  return parts_->core->status();
}

ControlInput SteppedLoop::input() const {
  return parts_->core->Input();
}

const LogRow& SteppedLoop::row() const {
  return parts_->core->row();
}

const Plan& SteppedLoop::plan() const {
  return parts_->core->plan();
}

double SteppedLoop::period() const {
  return parts_->config->control_period;
}

void SteppedLoop::Step() {
  TRACKBED_REQUIRE(!status(), "SteppedLoop::Step: the run has ended: {}", ToString(*status()));
  parts_->core->Step(*parts_->controller, true);
}

void SteppedLoop::Step(double steering, std::optional<double> acceleration) {
  TRACKBED_REQUIRE(!status(), "SteppedLoop::Step: the run has ended: {}", ToString(*status()));
  TRACKBED_REQUIRE(std::isfinite(steering) && std::isfinite(acceleration.value_or(0.0)),
                   "SteppedLoop::Step: steering is {} rad, acceleration {} m/s^2; must be finite",
                   steering, acceleration.value_or(0.0));
  GivenCommands given(*parts_->controller, steering, acceleration);
  parts_->core->Step(given, false);
}

RunLog SteppedLoop::log() const {
  return parts_->core->CopyLog();
}

}  // namespace trackbed
