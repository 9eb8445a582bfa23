#include "trackbed/sim/world_scene.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <cmath>
#include <cstring>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tests/tolerance.h"
#include "trackbed/core/angle.h"
#include "trackbed/sim/car_model.h"
#include "trackbed/sim/plant.h"
#include "trackbed/sim/scene.h"

// Tests the MuJoCo scene of a world: height fields against closed forms, contact with the ground
// and with obstacles, and start poses on uneven ground.
namespace trackbed {
namespace world_scene_test {

MujocoData MakeData(const CarModel& car) {
  return MakeMujocoData(*car.get());
}

const Scene& Prius() {
  static const Scene scene = ComposeScene(FindModel("prius", ""), {});
  return scene;
}

int Geom(const CarModel& car, const std::string& name) {
  const int geom = mj_name2id(car.get(), mjOBJ_GEOM, name.c_str());
  EXPECT_GE(geom, 0) << name;
  return geom;
}

const Bump kBump{.area = {{10.0, 1.0, 0.4}, 4.0, 6.0}, .height = 0.1, .edge = 0.5};

TEST(WithGround, LeavesFlatGroundAsItIs) {
  EXPECT_EQ(WithGround(Prius(), {}).xml, Prius().xml);
}

TEST(WithGround, AGradeIsThePlaneItself) {
  const Ground ground{.grade = {0.08, -0.05}};
  const CarModel car(WithGround(Prius(), ground), "prius");
  const mjModel& m = *car.get();
  EXPECT_EQ(mj_name2id(&m, mjOBJ_GEOM, "ground_0"), -1);
  EXPECT_EQ(mj_name2id(&m, mjOBJ_GEOM, "ground_fl"), -1);
  const int plane = Geom(car, "ground");
  EXPECT_EQ(m.geom_type[plane], mjGEOM_PLANE);
  const MujocoData d = MakeData(car);
  mj_kinematics(&m, d.get());
  const mjtNum* R = d->geom_xmat + 9 * plane;
  const Eigen::Vector3d normal = GroundNormal(ground, {});
  // Numbers of a model are written with 17 digits and normalized once.
  EXPECT_NEAR((Eigen::Vector3d(R[2], R[5], R[8]) - normal).norm(), 0.0, Tolerance(1e-12));
  EXPECT_NEAR(Eigen::Vector3d(d->geom_xpos + 3 * plane).norm(), 0.0, Tolerance(1e-12));
}

TEST(WithGround, AHeightFieldIsTheClosedFormAtItsSamples) {
  Ground ground{.grade = {0.03, 0.02}, .bumps = {kBump}};
  ground.side_slopes = {
      {.area = {{-30.0, 0.0, 2.0}, 20.0, 8.0}, .slope = -0.06, .transition_length = 5.0}};
  const CarModel car(WithGround(Prius(), ground), "prius");
  const mjModel& m = *car.get();
  const MujocoData d = MakeData(car);
  mj_kinematics(&m, d.get());
  ASSERT_EQ(m.nhfield, 2);
  for (const char* name : {"ground_0", "ground_1"}) {
    const int geom = Geom(car, name);
    ASSERT_EQ(m.geom_type[geom], mjGEOM_HFIELD);
    const int field = m.geom_dataid[geom];
    const int rows = m.hfield_nrow[field];
    const int columns = m.hfield_ncol[field];
    const mjtNum* size = m.hfield_size + 4 * field;
    double worst = 0.0;
    double highest = 0.0;
    for (int row = 0; row < rows; ++row) {
      for (int column = 0; column < columns; ++column) {
        const float share = m.hfield_data[m.hfield_adr[field] + row * columns + column];
        const std::array<mjtNum, 3> local{(2.0 * column / (columns - 1) - 1.0) * size[0],
                                          (2.0 * row / (rows - 1) - 1.0) * size[1],
                                          static_cast<double>(share) * size[2]};
        std::array<mjtNum, 3> p{};
        mju_mulMatVec(p.data(), d->geom_xmat + 9 * geom, local.data(), 3, 3);
        mju_addTo3(p.data(), d->geom_xpos + 3 * geom);
        worst = std::max(worst, std::abs(p[2] - GroundHeight(ground, {p[0], p[1]})));
        highest = std::max(highest, p[2] - ground.grade.dot(Vec2(p[0], p[1])));
      }
    }
    // Samples are floats with a relative rounding error of 6e-8, over a range of less than 2 m.
    EXPECT_NEAR(worst, 0.0, Tolerance(2e-7)) << name;
    EXPECT_GT(highest, 0.09) << name;
  }
}

/// Returns the height of the center of a ball of radius `r` that rests on the ground, above the
/// point `p`. Searches over points at a distance of `step`. The result is too low by at most
/// step^2/(4 r).
double BallHeight(const Ground& ground, const Vec2& p, double r, double step) {
  double highest = -1e9;
  for (double x = -r; x <= r; x += step) {
    for (double y = -r; y <= r; y += step) {
      const double square = r * r - x * x - y * y;
      if (square >= 0.0) {
        highest = std::max(highest, GroundHeight(ground, p + Vec2(x, y)) + std::sqrt(square));
      }
    }
  }
  return highest;
}

TEST(WithGround, ATerrainIsFineWhereItIsRefinedAndCoarseAround) {
  const Terrain::Size size{.low = {-64.0, -64.0}, .columns = 5, .rows = 4, .base = -3.0};
  Terrain terrain(size, std::vector<double>(std::size_t{21} * 17, -1.0));
  for (const int column : {1, 2}) {
    terrain.Refine(column, 1, [](const Vec2& p, double) {
      const double r = (p - Vec2(0.0, -16.0)).norm() / 14.0;
      return r < 1.0 ? 0.5 * std::pow(std::cos(0.5 * kPi * r), 4) : 0.0;
    });
  }
  Ground ground;
  ground.terrain = std::make_shared<const Terrain>(std::move(terrain));
  const CarModel car(WithGround(Prius(), ground), "prius");
  const mjModel& m = *car.get();
  ASSERT_EQ(m.nhfield, 3);  // two blocks and the whole area
  EXPECT_EQ(m.geom_pos[3 * Geom(car, "ground") + 2], -3.0);
  for (const char* name : {"ground_0", "ground_1", "ground_2"}) {
    const int geom = Geom(car, name);
    const int field = m.geom_dataid[geom];
    const mjtNum* sides = m.hfield_size + 4 * field;
    const int columns = m.hfield_ncol[field];
    const bool fine = std::string(name) != "ground_2";
    EXPECT_EQ(columns, fine ? 65 : 21);
    int under = 0;
    for (int i = 0; i < m.hfield_nrow[field] * columns; ++i) {
      const Vec2 p(m.geom_pos[3 * geom] + (2.0 * (i % columns) / (columns - 1.0) - 1.0) * sides[0],
                   m.geom_pos[3 * geom + 1] +
                       (2.0 * (i / columns) / (m.hfield_nrow[field] - 1.0) - 1.0) * sides[1]);
      const double z = m.geom_pos[3 * geom + 2] +
                       sides[2] * static_cast<double>(m.hfield_data[m.hfield_adr[field] + i]);
      const double below = GroundHeight(ground, p) - z;
      // The tolerance covers single precision over a height range below 8 m.
      const bool hidden = std::abs(below - 4.0) < Tolerance(1e-6);
      EXPECT_TRUE(hidden || std::abs(below) < Tolerance(1e-6)) << name << " " << below;
      under += hidden ? 1 : 0;
    }
    // 3 by 7 corners of coarse cells lie inside the two blocks, excluding their border.
    EXPECT_EQ(under, fine ? 0 : 21);
  }
}

TEST(WithGround, ABallComesToRestOnTheClosedForm) {
  const Ground ground{.grade = {0.02, 0.0}, .bumps = {kBump}};
  for (const double along : {-3.0, -1.4, -0.6, 0.0, 0.9, 1.7}) {
    const Vec2 p = ToWorld(kBump.area.center, {along, 0.3});
    Scene scene = WithGround(Prius(), ground);
    const double r = 0.3;
    const std::string ball = fmt::format(
        "<body name='ball' pos='{} {} {}'><joint name='ball' type='slide' axis='0 0 1'/>"
        "<geom type='sphere' size='{}' density='1000' condim='1' priority='2' "
        "solref='0.005 1' solimp='0.995 0.995 0.001'/></body>",
        p.x(), p.y(), GroundHeight(ground, p) + r + 0.05, r);
    scene.xml.insert(scene.xml.rfind("</worldbody>"), ball);
    const CarModel car(scene, "prius");
    const MujocoData d = MakeData(car);
    for (int i = 0; i < 500; ++i) {
      mj_step(car.get(), d.get());
    }
    const int body = mj_name2id(car.get(), mjOBJ_BODY, "ball");
    // The facets of the height field have the size d = 5 cm. The facets are lower than the bump,
    // with its curvature c = 2 pi^2 h/L^2 = 0.12 1/m, by at most c d^2/8 = 4e-5 m. The contact
    // yields by 1e-6 m.
    EXPECT_NEAR(d->xpos[3 * body + 2], BallHeight(ground, p, r, 0.002), Tolerance(5e-5)) << along;
  }
}

TEST(WithGround, WheelPlanesTouchNothingByThemselves) {
  const CarModel car(WithGround(Prius(), {.bumps = {kBump}}), "prius");
  for (const char* wheel : kWheels) {
    const int geom = Geom(car, std::string("ground_") + wheel);
    EXPECT_EQ(car.get()->geom_type[geom], mjGEOM_PLANE);
    const mjModel& m = *car.get();
    for (int other = 0; other < m.ngeom; ++other) {
      EXPECT_EQ((m.geom_contype[other] & m.geom_conaffinity[geom]) |
                    (m.geom_contype[geom] & m.geom_conaffinity[other]),
                0);
    }
  }
}

TEST(WithWorld, ObstaclesStandOnTheGround) {
  World world;
  world.ground.grade = {0.1, 0.0};
  world.obstacles = {{{{20.0, 3.0, kPi / 2.0}, 2.0, 1.0}, 1.5}};
  const CarModel flat(Prius(), "prius");
  const CarModel car(WithWorld(Prius(), flat.params(), world), "prius");
  const MujocoData d = MakeData(car);
  mj_kinematics(car.get(), d.get());
  const int box = Geom(car, "obstacle_0");
  const Eigen::Vector3d middle(d->geom_xpos + 3 * box);
  const Eigen::Vector3d normal = GroundNormal(world, {20.0, 3.0});
  EXPECT_NEAR((middle - Eigen::Vector3d(20.0, 3.0, 2.0) - 0.75 * normal).norm(), 0.0,
              Tolerance(1e-12));
  const mjtNum* R = d->geom_xmat + 9 * box;
  EXPECT_NEAR((Eigen::Vector3d(R[2], R[5], R[8]) - normal).norm(), 0.0, Tolerance(1e-12));
  // The box's length axis points north, across the grade.
  EXPECT_NEAR(R[3], 1.0, Tolerance(1e-12));
}

/// The largest force [N] of obstacles on anything, from `start` on for one second.
double LargestForce(const std::vector<Obstacle>& obstacles, const StartState& start) {
  World world;
  world.obstacles = obstacles;
  const CarModel flat(Prius(), "prius");
  const CarModel car(WithWorld(Prius(), flat.params(), world), "prius");
  const std::unique_ptr<Plant> plant =
      MakePlant("mujoco", {.car = car, .world = world, .start = start});
  double largest = plant->obstacle_force();
  for (double t = 0.0; t < 1.0; t += car.timestep()) {
    plant->Step({});
    largest = std::max(largest, plant->obstacle_force());
  }
  return largest;
}

// Whether a box exactly on the ground touches the ground would depend on the rounding of its
// corners.
TEST(WithWorld, MovingObstaclesDoNotTouchTheGround) {
  for (int i = 0; i < 31; ++i) {
    const OrientedBox box{{60.0, 30.0, 0.05 + 0.1 * i}, 4.0, 2.0};
    EXPECT_EQ(LargestForce({{.footprint = box, .height = 1.5, .velocity = {0.0, 0.5}}}, {}), 0.0)
        << box.center.yaw;
  }
}

TEST(WithWorld, MovingObstaclesDoNotTouchEachOther) {
  const Obstacle still{.footprint = {{60.0, 30.0, 0.0}, 4.0, 2.0}};
  Obstacle moving = still;
  moving.velocity = {1.0, 0.0};
  Obstacle oncoming = still;
  oncoming.velocity = {-1.0, 0.0};
  EXPECT_EQ(LargestForce({still, moving, oncoming}, {}), 0.0);
}

TEST(WithWorld, ObstaclesTouchTheCar) {
  Obstacle obstacle{.footprint = {{5.5, 0.0, 0.0}, 2.0, 2.0}};
  EXPECT_EQ(LargestForce({obstacle}, {}), 0.0);  // the car is at rest, one meter away
  EXPECT_GT(LargestForce({obstacle}, {.speed = 5.0}), 1000.0);
  obstacle.velocity = {-5.0, 0.0};
  EXPECT_GT(LargestForce({obstacle}, {}), 1000.0);
}

TEST(WithWorld, ObstaclesThatMoveThroughPosesTouchTheCar) {
  // The box comes from the side and turns toward the car. From 0.2 s on, the end of the box touches
  // the car.
  Obstacle obstacle{.footprint = {{5.5, 3.0, 0.0}, 4.0, 1.0}};
  obstacle.motion = {{0.0, {5.5, 3.0, 0.0}}, {0.2, {5.5, 3.0, 0.0}}, {0.4, {4.0, 1.5, 1.5}}};
  EXPECT_GT(LargestForce({obstacle}, {}), 1000.0);
  obstacle.until = 0.1;
  EXPECT_EQ(LargestForce({obstacle}, {}), 0.0);
}

/// Distances of the tyres' centers from the plane of a grade.
std::array<double, 4> TyreDistances(const CarModel& car, const mjData& d, const Ground& ground) {
  std::array<double, 4> distances{};
  for (std::size_t w = 0; w < 4; ++w) {
    distances[w] =
        GroundNormal(ground, {}).dot(Eigen::Vector3d(d.geom_xpos + 3 * car.parts().tyre[w]));
  }
  return distances;
}

TEST(StandingPosition, OnAGradeIsTheFlatOneTilted) {
  const Ground ground{.grade = {0.1, -0.07}};
  const CarModel car(WithGround(Prius(), ground), "prius");
  const mjModel& m = *car.get();
  const MujocoData d = MakeData(car);
  for (const double yaw : {0.0, 0.8, 2.5, -1.9}) {
    const Pose2 pose{5.0, -3.0, yaw};
    const auto qpos = car.StandingPosition(pose, 0.1, {}, ground);
    std::copy(qpos.begin(), qpos.end(), d->qpos);
    mj_forward(&m, d.get());
    for (const double distance : TyreDistances(car, *d, ground)) {
      // The distance must be that on flat ground: the height of the Prius's hubs at rest, without
      // an inclination of the tyres.
      EXPECT_NEAR(distance, 0.31073, Tolerance(1e-9)) << yaw;
    }
    const mjtNum* R = d->xmat + 9 * car.parts().chassis;
    EXPECT_NEAR(AngleDifference(std::atan2(R[3], R[0]), yaw), 0.0, Tolerance(1e-12));
    EXPECT_NEAR((Eigen::Vector3d(R[2], R[5], R[8]) - GroundNormal(ground, {})).norm(), 0.0,
                Tolerance(1e-12));
    const mjtNum* p = d->xpos + 3 * car.parts().chassis;
    EXPECT_EQ(p[0], 5.0);
    EXPECT_EQ(p[1], -3.0);
    EXPECT_NEAR(p[2], GroundHeight(ground, {5.0, -3.0}), Tolerance(1e-12));
  }
}

TEST(StandingPosition, OnFlatGroundIsTheFlatOne) {
  const CarModel car(Prius(), "prius");
  const Pose2 pose{1.0, 2.0, 0.7};
  EXPECT_EQ(car.StandingPosition(pose, 0.2, {1.0, 2.0, 3.0, 4.0}, {}),
            car.FlatPosition(pose, 0.2, {1.0, 2.0, 3.0, 4.0}));
}

TEST(StandingPosition, AcrossABumpNoWheelIsInTheGround) {
  const Ground ground{.bumps = {kBump}};
  const CarModel car(WithGround(Prius(), ground), "prius");
  const MujocoData d = MakeData(car);
  for (double x = 4.0; x < 14.0; x += 0.37) {
    const auto qpos = car.StandingPosition({x, 0.0, 0.2}, 0.0, {}, ground);
    std::copy(qpos.begin(), qpos.end(), d->qpos);
    mj_kinematics(car.get(), d.get());
    double nearest = 1.0;
    for (const int tyre : car.parts().tyre) {
      const mjtNum* center = d->geom_xpos + 3 * tyre;
      nearest =
          std::min(nearest, center[2] - BallHeight(ground, {center[0], center[1]}, 0.31073, 0.01));
    }
    // The ground touches each wheel only at the point below the hub. On a slope of 0.08, the ground
    // ahead of or behind this point may be higher by R (1 - cos 0.08) = 1 mm. This changes the
    // inclination of the car, but hardly moves its hubs.
    EXPECT_GT(nearest, Tolerance(-3e-3)) << x;
    EXPECT_LT(nearest, 0.05) << x;
  }
}

TEST(FlatConfiguration, IsThatOfTheScenesGround) {
  const Ground ground{.grade = {0.1, 0.0}};
  const CarModel car(WithGround(Prius(), ground), "prius");
  const auto row = car.FlatConfiguration({30.0, 0.0, 0.0}, 0.0, {});
  EXPECT_NEAR(row[2], 3.0, Tolerance(1e-12));
  EXPECT_NEAR(row[5], -std::sin(0.5 * std::atan(0.1)), Tolerance(1e-12));  // nose up
}

}  // namespace world_scene_test
}  // namespace trackbed
