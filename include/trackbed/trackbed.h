#pragma once

/// All headers for running a scenario, in one file:
///
///     const trackbed::Scenario scenario = trackbed::ReadScenario("corner.yaml");
///     const trackbed::CarModel car = trackbed::LoadCar(scenario);
///     const trackbed::FeasiblePlan plan = trackbed::PlanMission(scenario, car);
///     const trackbed::RunLog log = trackbed::DrivePlant(scenario, car, plan, "mujoco");
///
/// SimulateClosedLoop runs user-defined plants and controllers. RunMission also measures and judges
/// a run, as the program does. Main is the command-line program. Further headers are in the folders
/// of the modules.

#include "trackbed/analysis/run.h"                // IWYU pragma: export
#include "trackbed/cli/main.h"                    // IWYU pragma: export
#include "trackbed/control/controllers.h"         // IWYU pragma: export
#include "trackbed/drive/closed_loop.h"           // IWYU pragma: export
#include "trackbed/drive/drive.h"                 // IWYU pragma: export
#include "trackbed/planning/registry/planners.h"  // IWYU pragma: export
#include "trackbed/scenario/scenario.h"           // IWYU pragma: export
#include "trackbed/sim/plant.h"                   // IWYU pragma: export
