#include "trackbed/planning/lanes/lane_route_planner.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/geometry/random.h"
#include "tests/road_network/documents.h"
#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/core/angle.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/registry/planners.h"

namespace trackbed {
namespace {

using ::testing::HasSubstr;

std::shared_ptr<const RoadNetwork> Shared(RoadNetwork network) {
  return std::make_shared<const RoadNetwork>(std::move(network));
}

std::shared_ptr<const RoadNetwork> CrossingRoads() {
  return Shared(ReadOpenDrive(std::string(TRACKBED_SOURCE_DIR) + "/scenarios/roads/crossing.xodr"));
}

/// Returns a request that leads from the west around the loop and back. The car stands at the
/// beginning of the route.
PlanRequest AroundTheLoop() {
  PlanRequest request;
  request.vehicle = ReferenceCar();
  request.lanes = {CrossingRoads(), {{"1", -1, 10.0}, {"2", -1, 90.0}, {"1", 1, 20.0}}};
  request.start = PoseAt(*request.lanes.network, request.lanes.route.front());
  request.speed = {.speed = 5.0, .acceleration = 1.0, .deceleration = 1.5};
  return request;
}

Plan PlanOf(const PlanRequest& request) {
  return MakePlan(request, LaneRouteOptions{});
}

TEST(LaneRoutePlanner, FollowsTheLanesFromPlaceToPlace) {
  const PlanRequest request = AroundTheLoop();
  const Plan plan = PlanOf(request);
  ASSERT_TRUE(plan.ok()) << plan.reason;
  const LaneRoute route = FindLaneRoute(*request.lanes.network, request.lanes.route);
  EXPECT_EQ(plan.reference.path.segments(), route.path.segments());
  const Pose2 goal = PoseAt(*request.lanes.network, request.lanes.route.back());
  EXPECT_NEAR((plan.goal.position() - goal.position()).norm(), 0.0, Tolerance(1e-6));
  EXPECT_NEAR(AngleDifference(plan.goal.yaw, goal.yaw), 0.0, Tolerance(1e-6));
  EXPECT_EQ(plan.reference.speed.SpeedAt(plan.reference.path.length()), 0.0);
  for (const SteeringSchedule::Knot& knot : plan.schedule.knots()) {
    EXPECT_LE(std::abs(knot.steering), request.vehicle.steering_limit);
  }
}

TEST(LaneRoutePlanner, SaysWhichLanesItTakes) {
  const nlohmann::json found = DiagnosticsJson(PlanOf(AroundTheLoop()));
  const auto& lanes = found.at("lanes");
  ASSERT_EQ(lanes.size(), 6U);
  EXPECT_EQ(lanes.front().at("road"), "1");
  EXPECT_EQ(lanes.back().at("lane"), 1);
  EXPECT_EQ(lanes.back().at("to_m"), 20.0);
  EXPECT_LE(found.at("deviation_max_m").get<double>(), 1e-6);
}

void ExpectRefused(const PlanRequest& request, PlanStatus status, const std::string& why) {
  const Plan plan = PlanOf(request);
  EXPECT_EQ(plan.status, status) << ToString(plan.status);
  EXPECT_THAT(plan.reason, HasSubstr(why));
  EXPECT_EQ(plan.reference.path.length(), 0.0);
  EXPECT_TRUE(plan.schedule.knots().empty());
}

TEST(LaneRoutePlanner, RefusesRoutesThatAreNone) {
  PlanRequest request = AroundTheLoop();
  request.lanes.route.resize(1);
  ExpectRefused(request, PlanStatus::kNoPath, "a route of at least two places");
  request = AroundTheLoop();
  request.lanes.network = nullptr;
  ExpectRefused(request, PlanStatus::kNoPath, "needs a road network");
  request = AroundTheLoop();
  request.lanes.route[1].lane = -4;
  ExpectRefused(request, PlanStatus::kNoPath, "road 2 has no lane -4");
  request = AroundTheLoop();
  request.lanes.route = {{"1", 1, 30.0}, {"3", -1, 10.0}};
  ExpectRefused(request, PlanStatus::kNoPath, "no linked lanes lead");
}

TEST(LaneRoutePlanner, RefusesACarThatStandsElsewhere) {
  PlanRequest request = AroundTheLoop();
  request.start.y += 0.5;
  ExpectRefused(request, PlanStatus::kStartBlocked, "the car starts 0.5 m and 0 rad from where");
  request = AroundTheLoop();
  request.start.yaw += 0.1;
  ExpectRefused(request, PlanStatus::kStartBlocked, "and 0.1 rad from where");
}

TEST(LaneRoutePlanner, RefusesLanesThatTheCarCannotSteerThrough) {
  PlanRequest request = AroundTheLoop();
  request.vehicle.steering_limit = 0.05;
  ExpectRefused(request, PlanStatus::kTurnTooTight, "exceeds the limit of 0.050 rad");
}

/// The reference line of a road with a bend, as road designers draw it: a straight, a spiral, an
/// arc, a spiral and a straight. The pieces are rounded to micrometers, as in files.
class SpiralBend {
 public:
  SpiralBend(double curvature, double spiral, double arc) {
    Add(40.0, 0.0, 0.0, "<line/>");
    Add(spiral, 0.0, curvature,
        fmt::format("<spiral curvStart='0' curvEnd='{:.12g}'/>", curvature));
    Add(arc, curvature, curvature, fmt::format("<arc curvature='{:.12g}'/>", curvature));
    Add(spiral, curvature, 0.0,
        fmt::format("<spiral curvStart='{:.12g}' curvEnd='0'/>", curvature));
    Add(40.0, 0.0, 0.0, "<line/>");
  }

