#include <trackbed/trackbed.h>

trackbed::PlannerEntry Sidestep();        // sidestep.cpp
trackbed::ControllerEntry Feedforward();  // feedforward.cpp

int main(int argc, char** argv) {
  trackbed::RegisterPlanner(Sidestep());
  trackbed::RegisterController(Feedforward());
  return trackbed::Main(argc, argv);
}
