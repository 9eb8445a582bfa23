#pragma once

#include <tinyxml2.h>

#include <string>
#include <vector>

#include "src/path_files/commonroad_xml.h"
#include "src/path_files/lanelets.h"
#include "trackbed/path_files/commonroad_scenario.h"

/// The planning problem of a CommonRoad scenario: where a car starts, and its goal.
namespace trackbed {

struct PlanningProblem {
  Pose2 start;
  double speed = 0.0;       ///< Speed at the start [m/s], >= 0.
  double start_step = 0.0;  ///< Time step at which the problem begins.
  CommonRoadGoal goal;
  std::vector<std::string> goal_lanelets;  ///< Lanelets that the file names as goal.
};

/// Reads the first planning problem of a scenario. Adds notes about parts of the problem that are
/// left out or missing. Throws InputError if there is no problem, or no goal.
PlanningProblem ReadPlanningProblem(const tinyxml2::XMLElement& root, const Lanelets& lanelets,
                                    double timestep, const CommonRoadReading& reading,
                                    std::vector<std::string>& notes);

/// Returns the middle of a goal region.
Vec2 MiddleOf(const CommonRoadRegion& region);

/// Returns the lanelets in which the goal's regions lie: those that contain the middle of a region.
/// If no lanelet contains the middle of a region, returns the lanelets that overlap the region's
/// largest inscribed disc about its middle.
std::vector<std::string> GoalLanelets(const PlanningProblem& problem, const Lanelets& lanelets);

}  // namespace trackbed
