#include "render/tyre_forces.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "tests/render/pictures.h"
#include "tests/tolerance.h"

namespace trackbed::render {
namespace {

class TyreForcesTest : public FilmSceneTest {
 protected:
  /// Sets each wheel's load and its longitudinal and lateral force [N].
  void SetForces(double load, double along, double across) {
    for (const char* wheel : {"fl", "fr", "rl", "rr"}) {
      SetLogColumn(folder_.path(), "mujoco", fmt::format("normal_force_{}_N", wheel),
                   [=](double) { return load; });
      SetLogColumn(folder_.path(), "mujoco", fmt::format("longitudinal_force_{}_N", wheel),
                   [=](double) { return along; });
      SetLogColumn(folder_.path(), "mujoco", fmt::format("lateral_force_{}_N", wheel),
                   [=](double) { return across; });
    }
  }
  void SetScenario(const std::string& text) {
    WriteFileAtomically(folder_.path() / "scenario.resolved.yaml", text);
  }
  std::vector<WheelForce> ForcesAt(double time) {
    Recording recording = ReadRecording(folder_.path());
    const MujocoData data = MakeMujocoData(*recording.model);
    recording.plants.front().Pose(time, *recording.model, *data);
    return TyreForces(recording).At(time, *data);
  }
};

TEST_F(TyreForcesTest, LieInsideWhatTheContactsFrictionAllows) {
  EXPECT_TRUE(ForcesAt(1.0).empty());  // the log has no forces
  SetScenario("schema: 1\nname: c\nvehicle: {tyre: contact}\nmission: {speed: 3, duration: 1}\n");
  SetForces(4000.0, 1200.0, -2400.0);
  const std::vector<WheelForce> forces = ForcesAt(1.0);
  ASSERT_EQ(forces.size(), 4U);
  for (const WheelForce& force : forces) {
    // The car drives along x with its wheels straight; the contacts' friction is 0.9.
    EXPECT_NEAR((force.forward - Eigen::Vector3d::UnitX()).norm(), 0.0, Tolerance(1e-9));
    EXPECT_NEAR((force.left - Eigen::Vector3d::UnitY()).norm(), 0.0, Tolerance(1e-9));
    EXPECT_EQ(force.force, Vec2(1200.0, -2400.0));
    EXPECT_DOUBLE_EQ(force.most.x(), 3600.0);
    EXPECT_DOUBLE_EQ(force.most.y(), 3600.0);
    EXPECT_DOUBLE_EQ(force.Use(), std::hypot(1200.0, 2400.0) / 3600.0);
    EXPECT_EQ(force.place.z(), 0.0);
  }
  // At 1 s the rear axle is at x = 3, and the front one 2.7 m ahead.
  EXPECT_NEAR(forces[0].place.x(), 5.7, Tolerance(0.01));
  EXPECT_NEAR(forces[2].place.x(), 3.0, Tolerance(1e-9));
  EXPECT_GT(forces[0].place.y(), 0.5);
  EXPECT_LT(forces[1].place.y(), -0.5);
}

TEST_F(TyreForcesTest, KnowTheRoadAndTheMagicFormulasFriction) {
  SetForces(4000.0, 0.0, 1000.0);
  // A friction patch under the left wheels only.
  SetScenario(R"(schema: 1
name: run
mission: {speed: 3, waypoints: [[0, 0], [20, 0]]}
vehicle: {tyre: magic_formula}
world: {friction_patches: [{x: 3, y: 1, length: 20, width: 2, friction: 0.5}]}
)");
  const Recording recording = ReadRecording(folder_.path());
  const mjModel& model = *recording.model;
  const auto number = [&](const char* name) {
    const int id = mj_name2id(&model, mjOBJ_NUMERIC, name);
    return id < 0 ? 0.0 : model.numeric_data[model.numeric_adr[id]];
  };
  ASSERT_GT(number("p_dy1"), 0.0);
  const double over = number("F_z0") > 0.0 ? 4000.0 / number("F_z0") - 1.0 : 0.0;
  const std::vector<WheelForce> forces = ForcesAt(1.0);
  ASSERT_EQ(forces.size(), 4U);
  for (std::size_t w = 0; w < 4; ++w) {
    const double road = w % 2 == 0 ? 0.5 : 1.0;
    EXPECT_NEAR(forces[w].most.x(), 4000.0 * road * (number("p_dx1") + over * number("p_dx2")),
                Tolerance(1e-9));
    EXPECT_NEAR(forces[w].most.y(), 4000.0 * road * (number("p_dy1") + over * number("p_dy2")),
                Tolerance(1e-9));
  }
}

class GripDialTest : public FilmSceneTest {
 protected:
  /// A dial of 40 px in the center of 120 x 120 px, for a tyre with limits of 1000 N longitudinally
  /// and 2000 N laterally.
  Image Dial(const std::optional<Vec2>& force) {
    Image image;
    image.Resize(120, 120);
    std::fill(image.rgb.begin(), image.rgb.end(), std::uint8_t{120});
    Canvas canvas(image, font_);
    WheelForce wheel{};
    wheel.most = {1000.0, 2000.0};
    wheel.force = force.value_or(Vec2(0.0, 0.0));
    DrawGripDial(canvas, {60.0, 60.0}, 40.0, force ? &wheel : nullptr, 2.0);
    return image;
  }
};

TEST_F(GripDialTest, PointsWhereTheForceGoesAndEndsAtTheShareOfGripThatIsUsed) {
  // For any limit in newtons, 0.3 of the longitudinal friction limit is a bar of 12 px upward.
  const Image little = Dial(Vec2(300.0, 0.0));
  EXPECT_GT(little.Pixel(60, 50)[0], 200);
  EXPECT_GT(little.Pixel(60, 50)[1], 200);  // white: less than 0.9
  EXPECT_LT(little.Pixel(60, 35)[0], 120);  // beyond the bar's end: the dial's dark color
  EXPECT_LT(little.Pixel(60, 70)[0], 120);
  EXPECT_GT(little.Pixel(60, 20)[0], 180);  // the rim
  EXPECT_GT(little.Pixel(20, 60)[0], 180);
  EXPECT_EQ(little.Pixel(60, 15)[0], 120);
  // Half of the lateral limit of 2000 N is a bar of 20 px to the left. The bar for half of the
  // longitudinal limit of 1000 N has the same length.
  const Image half = Dial(Vec2(0.0, 1000.0));
  EXPECT_GT(half.Pixel(45, 60)[0], 200);
  EXPECT_LT(half.Pixel(32, 60)[0], 120);
  // A fully used tyre is red up to the rim; with ten times less grip and load the dial is the same.
  const Image all = Dial(Vec2(0.0, 2000.0));
  for (const int x : {25, 40, 52}) {
    EXPECT_GT(all.Pixel(x, 60)[0], all.Pixel(x, 60)[1] + 120) << x;
  }
  EXPECT_LT(all.Pixel(70, 60)[0], 120);
}

TEST_F(GripDialTest, StaysNextToTheRimHoweverLargeTheForceAndIsEmptyWithoutLoad) {
  const Image beyond = Dial(Vec2(5000.0, 0.0));
  EXPECT_GT(beyond.Pixel(60, 16)[0], beyond.Pixel(60, 16)[1] + 120);
  EXPECT_EQ(beyond.Pixel(60, 5)[0], 120);
  const Image empty = Dial(std::nullopt);
  EXPECT_LT(empty.Pixel(60, 60)[0], 120);
  EXPECT_GT(empty.Pixel(60, 20)[0], 120);
}

}  // namespace
}  // namespace trackbed::render
