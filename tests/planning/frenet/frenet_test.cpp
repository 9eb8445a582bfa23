#include "trackbed/planning/frenet/frenet.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <limits>
#include <tuple>

#include "tests/planning/drivable.h"
#include "tests/planning/frenet_scenes.h"
#include "tests/tolerance.h"
#include "trackbed/core/error.h"

// Tests the Frenet planner: its cost against known optima of polynomials, its candidates, and its
// plans among standing and moving boxes. ExpectDrivable checks each plan.
namespace trackbed {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Returns the argument at the minimum of a function. The function hardly changes near its minimum,
/// so only half of the digits of the argument are accurate.
template <typename Function>
double Minimum(const Function& function, double from, double to) {
  return boost::math::tools::brent_find_minima(function, from, to, 26).first;
}

/// Returns the cost of a lateral shift between two offsets at 5 m/s.
FrenetCost CostOfShift(double from, double to, double duration, const FrenetWeights& weights) {
  const FrenetPiece piece{duration, Polynomial{{0.0, 5.0}},
                          QuinticBetween({from, 0.0, 0.0}, {to, 0.0, 0.0}, duration)};
  return PieceCost(piece, {std::nullopt, 5.0}, weights);
}

// --- C
// --------------------------------------------------------------------------------------------

TEST(FrenetCost, IsLeastAtTheKnownTimes) {
  // The cost of a shift by D is least for the duration T* = (3600 K_dj D^2/K_dt)^(1/6) if the cost
  // integrates the jerk, and for ((360/7) K_dj D^2/K_dt)^(1/4) if it integrates the acceleration.
  for (const auto& [shift, by_jerk, by_acceleration] :
       {std::tuple{1.0, 3.91487, 2.67794}, std::tuple{3.5, 5.94392, 5.00997}}) {
    for (const int order : {3, 2}) {
      FrenetWeights weights;
      weights.derivative_order = order;
      const double best = Minimum(
          [&, d = shift](double t) { return CostOfShift(d, 0.0, t, weights).lateral; }, 1.0, 12.0);
      EXPECT_NEAR(best, order == 3 ? by_jerk : by_acceleration, Tolerance(5e-6));
    }
  }
}

TEST(FrenetCost, IsLeastAtTheKnownEndOffset) {
  // The best end offset is d_1 = d_0 A/(A + K_d) with A = 720 K_dj/T^5.
  FrenetWeights weights;
  weights.k_d = 0.3;
  for (const double duration : {2.0, 4.0}) {
    const double a = 720.0 * weights.k_dj / std::pow(duration, 5);
    const double best = Minimum(
        [&](double d) { return CostOfShift(2.0, d, duration, weights).lateral; }, -1.0, 3.0);
    EXPECT_NEAR(best, 2.0 * a / (a + weights.k_d), Tolerance(1e-7));
  }
}

TEST(FrenetCost, IsTheSumOfItsTerms) {
  // The car shifts by 2 m within 4 s and accelerates by 1.5 m/s. Each weight has a different value.
  FrenetWeights weights{0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.1, 3};
  const FrenetPiece piece{4.0, QuarticBetween({10.0, 3.0, 0.0}, {0.0, 4.5, 0.0}, 4.0),
                          QuinticBetween({1.0, 0.0, 0.0}, {-1.0, 0.0, 0.0}, 4.0)};
  // The station at the end is 10 + 4 (3 + 4.5)/2 = 25 m.
  const FrenetTarget target{27.0, 5.5};
  FrenetCost cost = PieceCost(piece, target, weights);
  const double lateral = 0.2 * 720.0 * 4.0 / 1024.0 + 0.3 * 1.0 + 0.4 * 4.0;
  const double longitudinal = 0.5 * 12.0 * 2.25 / 64.0 + 0.6 * 4.0 + 0.7 * 1.0 + 0.8 * 4.0;
  EXPECT_NEAR(cost.lateral, lateral, Tolerance(1e-12));
  EXPECT_NEAR(cost.longitudinal, longitudinal, Tolerance(1e-12));
  EXPECT_NEAR(cost.total, 0.9 * lateral + 1.1 * longitudinal, Tolerance(1e-12));
  // With the derivative order 2, the cost integrates accelerations, as in the publication.
  weights.derivative_order = 2;
  cost = PieceCost(piece, target, weights);
  EXPECT_NEAR(cost.lateral, lateral + 0.2 * (120.0 / 7.0 * 4.0 / 64.0 - 720.0 * 4.0 / 1024.0),
              Tolerance(1e-12));
  EXPECT_NEAR(cost.longitudinal, longitudinal + 0.5 * (1.2 * 2.25 / 4.0 - 12.0 * 2.25 / 64.0),
              Tolerance(1e-12));
  // Without a target station K_s has no effect.
  EXPECT_NEAR(PieceCost(piece, {std::nullopt, 5.5}, weights).longitudinal,
              cost.longitudinal - 0.6 * 4.0, Tolerance(1e-12));
}

TEST(FrenetCost, IsTheSameOverTimeAndOverStationAtConstantSpeed) {
  for (const int order : {2, 3}) {
    FrenetWeights weights;
    weights.derivative_order = order;
    const Polynomial s{{0.0, 3.0}};
    const FrenetPiece over_time{5.0, s, QuinticBetween({1.0, 0.3, 0.0}, {2.0, 0.0, 0.0}, 5.0)};
    const FrenetPiece over_station{5.0, s, QuinticBetween({1.0, 0.1, 0.0}, {2.0, 0.0, 0.0}, 15.0),
                                   true};
    EXPECT_NEAR(PieceCost(over_time, {std::nullopt, 3.0}, weights).total,
                PieceCost(over_station, {std::nullopt, 3.0}, weights).total, Tolerance(1e-12));
  }
}

TEST(FrenetCandidates, AreAllEndsByTheirCost) {
  const FrenetRequest request = OnPath(5.0);
  const FrenetOptions options;
  const auto candidates = FrenetCandidates(request, options);
  EXPECT_EQ(candidates.size(), 7U * 15U * 5U);
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const FrenetCandidate& candidate = candidates[i];
    EXPECT_EQ(candidate.cost.total,
              PieceCost(candidate.piece, {std::nullopt, 5.0}, options.weights).total);
    if (i > 0) {
      EXPECT_GE(candidate.cost.total, candidates[i - 1].cost.total);
    }
    const FrenetState end = candidate.piece.At(candidate.piece.duration);
    EXPECT_THAT(options.end_times, testing::Contains(candidate.piece.duration));
    EXPECT_THAT(options.end_offsets, testing::Contains(testing::DoubleNear(end.d, 1e-9)));
    EXPECT_NEAR(end.d_slope, 0.0, Tolerance(1e-9));
    EXPECT_NEAR(end.d_bend, 0.0, Tolerance(1e-9));
    EXPECT_NEAR(end.s_acceleration, 0.0, Tolerance(1e-9));
  }
}

