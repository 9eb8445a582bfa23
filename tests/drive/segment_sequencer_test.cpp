#include "src/drive/segment_sequencer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/drive/unicycle.h"
#include "tests/tolerance.h"
#include "trackbed/control/steering_controller.h"
#include "trackbed/planning/common/plan.h"

namespace trackbed {
namespace {

/// A plan straight along x: 10 m forward, 6 m backward, 3 m forward.
Plan BackAndForth() {
  return PlanAlongRoute({{.length = 10.0}, {.length = 6.0, .direction = -1}, {.length = 3.0}}, 0.0);
}

SegmentSequencer::Options Options(StationSource source = StationSource::kProjection) {
  return {.station_source = source,
          .vehicle = UnicycleParams(),
          .control_period = 0.02,
          .goal_tolerance = 0.4};
}

VehicleState StateAt(double x, double distance, double time = 0.0, double steering = 0.0) {
  VehicleState state;
  state.pose = {x, 0.0, 0.0};
  state.distance = distance;
  state.time = time;
  state.steering_actuator = steering;
  return state;
}

TEST(Segments, AreCutAtCuspsWithTheirSpeedsAndSchedule) {
  Plan plan = BackAndForth();
  plan.schedule = SteeringSchedule::Through({{0.0, 0.0}, {16.0, 0.16}, {19.0, 0.16}});
  const std::deque<Plan> segments = SplitIntoSegments(plan);
  ASSERT_EQ(segments.size(), 3U);
  const double lengths[] = {10.0, 6.0, 3.0};
  const double starts[] = {0.0, 10.0, 16.0};
  for (std::size_t i = 0; i < 3; ++i) {
    const Plan& own = segments[i];
    EXPECT_NEAR(own.reference.path.length(), lengths[i], Tolerance(1e-12));
    EXPECT_EQ(PlanGear(own), i == 1 ? -1 : 1);
    EXPECT_EQ(own.reference.speed.SpeedAt(lengths[i]), 0.0);
    EXPECT_NEAR(own.reference.speed.SpeedAt(1.0), plan.reference.speed.SpeedAt(starts[i] + 1.0),
                Tolerance(1e-12));
    // The schedule rises by 0.01 rad per meter up to 16 m.
    EXPECT_NEAR(own.schedule.At(1.0), plan.schedule.At(starts[i] + 1.0), Tolerance(1e-12));
    EXPECT_EQ(own.goal.x, plan.goal.x);
  }
}

TEST(Segments, OfAPlanWithoutCuspsAreThePlan) {
  const std::deque<Plan> segments = SplitIntoSegments(PlanAlongRoute({{.length = 10.0}}, 0.0));
  ASSERT_EQ(segments.size(), 1U);
  EXPECT_EQ(segments[0].reference.path.length(), 10.0);
}

TEST(Segments, AreCutAtStopsToo) {
  Plan plan = PlanAlongRoute({{.length = 10.0}}, 0.0);
  plan.stops = {4.0};
  const std::deque<Plan> segments = SplitIntoSegments(plan);
  ASSERT_EQ(segments.size(), 2U);
  EXPECT_NEAR(segments[0].reference.path.length(), 4.0, Tolerance(1e-12));
  EXPECT_TRUE(segments[1].stops.empty());
}

TEST(StationarySteer, IsOverWhenTheWheelsRest) {
  StationarySteer steer;
  steer.Update(0.0, 0.0);
  EXPECT_FALSE(steer.InProgress());  // never begun
  steer.Begin(0.0);
  EXPECT_TRUE(steer.InProgress());
  steer.Update(0.0, 0.1);  // rest needs two angles that hardly differ
  EXPECT_TRUE(steer.InProgress());
  steer.Update(0.003, 0.2);
  EXPECT_TRUE(steer.InProgress());
  steer.Update(0.00309, 0.3);  // less than 1e-4 rad
  EXPECT_FALSE(steer.InProgress());
  steer.Update(0.1, 0.4);
  EXPECT_FALSE(steer.InProgress());
}

TEST(StationarySteer, LastsUntilTheEndOfTheWait) {
  StationarySteer steer;
  steer.Begin(5.0);
  steer.Update(0.0, 0.0);
  steer.Update(0.0, 4.99);  // the wheels rest, the wait is not over
  EXPECT_TRUE(steer.InProgress());
  steer.Update(0.2, 5.0);  // the wait is over, the wheels turn
  EXPECT_TRUE(steer.InProgress());
  steer.Update(0.2, 5.01);
  EXPECT_FALSE(steer.InProgress());
}

TEST(SegmentSequencer, WaitsAtTheStopsOfThePlan) {
  Plan plan = PlanAlongRoute({{.length = 10.0}}, 0.0);
  plan.stops = {4.0, 7.0};
  plan.waits = {{0.0, 2.0}, {7.0, 3.0}};
  const std::deque<Plan> segments = SplitIntoSegments(plan);
  ASSERT_EQ(segments.size(), 3U);
  const double waits[] = {2.0, 0.0, 3.0};
  for (std::size_t i = 0; i < segments.size(); ++i) {
    ASSERT_EQ(segments[i].waits.size(), waits[i] > 0.0 ? 1U : 0U) << i;
    EXPECT_EQ(waits[i] > 0.0 ? segments[i].waits[0].duration : 0.0, waits[i]) << i;
  }
  SegmentSequencer sequencer(Drivable(plan), StateAt(0.0, 0.0), Options());
  EXPECT_TRUE(sequencer.stationary_steer().InProgress());
  EXPECT_EQ(sequencer.start_time(), 2.0);
  for (double x = 1.0; x <= 4.0; x += 1.0) {
    sequencer.Project(StateAt(x, x));
  }
  ASSERT_TRUE(sequencer.Advance(StateAt(4.0, 4.0, 5.0)));
  EXPECT_EQ(sequencer.start_time(), 5.0);
  for (double x = 5.0; x <= 7.0; x += 1.0) {
    sequencer.Project(StateAt(x, x));
  }
  ASSERT_TRUE(sequencer.Advance(StateAt(7.0, 7.0, 8.0)));
  EXPECT_EQ(sequencer.start_time(), 11.0);
}

TEST(SegmentSequencer, CountsStationsOnOverSegments) {
  SegmentSequencer sequencer(Drivable(BackAndForth()), StateAt(0.0, 0.0), Options());
  EXPECT_FALSE(sequencer.stationary_steer().InProgress());  // the plan starts straight ahead
  // The projection searches near the previous station, within 0.75 wheelbases (1.5 m), so the car
  // moves by 1 m at a time.
  for (double x = 1.0; x < 9.5; x += 1.0) {
    EXPECT_NEAR(sequencer.Project(StateAt(x, x))->s, x, Tolerance(1e-12));
    EXPECT_FALSE(sequencer.Advance(StateAt(x, x))) << x;
  }
  sequencer.Project(StateAt(9.59, 9.59));
  EXPECT_FALSE(sequencer.Advance(StateAt(9.59, 9.59)));  // 0.41 m before the end
  sequencer.Project(StateAt(9.61, 9.61));
  EXPECT_TRUE(sequencer.Advance(StateAt(9.61, 9.61, 5.0)));
  EXPECT_TRUE(sequencer.stationary_steer().InProgress());
  EXPECT_EQ(PlanGear(sequencer.plan()), -1);
  EXPECT_EQ(sequencer.start_time(), 5.0);
  EXPECT_NEAR(sequencer.offset(), 10.0, Tolerance(1e-12));
  EXPECT_FALSE(sequencer.is_last());
  // On the way back, x = 9 m is at station 1 m of the segment and at station 11 m of the log.
  EXPECT_NEAR(sequencer.Project(StateAt(9.0, 10.2))->s, 11.0, Tolerance(1e-12));
  EXPECT_NEAR(sequencer.station(), 1.0, Tolerance(1e-12));
}

TEST(SegmentSequencer, EndsAfterItsLastSegment) {
  SegmentSequencer sequencer(Drivable(PlanAlongRoute({{.length = 10.0}}, 0.0)), StateAt(0.0, 0.0),
                             Options());
  for (double x = 0.0; x <= 10.0; x += 1.0) {
    sequencer.Project(StateAt(x, x));
  }
  EXPECT_TRUE(sequencer.is_last());
  EXPECT_FALSE(sequencer.Advance(StateAt(10.0, 10.0)));
}

TEST(SegmentSequencer, ReachesHalfOfAShortSegmentAtLeast) {
  // The goal tolerance of 0.4 m would skip a segment of 0.3 m, so the car must drive at least half
  // of the segment.
  SegmentSequencer sequencer(
      Drivable(PlanAlongRoute({{.length = 0.3}, {.length = 5.0, .direction = -1}}, 0.0)),
      StateAt(0.0, 0.0), Options());
  sequencer.Project(StateAt(0.14, 0.14));
  EXPECT_FALSE(sequencer.Advance(StateAt(0.14, 0.14)));
  sequencer.Project(StateAt(0.16, 0.16));
  EXPECT_TRUE(sequencer.Advance(StateAt(0.16, 0.16)));
}

TEST(SegmentSequencer, CountsTheOdometerFromWhereverItBegins) {
  SegmentSequencer sequencer(Drivable(BackAndForth()), StateAt(0.0, 100.0),
                             Options(StationSource::kOdometer));
  EXPECT_EQ(sequencer.StationFor(StateAt(3.0, 104.0)), 4.0);  // not 3, where the car is
  EXPECT_TRUE(sequencer.Advance(StateAt(9.0, 109.7)));
  EXPECT_NEAR(sequencer.StationFor(StateAt(9.0, 110.7)), 1.0, Tolerance(1e-12));
}

TEST(SegmentSequencer, TellsTheEndOfALoopFromItsStart) {
  // A circle of 10 m radius ends where it begins.
  const double around = 2.0 * std::numbers::pi * 10.0;
  SegmentSequencer sequencer(Drivable(PlanAlongRoute({{.length = around, .curvature = 0.1}}, 3.0)),
                             StateAt(0.0, 0.0), Options());
  VehicleState state;
  ASSERT_TRUE(sequencer.Project(state));
  EXPECT_FALSE(sequencer.IsAtEnd(state));
  for (double s = 0.0; s < around; s += 0.5) {
    const double angle = s / 10.0;
    state.pose = {10.0 * std::sin(angle), 10.0 - 10.0 * std::cos(angle), angle};
    state.speed = 25.0;  // the car moves 0.5 m per control period
    ASSERT_TRUE(sequencer.Project(state));
    EXPECT_EQ(sequencer.IsAtEnd(state), around - s < 0.4) << s;
  }
}

TEST(SegmentSequencer, FollowsTheSpeedsOfItsStationSource) {
  Plan plan = PlanAlongRoute({{.length = 10.0}}, 0.0);
  plan.schedule_speed = SpeedProfile({{0.0, 1.25}});
  const SegmentSequencer closed(Drivable(plan), StateAt(0.0, 0.0), Options());
  const SegmentSequencer open(Drivable(plan), StateAt(0.0, 0.0), Options(StationSource::kOdometer));
  EXPECT_EQ(open.speed().SpeedAt(5.0), 1.25);
  EXPECT_NE(closed.speed().SpeedAt(5.0), 1.25);
}

TEST(SegmentSequencer, ReplacesWhatIsLeft) {
  SegmentSequencer sequencer(Drivable(BackAndForth()), StateAt(0.0, 0.0), Options());
  sequencer.Project(StateAt(1.25, 1.25));
  Plan next = PlanAlongRoute({{.length = 7.0}}, 0.0);
  next.reference.path = Path({1.25, 0.0, 0.0}, {{.length = 7.0}});
  sequencer.Replace(Drivable(next), StateAt(1.25, 1.25, 2.0));
  EXPECT_TRUE(sequencer.is_last());
  EXPECT_EQ(sequencer.start_time(), 2.0);
  EXPECT_NEAR(sequencer.offset(), 1.25, Tolerance(1e-12));
  EXPECT_NEAR(sequencer.Project(StateAt(2.0, 2.0))->s, 2.0, Tolerance(1e-12));
  EXPECT_NEAR(sequencer.station(), 0.75, Tolerance(1e-12));
}

TEST(SegmentSequencer, SteersBeforeAStartOnABendFromRestAlone) {
  const std::vector<Segment> bend{{.length = 10.0, .curvature = 0.1}};
  VehicleState rolling = StateAt(0.0, 0.0);
  rolling.speed = 1.0;
  const auto steers = [&](const std::vector<Segment>& segments, const VehicleState& start) {
    return SegmentSequencer(Drivable(PlanAlongRoute(segments, start.speed)), start, Options())
        .stationary_steer()
        .InProgress();
  };
  EXPECT_TRUE(steers(bend, StateAt(0.0, 0.0)));
  EXPECT_FALSE(steers(bend, rolling));
  EXPECT_FALSE(steers({{.length = 10.0}}, StateAt(0.0, 0.0)));
}

TEST(SegmentSequencer, LetsACarThatStandsBeforeABendSteerForTheBend) {
  const std::vector<Segment> bend{{.length = 10.0, .curvature = 0.1}};
  SegmentSequencer sequencer(Drivable(PlanAlongRoute(bend, 0.0)), StateAt(0.0, 0.0), Options());
  const VehicleState before = StateAt(-0.001, 0.0);
  sequencer.Project(before);
  EXPECT_EQ(sequencer.StationFor(before), 0.0);
  EXPECT_EQ(sequencer.StationNear(before.pose), 0.0);
  sequencer.stationary_steer().Update(0.2, 0.1);
  sequencer.stationary_steer().Update(0.2, 0.2);
  ASSERT_FALSE(sequencer.stationary_steer().InProgress());
  EXPECT_NEAR(sequencer.StationFor(before), -0.001, Tolerance(1e-12));
}

TEST(SegmentSequencer, HasNoProjectionWithoutAPath) {
  SegmentSequencer sequencer(Drivable(PlanAtSpeed(3.0)), StateAt(0.0, 0.0), Options());
  EXPECT_FALSE(sequencer.has_path());
  EXPECT_FALSE(sequencer.Project(StateAt(2.0, 2.0)));
  EXPECT_FALSE(sequencer.stationary_steer().InProgress());
}

}  // namespace
}  // namespace trackbed
