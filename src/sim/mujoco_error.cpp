#include "src/sim/mujoco_error.h"

#include <mujoco/mujoco.h>

#include "trackbed/core/error.h"
#include "trackbed/sim/car_model.h"

namespace trackbed {

void InstallMujocoErrorHandlers() {
  // Once: other threads may be using them.
  static const bool tamed = [] {
    mju_user_error = [](const char* message) {
      throw RunError(fmt::format("MuJoCo: {}", message));
    };
    mju_user_warning = [](const char*) {};
    return true;
  }();
  static_cast<void>(tamed);
}

std::string PhysicsVersion() {
  TRACKBED_CHECK(mj_version() == mjVERSION_HEADER, "MuJoCo {} is loaded, built with headers of {}",
                 mj_version(), mjVERSION_HEADER);
  return fmt::format("MuJoCo {}", mj_versionString());
}

}  // namespace trackbed