TEST(FrenetCandidates, BeginAsTheCarMoves) {
  FrenetRequest request = OnPath(5.0);
  request.start = {7.0, 4.0, 0.5, 1.0, 0.1, -0.02};
  for (const LateralMotion lateral : {LateralMotion::kOverTime, LateralMotion::kOverStation}) {
    FrenetOptions options;
    options.lateral = lateral;
    for (const FrenetCandidate& candidate : FrenetCandidates(request, options)) {
      const FrenetState start = candidate.piece.At(0.0);
      EXPECT_EQ(start.s, 7.0);
      EXPECT_EQ(start.s_rate, 4.0);
      EXPECT_EQ(start.s_acceleration, 0.5);
      EXPECT_EQ(start.d, 1.0);
      EXPECT_NEAR(start.d_slope, 0.1, Tolerance(1e-15));
      EXPECT_NEAR(start.d_bend, -0.02, Tolerance(1e-15));
    }
  }
}

TEST(FrenetCandidates, MoveAsideOverTheStationWhenSlow) {
  FrenetRequest request = OnPath(5.0);
  FrenetOptions options;
  options.speed_factors = {1.0, 0.3};
  for (const FrenetCandidate& candidate : FrenetCandidates(request, options)) {
    EXPECT_EQ(candidate.piece.over_station,
              candidate.piece.At(candidate.piece.duration).s_rate < 2);
  }
  request.start.s_rate = 1.9;
  for (const FrenetCandidate& candidate : FrenetCandidates(request, options)) {
    EXPECT_TRUE(candidate.piece.over_station);
  }
}

