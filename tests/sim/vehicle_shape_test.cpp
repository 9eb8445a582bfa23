#include "trackbed/sim/vehicle_shape.h"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <Eigen/Geometry>
#include <vector>

#include "tests/sim/cars.h"
#include "tests/support/case_names.h"
#include "trackbed/sim/compile_scene.h"
#include "trackbed/sim/world_scene.h"

namespace trackbed {
namespace {

using Transform = Eigen::Isometry3d;

Transform PlaceOf(const std::array<double, 3>& position, const std::array<double, 4>& quaternion) {
  Transform place = Transform::Identity();
  place.translate(Eigen::Vector3d(position[0], position[1], position[2]));
  place.rotate(Eigen::Quaterniond(quaternion[0], quaternion[1], quaternion[2], quaternion[3]));
  return place;
}

class ShapeOf : public testing::TestWithParam<const char*> {};

TEST_P(ShapeOf, StandsWhereMujocoPutsTheCar) {
  const Scene scene = ComposeScene(FindModel(GetParam(), ""), {});
  const VehicleShape shape = ReadVehicleShape(scene, GetParam());
  const MujocoModel model = CompileScene(scene, GetParam(), Looks::kKept);
  const MujocoData data(mj_makeData(model.get()));
  mj_kinematics(model.get(), data.get());
  ASSERT_EQ(static_cast<int>(shape.bodies.size()), model->nbody - 1);
  std::vector<Transform> places;
  for (std::size_t i = 0; i < shape.bodies.size(); ++i) {
    const ShapeBody& body = shape.bodies[i];
    ASSERT_LT(body.parent, static_cast<int>(i));
    const Transform own = PlaceOf(body.position, body.quaternion);
    places.push_back(body.parent < 0 ? own : places[static_cast<std::size_t>(body.parent)] * own);
    for (int axis = 0; axis < 3; ++axis) {
      // Rounding of a few products.
      EXPECT_NEAR(places[i].translation()[axis],
                  data->xpos[3 * (i + 1) + static_cast<std::size_t>(axis)], 1e-12);
    }
  }
  // Geoms from MuJoCo's own kinematics, in the order of the model.
  std::size_t drawn = 0;
  for (int geom = 0; geom < model->ngeom && drawn < shape.geoms.size(); ++geom) {
    const ShapeGeom& own = shape.geoms[drawn];
    const Transform place =
        places[static_cast<std::size_t>(own.body)] * PlaceOf(own.position, own.quaternion);
    const Eigen::Vector3d there(data->geom_xpos + 3 * geom);
    if (model->geom_bodyid[geom] == own.body + 1 && (place.translation() - there).norm() < 1e-12) {
      ++drawn;
    }
  }
  EXPECT_EQ(drawn, shape.geoms.size());
  EXPECT_GT(drawn, 10U);
}

TEST_P(ShapeOf, HasJointsThatStateLogsName) {
  const VehicleShape shape =
      ReadVehicleShape(ComposeScene(FindModel(GetParam(), ""), {}), GetParam());
  std::vector<std::string> channels;
  int free_joints = 0;
  for (const ShapeBody& body : shape.bodies) {
    for (const ShapeJoint& joint : body.joints) {
      if (joint.type == ShapeJoint::Type::kFree) {
        ++free_joints;
      } else {
        channels.push_back(joint.channel);
        const Eigen::Vector3d axis(joint.axis[0], joint.axis[1], joint.axis[2]);
        EXPECT_NEAR(axis.norm(), 1.0, 1e-12);
      }
    }
  }
  EXPECT_EQ(free_joints, 1);
  for (const char* channel : {"suspension_fl_m", "steer_fr_rad", "spin_rl_rad"}) {
    EXPECT_NE(std::find(channels.begin(), channels.end(), channel), channels.end()) << channel;
  }
  for (const ShapeMesh& mesh : shape.meshes) {
    ASSERT_EQ(mesh.vertices.size() % 3, 0U);
    ASSERT_EQ(mesh.faces.size() % 3, 0U);
    for (const int corner : mesh.faces) {
      ASSERT_LT(static_cast<std::size_t>(corner), mesh.vertices.size() / 3);
    }
  }
}

TEST(ReadVehicleShape, LeavesOutObstacles) {
  const CarModel car = CarWith("prius", {});
  World world;
  world.obstacles = {
      {.footprint = {{20.0, 0.0, 0.0}, 4.4, 1.8}, .velocity = {3.0, 0.0}},  // moves by joints
      {.footprint = {{30.0, 5.0, 0.0}, 2.0, 2.0}}};
  const VehicleShape alone = ReadVehicleShape(car.scene(), "prius");
  const VehicleShape among = ReadVehicleShape(WithWorld(car.scene(), car.params(), world), "prius");
  EXPECT_EQ(among.bodies.size(), alone.bodies.size());
  EXPECT_EQ(among.geoms.size(), alone.geoms.size());
}

INSTANTIATE_TEST_SUITE_P(Cars, ShapeOf, testing::Values("prius", "bmw320i"), kNamedByParameter);

}  // namespace
}  // namespace trackbed