  [[nodiscard]] double length() const { return station_; }
  [[nodiscard]] std::string Xml() const {
    RoadText road;
    road.length = fmt::format("{:.12g}", station_);
    road.geometry = geometry_;
    return road.Xml();
  }

 private:
  void Add(double length, double from, double to, const std::string& shape) {
    geometry_ += fmt::format(
        "<geometry s='{:.12g}' x='{:.6f}' y='{:.6f}' hdg='{:.12g}' length='{:.12g}'>{}</geometry>",
        station_, at_.x, at_.y, at_.yaw, length, shape);
    const Path piece(at_,
                     {{.length = length, .curvature = from, .sharpness = (to - from) / length}});
    at_ = piece.At(length).pose;
    station_ += length;
  }

  std::string geometry_;
  double station_ = 0.0;
  Pose2 at_{};
};

TEST(LaneRoutePlanner, SlowsDownForSpirals) {
  Random random(11);
  for (int i = 0; i < 100; ++i) {
    const double radius = random.Uniform(12.0, 150.0);
    const double curvature = (random.Below(2) == 0 ? 1.0 : -1.0) / radius;
    const SpiralBend bend(curvature, random.Uniform(0.1, 0.6) * radius,
                          random.Uniform(0.05, 1.0) * radius);
    PlanRequest request;
    request.vehicle = ReferenceCar();
    request.lanes = {Shared(ParseNetwork(bend.Xml())),
                     {{"1", -1, 1.0}, {"1", -1, bend.length() - 1.0}}};
    request.start = PoseAt(*request.lanes.network, request.lanes.route.front());
    // A car that starts from rest can slow down for every bend.
    request.speed = {.speed = random.Uniform(3.0, 20.0), .acceleration = 1.0, .deceleration = 1.5};
    const Plan plan = PlanOf(request);
    ASSERT_TRUE(plan.ok()) << i << ": radius " << radius << ", " << plan.reason;
    EXPECT_TRUE(plan.stops.empty()) << i;
    // The slope of the steering angle over the distance, in steps of 0.5 m.
    for (double s = 0.0; s + 0.5 < plan.reference.path.length(); s += 0.5) {
      const double slope = std::abs(plan.schedule.At(s + 0.5) - plan.schedule.At(s)) / 0.5;
      const double speed =
          std::min(plan.reference.speed.SpeedAt(s), plan.reference.speed.SpeedAt(s + 0.5));
      // In each step, the smaller speed times the mean slope must not exceed the largest steering
      // rate.
      EXPECT_LE(speed * slope, 1.0001 * request.vehicle.steering_rate) << i << " at " << s;
    }
  }
}

TEST(LaneRoutePlanner, PlansInThePlaneWhateverTheRoadsHeights) {
  RoadText road;
  PlanRequest request = AroundTheLoop();
  request.lanes = {Shared(ParseNetwork(road.Xml())), {{"1", -1, 10.0}, {"1", -1, 60.0}}};
  request.start = {10.0, -1.75, 0.0};
  const Plan level = PlanOf(request);
  ASSERT_TRUE(level.ok()) << level.reason;
  road.heights =
      "<elevationProfile><elevation s='0' a='3' b='0.1' c='0' d='0'/></elevationProfile>";
  request.lanes.network = Shared(ParseNetwork(road.Xml()));
  const Plan hilly = PlanOf(request);
  EXPECT_EQ(hilly.reference.path.segments(), level.reference.path.segments());
  EXPECT_EQ(hilly.reference.speed.SpeedAt(20.0), level.reference.speed.SpeedAt(20.0));
}

}  // namespace
}  // namespace trackbed