// --- PlanFrenet
// --------------------------------------------------------------------------------------------

TEST(Frenet, KeepsStraightOnWhereNothingIsInTheWay) {
  const FrenetPlan plan = PlanFrenet(StraightRoad(), OnPath(5.0), {});
  ASSERT_TRUE(plan.ok()) << plan.reason;
  EXPECT_EQ(plan.reason, "");
  EXPECT_EQ(plan.candidates, 525);
  EXPECT_EQ(plan.checked, 1);
  // Only the duration has a cost. The shortest duration is 2 s, and its cost is (K_dt + K_st) x 2
  // s.
  EXPECT_NEAR(plan.cost, 0.4, Tolerance(1e-12));
  for (const TrajectoryPoint& point : plan.points) {
    EXPECT_EQ(point.frenet.d, 0.0);
    EXPECT_NEAR(point.motion.pose.x, 5.0 * point.t, Tolerance(1e-12));
  }
}

TEST(Frenet, PassesABoxOnTheRoomierSide) {
  for (const double side : {1.0, -1.0}) {
    FrenetRequest request = OnPath(5.0);
    request.obstacles = {BoxAt(StraightRoad(), 25.0, side * 0.8)};
    FrenetOptions options;
    options.speed_factors = {1.0};
    options.end_times = {4.0, 5.0, 6.0, 7.0};
    const FrenetPlan plan = PlanFrenet(StraightRoad(), request, options);
    ASSERT_TRUE(plan.ok()) << plan.reason;
    // The inner edge of the box is at 0.05 m. The safe distance of 0.5 m and half of the car's
    // width, 0.8625 m, require an offset of 1.3125 m from the middle. The next offset in the grid
    // is 1.5 m.
    EXPECT_NEAR(plan.motion.At(plan.motion.duration()).d, -side * 1.5, Tolerance(1e-9));
    ExpectDrivable(StraightRoad(), request, options.limits, plan);
  }
}

TEST(Frenet, PlansOnlyWhatCanBeDriven) {
  const Path path = BentRoad();
  Random random(17);
  int found = 0;
  for (int i = 0; i < 60; ++i) {
    FrenetRequest request = OnPath(random.Uniform(2.0, 8.0));
    request.speed.speed *= 1.2;
    request.start.s = random.Uniform(0.0, 40.0);
    request.start.d = random.Uniform(-0.5, 0.5);
    request.start.s_acceleration = random.Uniform(-0.5, 0.5);
    request.road = {5.0, 4.0};
    for (MovingBox box : RandomBoxes(random, path)) {
      const Vec2 shift = path.At(request.start.s).pose.position() - path.At(0.0).pose.position();
      box.box.center.x += shift.x();
      box.box.center.y += shift.y();
      request.obstacles.push_back(box);
    }
    SCOPED_TRACE("scene " + std::to_string(i));
    const FrenetOptions options;
    const FrenetPlan plan = PlanFrenet(path, request, options);
    EXPECT_EQ(plan.checked, plan.passed + plan.rejected.total());
    EXPECT_EQ(plan.passed, plan.ok() ? 1 : 0);
    EXPECT_EQ(plan.ok(), plan.reason.empty());
    if (plan.ok()) {
      ++found;
      ExpectDrivable(path, request, options.limits, plan);
    } else {
      EXPECT_TRUE(plan.points.empty());
    }
    if (HasFailure()) {
      break;
    }
  }
  EXPECT_GT(found, 30);
}

