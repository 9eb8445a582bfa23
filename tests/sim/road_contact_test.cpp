#include "src/sim/road_contact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/tolerance.h"
#include "trackbed/sim/world_scene.h"

namespace trackbed {
namespace {

CarModel PriusOn(const World& world) {
  const Scene scene = ComposeScene(FindModel("prius", ""), {});
  return {WithWorld(scene, CarModel(scene, "prius").params(), world), "prius"};
}

/// A freely rolling car that moves east from the origin.
class Rolling {
 public:
  Rolling(const CarModel& car, double speed)
      : car_(car),
        m(CopyMujocoModel(*car.get())),
        d(MakeMujocoData(*m)),
        contact_(car, TyreSupport::kContacts, *m) {
    const auto qpos = car.StandingPosition({}, 0.0, {}, car.scene().ground);
    std::copy(qpos.begin(), qpos.end(), d->qpos);
    d->qvel[car.parts().chassis_dof] = speed;
    for (const int spin : car.parts().spin_dof) {
      d->qvel[spin] = speed / car.params().wheel_radius;
    }
  }

  void Step() {
    contact_.Place(*m, *d);
    mj_step(m.get(), d.get());
  }

  [[nodiscard]] int CountContacts(std::size_t wheel) const {
    int count = 0;
    for (int i = 0; i < d->ncon; ++i) {
      const int tyre = car_.parts().tyre[wheel];
      count += d->contact[i].geom1 == tyre || d->contact[i].geom2 == tyre ? 1 : 0;
    }
    return count;
  }

  [[nodiscard]] double Load(std::size_t wheel) const {
    double sum = 0.0;
    for (int i = 0; i < d->ncon; ++i) {
      const mjContact& contact = d->contact[i];
      if (contact.geom1 == car_.parts().tyre[wheel] || contact.geom2 == car_.parts().tyre[wheel]) {
        std::array<mjtNum, 6> force{};
        mj_contactForce(m.get(), d.get(), i, force.data());
        sum += force[0];
      }
    }
    return sum;
  }

 private:
  const CarModel& car_;

 public:
  MujocoModel m;
  MujocoData d;

