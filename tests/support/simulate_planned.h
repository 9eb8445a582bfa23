#pragma once

#include <string>

#include "trackbed/drive/drive.h"

namespace trackbed {

/// Plans a scenario without payload, and simulates the plan on one plant.
inline RunLog SimulatePlanned(const Scenario& scenario, const std::string& plant) {
  const CarModel car = LoadCar(scenario);
  return SimulateScenario(scenario, car, PlanScenario(scenario, car.unladen()), plant);
}

}  // namespace trackbed