TEST(Frenet, ForeseesWhereAMovingBoxWillBe) {
  // The box crosses the road, and is in the middle of the road when a car at constant speed
  // arrives.
  FrenetRequest request = OnPath(5.0);
  request.obstacles = {BoxAt(StraightRoad(), 20.0, -7.0)};
  FrenetOptions options;
  options.end_times = {4.0, 5.0};
  const FrenetPlan waits = PlanFrenet(StraightRoad(), request, options);
  ASSERT_TRUE(waits.ok());
  EXPECT_EQ(waits.checked, 1);  // The box stands beside the road.
  request.obstacles[0].velocity = {0.0, 1.8};
  const FrenetPlan plan = PlanFrenet(StraightRoad(), request, options);
  ASSERT_TRUE(plan.ok()) << plan.reason;
  EXPECT_GT(plan.rejected.Of(Rejection::kCollision), 0);
  ExpectDrivable(StraightRoad(), request, options.limits, plan);
}

TEST(Frenet, LooksBeyondTheEndOfItsMotion) {
  // At 3 m/s, a shift by 1.5 m takes 5.4 s. Without a horizon, the cheapest motion takes 2 s, ends
  // 9 m before the box, and does not consider the box.
  FrenetRequest request = OnPath(3.0);
  request.obstacles = {BoxAt(StraightRoad(), 20.0, 0.8)};
  FrenetOptions options;
  options.horizon = 0.0;
  const FrenetPlan blind = PlanFrenet(StraightRoad(), request, options);
  ASSERT_TRUE(blind.ok());
  EXPECT_EQ(blind.motion.duration(), 2.0);
  EXPECT_EQ(blind.motion.At(2.0).d, 0.0);
  options.horizon = 8.0;
  const FrenetPlan plan = PlanFrenet(StraightRoad(), request, options);
  ASSERT_TRUE(plan.ok()) << plan.reason;
  EXPECT_GT(plan.rejected.Of(Rejection::kCollision), 0);
  // If the car continues from the end of its motion, it must be clear of the box after 8 s.
  const FrenetState end = plan.motion.At(plan.motion.duration());
  const double later = end.s + end.s_rate * (8.0 - plan.motion.duration());
  EXPECT_TRUE(end.d < -1.3 || later + 3.625 < 20.0 - 1.0 - 0.5) << end.d << ", " << later;
}

TEST(Frenet, KeepsItsDistanceFromALeader) {
  FrenetRequest request = OnPath(3.0);
  const FollowLeader leader{13.0, 2.0, 4.0, 1.5};
  request.goal = leader;
  const FrenetPlan plan = PlanFrenet(StraightRoad(), request, {});
  ASSERT_TRUE(plan.ok()) << plan.reason;
  const double duration = plan.motion.duration();
  const FrenetState end = plan.motion.At(duration);
  EXPECT_NEAR(end.s_rate, 2.0, Tolerance(1e-9));
  // The gap is measured between the bumpers. The car's front is 4.45 - 0.825 m ahead of its rear
  // axle.
  EXPECT_NEAR(leader.station + 2.0 * duration - (end.s + 3.625), 4.0 + 1.5 * 2.0, Tolerance(1e-9));
  ExpectDrivable(StraightRoad(), request, {}, plan);
}

TEST(Frenet, StopsAtTheStation) {
  FrenetRequest request = OnPath(3.0);
  request.goal = StopAt{10.0};
  request.start.d = 0.3;
  const FrenetPlan plan = PlanFrenet(BentRoad(), request, {});
  ASSERT_TRUE(plan.ok()) << plan.reason;
  const FrenetState end = plan.motion.At(plan.motion.duration());
  EXPECT_NEAR(end.s, 10.0, Tolerance(1e-9));
  EXPECT_NEAR(end.s_rate, 0.0, Tolerance(1e-9));
  ExpectDrivable(BentRoad(), request, {}, plan);
}

