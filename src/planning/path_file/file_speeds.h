#pragma once

#include <optional>
#include <string>
#include <vector>

#include "trackbed/core/error.h"
#include "trackbed/path/fit_path.h"
#include "trackbed/planning/common/plan.h"

/// Speeds, stops and waits of a plan that follows the speeds and times of a path file.
namespace trackbed {

/// Returns the stations at which the path changes its direction of motion [m].
std::vector<double> CuspsOf(const Path& path);

/// Returns the problems of the speeds in a file that the car should follow: the speed is 0 at
/// several points that are farther apart than PathFitOptions::max_deviation.
std::vector<Problem> FileSpeedProblems(const FittedPath& fitted, const std::string& file);

/// Returns the speed at which the file's car starts [m/s]; nullopt if the file has no speeds.
std::optional<double> FileStartSpeed(const FittedPath& fitted);

/// Adds to the plan the speed caps, stops, waits and notes that follow from the file's speeds and
/// times. The plan must already contain the stops at curvature steps and cusps. A car that starts
/// at `start_speed` [m/s] above 0 does not wait at the start.
///
/// Between two points, the cap is the mean of the speeds at these points. The car may start faster
/// than the file's speeds, and then slows down at the mission's deceleration.
///
/// The car stops where the file's speed is 0. If the file has times, the car waits at a stop for as
/// long as the file's car stands. The duration of a standstill is the time from the first to the
/// last point with the speed 0. The wait also includes any time of the adjacent steps that the
/// file's car does not need to brake and to start. In a recording with noise, the file's car also
/// stands where it stays within PathFitOptions::max_deviation for longer than a car at 0.1 m/s
/// would.
void FollowFileSpeeds(Plan& plan, const FittedPath& fitted, double start_speed);

}  // namespace trackbed
