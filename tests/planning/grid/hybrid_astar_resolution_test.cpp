#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "tests/geometry/random.h"
#include "tests/planning/grid/hybrid_path_check.h"
#include "tests/planning/maps.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/planning/common/collision_checker.h"
#include "trackbed/planning/grid/hybrid_astar.h"

// Tests hybrid A* on random parking lots: the planner must solve a lot at every resolution or at
// none.
namespace trackbed {
namespace {

constexpr double kSafe = HybridAStarOptions{}.safe_distance;

double Front() {
  return ReferenceCar().length - ReferenceCar().rear_overhang;
}
double Rear() {
  return ReferenceCar().rear_overhang;
}
double Half() {
  return 0.5 * ReferenceCar().width;
}

/// Returns a random lot. The start is between two parked cars beside a wall, with 0.1 to 1.2 m of
/// free space at either end, in addition to the safe distance. The goal is on the lane.
HybridAStarProblem PullOut(Random& random) {
  const double ahead = Front() + kSafe + random.Uniform(0.1, 1.2);
  const double behind = -Rear() - kSafe - random.Uniform(0.1, 1.2);
  const double lane = random.Uniform(3.5, 7.0);
  const double side = Half() + random.Uniform(-0.1, 0.1);
  const double wall = -Half() - kSafe - 0.05;
  return {
      .start = {},
      .goal = {random.Uniform(8.0, 20.0), Half() + 0.5 * lane + random.Uniform(-0.3, 0.3),
               random.Uniform(-0.05, 0.05)},
      .obstacles = {Block(ahead, wall, ahead + 4.4, side), Block(behind - 4.4, wall, behind, side),
                    Block(-20.0, wall - 0.5, 40.0, wall),
                    Block(-20.0, Half() + lane, 40.0, Half() + lane + 0.5)}};
}

HybridAStarProblem Reversed(HybridAStarProblem problem) {
  std::swap(problem.start, problem.goal);
  return problem;
}

HybridAStarProblem ParallelParking(Random& random) {
  return Reversed(PullOut(random));
}

/// Returns a random lot. The goal is in a bay that the car enters forward or backward, with 0.1 to
/// 0.8 m of free space on either side, in addition to the safe distance. The start is on the lane
/// along the bays.
HybridAStarProblem IntoABay(Random& random) {
  const double side = Half() + kSafe + random.Uniform(0.1, 0.8);
  const double lane = random.Uniform(4.5, 8.0);
  const double depth = ReferenceCar().length + 0.5;
  const bool nose_in = random.Below(2) == 0;
  return {
      .start = {random.Uniform(-14.0, -6.0), 0.5 * lane + random.Uniform(-0.2, 0.2),
                random.Below(2) == 0 ? 0.0 : kPi},
      .goal = nose_in ? Pose2{0.0, Front() + 0.2 - depth, -0.5 * kPi}
                      : Pose2{0.0, Rear() + 0.3 - depth, 0.5 * kPi},
      .obstacles = {
          Block(-side - 1.8, -depth, -side, 0.0), Block(side, -depth, side + 1.8, 0.0),
          Block(-side - 6.0, -depth, -side - 3.0, 0.0), Block(side + 3.0, -depth, side + 6.0, 0.0),
          Block(-20.0, -depth - 1.3, 20.0, -depth - 0.8), Block(-20.0, lane, 20.0, lane + 0.5)}};
}

HybridAStarProblem OutOfABay(Random& random) {
  return Reversed(IntoABay(random));
}

/// Returns a closed yard with a gap in a wall. The gap has 0.03 to 0.6 m of free space on either
/// side, in addition to the safe distance.
HybridAStarProblem Gap(Random& random) {
  const double side = Half() + kSafe + random.Uniform(0.03, 0.6);
  const double wall = random.Uniform(6.0, 10.0);
  const double behind = wall + random.Uniform(0.3, 4.0);
  return {
      .start = {random.Uniform(-4.0, 1.0), random.Uniform(-8.0, 8.0), random.Uniform(-kPi, kPi)},
      .goal = {behind + random.Uniform(5.0, 9.0), random.Uniform(-8.0, 8.0),
               random.Uniform(-0.6, 0.6)},
      .obstacles = {Block(wall, side, behind, 15.0), Block(wall, -15.0, behind, -side),
                    Block(-8.0, 15.0, behind + 14.0, 15.5),
                    Block(-8.0, -15.5, behind + 14.0, -15.0), Block(-8.5, -15.0, -8.0, 15.0)}};
}

/// Returns a closed yard with up to 14 cars that are parked at random.
HybridAStarProblem Crowd(Random& random) {
  HybridAStarProblem problem{
      .start = {0.0, 0.0, random.Uniform(-kPi, kPi)},
      .goal = {random.Uniform(12.0, 18.0), random.Uniform(-6.0, 6.0), random.Uniform(-kPi, kPi)}};
  for (int i = 0; i < 14; ++i) {
    const OrientedBox box{
        {random.Uniform(-3.0, 20.0), random.Uniform(-9.0, 9.0), random.Uniform(-kPi, kPi)},
        4.4,
        1.8};
    const CollisionChecker clear(ReferenceCar(), {box}, kSafe + 0.1);
    if (clear.IsFree(problem.start) && clear.IsFree(problem.goal)) {
      problem.obstacles.push_back(box);
    }
  }
  for (const OrientedBox& wall : {Block(-6.0, 9.0, 24.0, 9.5), Block(-6.0, -9.5, 24.0, -9.0),
                                  Block(-6.5, -9.0, -6.0, 9.0), Block(24.0, -9.0, 24.5, 9.0)}) {
    problem.obstacles.push_back(wall);
  }
  return problem;
}

struct Kind {
  std::string name;
  HybridAStarProblem (*make)(Random& random);
};

void PrintTo(const Kind& kind, std::ostream* out) {
  *out << kind.name;
}

const std::array<Kind, 6> kKinds{{{"PullOut", PullOut},
                                  {"ParallelParking", ParallelParking},
                                  {"IntoABay", IntoABay},
                                  {"OutOfABay", OutOfABay},
                                  {"Gap", Gap},
                                  {"Crowd", Crowd}}};

/// Returns the value of the environment variable TRACKBED_PARKING_LOTS; null if it is not set. The
/// variable sets the total number of lots of all kinds, and makes the test use all resolutions. The
/// test of 200 lots takes about 15 minutes.
const char* RequestedLots() {
  return std::getenv("TRACKBED_PARKING_LOTS");
}

int LotsPerKind() {
  const int kinds = static_cast<int>(kKinds.size());
  return RequestedLots() == nullptr ? 2 : (std::atoi(RequestedLots()) + kinds - 1) / kinds;
}

/// Returns pairs of the side length of a cell [m] and the number of headings.
std::vector<std::pair<double, int>> Resolutions() {
  if (RequestedLots() == nullptr) {
    return {{1.0, 36}, {0.5, 72}, {0.5, 144}, {0.125, 36}};
  }
  std::vector<std::pair<double, int>> resolutions;
  for (const double cell : {1.0, 0.5, 0.25, 0.125}) {
    for (const int headings : {36, 72, 144}) {
      resolutions.emplace_back(cell, headings);
    }
  }
  return resolutions;
}

class ParkingLots : public ::testing::TestWithParam<Kind> {};

TEST_P(ParkingLots, AreSolvedAtEveryResolutionOrAtNone) {
  int solved = 0;
  for (int lot = 0; lot < LotsPerKind(); ++lot) {
    Random random(static_cast<std::uint64_t>(lot));
    const HybridAStarProblem problem = GetParam().make(random);
    std::string found;
    for (const auto& [cell, headings] : Resolutions()) {
      HybridAStarOptions options;
      options.cell = cell;
      options.headings = headings;
      const HybridAStarResult result = SearchHybridAStar(ReferenceCar(), problem, options);
      EXPECT_LE(result.expansions, options.budget);
      found += result.ok() ? '+' : '-';
      if (result.ok()) {
        ExpectGood(problem, options, result);
      }
    }
    solved += found.front() == '+' ? 1 : 0;
    EXPECT_EQ(found, std::string(found.size(), found.front()))
        << "lot " << lot << ": one character for each resolution";
  }
  EXPECT_GT(solved, 0);
}

/// If a path is driven backward, it leads from the goal to the start. The problem with start and
/// goal exchanged therefore has a solution, too.
TEST_P(ParkingLots, AreSolvedInBothDirectionsOrInNone) {
  for (int lot = 0; lot < LotsPerKind(); ++lot) {
    Random random(static_cast<std::uint64_t>(lot));
    const HybridAStarProblem problem = GetParam().make(random);
    const HybridAStarResult there = SearchHybridAStar(ReferenceCar(), problem, {});
    const HybridAStarResult back = SearchHybridAStar(ReferenceCar(), Reversed(problem), {});
    EXPECT_EQ(there.ok(), back.ok()) << "lot " << lot << ": " << there.reason << back.reason;
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, ParkingLots, ::testing::ValuesIn(kKinds),
                         [](const auto& kind) { return kind.param.name; });

/// Free space at either end of the gap of TightGap, in addition to the safe distance [m].
constexpr double kPlay = 0.8;

/// Returns a problem whose goal is between two parked cars.
HybridAStarProblem TightGap() {
  const double ahead = Front() + kSafe + kPlay;
  const double behind = -Rear() - kSafe - kPlay;
  const double wall = -Half() - kSafe - 0.05;
  return {.start = {-12.0, 3.2, 0.0},
          .goal = {},
          .obstacles = {Block(ahead, wall, ahead + 4.4, Half()),
                        Block(behind - 4.4, wall, behind, Half()),
                        Block(-20.0, wall - 0.5, 40.0, wall), Block(-20.0, 6.0, 40.0, 6.5)}};
}

TEST(HybridAStarResolutions, EnterAGapFromInside) {
  HybridAStarProblem problem = TightGap();
  const CurveDrive drive{
      .speed = 1.0, .min_speed = 0.3, .radius = 1.1 * ReferenceCar().min_turning_radius()};
  for (const auto& how : {std::optional<CurveDrive>(), std::optional(drive)}) {
    problem.drive = how;
    const HybridAStarResult result = SearchHybridAStar(ReferenceCar(), problem, {});
    ExpectGood(problem, {}, result);
    // A search from the start would expand the whole lane before it detects that the goal is in a
    // gap. A search from the goal expands only the few poses in the gap.
    EXPECT_LT(result.expansions, 20000);
  }
}

TEST(HybridAStarResolutions, LetARollingCarBeginForwards) {
  HybridAStarProblem problem = TightGap();
  problem.start = {12.0, 3.2, 0.0};  // The car can back in directly.
  for (const bool rolls : {false, true}) {
    problem.rolls = rolls;
    const HybridAStarResult result = SearchHybridAStar(ReferenceCar(), problem, {});
    ExpectGood(problem, {}, result);
    ASSERT_TRUE(result.ok());
    EXPECT_EQ(result.segments.front().direction, rolls ? 1 : -1);
  }
}

TEST(HybridAStarResolutions, ProveThatThereIsNoPath) {
  // The car has 1 cm of free space at either end, less than the shortest step. The search therefore
  // expands only the poses in the gap, whether the gap is the goal or the start.
  HybridAStarProblem problem = TightGap();
  problem.obstacles[0].center.x -= kPlay - 0.01;
  problem.obstacles[1].center.x += kPlay - 0.01;
  for (const HybridAStarProblem& each : {problem, Reversed(problem)}) {
    const HybridAStarResult result = SearchHybridAStar(ReferenceCar(), each, {});
    EXPECT_EQ(result.status, PlanStatus::kNoPath);
    EXPECT_LT(result.expansions, 100);
  }
}

}  // namespace
}  // namespace trackbed
