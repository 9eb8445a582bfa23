#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "trackbed/core/table.h"

/// Reads the plans of a run from the files in the run folder. The functions that read plans return
/// an empty result if a file is missing, and throw InputError naming the file if a file is invalid.
namespace trackbed::render {

/// A point on the ground [m]; z is 0 where the height is not needed.
struct Point {
  double x = 0;
  double y = 0;
  double z = 0;
};

/// A planned path that replaced the previous path during the run.
struct NewPlan {
  double from = 0;  ///< time at which the car adopts the plan [s]
  std::vector<Point> path;
};

/// Curvature along a plan, given at one or more stations.
struct CurvatureProfile {
  double from = 0;                ///< Time at which the car adopts the plan [s].
  double station = 0;             ///< Station in the car's log at which the plan begins [m].
  std::vector<double> s;          ///< Increasing stations along the plan [m].
  std::vector<double> curvature;  ///< Curvature at the stations of the plan [rad/m].
};

/// Reads a CSV table from the run folder. Throws InputError if the file is missing.
Table ReadRunTable(const std::filesystem::path& file);

/// Reads the initial path from `plan.csv`.
std::vector<Point> ReadPlan(const std::filesystem::path& file);

/// Reads the replanned paths from `<plant>.plan.csv`.
std::vector<NewPlan> ReadNewPlans(const std::filesystem::path& file);

/// Reads the curvature of each plan over the station, from `plan.csv` or `<plant>.plan.csv`. Plans
/// whose files have no curvature are omitted. The argument `begin` is the time at which the car
/// adopts the plan in `plan.csv` [s].
std::vector<CurvatureProfile> ReadCurvatures(const std::filesystem::path& file, double begin);

/// Reads the cones of each gate from `plan.json`. The cones of a gate are listed in pairs, left and
/// right of the lane, from the gate's entry to its exit.
std::vector<std::vector<Point>> ReadGates(const std::filesystem::path& file);

}  // namespace trackbed::render
