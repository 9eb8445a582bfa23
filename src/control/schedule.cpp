#include "trackbed/control/schedule.h"

#include <cmath>

namespace trackbed {
namespace {

class OpenLoop final : public SteeringController {
 public:
  explicit OpenLoop(const ScheduleOptions&) {}

  double Steer(const ControlInput& input) override {
    return input.schedule.At(input.station + std::abs(input.state.speed) * input.period);
  }
};

}  // namespace

void Visit(KeyVisitor&, ScheduleOptions&) {}

ControllerEntry ScheduleController() {
  return {.name = "schedule",
          .summary = "the plan's steering over distance traveled, open loop",
          .defaults = ScheduleOptions{},
          .station = StationSource::kOdometer,
          .needs_plan = true,
          .make = MakeBy<ScheduleOptions, OpenLoop>};
}

}  // namespace trackbed
