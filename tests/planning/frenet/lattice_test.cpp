#include "trackbed/planning/frenet/lattice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/planning/drivable.h"
#include "tests/planning/frenet_scenes.h"
#include "tests/tolerance.h"
#include "trackbed/core/error.h"

// Tests the Frenet lattice. With one layer, the lattice must equal the Frenet planner. An
// enumeration of all paths must confirm the cheapest path.
namespace trackbed {
namespace {

/// Returns three walls, 36 m apart, that extend alternately from the left and the right side into a
/// road. The road reaches 4 m to each side of its middle. To pass the walls on the right,
/// on the left and on the right, the car needs an offset of 1.86 m from the middle: 0.7 m of wall,
/// half of its width, and the safe distance.
std::vector<MovingBox> SlalomBoxes(const Path& path) {
  return {BoxAt(path, 24.0, 1.65, 1.0, 4.7), BoxAt(path, 60.0, -1.65, 1.0, 4.7),
          BoxAt(path, 96.0, 1.65, 1.0, 4.7)};
}

LatticeOptions SlalomOptions() {
  LatticeOptions options;
  options.layers = 9;
  options.limits.safe_distance = 0.3;
  return options;
}

FrenetRequest RandomScene(Random& random, const Path& path) {
  FrenetRequest request = OnPath(random.Uniform(2.5, 6.0));
  request.start.d = random.Uniform(-0.5, 0.5);
  request.start.s_acceleration = random.Uniform(-0.2, 0.2);
  request.road = {5.0, 4.0};
  request.obstacles = RandomBoxes(random, path);
  return request;
}

TEST(Lattice, OfOneLayerIsFrenet) {
  const Path path = BentRoad();
  Random random(41);
  int found = 0;
  for (int i = 0; i < 20; ++i) {
    FrenetRequest request = RandomScene(random, path);
    request.start.s_acceleration = 0.0;
    LatticeOptions lattice;
    lattice.layers = 1;
    lattice.spacing = 35.0;
    const FrenetPlan plan = PlanLattice(path, request, lattice);
    // The Frenet planner gets the same end states as the lattice. The duration to each end state
    // follows from the mean speed.
    double best = std::numeric_limits<double>::infinity();
    FrenetMotion motion;
    int candidates = 0;
    for (const double factor : lattice.speed_factors) {
      FrenetOptions frenet;
      frenet.end_offsets = lattice.end_offsets;
      frenet.speed_factors = {factor};
      frenet.lateral = LateralMotion::kOverStation;
      frenet.horizon = 0.0;
      frenet.end_times = {2.0 * 35.0 / ((1.0 + factor) * request.start.s_rate)};
      const FrenetPlan single = PlanFrenet(path, request, frenet);
      candidates += single.candidates;
      if (single.ok() && single.cost < best) {
        best = single.cost;
        motion = single.motion;
      }
    }
    EXPECT_EQ(plan.candidates, candidates);
    ASSERT_EQ(plan.ok(), !motion.pieces.empty());
    if (!plan.ok()) {
      continue;
    }
    ++found;
    // The durations are equal up to rounding.
    EXPECT_NEAR(plan.cost, best, Tolerance(1e-9));
    EXPECT_NEAR(plan.motion.duration(), motion.duration(), Tolerance(1e-12));
    EXPECT_NEAR(plan.motion.At(3.0).d, motion.At(3.0).d, Tolerance(1e-9));
  }
  EXPECT_GT(found, 5);
}

TEST(Lattice, IsNeverDearerThanASingleEdge) {
  const Path path = BentRoad();
  Random random(43);
  int both = 0;
  int cheaper = 0;
  int only = 0;
  for (int i = 0; i < 20; ++i) {
    FrenetRequest request = RandomScene(random, path);
    for (MovingBox& box : request.obstacles) {
      box.velocity = Vec2::Zero();
    }
    LatticeOptions options;
    options.layers = 3;
    LatticeOptions single = options;
    single.layers = 1;
    single.spacing = options.spacing * options.layers;
    const FrenetPlan a = PlanLattice(path, request, options);
    const FrenetPlan b = PlanLattice(path, request, single);
    if (b.ok()) {
      ++both;
      ASSERT_TRUE(a.ok());
      EXPECT_LE(a.cost, b.cost);
      cheaper += a.cost < b.cost ? 1 : 0;
    } else {
      only += a.ok() ? 1 : 0;
    }
  }
  EXPECT_GT(both, 5);
  EXPECT_GT(cheaper, 2);
  EXPECT_GT(only, 0);
}

TEST(Lattice, DrivesASlalomThatNoSingleEdgeCan) {
  for (const Path& path : {StraightRoad(), BentRoad()}) {
    FrenetRequest request = OnPath(3.0);
    request.road = {4.0, 4.0};
    request.obstacles = SlalomBoxes(path);
    const LatticeOptions options = SlalomOptions();
    LatticeOptions single = options;
    single.layers = 1;
    single.spacing = options.spacing * options.layers;
    EXPECT_FALSE(PlanLattice(path, request, single).ok());
    const FrenetPlan plan = PlanLattice(path, request, options);
    ASSERT_TRUE(plan.ok()) << plan.reason;
    EXPECT_GE(plan.motion.pieces.size(), 3U);
    EXPECT_NEAR(plan.motion.At(plan.motion.duration()).s, 108.0, Tolerance(1e-9));
    ExpectDrivable(path, request, options.limits, plan);
    const Reference reference = ToReference(plan.points);
    EXPECT_NEAR(reference.path.length(), plan.points.back().distance, Tolerance(1e-9));
  }
}

TEST(Lattice, PlansOnlyWhatCanBeDriven) {
  const Path path = BentRoad();
  Random random(47);
  int found = 0;
  for (int i = 0; i < 30; ++i) {
    SCOPED_TRACE("scene " + std::to_string(i));
    const FrenetRequest request = RandomScene(random, path);
    const LatticeOptions options;
    const FrenetPlan plan = PlanLattice(path, request, options);
    EXPECT_EQ(plan.checked, plan.passed + plan.rejected.total());
    EXPECT_EQ(plan.ok(), plan.reason.empty());
    if (plan.ok()) {
      ++found;
      ExpectDrivable(path, request, options.limits, plan);
      // The plan's cost is the sum of its edges' costs.
      double cost = 0.0;
      for (const FrenetPiece& piece : plan.motion.pieces) {
        cost += PieceCost(piece, {std::nullopt, std::get<KeepSpeed>(request.goal).speed},
                          options.weights)
                    .total;
      }
      EXPECT_NEAR(plan.cost, cost, Tolerance(1e-9));
    }
    if (HasFailure()) {
      break;
    }
  }
  EXPECT_GT(found, 10);
}

TEST(Lattice, LooksCloselyAtWhatItTakes) {
  // If motions are checked only every 20 s, the search misses collisions between the nodes.
  FrenetRequest request = OnPath(3.0);
  request.obstacles = SlalomBoxes(StraightRoad());
  LatticeOptions options;
  options.limits.safe_distance = 0.3;
  options.limits.time_step = 20.0;
  const FrenetPlan plan = PlanLattice(StraightRoad(), request, options);
  ASSERT_TRUE(plan.ok()) << plan.reason;
  EXPECT_GT(plan.rejected.Of(Rejection::kCollision), 0);
  EXPECT_EQ(plan.checked, plan.passed + plan.rejected.total());
  ExpectDrivable(StraightRoad(), request, options.limits, plan);
}

TEST(Lattice, IsTheCheapestOfAllWays) {
  // The lattice has two layers, three offsets and one speed. The test enumerates all paths, and
  // plans each edge as a separate lattice.
  const Path path = StraightRoad();
  FrenetRequest request = OnPath(3.0);
  request.obstacles = {BoxAt(path, 34.0, 0.75)};
  LatticeOptions options;
  options.layers = 2;
  options.spacing = 25.0;
  options.end_offsets = {0.0, -1.5, 1.5};
  options.speed_factors = {1.0};
  const FrenetPlan plan = PlanLattice(path, request, options);
  ASSERT_TRUE(plan.ok()) << plan.reason;
  EXPECT_EQ(plan.candidates, 3 + 3 + 9);
  const auto edge = [&](const FrenetState& from, double length, double to) {
    FrenetRequest part = request;
    part.start = from;
    LatticeOptions one = options;
    one.layers = 1;
    one.spacing = length;
    one.end_offsets = {to};
    const FrenetPlan found = PlanLattice(path, part, one);
    return found.ok() ? found.cost : std::numeric_limits<double>::infinity();
  };
  double best = std::numeric_limits<double>::infinity();
  for (const double last : options.end_offsets) {
    best = std::min(best, edge(request.start, 50.0, last));
    for (const double middle : options.end_offsets) {
      best = std::min(best, edge(request.start, 25.0, middle) +
                                edge({25.0, 3.0, 0.0, middle, 0.0, 0.0}, 25.0, last));
    }
  }
  EXPECT_NEAR(plan.cost, best, Tolerance(1e-12));
}

TEST(Lattice, StopsAtTheStation) {
  FrenetRequest request = OnPath(3.0);
  request.goal = StopAt{30.0};
  const FrenetPlan plan = PlanLattice(StraightRoad(), request, {});
  ASSERT_TRUE(plan.ok()) << plan.reason;
  const FrenetState end = plan.motion.At(plan.motion.duration());
  EXPECT_NEAR(end.s, 30.0, Tolerance(1e-9));
  EXPECT_NEAR(end.s_rate, 0.0, Tolerance(1e-9));
  ExpectDrivable(StraightRoad(), request, {}, plan);
  // A stop beyond the end of the lattice must not change the motion.
  request.goal = StopAt{100.0};
  const FrenetPlan far = PlanLattice(StraightRoad(), request, {});
  ASSERT_TRUE(far.ok()) << far.reason;
  EXPECT_NEAR(far.motion.At(far.motion.duration()).s, 48.0, Tolerance(1e-9));
  EXPECT_NEAR(far.motion.At(far.motion.duration()).s_rate, 3.0, Tolerance(1e-9));
}

TEST(Lattice, FollowsItsLeader) {
  FrenetRequest request = OnPath(3.0);
  request.speed.speed = 4.0;
  request.goal = FollowLeader{13.0, 2.0, 4.0, 1.5};
  LatticeOptions options;
  options.speed_factors = {1.0, 1.25, 0.75};
  const FrenetPlan plan = PlanLattice(StraightRoad(), request, options);
  ASSERT_TRUE(plan.ok()) << plan.reason;
  const double duration = plan.motion.duration();
  const FrenetState end = plan.motion.At(duration);
  const FrenetTarget target = TargetAt(request.goal, request.vehicle, duration);
  // The lattice has only three speeds. A layer takes 6 s at 2 m/s. If the speed of a layer is wrong
  // by half a step, the motion misses the target station by up to 1.5 m.
  EXPECT_NEAR(end.s, target.station.value(), 2.0);
}

TEST(Lattice, MeasuresEachEdgeByWhereTheLeaderIsThen) {
  FrenetRequest request = OnPath(3.0);
  request.road = {4.0, 4.0};
  request.goal = FollowLeader{13.0, 2.0, 4.0, 1.5};
  request.obstacles = SlalomBoxes(StraightRoad());
  LatticeOptions options = SlalomOptions();
  options.speed_factors = {1.0, 1.25, 0.75};
  const FrenetPlan plan = PlanLattice(StraightRoad(), request, options);
  ASSERT_TRUE(plan.ok()) << plan.reason;
  ASSERT_GE(plan.motion.pieces.size(), 3U);
  double cost = 0.0;
  double time = 0.0;
  for (const FrenetPiece& piece : plan.motion.pieces) {
    time += piece.duration;
    cost += PieceCost(piece, TargetAt(request.goal, request.vehicle, time), options.weights).total;
  }
  EXPECT_NEAR(plan.cost, cost, Tolerance(1e-9));
}

TEST(Lattice, IsCalledAgainFromWhereItsMotionIs) {
  // The test plans again every second, from the state that the car has reached. Without new
  // obstacles, the plan stays the same.
  const Path path = StraightRoad();
  FrenetRequest request = OnPath(3.0);
  request.road = {4.0, 4.0};
  request.obstacles = SlalomBoxes(path);
  LatticeOptions options = SlalomOptions();
  options.layers = 5;
  FrenetPlan driven;
  double time = 0.0;
  for (int cycle = 0; request.start.s < 105.0; ++cycle) {
    ASSERT_LT(cycle, 80);
    FrenetPlan plan = PlanLattice(path, request, options);
    if (plan.ok()) {
      EXPECT_NEAR(plan.motion.At(0.0).d, request.start.d, Tolerance(1e-9));
      EXPECT_NEAR(plan.motion.At(0.0).d_bend, request.start.d_bend, Tolerance(1e-9));
      ExpectDrivable(path, request, options.limits, plan, 2.0);
      driven = std::move(plan);
      time = 0.0;
    }
    time += 1.0;
    ASSERT_LT(time, driven.motion.duration()) << "at " << request.start.s;
    request.start = driven.motion.At(time);
  }
}

TEST(Lattice, FindsNothingWithoutEdgesOrBudget) {
  LatticeOptions options;
  options.budget = 0;
  FrenetPlan plan = PlanLattice(StraightRoad(), OnPath(3.0), options);
  EXPECT_EQ(plan.status, PlanStatus::kSearchFailed);
  EXPECT_EQ(plan.checked, 0);
  options = {};
  options.layers = 0;
  plan = PlanLattice(StraightRoad(), OnPath(3.0), options);
  EXPECT_EQ(plan.status, PlanStatus::kSearchFailed);
  EXPECT_EQ(plan.reason, "there are no edges");
  options = {};
  options.end_offsets.clear();
  EXPECT_EQ(PlanLattice(StraightRoad(), OnPath(3.0), options).reason, "there are no edges");
  FrenetRequest arrived = OnPath(3.0);
  arrived.goal = StopAt{0.0};
  EXPECT_EQ(PlanLattice(StraightRoad(), arrived, {}).reason, "there are no edges");
}

TEST(Lattice, SaysWhyNothingPasses) {
  FrenetRequest request = OnPath(3.0);
  request.obstacles = {BoxAt(StraightRoad(), 30.0, 0.0, 1.0, 20.0)};
  const FrenetPlan plan = PlanLattice(StraightRoad(), request, {});
  EXPECT_EQ(plan.status, PlanStatus::kSearchFailed);
  EXPECT_GT(plan.rejected.Of(Rejection::kCollision), 0);
  EXPECT_TRUE(plan.motion.pieces.empty());
  request.obstacles = {BoxAt(StraightRoad(), 1.0, 0.0)};
  EXPECT_EQ(PlanLattice(StraightRoad(), request, {}).status, PlanStatus::kStartBlocked);
}

TEST(Lattice, IsMirroredWithItsWorldAndRepeatsItself) {
  FrenetRequest request = OnPath(3.0);
  request.start.d = 0.2;
  request.obstacles = SlalomBoxes(StraightRoad());
  FrenetRequest mirrored = request;
  mirrored.start.d = -0.2;
  for (MovingBox& box : mirrored.obstacles) {
    box.box.center.y *= -1.0;
  }
  const FrenetPlan a = PlanLattice(StraightRoad(), request, SlalomOptions());
  const FrenetPlan b = PlanLattice(StraightRoad(), mirrored, SlalomOptions());
  const FrenetPlan c = PlanLattice(StraightRoad(), request, SlalomOptions());
  ASSERT_TRUE(a.ok() && b.ok() && c.ok());
  EXPECT_EQ(a.cost, b.cost);
  EXPECT_EQ(a.points, c.points);
  ASSERT_EQ(a.points.size(), b.points.size());
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    EXPECT_EQ(a.points[i].frenet.d, -b.points[i].frenet.d);
  }
}

}  // namespace
}  // namespace trackbed
