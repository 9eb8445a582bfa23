#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/road_network/documents.h"
#include "tests/support/temp_folder.h"
#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/scenario/initial_state.h"
#include "trackbed/scenario/scenario.h"

// Tests scenarios on road networks.
namespace trackbed {
namespace {

using ::testing::HasSubstr;

constexpr const char* kOnRoads = R"(schema: 1
name: on_roads
world: {road_network: roads.xodr}
mission:
  speed: 5
  route:
    - {road: 1, lane: 1, s: 80}
    - {road: 1, lane: 1, s: 20}
plan: {method: lane_route}
)";

/// A folder with roads.xodr, a network of one straight road.
struct RoadFolder {
  TempFolder folder;

  RoadFolder() { folder.Write("roads.xodr", Document(RoadText{}.Xml())); }

  [[nodiscard]] Scenario Read(const std::vector<Override>& overrides = {}) const {
    return ParseScenario(kOnRoads, "test.yaml", folder.path(), overrides);
  }

  [[nodiscard]] std::string LoadError(const std::vector<Override>& overrides) const {
    try {
      static_cast<void>(Read(overrides));
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
};

TEST(Roads, AreReadWithTheirRoute) {
  const RoadFolder here;
  const Scenario scenario = here.Read();
  ASSERT_TRUE(scenario.world.road_network && scenario.world.road_network->data);
  EXPECT_EQ(scenario.world.road_network->data->network.roads.size(), 1U);
  ASSERT_EQ(scenario.mission.route.size(), 2U);
  EXPECT_EQ(scenario.mission.route[0], (LanePlace{"1", 1, 80.0}));
}

TEST(Roads, AreWhereTheCarStarts) {
  // The route begins on the left lane, against the road's direction.
  const Pose2 start = InitialState(RoadFolder().Read()).pose;
  EXPECT_NEAR(start.x, 80.0, Tolerance(1e-12));
  EXPECT_NEAR(start.y, 1.75, Tolerance(1e-12));
  EXPECT_NEAR(std::abs(start.yaw), kPi, Tolerance(1e-12));
  EXPECT_EQ(InitialState(RoadFolder().Read({"mission.start={y: 2}"})).pose.y, 2.0);
}

TEST(Roads, BendTheWheelsOfACarThatStartsInABend) {
  const TempFolder folder;
  RoadText bend;
  bend.geometry =
      "<geometry s=\"0\" x=\"0\" y=\"0\" hdg=\"0\" length=\"100\"><arc "
      "curvature=\"0.02\"/></geometry>";
  folder.Write("roads.xodr", Document(bend.Xml()));
  const auto read = [&](int lane, int from, int to) {
    return ParseScenario(
        kOnRoads, "test.yaml", folder.path(),
        {fmt::format("mission.route=[{{road: 1, lane: {0}, s: {1}}}, {{road: 1, lane: {0}, s: "
                     "{2}}}]",
                     lane, from, to)});
  };
  // The centers of the lanes are 1.75 m beside the reference line, whose radius is 50 m. The path
  // is a chain of arcs within 0.05 m of the lane over some ten meters, which changes its curvature
  // by less than 1 %.
  const double right = std::atan(2.7 / 51.75);
  EXPECT_NEAR(InitialState(read(-1, 20, 80), ReferenceCar()).steering, right, 0.01 * right);
  const double left = -std::atan(2.7 / 48.25);  // against the road's direction
  EXPECT_NEAR(InitialState(read(1, 80, 20), ReferenceCar()).steering, left, -0.01 * left);
  EXPECT_THAT(ResolvedYaml(read(-1, 20, 80)), testing::Not(HasSubstr("steering: 0\n")));
}

TEST(Roads, StayBesideTheResolvedScenario) {
  const RoadFolder here;
  const Scenario scenario = here.Read();
  const std::string once = ResolvedYaml(scenario);
  EXPECT_THAT(once, HasSubstr("road_network: road_network.xodr\n"));
  const TempFolder elsewhere;
  elsewhere.Write("road_network.xodr", scenario.world.road_network->data->text);
  EXPECT_EQ(once, ResolvedYaml(ParseScenario(once, "resolved.yaml", elsewhere.path())));
}

TEST(Roads, MustLieWithTheScenario) {
  const RoadFolder here;
  EXPECT_THAT(here.LoadError({"world.road_network=../roads.xodr"}),
              HasSubstr("world.road_network: ../roads.xodr"));
  EXPECT_THAT(here.LoadError({"world.road_network=gone.xodr"}), HasSubstr("gone.xodr"));
  here.folder.Write("broken.xodr", "<OpenDRIVE>");
  EXPECT_THAT(here.LoadError({"world.road_network=broken.xodr"}),
              HasSubstr("broken.xodr:1: not XML"));
}

TEST(Roads, AndTheirRouteGoTogether) {
  const RoadFolder here;
  EXPECT_THAT(here.LoadError({"world={}"}),
              HasSubstr("world.road_network: missing; the planner lane_route follows its lanes"));
  EXPECT_THAT(here.LoadError({"mission={speed: 5}"}),
              HasSubstr("mission.route: none given; the planner lane_route needs at least 2"));
  EXPECT_THAT(here.LoadError({"plan={method: course, segments: [{length: 9, curvature: 0}]}"}),
              HasSubstr("mission.route: needs plan: {method: lane_route}"));
  EXPECT_THAT(here.LoadError({"mission.waypoints=[[0, 0], [1, 1]]"}),
              HasSubstr("the planner lane_route defines its own course"));
}

TEST(Roads, HaveThePlacesOfTheirRoute) {
  const RoadFolder here;
  EXPECT_THAT(here.LoadError({"mission.route[1].lane=2"}),
              HasSubstr("mission.route[1]: road 1 has no lane 2"));
  EXPECT_THAT(here.LoadError({"mission.route[0].road=7"}), HasSubstr("unknown road '7'"));
  EXPECT_THAT(here.LoadError({"mission.route[0].s=101"}), HasSubstr("must be between 0 and 100 m"));
  EXPECT_THAT(here.LoadError({"mission.route[0]={road: 1, lane: 1}"}),
              HasSubstr("mission.route[0].s: missing"));
}

/// The road of RoadFolder on a slope, as sloping.xodr.
void WriteSloping(const RoadFolder& here) {
  RoadText road;
  road.heights =
      "<elevationProfile><elevation s='0' a='1' b='0.05' c='0' d='0'/>"
      "</elevationProfile>";
  here.folder.Write("sloping.xodr", Document(road.Xml()));
}

TEST(Roads, ThatAreNotLevelAreTheGround) {
  const RoadFolder here;
  WriteSloping(here);
  EXPECT_TRUE(IsFlat(here.Read().world.ground));
  const Scenario scenario = here.Read({"world.road_network=sloping.xodr"});
  // The tolerance is that of route_ground_test.cpp.
  EXPECT_NEAR(GroundHeight(scenario.world, {50.0, 1.75}), 1.0 + 0.05 * 50.0, Tolerance(2e-5));
  // Readers of only the run's world get the same ground.
  here.folder.Write("road_network.xodr", scenario.world.road_network->data->text);
  const World world = ReadWorld(here.folder.Write("scenario.yaml", ResolvedYaml(scenario)));
  for (double x = -50.0; x < 150.0; x += 3.0) {
    EXPECT_EQ(GroundHeight(world, {x, 3.0}), GroundHeight(scenario.world, {x, 3.0}));
  }
}

TEST(Roads, ThatAreNotLevelAllowNoOtherGround) {
  const RoadFolder here;
  WriteSloping(here);
  const Override sloping = "world.road_network=sloping.xodr";
  EXPECT_EQ(here.LoadError({"world.ground={grade: {x: 0.1}}"}), "");
  EXPECT_THAT(here.LoadError({sloping, "world.ground={grade: {x: 0.1}}"}),
              HasSubstr("world.ground: not available on a route over roads that are not level"));
  RoadText road;
  road.heights =
      "<elevationProfile><elevation s='0' a='1' b='0' c='0' d='0'/>"
      "<elevation s='50' a='2' b='0' c='0' d='0'/></elevationProfile>";
  here.folder.Write("step.xodr", Document(road.Xml()));
  EXPECT_THAT(here.LoadError({"world.road_network=step.xodr"}),
              HasSubstr("mission.route: the surface of road 1 has a step or a kink at s = "));
}

}  // namespace
}  // namespace trackbed