TEST(Frenet, StartsFromRest) {
  FrenetRequest request = OnPath(3.0);
  request.start.s_rate = 0.0;
  request.start.d = -0.3;
  FrenetOptions options;
  options.end_times = {8.0};
  options.end_offsets = {0.0};
  const FrenetPlan plan = PlanFrenet(BentRoad(), request, options);
  ASSERT_TRUE(plan.ok()) << plan.reason;
  EXPECT_TRUE(plan.motion.pieces[0].over_station);
  EXPECT_NEAR(plan.motion.At(8.0).d, 0.0, Tolerance(1e-9));
  ExpectDrivable(BentRoad(), request, options.limits, plan);
}

TEST(Frenet, StaysWhereItStands) {
  FrenetRequest request = OnPath(3.0);
  request.start = {10.0, 0.0, 0.0, 1.0, 0.0, 0.0};
  request.goal = StopAt{10.0};
  const FrenetPlan plan = PlanFrenet(StraightRoad(), request, {});
  ASSERT_TRUE(plan.ok()) << plan.reason;
  EXPECT_NEAR(ToReference(plan.points).path.length(), 0.0, Tolerance(1e-12));
  EXPECT_EQ(plan.motion.At(1.0).d, 1.0);
}

/// Returns the counts of rejections if the planner tries only one end state and rejects it.
RejectionCounts CountRejected(const Path& path, const FrenetRequest& request,
                              FrenetOptions options) {
  options.end_offsets.resize(1);
  options.speed_factors = {1.0};
  const FrenetPlan plan = PlanFrenet(path, request, options);
  EXPECT_EQ(plan.status, PlanStatus::kSearchFailed);
  EXPECT_EQ(plan.checked, 1);
  EXPECT_EQ(plan.rejected.total(), 1);
  return plan.rejected;
}

TEST(Frenet, SaysWhyItRejects) {
  const Path road = StraightRoad();
  FrenetOptions options;
  options.end_times = {4.0};
  options.end_offsets = {0.0};
  {
    FrenetRequest request = OnPath(3.0);
    request.goal = KeepSpeed{4.0};
    EXPECT_EQ(CountRejected(road, request, options).Of(Rejection::kSpeed), 1);
    request.speed = {5.0, 0.2, 3.0};  // Gaining 1 m/s in 4 s needs 0.375 m/s^2.
    EXPECT_EQ(CountRejected(road, request, options).Of(Rejection::kAcceleration), 1);
  }
  {
    FrenetOptions aside = options;
    aside.end_offsets = {3.0};
    // The motion needs a lateral acceleration of 5.77 x 3/16 m/s^2.
    aside.limits.max_lateral_acceleration = 0.5;
    EXPECT_EQ(CountRejected(road, OnPath(8.0), aside).Of(Rejection::kAcceleration), 1);
    // The motion needs a steering rate of 60 L D/(T^3 v^2) = 0.84 rad/s, with the wheelbase L, the
    // shift D, the duration T and the speed v.
    aside.limits.max_lateral_acceleration = 3.0;
    EXPECT_EQ(CountRejected(road, OnPath(3.0), aside).Of(Rejection::kSteeringRate), 1);
    aside.end_times = {8.0};
    FrenetRequest narrow = OnPath(5.0);
    narrow.road.left = 3.9;
    EXPECT_EQ(CountRejected(road, narrow, aside).Of(Rejection::kRoad), 1);
    // The car needs 3 m, half of its width, and 0.09 m by which its front swings out before the
    // rear axle reaches the offset.
    narrow.road.left = 4.0;
    EXPECT_TRUE(PlanFrenet(road, narrow, aside).ok());
  }
  {
    // On a shift of 2 m within 4 m, the slope changes by up to 5.77 x 2/16 per meter.
    FrenetOptions tight = options;
    tight.end_offsets = {2.0};
    tight.limits.time_step = 1.0;
    FrenetRequest request = OnPath(1.0);
    request.speed = {5.0, 10.0, 10.0};
    request.vehicle.steering_rate = 10.0;
    EXPECT_EQ(CountRejected(road, request, tight).Of(Rejection::kCurvature), 1);
  }
  {
    const Path cusp({0.0, 0.0, 0.0}, {{6.0, 0.0, 1}, {50.0, 0.0, -1}});
    EXPECT_EQ(CountRejected(cusp, OnPath(3.0), options).Of(Rejection::kFrame), 1);
  }
  {
    FrenetRequest request = OnPath(3.0);
    request.obstacles = {BoxAt(road, 12.0, 0.0)};
    EXPECT_EQ(CountRejected(road, request, options).Of(Rejection::kCollision), 1);
  }
}

