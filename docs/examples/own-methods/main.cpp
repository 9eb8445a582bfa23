#include <trackbed/trackbed.h>

#include "trackbed/control/controllers.h"
#include "trackbed/control/steering_controller.h"
#include "trackbed/planning/common/planner.h"
#include "trackbed/planning/registry/planners.h"

trackbed::PlannerEntry Sidestep();        // sidestep.cpp
trackbed::ControllerEntry Feedforward();  // feedforward.cpp

int main(int argc, char** argv) {
  trackbed::RegisterPlanner(Sidestep());
  trackbed::RegisterController(Feedforward());
  return trackbed::Main(argc, argv);
}
