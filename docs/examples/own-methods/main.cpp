#include <trackbed/trackbed.h>

trackbed::PlannerEntry Sidestep();        // sidestep.cpp
trackbed::ControllerEntry Feedforward();  // feedforward.cpp
trackbed::MetricEntry RollMax();          // roll.cpp

int main(int argc, char** argv) {
  trackbed::RegisterPlanner(Sidestep());
  trackbed::RegisterController(Feedforward());
  trackbed::RegisterMetric(RollMax());
  return trackbed::Main(argc, argv);
}
