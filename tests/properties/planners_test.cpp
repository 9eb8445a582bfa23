// Properties that every registered planner must have for every problem.

#include "trackbed/planning/registry/planners.h"

#include <fmt/format.h>

#include <cmath>

#include "tests/planning/print_planner.h"
#include "tests/properties/measured_path.h"
#include "tests/properties/option_numbers.h"
#include "tests/properties/problems.h"
#include "tests/properties/property.h"
#include "tests/tolerance.h"
#include "trackbed/core/angle.h"

namespace properties {
namespace {

using namespace trackbed;

class EveryPlanner : public testing::TestWithParam<PlannerEntry> {};

/// Returns all planners that use waypoints. Omits planners that follow a track or lanes, because
/// the test problems have neither.
std::vector<PlannerEntry> PlannersOfWaypoints() {
  std::vector<PlannerEntry> planners = Planners();
  std::erase_if(planners, [](const PlannerEntry& entry) {
    return entry.follows_lanes || entry.follows_track;
  });
  return planners;
}

INSTANTIATE_TEST_SUITE_P(Registry, EveryPlanner, testing::ValuesIn(PlannersOfWaypoints()),
                         [](const auto& test) { return std::string(test.param.name); });

/// Expects that a successful plan reaches its goal, and that any other plan has a reason and an
/// empty path.
void CheckPlan(const Plan& plan, const Problem& problem, const PlannerEntry& entry) {
  RC_LOG() << ToText(problem) << "\n" << ToString(plan.status) << ": " << plan.reason << "\n";
  RC_TAG(std::string(ToString(plan.status)));
  if (!plan.ok()) {
    RC_ASSERT(!plan.reason.empty());
    RC_ASSERT(plan.reference.path.length() == 0.0);
    return;
  }
  const std::string flaw = FlawIn(plan, problem.request, entry);
  if (!flaw.empty()) {
    RC_FAIL(flaw);
  }
}

void CheckAnyProblem(const PlannerEntry& entry, const Wildness& wildness) {
  const Problem problem = AnyProblem(entry, wildness);
  Plan plan;
  const std::string refusal = Refusal([&] { plan = MakePlan(problem.request, problem.options); });
  if (!refusal.empty()) {
    RC_TAG(refusal);
  } else {
    CheckPlan(plan, problem, entry);
  }
}

TEST_P(EveryPlanner, LeadsThereOrSaysWhyNot) {
  // A search that finds no path visits all cells, which takes a hundred times as long as a curve.
  Check(GetParam().searches ? 0.4 : 1.0, [&] { CheckAnyProblem(GetParam(), {}); });
}

TEST_P(EveryPlanner, LeadsThereOrSaysWhyNotOverTensOfKilometers) {
  Check(0.02, [&] { CheckAnyProblem(GetParam(), {.smallest = 3, .largest = 3}); });
}

TEST_P(EveryPlanner, LeadsTheCarOfAUsualProblem) {
  const PlannerEntry& entry = GetParam();
  Check(0.5, [&] {
    const Problem problem = AnyProblem(entry, {.adversarial = false});
    CheckPlan(MakePlan(problem.request, problem.options), problem, entry);
  });
}

/// Expects that `path` is the path `expected` after the transformation `seen`.
void CheckSamePath(const Path& expected, const Path& path, double tolerance,
                   const std::function<Pose2(const Pose2&)>& seen) {
  RC_ASSERT(std::abs(path.length() - expected.length()) <= tolerance);
  for (int i = 0; i <= 50; ++i) {
    const double s = expected.length() * i / 50.0;
    const Pose2 a = seen(expected.At(s).pose);
    const Pose2 b = path.At(s).pose;
    if (!((a.position() - b.position()).norm() <= tolerance) ||
        !(std::abs(AngleDifference(a.yaw, b.yaw)) <= tolerance)) {
      RC_FAIL(fmt::format("{} m and {} rad apart at s = {} m", (a.position() - b.position()).norm(),
                          AngleDifference(a.yaw, b.yaw), s));
    }
  }
}

/// Expects that a planner solves a mirrored or moved problem equally. Some planners do not
/// distinguish between paths of equal cost, or draw random numbers in world axes: such a planner
/// must only find a path. All other planners must find the same path up to rounding. Coordinates of
/// about 1000 m are rounded by 2e-13 m. A search that stops within 1e-9 of its bounds amplifies
/// this rounding.
void CheckSeenFromElsewhere(const PlannerEntry& entry, const Problem& problem, const Problem& other,
                            const std::function<Pose2(const Pose2&)>& seen) {
  const Plan plan = MakePlan(problem.request, problem.options);
  const Plan same = MakePlan(other.request, other.options);
  RC_LOG() << ToText(problem) << "\n"
           << ToString(plan.status) << " " << plan.reason << "\n"
           << ToString(same.status) << " " << same.reason << "\n";
  RC_TAG(std::string(ToString(plan.status)));
  if (same.ok()) {
    if (const std::string flaw = FlawIn(same, other.request, entry); !flaw.empty()) {
      RC_FAIL(flaw);
    }
  }
  if (entry.is_random) {
    return;
  }
  RC_ASSERT(plan.status == same.status);
  // Around boxes, a grid search in the moved problem uses other cells and finds another path.
  if (!plan.ok() || entry.has_ties || (entry.searches && !problem.request.obstacles.empty())) {
    return;
  }
  // Around a box straight ahead, the curves to the left and to the right have equal length, and a
  // planner may choose either.
  if (entry.keeps_clear && !problem.request.obstacles.empty()) {
    RC_ASSERT(std::abs(plan.reference.path.length() - same.reference.path.length()) <=
              Tolerance(1e-5));
  } else {
    CheckSamePath(plan.reference.path, same.reference.path, Tolerance(1e-5), seen);
  }
}

TEST_P(EveryPlanner, PlansAMirroredProblemAsAMirroredPath) {
  Check(0.5, [&] {
    const Problem problem = AnyProblem(GetParam(), {.adversarial = false});
    CheckSeenFromElsewhere(GetParam(), problem, Mirrored(problem), [](const Pose2& pose) {
      return Pose2{pose.x, -pose.y, -pose.yaw};
    });
  });
}

TEST_P(EveryPlanner, PlansAMovedProblemAsAMovedPath) {
  Check(0.5, [&] {
    const Pose2 by{*Within(1000.0), *Within(1000.0), *Within(kPi)};
    const Problem problem = AnyProblem(GetParam(), {.adversarial = false});
    CheckSeenFromElsewhere(GetParam(), problem, Moved(problem, by),
                           [&](const Pose2& pose) { return Compose(by, pose); });
  });
}

TEST_P(EveryPlanner, RefusesOptionsThatAreNoNumbers) {
  const PlannerEntry& entry = GetParam();
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    PlannerOptions options = entry.defaults;
    std::size_t count = 0;
    const auto visit = [&](KeyVisitor& keys) { Visit(keys, options); };
    ForEachNumber(visit, [&](const std::string&, double&, Range) { ++count; });
    for (std::size_t i = 0; i < count; ++i) {
      options = entry.defaults;
      std::size_t k = 0;
      std::string name;
      ForEachNumber(visit, [&](const std::string& key, double& value, Range) {
        if (k++ == i) {
          value = bad;
          name = key;
        }
      });
      PlanRequest request;
      request.vehicle = ScaledCar(1.0);
      request.waypoints = {{0.0, 0.0}, {40.0, 0.0}, {80.0, 30.0}};
      request.speed = {3.0, 1.0, 1.5};
      EXPECT_TRUE(Refuses([&] { (void)MakePlan(request, options); })) << name << " " << bad;
    }
  }
}

}  // namespace
}  // namespace properties