TEST(Frenet, TellsItsFindingsInWords) {
  FrenetRequest request = OnPath(3.0);
  request.obstacles = {BoxAt(StraightRoad(), 8.0, 0.0, 1.0, 20.0)};
  FrenetOptions options;
  options.speed_factors = {1.0, 1.5};
  options.end_offsets = {0.0};
  options.end_times = {4.0};
  FrenetPlan plan = PlanFrenet(StraightRoad(), request, options);
  EXPECT_EQ(plan.reason, "none of 2 candidates is feasible: 1 speed, 1 collision");
  EXPECT_STREQ(ToString(plan.status), "search_failed");
  options.budget = 1;
  plan = PlanFrenet(StraightRoad(), request, options);
  EXPECT_EQ(plan.reason, "none of the first 1 of 2 candidates is feasible: 1 collision");
}

TEST(Frenet, FindsNothingWithoutCandidatesOrBudget) {
  FrenetOptions options;
  options.budget = 0;
  FrenetPlan plan = PlanFrenet(StraightRoad(), OnPath(3.0), options);
  EXPECT_EQ(plan.status, PlanStatus::kSearchFailed);
  EXPECT_EQ(plan.checked, 0);
  EXPECT_EQ(plan.reason, "none of the first 0 of 525 candidates is feasible");
  for (const auto clear :
       {&FrenetOptions::end_times, &FrenetOptions::end_offsets, &FrenetOptions::speed_factors}) {
    options = {};
    (options.*clear).clear();
    plan = PlanFrenet(StraightRoad(), OnPath(3.0), options);
    EXPECT_EQ(plan.status, PlanStatus::kSearchFailed);
    EXPECT_EQ(plan.reason, "there are no candidates");
  }
}

TEST(Frenet, DoesNotStartInAnObstacleOrWithoutAFrame) {
  FrenetRequest request = OnPath(3.0);
  request.obstacles = {BoxAt(StraightRoad(), 1.0, 0.5)};
  FrenetPlan plan = PlanFrenet(StraightRoad(), request, {});
  EXPECT_EQ(plan.status, PlanStatus::kStartBlocked);
  EXPECT_EQ(plan.reason, "the car is in collision with an obstacle");
  EXPECT_EQ(plan.checked, 0);
  request.obstacles.clear();
  request.start.d = 8.0;
  plan = PlanFrenet(Path({0.0, 0.0, 0.0}, {{50.0, 0.125, 1}}), request, {});
  EXPECT_EQ(plan.status, PlanStatus::kStartBlocked);
  EXPECT_EQ(plan.reason, "the path has no Frenet frame at the car's position");
}

TEST(Frenet, LeavesASpotThatIsTooCloseAlready) {
  // One box is 0.2 m beside the car, closer than the safe distance. Another box blocks the way of
  // the car. The car must continue without coming closer to the first box.
  FrenetRequest request = OnPath(5.0);
  request.obstacles = {BoxAt(StraightRoad(), 1.0, 0.2 + 0.8625 + 0.75),
                       BoxAt(StraightRoad(), 30.0, 1.0)};
  const FrenetPlan plan = PlanFrenet(StraightRoad(), request, {});
  ASSERT_TRUE(plan.ok()) << plan.reason;
  FrenetLimits closer;
  closer.safe_distance = 0.2;
  ExpectDrivable(StraightRoad(), request, closer, plan);
}

