#include "trackbed/sim/compile_scene.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <array>
#include <random>
#include <string>

#include "tests/support/error_text.h"
#include "tests/support/temp_folder.h"
#include "trackbed/core/file.h"

/// Models that are compiled for simulation, without visual geoms.
namespace trackbed {
namespace {

/// Writes random models: trees of bodies with visual and colliding geoms of several shapes, of
/// which some have mass and some do not.
class RandomModel {
 public:
  explicit RandomModel(unsigned seed) : random_(seed) {}

  std::string Xml() {
    const std::string bodies = Body(0) + Body(0);
    return fmt::format(
        "<mujoco>{}<asset><mesh name='m' vertex='0 0 0 {:.3f} 0 0 0 {:.3f} 0 0 0 {:.3f}'/></asset>"
        "<worldbody><geom name='ground' type='plane' size='1 1 1'/>{}</worldbody></mujoco>",
        Chance(0.3) ? Compiler() : "", Size(), Size(), Size(), bodies);
  }

 private:
  bool Chance(double share) { return std::bernoulli_distribution(share)(random_); }
  double Size() { return std::uniform_real_distribution(0.1, 0.4)(random_); }
  double Offset() { return std::uniform_real_distribution(-1.0, 1.0)(random_); }

  std::string Compiler() {
    return Chance(0.5) ? "<compiler inertiafromgeom='true'/>"
                       : fmt::format("<compiler settotalmass='{:.3f}'/>", 10.0 * Size());
  }

  std::string Geom(bool has_mass, bool collides) {
    static const std::array<const char*, 5> shapes{"box", "sphere", "cylinder", "capsule", "mesh"};
    const std::size_t shape = std::uniform_int_distribution<std::size_t>(0, 4)(random_);
    const double value = has_mass ? 10.0 * Size() : 0.0;
    return fmt::format(
        "<geom type='{}' {} pos='{:.3f} {:.3f} {:.3f}' euler='{:.1f} {:.1f} {:.1f}' "
        "{}='{:.4f}'{}/>",
        shapes[shape],
        shape == 4 ? std::string("mesh='m'")
                   : fmt::format("size='{:.3f} {:.3f} {:.3f}'", Size(), Size(), Size()),
        Offset(), Offset(), Offset(), 90.0 * Offset(), 90.0 * Offset(), 90.0 * Offset(),
        Chance(0.5) ? "mass" : "density", value, collides ? "" : " contype='0' conaffinity='0'");
  }

  std::string Body(int depth) {
    std::string text = fmt::format("<body pos='{:.3f} {:.3f} {:.3f}'>", Offset(), Offset(), 2.0);
    text += depth == 0 ? "<freejoint/>" : "<joint axis='0 1 0'/>";
    if (Chance(0.3)) {
      text += fmt::format("<inertial pos='{:.3f} 0 {:.3f}' mass='{:.3f}' diaginertia='.2 .3 .4'/>",
                          Offset(), Offset(), 10.0 * Size());
    }
    // At least one geom has mass, so that MuJoCo accepts the body.
    text += Geom(true, Chance(0.4));
    while (Chance(0.6)) {
      text += Geom(Chance(0.7), Chance(0.4));
    }
    while (depth < 3 && Chance(0.5)) {
      text += Body(depth + 1);
    }
    return text + "</body>";
  }

  std::mt19937 random_;
};

/// Compares all masses, also the total, and the centers of mass and inertias. Both models have
/// been compiled from the same numbers, so they must be equal to the last bit.
void ExpectSameMasses(const mjModel& simulated, const mjModel& own, const std::string& xml) {
  ASSERT_EQ(simulated.nbody, own.nbody) << xml;
  const MujocoData a = MakeMujocoData(simulated);
  const MujocoData b = MakeMujocoData(own);
  mj_forward(&simulated, a.get());
  mj_forward(&own, b.get());
  for (int body = 0; body < own.nbody; ++body) {
    ASSERT_EQ(simulated.body_mass[body], own.body_mass[body]) << xml;
    ASSERT_EQ(simulated.body_subtreemass[body], own.body_subtreemass[body]) << xml;
    for (int i = 3 * body; i < 3 * body + 3; ++i) {
      ASSERT_EQ(simulated.body_inertia[i], own.body_inertia[i]) << xml;
      ASSERT_EQ(a->xipos[i], b->xipos[i]) << xml;
      ASSERT_EQ(a->subtree_com[i], b->subtree_com[i]) << xml;
    }
    for (int i = 9 * body; i < 9 * body + 9; ++i) {
      ASSERT_EQ(a->ximat[i], b->ximat[i]) << xml;
    }
  }
}

TEST(CompileScene, KeepsTheMassesOfVisualGeoms) {
  const TempFolder folder;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    const std::string xml = RandomModel(seed).Xml();
    const std::string file = folder.Write("own.xml", xml).string();
    std::array<char, 500> message{};
    const MujocoModel own(mj_loadXML(file.c_str(), nullptr, message.data(), message.size()));
    ASSERT_NE(own, nullptr) << message.data() << xml;
    const Scene scene{.xml = xml, .trusted = true};
    const MujocoModel simulated = CompileScene(scene, "car.xml", Looks::kDiscarded);
    ExpectSameMasses(*simulated, *own, xml);
  }
}

// Without mass, visual geoms are dropped.
TEST(CompileScene, DropsVisualGeomsWithoutMass) {
  const Scene scene{
      .xml =
          "<mujoco><worldbody><body><freejoint/><geom size='1' mass='3'/>"
          "<geom size='2' mass='0' contype='0' conaffinity='0'/></body></worldbody></mujoco>",
      .trusted = true};
  EXPECT_EQ(CompileScene(scene, "car.xml", Looks::kDiscarded)->ngeom, 1);
  EXPECT_EQ(CompileScene(scene, "car.xml", Looks::kKept)->ngeom, 2);
}

// A model may use words of a newer MuJoCo than the linked one, which is then named.
TEST(CompileScene, NamesTheVersionOfMujocoThatAWordNeeds) {
  struct Case {
    const char* word;
    int version;
    const char* option;
    const char* actuator;
  };
  const Case cases[] = {
      {"implicitfast", 233, "<option integrator='implicitfast'/>", ""},
      {"dampratio", 316, "", "<actuator><position joint='j' dampratio='1'/></actuator>"},
      {"unheardof", 1 << 30, "<option unheardof='1'/>", ""}};
  for (const Case& one : cases) {
    const Scene scene{.xml = fmt::format("<mujoco>{}<worldbody><body><joint name='j'/><geom "
                                         "size='1'/></body></worldbody>{}</mujoco>",
                                         one.option, one.actuator),
                      .trusted = true};
    const std::string error = ErrorText([&] { CompileScene(scene, "car.xml", Looks::kKept); });
    EXPECT_EQ(error.empty(), mjVERSION_HEADER >= one.version) << one.word << error;
    const bool named = error.find("needs MuJoCo") != std::string::npos;
    EXPECT_EQ(named, mjVERSION_HEADER < one.version && one.version < (1 << 30)) << error;
  }
}

}  // namespace
}  // namespace trackbed
