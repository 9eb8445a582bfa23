#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "trackbed/core/table.h"

/// Reads the plans of a run from the files in the run folder. If a file is absent, the functions
/// return an empty result; if a file is invalid, they throw InputError naming the file.
namespace trackbed::render {

/// A point on the ground [m]; z is 0 where the height is not needed.
struct Point {
  double x = 0;
  double y = 0;
  double z = 0;
};

/// A path that replaced the previous path during the run.
struct NewPlan {
  double from = 0;  ///< time at which the plan is adopted [s]
  std::vector<Point> path;
};

/// Curvature along a plan, at one or more stations.
struct CurvatureProfile {
  double from = 0;                ///< Time of the plan's adoption [s].
  double station = 0;             ///< Station in the car's log at which the plan starts [m].
  std::vector<double> s;          ///< Stations of the plan, increasing [m].
  std::vector<double> curvature;  ///< Curvature at the stations of the plan [rad/m].
};

/// Reads a table of the run folder. Throws InputError if the file is missing.
Table ReadRunTable(const std::filesystem::path& file);

/// Reads the path in `plan.csv`.
std::vector<Point> ReadPlan(const std::filesystem::path& file);

/// Reads the paths in `<plant>.plan.csv`.
std::vector<NewPlan> ReadNewPlans(const std::filesystem::path& file);

/// Reads the curvature of each plan as a function of the station, from `plan.csv` or
/// `<plant>.plan.csv`. Plans without curvature are omitted. `begin` is the adoption time of the
/// plan in `plan.csv` [s].
std::vector<CurvatureProfile> ReadCurvatures(const std::filesystem::path& file, double begin);

/// Reads the cones of each gate from `plan.json`. The cones of a gate are in pairs, left and right
/// of the lane, from the gate's entry to its exit.
std::vector<std::vector<Point>> ReadGates(const std::filesystem::path& file);

}  // namespace trackbed::render
