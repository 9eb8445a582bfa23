#include "src/sim/spring_preload.h"

#include <mujoco/mujoco.h>

#include "src/sim/scene_xml.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

/// Calls `call` with each spring joint between a wheel and the chassis.
template <typename Call>
void ForEachSpring(const CarModel& car, std::size_t wheel, const Call& call) {
  const mjModel& model = *car.get();
  for (int body = car.parts().wheel[wheel]; body > 0 && body != car.chassis().chassis;
       body = model.body_parentid[body]) {
    for (int i = 0; i < model.body_jntnum[body]; ++i) {
      const int joint = model.body_jntadr[body] + i;
      if (model.jnt_type[joint] == mjJNT_SLIDE && model.jnt_stiffness[joint] > 0.0) {
        call(joint);
      }
    }
  }
}

}  // namespace

void PreloadSprings(const CarModel& car, tinyxml2::XMLElement& root,
                    const std::array<double, 4>& more, const std::string& key) {
  const mjModel& model = *car.get();
  for (std::size_t w = 0; w < kWheels.size(); ++w) {
    ForEachSpring(car, w, [&](int joint) {
      const int qpos = model.jnt_qposadr[joint];
      const double spring = model.qpos_spring[qpos] - more[w] / model.jnt_stiffness[joint];
      const char* name = mj_id2name(&model, mjOBJ_JOINT, joint);
      tinyxml2::XMLElement* element =
          name != nullptr && *name != '\0' ? FindInWorld(root, "joint", name) : nullptr;
      if (element == nullptr) {
        throw InputError(Problem{
            .file = car.file(),
            .key = key,
            .message = "a spring of the suspension has no name, so its preload cannot follow"});
      }
      element->SetAttribute("springref", spring);
    });
  }
}

bool HasSpring(const CarModel& car, std::size_t wheel) {
  bool found = false;
  ForEachSpring(car, wheel, [&](int) { found = true; });
  return found;
}

}  // namespace trackbed
