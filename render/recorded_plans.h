#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "trackbed/core/table.h"

/// Reads the plans of a run from the files in its folder. The reading functions return nothing if
/// the file is absent, and throw InputError naming the file if it is invalid.
namespace trackbed::render {

/// A point on the ground [m]; z may be omitted if its height is not needed.
struct Point {
  double x = 0;
  double y = 0;
  double z = 0;
};

/// A path adopted during the run in place of the previous one.
struct NewPlan {
  double from = 0;  ///< time at which the plan is adopted [s]
  std::vector<Point> path;
};

/// Curvature along a plan; at least one value.
struct CurvatureProfile {
  double from = 0;                ///< Time of the plan's adoption [s].
  double station = 0;             ///< Station of the car's log where the plan starts [m].
  std::vector<double> s;          ///< Stations of the plan, increasing [m].
  std::vector<double> curvature;  ///< Curvature at the stations of the plan [rad/m].
};

/// Reads a table of the run folder; InputError if it is missing.
Table ReadRunTable(const std::filesystem::path& file);

/// The path of `plan.csv`.
std::vector<Point> ReadPlan(const std::filesystem::path& file);

/// The paths of `<plant>.plan.csv`.
std::vector<NewPlan> ReadNewPlans(const std::filesystem::path& file);

/// The curvature over the stations of each plan, read from `plan.csv` or `<plant>.plan.csv`. Plans
/// without curvature are omitted. `begin` is the adoption time of the plan in `plan.csv` [s].
std::vector<CurvatureProfile> ReadCurvatures(const std::filesystem::path& file, double begin);

/// The cones of each gate in `plan.json`, in pairs across the gate's lane, from entry to exit.
std::vector<std::vector<Point>> ReadGates(const std::filesystem::path& file);

}  // namespace trackbed::render
