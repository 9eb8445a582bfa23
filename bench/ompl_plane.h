#pragma once

#include <ompl/base/MotionValidator.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "trackbed/planning/sampling/rrt_star.h"

// Converts the maps of tests/planning/maps.h to problems for OMPL's planners.
namespace trackbed::bench {

namespace ob = ompl::base;

inline Vec2 StatePosition(const ob::State* state) {
  const auto* values = state->as<ob::RealVectorStateSpace::StateType>();
  return {(*values)[0], (*values)[1]};
}

/// Checks edges with the distance function of Trackbed's own searches.
class Edges : public ob::MotionValidator {
 public:
  Edges(const ob::SpaceInformationPtr& space, const RrtStarProblem& problem)
      : ob::MotionValidator(space), problem_(problem) {}

  bool checkMotion(const ob::State* from, const ob::State* to) const override {
    const Vec2 a = StatePosition(from);
    const Vec2 b = StatePosition(to);
    return std::all_of(problem_.obstacles.begin(), problem_.obstacles.end(),
                       [&](const OrientedBox& obstacle) {
                         return Distance(a, b, obstacle) > problem_.inflation.most;
                       });
  }
  bool checkMotion(const ob::State* from, const ob::State* to,
                   std::pair<ob::State*, double>& /*last_valid*/) const override {
    return checkMotion(from, to);
  }

 private:
  const RrtStarProblem& problem_;
};

/// OMPL's problem for a map: sampled box, start, goal and edges. The map must outlive the returned
/// problem.
inline ob::ProblemDefinitionPtr MakeProblem(const RrtStarProblem& problem) {
  const auto space = std::make_shared<ob::RealVectorStateSpace>(2);
  ob::RealVectorBounds bounds(2);
  for (unsigned axis = 0; axis < 2; ++axis) {
    bounds.setLow(axis, problem.low[axis]);
    bounds.setHigh(axis, problem.high[axis]);
  }
  space->setBounds(bounds);
  const auto information = std::make_shared<ob::SpaceInformation>(space);
  information->setStateValidityChecker([](const ob::State*) { return true; });  // edges do it
  information->setMotionValidator(std::make_shared<Edges>(information, problem));
  information->setup();
  ob::ScopedState<ob::RealVectorStateSpace> start(space);
  ob::ScopedState<ob::RealVectorStateSpace> goal(space);
  for (unsigned axis = 0; axis < 2; ++axis) {
    start[axis] = problem.start[axis];
    goal[axis] = problem.goal[axis];
  }
  auto definition = std::make_shared<ob::ProblemDefinition>(information);
  definition->setStartAndGoalStates(start, goal);
  return definition;
}

inline double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace trackbed::bench
