#pragma once

/// The only include that a program needs to plan, simulate and compare:
///
///     const trackbed::RunResult run = trackbed::RunScenario("corner.yaml");
///     if (const auto car = run.Find("mujoco")) {
///       std::cout << car->metrics.tracking->cross_track_max;
///     }
///     const trackbed::PlantComparison apart = trackbed::Compare(run, "kinematic", "mujoco");
///
/// RunScenario plans the scenario, simulates it on all plants of the scenario, and measures and
/// judges each drive, as `trackbed run` does. Each step of RunScenario is also a function:
///
///     const trackbed::Scenario scenario = trackbed::LoadScenario("corner.yaml");
///     const trackbed::CarModel car = trackbed::LoadCar(scenario);
///     const trackbed::FeasiblePlan plan = trackbed::PlanScenario(scenario, car);
///     const trackbed::RunLog log = trackbed::SimulateScenario(scenario, car, plan, "mujoco");
///
/// MakeSteppedLoop makes the loop of SimulateScenario, for a program that gives the commands
/// itself. A Scenario can also be filled in code, with the options of any planner, local planner
/// and controller. SimulateClosedLoop runs user-defined plants and controllers. RegisterPlanner,
/// RegisterController, RegisterPlant and RegisterMetric add user-defined methods by name. Main is
/// the command-line program. Further headers are in the folders of the modules.

#include "trackbed/analysis/compare.h"                      // IWYU pragma: export
#include "trackbed/analysis/metric_registry.h"              // IWYU pragma: export
#include "trackbed/analysis/run.h"                          // IWYU pragma: export
#include "trackbed/cli/main.h"                              // IWYU pragma: export
#include "trackbed/control/controllers.h"                   // IWYU pragma: export
#include "trackbed/control/lqr.h"                           // IWYU pragma: export
#include "trackbed/control/mpc.h"                           // IWYU pragma: export
#include "trackbed/control/mppi.h"                          // IWYU pragma: export
#include "trackbed/control/optimal_steering.h"              // IWYU pragma: export
#include "trackbed/control/playback.h"                      // IWYU pragma: export
#include "trackbed/control/preview.h"                       // IWYU pragma: export
#include "trackbed/control/preview_integral.h"              // IWYU pragma: export
#include "trackbed/control/pure_pursuit.h"                  // IWYU pragma: export
#include "trackbed/control/rear_axle_feedback.h"            // IWYU pragma: export
#include "trackbed/control/schedule.h"                      // IWYU pragma: export
#include "trackbed/control/stanley.h"                       // IWYU pragma: export
#include "trackbed/control/steering_controller.h"           // IWYU pragma: export
#include "trackbed/control/steering_profile.h"              // IWYU pragma: export
#include "trackbed/control/surroundings.h"                  // IWYU pragma: export
#include "trackbed/drive/closed_loop.h"                     // IWYU pragma: export
#include "trackbed/drive/drive.h"                           // IWYU pragma: export
#include "trackbed/drive/stepped_loop.h"                    // IWYU pragma: export
#include "trackbed/planning/avoidance/avoidance_options.h"  // IWYU pragma: export
#include "trackbed/planning/common/course_schedule.h"       // IWYU pragma: export
#include "trackbed/planning/common/curvature_steps.h"       // IWYU pragma: export
#include "trackbed/planning/common/planner.h"               // IWYU pragma: export
#include "trackbed/planning/course/course.h"                // IWYU pragma: export
#include "trackbed/planning/course/lane_change.h"           // IWYU pragma: export
#include "trackbed/planning/course/straight.h"              // IWYU pragma: export
#include "trackbed/planning/curves/curve_planners.h"        // IWYU pragma: export
#include "trackbed/planning/fillet/fillet_planner.h"        // IWYU pragma: export
#include "trackbed/planning/frenet/frenet_options.h"        // IWYU pragma: export
#include "trackbed/planning/grid/astar_planner.h"           // IWYU pragma: export
#include "trackbed/planning/grid/hybrid_astar_planner.h"    // IWYU pragma: export
#include "trackbed/planning/lanes/lane_route_planner.h"     // IWYU pragma: export
#include "trackbed/planning/path_file/path_file_planner.h"  // IWYU pragma: export
#include "trackbed/planning/racing/center_line.h"           // IWYU pragma: export
#include "trackbed/planning/racing/minimum_curvature.h"     // IWYU pragma: export
#include "trackbed/planning/racing/minimum_time.h"          // IWYU pragma: export
#include "trackbed/planning/registry/planners.h"            // IWYU pragma: export
#include "trackbed/planning/replan/replan_options.h"        // IWYU pragma: export
#include "trackbed/planning/sampling/rrt_planner.h"         // IWYU pragma: export
#include "trackbed/planning/sampling/rrt_star_planner.h"    // IWYU pragma: export
#include "trackbed/scenario/scenario.h"                     // IWYU pragma: export
#include "trackbed/sim/plant.h"                             // IWYU pragma: export
