#pragma once

#include <string>

#include "trackbed/sim/mujoco_handles.h"
#include "trackbed/sim/scene.h"

namespace trackbed {

/// Whether a model is to be drawn or only stepped.
enum class Looks {
  kKept,
  kDiscarded,  ///< omits geoms and meshes without contacts and mass
};

/// Compiles a scene with MuJoCo. `name` is the scene's name in messages.
///
/// A scene that is not `trusted` is compiled, and stepped once, in a separate process that can open
/// no files and has 2 GB of memory (no limit under the address sanitizer) and a minute of processor
/// time: MuJoCo's readers of meshes, textures and composites do not validate their input, and may
/// crash. The compiled model is returned from there; it is byte for byte the same as one compiled
/// in this process.
///
/// Errors: InputError with the line in the car's file when the scene does not compile, when MuJoCo
/// crashes or does not finish, and when the model would take more than 1 GB. RunError when no
/// process can be started.
/// Threads: one compilation at a time; other threads wait.
/// Cost: MuJoCo's, 5 to 200 ms, and 5 to 20 ms for a separate process.
MujocoModel CompileScene(const Scene& scene, const std::string& name, Looks looks);

}  // namespace trackbed