FrenetPlan PlanAmongBoxes(const Path& path, const std::vector<MovingBox>& boxes, double d) {
  FrenetRequest request = OnPath(5.0);
  request.start.d = d;
  request.obstacles = boxes;
  return PlanFrenet(path, request, {});
}

TEST(Frenet, IsMirroredWithItsWorld) {
  Random random(23);
  for (int i = 0; i < 10; ++i) {
    const std::vector<MovingBox> boxes = RandomBoxes(random, StraightRoad());
    std::vector<MovingBox> mirrored = boxes;
    for (MovingBox& box : mirrored) {
      box.box.center.y *= -1.0;
      box.velocity.y() *= -1.0;
    }
    // The car starts beside the path, so no two candidates have equal cost.
    const FrenetPlan a = PlanAmongBoxes(StraightRoad(), boxes, 0.2);
    const FrenetPlan b = PlanAmongBoxes(StraightRoad(), mirrored, -0.2);
    ASSERT_EQ(a.ok(), b.ok());
    EXPECT_EQ(a.cost, b.cost);
    EXPECT_EQ(a.rejected, b.rejected);
    for (std::size_t k = 0; k < a.points.size(); ++k) {
      EXPECT_EQ(a.points[k].frenet.d, -b.points[k].frenet.d);
      EXPECT_NEAR(a.points[k].motion.pose.y, -b.points[k].motion.pose.y, Tolerance(1e-12));
    }
  }
}

TEST(Frenet, MovesWithItsWorld) {
  const Pose2 X_WM{-70.0, 130.0, 2.0};
  const Path here = BentRoad();
  const Path there(Compose(X_WM, here.At(0.0).pose), here.segments());
  Random random(29);
  for (int i = 0; i < 10; ++i) {
    const std::vector<MovingBox> boxes = RandomBoxes(random, here);
    std::vector<MovingBox> moved = boxes;
    for (MovingBox& box : moved) {
      box.box.center = Compose(X_WM, box.box.center);
      box.velocity = ToWorld({0.0, 0.0, X_WM.yaw}, box.velocity);
    }
    const FrenetPlan a = PlanAmongBoxes(here, boxes, 0.2);
    const FrenetPlan b = PlanAmongBoxes(there, moved, 0.2);
    ASSERT_EQ(a.ok(), b.ok());
    EXPECT_EQ(a.cost, b.cost);  // the Frenet frame is independent of the world's frame
    ASSERT_EQ(a.points.size(), b.points.size());
    for (std::size_t k = 0; k < a.points.size(); ++k) {
      const Pose2 expected = Compose(X_WM, a.points[k].motion.pose);
      // The tolerance allows for rounding at coordinates of 150 m, accumulated over the quadratures
      // of the path.
      EXPECT_NEAR((b.points[k].motion.pose.position() - expected.position()).norm(), 0.0,
                  Tolerance(1e-10));
    }
  }
}

TEST(Frenet, RepeatsItself) {
  Random random(31);
  const std::vector<MovingBox> boxes = RandomBoxes(random, BentRoad());
  const FrenetPlan a = PlanAmongBoxes(BentRoad(), boxes, 0.2);
  const FrenetPlan b = PlanAmongBoxes(BentRoad(), boxes, 0.2);
  EXPECT_EQ(a.motion, b.motion);
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.rejected, b.rejected);
}

TEST(Frenet, RefusesWhatMakesNoSense) {
  FrenetRequest request = OnPath(3.0);
  request.start.d = kNan;
  EXPECT_THROW(PlanFrenet(StraightRoad(), request, {}), InternalError);
  FrenetOptions options;
  options.end_times = {-1.0};
  EXPECT_THROW(PlanFrenet(StraightRoad(), OnPath(3.0), options), InternalError);
  options = {};
  options.limits.time_step = 0.0;
  EXPECT_THROW(PlanFrenet(StraightRoad(), OnPath(3.0), options), InternalError);
  options = {};
  options.weights.derivative_order = 1;
  EXPECT_THROW(PlanFrenet(StraightRoad(), OnPath(3.0), options), InternalError);
}

}  // namespace
}  // namespace trackbed
