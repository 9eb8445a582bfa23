#include "trackbed/planning/course/lane_change.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/tolerance.h"
#include "trackbed/core/angle.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/registry/planners.h"

namespace trackbed {
namespace lane_change_test {

constexpr double kRounding = 1e-9;

VehicleParams Car() {
  VehicleParams car;
  car.wheelbase = 2.5;
  car.length = 4.5;
  car.width = 1.6;
  car.rear_overhang = 1.0;
  car.steering_limit = 0.6;
  car.steering_rate = 0.4;
  return car;
}

TEST(LaneChangeGates, AreThoseOfPart1) {
  const auto gates = LaneChangeGates(LaneChangeStandard::kIso3888_1, Side::kLeft, 1.6, {});
  ASSERT_EQ(gates.size(), 3U);
  // The width of a section is 1.1, 1.2 or 1.3 times the car's width of 1.6 m, plus 0.25 m.
  const std::vector<double> widths{2.01, 2.17, 2.33};
  const std::vector<double> begins{0.0, 45.0, 95.0};
  const std::vector<double> lengths{15.0, 25.0, 30.0};
  const std::vector<double> right_edges{0.0, 3.5, 0.0};  // The distance from the right edge of
                                                         // section 1 [m].
  for (std::size_t i = 0; i < 3; ++i) {
    const OrientedBox& lane = gates[i].lane;
    EXPECT_EQ(gates[i].section, static_cast<int>(2 * i + 1));
    EXPECT_NEAR(lane.width, widths[i], Tolerance(kRounding));
    EXPECT_NEAR(lane.length, lengths[i], Tolerance(kRounding));
    EXPECT_NEAR(lane.center.x - 0.5 * lane.length, begins[i], Tolerance(kRounding));
    EXPECT_NEAR(lane.center.y - 0.5 * lane.width, right_edges[i] - 0.5 * 2.01,
                Tolerance(kRounding));
  }
}

TEST(LaneChangeGates, AreThoseOfPart2Mirrored) {
  const Pose2 start{3.0, 4.0, 0.5};
  const auto gates = LaneChangeGates(LaneChangeStandard::kIso3888_2, Side::kRight, 1.6, start);
  const std::vector<double> widths{2.01, 2.6, 3.0};
  const std::vector<double> begins{0.0, 25.5, 49.0};
  const std::vector<double> lengths{12.0, 11.0, 12.0};
  for (std::size_t i = 0; i < 3; ++i) {
    const OrientedBox& lane = gates[i].lane;
    const Vec2 middle = ToLocal(start, lane.center.position());
    EXPECT_EQ(lane.center.yaw, 0.5);
    EXPECT_NEAR(lane.width, widths[i], Tolerance(kRounding));
    EXPECT_NEAR(lane.length, lengths[i], Tolerance(kRounding));
    EXPECT_NEAR(middle.x() - 0.5 * lane.length, begins[i], Tolerance(kRounding));
    // The left edge of section 3 is 1 m to the right of the right edge of section 1. Sections 1 and
    // 5 share their left edge.
    const double left = middle.y() + 0.5 * lane.width;
    EXPECT_NEAR(left, i == 1 ? -0.5 * 2.01 - 1.0 : 0.5 * 2.01, Tolerance(kRounding));
  }
}

TEST(LaneChangeGates, HaveConesOutsideTheirEdges) {
  const Gate gate{3, {{10.0, 2.0, 0.5 * kPi}, 12.0, 3.0}};
  const std::vector<Vec2> cones = GateCones(gate);
  ASSERT_EQ(cones.size(), 10U);
  // The cones stand from y = -4 to y = 8, at 1.5 m plus half the width of a cone to either side.
  EXPECT_NEAR(cones[0].x(), 10.0 - 1.65, Tolerance(kRounding));
  EXPECT_NEAR(cones[0].y(), -4.0, Tolerance(kRounding));
  EXPECT_NEAR(cones[9].x(), 10.0 + 1.65, Tolerance(kRounding));
  EXPECT_NEAR(cones[9].y(), 8.0, Tolerance(kRounding));
}

TEST(LaneChangePlan, LeadsThroughTheMiddlesOnACurveWithoutJumps) {
  const Pose2 start{3.0, 4.0, 0.5};
  for (const LaneChangeStandard standard :
       {LaneChangeStandard::kIso3888_1, LaneChangeStandard::kIso3888_2}) {
    for (const Side side : {Side::kLeft, Side::kRight}) {
      PlanRequest request;
      request.vehicle = Car();
      request.start = start;
      request.start_speed = 12.0;
      request.infeasible = InfeasiblePolicy::kAllow;  // only the path's shape matters here
      request.speed = {12.0, 1.0, 1.5};
      const Plan plan = MakePlan(
          request,
          LaneChangePlannerOptions{.standard = standard, .first = side, .leave = 1.0, .join = 2.0});
      ASSERT_TRUE(plan.ok());
      ASSERT_EQ(plan.gates.size(), 3U);
      const Path& path = plan.reference.path;
      double last = 0.0;
      for (const Gate& gate : plan.gates) {
        const Vec2 center = gate.lane.center.position();
        const Projection at = path.Project({center.x(), center.y(), start.yaw});
        // The error of SegmentsThrough is below 1e-6 m over such bends.
        EXPECT_NEAR(at.cross_track, 0.0, Tolerance(1e-5));
        EXPECT_NEAR(at.heading_error, 0.0, Tolerance(1e-6));
        EXPECT_GT(at.s, last);
        last = at.s;
      }
      // The first lane change is 30 + 3 m long in part 1, and 13.5 + 3 m long in part 2.
      const bool part_1 = standard == LaneChangeStandard::kIso3888_1;
      const double length = part_1 ? 33.0 : 16.5;
      const double offset = std::abs(ToLocal(start, plan.gates[1].lane.center.position()).y());
      double most = 0.0;
      for (double s = 0.0; s < 75.0; s += 0.01) {
        most = std::max(most, std::abs(path.At(s).curvature));
      }
      const double bound = 10.0 / std::sqrt(3.0) * offset / (length * length);
      EXPECT_LE(most, bound);
      EXPECT_GE(most, 0.6 * bound);  // Where the curve y(x) is steep, its curvature is below its
                                     // second derivative.
      // The segments are arcs of at most 0.1 m, so the curvature steps by at most 0.1 m times
      // dkappa/ds. The derivative dkappa/ds is at most 60 offset/length^3, at the ends of a lane
      // change. The second lane change is shorter than the first, and its offset is not larger.
      const double steepest = 60.0 * offset / std::pow(part_1 ? 28.0 : 15.5, 3);
      double curvature = 0.0;
      for (const Segment& segment : path.segments()) {
        EXPECT_LE(std::abs(segment.curvature - curvature), 0.1 * steepest);
        EXPECT_TRUE(segment.curvature == 0.0 || segment.length < 0.1) << segment.length;
        curvature = segment.curvature;
      }
      // Braking from 12 m/s at 1.5 m/s^2 takes 48 m.
      EXPECT_NEAR(plan.reference.speed.SpeedAt(path.length() - 48.0), 12.0, Tolerance(1e-6));
      EXPECT_EQ(plan.reference.speed.SpeedAt(path.length()), 0.0);
      EXPECT_EQ(DiagnosticsJson(plan)["gates"].size(), 3U);
    }
  }
}

TEST(GateMargins, SeeConesThatStandBetweenPoses) {
  const std::vector<Gate> gates{{1, {{0.0, 0.0, 0.0}, 0.5, 3.0}}};
  // The gate is shorter than the distance between two poses. The car drifts to the left by 0.1 m
  // per meter.
  const std::vector<Pose2> poses{
      {-6.0, 0.0, 0.0}, {-3.0, 0.3, 0.0}, {0.0, 0.6, 0.0}, {3.0, 0.9, 0.0}};
  // The rear left corner, 1 m behind the rear axle, leaves the gate last. At this time, the rear
  // axle is at x = 1.25 m and y = 0.725 m.
  EXPECT_NEAR(GateMargins(gates, Car(), poses)[0], 1.5 - 0.8 - 0.725, Tolerance(kRounding));
  EXPECT_TRUE(std::isinf(GateMargins(gates, Car(), {{20.0, 0.0, 0.0}})[0]));
}

}  // namespace lane_change_test
}  // namespace trackbed
