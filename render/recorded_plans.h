#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "trackbed/core/table.h"

/// The plans of a run, from the files in its folder. All of these give nothing where the file is
/// absent, and InputError naming it where it is broken.
namespace trackbed::render {

/// A point on the ground [m]. Who does not care how high that is leaves z out.
struct Point {
  double x = 0;
  double y = 0;
  double z = 0;
};

/// A path that the car took up on its way, in place of the one it had.
struct NewPlan {
  double from = 0;  ///< the moment from which it holds [s]
  std::vector<Point> path;
};

/// The curvature of a plan along its way; one value at least.
struct CurvatureProfile {
  double from = 0;                ///< the moment from which the plan holds [s]
  double station = 0;             ///< in the car's log, where the plan's own begin [m]
  std::vector<double> s;          ///< the plan's own, rising [m]
  std::vector<double> curvature;  ///< [rad/m]
};

/// A table of the run folder; InputError when it is missing.
Table ReadRunTable(const std::filesystem::path& file);

/// The path of `plan.csv`.
std::vector<Point> ReadPlan(const std::filesystem::path& file);

/// The paths of `<plant>.plan.csv`.
std::vector<NewPlan> ReadNewPlans(const std::filesystem::path& file);

/// The curvature of each plan in either of these files, in so far as that has it, over the plan's
/// own stations. `begin` is when the plan of `plan.csv` holds from [s].
std::vector<CurvatureProfile> ReadCurvatures(const std::filesystem::path& file, double begin);

/// The cones of each gate in `plan.json`, in pairs across its lane, from entry to exit.
std::vector<std::vector<Point>> ReadGates(const std::filesystem::path& file);

}  // namespace trackbed::render
