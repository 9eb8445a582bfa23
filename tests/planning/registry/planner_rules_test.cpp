#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "trackbed/planning/course/course.h"
#include "trackbed/planning/fillet/fillet.h"
#include "trackbed/planning/grid/hybrid_astar.h"
#include "trackbed/planning/path_file/path_file_planner.h"
#include "trackbed/planning/registry/planners.h"
#include "trackbed/planning/sampling/rrt_planner.h"

// Tests the rules, starts and files that planners declare in their registry entries.
namespace trackbed {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::StartsWith;

/// Returns every contradiction between the options, as "key: message".
std::vector<std::string> Problems(
    const PlannerOptions& options,
    const CouldReadKey& could_read = [](const std::string&) { return true; }) {
  std::vector<std::string> lines;
  for (const OptionProblem& problem : PlannerFor(options).check(options, could_read)) {
    lines.push_back(problem.key + ": " + problem.message);
  }
  return lines;
}

/// Returns every problem of the options of a planner of detours, as "key: message".
std::vector<std::string> DetourProblems(const PlannerOptions& options) {
  std::vector<std::string> lines;
  for (const OptionProblem& problem : PlannerFor(options).check_detour(options)) {
    lines.push_back(problem.key + ": " + problem.message);
  }
  return lines;
}

PathFileOptions Line() {
  FittedPath fitted;
  fitted.path = Path({1.0, 2.0, 0.5}, {{.length = 10.0, .curvature = 0.02}});
  fitted.given.points = {{1.0, 2.0}, fitted.path.At(10.0).pose.position()};
  fitted.given.speed = {3.0, 4.0};
  fitted.stations = {0.0, 10.0};
  PathFileOptions options;
  options.file = "lane.csv";
  options.ahead = 1.4;
  options.path = std::make_shared<const FittedPath>(std::move(fitted));
  return options;
}

TEST(PlannerRules, SkipKeysThatCouldNotBeRead) {
  for (const PlannerEntry& planner : Planners()) {
    if (planner.check != nullptr) {
      EXPECT_THAT(Problems(planner.defaults, [](const std::string&) { return false; }), IsEmpty())
          << planner.name;
    }
  }
}

TEST(PlannerRules, AcceptTheirDefaultsInADetour) {
  for (const PlannerEntry& planner : Planners()) {
    const PlannerOptions options = planner.detour_defaults.value_or(planner.defaults);
    EXPECT_STREQ(PlannerFor(options).name, planner.name);
    if (planner.check_detour != nullptr) {
      EXPECT_THAT(DetourProblems(options), IsEmpty()) << planner.name;
    }
  }
  EXPECT_FALSE(MayGoBackwards(*PlannerFor(HybridAStarOptions{}).detour_defaults));
}

TEST(PlannerRules, CourseNeedsSegmentsOfOneKind) {
  EXPECT_THAT(Problems(CourseOptions{}),
              ElementsAre("segments: a course needs at least one segment"));
  const CourseOptions mixed{.segments = {{.length = 1.0, .curvature = 0.0},
                                         {.length = 1.0, .curvature = 0.0, .curvature_to = 0.1},
                                         {.length = 1.0}}};
  EXPECT_THAT(Problems(mixed),
              ElementsAre(StartsWith("segments[1]: give curvature or curvature_to, not both"),
                          StartsWith("segments[2]: give curvature (0 for a straight)")));
  const auto could_read = [](const std::string& key) { return key != "segments[1].curvature"; };
  EXPECT_THAT(Problems(mixed, could_read), ElementsAre(StartsWith("segments[2]: ")));
}

TEST(PlannerRules, FilletNeedsAConstraintOrARadius) {
  EXPECT_THAT(Problems(FilletOptions{.constraint = RadiusConstraint::kNone}),
              ElementsAre("constraint: 'none' requires plan.radius"));
  EXPECT_THAT(Problems(FilletOptions{.radius = 20.0, .constraint = RadiusConstraint::kNone}),
              IsEmpty());
}

TEST(PlannerRules, RrtBoundsItsSmoothingAndItsDetours) {
  EXPECT_THAT(Problems(RrtPlannerOptions{}), IsEmpty());
  EXPECT_THAT(
      Problems(RrtPlannerOptions{.data_weight = 0.4, .smoothness_weight = 0.3}),
      ElementsAre(StartsWith("smoothness_weight: data_weight + 2 smoothness_weight is 1;")));
  EXPECT_THAT(DetourProblems(RrtPlannerOptions{.time_limit = 1.0, .partial = true}),
              ElementsAre(StartsWith("time_limit: not allowed in a detour"),
                          StartsWith("partial: not allowed in a detour")));
}

TEST(PlannerStart, IsThatOfThePathInAFile) {
  PathFileOptions options = Line();
  const auto start = PlannerFor(options).start;
  EXPECT_EQ(start(options)->pose, (Pose2{1.0, 2.0, 0.5}));
  EXPECT_EQ(PlannerFor(options).start_curvature(options, RouteStart{}), 0.02);
  EXPECT_EQ(start(options)->speed, std::nullopt);
  options.speeds = PathSpeeds::kFile;
  EXPECT_EQ(start(options)->speed, 3.0);
  EXPECT_FALSE(start(PathFileOptions{}).has_value());
}

TEST(PlannerFiles, HaveTheNamesThatTheOptionsGiveThem) {
  PlannerOptions options = Line();
  const PlannerEntry& planner = PlannerFor(options);
  const std::vector<InputFile> files = planner.input_files(options);
  ASSERT_EQ(files.size(), 1U);
  EXPECT_EQ(files[0].name, "path.csv");
  EXPECT_EQ(files[0].source, "path lane.csv");
  EXPECT_THAT(planner.input_names, Contains(files[0].name));
  planner.resolve(options);
  EXPECT_EQ(options.Get<PathFileOptions>().file, "path.csv");
  EXPECT_EQ(options.Get<PathFileOptions>().ahead, 0.0);
  EXPECT_THAT(planner.input_files(PathFileOptions{}), IsEmpty());
}

}  // namespace
}  // namespace trackbed