 private:
  RoadContact contact_;
};

/// The height of a wheel's hub when its rim, a circle along x, touches the ground.
double HubHeight(const Ground& ground, double x, double y, double radius) {
  double highest = -1e9;
  for (int i = -400; i <= 400; ++i) {
    const double ahead = radius * i / 400.0;
    highest = std::max(
        highest, GroundHeight(ground, {x + ahead, y}) + std::sqrt(radius * radius - ahead * ahead));
  }
  return highest;
}

const Ground kHump{.bumps = {{.area = {{12.0, 0.0, 0.0}, 8.0, 8.0}, .height = 0.1}}};

TEST(RoadContact, WheelsFollowTheClosedFormOverABump) {
  const CarModel car = PriusOn({.ground = kHump});
  Rolling rolling(car, 5.0);
  double worst = 0.0;
  double highest = 0.0;
  while (rolling.d->qpos[car.parts().chassis_qpos] < 18.0) {
    rolling.Step();
    for (std::size_t w = 0; w < 4; ++w) {
      EXPECT_EQ(rolling.CountContacts(w), 1);
      // Hub positions at the beginning of the last step, for which its contacts were computed.
      const mjtNum* hub = rolling.d->geom_xpos + 3 * car.parts().tyre[w];
      const double above = hub[2] - HubHeight(kHump, hub[0], hub[1], 0.31075);
      worst = std::max(worst, std::abs(above));
      highest = std::max(highest, hub[2]);
    }
    ASSERT_FALSE(testing::Test::HasFailure());
  }
  EXPECT_GT(highest, 0.31 + 0.099);
  // The static deflection of a contact is 2e-5 m. The search finds the lowest point of the wheel to
  // 0.31/400^2/4 = 5e-7 m. The hump has the curvature c at its foot and crest, so the wheels
  // accelerate vertically by c v^2 = 0.8 m/s^2. This acceleration changes the deflection by c v^2
  // (1 - 2 dt/t)/k = 0.8 * 0.2/4e4 = 4e-6 m.
  EXPECT_LT(worst, Tolerance(3e-5));
}

TEST(RoadContact, LoadsChangeAsSmoothlyAsTheGround) {
  const CarModel car = PriusOn({.ground = kHump});
  Rolling rolling(car, 10.0);
  std::array<double, 4> last{};
  double largest = 0.0;
  double lightest = 1e9;
  while (rolling.d->qpos[car.parts().chassis_qpos] < 18.0) {
    rolling.Step();
    for (std::size_t w = 0; w < 4; ++w) {
      const double load = rolling.Load(w);
      if (rolling.d->time > 0.1) {
        largest = std::max(largest, std::abs(load - last[w]));
        lightest = std::min(lightest, load);
      }
      last[w] = load;
    }
  }
  // At the beginning of the hump, the unsprung mass of 36 kg is suddenly accelerated by 2 pi^2
  // h/L^2 v^2 = 3.1 m/s^2, which needs 110 N. The damper adds 1450 N s/m times the change of speed
  // in two timesteps. On a ground of flat facets, the load would jump by thousands of newtons.
  EXPECT_LT(largest, 200.0);
  // The load at rest is 3100 N. On the crest, the load decreases by the inertia of a quarter of the
  // car, 330 kg * 3.1 m/s^2 = 1020 N, and by an oscillation.
  EXPECT_GT(lightest, 1500.0);
}

TEST(RoadContact, ACarComesToRestAgainAsItStood) {
  const CarModel car = PriusOn({.ground = kHump});
  Rolling rolling(car, 10.0);
  while (rolling.d->time < 5.0) {
    rolling.Step();
  }
  const mjtNum* q = rolling.d->qpos + car.parts().chassis_qpos;
  EXPECT_GT(q[0], 40.0);
  // Body modes of 1.3 Hz with a damping ratio of 0.3 have decayed for 3 s, from 0.05 m by the
  // factor exp(-0.3 * 8.2 * 3).
  EXPECT_NEAR(q[2], 0.0, Tolerance(1e-4));
  EXPECT_NEAR(q[5], 0.0, Tolerance(1e-4));
  EXPECT_NEAR(q[1], 0.0, Tolerance(1e-6));  // left and right are symmetric
  for (int warning = 0; warning < mjNWARNING; ++warning) {
    EXPECT_EQ(rolling.d->warning[warning].number, 0);
  }
}

TEST(RoadContact, FlatStretchesAreAsFlatGround) {
  // Compares two cars. Only one of the two worlds has a hump, which is far away.
  Ground far = kHump;
  far.bumps[0].area.center.x = 1000.0;
  const CarModel flat = PriusOn({});
  const CarModel with_hump = PriusOn({.ground = far});
  Rolling a(flat, 5.0);
  Rolling b(with_hump, 5.0);
  for (int i = 0; i < 500; ++i) {
    a.Step();
    b.Step();
  }
  for (int i = 0; i < flat.get()->nq; ++i) {
    // The tolerance covers rounding over 500 steps of stiff contacts.
    EXPECT_NEAR(a.d->qpos[i], b.d->qpos[i], Tolerance(1e-8)) << i;
  }
}

TEST(RoadContact, TyresStillTouchObstacles) {
  World world{.ground = kHump};
  world.obstacles = {{{{5.0, 0.0, 0.0}, 1.0, 4.0}, 1.0}};
  const CarModel car = PriusOn(world);
  Rolling rolling(car, 10.0);
  const int obstacle = mj_name2id(car.get(), mjOBJ_GEOM, "obstacle_0");
  for (std::size_t w = 0; w < 4; ++w) {
    const int tyre = car.parts().tyre[w];
    EXPECT_NE(rolling.m->geom_contype[tyre] & rolling.m->geom_conaffinity[obstacle], 0);
    for (std::size_t other = 0; other < 4; ++other) {
      const std::string name = std::string("ground_") + kWheels[other];
      const int plane = mj_name2id(car.get(), mjOBJ_GEOM, name.c_str());
      EXPECT_EQ((rolling.m->geom_contype[tyre] & rolling.m->geom_conaffinity[plane]) != 0,
                w == other);
    }
    for (const char* name : {"ground", "ground_0"}) {
      const int road = mj_name2id(car.get(), mjOBJ_GEOM, name);
      EXPECT_EQ(rolling.m->geom_contype[tyre] & rolling.m->geom_conaffinity[road], 0) << name;
      EXPECT_EQ(rolling.m->geom_contype[road] & rolling.m->geom_conaffinity[tyre], 0) << name;
    }
  }
}

TEST(RoadContact, ASideSlopeRollsTheCar) {
  // The car stands in the middle of a wide ramp that rises to its left.
  const Ground ground{
      .side_slopes = {
          {.area = {{0.0, 0.0, 0.0}, 80.0, 10.0}, .slope = 0.08, .transition_length = 10.0}}};
  const CarModel car = PriusOn({.ground = ground});
  Rolling rolling(car, 0.0);
  for (const int spin : car.parts().spin_dof) {
    rolling.m->dof_frictionloss[spin] = 1000.0;  // brakes
  }
  for (int i = 0; i < 1500; ++i) {
    rolling.Step();
  }
  // On the right, the downhill side, the load is larger by m g h sin(a) / t. The total is m g
  // cos(a).
  const double angle = std::atan(0.08);
  const double weight = 1317.0 * 9.81;
  double sum = 0.0;
  double moment = 0.0;
  for (std::size_t w = 0; w < 4; ++w) {
    const double load = rolling.Load(w);
    sum += load;
    moment += load * (w < 2 ? 0.7525 : 0.74) * (w % 2 == 0 ? 1.0 : -1.0);
  }
  EXPECT_NEAR(sum, weight * std::cos(angle), Tolerance(0.001 * weight));
  // On its springs, the car leans farther: 5 degrees at 1 g, 0.4 degrees here. The center of
  // gravity, 0.55 m high, therefore moves 4 mm to the right, by 1 % of the lever arm.
  const double expected = -weight * std::sin(angle) * 0.55;
  EXPECT_NEAR(moment, expected, Tolerance(0.004 * weight));
  EXPECT_LT(moment, expected);
}

}  // namespace
}  // namespace trackbed
